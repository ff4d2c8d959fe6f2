//! What the controller makes of what the driver of a robot says: every transition of its motors, and every trouble.

#![allow(clippy::unwrap_used, clippy::panic, reason = "these are tests")]

mod common;

use std::cell::RefCell;
use std::rc::Rc;

use arl_rt::cell::{Cell, LateCycles};
use arl_rt::clock::{Clock, Lateness, RealClock};
use arl_rt::emit::*;
use arl_rt::motion::Joints;
use arl_rt::robot_driver::{DriverError, Drives, Feedback, Power, RobotDriver, Setpoint, SimulatedRobot, Start};
use arl_rt::{Builder, Controller, Outcome, Robot, State};
use common::*;

/// What the driver does to what the simulated robot says, by the cycle, from 1.
type Script = fn(u64, Feedback) -> Feedback;

/// What the driver has heard.
#[derive(Default)]
struct Heard {
    cycle: u64,
    setpoints: Vec<Setpoint>,
    /// How the motors were switched, and the speed of axis 1 then, in deg/s.
    switched: Vec<(Power, f64)>,
    closed: u32,
}

/// A simulated robot whose word is changed on its way.
struct Scripted {
    robot: SimulatedRobot,
    heard: Rc<RefCell<Heard>>,
    script: Script,
    torques: bool,
}

impl RobotDriver for Scripted {
    fn start(&mut self, start: &Start<'_>) -> Result<Joints, DriverError> {
        assert_eq!((start.period, start.robot.axes.len()), (0.001, 6));
        self.robot.start(start)
    }

    fn exchange(&mut self, setpoint: &Setpoint) -> Feedback {
        let mut heard = self.heard.borrow_mut();
        heard.cycle += 1;
        heard.setpoints.push(*setpoint);
        (self.script)(heard.cycle, self.robot.exchange(setpoint))
    }

    fn switch(&mut self, power: Power) -> Drives {
        let mut heard = self.heard.borrow_mut();
        let speed = heard.setpoints.last().map_or(0.0, |setpoint| setpoint.velocity.axes[0]);
        heard.switched.push((power, speed));
        self.robot.switch(power);
        // They come on in the next cycle at the earliest.
        Drives::Off
    }

    fn wants_torque(&self) -> bool {
        self.torques
    }

    fn close(&mut self) {
        self.heard.borrow_mut().closed += 1;
    }
}

/// A controller whose program turns axis 1 by 90 deg, which takes some 0.7 s, and what its driver hears.
fn turning(script: Script) -> (Controller, Rc<RefCell<Heard>>) {
    turning_with(script, |builder| builder)
}

/// The same with more.
fn turning_with(script: Script, more: impl FnOnce(Builder) -> Builder) -> (Controller, Rc<RefCell<Heard>>) {
    let heard = Rc::<RefCell<Heard>>::default();
    let driver = Scripted { robot: SimulatedRobot::new(), heard: Rc::clone(&heard), script, torques: false };
    let builder = more(Controller::builder().robot_driver(driver));
    let (controller, _) = controller(builder, |cx| {
        Box::pin(async move {
            motion::movej(bent(0.0)).vp(100.0).run(cx).await.at(FILE, 1)?;
            cx.line(FILE, 2);
            motion::movej(bent(90.0)).vp(100.0).run(cx).await.at(FILE, 2)?;
            flow::waittime(0.0).run(cx).await.at(FILE, 3)?;
            flow::waittime(5.0).run(cx).await.at(FILE, 4)
        })
    });
    (controller, heard)
}

/// The cycle in which axis 1 is at full speed.
const AT_SPEED: u64 = 750;

fn outcome(controller: &mut Controller) -> (u32, u32, String) {
    match controller.run() {
        Outcome::Alarm(alarm) => (alarm.fault.number(), alarm.line, alarm.fault.to_string()),
        other => panic!("no alarm: {other}"),
    }
}

