//! The command line of a compiled program.

mod channel_traces;
mod options;
mod results;

use std::ffi::OsString;
use std::io::{IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;
use std::sync::OnceLock;
use std::time::SystemTime;

use crate::builtins::time;
use crate::command::between::{Between, CycleOrder};
use crate::command::coverage;
use crate::command::debug;
use crate::command::interrupts::Interrupted;
use crate::command::live::{self, Cut, LineWriter, Recording, Wishes};
use crate::command::polling::Polling;
use crate::command::say::{self, say, say_condition};
use crate::command::serve;
use crate::command::stack::{PROGRAM_STACK_BYTES, Stack};
use crate::context::output::{Output, Stream};
use crate::context::program::Program;
pub use crate::context::program::{Make, Other};
use crate::context::standard_error::tell;
use crate::context::standstill::Standstill;
use crate::controller::trace::More;
use crate::controller::{Builder, Controller, Outcome, SetupError};
use crate::cycle::clock_source::{Lateness, RealClock, VirtualClock};
use crate::cycle::realtime::Realtime;
use crate::io::Scenario;
use crate::storage::state::{Directory, Memory};
use crate::unit::robot_driver::Connect;
use arl_robot::cell::{Cell, Names};
use arl_robot::changes::Part;
use arl_robot::result_file;
use arl_robot::robot::Robot;
pub use channel_traces::numbered as numbered_trace;
use options::{Asked, ClockKind, HELP, Options, parse};

/// A variable of the environment: with it the process ends when its standard input is closed, so that it does not
/// outlive who started it.
const WHILE_INPUT: &str = "ARL2RS_WHILE_INPUT";

/// The default directory for system variables, below the script directory.
const STATE_DIR: &str = ".arl-state";

pub(super) const EXIT_ENDED: u8 = 0;
const EXIT_USAGE: u8 = 2;
pub(super) const EXIT_ALARM: u8 = 3;
pub(super) const EXIT_MAX_TIME: u8 = 4;
pub(super) const EXIT_INTERRUPTED: u8 = 130;
/// A bug of the runtime: the code of Rust programs that panic.
const EXIT_PANICKED: u8 = 101;

/// Makes drivers for `--drive`.
static CONNECT: OnceLock<Connect> = OnceLock::new();

/// Sets the function that makes the drivers that a cell file asks for, before `main` runs a program:
/// `arl_drivers::connect`. Without it `--drive` is refused.
pub fn drivers(connect: Connect) {
    let _ = CONNECT.set(connect);
}

/// Runs a program according to its command line: the `main` of every compiled program.
///
/// The program is made on a thread with a large stack. `script_dir` is the folder of its files where the command line
/// names none.
pub fn main<P: Program + 'static>(program: impl FnOnce() -> P + Send, script_dir: &str) -> ExitCode {
    main_with(program, &[], script_dir)
}

/// As `main`, for several programs: the first one, and those that the cell file may name.
pub fn main_with<P: Program + 'static>(
    program: impl FnOnce() -> P + Send,
    others: &[Other],
    script_dir: &str,
) -> ExitCode {
    start(program, others, script_dir, None)
}

const WATCHING: Watching = Watching { connect: debug::connect, count: coverage::count, inside: debug::inside };

/// The extra abilities of programs that were made for a debugger.
#[derive(Clone, Copy)]
struct Watching {
    /// Connects a run to the debugger that listens at an address.
    connect: fn(&Controller, &str) -> std::io::Result<Box<dyn Between>>,
    /// Counts the statements of a run, for a file.
    count: fn(&Controller, &Path) -> std::io::Result<Box<dyn Between>>,
    /// Shows the inside of the program of a channel.
    inside: live::Inside,
}

impl Watching {
    /// The observer that acts between the cycles of the run, if one was requested.
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

/// As `main_with`, for programs that were compiled with the names of their variables. With `--serve` such a program
/// makes run after run, one for each line of the standard input, and answers with a line: for `arl2rs sweep`.
pub fn main_named<P: Program + 'static>(
    program: impl Fn() -> P + Send,
    others: &[Other],
    script_dir: &str,
) -> ExitCode {
    if std::env::args_os().skip(1).eq([OsString::from("--serve")]) {
        return ExitCode::from(serve::serve(move || Box::new(program()) as Box<dyn Program>, others, script_dir));
    }
    start(program, others, script_dir, None)
}

