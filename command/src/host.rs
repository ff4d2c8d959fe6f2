//! What hosts other than the command need: the package for Python.
//!
//! Everything here works as in the command, with the same `arl.toml`, cache and messages.

use crate::check;
pub use crate::engine::CodeProgram;
use crate::sweep;
pub use crate::sweep::{
    Bundle, Kept, MAX_TIME, Parameters, Row, RunResult, Settings, Spread, Sweep, SweepSettings, TIMEOUT, Worker, as_arl,
};
use crate::variables;
pub use crate::variables::Variable;
use arl_project::cache::{Cache, Lock};
pub use arl_project::options::EngineChoice;
use arl_project::options::{Checking, RunOptions};
use arl_project::program::{self, InProcess, prepare_in_process};
use arl_robot::cell::{Cell, Signal, SignalKind};
use arl_robot::settings::Source;
use arl_robot::{Robot, atomic_file, regular_file};
use arl_terminal::failure::Failure;
use arl_terminal::private_folder::PrivateFolder;
use arl2rs::compile::{guard, on_large_stack};
use std::ffi::OsString;
use std::fmt;
use std::path::{Component, Path, PathBuf};
use twox_hash::XxHash3_128;

/// Why something could not be done.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub enum HostError {
    /// Programs have mistakes: a JSON object each, as in `arl2rs check --format json`, with the warnings.
    Mistakes(Vec<String>),
    /// The request cannot be fulfilled.
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
            Failure::Shown => Self::Other("a program has mistakes: they were written to standard error".into()),
            Failure::Usage(text) => Self::Usage(text),
            Failure::Other(text) => Self::Other(text),
        }
    }
}

/// A program that runs in this process.
pub struct Prepared {
    /// What runs.
    pub program: PreparedProgram,
    /// The command-line words that all runs need: robot, cell, scenario and folder, from the settings and the
    /// `arl.toml`.
    pub words: Vec<String>,
}

/// What runs.
pub enum PreparedProgram {
    /// A compiled library. As long as the lock is held, the program is not compiled again, which would remove it: it is
    /// for loading it.
    Library(PathBuf, Option<Lock>),
    /// Code, for the engine of this process.
    Code(CodeProgram),
}

/// Sets which file this code is in, if that is not the program of the process: what another file compiled is compiled
/// again; and the words that start the command `arl2rs`.
pub fn is_part_of(file: PathBuf, command: Vec<OsString>) {
    program::is_part_of(file, command);
}

/// The diagnostics of programs, a JSON object each.
///
/// # Errors
/// A file cannot be read, or the robot or the cell is not valid.
pub fn check(files: &[PathBuf], settings: &Settings, strict: bool, background: bool) -> Result<Vec<String>, HostError> {
    found(files, settings, strict, background).map(|(all, _)| all)
}

/// Makes a program ready to run in this process: by the engine, or compiled into a library where the settings ask for
/// that, or where it was compiled before.
///
/// # Errors
/// The program has mistakes, or cannot be compiled here.
pub fn prepared(settings: &Settings) -> Result<Prepared, HostError> {
    mistakes(settings)?;
    safely(|| {
        let program = &settings.program;
        let options = options(settings).of_program(program)?;
        options.io.as_deref().map_or(Ok(()), scenario)?;
        let program_in_process = prepare_in_process(program, &options)?;
        let folder = options.script_dir.clone().map_or_else(|| folder_of(program), Ok)?;
        let named = [
            ("--robot", options.robot.as_deref().map(robot).transpose()?),
            ("--cell", options.cell.as_deref().map(full).transpose()?),
            ("--io", options.io.as_deref().map(full).transpose()?),
            ("--script-dir", Some(full(&folder)?)),
            ("--max-time", settings.max_time.map(|seconds| seconds.to_string())),
        ];
        let words = named.into_iter().filter_map(|(name, value)| Some([name.to_owned(), value?])).flatten().collect();
        let program = match program_in_process {
            InProcess::Library(ready) => PreparedProgram::Library(ready.program, ready.lock),
            InProcess::Code(bundle) => PreparedProgram::Code(CodeProgram::of(*bundle)),
        };
        Ok(Prepared { program, words })
    })
}