/// Set-points keep the limits of axis 1, to the last one.
fn keep_limits(heard: &Heard) {
    let axis = &Robot::builtin("kr10-r1420").unwrap().axes[0];
    for pair in heard.setpoints.windows(2) {
        let [before, here] = pair else { continue };
        let step = here.position.axes[0] - before.position.axes[0];
        let speed = here.velocity.axes[0];
        assert!((step / 0.001 - speed).abs() < 1e-6, "{step} {speed}");
        assert!(speed.abs() <= axis.vel * 1.001, "{speed}");
        let acceleration = (speed - before.velocity.axes[0]) / 0.001;
        assert!(acceleration.abs() <= axis.acc * 1.01, "{acceleration}");
        assert!((here.acceleration[0] - acceleration).abs() < 1e-3);
    }
}

#[test]
fn the_program_moves_at_speed_when_faults_come() {
    let (mut controller, heard) = turning(|_, feedback| feedback);
    controller.run_for(AT_SPEED as f64 * 0.001);
    assert!(heard.borrow().setpoints.last().unwrap().velocity.axes[0] > 100.0);
    assert_eq!(controller.run(), Outcome::Ended);
    drop(controller);
    let heard = heard.borrow();
    keep_limits(&heard);
    // The motors were on from the start, and were switched off when the robot was let go.
    assert_eq!((&heard.switched[..], heard.closed), (&[(Power::Off, 0.0)][..], 1));
}

#[test]
fn a_robot_that_says_nothing_stops_and_is_switched_off_at_rest() {
    let (mut controller, heard) = turning(|cycle, feedback| if cycle < AT_SPEED { feedback } else { Feedback::none() });
    let (number, line, text) = outcome(&mut controller);
    assert_eq!((number, line), (20071, 2), "{text}");
    assert_eq!(text, "no position feedback for 21 ms");
    let heard = heard.borrow();
    keep_limits(&heard);
    assert_eq!(heard.switched, [(Power::Off, 0.0)]);
    // It is over once the set-point stands: nobody waits for a robot to settle that says nothing.
    assert!(heard.cycle < AT_SPEED + 1000, "{}", heard.cycle);
}

#[test]
fn a_few_cycles_without_a_word_are_no_fault() {
    let (mut controller, heard) = turning(|cycle, feedback| if cycle % 25 < 5 { feedback } else { Feedback::none() });
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(heard.borrow().switched, []);
}

#[test]
fn no_numbers_are_no_positions() {
    for value in [f64::NAN, f64::INFINITY] {
        let script: Script = if value.is_nan() {
            |cycle, feedback| changed(cycle, feedback, f64::NAN)
        } else {
            |cycle, feedback| changed(cycle, feedback, f64::INFINITY)
        };
        let (mut controller, heard) = turning(script);
        let (number, line, text) = outcome(&mut controller);
        assert_eq!((number, line), (20071, 2), "{text}");
        assert!(controller.joints().axes.iter().all(|axis| axis.is_finite()));
        keep_limits(&heard.borrow());
        assert_eq!(heard.borrow().switched, [(Power::Off, 0.0)]);
    }
}

/// Axis 3 is there from a cycle on.
fn changed(cycle: u64, feedback: Feedback, value: f64) -> Feedback {
    let mut position = feedback.position.unwrap();
    if cycle >= AT_SPEED {
        position.axes[2] = value;
    }
    Feedback::at(position)
}

#[test]
fn a_robot_that_stays_behind_stops() {
    // What it said last is said for ever.
    let (mut controller, heard) = turning(|cycle, feedback| match cycle < AT_SPEED {
        true => feedback,
        false => Feedback::at(Joints { axes: bent(25.0).axes(), external: [0.0; 6] }),
    });
    let (number, line, text) = outcome(&mut controller);
    assert_eq!((number, line), (20070, 2), "{text}");
    let axis = &Robot::builtin("kr10-r1420").unwrap().axes[0];
    assert!(text.starts_with("the robot does not follow: j1 is ") && text.contains("deg are allowed"), "{text}");
    let allowed = axis.vel * 0.1;
    assert!(text.contains(&format!("{allowed:.2} deg are allowed")), "{text}");
    keep_limits(&heard.borrow());
    assert_eq!(heard.borrow().switched, [(Power::Off, 0.0)]);
}