/// As `main_named`, with the words of a command line that is not that of this process: for programs that are part of
/// another command. Programs of other files are those of `others`; the sources are as they were at `made`.
/// `was_interrupted`: whether the process got an interrupt, perhaps before the program watches for them itself.
/// Returns the number of the exit code.
pub fn main_within<P: Program + 'static>(
    words: Vec<OsString>,
    program: impl Fn() -> P + Send,
    others: &[Other],
    script_dir: &str,
    made: SystemTime,
    was_interrupted: fn() -> bool,
) -> u8 {
    say::made_at(made);
    if words.iter().eq(["--serve"]) {
        return serve::serve(move || Box::new(program()) as Box<dyn Program>, others, script_dir);
    }
    start_with(words, program, others, script_dir, Some(WATCHING), was_interrupted)
}

fn start<P: Program + 'static>(
    program: impl FnOnce() -> P + Send,
    others: &[Other],
    script_dir: &str,
    watching: Option<Watching>,
) -> ExitCode {
    let words = std::env::args_os().skip(1).collect();
    ExitCode::from(start_with(words, program, others, script_dir, watching, || false))
}

fn start_with<P: Program + 'static>(
    arguments: Vec<OsString>,
    program: impl FnOnce() -> P + Send,
    others: &[Other],
    script_dir: &str,
    watching: Option<Watching>,
    was_interrupted: fn() -> bool,
) -> u8 {
    let options = match parse(arguments, script_dir) {
        Ok(Some(options)) => options,
        Ok(None) => {
            // The other end may be closed; that is no error here.
            let _ = std::io::stdout().write_all(HELP.as_bytes());
            return EXIT_ENDED;
        }
        Err(error) => return fail(EXIT_USAGE, &format!("{error}\nTry --help.")),
    };
    if std::env::var_os(WHILE_INPUT).is_some() {
        std::thread::spawn(|| {
            let _ = std::io::copy(&mut std::io::stdin(), &mut std::io::sink());
            std::process::exit(EXIT_INTERRUPTED.into());
        });
    }
    let (interrupted, watched) = Interrupted::watch(was_interrupted, EXIT_INTERRUPTED);
    if let Err(error) = watched {
        warn(&format!("Ctrl-C will not stop the robot on its path: {error}"));
    }
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(Stack::WHOLE_BYTES);
        let run = || run(Box::new(program()), others, options, Path::new(script_dir), watching, &interrupted);
        match thread.spawn_scoped(scope, run).map(|thread| thread.join()) {
            Ok(Ok(code)) => code,
            // The panic has been reported where it happened.
            Ok(Err(_)) => EXIT_PANICKED,
            Err(error) => fail(EXIT_ALARM, &format!("the program's thread cannot be started: {error}")),
        }
    })
}

fn fail(code: u8, text: &str) -> u8 {
    tell(format_args!("error: {text}"));
    code
}

fn warn(text: &str) {
    tell(format_args!("warning: {text}"));
}

/// Sets up the controller and runs the program; returns the exit code.
fn run(
    program: Box<dyn Program>,
    others: &[Other],
    options: Options,
    sources: &Path,
    watching: Option<Watching>,
    interrupted: &Interrupted,
) -> u8 {
    let ran = try_run(program, others, options, sources, watching, interrupted);
    ran.unwrap_or_else(|SetupFailure { code, text }| {
        tell(format_args!("error: {text}"));
        code
    })
}

