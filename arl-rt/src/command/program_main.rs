//! The command line of a compiled program.

mod several;

use std::ffi::OsString;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use crate::builtins::time;
use crate::command::between::{Beat, Between};
use crate::command::coverage;
use crate::command::debug;
use crate::command::live::{self, Cut, LineWriter, Recording, STATE_INTERVAL_S, Wishes};
use crate::command::report;
use crate::command::say::say;
use crate::command::serve;
use crate::context::output::{Output, Stream};
use crate::context::program::Program;
pub use crate::context::program::{Make, Other};
use crate::context::standard_error::tell;
use crate::context::standstill::Standstill;
use crate::controller::{Builder, Controller, Outcome, SetupError};
use crate::cycle::clock_source::{RealClock, VirtualClock};
use crate::cycle::realtime::Realtime;
use crate::io::{Pendant, Scenario};
use crate::storage::state::{Directory, Memory};
use crate::unit::robot_driver::Connect;
use crate::values::Controlmode;
use arl_robot::cell::{Cell, Names};
use arl_robot::changes::{Changes, Part};
use arl_robot::robot::Robot;

/// What the program's functions may fill of the stack, and what the thread has on top of that for everything else. Each
/// cycle goes down the whole chain of functions that wait for each other, so that a long one takes long.
const PROGRAM_STACK_BYTES: usize = 8 << 20;
const CONTROLLER_STACK_BYTES: usize = 1 << 20;
/// What they may fill on a thread of another program, which has 2 MiB as a rule.
const HOST_STACK_BYTES: usize = 1 << 20;

/// The directory below the script directory that keeps system variables where no other is named.
const STATE_DIR: &str = ".arl-state";

pub(super) const EXIT_ENDED: u8 = 0;
const EXIT_USAGE: u8 = 2;
pub(super) const EXIT_ALARM: u8 = 3;
pub(super) const EXIT_MAX_TIME: u8 = 4;
pub(super) const EXIT_INTERRUPTED: u8 = 130;

const HELP: &str = "\
Runs a robot program on a simulated robot.

Options:
  --robot NAME|FILE     the robot: a built-in name or a robot file
  --cell FILE           the cell: io, home points, control cycle
  --drive               move the robots that the cell has a [driver] for; without it all are
                        simulated
  --clock virtual|real  run as fast as possible (default), or in real time; from the
                        first connection that a program opens it is real time
  --realtime[=CORE]     --clock real, and what the system gives the cycle: priority, its
                        memory locked, a core of its own (the last one)
  --script-dir DIR      the folder of the program's files
  --state-dir DIR       the folder that keeps system variables, and where
                        the programs stood, between runs
  --io FILE             a scenario: what the outside does to the inputs
  --trace FILE.csv      write the motion, one row a cycle
  --report[=FILE]       say at the end what each motion did, on the standard error,
                        or one JSON object a line into a file
  --live                be driven by lines on the standard input (di.5 = true), and
                        say what happens as JSON lines on the standard output
  --paused              with --live: wait for the start button
  --debug ADDRESS       connect to a debugger there, which says when to run: for programs
                        that were made for one
  --listener ADDRESS    connect to a listener there (arl2rs run --record) and say what
                        happens, as --live does
  --each-cycle          with --live or --listener: say in each cycle where the robots are
  --each-motion         with --live or --listener: say what each motion did
  --state-interval S    with --live: how often to say how everything stands (0.05)
  --coverage FILE       write how often each statement ran: for programs that were made
                        for a debugger
  --loop                the loop running mode: a program that ends is reset and begins
                        again, until the time is over or it calls exit
  --cycle-time FILE     write how many controller seconds the run took
  --max-time S          end after so many controller seconds, with exit code 4
  --mode MODE           auto (default), manual or manufast
  --override PCT        the speed override in percent, 0 to 100
  --seed N              the seed of rand
  --start-time T        the date at the start: now, or a time like 2000-01-01T00:00:00
  --set PLACE=VALUE     another value at one place: global.NAME, robot.KEYS, cell.KEYS,
                        io.KEYS (io.event.2.at=1.5); as often as there are places
  --help                this text

