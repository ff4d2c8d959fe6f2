//! `arl2rs test`: every program with a sidecar, each run as a process of its own, by the engine or compiled with the
//! others.

mod batch;
mod bless;
mod case;
mod coverage;
mod diff;
mod execute;
mod expect;
mod judge;
mod report;

use crate::args::{Shard, TestOptions};
use arl_project::cache::{Cache, Kind, Lock, Place};
use arl_project::cell_programs;
use arl_project::options::{Checking, EngineChoice};
use arl_project::package::{Emitted, EmittedOther};
use arl_project::program::{Job, check_options};
use arl_project::runtime::{Runtime, Unpacked};
use arl_terminal::exit::Exit;
use arl_terminal::failure::Failure;
use arl_terminal::interrupt;
use arl_terminal::private_folder::PrivateFolder;
use arl_terminal::progress::Progress;
use arl2rs::CheckOptions;
use arl2rs::compile::{Compiled, check_program, compile_program};
use arl2rs::diagnostics::Files;
use arl2rs::emit::{EmitOptions, Sizes};
use arl2rs::render::{Position, human};
use arl2rs::sources::FileSystem;
use case::{Case, Found};
use expect::FoundError;
use judge::judged;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// The verdict on a case: nothing, or how it failed.
type Verdict = Result<(), String>;

/// A case that was checked or run.
struct Done {
    verdict: Verdict,
    /// How long it took, s.
    seconds: f64,
    /// Controller seconds, if it ran.
    cycle_time: Option<f64>,
}

impl Done {
    fn failed(problem: impl Into<String>) -> Self {
        Self { verdict: Err(problem.into()), seconds: 0.0, cycle_time: None }
    }
}

/// Runs all cases; for people the last line on standard output is `N passed, N failed`.
pub(crate) fn test(dirs: &[PathBuf], options: &TestOptions) -> Result<Exit, Failure> {
    if options.all_forms && options.engine == Some(EngineChoice::Engine) {
        return Err(Failure::Usage("--engine engine: --all-forms is about compiled programs".into()));
    }
    if options.is_watched() && (options.all_forms || options.engine == Some(EngineChoice::Native)) {
        let option = if options.coverage.is_some() { "--coverage" } else { "--debug" };
        let compiled = if options.all_forms { "--all-forms" } else { "--engine native" };
        return Err(Failure::Usage(format!("{option}: only the engine stops at statements; leave out {compiled}")));
    }
    let (sizes, kept_as) = match options.all_forms {
        true => (Sizes::LEAST, "tests-all-forms"),
        false => (Sizes::default(), "tests"),
    };
    let emitting = EmitOptions { sizes, ..EmitOptions::default() };
    let kind = if options.is_watched() { Kind::Watched } else { Kind::Program };
    let mut found = find(dirs, options.bless)?;
    if let Some(Shard { index, count }) = options.shard {
        let mut number = 0..;
        found.retain(|_| number.next().is_some_and(|number: usize| number % count == index));
    }
    interrupt::last_words("interrupted: the results are only shown when all cases have run");
    let progress = Progress::start("checking");
    let codes = temporary_folder()?;
    let mut done: Vec<Option<Done>> = Vec::new();
    let mut runs: Vec<Run<'_>> = Vec::new();
    let (mut emitted, mut emitted_runs) = (Vec::new(), Vec::new());
    for (at, found) in found.iter().enumerate() {
        let case = match &found.case {
            Ok(case) if case.runs() => case,
            Ok(case) => {
                done.push(Some(check(case, options.bless)));
                continue;
            }
            Err(problem) => {
                done.push(Some(Done::failed(problem.clone())));
                continue;
            }
        };
        let made = if is_compiled(case, options) {
            emit(case, &emitting).map(|rust| {
                emitted.push(batch::EmittedCase { source: found.source.clone(), rust });
                emitted_runs.push((at, case));
            })
        } else {
            coded(case, kind, codes.path()).map(|coded| runs.push(Run { at, case, program: Ok(coded) }))
        };
        done.push(made.err().map(Done::failed));
    }
    let compiled = match emitted.is_empty() {
        true => None,
        false => Some(CompiledCases::of(&name_of_run(dirs, kept_as), &emitted, &progress)?),
    };
    let programs = compiled.iter().flat_map(|compiled| &compiled.programs);
    let native = emitted_runs.iter().zip(programs);
    runs.extend(native.map(|((at, case), program)| Run { at: *at, case, program: program.clone() }));
    runs.sort_by_key(|run| run.at);
    for (run, ran) in runs.iter().zip(run_all(&runs, options, &progress)?) {
        if let Some(slot) = done.get_mut(run.at) {
            *slot = Some(ran);
        }
    }
    drop(progress);
    compiled.into_iter().for_each(CompiledCases::give_back);
    let done: Vec<Done> = done.into_iter().map(|done| done.unwrap_or_else(|| Done::failed("it was not run"))).collect();
    report::report(&found, &done, options.format)
}