/// The global variables of a program, in the order of their files and declarations.
///
/// # Errors
/// The program cannot be read, or the robot or the cell is not there.
pub fn variables(settings: &Settings) -> Result<Vec<Variable>, HostError> {
    safely(|| {
        let checking = options(settings).of_program(&settings.program)?.checking();
        variables::of_program(&settings.program, &checking)
    })
}

/// The signals of a program's cell, each with its name in the cell, if it has one.
///
/// # Errors
/// The cell cannot be read.
pub fn signals(settings: &Settings) -> Result<Vec<(Signal, Option<String>)>, HostError> {
    safely(|| {
        let options = options(settings).of_program(&settings.program)?;
        let cell = options.cell.as_deref().map(Cell::load).transpose();
        let cell = cell.map_err(|error| Failure::Usage(error.to_string()))?;
        let (channels, names) = cell.map(|cell| (cell.channels, cell.names)).unwrap_or_default();
        let of_kind = |kind: SignalKind| {
            let signals = (1..=kind.count(&channels)).map(move |channel| Signal { kind, channel });
            signals.map(|signal| (signal, names.of(signal).map(str::to_owned))).collect::<Vec<_>>()
        };
        Ok(SignalKind::all().flat_map(of_kind).collect())
    })
}

/// The folder of the texts in the folder of a program that was given as text.
const TEXTS: &str = "texts";

/// A program that was given as text, in a folder of the cache. As long as this value lives, the folder is not removed.
#[derive(Debug)]
pub struct TextProgram {
    /// Its main file.
    pub path: PathBuf,
    _kept: KeptFolder,
}