#[test]
fn drives_with_a_fault_are_all_cut_off_at_once() {
    let (mut controller, heard) = turning(|cycle, feedback| match cycle < AT_SPEED {
        true => feedback,
        false => feedback.with_drives(Drives::Fault("E07, over-current of axis 2".into())),
    });
    let (number, line, text) = outcome(&mut controller);
    assert_eq!((number, line), (20072, 2), "{text}");
    assert_eq!(text, "the drives of the robot have a fault: E07, over-current of axis 2");
    let heard = heard.borrow();
    let (power, speed) = heard.switched[0];
    assert!(heard.switched.len() == 1 && power == Power::Cut && speed > 100.0, "{:?}", heard.switched);
    // From then on it is asked for nothing but to stay.
    let behind = &heard.setpoints[AT_SPEED as usize..];
    assert!(!behind.is_empty() && behind.iter().all(|setpoint| setpoint.velocity.axes == [0.0; 6]));
}

#[test]
fn drives_that_go_off_by_themselves_are_a_fault() {
    let (mut controller, _) = turning(|cycle, feedback| match cycle < AT_SPEED {
        true => feedback,
        false => feedback.with_drives(Drives::Off),
    });
    let (number, _, text) = outcome(&mut controller);
    assert_eq!((number, &*text), (20072, "the drives of the robot are off, though nobody switched them off"));
}

#[test]
fn a_robot_that_never_settles_is_not_waited_for() {
    let (mut controller, heard) = turning(|cycle, feedback| {
        let mut position = feedback.position.unwrap();
        position.axes[1] += if cycle % 2 == 0 { 0.01 } else { -0.01 };
        Feedback::at(position)
    });
    let (number, _, text) = outcome(&mut controller);
    assert_eq!(
        (number, &*text),
        (
            20073,
            "the robot has not settled at its set-point within 2 s: j2 is 0.0100 deg away; up to 0.001 deg counts as settled"
        )
    );
    assert_eq!(heard.borrow().switched, [(Power::Off, 0.0)]);
}

#[test]
fn how_near_is_near_enough_says_the_robot_file() {
    let text = Robot::text("kr10-r1420").unwrap().to_owned() + "\n[drives]\nsettled = 0.02\n";
    let robot = Robot::parse("robot.toml", &text).unwrap();
    let restless: Script = |cycle, feedback| {
        let mut position = feedback.position.unwrap();
        position.axes[1] += if cycle % 2 == 0 { 0.01 } else { -0.01 };
        Feedback::at(position)
    };
    let (mut controller, _) = turning_with(restless, |builder| builder.robot(robot));
    assert_eq!(controller.run(), Outcome::Ended);
}

#[test]
fn torques_that_are_no_numbers_are_no_feedback() {
    let (mut controller, heard) = turning(|cycle, feedback| {
        let second = if cycle < AT_SPEED { 100.0 } else { f64::NAN };
        feedback.with_torque([0.0, second, 0.0, 0.0, 0.0, 0.0])
    });
    let (number, _, text) = outcome(&mut controller);
    assert_eq!((number, &*text), (20071, "a motor torque that the robot reports is not a number"));
    assert_eq!(heard.borrow().switched, [(Power::Off, 0.0)]);
    keep_limits(&heard.borrow());
}