fn try_run(
    program: Box<dyn Program>,
    others: &[Other],
    options: Options,
    sources: &Path,
    watching: Option<Watching>,
    interrupted: &Interrupted,
) -> Result<u8, SetupFailure> {
    let asked = options.asked.clone();
    if let (Some((option, command)), None) = (asked.needs(), watching) {
        let text = format!("this program was not made for {option}: `{command}` makes such programs");
        return Err(SetupFailure::usage(text));
    }
    // Before any thread beside the cycle is started, but for the one that waits for interrupts.
    for problem in options.realtime.map(Realtime::begin).unwrap_or_default() {
        warn(&format!("--realtime has no full effect: {problem}"));
    }
    let (max_time, cycle_time) = (options.max_time, options.cycle_time.clone());
    let (wishes, paused, repeats) = (options.wishes, options.paused, options.repeats);
    // Where a robot is driven, lateness matters, too.
    let tells_lateness = options.clock == Some(ClockKind::Real) || options.drive;
    let report = options.report.clone().map(results::report_to).transpose().map_err(SetupFailure::usage)?;
    let writer = options.live.then(LineWriter::standard);
    let address = options.listener.as_deref().filter(|_| writer.is_none());
    let recording = address.map(|address| connect_to(address, wishes)).transpose().map_err(SetupFailure::usage)?;
    let builder = set_up(options, others)?;
    let builder = match (&writer, &recording) {
        (Some(writer), _) => builder.output(writer.messages()),
        (None, Some(recording)) => builder.output(recording.beside(Stream::standard())),
        (None, None) => builder,
    };
    let builder = if wishes.each_motion { builder.record_motions() } else { builder };
    let mut controller = builder.build(program)?;
    controller.set_loop(repeats);
    let between = watching.map_or(Ok(None), |watching| watching.begin(&controller, &asked));
    let between = between.map_err(SetupFailure::usage)?;
    // Nothing refuses the run any more: its traces take the place of older ones.
    controller.begin_traces();
    let code = match writer {
        Some(writer) => {
            if paused {
                controller.wait_for_start();
            }
            let inside = watching.map(|watching| watching.inside);
            code(live::drive(&mut controller, &writer, inside, wishes, max_time, interrupted))
        }
        None => {
            // Advice is for who looks on, not for scripts.
            let advises = watching.is_some() && between.is_none() && std::io::stderr().is_terminal();
            let code = watch(&mut controller, max_time, interrupted, between, recording, sources);
            if advises && let Some(advice) = advice_to_compile(controller.full_cycles()) {
                tell(format_args!("{advice}"));
            }
            code
        }
    };
    results::write_figures(&controller, report, cycle_time.as_deref());
    if tells_lateness {
        lateness(&controller).iter().for_each(|text| warn(text));
    }
    Ok(code)
}

/// Who runs a program by the engine is told about compiling after so many cycles that were full of calculation: that
/// took seconds.
const MANY_FULL_CYCLES: u64 = 2_000;

/// What to do about a program that calculates much.
fn advice_to_compile(full_cycles: u64) -> Option<String> {
    (full_cycles >= MANY_FULL_CYCLES).then(|| {
        format!(
            "{full_cycles} cycles were full of turns of loops: a program that calculates that much is sooner done with \
             `--engine native`, which compiles it (with Rust); a loop that only waits is better a `waituntil`"
        )
    })
}

/// Warnings about what was too late in a run in real time.
pub(super) fn lateness(controller: &Controller) -> Vec<String> {
    let mut warnings = Vec::new();
    if let Some(missing) = controller.lateness().map(Lateness::missing).filter(|missing| *missing > 0) {
        let messages = if missing == 1 { "message" } else { "messages" };
        warnings.push(format!(
            "{missing} {messages} from the robot did not arrive: the robot did not send, or the network lost them; as many control cycles were lost"
        ));
    }
    if let Some(lateness) = controller.lateness().filter(|lateness| lateness.late() > 0) {
        let (late, longest) = (lateness.late(), lateness.longest().as_secs_f64() * 1e3);
        let lost = lateness.lost() - lateness.missing();
        warnings.push(format!(
            "the computer was too busy: {late} control cycles began late, the latest by {longest:.1} ms; {lost} were lost"
        ));
    }
    if controller.found_late() > 0 {
        let advice = if cfg!(debug_assertions) { "; `arl2rs build --release` makes a faster program" } else { "" };
        warnings.push(format!(
            "the computer was too busy to find the motion ahead in time, {} times: robots may have moved more slowly, or stopped on their path{advice}",
            controller.found_late()
        ));
    }
    warnings
}