Exit codes: 0 ended, 2 usage, 3 alarm, 4 the time was over or nothing could change
any more, 130 interrupted.
";

/// What the command line says.
#[derive(Clone, PartialEq, Debug)]
struct Options {
    robot: Option<String>,
    cell: Option<PathBuf>,
    drive: bool,
    clock: Option<Pace>,
    realtime: Option<Realtime>,
    live: bool,
    paused: bool,
    asked: Asked,
    repeats: bool,
    script_dir: PathBuf,
    state_dir: Option<PathBuf>,
    io: Option<PathBuf>,
    trace: Option<PathBuf>,
    listener: Option<String>,
    wishes: Wishes,
    report: Option<Report>,
    cycle_time: Option<PathBuf>,
    max_time: Option<f64>,
    mode: Controlmode,
    override_percent: f64,
    seed: Option<u64>,
    start_time: Option<i64>,
    changes: Changes,
}

impl Options {
    /// The first option that only a program has that runs by itself.
    fn needs_a_process(&self) -> Option<&'static str> {
        let asked = [
            (self.live, "--live"),
            (self.paused, "--paused"),
            (self.realtime.is_some(), "--realtime"),
            (matches!(self.report, Some(Report::File(_))), "--report=FILE"),
            (self.cycle_time.is_some(), "--cycle-time"),
            (self.asked.debug.is_some(), "--debug"),
            (self.asked.coverage.is_some(), "--coverage"),
            (self.wishes.each_cycle && self.listener.is_none(), "--each-cycle"),
            (self.wishes.each_motion && self.listener.is_none(), "--each-motion"),
            (self.wishes.state_interval != STATE_INTERVAL_S, "--state-interval"),
        ];
        asked.into_iter().find_map(|(asked, option)| asked.then_some(option))
    }
}

/// How fast cycles follow each other.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Pace {
    Virtual,
    Real,
}

/// Where to say what the motions did.
#[derive(Clone, PartialEq, Debug)]
enum Report {
    /// As a table on the standard error.
    Table,
    /// As JSON in a file.
    File(PathBuf),
}

/// What makes drivers for `--drive`.
static CONNECT: OnceLock<Connect> = OnceLock::new();

/// Says what makes the drivers that a cell file asks for, before `main` runs a program: `arl_drivers::connect`. Without it
/// `--drive` is refused.
pub fn drivers(connect: Connect) {
    let _ = CONNECT.set(connect);
}

/// Runs a program as its command line says: the `main` of every compiled program.
///
/// The program is made on a thread with a large stack. `script_dir` is the folder of its files where the command line
/// names none.
pub fn main<P: Program + 'static>(program: impl FnOnce() -> P + Send, script_dir: &str) -> ExitCode {
    main_with(program, &[], script_dir)
}

/// The same for several programs: the first one, and those that the cell file may name.
pub fn main_with<P: Program + 'static>(
    program: impl FnOnce() -> P + Send,
    others: &[Other],
    script_dir: &str,
) -> ExitCode {
    start(program, others, script_dir, None)
}

/// The same for programs that were made for a debugger, which `--debug` connects to. Nothing of it is in other programs.
pub fn main_watched<P: Program + 'static>(
    program: impl FnOnce() -> P + Send,
    others: &[Other],
    script_dir: &str,
) -> ExitCode {
    start(
        program,
        others,
        script_dir,
        Some(Watching { connect: debug::connect, count: coverage::count, inside: debug::inside }),
    )
}

/// What programs can do that were made for a debugger.
#[derive(Clone, Copy)]
struct Watching {
    /// Connects a run to the debugger that listens at an address.
    connect: fn(&Controller, &str) -> std::io::Result<Box<dyn Between>>,
    /// Counts the statements of a run, for a file.
    count: fn(&Controller, &Path) -> std::io::Result<Box<dyn Between>>,
    /// Looks into the program of a channel.
    inside: live::Inside,
}

