//! The course of programs: waits, the budget of a cycle, restart, exit, alarms, reset.

mod common;

use arl_rt::emit::*;
use arl_rt::{Controller, Outcome, State};
use common::*;

#[test]
fn times_are_counted_in_cycles() {
    let (outcome, text) = run(|cx| {
        Box::pin(async move {
            let watch = Clock::new();
            for seconds in [0.0, 0.0001, 0.001, 0.0015, 0.5, 3.0] {
                clock::clkreset(cx, &watch);
                clock::clkstart(cx, &watch);
                flow::waittime(seconds).run(cx).await.at(FILE, 1)?;
                clock::clkstop(cx, &watch);
                say(cx, &clock::clkread(cx, &watch))?;
            }
            Ok(())
        })
    });
    assert_eq!(outcome, Outcome::Ended);
    assert_eq!(text, "0\n0.001\n0.001\n0.002\n0.5\n3\n");
}

#[test]
fn clocks_stop_go_on_and_are_reset() {
    let (_, text) = run(|cx| {
        Box::pin(async move {
            let watch = Clock::new();
            let wait = |seconds: f64| flow::waittime(seconds).run(cx);
            wait(0.1).await.at(FILE, 1)?;
            say(cx, &clock::clkread(cx, &watch))?;
            clock::clkstart(cx, &watch);
            wait(0.2).await.at(FILE, 2)?;
            clock::clkstart(cx, &watch);
            say(cx, &clock::clkread(cx, &watch))?;
            clock::clkstop(cx, &watch);
            wait(0.4).await.at(FILE, 3)?;
            say(cx, &clock::clkread(cx, &watch))?;
            clock::clkstart(cx, &watch);
            wait(0.1).await.at(FILE, 4)?;
            say(cx, &clock::clkread(cx, &watch))?;
            clock::clkreset(cx, &watch);
            wait(0.05).await.at(FILE, 5)?;
            say(cx, &clock::clkread(cx, &watch))
        })
    });
    assert_eq!(text, "0\n0.2\n0.2\n0.3\n0.05\n");
}

#[test]
fn negative_times_are_alarms() {
    let (outcome, _) = run(|cx| Box::pin(async move { flow::waittime(-0.5).run(cx).await.at(FILE, 7) }));
    assert_eq!(alarm(outcome), "alarm 20004: waittime: the time is -0.5 s, but must be 0 or more (t.arl:7)");
}

#[test]
fn waituntil_sees_inputs_and_its_longest_time() {
    fn script(cx: &Cx) -> BoxFuture<'_> {
        Box::pin(async move {
            let wait = flow::waituntil(cx).maxtime(2.0).start().await.at(FILE, 1)?;
            let late = loop {
                if io::getdi(cx, 6).await.at(FILE, 1)? {
                    break false;
                }
                if wait.late() {
                    break true;
                }
                cx.next_cycle().await;
            };
            text::print().argtoprint(&late).argtoprint(&" ").argtoprint(&cx.time()).run(cx).at(FILE, 2)
        })
    }
    let (outcome, text) = run(script);
    assert_eq!((outcome, text.as_str()), (Outcome::Ended, "true 2\n"));
    let (mut controller, messages) = controller(Controller::builder(), script);
    controller.run_for(1.25);
    controller.set_digital_input(6, true).unwrap();
    controller.run();
    assert_eq!(messages.text(), "false 1.25\n");
}

#[test]
fn loops_that_only_compute_give_the_cycle_back() {
    let (mut controller, _) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            let mut turns = 0_u64;
            loop {
                turns = std::hint::black_box(turns + 1);
                if cx.spend() {
                    cx.next_cycle().await;
                }
            }
        })
    });
    assert_eq!(controller.run_for(0.1), State::Running);
    assert_eq!(controller.time(), 0.1);
}

#[test]
fn many_rounds_count_at_once_and_values_outlast_the_wait() {
    let (mut controller, messages) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            let (mut sum, mut turns, first) = (0_i32, 0_i32, cx.cycle());
            while turns < 100 {
                turns += 1;
                sum += turns;
                if cx.spend_rounds(1_000_000) {
                    (sum, turns) = cx.next_cycle().keeping((sum, turns)).await;
                }
            }
            let cycles = (cx.cycle() - first) as i32;
            text::print().argtoprint(&sum).argtoprint(&" ").argtoprint(&cycles).run(cx).at(FILE, 1)
        })
    });
    controller.run();
    assert_eq!(messages.text(), "5050 100\n");
}

#[test]
fn loops_of_calls_that_need_not_wait_give_the_cycle_back() {
    let (mut controller, _) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            loop {
                io::setdo(cx, 1, true).await.at(FILE, 1)?;
                flow::waittime(0.0).run(cx).await.at(FILE, 2)?;
            }
        })
    });
    assert_eq!(controller.run_for(0.1), State::Running);
}