/// Whether a case is compiled, and not run by the engine: the command line says so, or else the project of the case. No
/// compiled program counts its statements.
fn is_compiled(case: &Case, options: &TestOptions) -> bool {
    !options.is_watched() && (options.all_forms || options.engine.or(case.engine) == Some(EngineChoice::Native))
}

fn temporary_folder() -> Result<PrivateFolder, Failure> {
    PrivateFolder::new("arl2rs-test-")
        .map_err(|error| Failure::Other(format!("cannot make a temporary folder for the cases: {error}")))
}

fn find(dirs: &[PathBuf], new: bool) -> Result<Vec<Found>, Failure> {
    let mut all = Vec::new();
    for dir in dirs {
        let folder = std::path::absolute(dir).map_err(|error| Failure::io("use", dir, &error))?;
        let found = case::find(&folder, new)
            .map_err(|error| Failure::Usage(format!("cannot read the folder {}: {error}", dir.display())))?;
        if found.is_empty() {
            let sidecars = "expected a NAME.arl with NAME.out, NAME.err or NAME.alarm beside it";
            return Err(Failure::Usage(format!("{} has no case: {sidecars}", dir.display())));
        }
        all.extend(found);
    }
    // Folders may be inside each other.
    all.sort_by(|one, other| one.source.cmp(&other.source));
    all.dedup_by(|one, other| one.source == other.source);
    Ok(all)
}

/// How a case's program is checked.
fn checking(case: &Case) -> Checking {
    let (robot, script_dir) = (case.robot.clone(), case.script_dir.clone());
    Checking { robot, script_dir, background: case.options.background, ..Checking::default() }
}

fn options(checking: &Checking) -> Result<CheckOptions, String> {
    check_options(checking).map_err(message_of)
}

fn message_of(failure: Failure) -> String {
    match failure {
        Failure::Usage(text) | Failure::Other(text) => text,
        Failure::Shown => String::new(),
    }
}

/// The Rust of a case that should run, with the programs that its cell names.
fn emit(case: &Case, emitting: &EmitOptions) -> Result<Emitted, String> {
    let checking = checking(case);
    let cell = case.cell.as_deref();
    let first = rust(&case.source, &checking, emitting)?;
    let mut others = Vec::new();
    for other in cell_programs::named(cell, checking.robot.as_deref()).map_err(message_of)? {
        let rust = rust(&other.path, &other.checking(&checking), emitting)
            .map_err(|problem| format!("{}: {problem}", other.file))?;
        let folder = other.folder(&case.source).map_err(message_of)?;
        others.push(EmittedOther { file: other.file, folder, rust });
    }
    Ok(Emitted { first, others, kind: Kind::Program })
}

/// The code of a case that should run, with the programs that its cell names, in a file of this folder.
fn coded(case: &Case, kind: Kind, folder: &Path) -> Result<batch::Compiled, String> {
    let job = Job::new(&case.source, case.cell.as_deref(), &checking(case)).map_err(message_of)?.into_kind(kind);
    let mut programs = job.check(&FileSystem).map_err(message_of)?;
    if let Some((at, refused)) = programs.iter().enumerate().find(|(_, compiled)| compiled.checked.program.is_none()) {
        let file = job.name_in_cell(at).map(|file| format!("{file}: ")).unwrap_or_default();
        return Err(format!("{file}it does not compile:\n{}", shown_errors(refused)));
    }
    let bundle = job.bundle(&mut programs).map_err(message_of)?;
    let name = batch::name(&case.source);
    let path = folder.join(&name);
    std::fs::write(&path, bundle.to_bytes()).map_err(|error| format!("cannot write its code: {error}"))?;
    Ok(batch::Compiled { program: PathBuf::new(), name, code: Some(path) })
}

fn rust(file: &Path, checking: &Checking, emitting: &EmitOptions) -> Result<String, String> {
    let compiled = compile_program(file, &FileSystem, &options(checking)?, emitting).map_err(|bug| bug.to_string())?;
    match &compiled.rust {
        Some(rust) => Ok(rust.clone()),
        None => Err(format!("it does not compile:\n{}", shown_errors(&compiled))),
    }
}

fn shown_errors(compiled: &Compiled) -> String {
    compiled.errors().map(|error| human(error, &compiled.checked.files, false)).collect()
}

