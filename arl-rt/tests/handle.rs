//! Other threads and a controller: what they ask, what they hear, and what becomes of them when it is gone.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests may fail")]

mod common;

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, mpsc};
use std::thread;
use std::time::Duration;

use arl_rt::clock::RealClock;
use arl_rt::emit::*;
use arl_rt::fault::Reason;
use arl_rt::io::Pendant;
use arl_rt::motion::Joints;
use arl_rt::output::Event;
use arl_rt::robot_driver::{Drives, Feedback, Power, RobotDriver, Setpoint, Start};
use arl_rt::status::{HandleError, Status};
use arl_rt::{Alarm, Controller, Handle, Outcome, Robot, Running, SetupError, State};
use common::{FILE, bent, plain, say, script};

/// Waits for an input, says so, and divides by what the analog input has.
fn wait_and_divide(cx: &Cx) -> BoxFuture<'_> {
    Box::pin(async move {
        while !io::getdi(cx, 1).await.at(FILE, 1)? {
            flow::waittime(0.001).run(cx).await.at(FILE, 1)?;
        }
        io::setdo(cx, 2, true).await.at(FILE, 2)?;
        say(cx, &"heard")?;
        let divisor = io::getai(cx, 1).await.at(FILE, 3)? as i32;
        say(cx, &div(12, divisor).at(FILE, 3)?)
    })
}

/// In real time, in a thread of its own.
fn spawned() -> Running {
    Controller::spawn(|| Controller::builder().clock(RealClock::new()).build(Box::new(script(wait_and_divide))))
        .unwrap()
}

#[test]
fn what_threads_share_can_be_sent() {
    fn sent<T: Send + 'static>() {}
    fn shared<T: Send + Sync + Clone + 'static>() {}
    shared::<Handle>();
    sent::<Running>();
    sent::<Event>();
    sent::<Status>();
    sent::<Outcome>();
    sent::<Reason>();
    sent::<Alarm>();
    sent::<SetupError>();
    sent::<HandleError>();
}

#[test]
fn a_thread_sets_inputs_and_hears_what_happens() {
    let running = spawned();
    let handle = running.handle();
    let events = handle.events().unwrap();
    assert!(!handle.dout(2).unwrap());
    handle.set_ai(1, 4.0).unwrap();
    handle.set_di(1, true).unwrap();
    assert_eq!(running.join(), Outcome::Ended);
    let events: Vec<Event> = events.iter().collect();
    let texts: Vec<&str> = events
        .iter()
        .filter_map(|event| match event {
            Event::Message { text, .. } => Some(&**text),
            _ => None,
        })
        .collect();
    assert_eq!(texts, ["heard", "3"]);
    assert_eq!(events.last(), Some(&Event::State(State::Ended)), "{events:?}");
    assert_eq!(handle.status(), Err(HandleError::Gone));
}

#[test]
fn alarms_and_warnings_are_heard() {
    let running = spawned();
    let handle = running.handle();
    let events = handle.events().unwrap();
    handle.press(Pendant::Reset).unwrap();
    handle.order("di.1 = true").unwrap();
    let outcome = running.join();
    let Outcome::Alarm(alarm) = &outcome else { panic!("{outcome}") };
    let events: Vec<Event> = events.iter().collect();
    assert!(events.contains(&Event::Alarm(alarm.clone())), "{events:?}");
    let refused = |event: &Event| matches!(event, Event::Warning(text) if text.starts_with("reset is refused"));
    assert!(events.iter().any(refused), "{events:?}");
}

#[test]
fn wrong_questions_are_answered_with_why() {
    let running = spawned();
    let handle = running.handle();
    assert!(matches!(handle.set_di(4711, true), Err(HandleError::Fault(_))));
    assert!(matches!(handle.ao(0), Err(HandleError::Fault(_))));
    let Err(HandleError::Order(why)) = handle.order("di.1 = maybe") else { panic!("it was taken") };
    assert!(why.contains("maybe") || why.contains("true"), "{why}");
    assert_eq!(running.stop(), Outcome::Stopped);
}

