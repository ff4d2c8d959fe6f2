//! Many runs: tables of parameters, what runs depend on, and processes that make them.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use arl2rs_cli::host::{self, Parameters, Row, RunResult, Settings, Spread, Sweep, SweepSettings};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::problem::{Failed, Refused, of_host};
use crate::{Given, LOOK_INTERVAL, interruptible};

/// The file of a sweep: the settings, as a dictionary, and the parameters of each run, as JSON.
#[pyfunction]
pub(crate) fn table(file: PathBuf) -> PyResult<(Given, Vec<String>)> {
    let Sweep { settings, rows } = host::table(&file).map_err(of_host)?;
    let rows: PyResult<Vec<String>> = rows.iter().map(written).collect();
    Ok((settings.into(), rows?))
}

/// Reads JSON of the Python side.
pub(crate) fn read<T: DeserializeOwned>(text: &str) -> PyResult<T> {
    serde_json::from_str(text).map_err(|error| PyValueError::new_err(format!("{text}: {error}")))
}

pub(crate) fn parameters(row: &str) -> PyResult<Parameters> {
    read(row)
}

pub(crate) fn written(value: &impl Serialize) -> PyResult<String> {
    serde_json::to_string(value).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// The result of a run that could not begin, or was lost.
#[pyfunction]
pub(crate) fn lost(outcome: &str, problem: String) -> PyResult<String> {
    written(&RunResult::lost(outcome, problem))
}

/// The kept results of a bundle on this computer.
#[pyclass(frozen)]
pub(crate) struct Kept {
    kept: Mutex<host::Kept>,
}

#[pymethods]
impl Kept {
    #[new]
    fn new(bundle: &Bundle) -> PyResult<Self> {
        Ok(Self { kept: Mutex::new(host::kept(&bundle.bundle).map_err(of_host)?) })
    }

    /// The result of the run of these words, as JSON.
    fn find(&self, words: Vec<String>) -> PyResult<Option<String>> {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.find(&words).map(written).transpose()
    }

    /// Keeps a result.
    fn keep(&self, words: Vec<String>, result: &str) -> PyResult<()> {
        let result: RunResult = read(result)?;
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(kept.keep(&words, &result)?)
    }
}

/// All that the runs of a sweep depend on except their parameters.
#[pyclass(frozen)]
pub(crate) struct Bundle {
    bundle: host::Bundle,
    timeout: Option<f64>,
}

#[pymethods]
impl Bundle {
    /// Compiles the program if needed, and gathers what it reads.
    #[new]
    fn new(py: Python<'_>, given: Given, rows: Vec<String>) -> PyResult<Self> {
        let settings: Settings = given.into();
        let rows = rows.iter().map(|row| parameters(row)).collect::<PyResult<Vec<_>>>()?;
        let timeout = settings.timeout;
        let bundle = interruptible(py, move || host::bundle(&settings, &rows))?.map_err(of_host)?;
        Ok(Self { bundle, timeout })
    }

    /// The hash of everything in it.
    #[getter]
    fn key(&self) -> String {
        self.bundle.key()
    }

    /// The files: their places in the bundle, and their contents.
    #[getter]
    fn files<'py>(&self, py: Python<'py>) -> Vec<(String, Bound<'py, PyBytes>)> {
        self.bundle.files.iter().map(|(place, bytes)| (place.clone(), PyBytes::new(py, bytes))).collect()
    }

    /// In mm, if runs look for collisions.
    #[getter]
    fn clearance(&self) -> Option<f64> {
        self.bundle.clearance
    }

    /// The words of a run.
    fn words(&self, row: &str) -> PyResult<Vec<String>> {
        self.bundle.words(&parameters(row)?).map_err(Refused::new_err)
    }

    /// The row of a run in the form of a sweep, from its number, its parameters and its result.
    fn row(&self, run: usize, parameters: &str, result: &str) -> PyResult<String> {
        let result = self.bundle.in_own_names(read(result)?);
        written(&Row { run, parameters: read(parameters)?, result })
    }
}

/// Makes all runs on this computer; `take` gets each row as JSON, in order, and `warn` what is no reason to end.
#[pyfunction]
pub(crate) fn sweep(
    py: Python<'_>,
    bundle: &Bundle,
    rows: Vec<String>,
    processes: usize,
    keeps: bool,
    take: Py<PyAny>,
    warn: Py<PyAny>,
) -> PyResult<()> {
    let rows = rows.iter().map(|row| parameters(row)).collect::<PyResult<Vec<_>>>()?;
    let (enough, problem) = (AtomicBool::new(false), Mutex::new(None));
    let fail = |error: PyErr| {
        enough.store(true, Ordering::Relaxed);
        let mut problem = problem.lock().unwrap_or_else(PoisonError::into_inner);
        problem.get_or_insert(error);
    };
    let call = |function: &Py<PyAny>, text: &str| {
        if let Err(error) = Python::attach(|py| function.call1(py, (text,)).map(drop)) {
            fail(error);
        }
    };
    let ended = py.detach(|| {
        std::thread::scope(|scope| {
            // This thread handles Ctrl-C: the runs are made on another one.
            let runs = scope.spawn(|| {
                let mut row = |row: Row| match written(&row) {
                    Ok(text) => call(&take, &text),
                    Err(error) => fail(error),
                };
                let how = SweepSettings { processes, timeout: bundle.timeout, keeps };
                let is_enough = || enough.load(Ordering::Relaxed);
                host::sweep(&bundle.bundle, &rows, how, &is_enough, &mut row, &mut |text| call(&warn, text))
            });
            while !runs.is_finished() {
                std::thread::sleep(LOOK_INTERVAL);
                if let Err(error) = Python::attach(|py| py.check_signals()) {
                    fail(error);
                }
            }
            runs.join()
        })
    });
    if let Some(error) = problem.into_inner().unwrap_or_else(PoisonError::into_inner) {
        return Err(error);
    }
    match ended {
        Ok(ended) => ended.map_err(of_host),
        Err(_) => Err(Failed::new_err("a bug in arl2rs: standard error says where the sweep panicked")),
    }
}

/// A process that makes one run of a bundle after another.
#[pyclass(frozen)]
pub(crate) struct Worker {
    worker: Mutex<host::Worker>,
}

#[pymethods]
impl Worker {
    /// A worker with the files of a bundle; with a clearance it looks for collisions.
    #[new]
    fn new(files: Vec<(String, Vec<u8>)>, timeout: Option<f64>, clearance: Option<f64>) -> PyResult<Self> {
        let spread = Spread::of(files)?;
        let worker = host::Worker::new(&spread, timeout, clearance).map_err(PyOSError::new_err)?;
        Ok(Self { worker: Mutex::new(worker) })
    }

    /// Makes a run: its result, as JSON, and whether the same run gives it again.
    fn run(&self, py: Python<'_>, words: Vec<String>) -> PyResult<(String, bool)> {
        let ran = py.detach(|| {
            let interrupted = || Python::attach(|py| py.check_signals()).is_err();
            let mut worker = self.worker.lock().unwrap_or_else(PoisonError::into_inner);
            worker.run(&words, &interrupted)
        });
        let (result, again) = ran.ok_or_else(|| pyo3::exceptions::PyKeyboardInterrupt::new_err(()))?;
        Ok((written(&result)?, again))
    }
}