/// Checks a case that should have errors.
fn check(case: &Case, bless: bool) -> Done {
    let start = Instant::now();
    let look = || {
        let checking = Checking { cell: case.cell.clone(), ..checking(case) };
        let compiled = check_program(&case.source, &FileSystem, &options(&checking)?).map_err(|bug| bug.to_string())?;
        let expected = case.errors.as_deref().unwrap_or_default();
        let found = found_errors(&compiled, &compiled.checked.files);
        let Some(lines) = expect::compare_errors(expected, &found) else { return Ok(()) };
        let problem = format!("the errors differ (- expected, + actual):\n{lines}");
        match bless {
            true => bless::errors(case, &found).map_err(|why| format!("{problem}\n{why}")),
            false => Err(problem),
        }
    };
    let verdict = look();
    Done { verdict, seconds: start.elapsed().as_secs_f64(), cycle_time: None }
}

fn found_errors(compiled: &Compiled, files: &Files) -> Vec<FoundError> {
    let found = |error: &arl2rs::diagnostics::Diagnostic| FoundError {
        line: Position::of(error.primary.at, files).line,
        text: [Some(error.message.as_str()), error.help.as_deref()]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join("; "),
    };
    compiled.errors().map(found).collect()
}

/// The name under which the programs of a run are kept: another run of the same folders finds them again.
fn name_of_run(dirs: &[PathBuf], kept_as: &str) -> PathBuf {
    let folders: PathBuf = dirs.iter().filter_map(|dir| std::path::absolute(dir).ok()).collect();
    folders.join(kept_as)
}

/// A case that runs, and its place among all cases.
struct Run<'a> {
    at: usize,
    case: &'a Case,
    /// What is started, or the errors of rustc.
    program: Result<batch::Compiled, String>,
}

/// Cases that were compiled. They stay in the cache while this value lives.
struct CompiledCases {
    /// The program of each, or the errors of rustc.
    programs: Vec<Result<batch::Compiled, String>>,
    cache: Cache,
    place: Place,
    runtime: Unpacked,
    _lock: Lock,
}

impl CompiledCases {
    /// Compiles cases. The programs are kept under this name.
    fn of(name: &Path, emitted: &[batch::EmittedCase], progress: &Progress) -> Result<Self, Failure> {
        let cache = Cache::find()?;
        let place = cache.program(name);
        let lock = place.lock(false)?;
        progress.say(&format!("compiling {} cases", emitted.len()));
        let runtime = Runtime::find().unpack(&cache)?;
        let programs = batch::compile(&place, &runtime, emitted, progress)?;
        Ok(Self { programs, cache, place, runtime, _lock: lock })
    }

    /// The cache may remove them from now on.
    fn give_back(self) {
        self.cache.keep_limit(&self.place, &self.runtime.give_back());
    }
}

/// Runs cases, several at once.
fn run_all(runs: &[Run<'_>], options: &TestOptions, progress: &Progress) -> Result<Vec<Done>, Failure> {
    let scratch = temporary_folder()?;
    let mut coverage = coverage::Coverage::default();
    let mut places = Vec::new();
    if options.coverage.is_some() {
        for run in runs {
            // What cannot be checked was reported before.
            places.push(coverage.add(run.case).ok());
        }
    }
    let coverage = Mutex::new(coverage);
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<Done>> = Mutex::new(runs.iter().map(|_| Done::failed("it was not run")).collect());
    let extras = execute::Extras { counts: options.coverage.is_some(), keep: options.keep.as_deref() };
    let work = || {
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let Some(Run { case, program, .. }) = runs.get(at) else { return };
            progress.say(&format!("running {} of {}", at + 1, runs.len()));
            let ran = match program {
                Ok(program) => match execute::execute(case, program, scratch.path(), extras) {
                    Ok(outcome) => {
                        if let Some(Some(places)) = places.get(at)
                            && let Ok(mut coverage) = coverage.lock()
                        {
                            coverage.count(places, &outcome.counted);
                        }
                        judged(case, &outcome, options.bless)
                    }
                    Err(error) => Done::failed(format!("cannot run it: {error}")),
                },
                Err(errors) => {
                    Done::failed(format!("bug in arl2rs: the Rust code generated from it does not compile\n{errors}"))
                }
            };
            if let Ok(mut done) = done.lock()
                && let Some(slot) = done.get_mut(at)
            {
                *slot = ran;
            }
        }
    };
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(work);
        }
    });
    if let Some(file) = &options.coverage {
        coverage.into_inner().unwrap_or_default().write(file)?;
    }
    Ok(done.into_inner().unwrap_or_default())
}
