//! Programs as libraries in this process, and their runs.

use std::sync::{Mutex, MutexGuard};
use std::thread::{self, ThreadId};

use arl_library::{Library as Loaded, LoadError, Session as Run};
use arl2rs::cli::host::{self, Settings};
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::problem::{Gone, of_host, of_library};
use crate::{Given, interruptible};

/// So many cycles may go by before somebody looks whether Ctrl-C was pressed; some 50 ms.
const CHUNK: u64 = 5_000;

/// A compiled program in this process.
#[pyclass(frozen)]
pub(crate) struct Library {
    loaded: Loaded,
    words: Vec<String>,
}

#[pymethods]
impl Library {
    /// Compiles the program where needed, and loads it.
    #[new]
    fn new(py: Python<'_>, given: Given) -> PyResult<Self> {
        let settings: Settings = given.into();
        let compiled = interruptible(py, move || host::library(&settings))?.map_err(of_host)?;
        // SAFETY: this is what the compiler has just made, or made before and nobody else may write.
        let loaded = unsafe { Loaded::open(&compiled.path) }.map_err(of_library)?;
        // Now that it is loaded, the program may be compiled anew: that is another file.
        Ok(Self { loaded, words: compiled.words })
    }

    /// The words that all runs need.
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
        Ok(Session { thread: thread::current().id(), run: Mutex::new(Some(run)), numbers: Mutex::default() })
    }
}

/// A run of a program, on the thread that began it.
#[pyclass(frozen)]
pub(crate) struct Session {
    thread: ThreadId,
    run: Mutex<Option<Run>>,
    numbers: Mutex<Vec<f64>>,
}

impl Session {
    /// The run. Another thread is sent away, not kept waiting.
    fn own(&self) -> PyResult<MutexGuard<'_, Option<Run>>> {
        let wrong = || Gone::new_err(LoadError::WrongThread.to_string());
        if thread::current().id() != self.thread {
            return Err(wrong());
        }
        self.run.try_lock().map_err(|_| wrong())
    }

    /// A text that every run has that is not broken.
    fn told(&self, tell: impl FnOnce(&mut Run) -> String) -> PyResult<String> {
        match self.with(tell)? {
            text if text.is_empty() => Err(of_library(LoadError::Broken)),
            text => Ok(text),
        }
    }

    fn with<T>(&self, act: impl FnOnce(&mut Run) -> T) -> PyResult<T> {
        let mut run = self.own()?;
        run.as_mut().map(act).ok_or_else(|| Gone::new_err("the session is closed"))
    }

    fn tried<T>(&self, act: impl FnOnce(&mut Run) -> Result<T, LoadError>) -> PyResult<T> {
        self.with(act)?.map_err(of_library)
    }
}

#[pymethods]
impl Session {
    /// Goes on for so many cycles, or to the end of the run; its exit code then. Other threads of Python go on meanwhile.
    fn go_on(&self, py: Python<'_>, cycles: u64, alone: bool) -> PyResult<Option<u8>> {
        let mut left = cycles;
        loop {
            let now = left.min(CHUNK);
            let code = py.detach(|| self.tried(|run| run.go_on(now, alone)))?;
            left -= now;
            py.check_signals()?;
            if code.is_some() || left == 0 {
                return Ok(code);
            }
        }
    }

    /// A few cycles, and what is observed after them into an array of doubles; the exit code where the run is over.
    fn step(&self, py: Python<'_>, cycles: u64, alone: bool, into: PyBuffer<f64>) -> PyResult<Option<u8>> {
        let code =
            if cycles > CHUNK { self.go_on(py, cycles, alone)? } else { self.tried(|run| run.go_on(cycles, alone))? };
        self.observe(py, into)?;
        Ok(code)
    }

    /// What is observed, into an array of doubles; how many numbers there are.
    fn observe(&self, py: Python<'_>, into: PyBuffer<f64>) -> PyResult<usize> {
        let mut numbers = self.numbers.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        numbers.resize(into.item_count(), f64::NAN);
        let count = self.with(|run| run.observe(&mut numbers))?;
        into.copy_from_slice(py, &numbers)?;
        Ok(count)
    }

    /// Which signals and global variables are observed behind the row of the trace.
    fn watch(&self, names: Vec<String>) -> PyResult<()> {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        self.tried(|run| run.watch(&names))
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

    /// What was said since the last call, a JSON object a line.
    fn take_said(&self) -> PyResult<String> {
        self.with(Run::take_said)
    }

    /// The rows of the trace since the last call, as the bytes of doubles.
    fn take_rows<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let rows = self.with(Run::take_rows)?;
        PyBytes::new_with(py, rows.len() * 8, |bytes| {
            bytes.chunks_exact_mut(8).zip(&rows).for_each(|(to, number)| to.copy_from_slice(&number.to_ne_bytes()));
            Ok(())
        })
    }

    /// How everything stands, a JSON object.
    fn state(&self) -> PyResult<String> {
        self.told(Run::state)
    }

    /// What came of the run, or how far it is, a JSON object.
    fn summary(&self) -> PyResult<String> {
        self.told(Run::summary)
    }

    /// What each motion did, a JSON object a line.
    fn report(&self) -> PyResult<String> {
        self.with(Run::report)
    }

    /// Controller time in s.
    #[getter]
    fn time(&self) -> PyResult<f64> {
        self.with(|run| run.time())
    }

    /// Ends the programs: the robots stop on their paths within the cycles that follow.
    fn stop(&self) -> PyResult<()> {
        self.with(|run| run.stop())
    }

    /// Ends the run.
    fn close(&self) -> PyResult<()> {
        drop(self.own()?.take());
        Ok(())
    }
}
