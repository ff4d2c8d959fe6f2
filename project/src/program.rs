//! Compiles a program from its source file, with as little work as the changes require.

use crate::cache::{Cache, Content, Kind, Lock, Place, RECORD, write_if_changed};
use crate::cargo;
use crate::cell_programs::{self, Other, absolute};
use crate::listing;
use crate::options::Checking;
use crate::package;
use crate::package::{Emitted, EmittedOther};
use crate::robots;
use crate::runtime::{Runtime, hash_state};
use crate::stamp::{Freshness, Kept, Recording, Stamp};
use arl_robot::cell::Cell;
use arl_robot::outline::Outline;
use arl_terminal::failure::Failure;
use arl_terminal::progress::Progress;
use arl_terminal::show;
use arl2rs::CheckOptions;
use arl2rs::Sources;
use arl2rs::compile::{Bug, Compiled, compile_program};
use arl2rs::emit::EmitOptions;
use arl2rs::sources::FileSystem;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// A compiled program, which other processes cannot compile again while the lock is held.
#[derive(Debug)]
pub struct Ready {
    /// The executable, or the library.
    pub program: PathBuf,
    /// No other process compiles the program again while this is held.
    pub lock: Lock,
    /// The files that were read; empty if they were not recorded.
    pub sources: Vec<PathBuf>,
}

/// The options of a check.
///
/// # Errors
/// The robot does not exist, or the cell file cannot be read.
pub fn check_options(checking: &Checking) -> Result<CheckOptions, Failure> {
    let script_dir = match &checking.script_dir {
        Some(folder) => Some(std::path::absolute(folder).map_err(|error| Failure::io("use", folder, &error))?),
        None => None,
    };
    let family = robots::family(checking.robot.as_deref())?;
    let cell = checking.cell.as_deref().map(outline).transpose()?;
    let Checking { strict, background, .. } = *checking;
    Ok(CheckOptions { family, strict, background, script_dir, cell, ..CheckOptions::default() })
}

/// What a cell file provides for programs.
fn outline(cell: &Path) -> Result<Outline, Failure> {
    let cell = Cell::load(cell).map_err(|error| Failure::Usage(error.to_string()))?;
    Ok(Outline::of(&cell))
}

/// The file that contains the compiler, if it is not the executable of this process.
static COMPILER: OnceLock<PathBuf> = OnceLock::new();

/// Sets the file that contains the compiler.
pub fn is_part_of(file: PathBuf) {
    let _ = COMPILER.set(file);
}

/// Everything that becomes one program: the program on the command line and those that its cell names.
#[derive(Debug)]
pub struct Job<'a> {
    file: &'a Path,
    cell: Option<&'a Path>,
    options: CheckOptions,
    others: Vec<(Other, CheckOptions)>,
    kind: Kind,
    /// Whether its warnings have been shown.
    is_checked: bool,
}

/// A finished job: the results of the check, that of the first program first, and the emitted Rust.
pub struct Done {
    programs: Vec<Compiled>,
    /// The emitted Rust.
    pub rust: Emitted,
    /// The messages, rendered.
    messages: String,
}

impl<'a> Job<'a> {
    /// A job for a program and the additional programs of its cell.
    ///
    /// # Errors
    /// A robot or a cell file cannot be read, or the channels of the cell are not valid.
    pub fn new(file: &'a Path, cell: Option<&'a Path>, checking: &Checking) -> Result<Self, Failure> {
        let others = cell_programs::named(cell, checking.robot.as_deref())?;
        let with_options = |other: Other| check_options(&other.checking(checking)).map(|options| (other, options));
        Ok(Self {
            file,
            cell: cell.filter(|_| !others.is_empty()),
            options: check_options(checking)?,
            others: others.into_iter().map(with_options).collect::<Result<_, _>>()?,
            kind: Kind::Program,
            is_checked: false,
        })
    }

    /// The same job, to be compiled into `kind`.
    pub fn into_kind(self, kind: Kind) -> Self {
        Self { kind, ..self }
    }

    /// The main file as an absolute path.
    ///
    /// # Errors
    /// The current folder cannot be determined.
    pub fn main(&self) -> Result<PathBuf, Failure> {
        absolute(self.file)
    }

    /// The place of the program in the cache.
    ///
    /// # Errors
    /// The current folder cannot be determined.
    pub fn place(&self, cache: &Cache) -> Result<Place, Failure> {
        let place = match self.cell {
            Some(cell) => cache.programs(&self.main()?, &absolute(cell)?),
            None => cache.program(&self.main()?),
        };
        Ok(place.of(self.kind))
    }

