//! A run that another program drives: orders come in, one per line, and events go out, one JSON object per line.
//!
//! This is the option `--live` of a compiled program, on which `arl2rs run --pendant` is built. Orders are the same
//! words as an event of an io scenario: `di.5 = true`, `ai.2 = 4.2`, `pendant = "pause"`, `override = 50`. When the
//! orders end, the robot stops on its path and the program with it.
//!
//! `inside = 1` has lines with the functions and variables of channel 1 sent, where the program was made for a
//! debugger; `inside = 0` ends that.
//!
//! `hold = "j1+"`, sent again and again, moves an axis or the TCP as long as it is sent (`holding.rs`).
//!
//! The first line sent is `{"hello":...}`: the channels with their programs, robots, axes and links, and the names of
//! signals. Then come `state` (20 times a second), `inside` (4 times a second), `message`, `warning`, `alarm`, and
//! `refused` for an order that could not be carried out.
//!
//! `--state-interval S` sets the interval of states. With `--each-cycle`, `cycle` reports in each cycle where the
//! robots are, and the levels of inputs and outputs; with `--each-motion`, `report` gives what a motion did, once it
//! has ended.
//!
//! A mere listener (`--listener`) gets the same lines, reports at the end, and finally `ended` with how often something
//! was left out.

mod holding;
mod line_writer;
mod motions;
mod orders;
mod recording;

use crate::command::ending::Ending;
use crate::command::interrupts::Interrupted;
use crate::controller::Controller;
use holding::Holding;
use motions::EndedMotions;
use orders::{Next, Orders};

pub(crate) use line_writer::{LineWriter, alarm_line, message_line, push_state, warning_line};
pub(crate) use recording::{Recording, Wishes};

/// How often a state is sent by default, in s.
pub(crate) const STATE_INTERVAL_S: f64 = 0.05;
/// How often the inside of a program is sent, in s.
const INSIDE_INTERVAL_S: f64 = 0.25;

/// Shows the inside of the program of a channel, counted from 0: the fields of an object.
pub(crate) type Inside = fn(&Controller, usize) -> Option<String>;

/// Steps while orders may come: also after the end of the program, which an order may start again. Returns how the
/// run ended.
pub(crate) fn drive(
    controller: &mut Controller,
    writer: &LineWriter,
    inside: Option<Inside>,
    wishes: Wishes,
    max_time: Option<f64>,
    interrupted: &Interrupted,
) -> Ending {
    let last = max_time.map_or(u64::MAX, |seconds| controller.cycles(seconds));
    let every = controller.cycles(wishes.state_interval);
    let every_inside = controller.cycles(INSIDE_INTERVAL_S);
    let orders = Orders::from_standard_input();
    let mut look = Look { inside, channel: None };
    let mut ended_motions = EndedMotions::default();
    let mut holding = Holding::default();
    let mut cut = None;
    writer.hello(controller);
    loop {
        let gone = cut.is_none() && !obey(controller, writer, &orders, &mut look, &mut holding) || interrupted.is_set();
        let over = cut.is_some() || gone || controller.cycle() >= last;
        if over {
            holding.let_go(controller);
        }
        if over && controller.outcome().is_some() && controller.all_stand() {
            break;
        }
        if over && cut.is_none() {
            cut = Some(if gone { Ending::Stopped } else { Ending::TimeOver });
            controller.stop();
        }
        controller.step();
        holding.cycle_ended(controller);
        writer.news(controller);
        if wishes.each_cycle {
            writer.cycle(controller);
        }
        if controller.is_turn(every) {
            writer.state(controller);
            ended_motions.say(controller, writer);
        }
        if controller.is_turn(every_inside) {
            look.say(controller, writer);
        }
    }
    controller.close_robots();
    controller.settle_state();
    writer.news(controller);
    writer.state(controller);
    ended_motions.say(controller, writer);
    Ending::of(cut, controller.outcome())
}

/// The inspection of a program.
struct Look {
    inside: Option<Inside>,
    /// The channel that is inspected, from 0.
    channel: Option<usize>,
}

impl Look {
    /// The number of the channel that an order asks to inspect, where it is such an order; 0: none.
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

    fn say(&self, controller: &Controller, writer: &LineWriter) {
        let fields = self.inside.zip(self.channel).and_then(|(inside, channel)| inside(controller, channel));
        if let (Some(fields), Some(channel)) = (fields, self.channel) {
            writer.inside(channel + 1, &fields);
        }
    }
}

/// Carries out the orders that have arrived; returns whether more may come.
fn obey(
    controller: &mut Controller,
    writer: &LineWriter,
    orders: &Orders,
    look: &mut Look,
    holding: &mut Holding,
) -> bool {
    loop {
        match orders.next() {
            Next::Order(order) => {
                let done = match (Look::asked(&order), Holding::asked(&order)) {
                    (Some(value), _) => look.set(controller, value).map(|()| look.say(controller, writer)),
                    (None, Some((channel, words))) => holding.hold(controller, channel, words),
                    (None, None) => controller.order(&order).map_err(|error| error.to_string()),
                };
                if let Err(why) = done {
                    writer.refused(&order, &why);
                }
            }
            Next::None => return true,
            Next::End => return false,
        }
    }
}