impl Watching {
    /// Who looks after the run between its cycles, if somebody is asked for.
    fn begin(self, controller: &Controller, asked: &Asked) -> Result<Option<Box<dyn Between>>, String> {
        let begun = match asked {
            Asked { debug: Some(address), .. } => (self.connect)(controller, address)
                .map_err(|error| format!("there is no debugger at {address}: {error}")),
            Asked { coverage: Some(file), .. } => {
                (self.count)(controller, file).map_err(|error| format!("cannot write {}: {error}", file.display()))
            }
            _ => return Ok(None),
        };
        begun.map(Some)
    }
}

/// What only programs can do that were made for a debugger.
#[derive(Clone, PartialEq, Default, Debug)]
struct Asked {
    debug: Option<String>,
    coverage: Option<PathBuf>,
}

impl Asked {
    /// Which option asks for it, and which command makes programs that can.
    fn needs(&self) -> Option<(&'static str, &'static str)> {
        match self {
            Self { debug: Some(_), .. } => Some(("--debug", "arl2rs dap")),
            Self { coverage: Some(_), .. } => Some(("--coverage", "arl2rs test --coverage FILE")),
            _ => None,
        }
    }
}

/// The same for programs that were compiled with the names of their variables. With `--serve` such a program makes run after run, each as a line of
/// the standard input asks for, and answers with a line: for `arl2rs sweep`.
pub fn main_named<P: Program + 'static>(
    program: impl Fn() -> P + Send,
    others: &[Other],
    script_dir: &str,
) -> ExitCode {
    if std::env::args_os().skip(1).eq([OsString::from("--serve")]) {
        return serve::serve(move || Box::new(program()) as Box<dyn Program>, others, script_dir);
    }
    start(program, others, script_dir, None)
}

fn start<P: Program + 'static>(
    program: impl FnOnce() -> P + Send,
    others: &[Other],
    script_dir: &str,
    watching: Option<Watching>,
) -> ExitCode {
    let arguments = std::env::args_os().skip(1);
    let options = match parse(arguments, script_dir) {
        Ok(Some(options)) => options,
        Ok(None) => {
            // Nobody may read the other end any more.
            let _ = std::io::stdout().write_all(HELP.as_bytes());
            return ExitCode::from(EXIT_ENDED);
        }
        Err(error) => return fail(EXIT_USAGE, &format!("{error}\nTry --help.")),
    };
    let interrupted = Arc::new(AtomicBool::new(false));
    if let Err(error) = watch_for_interrupts(&interrupted) {
        warn(&format!("Ctrl-C will not stop the robot on its path: {error}"));
    }
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(PROGRAM_STACK_BYTES + CONTROLLER_STACK_BYTES);
        let run = || run(Box::new(program()), others, options, Path::new(script_dir), watching, &interrupted);
        match thread.spawn_scoped(scope, run).map(|thread| thread.join()) {
            Ok(Ok(code)) => ExitCode::from(code),
            // The panic has been reported where it happened.
            Ok(Err(_)) => ExitCode::from(101),
            Err(error) => fail(EXIT_ALARM, &format!("the program's thread cannot be started: {error}")),
        }
    })
}

/// The first Ctrl-C sets the flag; a second one ends the process, should the program not come to an end.
fn watch_for_interrupts(interrupted: &Arc<AtomicBool>) -> std::io::Result<()> {
    use signal_hook::{consts::SIGINT, flag};
    flag::register_conditional_shutdown(SIGINT, i32::from(EXIT_INTERRUPTED), Arc::clone(interrupted))?;
    flag::register(SIGINT, Arc::clone(interrupted))?;
    Ok(())
}

fn fail(code: u8, text: &str) -> ExitCode {
    tell(format_args!("error: {text}"));
    ExitCode::from(code)
}

fn warn(text: &str) {
    tell(format_args!("warning: {text}"));
}

