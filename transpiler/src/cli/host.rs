//! What other doors than the command need: the package for Python.
//!
//! Everything here is as the command does it, with the same `arl.toml`, cache and words.

use super::args::{Checking, RunOptions};
use super::cache::{Cache, Kind, Lock};
use super::check;
use super::failure::Failure;
use super::program::{self, prepare_checked};
use super::sweep;
pub use super::sweep::{
    Bundle, Kept, MAX_TIME, Parameters, Row, RunResult, Settings, Spread, Sweep, TIMEOUT, Worker, as_arl,
};
use crate::compile::{guard, on_large_stack};
use arl_robot::Robot;
use std::fmt;
use std::path::{Path, PathBuf};

/// Why something could not be done.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub enum HostError {
    /// Programs have mistakes: a JSON object each, as `arl2rs check --format json` says them, with the warnings.
    Mistakes(Vec<String>),
    /// What is asked for cannot be.
    Usage(String),
    /// Something around the compiler went wrong: cargo is missing, a folder cannot be written.
    Other(String),
}

impl fmt::Display for HostError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            HostError::Mistakes(_) => f.write_str("the program has mistakes"),
            HostError::Usage(text) | HostError::Other(text) => f.write_str(text),
        }
    }
}

impl std::error::Error for HostError {}

impl From<Failure> for HostError {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Shown => Self::Other("a program has mistakes: they were said on the standard error".into()),
            Failure::Usage(text) => Self::Usage(text),
            Failure::Other(text) => Self::Other(text),
        }
    }
}

/// A compiled library. As long as this lives nobody compiles the program anew, which would remove it: it is for loading it.
#[derive(Debug)]
pub struct CompiledLibrary {
    /// The file.
    pub path: PathBuf,
    /// The words that all runs need: robot, cell, scenario and folder, from the settings and the `arl.toml`.
    pub words: Vec<String>,
    _lock: Lock,
}

/// Says which file this code is in, where that is not the program of the process: what another one compiled is compiled anew.
pub fn is_part_of(file: PathBuf) {
    program::is_part_of(file);
}

/// What there is to say of programs, a JSON object each.
///
/// # Errors
/// A file cannot be read, or the robot or the cell is none.
pub fn check(
    files: &[PathBuf],
    settings: &Settings,
    (strict, background): (bool, bool),
) -> Result<Vec<String>, HostError> {
    found(files, settings, (strict, background)).map(|(all, _)| all)
}

/// Compiles a program into a library, unless that was done before.
///
/// # Errors
/// It has mistakes, or cannot be compiled here.
pub fn library(settings: &Settings) -> Result<CompiledLibrary, HostError> {
    mistakes(settings)?;
    safely(|| {
        let program = &settings.program;
        let options = options(settings).of_program(program)?;
        let ready = prepare_checked(Kind::Library, program, options.cell.as_deref(), &options.checking())?;
        let folder = options.script_dir.clone().map_or_else(|| folder_of(program), Ok)?;
        let named = [
            ("--robot", options.robot.as_deref().map(robot).transpose()?),
            ("--cell", options.cell.as_deref().map(full).transpose()?),
            ("--io", options.io.as_deref().map(full).transpose()?),
            ("--script-dir", Some(full(&folder)?)),
            ("--max-time", settings.max_time.map(|seconds| seconds.to_string())),
        ];
        let words = named.into_iter().filter_map(|(name, value)| Some([name.to_owned(), value?])).flatten().collect();
        Ok(CompiledLibrary { path: ready.program, words, _lock: ready.lock })
    })
}

/// Compiles a program for a sweep, and gathers all that its runs depend on. `rows` may name robots and scenarios of their own.
///
/// # Errors
/// It has mistakes, cannot be compiled here, a file cannot be read, or no row has parameters that there are.
pub fn bundle(settings: &Settings, rows: &[Parameters]) -> Result<Bundle, HostError> {
    mistakes(settings)?;
    safely(|| Bundle::new(settings, rows.iter()))
}

/// The file of a sweep.
///
/// # Errors
/// It cannot be read, or says what it cannot say.
pub fn table(file: &Path) -> Result<Sweep, HostError> {
    safely(|| Sweep::read(file))
}

/// Makes runs on so many processes (0: one for each core), and hands out their rows in order, until `is_enough`. With `keeps`, what is known from
/// earlier does not run again, and what is new is kept. `warn` is told what is no reason to end.
///
/// # Errors
/// The program cannot be written to the disk.
pub fn sweep(
    bundle: &Bundle,
    rows: &[Parameters],
    (processes, timeout, keeps): (usize, Option<f64>, bool),
    is_enough: &(dyn Fn() -> bool + Sync),
    take: &mut dyn FnMut(Row),
    warn: &mut dyn FnMut(&str),
) -> Result<(), HostError> {
    sweep::all(bundle, rows, (processes, timeout, keeps), is_enough, take, warn).map_err(HostError::from)
}

/// The results that are kept of a bundle on this computer.
///
/// # Errors
/// There is no folder for them.
pub fn kept(bundle: &Bundle) -> Result<Kept, HostError> {
    let path = Cache::find()?.results(&bundle.key());
    Kept::open(&path).map_err(|error| HostError::Other(format!("{}: {error}", path.display())))
}

fn safely<T: Send>(work: impl FnOnce() -> Result<T, Failure> + Send) -> Result<T, HostError> {
    match on_large_stack(|| guard(work)) {
        Ok(done) => Ok(done?),
        Err(bug) => Err(HostError::Other(bug.to_string())),
    }
}

/// Refuses a program with mistakes.
fn mistakes(settings: &Settings) -> Result<(), HostError> {
    let (all, refused) = found(std::slice::from_ref(&settings.program), settings, (false, false))?;
    if refused { Err(HostError::Mistakes(all)) } else { Ok(()) }
}

fn found(
    files: &[PathBuf],
    settings: &Settings,
    (strict, background): (bool, bool),
) -> Result<(Vec<String>, bool), HostError> {
    let Settings { robot, cell, script_dir, .. } = settings.clone();
    let checking = Checking { strict, background, robot, cell, script_dir, verbose: false };
    safely(|| check::found(files, &checking))
}

fn options(settings: &Settings) -> RunOptions {
    let Settings { robot, cell, io, script_dir, .. } = settings.clone();
    RunOptions { robot, cell, io, script_dir, ..RunOptions::default() }
}

fn folder_of(program: &Path) -> Result<PathBuf, Failure> {
    let full = super::several::absolute(program)?;
    Ok(full.parent().map(Path::to_path_buf).unwrap_or_default())
}

/// A robot by its name, or its file in full.
fn robot(name: &str) -> Result<String, Failure> {
    if Robot::text(name).is_some() { Ok(name.to_owned()) } else { full(Path::new(name)) }
}

fn full(path: &Path) -> Result<String, Failure> {
    Ok(super::several::absolute(path)?.display().to_string())
}
