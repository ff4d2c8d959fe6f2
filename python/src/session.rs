//! Programs as libraries in this process, and their runs.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard};
use std::thread::{self, ThreadId};

use arl_library::{Library as Loaded, LoadError, Session as Run};
use arl2rs_cli::host::{self, CodeProgram, Prepared, PreparedProgram, Settings};
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::problem::{Gone, Refused, of_host, of_library};
use crate::value::{Place, of_literal};
use crate::{Given, interruptible};

/// The most cycles that run before Ctrl-C is checked; some 50 ms.
const CHUNK: u64 = 5_000;

/// A program in this process.
#[pyclass(frozen)]
pub(crate) struct Library {
    loaded: Loaded,
    words: Vec<String>,
}

#[pymethods]
impl Library {
    /// Makes the program ready to run.
    #[new]
    fn new(py: Python<'_>, given: Given) -> PyResult<Self> {
        let settings: Settings = given.into();
        let Prepared { program, words } = interruptible(py, move || host::prepared(&settings))?.map_err(of_host)?;
        let loaded = match program {
            PreparedProgram::Code(CodeProgram { make, others, folder }) => Loaded::in_process(make, others, folder),
            // Once it is loaded, the program may be compiled again: that makes another file.
            PreparedProgram::Library(path, _lock) => {
                // SAFETY: this is what the compiler has just made, or made before, and what no one else may write.
                unsafe { Loaded::open(&path) }.map_err(of_library)?
            }
        };
        Ok(Self { loaded, words })
    }

    /// The command-line words that all runs need.
    #[getter]
    fn words(&self) -> Vec<String> {
        self.words.clone()
    }

    /// The names of the columns of a trace.
    #[getter]
    fn columns(&self) -> Vec<String> {
        self.loaded.columns()
    }

    /// A run at the start of its first cycle.
    fn begin(&self, words: Vec<String>, traced: bool) -> PyResult<Session> {
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let run = self.loaded.begin(&words, traced).map_err(of_library)?;
        let columns = self.loaded.columns().len();
        let going = Going { run, columns, traced, watched: Vec::new(), numbers: Vec::new(), rows: Vec::new() };
        Ok(Session { thread: thread::current().id(), going: Mutex::new(Some(going)), gone: AtomicU64::new(0) })
    }
}

/// What is watched after the row of a trace.
enum Watched {
    /// What the library itself observes: its index there.
    ByLibrary(usize),
    /// A number in a structure or an array.
    Part(Place),
}

/// A run, and what is kept of it for the caller.
struct Going {
    run: Run,
    /// How many columns a row of the trace has.
    columns: usize,
    traced: bool,
    watched: Vec<Watched>,
    /// What the library observes.
    numbers: Vec<f64>,
    /// Rows that were not taken yet, if something else is watched.
    rows: Vec<f64>,
}

impl Going {
    /// Watches these from now on.
    fn watch(&mut self, names: &[String]) -> PyResult<()> {
        let (mut by_library, mut watched) = (Vec::new(), Vec::new());
        for name in names {
            let place = name.strip_prefix("global.").map(Place::parse).transpose()?;
            watched.push(match place.filter(|place| !place.is_whole()) {
                Some(place) => {
                    self.run.global(&place.variable).map_err(of_library)?;
                    Watched::Part(place)
                }
                None => {
                    by_library.push(name.as_str());
                    Watched::ByLibrary(by_library.len() - 1)
                }
            });
        }
        self.run.watch(&by_library).map_err(of_library)?;
        self.watched = watched;
        Ok(())
    }

    /// Fills in the row of the trace and what is watched; returns how many numbers there are.
    fn observe(&mut self, into: &mut [f64]) -> usize {
        let by_library = self.watched.iter().filter(|it| matches!(it, Watched::ByLibrary(_))).count();
        self.numbers.resize(self.columns + by_library, f64::NAN);
        self.run.observe(&mut self.numbers);
        let (row, values) = self.numbers.split_at(self.columns.min(self.numbers.len()));
        into.iter_mut().zip(row).for_each(|(to, number)| *to = *number);
        // Parts of one variable mostly come together.
        let mut last: Option<(&str, serde_json::Value)> = None;
        for (to, watched) in into.iter_mut().skip(self.columns).zip(&self.watched) {
            *to = match watched {
                Watched::ByLibrary(at) => values.get(*at).copied().unwrap_or(f64::NAN),
                Watched::Part(place) => {
                    if last.as_ref().is_none_or(|(name, _)| *name != place.variable) {
                        let value = self.run.global(&place.variable).ok();
                        let value = value.and_then(|literal| of_literal(&literal, "").ok());
                        last = Some((&place.variable, value.unwrap_or_default()));
                    }
                    last.as_ref().map_or(f64::NAN, |(_, value)| place.number(value))
                }
            };
        }
        self.columns + self.watched.len()
    }

    /// Continues the run. If something is watched in a traced run, its values follow each row.
    fn go_on(&mut self, cycles: u64, alone: bool) -> Result<Option<u8>, LoadError> {
        if !self.traced || self.watched.is_empty() {
            return self.run.go_on(cycles, alone);
        }
        let mut row = vec![f64::NAN; self.columns + self.watched.len()];
        for _ in 0..cycles.max(1) {
            let code = self.run.go_on(cycles.min(1), alone)?;
            // One row or none: none where no program runs.
            let traced = self.run.take_rows();
            if !traced.is_empty() {
                self.observe(&mut row);
                row.iter_mut().zip(&traced).for_each(|(to, number)| *to = *number);
                self.rows.extend_from_slice(&row);
            }
            if code.is_some() {
                return Ok(code);
            }
        }
        Ok(None)
    }

