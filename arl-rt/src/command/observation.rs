//! The values that a host observes after each step, as numbers.

use crate::context::named::{self, with_variable};
use crate::context::program::Program;
use crate::controller::{Controller, trace};
use arl_robot::cell::{Signal, SignalKind};

/// The first robot's row of the trace, followed by signals and global variables that a host has named.
#[derive(Default)]
pub(crate) struct Observation {
    watched: Vec<Watched>,
}

enum Watched {
    Signal(Signal),
    Global(String),
}

impl Observation {
    /// Observes these from now on, one name per line: signals (`do.1`, or the cell's names for them) and global
    /// variables that are numbers or truth values (`global.placed`).
    ///
    /// # Errors
    /// One of them does not exist, or is not a number; then nothing changes.
    pub(crate) fn watch(&mut self, names: &str, controller: &Controller) -> Result<(), String> {
        let names = names.lines().map(str::trim).filter(|name| !name.is_empty());
        let watched = names.map(|name| {
            let watched = match name.strip_prefix("global.") {
                Some(global) => Watched::Global(global.to_owned()),
                None => Watched::Signal(Signal::parse(name).or_else(|| controller.names().signal(name)).ok_or_else(
                    || format!("`{name}` is neither a signal nor a global variable: expected one like do.1 or global.placed"),
                )?),
            };
            watched.value(controller).map(|_| watched).map_err(|problem| format!("`{name}`: {problem}"))
        });
        self.watched = watched.collect::<Result<_, String>>()?;
        Ok(())
    }

    /// How many numbers there are.
    pub(crate) fn count(&self) -> usize {
        trace::COLUMNS + self.watched.len()
    }

    /// Fills in the numbers, as many as there is room for. The values of axes that do not exist are NaN.
    pub(crate) fn fill(&self, numbers: &mut [f64], controller: &Controller) {
        let row = controller.trace_row();
        let (front, back) = numbers.split_at_mut(row.len().min(numbers.len()));
        front.iter_mut().zip(row).for_each(|(to, number)| *to = number);
        for (to, watched) in back.iter_mut().zip(&self.watched) {
            *to = watched.value(controller).unwrap_or(f64::NAN);
        }
    }
}

impl Watched {
    fn value(&self, controller: &Controller) -> Result<f64, String> {
        match self {
            Watched::Signal(signal) => of_signal(*signal, controller),
            Watched::Global(name) => of_global(name, controller.first_program()),
        }
    }
}

fn of_signal(signal: Signal, controller: &Controller) -> Result<f64, String> {
    let at = signal.channel as usize - 1;
    let level = |levels: &[bool]| levels.get(at).map(|level| f64::from(u8::from(*level)));
    let value = controller.with_signals(|io| match signal.kind {
        SignalKind::DigitalInput => level(io.inputs().levels()),
        SignalKind::DigitalOutput => level(io.outputs().levels()),
        SignalKind::AnalogInput => io.analogs(false).get(at).copied(),
        SignalKind::AnalogOutput => io.analogs(true).get(at).copied(),
        SignalKind::InternalInput | SignalKind::InternalOutput => None,
    });
    value.ok_or_else(|| "the cell has no such signal, or it cannot be watched".into())
}

fn of_global(name: &str, program: &dyn Program) -> Result<f64, String> {
    let number = |text: String| match text.as_str() {
        "true" => Ok(1.0),
        "false" => Ok(0.0),
        text => text.parse().map_err(|_| "its value is neither a number nor a bool".to_owned()),
    };
    let value = with_variable(program, name, |variable| variable.slot.written()).map_err(|error| error.to_string())?;
    value.map_or_else(|| Err(named::unknown(name, &[program]).to_string()), number)
}