#[test]
fn measured_speeds_count_in_place_of_differences() {
    // It says that it turns, though it stays: whoever switches it on again waits until it says that it rests.
    let (mut controller, heard) = turning(|cycle, feedback| {
        let mut speed = Joints { axes: [0.0; 6], external: [0.0; 6] };
        speed.axes[0] = if (3000..3500).contains(&cycle) { 50.0 } else { 0.0 };
        feedback.with_velocity(speed)
    });
    controller.run_for(1.0);
    controller.press(arl_rt::io::Pendant::ServoOff);
    controller.run_for(2.2);
    controller.press(arl_rt::io::Pendant::ServoOn);
    controller.step();
    assert_eq!(heard.borrow().switched, [(Power::Off, 0.0)]);
    controller.run_for(0.5);
    controller.press(arl_rt::io::Pendant::ServoOn);
    controller.step();
    assert_eq!(heard.borrow().switched, [(Power::Off, 0.0), (Power::On, 0.0)]);
}

#[test]
fn an_emergency_stop_reaches_a_robot_that_is_off() {
    let (mut controller, heard) = turning(|_, feedback| feedback);
    controller.run_for(1.0);
    controller.press(arl_rt::io::Pendant::ServoOff);
    controller.run_for(2.0);
    controller.emergency_stop();
    controller.step();
    assert_eq!(heard.borrow().switched, [(Power::Off, 0.0), (Power::Cut, 0.0)]);
}

#[test]
fn a_robot_that_was_let_go_is_called_no_more() {
    let (mut controller, heard) = turning(|_, feedback| feedback);
    controller.run_for(AT_SPEED as f64 * 0.001);
    controller.close_robots();
    let before = heard.borrow().cycle;
    controller.emergency_stop();
    controller.run_for(0.1);
    drop(controller);
    let heard = heard.borrow();
    // It moved: it was cut off, once, and closed, once.
    assert!(matches!(heard.switched[..], [(Power::Cut, speed)] if speed > 100.0), "{:?}", heard.switched);
    assert_eq!((heard.cycle, heard.closed), (before, 1));
}

#[test]
fn motors_go_off_at_rest_and_come_on_when_they_say_so() {
    let (mut controller, heard) = turning(|cycle, feedback| {
        // After they are switched on, the drives take 0.3 s.
        let on = AT_SPEED + 2000;
        if (on + 1..on + 300).contains(&cycle) { feedback.with_drives(Drives::Off) } else { feedback }
    });
    controller.run_for(AT_SPEED as f64 * 0.001);
    controller.press(arl_rt::io::Pendant::ServoOff);
    controller.step();
    assert_eq!(heard.borrow().switched, [], "it moves still");
    controller.run_for(1.999);
    assert_eq!(heard.borrow().switched, [(Power::Off, 0.0)]);
    assert_eq!(controller.state(), State::Paused);
    keep_limits(&heard.borrow());
    controller.press(arl_rt::io::Pendant::ServoOn);
    controller.step();
    controller.press(arl_rt::io::Pendant::Start);
    controller.step();
    assert_eq!(controller.state(), State::Paused, "the drives are not on yet");
    controller.run_for(0.4);
    controller.press(arl_rt::io::Pendant::Start);
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(heard.borrow().switched, [(Power::Off, 0.0), (Power::On, 0.0)]);
    assert!((controller.joints().axes[0] - 90.0).abs() < 1e-6);
}

/// A robot at rest within its motion whose motors were switched off and on, and do not come on.
fn coming_on_for_ever() -> (Controller, Rc<RefCell<Heard>>) {
    let (mut controller, heard) =
        turning(|cycle, feedback| if cycle > 3000 { feedback.with_drives(Drives::Off) } else { feedback });
    controller.run_for(1.0);
    controller.press(arl_rt::io::Pendant::ServoOff);
    controller.run_for(2.0);
    controller.press(arl_rt::io::Pendant::ServoOn);
    (controller, heard)
}

#[test]
fn motors_that_do_not_come_on_are_a_fault() {
    let (mut controller, _) = coming_on_for_ever();
    let (number, _, text) = outcome(&mut controller);
    assert_eq!((number, &*text), (20072, "the drives of the robot have not come on within 5 s"));
}