    /// Checks and emits all programs, and shows their messages.
    ///
    /// # Errors
    /// [`Failure::Shown`] if a program has errors.
    pub fn compile(&self, sources: &dyn Sources) -> Result<Done, Failure> {
        let (watched, named) = (self.kind == Kind::Watched, matches!(self.kind, Kind::Library | Kind::Named));
        let emitting = EmitOptions { watched, named, ..EmitOptions::default() };
        let emit = |file: &Path, options| compile_program(file, sources, options, &emitting).map_err(bug);
        let mut programs = vec![emit(self.file, &self.options)?];
        for (other, options) in &self.others {
            programs.push(emit(&other.path, options)?);
        }
        let mut limit = listing::Limit::default();
        let messages: String = programs.iter().map(|compiled| listing::rendered(compiled, &mut limit)).collect();
        if !self.is_checked || programs.iter().any(|compiled| compiled.rust.is_none()) {
            show::say(&messages);
        }
        let rust: Option<Vec<String>> = programs.iter_mut().map(|compiled| compiled.rust.take()).collect();
        let mut rust = rust.ok_or(Failure::Shown)?.into_iter();
        let first = rust.next().ok_or(Failure::Shown)?;
        let main = self.main()?;
        let beside = |((other, _), rust): (&(Other, CheckOptions), String)| {
            Ok(EmittedOther { file: other.file.clone(), folder: other.folder(&main)?, rust })
        };
        let others = self.others.iter().zip(rust).map(beside).collect::<Result<_, Failure>>()?;
        Ok(Done { programs, rust: Emitted { first, others, kind: self.kind }, messages })
    }

    /// A number that changes with everything except the sources: this command, the runtime, the options, the channels.
    fn identity(&self, runtime: Runtime) -> u64 {
        let mut hasher = DefaultHasher::new();
        if let Some(compiler) = COMPILER.get().cloned().or_else(|| std::env::current_exe().ok()) {
            hash_state(&compiler, &mut hasher);
        }
        runtime.state().hash(&mut hasher);
        let of_options = |options: &CheckOptions| (options.family, options.strict, options.background);
        (of_options(&self.options), &self.options.script_dir).hash(&mut hasher);
        self.others.iter().for_each(|(other, options)| (other, of_options(options)).hash(&mut hasher));
        hasher.finish()
    }
}

/// A bug of the compiler as the failure of the command.
pub fn bug(bug: Bug) -> Failure {
    Failure::Other(bug.to_string())
}

/// Compiles a program together with those that its cell names, unless that was done before.
///
/// # Errors
/// The program is refused or cannot be compiled; the error gives the reason and the position.
pub fn prepare(kind: Kind, file: &Path, cell: Option<&Path>, checking: &Checking) -> Result<Ready, Failure> {
    prepare_job(&Job::new(file, cell, checking)?.into_kind(kind), checking)
}

/// Like `prepare`, for a program whose warnings have been shown by a check.
///
/// # Errors
/// As for [`prepare`].
pub fn prepare_checked(kind: Kind, file: &Path, cell: Option<&Path>, checking: &Checking) -> Result<Ready, Failure> {
    prepare_job(&Job { is_checked: true, ..Job::new(file, cell, checking)?.into_kind(kind) }, checking)
}

fn prepare_job(job: &Job<'_>, checking: &Checking) -> Result<Ready, Failure> {
    let cache = Cache::find()?;
    let place = job.place(&cache)?;
    let runtime = Runtime::find();
    let identity = job.identity(runtime);
    let lock = place.lock(true)?;
    if let (Freshness::Fresh, Some(stamp)) = state(&place, identity) {
        return start_again(&place, &stamp, lock, job.is_checked);
    }
    drop(lock);
    let lock = place.lock(false)?;
    let (freshness, stamp) = state(&place, identity);
    if let (Freshness::Fresh, Some(stamp)) = (freshness, &stamp) {
        return start_again(&place, stamp, lock, job.is_checked);
    }
    if let (None, Some(damaged)) = (&stamp, damaged(&place)) {
        show::warning(&format!("{} is damaged: the program is compiled anew", damaged.display()));
    }

    let read = Recording::new(&FileSystem);
    let done = job.compile(&read)?;
    // The runtime reads data files again below the script directory, which must therefore be the folder of the main
    // file.
    let read_again = checking.script_dir.is_none() && freshness == Freshness::DataChanged;
    let kept = stamp.filter(|stamp| read_again && only_values(stamp, &done.programs, &read));
    let (name, program) = match kept {
        Some(stamp) => (stamp.kept.name, stamp.kept.program),
        None => build(&cache, &place, runtime, &done, &job.main()?)?,
    };
    write_if_changed(&place.messages(), done.messages.as_bytes())?;
    let path = place.folder.join(&name);
    let kept = Kept { name, program, messages: Content::of(done.messages.as_bytes()) };
    let stamp = Stamp::of(&done.programs, &read, identity, kept);
    if let Some(stamp) = &stamp {
        write_if_changed(&place.stamp(), stamp.text().as_bytes())?;
    }
    Ok(Ready { program: path, lock, sources: stamp.as_ref().map(sources).unwrap_or_default() })
}

fn only_values(stamp: &Stamp, compiled: &[Compiled], read: &Recording<'_>) -> bool {
    Stamp::of(compiled, read, stamp.identity, stamp.kept.clone()).is_some_and(|now| stamp.same_but_values(&now))
}