/// Reads the command line; nothing where help was asked for.
fn parse(
    arguments: impl IntoIterator<Item = OsString> + 'static,
    script_dir: &str,
) -> Result<Option<Options>, lexopt::Error> {
    use lexopt::prelude::*;
    let mut options = Options {
        robot: None,
        cell: None,
        drive: false,
        clock: None,
        realtime: None,
        live: false,
        paused: false,
        asked: Asked::default(),
        repeats: false,
        script_dir: PathBuf::from(script_dir),
        state_dir: None,
        io: None,
        trace: None,
        listener: None,
        wishes: Wishes::default(),
        report: None,
        cycle_time: None,
        max_time: None,
        mode: Controlmode::Auto,
        override_percent: 100.0,
        seed: None,
        start_time: None,
        changes: Changes::default(),
    };
    let mut parser = lexopt::Parser::from_args(arguments);
    while let Some(argument) = parser.next()? {
        match argument {
            Long("robot") => options.robot = Some(parser.value()?.string()?),
            Long("cell") => options.cell = Some(parser.value()?.into()),
            Long("drive") => options.drive = true,
            Long("live") => (options.live, options.clock) = (true, Some(Pace::Real)),
            Long("paused") => options.paused = true,
            Long("debug") => options.asked.debug = Some(parser.value()?.string()?),
            Long("coverage") => options.asked.coverage = Some(parser.value()?.into()),
            Long("clock") => {
                let paces = [("virtual", Pace::Virtual), ("real", Pace::Real)];
                options.clock = Some(word(&mut parser, "--clock", &paces)?);
            }
            Long("realtime") => {
                let core = parser.optional_value().map(|core| core.parse()).transpose()?;
                options.realtime = Some(core.map_or_else(Realtime::new, |core| Realtime::new().core(core)));
            }
            Long("loop") => options.repeats = true,
            Long("script-dir") => options.script_dir = parser.value()?.into(),
            Long("state-dir") => options.state_dir = Some(parser.value()?.into()),
            Long("io") => options.io = Some(parser.value()?.into()),
            Long("trace") => options.trace = Some(parser.value()?.into()),
            Long("each-cycle") => options.wishes.each_cycle = true,
            Long("each-motion") => options.wishes.each_motion = true,
            Long("state-interval") => {
                options.wishes.state_interval = number(&mut parser, "--state-interval", "seconds", f64::MAX)?;
            }
            Long("listener") => options.listener = Some(parser.value()?.string()?),
            Long("report") => {
                options.report = Some(parser.optional_value().map_or(Report::Table, |file| Report::File(file.into())));
            }
            Long("cycle-time") => options.cycle_time = Some(parser.value()?.into()),
            Long("max-time") => options.max_time = Some(number(&mut parser, "--max-time", "seconds", f64::MAX)?),
            Long("mode") => {
                let modes =
                    [("auto", Controlmode::Auto), ("manual", Controlmode::Manual), ("manufast", Controlmode::Manufast)];
                options.mode = word(&mut parser, "--mode", &modes)?;
            }
            Long("override") => options.override_percent = number(&mut parser, "--override", "percent", 100.0)?,
            Long("seed") => options.seed = Some(parser.value()?.parse()?),
            Long("start-time") => {
                let text = parser.value()?.string()?;
                let wrong = || format!("--start-time {text}: expected now, or a time like 2000-01-01T00:00:00");
                options.start_time = Some(time::parse(&text).ok_or_else(wrong)?);
            }
            Long("set") => options.changes.add(&parser.value()?.string()?)?,
            Short('h') | Long("help") => return Ok(None),
            other => return Err(other.unexpected()),
        }
    }
    if options.realtime.is_some() {
        if options.clock == Some(Pace::Virtual) {
            return Err("--realtime is for --clock real: on the virtual clock cycles do not wait".into());
        }
        options.clock = Some(Pace::Real);
    }
    let Options { robot, cell, io, changes, .. } = &options;
    let files =
        [(Part::Robot, robot.is_some(), "robot"), (Part::Cell, cell.is_some(), "cell"), (Part::Io, io.is_some(), "io")];
    for (part, is_named, option) in files {
        if let (false, Some((path, _))) = (is_named, changes.of_part(part).next()) {
            return Err(format!("--set {option}.{path}: --{option} has to name the file whose value this is").into());
        }
    }
    Ok(Some(options))
}

/// One of a few words.
fn word<T: Copy>(parser: &mut lexopt::Parser, option: &str, words: &[(&str, T)]) -> Result<T, lexopt::Error> {
    use lexopt::ValueExt;
    let found = parser.value()?.string()?;
    let known = words.iter().find(|(word, _)| word.eq_ignore_ascii_case(&found));
    known.map(|(_, value)| *value).ok_or_else(|| {
        let words: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
        format!("{option} {found}: expected {}", words.join(" or ")).into()
    })
}

