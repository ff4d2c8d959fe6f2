//! A run that a debugger halts and looks into: what `--debug ADDRESS` of a program is that was emitted for it.
//!
//! The program connects to the debugger, which listens. Requests come in, a line each: a number, a word and what the word
//! takes, with tabs in between. Answers and events go out as JSON objects, a line each: `{"answer":7,..}`, `{"event":..}`.
//!
//! On the virtual clock everything stands still while the program is halted, time, too: the run is the same as without a
//! debugger, to the last bit. In real time the robot stops on its path, as with the pendant's pause button, and cycles go on.

mod answers;
mod debugger;
mod link;
mod plan;

use std::io::Result;
use std::rc::Rc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::context::standstill::Standstill;
use crate::controller::{Controller, Outcome};
use crate::fault;
use crate::io::Pendant;
use debugger::Debugger;
use link::Link;

/// How a run ended that a debugger looked into.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum End {
    /// All programs have ended.
    Over(Outcome),
    /// The time is over.
    MaxTime,
    /// Nothing can change any more, from this time in s on: who waits for what.
    Standstill(f64, Vec<Standstill>),
    /// The debugger is gone, or somebody pressed Ctrl-C.
    Interrupted,
}

/// Runs as the debugger says that listens at an address. `say` passes on what came up in a cycle.
///
/// # Errors
/// No debugger listens there.
pub(crate) fn drive(
    controller: &mut Controller,
    address: &str,
    max_time: Option<f64>,
    interrupted: &AtomicBool,
    say: fn(&mut Controller),
) -> Result<End> {
    let debugger = Rc::new(Debugger::new(Link::connect(address)?, controller.is_real()));
    let of_alarms = Rc::clone(&debugger);
    fault::listen(Rc::new(move |alarm| of_alarms.alarm_came_up(alarm)));
    controller.watch(Rc::<Debugger>::clone(&debugger));
    let last = max_time.map_or(u64::MAX, |seconds| controller.cycles(seconds));
    let mut end = None;
    let mut pauses = false;
    debugger.begin(controller.contexts());
    loop {
        let over = if end.is_some() { controller.outcome().is_some() } else { controller.is_over() };
        if over {
            break;
        }
        debugger.cycle_begins(controller.contexts());
        if debugger.is_halted() != pauses {
            pauses = debugger.is_halted();
            controller.press(if pauses { Pendant::Pause } else { Pendant::Start });
        }
        if end.is_none() && (debugger.is_gone() || interrupted.load(Ordering::Relaxed)) {
            end = Some(End::Interrupted);
            controller.stop();
        } else if end.is_none() && controller.cycle() >= last {
            end = Some(End::MaxTime);
            controller.stop();
        }
        controller.step();
        say(controller);
        if end.is_none()
            && !pauses
            && let Some(waiting) = controller.standstill()
        {
            end = Some(End::Standstill(controller.time(), waiting));
            controller.stop();
        }
    }
    controller.settle_state();
    say(controller);
    debugger.end(controller.contexts());
    Ok(end.unwrap_or_else(|| End::Over(controller.outcome().cloned().unwrap_or(Outcome::Stopped))))
}