#[test]
fn programs_stop_where_nobody_has_them_any_more() {
    let running = spawned();
    let handle = running.handle();
    drop(running);
    assert_eq!(handle.stop(), Err(HandleError::Gone));
}

/// Goes to and fro without end.
fn swing(cx: &Cx) -> BoxFuture<'_> {
    Box::pin(async move {
        for turn in 0.. {
            let target = bent(if turn % 2 == 0 { 80.0 } else { -80.0 });
            motion::movej(target).run(cx).await.at(FILE, 1)?;
        }
        Ok(())
    })
}

/// A robot that does what it is told, and writes down how fast j1 was last, in deg/s, and whether its power was cut.
#[derive(Clone, Default)]
struct Watched(Arc<Mutex<(f64, bool)>>);

impl RobotDriver for Watched {
    fn start(&mut self, start: &Start<'_>) -> Result<Joints, String> {
        Ok(*start.home)
    }

    fn exchange(&mut self, setpoint: &Setpoint) -> Feedback {
        self.0.lock().unwrap().0 = setpoint.velocity.axes[0];
        Feedback::at(setpoint.position)
    }

    fn switch(&mut self, power: Power) -> Drives {
        self.0.lock().unwrap().1 |= power == Power::Cut;
        if power == Power::On { Drives::On } else { Drives::Off }
    }
}

#[test]
fn a_robot_comes_to_rest_on_its_path_when_nobody_has_it_any_more() {
    let robot = Watched::default();
    let driver = robot.clone();
    let running = Controller::spawn(move || {
        let builder = Controller::builder().clock(RealClock::new()).robot_driver(driver);
        builder.build(Box::new(script(swing)))
    });
    let running = running.unwrap();
    while robot.0.lock().unwrap().0 == 0.0 {
        thread::yield_now();
    }
    drop(running);
    assert_eq!(*robot.0.lock().unwrap(), (0.0, false));
}

#[test]
fn what_nobody_did_in_time_is_never_done() {
    let mut controller = plain(Controller::builder(), wait_and_divide);
    let handle = controller.handle().patience(Duration::from_millis(1));
    let done = Arc::new(AtomicBool::new(false));
    let doing = Arc::clone(&done);
    let asked = thread::spawn(move || handle.ask(move |_| doing.store(true, Ordering::Relaxed)));
    assert_eq!(asked.join().unwrap(), Err(HandleError::NotStepped));
    controller.step();
    assert!(!done.load(Ordering::Relaxed));
}

#[test]
fn what_is_asked_is_done_in_its_order_between_two_cycles() {
    let mut controller = plain(Controller::builder(), wait_and_divide);
    let handle = controller.handle();
    let (tell, told) = mpsc::channel();
    let asking = thread::spawn(move || {
        for number in 0..200_u32 {
            tell.send(handle.ask(move |controller| (number, controller.time())).unwrap()).unwrap();
        }
    });
    while !asking.is_finished() {
        controller.step();
    }
    let told: Vec<(u32, f64)> = told.iter().collect();
    assert!(told.iter().map(|(number, _)| *number).eq(0..200));
    assert!(told.is_sorted_by(|a, b| a.1 < b.1), "a thread has one answer a cycle: {told:?}");
}

#[test]
fn a_program_that_waits_is_no_standstill_while_somebody_may_ask() {
    let mut controller = plain(Controller::builder(), wait_and_divide);
    let handle = controller.handle();
    controller.press(Pendant::Pause);
    controller.run_for(3.0);
    assert_eq!(controller.standstill(), None);
    drop(handle);
    assert!(controller.standstill().is_some());
}

#[test]
fn a_controller_that_cannot_be_made_says_why() {
    let other = || {
        let robot = Robot::builtin("cobra600")?;
        Controller::builder().robot(robot).build(Box::new(script(wait_and_divide)))
    };
    let error = Controller::spawn(other).unwrap_err();
    assert!(error.to_string().contains("six-axis"), "{error}");
}
