//! The Rust part of the package `arl2rs`: what the command and the libraries of programs do, for its Python side.

mod farm;
mod problem;
mod robot;
mod session;
mod value;

use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

use arl2rs_cli::host::{self, EngineChoice, Settings};
use pyo3::prelude::*;

/// Executes the command from the file of this library, without the Python side: importing that takes longer.
const COMMAND: &str = "
import importlib.util, signal, sys
signal.signal(signal.SIGINT, signal.SIG_DFL)
spec = importlib.util.spec_from_file_location('_arl2rs', sys.argv[1])
module = importlib.util.module_from_spec(spec)
spec.loader.exec_module(module)
sys.exit(module.command(['arl2rs', *sys.argv[2:]]))
";

#[pymodule]
mod _arl2rs {
    #[pymodule_export]
    use super::farm::{Bundle, Kept, Worker, lost, sweep, table};
    #[pymodule_export]
    use super::problem::{Failed, Gone, Mistakes, Refused};
    #[pymodule_export]
    use super::robot::{Robot, robots};
    #[pymodule_export]
    use super::session::{Library, Session};
    #[pymodule_export]
    use super::value::value;
    use std::ffi::OsString;

    #[pymodule_export]
    use super::{Text, check, command, literal, signals, variables, words};
    use pyo3::prelude::*;

    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
    #[pymodule_export]
    const MAX_TIME: f64 = super::host::MAX_TIME;
    #[pymodule_export]
    const TIMEOUT: f64 = super::host::TIMEOUT;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        // What an older package has compiled is compiled again. The command is started by way of Python.
        if let Ok(file) = module.filename().and_then(|file| Ok(std::path::absolute(file.to_string())?)) {
            // An interpreter that is part of another program has none.
            let python: Option<OsString> = module.py().import("sys")?.getattr("executable")?.extract().ok();
            let python = python.filter(|python| !python.is_empty());
            let words = ["-I", "-S", "-c", super::COMMAND].map(OsString::from);
            let command = python.map(|python| [python].into_iter().chain(words).chain([file.clone().into()]).collect());
            super::host::is_part_of(file, command.unwrap_or_default());
        }
        Ok(())
    }
}

/// What is run, as given by Python.
#[derive(FromPyObject, IntoPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Given {
    program: PathBuf,
    robot: Option<String>,
    cell: Option<PathBuf>,
    io: Option<PathBuf>,
    script_dir: Option<PathBuf>,
    /// Whether it is compiled; `None`: as an `arl.toml` says.
    native: Option<bool>,
    files: Vec<PathBuf>,
    max_time: Option<f64>,
    timeout: Option<f64>,
    collisions: bool,
    clearance: Option<f64>,
}

impl From<Settings> for Given {
    fn from(settings: Settings) -> Self {
        let Settings { program, robot, cell, io, script_dir, files, engine, max_time, timeout, collisions, clearance } =
            settings;
        let native = engine.map(|engine| engine == EngineChoice::Native);
        Self { program, robot, cell, io, script_dir, native, files, max_time, timeout, collisions, clearance }
    }
}

impl From<Given> for Settings {
    fn from(given: Given) -> Self {
        let Given { program, robot, cell, io, script_dir, native, files, max_time, timeout, collisions, clearance } =
            given;
        let engine = native.map(|native| if native { EngineChoice::Native } else { EngineChoice::Engine });
        Self { program, robot, cell, io, script_dir, files, engine, max_time, timeout, collisions, clearance }
    }
}

/// The diagnostics of programs, a JSON object each.
#[pyfunction]
fn check(py: Python<'_>, files: Vec<PathBuf>, given: Given, strict: bool, background: bool) -> PyResult<Vec<String>> {
    let settings = given.into();
    interruptible(py, move || host::check(&files, &settings, strict, background))?.map_err(problem::of_host)
}

/// The global variables of a program, a JSON object each.
#[pyfunction]
fn variables(py: Python<'_>, given: Given) -> PyResult<Vec<String>> {
    let settings = given.into();
    let all = interruptible(py, move || host::variables(&settings))?.map_err(problem::of_host)?;
    all.iter().map(farm::written).collect()
}

/// The signals of a program's cell, each with its name in the cell.
#[pyfunction]
fn signals(given: Given) -> PyResult<Vec<(String, Option<String>)>> {
    let all = host::signals(&given.into()).map_err(problem::of_host)?;
    Ok(all.into_iter().map(|(signal, name)| (signal.to_string(), name)).collect())
}

/// A program that was given as text; it stays in the cache as long as this object lives.
#[pyclass(frozen)]
struct Text {
    program: host::TextProgram,
}

#[pymethods]
impl Text {
    /// Takes the files, the main one first: names and texts.
    #[new]
    fn new(py: Python<'_>, files: Vec<(String, String)>) -> PyResult<Self> {
        let program = interruptible(py, move || host::text_program(&files))?.map_err(problem::of_host)?;
        Ok(Self { program })
    }

    /// Its main file.
    #[getter]
    fn path(&self) -> PathBuf {
        self.program.path.clone()
    }
}

/// The command-line words of parameters, which are JSON.
#[pyfunction]
fn words(parameters: &str) -> PyResult<Vec<String>> {
    farm::parameters(parameters)?.words().map_err(problem::Refused::new_err)
}

/// A value, which is JSON, as a literal of ARL.
#[pyfunction]
fn literal(value: &str) -> PyResult<String> {
    let value = farm::read(value)?;
    host::as_arl(&value).ok_or_else(|| problem::Refused::new_err("None is not a value of ARL"))
}

/// How often to check whether Ctrl-C was pressed, and whether something has ended.
pub(crate) const LOOK_INTERVAL: Duration = Duration::from_millis(2);

/// Does something long on a thread of its own, while this thread handles Ctrl-C. Work that is given up is left to
/// itself.
pub(crate) fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    let worker = std::thread::spawn(work);
    while !worker.is_finished() {
        py.detach(|| std::thread::sleep(LOOK_INTERVAL));
        py.check_signals()?;
    }
    worker.join().map_err(|_| problem::Failed::new_err("a bug in arl2rs: standard error says where it panicked"))
}

/// Executes these words, as the command does; returns its exit code.
#[pyfunction]
fn command(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| arl2rs_cli::command(words))
}
