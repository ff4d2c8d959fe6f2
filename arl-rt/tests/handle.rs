//! Other threads and a controller: what they ask, what they hear, and what becomes of them when it is gone.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests may fail")]

mod common;

use std::cell::RefCell;
use std::rc::Rc;
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
use arl_rt::robot_driver::{DriverError, Drives, Feedback, Power, RobotDriver, Setpoint, Start};
use arl_rt::status::{HandleError, Status};
use arl_rt::{Alarm, Controller, Foreground, Handle, Message, Outcome, Robot, Running, SetupError, State};
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
    assert!(!handle.digital_output(2).unwrap());
    handle.set_analog_input(1, 4.0).unwrap();
    handle.set_digital_input(1, true).unwrap();
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
    assert!(matches!(handle.set_digital_input(4711, true), Err(HandleError::Fault(_))));
    assert!(matches!(handle.analog_output(0), Err(HandleError::Fault(_))));
    let Err(HandleError::Order(why)) = handle.order("di.1 = maybe") else { panic!("it was taken") };
    let why = why.to_string();
    assert!(why.contains("maybe") || why.contains("true"), "{why}");
    assert_eq!(running.stop(), Outcome::Stopped);
}

#[test]
fn a_thread_that_is_the_controllers_own_does_not_wait_for_itself() {
    let answers = Rc::new(RefCell::new(Vec::new()));
    let (kept, handle) = (Rc::clone(&answers), Rc::new(RefCell::new(None::<Handle>)));
    let asking = Rc::clone(&handle);
    let builder = Controller::builder().output(move |_: &Message<'_>| {
        let answer = asking.borrow().as_ref().map(|handle| handle.digital_output(2));
        kept.borrow_mut().extend(answer);
    });
    let mut controller = plain(builder, wait_and_divide);
    *handle.borrow_mut() = Some(controller.handle());
    controller.set_digital_input(1, true).unwrap();
    controller.run_for(0.1);
    assert_eq!(answers.borrow().first(), Some(&Err(HandleError::OwnThread)));
}

#[test]
fn a_question_that_panics_costs_who_asked_alone() {
    let running = spawned();
    let handle = running.handle();
    assert_eq!(handle.ask(|_| panic!("as it is meant to")), Err::<(), _>(HandleError::Panicked));
    handle.set_analog_input(1, 4.0).unwrap();
    handle.set_digital_input(1, true).unwrap();
    assert_eq!(running.join(), Outcome::Ended);
}

#[test]
fn a_question_may_step_and_time_goes_on() {
    let mut controller = plain(Controller::builder(), wait_and_divide);
    let handle = controller.handle();
    let asking = thread::spawn(move || {
        let inside = handle.ask(|controller| {
            controller.run_for(0.5);
            controller.time()
        });
        (inside, handle.ask(|controller| controller.time()))
    });
    while !asking.is_finished() {
        controller.step();
    }
    let (inside, after) = asking.join().unwrap();
    assert!(after.unwrap() > inside.unwrap());
}

fn divide_by_zero(cx: &Cx) -> BoxFuture<'_> {
    Box::pin(async move { say(cx, &div(12, 0).at(FILE, 1)?) })
}

#[test]
fn events_come_from_the_very_start() {
    let (tell, events) = mpsc::channel();
    let make = move || Controller::builder().events(tell).build(Box::new(script(divide_by_zero)));
    let outcome = Controller::spawn(make).unwrap().join();
    let Outcome::Alarm(alarm) = outcome else { panic!("{outcome}") };
    let events: Vec<Event> = events.iter().collect();
    assert_eq!(events, [Event::Alarm(alarm), Event::State(State::Ended)]);
}

#[test]
fn a_program_that_begins_anew_is_reported_even_if_it_ends_at_once() {
    let (tell, events) = mpsc::channel();
    let mut controller = plain(Controller::builder().events(tell), |_| Box::pin(async { Ok(()) }));
    controller.run();
    controller.reset().unwrap();
    controller.run();
    let states: Vec<Event> = events.try_iter().collect();
    assert_eq!(states, [State::Ended, State::Running, State::Ended].map(Event::State));
}