/// A number from 0 up.
fn number(parser: &mut lexopt::Parser, option: &str, what: &str, most: f64) -> Result<f64, lexopt::Error> {
    use lexopt::ValueExt;
    let found = parser.value()?.string()?;
    match found.parse::<f64>() {
        Ok(number) if (0.0..=most).contains(&number) => Ok(number),
        _ if most < f64::MAX => Err(format!("{option} {found}: expected {what} from 0 to {most}").into()),
        _ => Err(format!("{option} {found}: expected {what}, 0 or more").into()),
    }
}

/// Sets the controller up and runs the program; the exit code.
fn run(
    program: Box<dyn Program>,
    others: &[Other],
    options: Options,
    sources: &Path,
    watching: Option<Watching>,
    interrupted: &AtomicBool,
) -> u8 {
    let asked = options.asked.clone();
    if let (Some((option, command)), None) = (asked.needs(), watching) {
        tell(format_args!("error: this program was not made for {option}: `{command}` makes such programs"));
        return EXIT_USAGE;
    }
    // Before anything begins to work beside the cycle.
    for problem in options.realtime.map(Realtime::begin).unwrap_or_default() {
        warn(&format!("not as --realtime asks: {problem}"));
    }
    let max_time = options.max_time;
    let cycle_time = options.cycle_time.clone();
    let real = options.clock == Some(Pace::Real);
    let report = match options.report.clone().map(report_to).transpose() {
        Ok(report) => report,
        Err(error) => {
            tell(format_args!("error: {error}"));
            return EXIT_USAGE;
        }
    };
    let repeats = options.repeats;
    let voice = options.live.then(LineWriter::standard);
    let (wishes, paused) = (options.wishes, options.paused);
    let address = options.listener.as_deref().filter(|_| voice.is_none());
    let recording = match address.map(|address| connect_to(address, wishes)).transpose() {
        Ok(recording) => recording,
        Err(problem) => {
            tell(format_args!("error: {problem}"));
            return EXIT_USAGE;
        }
    };
    let controller = set_up(options, others).and_then(|builder| {
        let builder = match (&voice, &recording) {
            (Some(voice), _) => builder.output(voice.messages()),
            (None, Some(recording)) => builder.output(recording.beside(Stream::standard())),
            (None, None) => builder,
        };
        let builder = if wishes.each_motion { builder.record_motions() } else { builder };
        builder.build(program).map_err(SetupFailure::from)
    });
    let mut controller = match controller {
        Ok(controller) => controller,
        Err(SetupFailure { code, text }) => {
            tell(format_args!("error: {text}"));
            return code;
        }
    };
    controller.set_loop(repeats);
    let between = match watching.map_or(Ok(None), |watching| watching.begin(&controller, &asked)) {
        Ok(between) => between,
        Err(problem) => {
            tell(format_args!("error: {problem}"));
            return EXIT_USAGE;
        }
    };
    let code = match voice {
        Some(voice) => {
            if paused {
                controller.press(Pendant::Pause);
            }
            let inside = watching.map(|watching| watching.inside);
            code(live::drive(&mut controller, &voice, (inside, wishes), max_time, interrupted))
        }
        None => watch(&mut controller, max_time, interrupted, (between, recording), sources),
    };
    if let Some(mut report) = report
        && let Err(error) = report(&controller)
    {
        warn(&format!("the report cannot be written: {error}"));
    }
    if let Some(file) = cycle_time
        && let Err(error) = std::fs::write(&file, format!("{}\n", controller.time()))
    {
        warn(&format!("cannot write {}: {error}", file.display()));
    }
    if real {
        lateness(&controller).iter().for_each(|text| warn(text));
    }
    code
}

