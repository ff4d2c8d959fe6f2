//! A hundred hours on the virtual clock: cycles in which nothing can change cost nothing, and the run is the same as
//! with them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "these are tests")]

mod common;

use std::cell::Cell;
use std::rc::Rc;

use arl_rt::emit::*;
use arl_rt::io::Scenario;
use arl_rt::{Builder, Captured, Controller, Foreground, Outcome};
use common::*;

/// A clock that counts the cycles that it sees.
#[derive(Clone, Default)]
struct Counting {
    seen: Rc<Cell<u64>>,
    /// Whether cycles may be left out.
    may_skip: bool,
}

impl arl_rt::clock::Clock for Counting {
    fn wait_for(&mut self, _cycle: u64, _period: f64) {
        self.seen.set(self.seen.get() + 1);
    }

    fn is_real(&self) -> bool {
        false
    }

    fn may_skip(&self) -> bool {
        self.may_skip
    }
}

#[test]
fn a_hundred_hours_of_waiting_are_a_few_cycles_and_no_time_is_lost() {
    let clock = Counting { may_skip: true, ..Counting::default() };
    let (mut controller, messages) = controller(Controller::builder().clock(clock.clone()), |cx| {
        Box::pin(async move {
            let watch = Clock::new();
            clock::clkstart(cx, &watch);
            motion::movej(bent(10.0)).vp(100.0).run(cx).await.at(FILE, 1)?;
            flow::waittime(0.0).run(cx).await.at(FILE, 2)?;
            say(cx, &(clock::clkread(cx, &watch) < 5.0))?;
            clock::clkreset(cx, &watch);
            for _ in 0..100 {
                flow::waittime(3600.0).run(cx).await.at(FILE, 3)?;
            }
            say(cx, &(clock::clkread(cx, &watch) == 360_000.0))?;
            say(cx, &time::cdate(cx))?;
            Ok(())
        })
    });
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(messages.text(), "true\ntrue\n2000-01-05\n");
    assert!(controller.time() > 360_000.0 && controller.time() < 360_005.0, "{}", controller.time());
    assert!(clock.seen.get() < 20_000, "{} cycles", clock.seen.get());
}

#[test]
fn a_clock_of_your_own_sees_each_cycle() {
    let clock = Counting::default();
    let (mut controller, _) = controller(Controller::builder().clock(clock.clone()), |cx| {
        Box::pin(async move { flow::waittime(10.0).run(cx).await.at(FILE, 1) })
    });
    assert_eq!(controller.run(), Outcome::Ended);
    assert!(clock.seen.get() >= 10_000);
}

/// What happens from outside within some minutes of [`busy`].
const SCENARIO: &str = "[[event]]\nat = 20\ndi.1 = true\n\
                        [[event]]\nwhen = \"do.1\"\nafter = 30\ndi.2 = true\n\
                        [[event]]\nat = 45.5\ndi.3 = true\n\
                        [[event]]\nat = 45.6\ndi.3 = false\n\
                        [[event]]\nat = 70\npendant = \"pause\"\n\
                        [[event]]\nat = 90\npendant = \"start\"\n";

/// Waits for time and for signals, with an interrupt, a timer, a pulse and motion in between.
fn busy(cx: &Cx) -> BoxFuture<'_> {
    Box::pin(async move {
        let print_time =
            |cx: &Cx, what: &'static str| text::print().argtoprint(&what).argtoprint(&cx.time()).run(cx).at(FILE, 9);
        event::interrupt(
            async |cx: &Cx| io::getdi(cx, 3).await.at(FILE, 1),
            async move |cx: &Cx| print_time(cx, "interrupt "),
        )
        .name(&"three".into())
        .run(cx)
        .at(FILE, 1)?;
        flow::waittime(12.3456).run(cx).await.at(FILE, 2)?;
        print_time(cx, "waited ")?;
        while !io::getdi(cx, 1).await.at(FILE, 3)? {
            cx.change().await;
        }
        print_time(cx, "di 1 ")?;
        motion::movej(bent(30.0)).vp(100.0).run(cx).await.at(FILE, 4)?;
        io::setdo(cx, 1, true).await.at(FILE, 5)?;
        print_time(cx, "there ")?;
        while !io::getdi(cx, 2).await.at(FILE, 6)? {
            cx.change().await;
        }
        print_time(cx, "di 2 ")?;
        io::pulsedo(cx, 3, true, 2.0).await.at(FILE, 7)?;
        event::timer(3.5, async move |cx: &Cx| print_time(cx, "timer ")).name(&"t".into()).run(cx).at(FILE, 8)?;
        flow::waittime(60.0).run(cx).await.at(FILE, 8)?;
        motion::movej(bent(-20.0)).vp(100.0).run(cx).await.at(FILE, 8)?;
        flow::waittime(1.0).run(cx).await.at(FILE, 8)?;
        print_time(cx, "end ")
    })
}

/// The other robot's program ends early, and waits in between.
fn other(cx: &Cx) -> BoxFuture<'_> {
    Box::pin(async move {
        flow::waittime(15.0).run(cx).await.at(FILE, 21)?;
        motion::movej(bent(5.0)).vp(100.0).run(cx).await.at(FILE, 22)?;
        flow::waittime(17.0).run(cx).await.at(FILE, 23)?;
        text::print().argtoprint(&"other ").argtoprint(&cx.time()).run(cx).at(FILE, 24)
    })
}

fn two_robots(clock: Counting) -> (Controller, Captured) {
    let builder: Builder = Controller::builder().clock(clock);
    let builder = builder.scenario(Scenario::parse("s.toml", SCENARIO).unwrap());
    controller(builder.foreground(Foreground::new(Box::new(script(other)))), busy)
}

