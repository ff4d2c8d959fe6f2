//! I/O islands: Modbus TCP servers with inputs and outputs of the cell. A thread for each island exchanges them; the
//! cycle only copies images.

mod link;
mod plan;
mod poller;
mod shared;

use std::sync::Arc;
use std::thread::JoinHandle;

use arl_motion::beside;

use arl_robot::islands::{Island, Lost, Rest};

use self::plan::Signals;
use self::poller::Poller;
use self::shared::SharedImages;
use crate::io::{Inputs, IoDriver, OutputSignal, Outputs};

/// The islands of a cell. Their outputs are written a last time on drop, which takes up to the timeout of a request.
#[derive(Default)]
pub(crate) struct Islands {
    ports: Vec<Port>,
}

/// The cycle's side of an island.
struct Port {
    island: Island,
    shared: Arc<SharedImages>,
    thread: Option<JoinHandle<()>>,
    inputs: Signals,
    /// The last cycle whose outputs the island has taken.
    written: Option<u64>,
    /// How often the island had been found or lost at the last check by the cycle.
    turns: u64,
    lost: Option<Arc<str>>,
    /// A message for the user.
    news: Option<String>,
}

impl Islands {
    /// Starts the exchange with islands; returns once each has answered or is known to be lost.
    ///
    /// # Errors
    /// An island without which no robot may move is lost; the message has its name and the reason.
    pub(crate) fn start(islands: &[Island]) -> Result<Self, String> {
        let mut ports = Vec::with_capacity(islands.len());
        for island in islands {
            ports.push(Port::start(island)?);
        }
        // A lost island ends all of them again, as `islands` is dropped.
        let islands = Self { ports };
        for port in &islands.ports {
            if let Some(why) = port.shared.first_turn().filter(|_| port.island.lost == Lost::Alarm) {
                let title = title(&port.island);
                return Err(format!(
                    "{title} is not available: {why}; start it, or correct the table [[island]] of the cell file \
                     (`lost = \"warning\"` lets programs run without it)"
                ));
            }
        }
        Ok(islands)
    }

    /// Whether the cell has no islands.
    pub(crate) fn is_empty(&self) -> bool {
        self.ports.is_empty()
    }
}

impl IoDriver for Islands {
    fn read(&mut self, mut inputs: Inputs<'_>) {
        self.ports.iter_mut().for_each(|port| port.read(&mut inputs));
    }

    fn write(&mut self, outputs: Outputs<'_>) {
        self.ports.iter().for_each(|port| port.write(outputs));
    }

    fn has_reached(&self, output: OutputSignal, cycle: u64) -> bool {
        let done = |port: &Port| port.written.is_some_and(|written| written >= cycle);
        self.ports.iter().all(|port| !port.has(output) || done(port))
    }

    fn take_warning(&mut self) -> Option<String> {
        self.ports.iter_mut().find_map(|port| port.news.take())
    }

    fn fault(&self) -> Option<&str> {
        self.ports.iter().filter(|port| port.island.lost == Lost::Alarm).find_map(|port| port.lost.as_deref())
    }
}

impl Drop for Islands {
    fn drop(&mut self) {
        for port in &self.ports {
            port.shared.stop();
            port.thread.iter().for_each(|thread| thread.thread().unpark());
        }
        for port in &mut self.ports {
            // The result of the thread has no new information.
            port.thread.take().into_iter().for_each(|thread| drop(thread.join()));
        }
    }
}

impl Port {
    fn start(island: &Island) -> Result<Self, String> {
        let points = &island.points;
        let values = |analogs: &[arl_robot::islands::Analog]| {
            analogs.iter().map(|analog| analog.scale.without_signal()).collect::<Vec<_>>()
        };
        let inputs = Signals::at_rest(points.di.len(), &values(&points.ai));
        let outputs = Signals::at_rest(points.dout.len(), &values(&points.ao));
        let shared = Arc::new(SharedImages::new(inputs.clone(), outputs.clone()));
        let poller = Poller::new(island.clone(), Arc::clone(&shared), [inputs.clone(), outputs]);
        let thread = beside::spawn(std::thread::Builder::new().name("island".into()), move || poller.run());
        let thread = thread.map_err(|error| format!("the thread of {} cannot be started: {error}", title(island)))?;
        Ok(Self {
            island: island.clone(),
            shared,
            thread: Some(thread),
            inputs,
            written: None,
            turns: 0,
            lost: None,
            news: None,
        })
    }

    /// Whether the island has this output.
    fn has(&self, output: OutputSignal) -> bool {
        let points = &self.island.points;
        match output {
            OutputSignal::Digital(channel) => points.dout.iter().any(|bit| bit.channel + 1 == channel),
            OutputSignal::Analog(channel) => points.ao.iter().any(|analog| analog.channel + 1 == channel),
        }
    }

    fn read(&mut self, inputs: &mut Inputs<'_>) {
        if let Some(state) = self.shared.try_lock() {
            self.inputs.copy_from(&state.inputs);
            self.written = state.written;
            if state.turns != self.turns {
                let lost = state.lost.as_ref().map(|why| format!("{} is lost: {why}", title(&self.island)));
                self.news = news(&self.island, lost.as_deref(), self.turns == 0);
                self.lost = lost.map(Into::into);
                self.turns = state.turns;
            }
        }
        for (bit, level) in self.island.points.di.iter().zip(&self.inputs.bits) {
            inputs.set_digital_input(bit.channel + 1, *level);
        }
        for (analog, value) in self.island.points.ai.iter().zip(&self.inputs.values) {
            inputs.set_analog_input(analog.channel + 1, *value);
        }
    }

    fn write(&self, outputs: Outputs<'_>) {
        // If the thread copies them just now, it gets these in the next cycle.
        let Some(mut state) = self.shared.try_lock() else { return };
        let points = &self.island.points;
        for (bit, level) in points.dout.iter().zip(&mut state.outputs.bits) {
            *level = outputs.digital_output(bit.channel + 1);
        }
        for (analog, value) in points.ao.iter().zip(&mut state.outputs.values) {
            *value = outputs.analog_output(analog.channel + 1);
        }
        state.given = Some(outputs.cycle());
    }
}

/// The message for the user when an island is found or lost; an alarm reports the loss of an island that stops the
/// robots.
fn news(island: &Island, lost: Option<&str>, first: bool) -> Option<String> {
    match (lost, island.lost) {
        (None, _) if first => None,
        (None, _) => Some(format!("{} is back", title(island))),
        (Some(_), Lost::Alarm) => None,
        (Some(lost), Lost::Warning) => Some(match island.inputs {
            _ if island.points.di.is_empty() && island.points.ai.is_empty() => lost.to_owned(),
            Rest::Zero => format!("{lost}; its inputs go to 0"),
            Rest::Hold => format!("{lost}; its inputs stay as they were"),
        }),
    }
}

/// The name of an island in messages.
fn title(island: &Island) -> String {
    let address = island.address.to_string();
    if island.name == address {
        format!("the island {address}")
    } else {
        format!("the island {} ({address})", island.name)
    }
}

#[cfg(test)]
mod tests;