/// What came too late in a run in real time.
pub(super) fn lateness(controller: &Controller) -> Vec<String> {
    let mut said = Vec::new();
    if let Some(lateness) = controller.lateness().filter(|lateness| lateness.late() > 0) {
        let (late, lost, longest) = (lateness.late(), lateness.lost(), lateness.longest().as_secs_f64() * 1e3);
        said.push(format!(
            "the computer was too busy: {late} control cycles began late, the latest by {longest:.1} ms; {lost} were lost"
        ));
    }
    if controller.found_late() > 0 {
        let advice = if cfg!(debug_assertions) { "; `arl2rs build --release` makes a quicker program" } else { "" };
        said.push(format!(
            "the computer was too busy to find the motion ahead in time, {} times: robots may have gone more slowly, or stopped on their path{advice}",
            controller.found_late()
        ));
    }
    said
}

/// Who waits for what in vain, each with its channel where there are several.
pub(super) fn listed(waiting: &[Standstill]) -> Vec<String> {
    let several = waiting.len() > 1;
    let line = |one: &Standstill| if several { format!("{}: {one}", one.channel) } else { one.to_string() };
    waiting.iter().map(line).collect()
}

/// Says who waits for what in vain.
fn say_standstill(time: f64, waiting: &[Standstill]) {
    tell(format_args!(
        "nothing can change any more after {time} s: no event of a scenario is left, nothing moves, and no timer runs"
    ));
    listed(waiting).iter().for_each(|line| tell(format_args!("  {line}")));
}

/// A controller for a run in this process, with the same options as on a command line, after how many s it ends at the latest, and whether it is asked to be in real time.
pub(super) fn in_process(
    program: Box<dyn Program>,
    (others, script_dir): (&[Other], &str),
    arguments: Vec<OsString>,
    output: impl Output + 'static,
) -> Result<InProcess, String> {
    let options = parse(arguments, script_dir).map_err(|error| error.to_string())?;
    let options = options.ok_or("--help: there is no command line here")?;
    if let Some(option) = options.needs_a_process() {
        return Err(format!("{option} is for a program that runs by itself"));
    }
    let (max_time, repeats, wishes) = (options.max_time, options.repeats, options.wishes);
    let is_real = options.clock == Some(Pace::Real);
    let keeps = options.state_dir.is_some();
    let recording = options.listener.as_deref().map(|address| connect_to(address, wishes)).transpose()?;
    let builder = set_up(options, others).map_err(|failure| failure.text)?.stack(HOST_STACK_BYTES);
    // Runs beside each other would share the folder of the program.
    let builder = if keeps { builder } else { builder.storage(Memory::default()) };
    let builder = match &recording {
        Some(recording) => builder.output(recording.beside(output)),
        None => builder.output(output),
    };
    let builder = if wishes.each_motion { builder.record_motions() } else { builder };
    let mut controller = builder.build(program).map_err(|error| error.to_string())?;
    controller.set_loop(repeats);
    Ok(InProcess { controller, max_time, is_real, recording })
}

/// A run that is part of another process, before its first cycle.
pub(super) struct InProcess {
    pub(super) controller: Controller,
    pub(super) max_time: Option<f64>,
    /// Whether it was asked to be in real time.
    pub(super) is_real: bool,
    pub(super) recording: Option<Recording>,
}

/// What there is to say where a listener could not hear all.
pub(super) fn left_out(lost: u64) -> Option<String> {
    (lost > 0).then(|| format!("who listens was too slow for real time: what happened is left out, {lost} times"))
}

fn connect_to(address: &str, wishes: Wishes) -> Result<Recording, String> {
    Recording::connect(address, wishes).map_err(|error| format!("there is no listener at {address}: {error}"))
}

/// The exit code of a run that was driven from outside.
fn code(driven: Result<Option<Outcome>, Cut>) -> u8 {
    match driven {
        Ok(Some(Outcome::Alarm(_))) => EXIT_ALARM,
        Ok(_) => EXIT_ENDED,
        Err(Cut::MaxTime) => EXIT_MAX_TIME,
        Err(Cut::Interrupted) => EXIT_INTERRUPTED,
    }
}

/// Writes the report at the end of a run.
type WriteReport = Box<dyn FnMut(&Controller) -> std::io::Result<()>>;