#[test]
fn servo_on_before_rest_takes_servo_off_back() {
    let (mut controller, heard) = turning(|_, feedback| feedback);
    controller.run_for(AT_SPEED as f64 * 0.001);
    controller.press(arl_rt::io::Pendant::ServoOff);
    controller.run_for(0.02);
    controller.press(arl_rt::io::Pendant::ServoOn);
    controller.press(arl_rt::io::Pendant::Start);
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(heard.borrow().switched, []);
    keep_limits(&heard.borrow());
}

#[test]
fn an_emergency_stop_cuts_the_power_at_speed_and_the_program_goes_on_from_its_path() {
    let (mut controller, heard) = turning(|_, feedback| feedback);
    controller.run_for(AT_SPEED as f64 * 0.001);
    controller.emergency_stop();
    controller.step();
    {
        let heard = heard.borrow();
        let (power, speed) = heard.switched[0];
        assert!(heard.switched.len() == 1 && power == Power::Cut && speed > 100.0, "{:?}", heard.switched);
        assert_eq!(heard.setpoints.last().unwrap().velocity.axes, [0.0; 6]);
    }
    // The motion behind it stops, too: only then the motors may come on.
    controller.press(arl_rt::io::Pendant::ServoOn);
    controller.step();
    assert_eq!(heard.borrow().switched.len(), 1);
    assert!(controller.take_warnings().iter().any(|warning| warning.contains("servo on is refused")));
    controller.run_for(2.0);
    let stopped = controller.joints().axes[0];
    assert!(stopped > 5.0 && stopped < 85.0, "{stopped}");
    assert_eq!(controller.state(), State::Paused);
    controller.press(arl_rt::io::Pendant::ServoOn);
    controller.step();
    let first = heard.borrow().setpoints.last().unwrap().position.axes[0];
    assert!((first - stopped).abs() < 1e-9, "no step: {first} and {stopped}");
    controller.step();
    controller.press(arl_rt::io::Pendant::Start);
    assert_eq!(controller.run(), Outcome::Ended);
    assert!((controller.joints().axes[0] - 90.0).abs() < 1e-6);
}

#[test]
fn after_a_fault_the_robot_is_switched_on_again_where_it_is() {
    let (mut controller, heard) =
        turning(|cycle, feedback| if (AT_SPEED..4000).contains(&cycle) { Feedback::none() } else { feedback });
    controller.run();
    while controller.time() < 4.5 {
        controller.step();
    }
    controller.press(arl_rt::io::Pendant::Clear);
    controller.press(arl_rt::io::Pendant::ServoOn);
    controller.step();
    controller.step();
    controller.press(arl_rt::io::Pendant::Reset);
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(heard.borrow().switched, [(Power::Off, 0.0), (Power::On, 0.0)]);
    assert!((controller.joints().axes[0] - 90.0).abs() < 1e-6);
}

#[test]
fn axes_that_are_not_there_do_not_count() {
    let (mut controller, _) = turning(|_, feedback| {
        let position = feedback.position.unwrap();
        Feedback::at(Joints { external: [0.0; 6], ..position })
    });
    assert_eq!(controller.run(), Outcome::Ended);
}

#[test]
fn a_run_with_an_emergency_stop_ends() {
    let run = |with: fn(&mut Controller)| {
        let (mut controller, _) = controller(Controller::builder(), |cx| {
            Box::pin(async move { motion::movej(bent(90.0)).vp(100.0).run(cx).await.at(FILE, 1) })
        });
        controller.run_for(0.5);
        controller.emergency_stop();
        controller.run_for(0.01);
        with(&mut controller);
        controller.run()
    };
    assert!(matches!(run(|_| {}), Outcome::Standstill(_)));
    assert_eq!(run(Controller::stop), Outcome::Stopped);
}

