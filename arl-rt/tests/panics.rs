//! What users hand over may panic: it costs what panics, and the controller goes on.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests may fail")]

mod common;

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::rc::Rc;

use arl_rt::emit::*;
use arl_rt::io::{Override, Pendant};
use arl_rt::{Alarm, Controller, Message, Outcome, State};
use common::*;

/// Prints three times, a cycle apart.
fn say_three<'a>(cx: &'a Cx) -> BoxFuture<'a> {
    Box::pin(async move {
        for number in 1..=3 {
            say(cx, &number)?;
            flow::waittime(0.001).run(cx).await.at(FILE, 1)?;
        }
        Ok(())
    })
}

#[test]
fn an_output_that_panics_loses_what_it_was_sent_and_no_more() {
    let heard = Rc::new(Cell::new(0));
    let hearing = Rc::clone(&heard);
    let builder = Controller::builder().output(move |_: &Message<'_>| {
        hearing.set(hearing.get() + 1);
        assert!(hearing.get() != 2, "as it is meant to");
    });
    let mut controller = plain(builder, say_three);
    assert_eq!(controller.run(), Outcome::Ended);
    assert_eq!(heard.get(), 3);
    assert_eq!(controller.take_warnings(), ["the output has panicked: what was reported to it is lost"]);
}

#[test]
fn listeners_that_panic_lose_what_they_were_sent() {
    let builder = Controller::builder()
        .on_alarm(|_: &Alarm| panic!("as it is meant to"))
        .on_warning(|_| panic!("as it is meant to"));
    let mut controller = plain(builder, |_| Box::pin(async { arl_rt::emit::div(1, 0).at(FILE, 1).map(|_| ()) }));
    assert!(matches!(controller.run(), Outcome::Alarm(_)));
    assert_eq!(controller.take_alarms().len(), 1);
    let warnings = controller.take_warnings();
    assert!(warnings.iter().any(|warning| warning.contains("`on_alarm`")), "{warnings:?}");
    assert!(warnings.iter().any(|warning| warning.contains("`on_warning`")), "{warnings:?}");
}

#[test]
fn a_program_that_panics_has_ended_when_the_panic_is_reported() {
    let mut controller = plain(Controller::builder(), |cx| {
        Box::pin(async move {
            flow::waittime(0.002).run(cx).await.at(FILE, 1)?;
            assert!(cx.time() < 0.001, "as it is meant to");
            Ok(())
        })
    });
    let result = catch_unwind(AssertUnwindSafe(|| controller.run_for(0.1)));
    assert!(result.is_err());
    controller.step();
    assert_eq!((controller.state(), controller.outcome()), (State::Ended, Some(&Outcome::Stopped)));
    controller.reset().unwrap();
}

#[test]
fn distances_that_are_none_and_overrides_that_are_none_are_refused() {
    for percent in [f64::NAN, -5.0, 500.0, f64::INFINITY] {
        assert!(Override::from_percent(percent).is_err(), "{percent}");
    }
    let mut controller = plain(Controller::builder(), say_three);
    assert_eq!(controller.run(), Outcome::Ended);
    let before = controller.joints();
    for by in [f64::NAN, f64::INFINITY, 9e9] {
        controller.jog(1, by);
        controller.run_for(0.1);
        assert!(controller.take_warnings()[0].contains("an axis cannot move by"), "{by}");
    }
    controller.press(Pendant::ServoOff);
    for _ in 0..10 {
        controller.step();
    }
    controller.move_by_hand(1, f64::NAN);
    assert!(controller.take_warnings()[0].contains("an axis cannot move by"));
    assert_eq!(controller.joints(), before);
}

#[test]
fn a_condition_that_panics_ends_its_program() {
    let mut controller = plain(Controller::builder(), |cx| {
        Box::pin(async move {
            let panics = async |cx: &Cx| {
                assert!(cx.time() < 0.01, "as it is meant to");
                Ok(false)
            };
            event::interrupt(panics, async |_: &Cx| Ok(())).name(&"odd".into()).run(cx).at(FILE, 1)?;
            flow::waittime(10.0).run(cx).await.at(FILE, 2)
        })
    });
    assert!(catch_unwind(AssertUnwindSafe(|| controller.run())).is_err());
    controller.step();
    assert_eq!(controller.outcome(), Some(&Outcome::Stopped));
}