/// What writes the report. A file is made at the start: better to fail now than after a long run.
fn report_to(report: Report) -> Result<WriteReport, String> {
    Ok(match report {
        Report::Table => Box::new(|controller| {
            let text = report::tables(&controller.all_motions(), controller.time());
            let lateness = controller.lateness().map(ToString::to_string).unwrap_or_default();
            std::io::stderr().write_all((text + &lateness).as_bytes())
        }),
        Report::File(path) => {
            let mut file = File::create(&path).map_err(|error| format!("{}: {error}", path.display()))?;
            Box::new(move |controller| {
                let text = report::all_json(&controller.all_motions(), controller.time());
                let clock = controller.lateness().map(report::clock_json).unwrap_or_default();
                file.write_all((text + &clock).as_bytes())
            })
        }
    })
}

/// Steps until the run is over, its time is, or somebody pressed Ctrl-C.
fn watch(
    controller: &mut Controller,
    max_time: Option<f64>,
    interrupted: &AtomicBool,
    (mut between, recording): (Option<Box<dyn Between>>, Option<Recording>),
    sources: &Path,
) -> u8 {
    recording.iter().for_each(|recording| recording.begin(controller));
    let last = max_time.map_or(u64::MAX, |seconds| controller.cycles(seconds));
    let mut code = None;
    // Who was told to stop does not begin again.
    let is_over = |controller: &Controller, stopped: bool| match stopped {
        true => controller.outcome().is_some(),
        false => controller.is_over(),
    };
    while !is_over(controller, code.is_some()) {
        let beat = between.as_mut().map_or(Beat::Runs, |between| between.cycle_begins(controller));
        let is_alone = recording.as_ref().is_some_and(Recording::is_gone);
        if code.is_none() && (interrupted.load(Ordering::Relaxed) || is_alone || beat == Beat::Ends) {
            code = Some(EXIT_INTERRUPTED);
            controller.stop();
            tell(format_args!("interrupted: the robot stops on its path"));
        } else if code.is_none() && controller.cycle() >= last {
            code = Some(EXIT_MAX_TIME);
            tell(format_args!("{}", time_is_over(controller, max_time.unwrap_or_default())));
            controller.stop();
        }
        controller.step();
        recording.iter().for_each(|recording| recording.cycle_ended(controller));
        say(controller, sources, recording.as_ref());
        if code.is_none()
            && beat != Beat::Stands
            && let Some(waiting) = controller.standstill()
            && !between
                .as_mut()
                .is_some_and(|between| between.nothing_can_change(controller, &listed(&waiting).join("; ")))
        {
            code = Some(EXIT_MAX_TIME);
            say_standstill(controller.time(), &waiting);
            controller.stop();
        }
    }
    controller.close_robots();
    controller.settle_state();
    say(controller, sources, recording.as_ref());
    let lost = recording.iter().map(|recording| recording.run_ended(controller)).sum::<u64>();
    left_out(lost).iter().for_each(|text| warn(text));
    between.into_iter().for_each(|mut between| between.run_ended(controller));
    match (code, controller.outcome()) {
        (Some(code), _) => code,
        (None, Some(Outcome::Alarm(_))) => EXIT_ALARM,
        (None, _) => EXIT_ENDED,
    }
}

/// What a run says whose time is over, after so many s.
pub(super) fn time_is_over(controller: &Controller, limit: f64) -> String {
    let place = match controller.place() {
        // What only calculates says no line.
        (file, 0) => format!("calculates in {}", file.name()),
        (file, line) => format!("stands at {}:{line}", file.name()),
    };
    format!("the time is over: {limit} s; the program {place}")
}

/// Why there is no controller, and the exit code for it.
struct SetupFailure {
    code: u8,
    text: String,
}

impl SetupFailure {
    fn usage(text: impl ToString) -> Self {
        Self { code: EXIT_USAGE, text: text.to_string() }
    }
}

impl From<SetupError> for SetupFailure {
    fn from(error: SetupError) -> Self {
        let code = if matches!(error, SetupError::State(_)) { EXIT_ALARM } else { EXIT_USAGE };
        Self { code, text: error.to_string() }
    }
}