/// The programs that wait in vain and what they wait for, each with its channel where there are several.
pub(super) fn listed(waiting: &[Standstill]) -> Vec<String> {
    let are_many = waiting.len() > 1;
    let line = |one: &Standstill| if are_many { format!("{}: {one}", one.channel) } else { one.to_string() };
    waiting.iter().map(line).collect()
}

/// Reports which programs wait in vain, and for what.
fn say_standstill(controller: &Controller, sources: &Path, waiting: &[Standstill]) {
    let time = controller.time();
    tell(format_args!(
        "nothing can change any more after {time} s: no event of a scenario is left, nothing moves, and no timer runs"
    ));
    for (one, line) in waiting.iter().zip(listed(waiting)) {
        tell(format_args!("  {line}"));
        say_condition(controller, sources, one).iter().for_each(|line| tell(format_args!("  {line}")));
    }
}

/// A controller for a run in this process, with the same options as on a command line, its time limit in s, and whether
/// it was requested to run in real time.
pub(super) fn in_process(
    program: Box<dyn Program>,
    others: &[Other],
    script_dir: &str,
    arguments: Vec<OsString>,
    stack: Stack,
    output: impl Output + 'static,
) -> Result<InProcess, String> {
    let options = parse(arguments, script_dir).map_err(|error| error.to_string())?;
    let options = options.ok_or("--help: there is no command line here")?;
    if let Some(option) = options.needs_a_process() {
        return Err(format!("{option} is only for a program that runs on its own"));
    }
    let (max_time, repeats, wishes) = (options.max_time, options.repeats, options.wishes);
    let trace_columns = options.trace_columns;
    let is_real = options.clock == Some(ClockKind::Real);
    let keeps = options.state_dir.is_some();
    let recording = options.listener.as_deref().map(|address| connect_to(address, wishes)).transpose()?;
    let builder = set_up(options, others).map_err(|failure| failure.text)?.stack(stack.program_bytes());
    // Concurrent runs would share the folder of the program.
    let builder = if keeps { builder } else { builder.storage(Memory::default()) };
    let builder = match &recording {
        Some(recording) => builder.output(recording.beside(output)),
        None => builder.output(output),
    };
    let builder = if wishes.each_motion { builder.record_motions() } else { builder };
    let mut controller = builder.build(program).map_err(|error| error.to_string())?;
    controller.set_loop(repeats);
    controller.begin_traces();
    Ok(InProcess { controller, max_time, is_real, trace_columns, recording })
}

/// A run that is part of another process, before its first cycle.
pub(super) struct InProcess {
    pub(super) controller: Controller,
    pub(super) max_time: Option<f64>,
    /// Whether it was requested to run in real time.
    pub(super) is_real: bool,
    /// The columns of the trace behind those that every trace has.
    pub(super) trace_columns: More,
    pub(super) recording: Option<Recording>,
}

