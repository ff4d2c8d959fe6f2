//! The signals of a run, for a plot.

use std::cell::RefCell;
use std::error::Error;
use std::rc::Rc;

use super::listen::Hears;
use super::plot::Lane;
use super::record::Recorder;
use super::recorded::{Signal, Store};
use super::said::Line;

/// Hears which signals change.
pub(super) struct Signals {
    recorder: Recorder<Store>,
    lanes: Rc<RefCell<Vec<Lane>>>,
}

impl Signals {
    /// Together with what is there once the run has ended.
    pub(super) fn new() -> (Self, Rc<RefCell<Vec<Lane>>>) {
        let lanes = Rc::<RefCell<Vec<Lane>>>::default();
        (Self { recorder: Recorder::new(Store::default(), &[]), lanes: Rc::clone(&lanes) }, lanes)
    }
}

impl Hears for Signals {
    fn hear(&mut self, line: &Line) -> Result<Vec<Line>, Box<dyn Error>> {
        // Where the robots were is in the trace.
        if let Line::Hello(_) | Line::State(_) = line {
            self.recorder.hear(line)?;
        }
        Ok(Vec::new())
    }

    fn end(self: Box<Self>) -> Result<(), Box<dyn Error>> {
        let store = self.recorder.ended()?;
        let lane = |(Signal { kind, number }, changes): (&Signal, &Vec<(f64, f64)>)| {
            let signal = format!("{kind}.{number}");
            let name = store.cell.names.iter().find(|name| name.signal == signal);
            let label = name.map_or_else(|| signal.clone(), |name| format!("{} {signal}", name.name));
            Lane { label, changes: changes.clone() }
        };
        *self.lanes.borrow_mut() = store.signals.iter().map(lane).collect();
        Ok(())
    }

    fn broken(&self) -> String {
        "the plot shows no signals".to_owned()
    }
}
