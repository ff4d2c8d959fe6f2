//! `arl2rs run` and `arl2rs plot`

use crate::engine;
use arl_project::arl_toml;
use arl_project::cache::Kind;
use arl_project::options::{EngineChoice, RunOptions};
use arl_project::program::{Here, Ready, prepare, prepare_here};
use arl_project::robots;
use arl_robot::Robot;
use arl_robot::cell::Cell;
use arl_robot::changes::Part;
use arl_robot::result_file::{self, ResultFile};
use arl_rt::emit::program_main;
use arl_runs::collide::Scene;
use arl_runs::listen::{Listener, Received, Subscriber};
use arl_runs::pendant;
use arl_runs::plot::{self, Lane, Ran};
use arl_runs::record::Recording;
use arl_runs::report::Reporting;
use arl_runs::scenery::Scenery;
use arl_runs::signals::Signals;
use arl_runs::texts;
use arl_terminal::answer::ReportFormat;
use arl_terminal::exit::Exit;
use arl_terminal::failure::Failure;
use arl_terminal::interrupt;
use arl_terminal::private_folder::PrivateFolder;
use arl_terminal::show;
use std::cell::RefCell;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;

/// Makes the program ready, then runs it in this process, or lets it take over.
pub(crate) fn run(file: &Path, options: &RunOptions) -> Result<Exit, Failure> {
    let on_screen = options.pendant && options.plot.is_none() && std::io::stdout().is_terminal();
    if on_screen && options.engine == Some(EngineChoice::Native) {
        let why = "--engine native: the screen of --pendant shows the inside of programs, which the engine runs";
        return Err(Failure::Usage(format!("{why}; leave out one of the two")));
    }
    let options = &options.of_program(file)?;
    let kind = match on_screen {
        true => Kind::Watched,
        false if options.changed()?.of_part(Part::Global).next().is_some() => Kind::Named,
        false => Kind::Program,
    };
    let observers = Observers::of(options)?;
    let made = SystemTime::now();
    // A program that reports to others is a process of its own.
    let here = match on_screen || options.plot.is_some() || !observers.are_none(options) {
        true => Here::Process(prepare(kind, file, options)?),
        false => prepare_here(kind, file, options)?,
    };
    let (Here::Process(Ready { sources, .. }) | Here::Code { sources, .. }) = &here;
    let further = further_traces(options)?;
    let mut results = options.results();
    results.extend(further.iter().map(|path| ("--trace", path.as_path())));
    expect_apart(&results, &inputs(file, options, sources))?;
    // Better to fail now than after a long run; the program checks its own results only when it begins.
    results.iter().try_for_each(|(_, path)| result(path).map(drop))?;
    let subscribers = observers.subscribers(options, sources)?;
    match here {
        Here::Code { bundle, .. } => Ok(engine::run_here(*bundle, options.arguments(), made)),
        Here::Process(ready) => run_process(ready, file, options, on_screen, subscribers),
    }
}

/// Starts the program, or becomes it if there is nobody who listens to it.
fn run_process(
    ready: Ready,
    file: &Path,
    options: &RunOptions,
    on_screen: bool,
    mut subscribers: Vec<Box<dyn Subscriber>>,
) -> Result<Exit, Failure> {
    let mut command = ready.command()?;
    command.args(options.arguments());
    if on_screen {
        return pendant::run(command, &ready.sources, ready.lock, subscribers);
    }
    if let Some(picture) = &options.plot {
        let (signals, lanes) = Signals::new();
        subscribers.push(Box::new(signals));
        let listener = Listener::of(subscribers)?;
        return run_and_plot(command, listener, ready, file, options, picture, &lanes);
    }
    match Listener::of(subscribers)? {
        // The folder of its code is removed after the run.
        None if ready.folder.is_some() => wait(command, None, ready).map(|ended| ended.code),
        Some(listener) => wait(command, Some(listener), ready).map(|ended| ended.code),
        None => start(command, ready),
    }
}

/// The traces of the cell's other robots.
fn further_traces(options: &RunOptions) -> Result<Vec<PathBuf>, Failure> {
    let Some(first) = options.trace.as_deref() else { return Ok(Vec::new()) };
    let count = u8::try_from(cell(options)?.further_foreground_channels()).unwrap_or(u8::MAX);
    Ok((2..=count.saturating_add(1)).map(|number| program_main::numbered_trace(first, number)).collect())
}

