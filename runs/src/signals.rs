//! The signals of a run, for a plot.

use std::cell::RefCell;
use std::error::Error;
use std::rc::Rc;

use mcap::McapResult;

use crate::listen::Subscriber;
use crate::playback::{Signal, Store};
use crate::plot::Lane;
use crate::record::{Recorder, RunMessage, Sink};
use crate::scenery::Scenery;
use arl_wire::Line;

/// Records the changes of signals.
pub struct Signals {
    recorder: Recorder<Levels>,
    lanes: Rc<RefCell<Vec<Lane>>>,
}

impl Signals {
    /// A recorder, and the lanes that are there once the run has ended.
    pub fn new() -> (Self, Rc<RefCell<Vec<Lane>>>) {
        let lanes = Rc::<RefCell<Vec<Lane>>>::default();
        (Self { recorder: Recorder::new(Levels::default(), &Scenery::default()), lanes: Rc::clone(&lanes) }, lanes)
    }
}

impl Subscriber for Signals {
    fn receive(&mut self, line: &Line) -> Result<Vec<Line>, Box<dyn Error>> {
        self.recorder.receive(line)?;
        Ok(Vec::new())
    }

    fn end(self: Box<Self>) -> Result<(), Box<dyn Error>> {
        let Levels(store) = self.recorder.ended()?;
        let lane = |(signal, changes): (&Signal, &Vec<(f64, f64)>)| {
            let name = store.name_of(*signal);
            let label = name.map_or_else(|| signal.to_string(), |name| format!("{name} {signal}"));
            Lane { label, changes: changes.clone() }
        };
        *self.lanes.borrow_mut() = store.signals.iter().map(lane).collect();
        Ok(())
    }

    fn broken(&self) -> String {
        "the plot shows no signals".to_owned()
    }
}

/// A store of levels and their names only: the positions of the robots are in the trace.
#[derive(Default)]
struct Levels(Store);

impl Sink for Levels {
    fn message(&mut self, time: u64, message: RunMessage) -> McapResult<()> {
        match message {
            RunMessage::Cell(_) | RunMessage::Io(_) => self.0.message(time, message),
            _ => Ok(()),
        }
    }

    fn source(&mut self, _name: &str, _text: &str) -> McapResult<()> {
        Ok(())
    }

    fn finish(&mut self) -> McapResult<()> {
        Ok(())
    }
}