    fn take_rows(&mut self) -> Vec<f64> {
        if self.watched.is_empty() { self.run.take_rows() } else { std::mem::take(&mut self.rows) }
    }
}

/// A run of a program, on the thread that began it.
#[pyclass(frozen)]
pub(crate) struct Session {
    thread: ThreadId,
    going: Mutex<Option<Going>>,
    /// As returned by [`Session::gone`].
    gone: AtomicU64,
}

impl Session {
    /// The run. Another thread is refused, not kept waiting.
    fn own(&self) -> PyResult<MutexGuard<'_, Option<Going>>> {
        let wrong = || Gone::new_err(LoadError::WrongThread.to_string());
        if thread::current().id() != self.thread {
            return Err(wrong());
        }
        self.going.try_lock().map_err(|_| wrong())
    }

    /// A text that every run has unless it is broken.
    fn text_of(&self, tell: impl FnOnce(&mut Run) -> String) -> PyResult<String> {
        match self.with(|going| tell(&mut going.run))? {
            text if text.is_empty() => Err(of_library(LoadError::Broken)),
            text => Ok(text),
        }
    }

    fn with<T>(&self, act: impl FnOnce(&mut Going) -> T) -> PyResult<T> {
        let mut going = self.own()?;
        going.as_mut().map(act).ok_or_else(|| Gone::new_err("the session is closed"))
    }

    fn chunk(&self, cycles: u64, alone: bool) -> PyResult<Option<u8>> {
        let code = self.with(|going| going.go_on(cycles, alone))?.map_err(of_library)?;
        self.gone.fetch_add(cycles, Ordering::Relaxed);
        Ok(code)
    }

    fn tried<T>(&self, act: impl FnOnce(&mut Run) -> Result<T, LoadError>) -> PyResult<T> {
        self.with(|going| act(&mut going.run))?.map_err(of_library)
    }
}

#[pymethods]
impl Session {
    /// Continues for this many cycles, or to the end of the run; returns its exit code then. Other Python threads
    /// continue meanwhile.
    fn go_on(&self, py: Python<'_>, cycles: u64, alone: bool) -> PyResult<Option<u8>> {
        let mut remaining = cycles;
        loop {
            let now = remaining.min(CHUNK);
            let code = py.detach(|| self.chunk(now, alone))?;
            remaining -= now;
            py.check_signals()?;
            if code.is_some() || remaining == 0 {
                return Ok(code);
            }
        }
    }

    /// Runs a few cycles, and puts what is observed after them into an array of doubles; returns the exit code if the
    /// run is over.
    fn step(&self, py: Python<'_>, cycles: u64, alone: bool, into: PyBuffer<f64>) -> PyResult<Option<u8>> {
        let code = if cycles > CHUNK { self.go_on(py, cycles, alone)? } else { self.chunk(cycles, alone)? };
        self.observe(py, into)?;
        Ok(code)
    }

    /// Puts what is observed into an array of doubles; returns how many numbers there are.
    fn observe(&self, py: Python<'_>, into: PyBuffer<f64>) -> PyResult<usize> {
        let mut numbers = vec![f64::NAN; into.item_count()];
        let count = self.with(|going| going.observe(&mut numbers))?;
        into.copy_from_slice(py, &numbers)?;
        Ok(count)
    }

    /// Sets which signals, global variables and parts of them are observed after the row of the trace.
    fn watch(&self, names: Vec<String>) -> PyResult<()> {
        if names.iter().any(|name| name.contains('\n')) {
            return Err(Refused::new_err("a name cannot contain a line break"));
        }
        self.with(|going| going.watch(&names))?
    }

    /// Does what an event of a scenario does.
    fn order(&self, order: &str) -> PyResult<()> {
        self.tried(|run| run.order(order))
    }

    /// The value of a global variable, as a literal.
    fn global_value(&self, name: &str) -> PyResult<String> {
        self.tried(|run| run.global(name))
    }

    /// Gives a global variable a value.
    fn set_global(&self, name: &str, literal: &str) -> PyResult<()> {
        self.tried(|run| run.set_global(name, literal))
    }

    /// What was reported since the last call, a JSON object a line.
    fn take_said(&self) -> PyResult<String> {
        self.with(|going| going.run.take_said())
    }

    /// The rows of the trace since the last call, as the bytes of doubles.
    fn take_rows<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let rows = self.with(Going::take_rows)?;
        PyBytes::new_with(py, rows.len() * 8, |bytes| {
            bytes.chunks_exact_mut(8).zip(&rows).for_each(|(to, number)| to.copy_from_slice(&number.to_ne_bytes()));
            Ok(())
        })
    }

    /// The present state, a JSON object.
    fn state(&self) -> PyResult<String> {
        self.text_of(Run::state)
    }

    /// The result of the run, or how far it is, a JSON object.
    fn summary(&self) -> PyResult<String> {
        self.text_of(Run::summary)
    }

    /// What each motion did, a JSON object a line.
    fn report(&self) -> PyResult<String> {
        self.with(|going| going.run.report())
    }

    /// Controller time in s.
    #[getter]
    fn time(&self) -> PyResult<f64> {
        self.with(|going| going.run.time())
    }

    /// How many cycles calls have completed, long calls in parts; cycles that were requested after the end of the run
    /// count, too.
    #[getter]
    fn gone(&self) -> u64 {
        self.gone.load(Ordering::Relaxed)
    }

    /// Ends the programs: the robots stop on their paths within the cycles that follow.
    fn stop(&self) -> PyResult<()> {
        self.with(|going| going.run.stop())
    }

    /// Ends the run.
    fn close(&self) -> PyResult<()> {
        drop(self.own()?.take());
        Ok(())
    }
}