#[test]
fn drives_that_fail_after_another_fault_are_cut_off_too() {
    let (mut controller, heard) = turning(|cycle, feedback| match cycle {
        0..AT_SPEED => feedback,
        _ if cycle < AT_SPEED + 60 => Feedback::none(),
        _ => Feedback::none().with_drives(Drives::Fault("E07".into())),
    });
    let (number, ..) = outcome(&mut controller);
    assert_eq!(number, 20071);
    let heard = heard.borrow();
    let (power, speed) = heard.switched[0];
    assert!(heard.switched.len() == 1 && power == Power::Cut && speed > 10.0, "{:?}", heard.switched);
}

#[test]
fn motors_are_switched_off_while_they_come_on() {
    let (mut controller, heard) = coming_on_for_ever();
    controller.run_for(0.5);
    controller.press(arl_rt::io::Pendant::ServoOff);
    controller.run_for(6.0);
    assert_eq!(heard.borrow().switched, [(Power::Off, 0.0), (Power::On, 0.0), (Power::Off, 0.0)]);
    assert_eq!(controller.state(), State::Paused);
}

#[test]
fn a_controller_that_is_dropped_at_speed_cuts_the_power() {
    let (mut controller, heard) = turning(|_, feedback| feedback);
    controller.run_for(AT_SPEED as f64 * 0.001);
    drop(controller);
    let heard = heard.borrow();
    assert_eq!((heard.switched[0].0, heard.switched.len(), heard.closed), (Power::Cut, 1, 1));
}

#[test]
fn motors_come_on_only_where_it_is_known_where_the_robot_is() {
    let (mut controller, heard) =
        turning(|cycle, feedback| if (AT_SPEED..4000).contains(&cycle) { Feedback::none() } else { feedback });
    controller.run();
    controller.press(arl_rt::io::Pendant::ServoOn);
    controller.step();
    assert!(controller.take_warnings().iter().any(|warning| warning.contains("no position feedback from the robot")));
    assert_eq!(heard.borrow().switched, [(Power::Off, 0.0)]);
}