/// A warning where events for a listener were left out.
pub(super) fn lost_events_warning(lost: u64) -> Option<String> {
    (lost > 0).then(|| format!("the listener was too slow for real time: events were left out {lost} times"))
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

/// Steps until the run is over, its time is up, or Ctrl-C was pressed.
fn watch(
    controller: &mut Controller,
    max_time: Option<f64>,
    interrupted: &Interrupted,
    mut between: Option<Box<dyn Between>>,
    recording: Option<Recording>,
    sources: &Path,
) -> u8 {
    recording.iter().for_each(|recording| recording.begin(controller));
    let last = max_time.map_or(u64::MAX, |seconds| controller.cycles(seconds));
    let mut code = None;
    // A listener or debugger already sees where the program is.
    let mut polling = (between.is_none() && recording.is_none()).then(Polling::new);
    // A run that was stopped does not begin again.
    let is_over = |controller: &Controller, stopped: bool| match stopped {
        true => controller.outcome().is_some(),
        false => controller.is_over(),
    };
    while !is_over(controller, code.is_some()) {
        let order = between.as_mut().map_or(CycleOrder::Runs, |between| between.cycle_begins(controller));
        let is_alone = recording.as_ref().is_some_and(Recording::is_gone);
        if code.is_none() && (interrupted.is_set() || is_alone || order == CycleOrder::Ends) {
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
        // In real time waiting for an operator is normal.
        let polling = polling.as_mut().filter(|_| !controller.is_real_time());
        if let Some(text) = polling.and_then(|polling| polling.cycle_ended(controller)) {
            tell(format_args!("{text}"));
        }
        if code.is_none()
            && order != CycleOrder::Stands
            && let Some(waiting) = controller.standstill()
            && !between
                .as_mut()
                .is_some_and(|between| between.nothing_can_change(controller, &listed(&waiting).join("; ")))
        {
            code = Some(EXIT_MAX_TIME);
            say_standstill(controller, sources, &waiting);
            controller.stop();
        }
        if code.is_none() && between.is_none() && recording.is_none() {
            controller.skip_quiet_cycles(last);
        }
    }
    controller.close_robots();
    controller.settle_state();
    say(controller, sources, recording.as_ref());
    let lost = recording.iter().map(|recording| recording.run_ended(controller)).sum::<u64>();
    lost_events_warning(lost).iter().for_each(|text| warn(text));
    between.into_iter().for_each(|mut between| between.run_ended(controller));
    match (code, controller.outcome()) {
        (Some(code), _) => code,
        (None, Some(Outcome::Alarm(_))) => EXIT_ALARM,
        (None, _) => EXIT_ENDED,
    }
}

/// The message of a run that has reached its time limit, in s.
pub(super) fn time_is_over(controller: &Controller, limit: f64) -> String {
    let place = match controller.place() {
        // Code that only calculates sets no line.
        (file, 0) => format!("is calculating in {}", file.name()),
        (file, line) => format!("is at {}:{line}", file.name()),
    };
    format!("the time limit of {limit} s has passed; the program {place}")
}

/// The reason why there is no controller, and the exit code for it.
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
    result_file::expect_apart(&options.results(), &options.inputs()).map_err(SetupFailure::usage)?;
    let mut builder =
        Controller::builder().mode(options.mode).speed_override(options.speed_override).stack(PROGRAM_STACK_BYTES);
    if let Some(robot) = &options.robot {
        builder = builder.robot(Robot::load_with(robot, &options.changes).map_err(SetupFailure::usage)?);
    }
    let mut names = Names::default();
    if let Some(cell) = &options.cell {
        let cell = Cell::load_with(cell, &options.changes).map_err(SetupFailure::usage)?;
        names = cell.names.clone();
        builder = builder.cell_with(cell, others)?;
        builder = channel_traces::trace(builder, &options)?;
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
        builder = builder.trace(results::file(trace).map_err(SetupFailure::usage)?);
    }
    if options.trace_columns.file {
        builder = builder.trace_files();
    }
    if options.report.is_some() {
        builder = builder.record_motions();
    }
    if let Some(seed) = options.seed {
        builder = builder.seed(seed);
    }
    // On the real clock the run starts at the real date.
    let start = options.start_time.or_else(|| (options.clock == Some(ClockKind::Real)).then(time::of_the_world));
    if let Some(start) = start {
        builder = builder.start_date(start);
    }
    let state_dir = options.state_dir.unwrap_or_else(|| Path::new(&options.script_dir).join(STATE_DIR));
    builder = builder.script_dir(options.script_dir).storage(Directory::new(state_dir));
    Ok(match options.clock {
        Some(ClockKind::Real) => builder.clock(RealClock::new()),
        Some(ClockKind::Virtual) => builder.clock(VirtualClock::asked_for()),
        None => builder.clock(VirtualClock::new()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_calculates_much_is_told_about_compiling() {
        assert_eq!(advice_to_compile(MANY_FULL_CYCLES - 1), None);
        assert!(advice_to_compile(MANY_FULL_CYCLES).is_some_and(|advice| advice.contains("--engine native")));
    }
}