/// The state recorded by the stamp. A program that is missing or damaged counts as changed.
fn state(place: &Place, identity: u64) -> (Freshness, Option<Stamp>) {
    let none = (Freshness::Stale, None);
    let Some(stamp) = Stamp::read(&place.stamp()) else { return none };
    let freshness = stamp.freshness(identity);
    // The contents of a program that is not started do not matter.
    if freshness != Freshness::Stale && !is_whole(place, &stamp.kept) { none } else { (freshness, Some(stamp)) }
}

fn is_whole(place: &Place, kept: &Kept) -> bool {
    kept.program.is_in(&place.folder.join(&kept.name)) && kept.messages.is_in(&place.messages())
}

/// The file of a program that has changed since it was written.
fn damaged(place: &Place) -> Option<PathBuf> {
    let Some(Stamp { kept, .. }) = Stamp::read(&place.stamp()) else {
        return Stamp::is_damaged(&place.stamp()).then(|| place.stamp());
    };
    let files = [(place.folder.join(&kept.name), kept.program), (place.messages(), kept.messages)];
    files.into_iter().find_map(|(path, content)| (path.exists() && !content.is_in(&path)).then_some(path))
}

/// Shows the warnings again unless the program is checked, and leaves everything else as it is.
fn start_again(place: &Place, stamp: &Stamp, lock: Lock, is_checked: bool) -> Result<Ready, Failure> {
    if !is_checked {
        show::say(&std::fs::read_to_string(place.messages()).unwrap_or_default());
    }
    let (program, sources) = (place.folder.join(&stamp.kept.name), sources(stamp));
    renew(&program, &sources);
    Ok(Ready { program, lock, sources })
}

/// Makes a program as new as its sources, which have the text that it was compiled from, even if they were written
/// again: alarms show the lines of files that are no newer than the program.
fn renew(program: &Path, sources: &[PathBuf]) {
    let time = |path: &Path| path.metadata().and_then(|about| about.modified()).ok();
    let newest = sources.iter().filter_map(|path| time(path)).max();
    if newest > time(program) {
        // If that is not allowed, alarms show their lines without text.
        let _ = newest.map(|newest| std::fs::File::open(program).and_then(|file| file.set_modified(newest)));
    }
}

fn sources(stamp: &Stamp) -> Vec<PathBuf> {
    stamp.files.iter().map(|file| file.path.clone()).collect()
}

/// Compiles the Rust code and stores the program under a name of its own, so that older programs keep running.
fn build(
    cache: &Cache,
    place: &Place,
    runtime: Runtime,
    done: &Done,
    main: &Path,
) -> Result<(String, Content), Failure> {
    let mut hasher = DefaultHasher::new();
    (&done.rust.first, &done.rust.others, runtime.state()).hash(&mut hasher);
    let checked = done.programs.first().and_then(|compiled| compiled.checked.program.as_ref());
    let stem = checked.map_or("program", |program| program.name.as_str());
    let name = format!("{stem}-{:016x}{}", hasher.finish(), std::env::consts::EXE_SUFFIX);
    let path = place.folder.join(&name);
    compile_rust(cache, place, runtime, &done.rust, main, false, &path)?;
    remove_old(place, &name);
    let content = Content::of_file(&path).map_err(|error| Failure::io("read", &path, &error))?;
    Ok((name, content))
}

/// Compiles emitted Rust with cargo; the executable is copied to `to`.
///
/// # Errors
/// As for [`cargo::build`], and errors of rustc.
pub fn compile_rust(
    cache: &Cache,
    place: &Place,
    runtime: Runtime,
    rust: &Emitted,
    main: &Path,
    release: bool,
    to: &Path,
) -> Result<(), Failure> {
    let folder = main.parent().unwrap_or(Path::new("/"));
    let runtime = runtime.unpack(cache)?;
    package::write(place, &runtime, rust, folder)?;
    let progress = Progress::start("compiling");
    let built = cargo::build(&place.folder, &runtime.target(), release, &progress)?;
    let executable = match built.programs.into_iter().next() {
        Some((_, program)) if built.errors.is_empty() => program,
        _ => return Err(cargo::bug(&built.errors, main)),
    };
    // A running program cannot be overwritten, but it can be removed.
    if to.is_file() {
        std::fs::remove_file(to).map_err(|error| Failure::io("replace", to, &error))?;
    }
    std::fs::copy(&executable, to).map_err(|error| Failure::io("write", to, &error))?;
    cache.keep_limit(place, &runtime.give_back());
    Ok(())
}

/// Removes programs of earlier states. A running one continues if the system allows it.
fn remove_old(place: &Place, keep: &str) {
    const OURS: [&str; 8] = ["Cargo.toml", "Cargo.lock", "base.lock", "src", "stamp", "said", "lock", RECORD];
    let Ok(entries) = std::fs::read_dir(&place.folder) else { return };
    for entry in entries.filter_map(Result::ok) {
        let name = entry.file_name();
        if name != keep && !OURS.iter().any(|ours| name == *ours) {
            // A file that cannot be removed now is removed next time.
            let _ = std::fs::remove_file(entry.path());
        }
    }
}