fn set_up(options: Options, others: &[Other]) -> Result<Builder, SetupFailure> {
    let mut builder =
        Controller::builder().mode(options.mode).speed_override(options.override_percent).stack(PROGRAM_STACK_BYTES);
    if let Some(robot) = &options.robot {
        builder = builder.robot(Robot::load_with(robot, &options.changes).map_err(SetupFailure::usage)?);
    }
    let mut names = Names::default();
    if let Some(cell) = &options.cell {
        let cell = Cell::load_with(cell, &options.changes).map_err(SetupFailure::usage)?;
        names = cell.names.clone();
        builder = builder.cell_with(cell, others)?;
        builder = several::trace(builder, options.trace.as_deref())?;
    }
    if options.drive {
        let connect = CONNECT.get().ok_or_else(|| SetupFailure::usage("--drive: this program has no drivers"))?;
        builder = builder.drivers(*connect);
    }
    if let Some(io) = &options.io {
        let scenario = Scenario::load_changed(io, &names, &options.changes);
        builder = builder.scenario(scenario.map_err(SetupFailure::usage)?);
    }
    let globals = options.changes.of_part(Part::Global);
    builder = globals.fold(builder, |builder, (name, value)| builder.global(name, value));
    if let Some(trace) = &options.trace {
        let file = File::create(trace);
        builder = builder.trace(file.map_err(|error| SetupFailure::usage(format!("{}: {error}", trace.display())))?);
    }
    if options.report.is_some() {
        builder = builder.record_motions();
    }
    if let Some(seed) = options.seed {
        builder = builder.seed(seed);
    }
    // On the real clock the date is the world's.
    let start = options.start_time.or_else(|| (options.clock == Some(Pace::Real)).then(time::of_the_world));
    if let Some(start) = start {
        builder = builder.start_date(start);
    }
    let state_dir = options.state_dir.unwrap_or_else(|| Path::new(&options.script_dir).join(STATE_DIR));
    builder = builder.script_dir(options.script_dir).storage(Directory::new(state_dir));
    Ok(match options.clock {
        Some(Pace::Real) => builder.clock(RealClock::new()),
        Some(Pace::Virtual) => builder.clock(VirtualClock::asked_for()),
        None => builder.clock(VirtualClock::new()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(arguments: &[&str]) -> Result<Option<Options>, String> {
        let arguments: Vec<OsString> = arguments.iter().map(Into::into).collect();
        parse(arguments, "scripts").map_err(|error| error.to_string())
    }

    #[test]
    fn options_are_read() {
        assert!(parsed(&["--loop"]).unwrap().unwrap().repeats);
        let options = parsed(&["--robot=six-10", "--clock", "real", "--max-time", "2.5", "--mode", "MANUAL"]);
        let options = options.unwrap().unwrap();
        assert_eq!(options.robot.as_deref(), Some("six-10"));
        assert_eq!((options.clock, options.max_time, options.mode), (Some(Pace::Real), Some(2.5), Controlmode::Manual));
        assert_eq!(options.script_dir, Path::new("scripts"));
        let realtime = parsed(&["--realtime=1"]).unwrap().unwrap();
        assert_eq!((realtime.clock, realtime.realtime), (Some(Pace::Real), Some(Realtime::new().core(1))));
        assert_eq!(parsed(&["--help"]), Ok(None));
        let report = |arguments: &[&str]| parsed(arguments).unwrap().unwrap().report;
        assert_eq!(report(&["--report", "--seed", "1"]), Some(Report::Table));
        assert_eq!(report(&["--report=r.jsonl"]), Some(Report::File("r.jsonl".into())));
    }

    #[test]
    fn mistakes_say_what_was_expected() {
        for (arguments, words) in [
            (&["--clock", "fast"][..], "virtual or real"),
            (&["--max-time", "-1"], "seconds, 0 or more"),
            (&["--override", "120"], "percent from 0 to 100"),
            (&["--mode", "t1"], "auto or manual or manufast"),
            (&["--start-time", "then"], "2000-01-01T00:00:00"),
            (&["--realtime=first"], "invalid digit"),
            (&["--realtime", "--clock", "virtual"], "--realtime is for --clock real"),
            (&["--speed"], "--speed"),
            (&["--seed"], "--seed"),
            (&["file"], "file"),
        ] {
            let error = parsed(arguments).unwrap_err();
            assert!(error.contains(words), "{error}");
        }
    }
}
