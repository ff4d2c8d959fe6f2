//! Compiles a program from its source file, with as little work as the changes require.

use crate::cache::{Cache, Content, Kind, Lock, Place, RECORD, write_if_changed};
use crate::cargo;
use crate::cell_programs::{self, Other, absolute};
use crate::code_files::{self, CODE};
use crate::listing;
use crate::options::{Checking, EngineChoice, RunOptions};
use crate::package;
use crate::package::{Emitted, EmittedOther};
use crate::robots;
use crate::runtime::{Runtime, hash_state};
use crate::stamp::{Freshness, Kept, Recording, Stamp};
use arl_code::{Bundle, BundledProgram, Code};
use arl_robot::cell::Cell;
use arl_robot::outline::Outline;
use arl_terminal::failure::Failure;
use arl_terminal::private_folder::PrivateFolder;
use arl_terminal::progress::Progress;
use arl_terminal::show;
use arl2rs::CheckOptions;
use arl2rs::Sources;
use arl2rs::compile::{Bug, Compiled, check_program, compile_program};
use arl2rs::emit::EmitOptions;
use arl2rs::lower::{lower, lower_watched};
use arl2rs::sources::FileSystem;
use std::ffi::OsString;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// A program that can be started. Other processes cannot compile it again while the lock is held.
#[derive(Debug)]
pub struct Ready {
    /// The executable, or the library; of this command if the program is code.
    pub program: PathBuf,
    /// The code, if the executable is this command, which has the engine.
    pub code: Option<PathBuf>,
    /// No other process compiles the program again while this is held. `None` if no other process knows of it.
    pub lock: Option<Lock>,
    /// The folder of the code where there is no cache: it is removed when this is dropped.
    pub folder: Option<PrivateFolder>,
    /// The files that were read; empty if they were not recorded.
    pub sources: Vec<PathBuf>,
}

impl Ready {
    /// The command that runs the program.
    ///
    /// # Errors
    /// As for [`command_of_code`].
    pub fn command(&self) -> Result<Command, Failure> {
        match &self.code {
            Some(code) => command_of_code(code),
            None => Ok(Command::new(&self.program)),
        }
    }
}

/// The command that runs code: this command, which has the engine.
///
/// # Errors
/// It is not known how this command is started.
pub fn command_of_code(code: &Path) -> Result<Command, Failure> {
    let words = this_command()?;
    let (program, first) = words.split_first().ok_or_else(|| {
        Failure::Other("the interpreter that this is part of cannot be started as a process of its own".into())
    })?;
    let mut command = Command::new(program);
    command.args(first).arg("engine").arg(code);
    Ok(command)
}

/// A variable of the environment of programs, compiled or run from code: with it a program ends when its standard input
/// is closed, so that it does not outlive who started it. The other side is `arl-rt/src/command/program_main.rs`.
pub const WHILE_INPUT: &str = "ARL2RS_WHILE_INPUT";

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

/// What this command is, if it is not the executable of this process.
static THIS: OnceLock<This> = OnceLock::new();

/// What this command is.
struct This {
    /// The file that contains it.
    file: PathBuf,
    /// The words that start it.
    command: Vec<OsString>,
}

/// Sets the file that contains this command, and the words that start it.
pub fn is_part_of(file: PathBuf, command: Vec<OsString>) {
    let _ = THIS.set(This { file, command });
}

