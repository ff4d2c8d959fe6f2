//! The command line of a compiled program.

use std::ffi::OsString;
use std::io::{IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;
use std::time::SystemTime;

use crate::command::between::{Between, CycleOrder};
pub use crate::command::channel_traces::numbered as numbered_trace;
use crate::command::coverage;
use crate::command::debug;
use crate::command::ending::{EXIT_ALARM, EXIT_INTERRUPTED, EXIT_PANICKED, EXIT_USAGE, Ending};
use crate::command::interrupts::Interrupted;
use crate::command::live::{self, LineWriter, Recording};
use crate::command::options::{Asked, ClockKind, HELP, Options, parse};
use crate::command::polling::Polling;
use crate::command::results;
use crate::command::say::{self, say, say_condition, warn};
use crate::command::serve;
pub use crate::command::set_up::drivers;
use crate::command::set_up::{SetupFailure, connect_to, set_up};
use crate::command::stack::Stack;
use crate::command::words::{lateness, listed, lost_events_warning, time_is_over};
use crate::context::output::Stream;
use crate::context::program::Program;
pub use crate::context::program::{Make, Other};
use crate::context::standard_error::tell;
use crate::context::standstill::Standstill;
use crate::controller::Controller;
use crate::cycle::realtime::Realtime;

/// A variable of the environment: with it the process ends when its standard input is closed, so that it does not
/// outlive who started it.
const WHILE_INPUT: &str = "ARL2RS_WHILE_INPUT";

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
            return Ending::Ended.code();
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
    ran.unwrap_or_else(|SetupFailure { code, text }| fail(code, &text))
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
    let ending = match writer {
        Some(writer) => {
            if paused {
                controller.wait_for_start();
            }
            let inside = watching.map(|watching| watching.inside);
            live::drive(&mut controller, &writer, inside, wishes, max_time, interrupted)
        }
        None => {
            // Advice is for who looks on, not for scripts.
            let advises = watching.is_some() && between.is_none() && std::io::stderr().is_terminal();
            let ending = watch(&mut controller, max_time, interrupted, between, recording, sources);
            if advises && let Some(advice) = advice_to_compile(controller.full_cycles()) {
                tell(format_args!("{advice}"));
            }
            ending
        }
    };
    results::write_figures(&controller, report, cycle_time.as_deref());
    if tells_lateness {
        lateness(&controller).iter().for_each(|text| warn(text));
    }
    Ok(ending.code())
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

/// Steps until the run is over, its time is up, or Ctrl-C was pressed.
fn watch(
    controller: &mut Controller,
    max_time: Option<f64>,
    interrupted: &Interrupted,
    mut between: Option<Box<dyn Between>>,
    recording: Option<Recording>,
    sources: &Path,
) -> Ending {
    recording.iter().for_each(|recording| recording.begin(controller));
    let last = max_time.map_or(u64::MAX, |seconds| controller.cycles(seconds));
    let mut cut = None;
    // A listener or debugger already sees where the program is.
    let mut polling = (between.is_none() && recording.is_none()).then(Polling::new);
    // A run that was stopped does not begin again.
    let is_over = |controller: &Controller, stopped: bool| match stopped {
        true => controller.outcome().is_some(),
        false => controller.is_over(),
    };
    while !is_over(controller, cut.is_some()) {
        let order = between.as_mut().map_or(CycleOrder::Runs, |between| between.cycle_begins(controller));
        let is_alone = recording.as_ref().is_some_and(Recording::is_gone);
        if cut.is_none() && (interrupted.is_set() || is_alone || order == CycleOrder::Ends) {
            cut = Some(Ending::Stopped);
            controller.stop();
            tell(format_args!("interrupted: the robot stops on its path"));
        } else if cut.is_none() && controller.cycle() >= last {
            cut = Some(Ending::TimeOver);
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
        if cut.is_none()
            && order != CycleOrder::Stands
            && let Some(waiting) = controller.standstill()
            && !between
                .as_mut()
                .is_some_and(|between| between.nothing_can_change(controller, &listed(&waiting).join("; ")))
        {
            cut = Some(Ending::Stuck);
            say_standstill(controller, sources, &waiting);
            controller.stop();
        }
        if cut.is_none() && between.is_none() && recording.is_none() {
            controller.skip_quiet_cycles(last);
        }
    }
    controller.close_robots();
    controller.settle_state();
    say(controller, sources, recording.as_ref());
    let lost = recording.iter().map(|recording| recording.run_ended(controller)).sum::<u64>();
    lost_events_warning(lost).iter().for_each(|text| warn(text));
    between.into_iter().for_each(|mut between| between.run_ended(controller));
    Ending::of(cut, controller.outcome())
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