/// What a run reads, each with what it is.
fn inputs<'a>(file: &'a Path, options: &'a RunOptions, sources: &'a [PathBuf]) -> Vec<(&'static str, &'a Path)> {
    let sources = sources.iter().map(|path| ("a file of the program", path.as_path()));
    std::iter::once(("the program", file)).chain(sources).chain(options.inputs()).collect()
}

/// Who observes the program, by what is around it: `None` where that does not matter.
struct Observers {
    scenery: Option<Scenery>,
    /// Collisions.
    watchers: Vec<Box<dyn Subscriber>>,
}

impl Observers {
    fn of(options: &RunOptions) -> Result<Self, Failure> {
        if options.cell.is_none() && options.clearance.is_none() && !Self::are_asked(options) {
            return Ok(Self { scenery: None, watchers: Vec::new() });
        }
        let robot = robots::load_with(options.robot.as_deref(), &options.changed()?)?;
        let cell = cell(options)?;
        let scenery = Scenery::of(&cell, &robots::of_cell(&cell, robot)?, &show::warning)?;
        let watchers = watchers(&scenery, options.clearance)?;
        Ok(Self { scenery: Some(scenery), watchers })
    }

    /// Whether a recording, or a report that is made from one, was requested.
    fn are_asked(options: &RunOptions) -> bool {
        options.record.is_some() || matches!(options.format, Some(ReportFormat::Json | ReportFormat::Html))
    }

    fn are_none(&self, options: &RunOptions) -> bool {
        self.watchers.is_empty() && !Self::are_asked(options)
    }

    /// The subscribers of the program: collisions come first, so that they are recorded.
    fn subscribers(self, options: &RunOptions, sources: &[PathBuf]) -> Result<Vec<Box<dyn Subscriber>>, Failure> {
        let Self { scenery: Some(scenery), watchers: mut subscribers } = self else { return Ok(Vec::new()) };
        if let Some(path) = &options.record {
            subscribers.push(Box::new(Recording::create(path, &scenery, sources)?));
        }
        if let (Some(file), Some(format @ (ReportFormat::Json | ReportFormat::Html))) =
            (&options.report, options.format)
        {
            subscribers.push(Box::new(Reporting::create(file, format, &scenery)?));
        }
        Ok(subscribers)
    }
}

/// The cell of a run; an empty one if none is named.
pub(crate) fn cell(options: &RunOptions) -> Result<Cell, Failure> {
    let changes = options.changed()?;
    let cell = options.cell.as_deref().map(|cell| Cell::load_with(cell, &changes)).transpose();
    Ok(cell.map_err(|error| Failure::Usage(error.to_string()))?.unwrap_or_default())
}

/// The subscribers that watch what robots touch, and what they take along, if the cell has bodies or a clearance is
/// requested.
pub(crate) fn watchers(scenery: &Scenery, clearance: Option<f64>) -> Result<Vec<Box<dyn Subscriber>>, Failure> {
    if clearance.is_none() && scenery.bodies.is_empty() {
        return Ok(Vec::new());
    }
    let scene = Scene::of(scenery, &show::warning)?;
    Ok(scene.watch(clearance.unwrap_or_default(), true).0)
}

/// Draws an existing trace.
pub(crate) fn plot(trace: &Path, picture: &Path, robot: Option<&str>) -> Result<(), Failure> {
    expect_apart(&[("the picture", picture)], &[("the trace", trace)])?;
    let beside = arl_toml::of_program(trace)?.and_then(|file| file.robot);
    let robot = robot.or(beside.as_deref());
    let title = trace.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    draw(trace, result(picture)?, robots::load(robot)?, &Ran { title, ..Ran::default() })
}

fn draw(trace: &Path, picture: ResultFile, robot: Robot, ran: &Ran) -> Result<(), Failure> {
    let path = picture.path().to_owned();
    if !plot::plot(trace, picture, robot, ran)? {
        not_drawn("no motion was executed", &path);
    }
    Ok(())
}

/// A warning that there is no new picture.
fn not_drawn(why: &str, picture: &Path) {
    let old = if picture.exists() { "; it is still that of an earlier run" } else { "" };
    show::warning(&format!("{why}, so {} was not drawn{old}", picture.display()));
}

