//! From a source file to a compiled program, with as little work as the changes need.

use super::args::Checking;
use super::cache::{Cache, Lock, Place, write_if_changed};
use super::failure::Failure;
use super::progress::Progress;
use super::runtime::{Runtime, hash_state};
use super::stamp::{Freshness, Recording, Stamp};
use super::{cargo, project, robots, show};
use crate::CheckOptions;
use crate::compile::{Compiled, compile_program};
use crate::emit::EmitOptions;
use crate::sources::FileSystem;
use arl_robot::channels::Channels;
use arl_robot::islands::Island;
use arl_robot::settings::SettingsError;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

/// A compiled program, safe from other processes that would compile it as long as the lock is held.
#[derive(Debug)]
pub(super) struct Ready {
    pub(super) program: PathBuf,
    pub(super) lock: Lock,
    /// The files that were read; none where nobody wrote them down.
    pub(super) sources: Vec<PathBuf>,
}

/// The options of a check.
pub(super) fn check_options(checking: &Checking) -> Result<CheckOptions, Failure> {
    let script_dir = match &checking.script_dir {
        Some(folder) => Some(std::path::absolute(folder).map_err(|error| Failure::io("use", folder, &error))?),
        None => None,
    };
    let family = robots::family(checking.robot.as_deref())?;
    let channels = checking.cell.as_deref().map(channels_of).transpose()?;
    let Checking { strict, background, .. } = *checking;
    Ok(CheckOptions { family, strict, background, script_dir, channels, ..CheckOptions::default() })
}

/// The channels of a cell file, whose islands are right, too.
fn channels_of(cell: &Path) -> Result<Channels, Failure> {
    let name = cell.display().to_string();
    let text = std::fs::read_to_string(cell)
        .map_err(|error| Failure::Usage(format!("{name}: cannot read the cell file: {error}")))?;
    let wrong = |error: SettingsError| Failure::Usage(error.to_string());
    let channels = Channels::of_cell(&name, &text).map_err(wrong)?;
    Island::of_cell(&name, &text).map_err(wrong)?;
    Ok(channels)
}

/// Checks and emits a program, and shows what there is to say.
///
/// # Errors
/// [`Failure::Shown`] where the program has errors.
pub(super) fn compile(file: &Path, options: &CheckOptions) -> Result<(Compiled, String), Failure> {
    let mut compiled = compile_program(file, &FileSystem, options, &EmitOptions::default())?;
    show::diagnostics(&compiled);
    let rust = compiled.rust.take().ok_or(Failure::Shown)?;
    Ok((compiled, rust))
}

/// Compiles a program unless that was done before.
pub(super) fn prepare(file: &Path, checking: &Checking) -> Result<Ready, Failure> {
    let options = check_options(checking)?;
    let main = std::path::absolute(file).map_err(|error| Failure::io("use", file, &error))?;
    let cache = Cache::find()?;
    let place = cache.program(&main);
    let runtime = Runtime::find();
    let identity = identity(&options, &runtime);
    let lock = place.lock(true)?;
    if let (Freshness::Fresh, Some(stamp)) = state(&place, identity) {
        return start_again(&place, &stamp, lock);
    }
    drop(lock);
    let lock = place.lock(false)?;
    let (freshness, stamp) = state(&place, identity);
    if let (Freshness::Fresh, Some(stamp)) = (freshness, &stamp) {
        return start_again(&place, stamp, lock);
    }

    let read = Recording::new(&FileSystem);
    let mut compiled = compile_program(file, &read, &options, &EmitOptions::default())?;
    let said = show::rendered(&compiled);
    show::again(&said);
    let rust = compiled.rust.take().ok_or(Failure::Shown)?;
    // The runtime reads data files again in the script directory: here it must be the program's own folder.
    let read_again = options.script_dir.is_none() && freshness == Freshness::DataChanged;
    let kept = stamp.filter(|stamp| read_again && only_values(stamp, &compiled, &read));
    let program = match kept {
        Some(stamp) => stamp.program,
        None => build(&cache, &place, &runtime, &rust, &main, &compiled)?,
    };
    write_if_changed(&place.folder.join("said"), said.as_bytes())?;
    let path = place.folder.join(&program);
    let stamp = Stamp::of(&compiled, &read, identity, program);
    if let Some(stamp) = &stamp {
        write_if_changed(&place.stamp(), stamp.text().as_bytes())?;
    }
    Ok(Ready { program: path, lock, sources: stamp.as_ref().map(sources).unwrap_or_default() })
}

