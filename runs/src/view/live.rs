//! A running program that is shown: what it reports becomes a growing run, and it takes orders.

use std::error::Error;
use std::process::Command;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use mcap::McapResult;

use crate::link::ProgramLink;
use crate::listen::{self, Subscriber};
use crate::playback::Store;
use crate::record::{Recorder, RunMessage, Sink};
use crate::scenery::Scenery;
use arl_terminal::interrupt;
use arl_terminal::show;
use arl_wire::Line;

/// The interval at which new lines of the program are looked for.
const LOOK_INTERVAL: Duration = Duration::from_millis(4);

/// A running program.
pub(super) struct Live {
    link: Arc<Mutex<ProgramLink>>,
}

impl Live {
    /// Starts a program, which waits for its start button. `subscribers` get its lines besides the page.
    pub(super) fn start(mut command: Command, subscribers: &[Box<dyn Subscriber>]) -> std::io::Result<Self> {
        command.args(["--live", "--paused", "--each-motion", "--state-interval", listen::STATE_INTERVAL]);
        command.args(listen::wishes(subscribers));
        Ok(Self { link: Arc::new(Mutex::new(ProgramLink::start(command)?)) })
    }

    /// Sends the program an order, a line.
    ///
    /// # Errors
    /// The order is not a single line.
    pub(super) fn order(&self, order: &str) -> Result<(), String> {
        if order.contains(char::is_control) {
            return Err("an order must be a single line".to_owned());
        }
        self.link.lock().unwrap_or_else(PoisonError::into_inner).order(order);
        Ok(())
    }

    /// Listens to the program until it ends; returns its exit code. `subscribers` get its lines first, and may add to
    /// what the page gets.
    pub(super) fn receive(
        &self,
        mut subscribers: Vec<Box<dyn Subscriber>>,
        scenery: &Scenery,
        store: &Arc<Mutex<Store>>,
    ) -> u8 {
        let recorder = Recorder::new(Shared(Arc::clone(store)), scenery);
        subscribers.push(Box::new(Growing { recorder, store: Arc::clone(store) }));
        loop {
            let (ended, lines) = {
                let mut link = self.link.lock().unwrap_or_else(PoisonError::into_inner);
                // Lines that the program sent before it ended come before the end.
                let ended = link.ended();
                if interrupt::was_pressed() {
                    // The interrupt may be for this command alone: the robot stops on its path all the same.
                    link.leave();
                }
                let lines: Vec<Line> = match ended {
                    Some(_) => link.last_lines().collect(),
                    None => std::iter::from_fn(|| link.line()).collect(),
                };
                (ended, lines)
            };
            lines.into_iter().for_each(|line| listen::pass_on(for_page(line), &mut subscribers));
            if let Some(code) = ended {
                listen::end(subscribers, true);
                store.lock().unwrap_or_else(PoisonError::into_inner).goes_on = false;
                return code;
            }
            std::thread::sleep(LOOK_INTERVAL);
        }
    }
}

/// Turns lines that concern the users of the page into warnings there; other output is also printed where the command
/// was started.
fn for_page(line: Line) -> Line {
    match line {
        Line::Refused(refused) => Line::Warning(format!("{}: {}", refused.order, refused.why)),
        Line::Other(text) => {
            show::say(&format!("{text}\n"));
            Line::Warning(text)
        }
        line => line,
    }
}

/// A growing run.
struct Growing {
    recorder: Recorder<Shared>,
    store: Arc<Mutex<Store>>,
}

impl Subscriber for Growing {
    fn receive(&mut self, line: &Line) -> Result<Vec<Line>, Box<dyn Error>> {
        self.recorder.receive(line)?;
        if let Line::State(state) = line {
            // Time goes on while nothing changes.
            let mut store = self.store.lock().unwrap_or_else(PoisonError::into_inner);
            store.end = store.end.max(state.time);
        }
        Ok(Vec::new())
    }

    fn end(mut self: Box<Self>) -> Result<(), Box<dyn Error>> {
        Ok(self.recorder.finish()?)
    }

    fn broken(&self) -> String {
        "the page is no longer updated".to_owned()
    }
}

/// A store that the page reads meanwhile.
struct Shared(Arc<Mutex<Store>>);

impl Sink for Shared {
    fn message(&mut self, time: u64, message: RunMessage) -> McapResult<()> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).message(time, message)
    }

    fn source(&mut self, name: &str, text: &str) -> McapResult<()> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).source(name, text)
    }

    fn finish(&mut self) -> McapResult<()> {
        Ok(())
    }
}