#[test]
fn a_run_without_its_quiet_cycles_is_the_run_with_them() {
    let (skipping, plain) = (Counting { may_skip: true, ..Counting::default() }, Counting::default());
    let ((mut short, brief), (mut long, all)) = (two_robots(skipping.clone()), two_robots(plain.clone()));
    assert_eq!(short.run(), Outcome::Ended);
    assert_eq!(long.run(), Outcome::Ended);
    assert_eq!(brief.text(), all.text());
    assert!(brief.text().contains("interrupt ") && brief.text().contains("timer "), "{}", brief.text());
    assert_eq!(short.time(), long.time());
    let bits = |controller: &Controller| controller.joints().axes.map(f64::to_bits);
    assert_eq!(bits(&short), bits(&long));
    assert!((plain.seen.get() as f64 * 0.001 - long.time()).abs() < 1e-6);
    assert!(skipping.seen.get() * 3 < plain.seen.get(), "{} of {}", skipping.seen.get(), plain.seen.get());
}

/// Sets an output and waits at once, for long: somebody else sees it in the cycle behind.
fn sets_and_waits(cx: &Cx) -> BoxFuture<'_> {
    Box::pin(async move {
        let print_time = |cx: &Cx| text::print().argtoprint(&"seen ").argtoprint(&cx.time()).run(cx).at(FILE, 9);
        event::interrupt(async |cx: &Cx| io::getdo(cx, 1).await.at(FILE, 1), async move |cx: &Cx| print_time(cx))
            .name(&"set".into())
            .run(cx)
            .at(FILE, 1)?;
        // By time or by an input that is on for long, when it is looked at.
        flow::waittime(1.0).run(cx).await.at(FILE, 2)?;
        while !io::getdi(cx, 1).await.at(FILE, 3)? {
            flow::waittime(0.01).run(cx).await.at(FILE, 3)?;
        }
        io::setdo(cx, 1, true).await.at(FILE, 4)?;
        flow::waittime(10.0).run(cx).await.at(FILE, 5)?;
        io::setdo(cx, 2, true).await.at(FILE, 6)?;
        flow::waittime(100.0).run(cx).await.at(FILE, 7)
    })
}

#[test]
fn what_is_done_before_a_wait_is_seen_in_the_cycle_behind() {
    let run = |may_skip: bool| {
        let clock = Counting { may_skip, ..Counting::default() };
        let events = "[[event]]\nat = 3.0037\ndi.1 = true\n";
        let builder = Controller::builder().clock(clock).scenario(Scenario::parse("s.toml", events).unwrap());
        let builder = builder.background(script(|cx| {
            Box::pin(async move {
                while !io::getdo(cx, 2).await.at(FILE, 11)? {
                    cx.change().await;
                }
                text::print().argtoprint(&"beside ").argtoprint(&cx.time()).run(cx).at(FILE, 12)
            })
        }));
        let (mut controller, messages) = controller(builder, sets_and_waits);
        assert_eq!(controller.run(), Outcome::Ended);
        messages.text()
    };
    let (short, long) = (run(true), run(false));
    assert_eq!(short, long);
    assert!(short.contains("seen 3.") && short.contains("beside 13."), "{short}");
}

#[test]
fn so_many_seconds_are_so_many_seconds() {
    let clock = Counting { may_skip: true, ..Counting::default() };
    let (mut controller, _) = controller(Controller::builder().clock(clock.clone()), |cx| {
        Box::pin(async move {
            while !io::getdi(cx, 1).await.at(FILE, 1)? {
                cx.change().await;
            }
            flow::waittime(7200.0).run(cx).await.at(FILE, 2)
        })
    });
    controller.run_for(3600.0);
    assert_eq!(controller.time(), 3600.0);
    controller.set_digital_input(1, true).unwrap();
    controller.run_for(0.5);
    assert_eq!(controller.time(), 3600.5);
    assert_eq!(controller.run(), Outcome::Ended);
    assert!((controller.time() - 10_800.0).abs() < 0.01, "{}", controller.time());
    assert!(clock.seen.get() < 5000, "{} cycles", clock.seen.get());
}

/// The set-points, the TCP and what the robot reports, bit by bit, of a motion that begins so late.
fn motion_after(seconds: f64) -> Vec<[[u64; 6]; 3]> {
    let (mut controller, _) = controller(Controller::builder(), move |cx| {
        Box::pin(async move {
            flow::waittime(seconds).run(cx).await.at(FILE, 1)?;
            motion::movej(bent(30.0)).vp(100.0).run(cx).await.at(FILE, 2)?;
            motion::movej(bent(-10.0)).vp(50.0).sp(20.0).run(cx).await.at(FILE, 3)?;
            motion::movej(bent(15.0)).vp(100.0).run(cx).await.at(FILE, 4)?;
            flow::waittime(0.0).run(cx).await.at(FILE, 5)
        })
    });
    controller.run_for(seconds);
    let mut found = Vec::new();
    while controller.outcome().is_none() {
        controller.step();
        let status = controller.status();
        let robot = status.channels[0].robot.as_ref().unwrap();
        found.push([robot.joints.axes, robot.tcp, robot.reported.axes].map(|all| all.map(f64::to_bits)));
    }
    found
}

#[test]
fn a_motion_after_a_hundred_hours_is_that_at_the_start_to_the_last_bit() {
    let first = motion_after(1.0);
    assert!(first.len() > 500, "{}", first.len());
    // Not only after whole seconds: the robot's lag has a length of eight cycles.
    for seconds in [360_000.0, 360_000.003] {
        assert!(motion_after(seconds) == first, "{seconds}");
    }
}