/// The words that start this command.
fn this_command() -> Result<Vec<OsString>, Failure> {
    if let Some(this) = THIS.get() {
        return Ok(this.command.clone());
    }
    let program = std::env::current_exe().map_err(|error| Failure::io("find", Path::new("arl2rs"), &error))?;
    Ok(vec![program.into()])
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

impl Done {
    /// The files of the programs.
    pub fn files(&self) -> Vec<PathBuf> {
        self.programs.iter().flat_map(files).collect()
    }
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

    /// The job of a run.
    fn of_run(file: &'a Path, options: &'a RunOptions) -> Result<Self, Failure> {
        Self::new(file, options.cell.as_deref(), &options.checking())
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
        let named = matches!(self.kind, Kind::Library | Kind::Named);
        let emitting = EmitOptions { named, ..EmitOptions::default() };
        let mut programs = self.each(|file, options| compile_program(file, sources, options, &emitting))?;
        let messages = self.show(&programs)?;
        let mut rust = programs.iter_mut().map(|compiled| compiled.rust.take().ok_or(Failure::Shown));
        let first = rust.next().unwrap_or(Err(Failure::Shown))?;
        let rust: Vec<String> = rust.collect::<Result<_, _>>()?;
        let others = self.beside(rust, |file, folder, rust| EmittedOther { file, folder, rust })?;
        Ok(Done { programs, rust: Emitted { first, others, kind: self.kind }, messages })
    }

    /// Checks all programs, the first of the job first.
    ///
    /// # Errors
    /// A bug of the compiler.
    pub fn check(&self, sources: &dyn Sources) -> Result<Vec<Compiled>, Failure> {
        self.each(|file, options| check_program(file, sources, options))
    }

    /// The name that the cell has for a program: not for the first one, at 0.
    pub fn name_in_cell(&self, at: usize) -> Option<&str> {
        self.others.get(at.checked_sub(1)?).map(|(other, _)| other.file.as_str())
    }

    /// The code that the engine runs, of programs that [`Job::check`] found correct.
    ///
    /// # Errors
    /// [`Failure::Shown`] for a program with errors; a program that is too large for the engine.
    pub fn bundle(&self, programs: &mut [Compiled]) -> Result<Bundle, Failure> {
        let is_watched = self.kind == Kind::Watched;
        let code = |compiled: &mut Compiled| {
            let program = compiled.checked.program.as_mut().ok_or(Failure::Shown)?;
            let code = if is_watched { lower_watched(program) } else { lower(program) };
            code.map_err(|problem| match is_watched {
                true => Failure::Other(format!("{problem}: it runs only without a debugger, coverage and --pendant")),
                false => Failure::Other(format!("{problem}: `--engine native` compiles it")),
            })
        };
        let mut codes = programs.iter_mut().map(code);
        let main = codes.next().unwrap_or(Err(Failure::Shown))?;
        let others = codes.collect::<Result<Vec<Code>, _>>()?;
        let others = self.beside(others, |file, folder, code| BundledProgram { file, folder, code })?;
        let folder = self.main()?.parent().unwrap_or(Path::new("/")).display().to_string();
        Ok(Bundle { folder, main, others })
    }

    /// What `make` makes of each program, the first of the job first.
    fn each<T>(&self, make: impl Fn(&Path, &CheckOptions) -> Result<T, Bug>) -> Result<Vec<T>, Failure> {
        let first = (self.file, &self.options);
        let others = self.others.iter().map(|(other, options)| (other.path.as_path(), options));
        std::iter::once(first).chain(others).map(|(file, options)| make(file, options).map_err(bug)).collect()
    }

    /// Puts each result beside the file and the folder of its additional program.
    fn beside<T, U>(&self, made: Vec<T>, put: impl Fn(String, String, T) -> U) -> Result<Vec<U>, Failure> {
        let main = self.main()?;
        let others = self.others.iter().zip(made);
        others.map(|((other, _), made)| Ok(put(other.file.clone(), other.folder(&main)?, made))).collect()
    }

    /// Shows the messages of programs, and returns them.
    ///
    /// # Errors
    /// [`Failure::Shown`] if a program has errors.
    fn show(&self, programs: &[Compiled]) -> Result<String, Failure> {
        let mut limit = listing::Limit::default();
        let messages: String = programs.iter().map(|compiled| listing::rendered(compiled, &mut limit)).collect();
        let is_refused = programs.iter().any(|compiled| compiled.checked.program.is_none());
        if !self.is_checked || is_refused {
            show::say(&messages);
        }
        if is_refused { Err(Failure::Shown) } else { Ok(messages) }
    }

    /// A number that changes with everything except the sources: this command, the runtime, the options, the channels.
    fn identity(&self, runtime: Runtime) -> u64 {
        let mut hasher = DefaultHasher::new();
        state_of_command().hash(&mut hasher);
        runtime.state().hash(&mut hasher);
        let of_options = |options: &CheckOptions| (options.family, options.strict, options.background);
        (of_options(&self.options), &self.options.script_dir).hash(&mut hasher);
        self.others.iter().for_each(|(other, options)| (other, of_options(options)).hash(&mut hasher));
        hasher.finish()
    }
}

/// A number that changes with the file of this command.
pub fn state_of_command() -> u64 {
    let mut hasher = DefaultHasher::new();
    let file = THIS.get().map(|this| this.file.clone()).or_else(|| std::env::current_exe().ok());
    if let Some(file) = file {
        hash_state(&file, &mut hasher);
    }
    hasher.finish()
}

/// A bug of the compiler as the failure of the command.
pub fn bug(bug: Bug) -> Failure {
    Failure::Other(bug.to_string())
}

/// Makes a program ready to run, together with those that its cell names: by the engine, or compiled, as the options
/// say. Where they say nothing, the engine runs it; but a compiled program is used where it is up to date, and for real
/// arms if there is a compiler.
///
/// # Errors
/// The program is refused or cannot be compiled; the error gives the reason and the position.
pub fn prepare(kind: Kind, file: &Path, options: &RunOptions) -> Result<Ready, Failure> {
    prepare_job(&Job::of_run(file, options)?.into_kind(kind), options)
}

/// Like `prepare`, for a program whose warnings have been shown by a check.
///
/// # Errors
/// As for [`prepare`].
pub fn prepare_checked(kind: Kind, file: &Path, options: &RunOptions) -> Result<Ready, Failure> {
    prepare_job(&Job { is_checked: true, ..Job::of_run(file, options)?.into_kind(kind) }, options)
}

fn prepare_job(job: &Job<'_>, options: &RunOptions) -> Result<Ready, Failure> {
    match options.engine {
        // There is no native code that a debugger could halt.
        _ if job.kind == Kind::Watched => lowered(job),
        Some(EngineChoice::Native) => compiled(job, options),
        Some(EngineChoice::Engine) => lowered(job),
        None if options.drive && cargo::is_there() => compiled(job, options),
        None => match kept(job)? {
            Some(ready) => Ok(ready),
            None => lowered(job),
        },
    }
}

/// Makes a program ready to run: by the engine of this process, or as a process of its own, where it is compiled, or
/// where this command is part of another program, or of a run that shares its memory and its time with nothing.
///
/// # Errors
/// As for [`prepare`].
pub fn prepare_here(kind: Kind, file: &Path, options: &RunOptions) -> Result<Here, Failure> {
    let job = Job::of_run(file, options)?.into_kind(kind);
    let is_alone = THIS.get().is_some() || options.drive || options.realtime.is_some();
    if is_alone || options.engine == Some(EngineChoice::Native) {
        return prepare_job(&job, options).map(Here::Process);
    }
    if options.engine.is_none()
        && let Some(ready) = kept(&job)?
    {
        return Ok(Here::Process(ready));
    }
    let mut programs = job.check(&FileSystem)?;
    job.show(&programs)?;
    let bundle = Box::new(job.bundle(&mut programs)?);
    Ok(Here::Code { bundle, sources: sources_of(&programs)? })
}

/// A program that is run by the engine of this process, or as a process of its own.
#[derive(Debug)]
pub enum Here {
    /// A process.
    Process(Ready),
    /// The code, and the files that were read.
    Code {
        /// The code.
        bundle: Box<Bundle>,
        /// The files that were read.
        sources: Vec<PathBuf>,
    },
}

/// Checks a program together with those that its cell names, for the engine of this process, unless the options ask for
/// native code. Its messages have been shown by a check.
///
/// # Errors
/// The program is refused.
pub fn prepare_in_process(file: &Path, options: &RunOptions) -> Result<InProcess, Failure> {
    let job = Job { is_checked: true, ..Job::of_run(file, options)?.into_kind(Kind::Library) };
    if options.engine == Some(EngineChoice::Native) {
        return compiled(&job, options).map(InProcess::Library);
    }
    if options.engine.is_none()
        && let Some(ready) = kept(&job)?
    {
        return Ok(InProcess::Library(ready));
    }
    let mut programs = job.check(&FileSystem)?;
    job.show(&programs)?;
    job.bundle(&mut programs).map(|bundle| InProcess::Code(Box::new(bundle)))
}

/// A program that runs in this process.
pub enum InProcess {
    /// A compiled library.
    Library(Ready),
    /// The code of the program.
    Code(Box<Bundle>),
}

/// Checks the programs of a job, and makes them ready for the engine: this command runs their code.
///
/// # Errors
/// A program is refused; the code cannot be written.
fn lowered(job: &Job<'_>) -> Result<Ready, Failure> {
    let mut programs = job.check(&FileSystem)?;
    job.show(&programs)?;
    let code = job.bundle(&mut programs)?.to_bytes();
    let sources = sources_of(&programs)?;
    let program = this_command()?.into_iter().next().unwrap_or_default().into();
    let (path, lock, folder) = match code_in_cache(job, &code) {
        Ok((path, lock)) => (path, Some(lock), None),
        Err(failure @ Failure::Usage(_)) => return Err(failure),
        // Without a cache the code is of this run alone.
        Err(_) => {
            let (path, folder) = code_files::write_apart(&code)?;
            (path, None, Some(folder))
        }
    };
    Ok(Ready { program, code: Some(path), lock, folder, sources })
}

/// Writes the code of a job into its place in the cache, which is locked.
fn code_in_cache(job: &Job<'_>, code: &[u8]) -> Result<(PathBuf, Lock), Failure> {
    let cache = Cache::find()?;
    let place = job.place(&cache)?;
    let is_new = !place.folder.exists();
    let lock = place.lock(true)?;
    let path = code_files::write(&place, code)?;
    if is_new {
        cache.keep_limit(&place, &Runtime::find().folder(&cache));
    }
    Ok((path, lock))
}

/// The files of all programs, as absolute paths.
fn sources_of(programs: &[Compiled]) -> Result<Vec<PathBuf>, Failure> {
    programs.iter().flat_map(files).map(|file| absolute(&file)).collect()
}

/// The files of a program that was checked.
fn files(compiled: &Compiled) -> Vec<PathBuf> {
    compiled.checked.files.iter().map(|(_, file)| compiled.folder.join(&file.name)).collect()
}

/// The compiled program, if there is one and it is up to date.
fn kept(job: &Job<'_>) -> Result<Option<Ready>, Failure> {
    // Where there is no cache, nothing is kept.
    let Ok(cache) = Cache::find() else { return Ok(None) };
    let place = job.place(&cache)?;
    if !place.stamp().exists() {
        return Ok(None);
    }
    let lock = place.lock(true)?;
    match state(&place, job.identity(Runtime::find())) {
        (Freshness::Fresh, Some(stamp)) => start_again(&place, &stamp, lock, job.is_checked).map(Some),
        _ => Ok(None),
    }
}

/// Compiles a program unless that was done before.
fn compiled(job: &Job<'_>, options: &RunOptions) -> Result<Ready, Failure> {
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
    let read_again = options.script_dir.is_none() && freshness == Freshness::DataChanged;
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
    Ok(Ready {
        program: path,
        code: None,
        lock: Some(lock),
        folder: None,
        sources: stamp.as_ref().map(sources).unwrap_or_default(),
    })
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
    Ok(Ready { program, code: None, lock: Some(lock), folder: None, sources })
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
        let is_code = name.to_string_lossy().starts_with(CODE);
        if name != keep && !is_code && !OURS.iter().any(|ours| name == *ours) {
            // A file that cannot be removed now is removed next time.
            let _ = std::fs::remove_file(entry.path());
        }
    }
}
