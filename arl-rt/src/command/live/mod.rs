//! A run that another program drives: orders come in, a line each, and what happens goes out, a JSON object a line.
//!
//! This is what `--live` of a compiled program is, and what `arl2rs run --pendant` sits on. Orders are what an event of
//! an io scenario does, in the same words: `di.5 = true`, `ai.2 = 4.2`, `pendant = "pause"`, `override = 50`. When the
//! orders end, the robot stops on its path and the program with it.
//!
//! `inside = 1` lets lines with the functions and variables of channel 1 go out, where the program was made for a
//! debugger; `inside = 0` ends that.
//!
//! `hold = "j1+"`, said again and again, moves an axis or the TCP as long as it is said (`holding.rs`).
//!
//! The first line that goes out is `{"hello":...}`: the channels with their programs, robots, axes and links, and the
//! names of signals. Then come `state` (20 times a second), `inside` (4 times a second), `message`, `warning`, `alarm`,
//! and `refused` for an order that could not be carried out.
//!
//! `--state-interval S` has states come more often. With `--each-cycle`, `cycle` says in each cycle where the robots
//! are, and the levels of inputs and outputs; with `--each-motion`, `report` says what a motion did, once it has ended.
//!
//! Who only listens (`--listener`) hears the same, reports at the end, and at last `ended` with how often something was
//! left out.

mod holding;
mod line_writer;
mod motions;
mod orders;
mod recording;

use std::sync::atomic::{AtomicBool, Ordering};

use crate::controller::{Controller, Outcome};
use holding::Holding;
use motions::EndedMotions;
use orders::{Next, Orders};

pub(crate) use line_writer::{LineWriter, alarm_line, message_line, push_state, warning_line};
pub(crate) use recording::{Recording, Wishes};

/// How often a state goes out where nobody asks for another interval, in s.
pub(crate) const STATE_INTERVAL_S: f64 = 0.05;
/// How often it goes out what is inside a program, in s.
const INSIDE_INTERVAL_S: f64 = 0.25;

/// Looks into the program of a channel, counted from 0: the fields of an object.
pub(crate) type Inside = fn(&Controller, usize) -> Option<String>;

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
    (inside, wishes): (Option<Inside>, Wishes),
    max_time: Option<f64>,
    interrupted: &AtomicBool,
) -> Result<Option<Outcome>, Cut> {
    let last = max_time.map_or(u64::MAX, |seconds| controller.cycles(seconds));
    let every = controller.cycles(wishes.state_interval);
    let every_inside = controller.cycles(INSIDE_INTERVAL_S);
    let orders = Orders::from_standard_input();
    let mut look = Look { inside, channel: None };
    let mut ended_motions = EndedMotions::default();
    let mut holding = Holding::default();
    let mut cut = None;
    voice.hello(controller);
    loop {
        let gone = cut.is_none() && !obey(controller, voice, &orders, (&mut look, &mut holding))
            || interrupted.load(Ordering::Relaxed);
        let over = cut.is_some() || gone || controller.cycle() >= last;
        if over {
            holding.let_go(controller);
        }
        if over && controller.outcome().is_some() && controller.all_stand() {
            break;
        }
        if over && cut.is_none() {
            cut = Some(if gone { Cut::Interrupted } else { Cut::MaxTime });
            controller.stop();
        }
        controller.step();
        holding.cycle_ended(controller);
        voice.news(controller);
        if wishes.each_cycle {
            voice.cycle(controller);
        }
        if controller.is_turn(every) {
            voice.state(controller);
            ended_motions.say(controller, voice);
        }
        if controller.is_turn(every_inside) {
            look.say(controller, voice);
        }
    }
    controller.close_robots();
    controller.settle_state();
    voice.news(controller);
    voice.state(controller);
    ended_motions.say(controller, voice);
    cut.map_or_else(|| Ok(controller.outcome().cloned()), Err)
}

/// Somebody who looks into a program.
struct Look {
    inside: Option<Inside>,
    /// The channel that is looked into, from 0.
    channel: Option<usize>,
}

impl Look {
    /// The number of the channel that an order asks to look into, where it is such an order; 0: none.
    fn asked(order: &str) -> Option<&str> {
        let (word, value) = order.split_once('=')?;
        (word.trim() == "inside").then_some(value.trim())
    }

    fn set(&mut self, controller: &Controller, value: &str) -> Result<(), String> {
        self.inside.ok_or("this program was not made for inspection: `arl2rs run --pendant` makes such programs")?;
        let number: usize =
            value.parse().map_err(|_| format!("`{value}` is not a channel: expected its number, or 0"))?;
        if number > controller.status().channels.len() {
            return Err(format!("there is no channel {number}"));
        }
        self.channel = number.checked_sub(1);
        Ok(())
    }

    fn say(&self, controller: &Controller, voice: &LineWriter) {
        let fields = self.inside.zip(self.channel).and_then(|(inside, channel)| inside(controller, channel));
        if let (Some(fields), Some(channel)) = (fields, self.channel) {
            voice.inside(channel + 1, &fields);
        }
    }
}

/// Carries out what has come; whether more may come.
fn obey(
    controller: &mut Controller,
    voice: &LineWriter,
    orders: &Orders,
    (look, holding): (&mut Look, &mut Holding),
) -> bool {
    loop {
        match orders.next() {
            Next::Order(order) => {
                let done = match (Look::asked(&order), Holding::asked(&order)) {
                    (Some(value), _) => look.set(controller, value).map(|()| look.say(controller, voice)),
                    (None, Some(button)) => holding.hold(controller, button),
                    (None, None) => controller.order(&order).map_err(|error| error.to_string()),
                };
                if let Err(why) = done {
                    voice.refused(&order, &why);
                }
            }
            Next::None => return true,
            Next::End => return false,
        }
    }
}
