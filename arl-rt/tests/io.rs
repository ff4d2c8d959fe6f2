//! Inputs and outputs as programs use them.

mod common;

use arl_rt::emit::*;
use arl_rt::io::{Pendant, Scenario};
use arl_rt::{Controller, Outcome};
use common::*;

#[test]
fn outputs_and_inputs_single_and_in_groups() {
    let (mut controller, messages) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            io::setdo(cx, 3, true).await.at(FILE, 1)?;
            io::setdo_group(cx, 5, 8, 0b1100).await.at(FILE, 2)?;
            io::syncdo(cx, 1, true).await.at(FILE, 3)?;
            io::syncdo_group(cx, 63, 64, 3).await.at(FILE, 4)?;
            say(cx, &io::getdo(cx, 3).await.at(FILE, 5)?)?;
            say(cx, &io::getdo_group(cx, 5, 8).await.at(FILE, 6)?)?;
            say(cx, &io::getdi_group(cx, 6, 9).await.at(FILE, 7)?)?;
            say(cx, &io::getnostopdi(cx, 7).at(FILE, 8)?)?;
            say(cx, &cx.time())
        })
    });
    for channel in 6..=9 {
        controller.set_digital_input(channel, true).unwrap();
    }
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(messages.text(), "true\n12\n15\ntrue\n0.002\n", "each syncdo takes a cycle");
    assert!(controller.digital_output(64).unwrap() && !controller.digital_output(2).unwrap());
}

#[test]
fn channels_that_do_not_exist_are_alarms() {
    let (outcome, _) = run(|cx| Box::pin(async move { io::setdo(cx, 65, true).await.at(FILE, 4) }));
    assert_eq!(alarm(outcome), "alarm 20010: DO 65 does not exist: this cell has channels 1 to 64 (t.arl:4)");
    let (outcome, _) = run(|cx| Box::pin(async move { io::getdi_group(cx, 4, 2).await.at(FILE, 5).map(|_| ()) }));
    assert!(alarm(outcome).contains("reversed range"));
    let (outcome, _) = run(|cx| Box::pin(async move { io::setdoimv(0, true).run(cx).at(FILE, 6) }));
    assert!(alarm(outcome).contains("DO 0 does not exist"));
}

/// The times at which an output changes, in cycles.
#[allow(clippy::unwrap_used, reason = "part of a test")]
fn edges(controller: &mut Controller, channel: i32) -> Vec<(u64, bool)> {
    let mut edges = Vec::new();
    let mut level = controller.digital_output(channel).unwrap();
    let mut cycle = 0;
    while controller.outcome().is_none() {
        controller.step();
        let now = controller.digital_output(channel).unwrap();
        if now != level {
            edges.push((cycle, now));
            level = now;
        }
        cycle += 1;
    }
    edges
}

#[test]
fn a_pulse_runs_beside_the_program_and_holds_up_its_end() {
    let (mut controller, messages) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            io::pulsedo(cx, 5, true, 0.2).await.at(FILE, 1)?;
            say(cx, &cx.time())
        })
    });
    assert_eq!(edges(&mut controller, 5), [(0, true), (200, false)]);
    assert_eq!(messages.text(), "0\n");
    assert_eq!(controller.outcome(), Some(&Outcome::Ended));
    assert_eq!(controller.time(), 0.201);
}

#[test]
fn a_new_pulse_ends_the_old_one_as_in_the_manual() {
    let (mut controller, _) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            io::pulsedo(cx, 5, true, 0.3).await.at(FILE, 1)?;
            flow::waittime(0.2).run(cx).await.at(FILE, 2)?;
            io::pulsedo(cx, 5, false, 0.1).await.at(FILE, 3)
        })
    });
    assert_eq!(edges(&mut controller, 5), [(0, true), (200, false), (300, true)]);
}

#[test]
fn a_pulse_goes_on_in_a_pause_and_ends_with_stop() {
    let (mut controller, _) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            io::pulsedo(cx, 5, true, 0.2).await.at(FILE, 1)?;
            io::pulsedo(cx, 6, true, 10.0).await.at(FILE, 2)?;
            flow::pause().run(cx).await.at(FILE, 3)
        })
    });
    controller.run_for(0.3);
    assert!(!controller.digital_output(5).unwrap() && controller.digital_output(6).unwrap());
    controller.stop();
    assert_eq!(controller.run(), Outcome::Stopped);
    assert!(!controller.digital_output(6).unwrap());
    assert!(controller.time() < 0.31);
}

#[test]
fn setdo_waits_for_the_motion_and_setdoimv_comes_with_its_end() {
    let (mut controller, _) = controller(Controller::builder(), |cx| {
        Box::pin(async move {
            io::setdoimv(1, true).run(cx).at(FILE, 1)?;
            motion::movej(bent(10.0)).vp(50.0).run(cx).await.at(FILE, 2)?;
            io::setdoimv(2, true).run(cx).at(FILE, 3)?;
            motion::movej(bent(20.0)).vp(50.0).run(cx).await.at(FILE, 4)?;
            io::setdo(cx, 3, true).await.at(FILE, 5)
        })
    });
    controller.step();
    assert!(controller.digital_output(1).unwrap(), "no motion is on its way: at once");
    let mut angles = Vec::new();
    for channel in [2, 3] {
        while !controller.digital_output(channel).unwrap() {
            controller.step();
        }
        angles.push(controller.joints().axes[0]);
    }
    assert!((angles[0] - 10.0).abs() < 0.2, "while it passes its first target: {angles:?}");
    assert_eq!(angles[1], 20.0, "at rest");
}

