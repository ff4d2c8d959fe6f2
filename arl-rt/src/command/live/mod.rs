//! A run that another program drives: orders come in, a line each, and what happens goes out, a JSON object a line.
//!
//! This is what `--live` of a compiled program is, and what `arl2rs run --pendant` sits on. Orders are what an event of an
//! io scenario does, in the same words: `di.5 = true`, `ai.2 = 4.2`, `pendant = "pause"`, `override = 50`. When the orders
//! end, the robot stops on its path and the program with it.
//!
//! The first line that goes out is `{"hello":...}`: the channels with their programs, robots and axes, and the names of
//! signals. Then come `state` (20 times a second), `message`, `warning`, `alarm`, and `refused` for an order that could
//! not be carried out.

mod line_writer;
mod orders;

use std::sync::atomic::{AtomicBool, Ordering};

use crate::controller::{Controller, Outcome};
use orders::{Next, Orders};

pub(crate) use line_writer::LineWriter;

/// How often a state goes out, in s.
const STATE_INTERVAL_S: f64 = 0.05;

/// Why a run is over before its program is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Cut {
    /// The orders ended, or somebody pressed Ctrl-C.
    Interrupted,
    /// The time is over.
    MaxTime,
}

/// Steps while orders may come: also after the end of the program, which an order may start again. Says how the program
/// ended last, or why it was stopped.
pub(crate) fn drive(
    controller: &mut Controller,
    voice: &LineWriter,
    max_time: Option<f64>,
    interrupted: &AtomicBool,
) -> Result<Option<Outcome>, Cut> {
    let last = max_time.map_or(u64::MAX, |seconds| controller.cycles(seconds));
    let every = controller.cycles(STATE_INTERVAL_S).max(1);
    let orders = Orders::from_standard_input();
    let mut cut = None;
    voice.hello(controller);
    loop {
        let gone = cut.is_none() && !obey(controller, voice, &orders) || interrupted.load(Ordering::Relaxed);
        let over = cut.is_some() || gone || controller.cycle() >= last;
        if over && controller.outcome().is_some() {
            break;
        }
        if over && cut.is_none() {
            cut = Some(if gone { Cut::Interrupted } else { Cut::MaxTime });
            controller.stop();
        }
        controller.step();
        voice.news(controller);
        if controller.cycle().is_multiple_of(every) {
            voice.state(controller);
        }
    }
    controller.settle_state();
    voice.news(controller);
    voice.state(controller);
    cut.map_or_else(|| Ok(controller.outcome().cloned()), Err)
}

/// Carries out what has come; whether more may come.
fn obey(controller: &mut Controller, voice: &LineWriter, orders: &Orders) -> bool {
    loop {
        match orders.next() {
            Next::Order(order) => {
                if let Err(why) = controller.order(&order) {
                    voice.refused(&order, &why);
                }
            }
            Next::None => return true,
            Next::End => return false,
        }
    }
}
