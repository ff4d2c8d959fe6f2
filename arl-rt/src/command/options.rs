//! The options of a compiled program's command line.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::builtins::time;
use crate::command::live::{STATE_INTERVAL_S, Wishes};
use crate::controller::trace::More;
use crate::cycle::realtime::Realtime;
use crate::values::Controlmode;
use arl_motion::Override;
use arl_robot::changes::{Changes, Part};

pub(super) const HELP: &str = "\
Runs a robot program on a simulated robot.

Options:
  --robot NAME|FILE     the robot: a built-in name or a robot file
  --cell FILE           the cell: io, home points, control cycle
  --drive               move the robots that the cell has a [driver] for; without it all are
                        simulated
  --clock virtual|real  run as fast as possible (default), or in real time; from the
                        first connection that a program opens, it is real time
  --realtime[=CORE]     --clock real, and what the system can give the cycle: priority,
                        locked memory, a core of its own (the last one)
  --script-dir DIR      the folder of the program's files
  --state-dir DIR       the folder that keeps system variables, and where
                        the programs were, between runs
  --io FILE             a scenario: what happens at the inputs
  --trace FILE.csv      write the motion, one row a cycle
  --trace-columns file  more columns of the trace, after the usual ones: file, the
                        file that the line belongs to
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
  --state-interval S    with --live: how often to report the state (0.05)
  --coverage FILE       write how often each statement ran: for programs that were made
                        for a debugger
  --loop                the loop running mode: a program that ends is reset and begins
                        again, until the time is up or it calls exit
  --cycle-time FILE     write how many controller seconds the run took
  --max-time S          end after S controller seconds, with exit code 4
  --mode MODE           auto (default), manual or manufast
  --override PCT        the speed override in percent, 0 to 100
  --seed N              the seed of rand
  --start-time T        the date at the start: now, or a time like 2000-01-01T00:00:00
  --set PLACE=VALUE     another value for one key: global.NAME, robot.KEYS, cell.KEYS,
                        io.KEYS (io.event.2.at=1.5); can be given more than once
  --help                this text

Exit codes: 0 ended, 2 usage, 3 an alarm of any program, 4 the time was up or
nothing could change any more, 130 interrupted.
";

/// The options of the command line.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Options {
    pub(super) robot: Option<String>,
    pub(super) cell: Option<PathBuf>,
    pub(super) drive: bool,
    pub(super) clock: Option<ClockKind>,
    pub(super) realtime: Option<Realtime>,
    pub(super) live: bool,
    pub(super) paused: bool,
    pub(super) asked: Asked,
    pub(super) repeats: bool,
    pub(super) script_dir: PathBuf,
    pub(super) state_dir: Option<PathBuf>,
    pub(super) io: Option<PathBuf>,
    pub(super) trace: Option<PathBuf>,
    pub(super) trace_columns: More,
    pub(super) listener: Option<String>,
    pub(super) wishes: Wishes,
    pub(super) report: Option<Report>,
    pub(super) cycle_time: Option<PathBuf>,
    pub(super) max_time: Option<f64>,
    pub(super) mode: Controlmode,
    pub(super) speed_override: Override,
    pub(super) seed: Option<u64>,
    pub(super) start_time: Option<i64>,
    pub(super) changes: Changes,
}

impl Options {
    /// The files that the run writes, each with its option.
    pub(super) fn results(&self) -> Vec<(&'static str, &Path)> {
        let report = self.report.as_ref().and_then(Report::file);
        let all = [
            ("--trace", self.trace.as_deref()),
            ("--report", report),
            ("--cycle-time", self.cycle_time.as_deref()),
            ("--coverage", self.asked.coverage.as_deref()),
        ];
        all.into_iter().filter_map(|(option, path)| Some((option, path?))).collect()
    }

    /// The files that the run reads, each with what it is.
    pub(super) fn inputs(&self) -> Vec<(&'static str, &Path)> {
        let robot = self.robot.as_deref().map(Path::new).filter(|robot| robot.is_file());
        let all = [("the cell", self.cell.as_deref()), ("the scenario", self.io.as_deref()), ("the robot", robot)];
        all.into_iter().filter_map(|(what, path)| Some((what, path?))).collect()
    }

    /// The first option given that only a program running on its own supports.
    pub(super) fn needs_a_process(&self) -> Option<&'static str> {
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
pub(super) enum ClockKind {
    Virtual,
    Real,
}

/// Where to report what the motions did.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Report {
    /// As a table on the standard error.
    Table,
    /// As JSON in a file.
    File(PathBuf),
}

impl Report {
    /// Its file.
    fn file(&self) -> Option<&Path> {
        match self {
            Self::Table => None,
            Self::File(file) => Some(file),
        }
    }
}

/// Requests that only programs made for a debugger support.
#[derive(Clone, PartialEq, Default, Debug)]
pub(super) struct Asked {
    pub(super) debug: Option<String>,
    pub(super) coverage: Option<PathBuf>,
}