#[test]
fn restart_keeps_variables_and_lets_motion_run_out() {
    let (mut controller, messages) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            let count = cx.system().i.update(|i| {
                i[0] += 1;
                i[0]
            });
            text::print().argtoprint(&count).argtoprint(&pose::cjoint(cx).j1).run(cx).at(FILE, 1)?;
            motion::movej(bent(f64::from(count) * 5.0)).vp(50.0).run(cx).await.at(FILE, 2)?;
            if count < 3 { Err(Stop::restart()) } else { Err(Stop::exit()) }
        })
    });
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(messages.text(), "10\n25\n310\n", "1 at 0, 2 at 5, 3 at 10 deg");
    assert_eq!(controller.joints().axes[0], 15.0, "the last motion ran to its end, too");
}

#[test]
fn a_program_of_nothing_but_restart_does_not_hang() {
    let (mut controller, _) = controller(Controller::builder(), |_| Box::pin(async { Err(Stop::restart()) }));
    assert_eq!(controller.run_for(0.05), State::Running);
}

#[test]
fn an_alarm_stops_the_robot_on_its_path() {
    let (mut controller, _) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            motion::movej(bent(80.0)).vp(100.0).run(cx).await.at(FILE, 1)?;
            motion::movej(bent(-80.0)).vp(100.0).run(cx).await.at(FILE, 2)?;
            for _ in 0..300 {
                cx.next_cycle().await;
            }
            flow::assert(false).at(FILE, 3)
        })
    });
    controller.run_for(0.3);
    let before = controller.joints().axes[0];
    assert_eq!(alarm(controller.run()), "alarm 20008: assertion failed (t.arl:3)");
    let [j1, j2, ..] = controller.joints().axes;
    assert!(before < j1 && j1 < 80.0, "it came to rest on the way: {before} {j1}");
    assert!((-90.0..=0.0).contains(&j2));
    assert_eq!(controller.take_alarms().len(), 1);
    assert_eq!(controller.take_alarms(), []);
}

#[test]
fn stop_ends_the_program_at_rest() {
    let (mut controller, _) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            motion::movej(bent(80.0)).vp(100.0).run(cx).await.at(FILE, 1)?;
            flow::waittime(1000.0).run(cx).await.at(FILE, 2)
        })
    });
    controller.run_for(0.3);
    controller.stop();
    assert_eq!(controller.state(), State::Running, "it still brakes");
    assert_eq!(controller.run(), Outcome::Stopped);
    assert!(controller.joints().axes[0] < 80.0 && controller.time() < 1.0);
}

#[test]
fn pause_waits_for_the_start_button() {
    let (mut controller, messages) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            flow::pause().run(cx).await.at(FILE, 1)?;
            say(cx, &cx.time())
        })
    });
    assert_eq!(controller.run_for(0.5), State::Paused);
    controller.resume();
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(messages.text(), "0.5\n");
}

#[test]
fn a_reset_starts_from_the_beginning() {
    let (mut controller, messages) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            let system = cx.system();
            system.i.update(|i| i[0] += 1);
            say(cx, &system.i.with(|i| i[0]))?;
            say(cx, &system.dfspeed.get().per)?;
            text::print().to(Printto::Off).argtoprint(&"not seen").run(cx).at(FILE, 1)?;
            io::pulsedo(cx, 4, true, 100.0).await.at(FILE, 2)?;
            motion::movej(bent(5.0)).vp(70.0).run(cx).await.at(FILE, 3)?;
            Err(Stop::alarm(arl_rt::Alarm::new(Fault::Assertion, FILE, 4)))
        })
    });
    assert!(controller.reset().is_err(), "it runs");
    for _ in 0..2 {
        assert!(matches!(controller.run(), Outcome::Alarm(_)));
        assert!(!controller.digital_output(4).unwrap(), "the pulse has ended");
        controller.reset().unwrap();
    }
    assert_eq!(messages.text(), "1\n5\n2\n5\n", "system variables of 10.1 stay, those of 10.2 do not");
}

#[test]
fn the_real_clock_keeps_its_pace() {
    let builder = Controller::builder().clock(arl_rt::clock::RealClock::new());
    let (mut controller, _) =
        controller(builder, |cx| Box::pin(async move { flow::waittime(0.05).run(cx).await.at(FILE, 1) }));
    let start = std::time::Instant::now();
    assert_eq!(controller.run(), Outcome::Ended);
    assert!(start.elapsed().as_secs_f64() >= 0.049, "never faster than the world");
}

#[test]
fn other_cycles_are_possible() {
    let cell = arl_rt::Cell::parse("c.toml", "[controller]\ncycle = 4\n").unwrap();
    let (mut controller, messages) = controller(Controller::builder().cell(cell), |cx| {
        Box::pin(async move {
            flow::waittime(0.01).run(cx).await.at(FILE, 1)?;
            say(cx, &cx.time())
        })
    });
    controller.run();
    assert_eq!(messages.text(), "0.012\n", "three cycles of 4 ms");
}
