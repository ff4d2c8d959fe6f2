//! A program that runs while it is shown: what it says becomes a run that grows, and it takes orders.

use std::error::Error;
use std::process::Command;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use mcap::McapResult;

use crate::link::ProgramLink;
use crate::listen::{self, Hears};
use crate::playback::Store;
use crate::record::{Recorder, Schema, Sink};
use crate::scenery::Scenery;
use arl_terminal::interrupt;
use arl_terminal::show;
use arl_wire::Line;

/// How often it is looked whether the program has said something.
const LOOK_INTERVAL: Duration = Duration::from_millis(4);

/// A program that runs.
pub(super) struct Live {
    link: Arc<Mutex<ProgramLink>>,
}

impl Live {
    /// Starts a program, which waits for its start button. Others than the page want to hear it, too.
    pub(super) fn start(mut command: Command, hearers: &[Box<dyn Hears>]) -> std::io::Result<Self> {
        command.args(["--live", "--paused", "--each-motion", "--state-interval", listen::STATE_INTERVAL]);
        command.args(listen::wishes(hearers));
        Ok(Self { link: Arc::new(Mutex::new(ProgramLink::start(command)?)) })
    }

    /// Gives the program an order, a line.
    ///
    /// # Errors
    /// It is not a line.
    pub(super) fn order(&self, order: &str) -> Result<(), String> {
        if order.contains(char::is_control) {
            return Err("an order must be a single line".to_owned());
        }
        self.link.lock().unwrap_or_else(PoisonError::into_inner).order(order);
        Ok(())
    }

    /// Hears the program until it ends; its exit code. Who hears it first, `hearers`, may add to what the page is told.
    pub(super) fn hear(&self, mut hearers: Vec<Box<dyn Hears>>, scenery: &Scenery, store: &Arc<Mutex<Store>>) -> u8 {
        let recorder = Recorder::new(Shared(Arc::clone(store)), scenery);
        hearers.push(Box::new(Growing { recorder, store: Arc::clone(store) }));
        loop {
            let (ended, lines) = {
                let mut link = self.link.lock().unwrap_or_else(PoisonError::into_inner);
                // What it said before it ended comes before the end.
                let ended = link.ended();
                if interrupt::was_pressed() {
                    // It may be for this command alone: the robot stops on its path all the same.
                    link.leave();
                }
                let lines: Vec<Line> = match ended {
                    Some(_) => link.last_lines().collect(),
                    None => std::iter::from_fn(|| link.line()).collect(),
                };
                (ended, lines)
            };
            lines.into_iter().for_each(|line| listen::pass_on(told(line), &mut hearers));
            if let Some(code) = ended {
                listen::end(hearers, true);
                store.lock().unwrap_or_else(PoisonError::into_inner).goes_on = false;
                return code;
            }
            std::thread::sleep(LOOK_INTERVAL);
        }
    }
}

/// What concerns people who look at the page is a warning there, and also said where the command was started.
fn told(line: Line) -> Line {
    match line {
        Line::Refused(refused) => Line::Warning(format!("{}: {}", refused.order, refused.why)),
        Line::Other(text) => {
            show::say(&format!("{text}\n"));
            Line::Warning(text)
        }
        line => line,
    }
}

/// A run that grows.
struct Growing {
    recorder: Recorder<Shared>,
    store: Arc<Mutex<Store>>,
}

impl Hears for Growing {
    fn hear(&mut self, line: &Line) -> Result<Vec<Line>, Box<dyn Error>> {
        self.recorder.hear(line)?;
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

/// A store that the page looks at meanwhile.
struct Shared(Arc<Mutex<Store>>);

impl Sink for Shared {
    fn message(&mut self, topic: &str, schema: &'static Schema, time: u64, message: &[u8]) -> McapResult<()> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).message(topic, schema, time, message)
    }

    fn source(&mut self, name: &str, text: &str) -> McapResult<()> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).source(name, text)
    }

    fn finish(&mut self) -> McapResult<()> {
        Ok(())
    }
}