/// A robot that cannot be had.
struct Nowhere(Result<f64, &'static str>);

impl RobotDriver for Nowhere {
    fn start(&mut self, start: &Start<'_>) -> Result<Joints, DriverError> {
        let at = self.0?;
        Ok(Joints { axes: [at; 6], ..*start.home })
    }

    fn exchange(&mut self, setpoint: &Setpoint) -> Feedback {
        Feedback::at(setpoint.position)
    }

    fn switch(&mut self, _power: Power) -> Drives {
        Drives::On
    }
}

#[test]
fn a_robot_that_does_not_start_is_no_controller() {
    let refused = |driver: Nowhere| {
        let script = script(|_| Box::pin(async { Ok(()) }));
        Controller::builder().robot_driver(driver).build(Box::new(script)).err().unwrap().to_string()
    };
    let problem = refused(Nowhere(Err("no answer from 10.0.0.2:49152")));
    assert_eq!(problem, "the robot of channel 1 cannot be started: no answer from 10.0.0.2:49152");
    assert!(refused(Nowhere(Ok(f64::NAN))).contains("the position that the robot reports for j1 is not a number"));
    let outside = refused(Nowhere(Ok(500.0)));
    let why = "the robot reports j1 at 500.000 deg, outside of its range of -170 to 170 deg";
    assert!(outside.contains(why) && outside.contains("does the robot file match this robot?"), "{outside}");
}

#[test]
fn a_robot_that_leaves_its_range_is_an_alarm_at_once() {
    let (mut controller, heard) = turning(|cycle, feedback| changed(cycle, feedback, 500.0));
    let (number, line, text) = outcome(&mut controller);
    assert_eq!((number, line), (20070, 2), "{text}");
    assert!(text.starts_with("the robot does not follow: j3 is "), "{text}");
    keep_limits(&heard.borrow());
}

/// Axis 3 is at 500 deg in some of the cycles in which the motors are off.
fn pushed_away(from: u64, to: u64) -> (Controller, Rc<RefCell<Heard>>) {
    thread_local!(static WHEN: std::cell::Cell<(u64, u64)> = const { std::cell::Cell::new((0, 0)) });
    WHEN.set((from, to));
    let (mut controller, heard) = turning(|cycle, feedback| {
        let (from, to) = WHEN.get();
        let mut position = feedback.position.unwrap();
        if (from..to).contains(&cycle) {
            position.axes[2] = 500.0;
        }
        // The drives come on 0.3 s after they were told to.
        let drives = if (3000..3300).contains(&cycle) { Drives::Off } else { Drives::On };
        Feedback::at(position).with_drives(drives)
    });
    controller.run_for(1.0);
    controller.press(arl_rt::io::Pendant::ServoOff);
    controller.run_for(2.0);
    controller.press(arl_rt::io::Pendant::ServoOn);
    controller.step();
    (controller, heard)
}

#[test]
fn motors_come_on_only_where_the_axes_can_be() {
    let (mut controller, heard) = pushed_away(2500, 4000);
    let warnings = controller.take_warnings();
    assert!(
        warnings.iter().any(|warning| warning.contains("servo on is refused: the robot reports j3 at 500.000 deg"))
    );
    assert_eq!(heard.borrow().switched, [(Power::Off, 0.0)], "{warnings:?}");
    // Where it is there while they come on, it is not asked to stay there.
    let (mut controller, heard) = pushed_away(3100, 4000);
    let (number, _, text) = outcome(&mut controller);
    assert_eq!((number, &text[..38]), (20070, "the robot reports j3 at 500.000 deg, o"));
    assert_eq!(heard.borrow().switched.last(), Some(&(Power::Off, 0.0)));
}

#[test]
fn set_points_have_torques_where_they_are_wanted_and_deadlines_where_time_is_real() {
    let run = |torques: bool, real: bool| {
        let heard = Rc::<RefCell<Heard>>::default();
        let driver = Scripted {
            robot: SimulatedRobot::new(),
            heard: Rc::clone(&heard),
            script: |_, feedback| feedback,
            torques,
        };
        let mut builder = Controller::builder().robot_driver(driver);
        if real {
            builder = builder.clock(RealClock::new());
        }
        let (mut controller, _) = controller(builder, |cx| {
            Box::pin(async move { motion::movej(bent(1.0)).vp(100.0).run(cx).await.at(FILE, 1) })
        });
        controller.run_for(0.02);
        drop(controller);
        let heard = Rc::try_unwrap(heard).ok().unwrap().into_inner();
        heard.setpoints
    };
    let simulated = run(true, false);
    assert!(simulated.iter().all(|setpoint| setpoint.deadline.is_none()));
    // Axis 2 holds the arm.
    assert!(simulated.iter().all(|setpoint| setpoint.torque.unwrap()[1].abs() > 10.0));
    let real = run(false, true);
    assert!(real.iter().all(|setpoint| setpoint.torque.is_none()));
    let apart = |pair: &[Setpoint]| pair[1].deadline.unwrap().duration_since(pair[0].deadline.unwrap()).as_secs_f64();
    // A busy computer may lose some.
    let is_on_grid = |apart: f64| apart > 0.0009 && (apart / 0.001 - (apart / 0.001).round()).abs() < 1e-3;
    assert!(real.windows(2).all(|pair| is_on_grid(apart(pair))));
}

/// A clock that loses so many cycles at speed, in two that are some cycles apart.
#[derive(Default)]
struct Losing {
    each: u64,
    apart: u64,
    /// They were never sent.
    missing: bool,
    lateness: Lateness,
}

impl Clock for Losing {
    fn wait_for(&mut self, cycle: u64, _period: f64) {
        if cycle == AT_SPEED || cycle == AT_SPEED + self.apart {
            match self.missing {
                true => self.lateness.note_missing(self.each),
                false => self.lateness.note_lost(self.each),
            }
        }
    }

    fn is_real(&self) -> bool {
        false
    }

    fn lateness(&self) -> Option<&Lateness> {
        Some(&self.lateness)
    }
}

fn losing(each: u64, apart: u64) -> Losing {
    Losing { each, apart, ..Losing::default() }
}

#[test]
fn a_computer_that_loses_cycles_stops_its_robot() {
    let (mut controller, heard) = turning_with(|_, feedback| feedback, |builder| builder.clock(losing(11, 40)));
    let (number, line, text) = outcome(&mut controller);
    assert_eq!((number, line), (20074, 2), "{text}");
    assert_eq!(text, "the computer was too busy: 22 control cycles were lost within a second");
    assert_eq!(controller.lateness().map(|lateness| (lateness.late(), lateness.lost())), Some((2, 22)));
    let heard = heard.borrow();
    keep_limits(&heard);
    let last = heard.setpoints.last().unwrap();
    // It stands on its path, with its motors on.
    assert!(last.velocity.axes[0] == 0.0 && last.position.axes[0] < 89.0, "{last:?}");
    assert!(heard.switched.is_empty());
}

#[test]
fn what_was_never_sent_is_not_the_computers_fault() {
    let clock = Losing { missing: true, ..losing(11, 40) };
    let (mut controller, heard) = turning_with(|_, feedback| feedback, |builder| builder.clock(clock));
    let (number, line, text) = outcome(&mut controller);
    assert_eq!((number, line), (20074, 2), "{text}");
    assert_eq!(text, "messages from the robot did not arrive: 22 control cycles were lost within a second");
    let lateness = controller.lateness().unwrap();
    assert_eq!((lateness.late(), lateness.lost(), lateness.missing()), (0, 22, 22));
    keep_limits(&heard.borrow());
}

#[test]
fn few_cycles_that_are_lost_are_no_fault_and_a_cell_says_how_many() {
    let lost = |each, limit| {
        let cell = Cell { late: LateCycles { limit, ..LateCycles::default() }, ..Cell::default() };
        turning_with(|_, feedback| feedback, |builder| builder.clock(losing(each, 40)).cell(cell)).0
    };
    assert_eq!(lost(10, None).run(), Outcome::Ended);
    assert_eq!(lost(50, Some(100)).run(), Outcome::Ended);
    assert_eq!(outcome(&mut lost(2, Some(3))).0, 20074);
    // A robot that is simulated does not mind, unless somebody asks for it.
    let simulated = |limit| {
        let cell = Cell { late: LateCycles { limit, ..LateCycles::default() }, ..Cell::default() };
        let builder = Controller::builder().clock(losing(500, 1)).cell(cell);
        controller(builder, |cx| Box::pin(async move { motion::movej(bent(90.0)).vp(20.0).run(cx).await.at(FILE, 1) }))
            .0
    };
    assert_eq!(simulated(None).run(), Outcome::Ended);
    assert_eq!(outcome(&mut simulated(Some(20))).0, 20074);
}

#[test]
fn a_robot_file_says_how_far_behind_is_too_far() {
    let text = Robot::text("kr10-r1420").unwrap();
    let limits = |text: &str| Robot::parse("a.toml", text).unwrap().drives.clone();
    let default = limits(text);
    assert_eq!((default.feedback, default.settling, default.following.len()), (0.02, 2.0, 6));
    let given = text.replacen("[[axis]]", "[drives]\nfeedback = 50\nsettling = 500\n\n[[axis]]\nfollowing = 3.5", 1);
    let given = limits(&given);
    assert_eq!((given.feedback, given.settling, given.following[0]), (0.05, 0.5, 3.5));
    assert_eq!(given.following[1..], default.following[1..]);
    for (what, words) in [
        ("following = 0", "a distance in deg (mm) from its set-point"),
        ("following = \"a\"", "a distance in deg (mm) from its set-point"),
    ] {
        let error = Robot::parse("a.toml", &text.replacen("[[axis]]", &format!("[[axis]]\n{what}"), 1)).unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
    }
}