/// A file for a picture.
fn result(path: &Path) -> Result<ResultFile, Failure> {
    ResultFile::new(path).map_err(|error| Failure::Usage(format!("cannot write {}: {error}", path.display())))
}

fn expect_apart(results: &[(&str, &Path)], inputs: &[(&str, &Path)]) -> Result<(), Failure> {
    result_file::expect_apart(results, inputs).map_err(Failure::Usage)
}

/// Runs the program, then draws its trace, however the run ended.
fn run_and_plot(
    mut command: Command,
    listener: Option<Listener>,
    ready: Ready,
    file: &Path,
    options: &RunOptions,
    picture: &Path,
    lanes: &RefCell<Vec<Lane>>,
) -> Result<Exit, Failure> {
    // Better to fail now than after a long run.
    let result = result(picture)?;
    let (trace, _passing) = match options.trace.clone() {
        Some(trace) => (trace, None),
        // Unless the trace is requested, it is temporary.
        None => {
            let folder = PrivateFolder::new("arl2rs-plot-");
            let folder = folder
                .map_err(|error| Failure::Other(format!("cannot make a temporary folder for the trace: {error}")))?;
            let trace = folder.path().join("trace.csv");
            command.arg("--trace").arg(&trace).args(["--trace-columns", "file"]);
            (trace, Some(folder))
        }
    };
    let ran = ran(file, &ready.sources);
    let Ended { code, is_killed, received } = wait(command, listener, ready)?;
    let ran = Ran { lanes: lanes.take(), ..ran };
    match received {
        // The program did not even begin, and has reported the reason: the trace is that of an earlier run.
        Received::Nothing => {}
        // What it had not written yet is missing in the trace.
        _ if is_killed || (received == Received::Broken && code == Exit::INTERRUPTED) => {
            not_drawn("the program was ended at once", picture);
        }
        _ => draw(&trace, result, robots::load_with(options.robot.as_deref(), &options.changed()?)?, &ran)?,
    }
    Ok(code)
}

/// What the plot shows of the program.
fn ran(file: &Path, sources: &[PathBuf]) -> Ran {
    let title = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    Ran { main: Some(title.clone()), title, sources: texts::read(sources), lanes: Vec::new() }
}

/// The program takes the place of this process: signals, streams and exit code are its own.
#[cfg(unix)]
fn start(mut command: Command, ready: Ready) -> Result<Exit, Failure> {
    use std::os::unix::process::CommandExt;
    let Ready { program, lock, .. } = ready;
    let error = command.exec();
    drop(lock);
    Err(Failure::io("start", &program, &error))
}

#[cfg(not(unix))]
fn start(command: Command, ready: Ready) -> Result<Exit, Failure> {
    wait(command, None, ready).map(|ended| ended.code)
}

/// How a run ended.
struct Ended {
    code: Exit,
    /// Whether something else than the program itself has ended it.
    is_killed: bool,
    received: Received,
}

/// Runs the program while this process waits, or listens to it. Only the program acts on Ctrl-C.
fn wait(mut command: Command, listener: Option<Listener>, ready: Ready) -> Result<Ended, Failure> {
    let left = interrupt::leave_to_the_program();
    let fail = |error: std::io::Error| Failure::io("start", &ready.program, &error);
    listener.iter().for_each(|listener| listener.ask(&mut command));
    let mut child = command.spawn().map_err(fail)?;
    left.pass_on_to(&child);
    drop(ready.lock);
    let ended = match listener {
        // The program itself reports what it could not send.
        Some(listener) => listener.receive(&mut child),
        None => child.wait().map(|status| (status, Received::Nothing)),
    };
    let (status, received) = ended.map_err(fail)?;
    Ok(Ended { code: Exit::from(code(status)), is_killed: status.code().is_none(), received })
}

/// The exit code of a program, as in a shell.
fn code(ended: std::process::ExitStatus) -> u8 {
    #[cfg(unix)]
    let by_signal = std::os::unix::process::ExitStatusExt::signal(&ended).map(|signal| 128 + signal);
    #[cfg(not(unix))]
    let by_signal = None;
    // A second interrupt, or one before the program watched for them.
    let by_signal = by_signal.map(|code| if interrupt::was_pressed() { i32::from(Exit::INTERRUPTED.0) } else { code });
    ended.code().or(by_signal).and_then(|code| u8::try_from(code).ok()).unwrap_or(1)
}