impl Asked {
    /// The option that makes the request, and the command that makes programs that support it.
    pub(super) fn needs(&self) -> Option<(&'static str, &'static str)> {
        match self {
            Self { debug: Some(_), .. } => Some(("--debug", "arl2rs dap")),
            Self { coverage: Some(_), .. } => Some(("--coverage", "arl2rs test --coverage FILE")),
            _ => None,
        }
    }
}

impl Options {
    /// The default options.
    fn new(script_dir: &str) -> Self {
        Self {
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
            trace_columns: More::default(),
            listener: None,
            wishes: Wishes::default(),
            report: None,
            cycle_time: None,
            max_time: None,
            mode: Controlmode::Auto,
            speed_override: Override::FULL,
            seed: None,
            start_time: None,
            changes: Changes::default(),
        }
    }

    /// Checks that the options fit each other; sets what one of them implies for another.
    fn agree(&mut self) -> Result<(), lexopt::Error> {
        if self.realtime.is_some() {
            if self.clock == Some(ClockKind::Virtual) {
                return Err("--realtime is for --clock real: on the virtual clock cycles do not wait".into());
            }
            self.clock = Some(ClockKind::Real);
        }
        let Options { robot, cell, io, changes, .. } = self;
        let files = [
            (Part::Robot, robot.is_some(), "robot", "file, or a built-in robot,"),
            (Part::Cell, cell.is_some(), "cell", "file"),
            (Part::Io, io.is_some(), "io", "file"),
        ];
        for (part, is_named, option, what) in files {
            if let (false, Some((path, _))) = (is_named, changes.of_part(part).next()) {
                return Err(format!("--set {option}.{path}: name the {what} with --{option}").into());
            }
        }
        Ok(())
    }
}

/// Reads the command line; `None` where help was requested.
pub(super) fn parse(
    arguments: impl IntoIterator<Item = OsString> + 'static,
    script_dir: &str,
) -> Result<Option<Options>, lexopt::Error> {
    use lexopt::prelude::*;
    let mut options = Options::new(script_dir);
    let mut parser = lexopt::Parser::from_args(arguments);
    while let Some(argument) = parser.next()? {
        match argument {
            Long("robot") => options.robot = Some(parser.value()?.string()?),
            Long("cell") => options.cell = Some(parser.value()?.into()),
            Long("drive") => options.drive = true,
            Long("live") => (options.live, options.clock) = (true, Some(ClockKind::Real)),
            Long("paused") => options.paused = true,
            Long("debug") => options.asked.debug = Some(parser.value()?.string()?),
            Long("coverage") => options.asked.coverage = Some(parser.value()?.into()),
            Long("clock") => {
                let paces = [("virtual", ClockKind::Virtual), ("real", ClockKind::Real)];
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
            Long("trace-columns") => {
                let text = parser.value()?.string()?;
                options.trace_columns = More::parse(&text).map_err(|why| format!("--trace-columns {text}: {why}"))?;
            }
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
            Long("override") => {
                let percent = number(&mut parser, "--override", "percent", 100.0)?;
                options.speed_override = Override::from_percent(percent).map_err(|error| error.to_string())?;
            }
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
    options.agree()?;
    Ok(Some(options))
}

/// Reads one of a few words.
fn word<T: Copy>(parser: &mut lexopt::Parser, option: &str, words: &[(&str, T)]) -> Result<T, lexopt::Error> {
    use lexopt::ValueExt;
    let found = parser.value()?.string()?;
    let known = words.iter().find(|(word, _)| word.eq_ignore_ascii_case(&found));
    known.map(|(_, value)| *value).ok_or_else(|| {
        let words: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
        format!("{option} {found}: expected {}", words.join(" or ")).into()
    })
}

/// Reads a number from 0 up.
fn number(parser: &mut lexopt::Parser, option: &str, what: &str, most: f64) -> Result<f64, lexopt::Error> {
    use lexopt::ValueExt;
    let found = parser.value()?.string()?;
    match found.parse::<f64>() {
        Ok(number) if (0.0..=most).contains(&number) => Ok(number),
        _ if most < f64::MAX => Err(format!("{option} {found}: expected {what} from 0 to {most}").into()),
        _ => Err(format!("{option} {found}: expected {what}, 0 or more").into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

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
        assert_eq!(
            (options.clock, options.max_time, options.mode),
            (Some(ClockKind::Real), Some(2.5), Controlmode::Manual)
        );
        assert_eq!(options.script_dir, Path::new("scripts"));
        assert!(parsed(&["--trace-columns=file"]).unwrap().unwrap().trace_columns.file);
        let realtime = parsed(&["--realtime=1"]).unwrap().unwrap();
        assert_eq!((realtime.clock, realtime.realtime), (Some(ClockKind::Real), Some(Realtime::new().core(1))));
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
            (&["--trace-columns", "do.1"], "`do.1` is not a column: expected file"),
            (&["--speed"], "--speed"),
            (&["--seed"], "--seed"),
            (&["file"], "file"),
        ] {
            let error = parsed(arguments).unwrap_err();
            assert!(error.contains(words), "{error}");
        }
    }
}
