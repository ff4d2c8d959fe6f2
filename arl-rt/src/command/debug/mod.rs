//! A run that a debugger halts and inspects: the option `--debug ADDRESS` of a program that was made for this.
//!
//! The program connects to the debugger, which listens. Requests come in, one per line: a number, a word and the
//! arguments of the word, separated by tabs. Answers and events go out as JSON objects, one per line:
//! `{"answer":7,..}`, `{"event":..}`.
//!
//! On the virtual clock everything stands still while the program is halted, including time: the run is the same as
//! without a debugger, to the last bit. In real time the robot stops on its path, as with the pendant's pause button,
//! and cycles go on.

mod answers;
mod debugger;
mod functions;
mod link;
mod plan;

use std::io::Result;
use std::rc::Rc;

use super::between::{Between, CycleOrder};
use crate::controller::Controller;
use crate::fault;
use crate::io::Pendant;
use debugger::Debugger;
use link::DebugLink;

/// Serves the debugger between the cycles of a run.
struct Session {
    debugger: Rc<Debugger>,
    /// Whether it has paused the programs.
    pauses: bool,
}

/// Connects to the debugger that listens at an address, and waits until it lets programs run.
///
/// # Errors
/// No debugger listens there.
pub(crate) fn connect(controller: &Controller, address: &str) -> Result<Box<dyn Between>> {
    let debugger = Rc::new(Debugger::new(DebugLink::connect(address)?, controller.is_real()));
    let of_alarms = Rc::clone(&debugger);
    fault::listen(Rc::new(move |alarm| of_alarms.alarm_came_up(alarm)));
    controller.watch(Rc::<Debugger>::clone(&debugger));
    debugger.begin(controller.contexts());
    Ok(Box::new(Session { debugger, pauses: false }))
}

/// The inside of the program of a channel: the fields of an object with its functions and variables. `None` where there
/// is no such channel.
pub(crate) fn inside(controller: &Controller, channel: usize) -> Option<String> {
    controller.contexts().get(channel).map(|cx| answers::inside(cx))
}

impl Between for Session {
    fn cycle_begins(&mut self, controller: &mut Controller) -> CycleOrder {
        self.debugger.cycle_begins(controller.contexts());
        let halted = self.debugger.is_halted();
        if halted != self.pauses {
            self.pauses = halted;
            controller.press(if halted { Pendant::Pause } else { Pendant::Start });
        }
        match (self.debugger.is_gone(), halted) {
            (true, _) => CycleOrder::Ends,
            (false, true) => CycleOrder::Stands,
            (false, false) => CycleOrder::Runs,
        }
    }

    fn nothing_can_change(&mut self, controller: &mut Controller, waiting: &str) -> bool {
        self.debugger.nothing_can_change(controller.contexts(), waiting)
    }

    fn run_ended(&mut self, controller: &mut Controller) {
        self.debugger.end(controller.contexts());
    }
}