/// Says when input 1 has gone on.
fn waits(cx: &Cx) -> BoxFuture<'_> {
    Box::pin(async move {
        while !io::getdi(cx, 1).await.at(FILE, 1)? {
            flow::waittime(0.01).run(cx).await.at(FILE, 2)?;
        }
        say(cx, &cx.time())
    })
}

/// Whether so many times were said, to a few steps of the loop.
fn are_near(printed: &str, times: &[f64]) -> bool {
    let printed: Vec<f64> = printed.lines().map(|line| line.parse().unwrap_or(f64::NAN)).collect();
    printed.len() == times.len() && printed.iter().zip(times).all(|(printed, time)| (printed - time).abs() < 0.05)
}

#[test]
fn the_time_of_a_scenario_begins_with_the_programs() {
    let short = "[[event]]\nat = 0.2\ndi.1 = true\n[[event]]\nat = 0.25\ndi.1 = false\n";
    let build = |text| Controller::builder().scenario(Scenario::parse("s.toml", text).unwrap());
    let (mut paused, messages) = controller(build(short), waits);
    paused.press(Pendant::Pause);
    paused.run_for(2.0);
    assert!(paused.standstill().is_some(), "somebody is to start it");
    paused.press(Pendant::Start);
    assert_eq!(paused.run(), Outcome::Ended);
    // Once more, after a reset: the input goes on again, although it was on when the program ended.
    paused.press(Pendant::Reset);
    assert_eq!(paused.run(), Outcome::Ended);
    paused.reset().unwrap();
    assert_eq!(paused.run(), Outcome::Ended);
    assert!(are_near(&messages.text(), &[2.2, 2.4, 2.6]), "{}", messages.text());
    // An order is a button, too.
    let (mut ordered, messages) = controller(build(short), waits);
    ordered.order("pendant = \"pause\"").unwrap();
    ordered.run_for(0.5);
    ordered.order("pendant = \"start\"").unwrap();
    assert_eq!(ordered.run(), Outcome::Ended);
    assert!(are_near(&messages.text(), &[0.7]), "{}", messages.text());
    // What a scenario starts itself does not wait, and buttons that it presses do not begin it anew.
    let starts = format!(
        "{short}[[event]]\nat = 0.1\npendant = \"start\"\n[[event]]\nat = 1\npendant = \"reset\"\n\
                          [[event]]\nat = 1.5\ndi.1 = true\n"
    );
    let (mut started, messages) = controller(build(&starts), waits);
    started.press(Pendant::Pause);
    assert_eq!(started.run(), Outcome::Ended);
    assert!(are_near(&messages.text(), &[0.2, 1.5]), "{}", messages.text());
}

#[test]
fn a_scenario_answers_outputs() {
    let scenario = "[[event]]\nwhen = \"do.1\"\nafter = 0.1\ndi.1 = true\nai.2 = 4.5\n\
                    [[event]]\nwhen = \"!do.1\"\ndi.1 = false\n";
    let builder = Controller::builder().scenario(Scenario::parse("s.toml", scenario).unwrap());
    let (mut controller, messages) = controller(builder, |cx| {
        Box::pin(async move {
            for _ in 0..3 {
                io::setdo(cx, 1, true).await.at(FILE, 1)?;
                while !io::getdi(cx, 1).await.at(FILE, 2)? {
                    cx.next_cycle().await;
                }
                say(cx, &cx.time())?;
                io::setdo(cx, 1, false).await.at(FILE, 3)?;
                while io::getdi(cx, 1).await.at(FILE, 4)? {
                    cx.next_cycle().await;
                }
                say(cx, &cx.time())?;
            }
            Ok(())
        })
    });
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(messages.text(), "0.1\n0.101\n0.201\n0.202\n0.302\n0.303\n");
}

#[test]
fn the_pendant_of_a_scenario_starts_a_paused_program() {
    let scenario = Scenario::parse("s.toml", "[[event]]\nat = 0.25\npendant = \"start\"\n").unwrap();
    let (mut controller, messages) = controller(Controller::builder().scenario(scenario), |cx| {
        Box::pin(async move {
            flow::pause().run(cx).await.at(FILE, 1)?;
            say(cx, &cx.time())
        })
    });
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(messages.text(), "0.25\n");
}

#[test]
fn drivers_stand_for_the_outside() {
    use std::cell::RefCell;
    use std::rc::Rc;

    /// Each output is wired to the input of the same number.
    struct Loop(Rc<RefCell<Vec<bool>>>);

    impl arl_rt::io::IoDriver for Loop {
        fn read(&mut self, mut inputs: arl_rt::io::Inputs<'_>) {
            for (at, level) in self.0.borrow().iter().enumerate() {
                inputs.set_digital_input(at + 1, *level);
            }
        }

        fn write(&mut self, outputs: arl_rt::io::Outputs<'_>) {
            *self.0.borrow_mut() = (1..=8).map(|channel| outputs.digital_output(channel)).collect();
        }
    }

    let wires = Rc::new(RefCell::new(Vec::new()));
    let (mut controller, messages) = controller(Controller::builder().io_driver(Loop(Rc::clone(&wires))), |cx| {
        Box::pin(async move {
            io::syncdo(cx, 7, true).await.at(FILE, 1)?;
            say(cx, &io::getdi_group(cx, 1, 8).await.at(FILE, 2)?)
        })
    });
    controller.run();
    assert_eq!(messages.text(), "64\n");
    assert!(wires.borrow()[6]);
}