fn only_values(stamp: &Stamp, compiled: &Compiled, read: &Recording<'_>) -> bool {
    Stamp::of(compiled, read, stamp.identity, stamp.program.clone()).is_some_and(|now| stamp.same_but_values(&now))
}

/// What the stamp says. A program that is gone is as good as changed.
fn state(place: &Place, identity: u64) -> (Freshness, Option<Stamp>) {
    match Stamp::read(&place.stamp()).filter(|stamp| place.folder.join(&stamp.program).is_file()) {
        Some(stamp) => (stamp.freshness(identity), Some(stamp)),
        None => (Freshness::Stale, None),
    }
}

/// Shows the warnings again and leaves the rest as it is.
fn start_again(place: &Place, stamp: &Stamp, lock: Lock) -> Result<Ready, Failure> {
    show::again(&std::fs::read_to_string(place.folder.join("said")).unwrap_or_default());
    Ok(Ready { program: place.folder.join(&stamp.program), lock, sources: sources(stamp) })
}

fn sources(stamp: &Stamp) -> Vec<PathBuf> {
    stamp.files.iter().map(|file| file.path.clone()).collect()
}

/// Compiles the Rust and puts the program into its place under a name of its own, so that older ones run on.
fn build(
    cache: &Cache,
    place: &Place,
    runtime: &Runtime,
    rust: &str,
    main: &Path,
    compiled: &Compiled,
) -> Result<String, Failure> {
    let executable = compile_rust(cache, place, runtime, rust, main, false)?;
    let mut hasher = DefaultHasher::new();
    (rust, runtime.state()).hash(&mut hasher);
    let stem = compiled.checked.program.as_ref().map_or("program", |program| program.name.as_str());
    let name = format!("{stem}-{:016x}{}", hasher.finish(), std::env::consts::EXE_SUFFIX);
    let path = place.folder.join(&name);
    remove_old(place, &name);
    std::fs::copy(&executable, &path).map_err(|error| Failure::io("write", &path, &error))?;
    Ok(name)
}

/// Compiles emitted Rust with cargo; the executable is where cargo put it.
pub(super) fn compile_rust(
    cache: &Cache,
    place: &Place,
    runtime: &Runtime,
    rust: &str,
    main: &Path,
    release: bool,
) -> Result<PathBuf, Failure> {
    let folder = main.parent().unwrap_or(Path::new("/"));
    project::write(place, runtime, rust, folder)?;
    let profile = if release { "release" } else { "debug" };
    let first = !cache.target().join(profile).is_dir();
    let words = if first { "compiling the runtime (only this once) and the program" } else { "compiling" };
    let progress = Progress::start(words);
    let built = cargo::build(&place.folder, &cache.target(), release, &progress)?;
    drop(progress);
    match built.programs.into_iter().next() {
        Some((_, program)) if built.errors.is_empty() => Ok(program),
        _ => Err(cargo::bug(&built.errors, main)),
    }
}

/// Removes programs of earlier states. One that runs goes on where the system allows it.
fn remove_old(place: &Place, keep: &str) {
    const OURS: [&str; 7] = ["Cargo.toml", "Cargo.lock", "base.lock", "src", "stamp", "said", "lock"];
    let Ok(entries) = std::fs::read_dir(&place.folder) else { return };
    for entry in entries.filter_map(Result::ok) {
        let name = entry.file_name();
        if name != keep && !OURS.iter().any(|ours| name == *ours) {
            // What cannot be removed now is removed next time.
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// A number that changes with everything but the sources: this command, the runtime, the options.
fn identity(options: &CheckOptions, runtime: &Runtime) -> u64 {
    let mut hasher = DefaultHasher::new();
    if let Ok(command) = std::env::current_exe() {
        hash_state(&command, &mut hasher);
    }
    runtime.state().hash(&mut hasher);
    (options.family, options.strict, options.background, &options.script_dir).hash(&mut hasher);
    hasher.finish()
}