/// What keeps the folder of a text.
#[derive(Debug)]
enum KeptFolder {
    /// It is in the cache.
    Locked(#[expect(dead_code, reason = "held until dropped")] Lock),
    /// It is of this process alone.
    Own(#[expect(dead_code, reason = "held until dropped")] PrivateFolder),
}

/// The folder of a text: in the cache, or where there is none, one of this process.
fn text_folder(hash: &str) -> Result<(PathBuf, KeptFolder), Failure> {
    let in_cache = || {
        let folder = Cache::find()?.text(hash);
        let lock = Lock::take(&folder, true, "waiting for another arl2rs that is removing this program")?;
        Ok((folder, KeptFolder::Locked(lock)))
    };
    match in_cache() {
        Err(Failure::Usage(text)) => Err(Failure::Usage(text)),
        Err(_) => {
            let folder = PrivateFolder::new("arl2rs-text-");
            let folder = folder.map_err(|error| Failure::Other(format!("cannot make a temporary folder: {error}")))?;
            Ok((folder.path().to_owned(), KeptFolder::Own(folder)))
        }
        found => found,
    }
}

/// Puts a program that is given as text into the cache: its main file first, then the files beside it, by their names.
/// The same texts have the same folder, so that they are compiled once.
///
/// # Errors
/// A name leads out of the folder, or it cannot be written.
pub fn text_program(files: &[(String, String)]) -> Result<TextProgram, HostError> {
    safely(|| {
        let mut hasher = XxHash3_128::new();
        for (name, text) in files {
            if !Path::new(name).components().all(|part| matches!(part, Component::Normal(_))) || name.is_empty() {
                return Err(Failure::Usage(format!("{name:?}: expected the name of a file, like \"points.arl\"")));
            }
            for part in [name, text] {
                hasher.write(&(part.len() as u64).to_le_bytes());
                hasher.write(part.as_bytes());
            }
        }
        let (main, _) = files.first().ok_or_else(|| Failure::Usage("expected the text of the program".into()))?;
        let hash = format!("{:032x}", hasher.finish_128());
        let (folder, kept) = text_folder(&hash)?;
        // Not where the lock is: a text may have the lock's name.
        let folder = folder.join(TEXTS);
        for (name, text) in files {
            let path = folder.join(name);
            let parent = path.parent().unwrap_or(&folder);
            std::fs::create_dir_all(parent).map_err(|error| Failure::io("make the folder", parent, &error))?;
            // Other processes may read the file, and write the same.
            if std::fs::read(&path).is_ok_and(|there| there == text.as_bytes()) {
                continue;
            }
            let written = atomic_file::write(&path, text.as_bytes());
            written.map_err(|error| Failure::io("write", &path, &error))?;
        }
        Ok(TextProgram { path: folder.join(main), _kept: kept })
    })
}

/// Compiles a program for a sweep, and gathers all that its runs depend on. `rows` may name robots and scenarios of
/// their own.
///
/// # Errors
/// The program has mistakes, cannot be compiled here, a file cannot be read, or no row has known parameters.
pub fn bundle(settings: &Settings, rows: &[Parameters]) -> Result<Bundle, HostError> {
    mistakes(settings)?;
    safely(|| Bundle::new(settings, rows.iter()))
}

/// Reads the file of a sweep.
///
/// # Errors
/// The file cannot be read, or its content is not valid.
pub fn table(file: &Path) -> Result<Sweep, HostError> {
    safely(|| Sweep::read(file))
}

/// Makes runs, and passes on their rows in order, until `is_enough`. `warn` gets what is no reason to end.
///
/// # Errors
/// The program cannot be written to the disk.
pub fn sweep(
    bundle: &Bundle,
    rows: &[Parameters],
    settings: SweepSettings,
    is_enough: &(dyn Fn() -> bool + Sync),
    take: &mut dyn FnMut(Row),
    warn: &mut dyn FnMut(&str),
) -> Result<(), HostError> {
    sweep::all(bundle, rows, settings, is_enough, take, warn).map_err(HostError::from)
}

/// The kept results of a bundle on this computer.
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
    let (all, refused) = found(std::slice::from_ref(&settings.program), settings, false, false)?;
    if refused { Err(HostError::Mistakes(all)) } else { Ok(()) }
}

fn found(
    files: &[PathBuf],
    settings: &Settings,
    strict: bool,
    background: bool,
) -> Result<(Vec<String>, bool), HostError> {
    let Settings { robot, cell, script_dir, .. } = settings.clone();
    let checking = Checking { strict, background, robot, cell, script_dir, verbose: false };
    safely(|| check::found(files, &checking))
}

fn options(settings: &Settings) -> RunOptions {
    let Settings { robot, cell, io, script_dir, engine, .. } = settings.clone();
    RunOptions { robot, cell, io, script_dir, engine, ..RunOptions::default() }
}

/// Checks that a scenario is there, and is TOML; whether it fits the cell shows when a run begins.
fn scenario(path: &Path) -> Result<(), Failure> {
    let shown = path.display().to_string();
    let text = regular_file::read_text(path)
        .map_err(|error| Failure::Usage(format!("cannot read the scenario {shown}: {error}")))?;
    let source = Source { file: &shown, text: &text };
    source.parse().map(drop).map_err(|error| Failure::Usage(error.to_string()))
}

fn folder_of(program: &Path) -> Result<PathBuf, Failure> {
    let full = arl_project::cell_programs::absolute(program)?;
    Ok(full.parent().map(Path::to_path_buf).unwrap_or_default())
}

/// A robot by its name, or the full path of its file.
fn robot(name: &str) -> Result<String, Failure> {
    if Robot::text(name).is_some() { Ok(name.to_owned()) } else { full(Path::new(name)) }
}

fn full(path: &Path) -> Result<String, Failure> {
    Ok(arl_project::cell_programs::absolute(path)?.display().to_string())
}