#[test]
fn a_program_that_has_ended_begins_anew_until_somebody_waits_for_its_end() {
    let running = spawned();
    let handle = running.handle();
    let events = handle.events().unwrap();
    let ended = || events.iter().any(|event| event == Event::State(State::Ended));
    handle.set_analog_input(1, 4.0).unwrap();
    handle.set_digital_input(1, true).unwrap();
    assert!(ended());
    handle.press(Pendant::Reset).unwrap();
    assert!(ended());
    assert_eq!(running.join(), Outcome::Ended);
}

#[test]
fn who_waits_for_the_end_of_what_waits_in_vain_gets_a_standstill() {
    let make = || Controller::builder().build(Box::new(script(wait_forever)));
    let outcome = Controller::spawn(make).unwrap().join();
    assert!(matches!(&outcome, Outcome::Standstill(waiting) if waiting.len() == 1), "{outcome}");
}

/// Pauses itself: nobody presses start.
fn wait_forever(cx: &Cx) -> BoxFuture<'_> {
    Box::pin(async move { flow::pause().run(cx).await.at(FILE, 1) })
}

/// Loads the other program into channel 1 after half a second.
fn switch(cx: &Cx) -> BoxFuture<'_> {
    Box::pin(async move {
        flow::waittime(0.5).run(cx).await.at(FILE, 1)?;
        channel::switcharl(cx, 1, &Str::literal("other.arl")).await.at(FILE, 2).map(drop)
    })
}

#[test]
fn what_is_stopped_ends_also_while_another_program_is_loaded() {
    for cycle in 495..530 {
        let builder = Controller::builder().background(Box::new(script(switch)));
        let mut controller = plain(builder.loadable("other.arl", || Box::new(script(swing))), swing);
        controller.run_for(f64::from(cycle) * 0.001);
        controller.stop();
        controller.run_for(5.0);
        assert_eq!(controller.outcome(), Some(&Outcome::Stopped), "stopped in cycle {cycle}");
    }
}

#[test]
fn what_is_stopped_ends_also_where_somebody_resets_programs_that_have_ended() {
    let running = Controller::spawn(|| {
        let second = Foreground::new(Box::new(script(wait_and_divide)));
        let builder = Controller::builder().clock(RealClock::new()).foreground(second);
        builder.build(Box::new(script(swing)))
    });
    let running = running.unwrap();
    let handle = running.handle();
    // Channel 2 has ended while channel 1 comes to rest: a reset lets it begin anew.
    let resetting = thread::spawn(move || while handle.press(Pendant::Reset).is_ok() {});
    thread::sleep(Duration::from_millis(100));
    assert_eq!(running.stop(), Outcome::Stopped);
    resetting.join().unwrap();
}

#[test]
fn an_alarm_stays_the_outcome_of_what_is_stopped_after_it() {
    let mut controller = plain(Controller::builder(), |cx| {
        Box::pin(async move {
            motion::movej(bent(80.0)).run(cx).await.at(FILE, 1)?;
            // The robot is under way then.
            for _ in 0..100 {
                cx.next_cycle().await;
            }
            say(cx, &div(12, 0).at(FILE, 3)?)
        })
    });
    controller.run_for(0.11);
    assert_eq!((controller.take_alarms().len(), controller.outcome()), (1, None));
    controller.stop();
    let outcome = controller.run();
    assert!(matches!(outcome, Outcome::Alarm(_)), "{outcome}");
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
    fn start(&mut self, start: &Start<'_>) -> Result<Joints, DriverError> {
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
    let (sender, answers) = mpsc::channel();
    let asking = thread::spawn(move || {
        for number in 0..200_u32 {
            sender.send(handle.ask(move |controller| (number, controller.time())).unwrap()).unwrap();
        }
    });
    while !asking.is_finished() {
        controller.step();
    }
    let answers: Vec<(u32, f64)> = answers.iter().collect();
    assert!(answers.iter().map(|(number, _)| *number).eq(0..200));
    assert!(answers.is_sorted_by(|a, b| a.1 < b.1), "a thread has one answer a cycle: {answers:?}");
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
