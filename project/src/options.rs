//! Options for checking and running programs, given on the command line and in `arl.toml`.

use arl_robot::changes::Changes;
use arl_terminal::answer::ReportFormat;
use arl_terminal::failure::Failure;
use clap::{Args, ValueEnum};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Options of the compiler.
#[derive(Args, Clone, Default, PartialEq, Debug)]
pub struct Checking {
    /// Also warn where arl2rs accepts what the controller would not.
    #[arg(long)]
    pub strict: bool,
    /// The robot that the program is for: a built-in name or a robot file.
    #[arg(long, value_name = "NAME|FILE")]
    pub robot: Option<String>,
    /// The program is for a background channel: it has no robot.
    #[arg(long)]
    pub background: bool,
    /// The cell that the program is for: channels, lines and bytes that its file does not have are errors.
    #[arg(long, value_name = "FILE")]
    pub cell: Option<PathBuf>,
    /// The folder that `/home/ae/script/` in an import means; the program's folder if absent.
    #[arg(long, value_name = "DIR")]
    pub script_dir: Option<PathBuf>,
    /// Show what came from the command line and what from an `arl.toml` beside the program or above it.
    #[arg(long)]
    pub verbose: bool,
}

/// Options of a running program. They are handed on to it, but for the plot, which is made from its trace.
#[derive(Args, Clone, Default, Debug)]
pub struct RunOptions {
    /// The robot: a built-in name or a robot file.
    #[arg(long, value_name = "NAME|FILE")]
    pub robot: Option<String>,
    /// The cell: io, buses, home points.
    #[arg(long, value_name = "FILE")]
    pub cell: Option<PathBuf>,
    /// Move the robots that the cell has a `[driver]` for. Without this all robots are simulated, whatever the cell
    /// says.
    #[arg(long)]
    pub drive: bool,
    /// Run as fast as possible, or in real time.
    #[arg(long, value_enum)]
    pub clock: Option<Clock>,
    /// Run in real time, with what the system gives the control cycle: the highest priority, its memory locked, a core
    /// of its own (the last one, or CORE). What the system does not allow is reported.
    #[arg(long, value_name = "CORE", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    pub realtime: Option<String>,
    /// The folder that the program's files are in; the program's folder if absent.
    #[arg(long, value_name = "DIR")]
    pub script_dir: Option<PathBuf>,
    /// The folder that keeps state between runs.
    #[arg(long, value_name = "DIR")]
    pub state_dir: Option<PathBuf>,
    /// A scenario: what happens at the inputs.
    #[arg(long, value_name = "FILE")]
    pub io: Option<PathBuf>,
    /// Write the motion, one row a cycle.
    #[arg(long, value_name = "FILE.csv")]
    pub trace: Option<PathBuf>,
    /// Columns of the trace after those that it always has, separated by commas: `file`, the file that the line is in.
    #[arg(long, value_name = "COLUMN", requires = "trace")]
    pub trace_columns: Option<String>,
    /// Record the run for viewers of robot data (Foxglove, Lichtblick, Rerun): frames, joints, io, program and motion
    /// pointer, messages, alarms, what each motion did. A description of the robots is written beside it: cell.urdf.
    #[arg(long, value_name = "FILE.mcap")]
    pub record: Option<PathBuf>,
    /// Look for collisions, and also warn where robots, bodies of the cell and what is carried come closer to each
    /// other than this many mm. Without this option collisions are looked for if the cell has bodies.
    #[arg(long, value_name = "MM", value_parser = clearance, allow_negative_numbers = true)]
    pub clearance: Option<f64>,
    /// Say at the end what each line's motions did: speeds, times, blends, the closest limit. With =FILE: each motion
    /// as a JSON object on a line of the file.
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true, default_missing_value = "-")]
    pub report: Option<PathBuf>,
    /// The report of the whole run in another form: cycle time by line, moving and waiting, signals, contacts. Without
    /// --report=FILE it goes to standard error.
    #[arg(long, value_enum, requires = "report")]
    pub format: Option<ReportFormat>,
    /// Draw the motion afterwards: the path of the TCP, its speed, the axes' speeds.
    #[arg(long, value_name = "FILE.svg")]
    pub plot: Option<PathBuf>,
    /// Show a live screen with the program, the robot and io, and keys for start, pause, step, reset, override and
    /// inputs. The program runs in real time. If standard output is not a terminal, this option has no effect.
    #[arg(long, conflicts_with_all = ["plot", "clock"])]
    pub pendant: bool,
    /// The loop running mode: a program that ends is reset and begins again.
    #[arg(long = "loop")]
    pub repeats: bool,
    /// End after this many controller seconds, with exit code 4.
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub max_time: Option<f64>,
    /// The mode of operation.
    #[arg(long, value_enum)]
    pub mode: Option<Mode>,
    /// The override in percent.
    #[arg(long = "override", value_name = "PCT", value_parser = percent, allow_negative_numbers = true)]
    pub override_percent: Option<f64>,
    /// The seed of `rand` on the virtual clock.
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// The date at the start on the virtual clock: `now`, or a time like 2000-01-01T00:00:00.
    #[arg(long, value_name = "T")]
    pub start_time: Option<String>,
    /// Change one value for this run: `global.pitch=80`, `robot.axis.1.vel=90`, `io.event.2.at=1.5`,
    /// `cell.KEYS=VALUE`. Entries of lists count from 1. Can be given several times.
    #[arg(long = "set", value_name = "PLACE=VALUE")]
    pub changes: Vec<String>,
    /// How the program is run: at once from its code, or compiled with rustc. Without this option at once, unless the
    /// compiled program is there and up to date.
    #[arg(long, value_enum)]
    pub engine: Option<EngineChoice>,
    /// Show what came from the command line and what from an `arl.toml` beside the program or above it.
    #[arg(long)]
    pub verbose: bool,
}

/// How programs are run.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum, Deserialize, Debug)]
#[serde(rename_all = "kebab-case")]
pub enum EngineChoice {
    /// At once, from their code.
    Engine,
    /// Compiled with rustc.
    Native,
}

impl EngineChoice {
    /// Its name on the command line and in `arl.toml`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Engine => "engine",
            Self::Native => "native",
        }
    }
}

/// A distance in mm.
///
/// # Errors
/// It is not a number, negative or not finite.
pub fn clearance(text: &str) -> Result<f64, String> {
    within(text, f64::MAX).ok_or_else(|| "expected a distance in mm, 0 or more".into())
}

/// A time in s.
fn seconds(text: &str) -> Result<f64, String> {
    within(text, f64::MAX).ok_or_else(|| "expected a time in s, 0 or more".into())
}

/// A percentage.
fn percent(text: &str) -> Result<f64, String> {
    within(text, 100.0).ok_or_else(|| "expected a number of percent, 0 to 100".into())
}

/// A number from 0 to `most`.
fn within(text: &str, most: f64) -> Option<f64> {
    text.parse::<f64>().ok().filter(|number| (0.0..=most).contains(number))
}

/// What time is made of.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum, Debug)]
pub enum Clock {
    /// As fast as possible, with the same result on every run.
    Virtual,
    /// In real time.
    Real,
}

/// The modes of operation.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum, Debug)]
pub enum Mode {
    /// Automatic.
    Auto,
    /// Manual at low speed.
    Manual,
    /// Manual at high speed.
    Manufast,
}

impl RunOptions {
    /// The options as arguments of the program.
    pub fn arguments(&self) -> Vec<std::ffi::OsString> {
        let word = |value: Option<clap::builder::PossibleValue>| value.map(|value| value.get_name().into());
        let path = |path: &Option<PathBuf>| path.clone().map(PathBuf::into_os_string);
        let number = |number: Option<String>| number.map(Into::into);
        let all: [(&str, Option<std::ffi::OsString>); 13] = [
            ("--robot", self.robot.clone().map(Into::into)),
            ("--cell", path(&self.cell)),
            ("--clock", word(self.clock.and_then(|clock| clock.to_possible_value()))),
            ("--script-dir", path(&self.script_dir)),
            ("--state-dir", path(&self.state_dir)),
            ("--io", path(&self.io)),
            ("--trace", path(&self.trace)),
            ("--trace-columns", self.trace_columns.clone().map(Into::into)),
            ("--max-time", number(self.max_time.map(|time| time.to_string()))),
            ("--mode", word(self.mode.and_then(|mode| mode.to_possible_value()))),
            ("--override", number(self.override_percent.map(|percent| percent.to_string()))),
            ("--seed", number(self.seed.map(|seed| seed.to_string()))),
            ("--start-time", self.start_time.clone().map(Into::into)),
        ];
        let mut arguments: Vec<std::ffi::OsString> =
            all.into_iter().filter_map(|(name, value)| value.map(|value| [name.into(), value])).flatten().collect();
        arguments.extend(self.changes.iter().flat_map(|change| ["--set".into(), change.into()]));
        if self.repeats {
            arguments.push("--loop".into());
        }
        if self.drive {
            arguments.push("--drive".into());
        }
        arguments.extend(self.realtime.as_deref().map(|core| match core {
            "" => "--realtime".into(),
            core => format!("--realtime={core}").into(),
        }));
        // Other forms of the report are made from the program's output.
        if let (Some(file), None | Some(ReportFormat::Human)) = (&self.report, self.format) {
            let mut report = std::ffi::OsString::from("--report");
            if file.as_os_str() != "-" {
                report.push("=");
                report.push(file);
            }
            arguments.push(report);
        }
        arguments
    }

    /// The files that a run writes, each with its option.
    pub fn results(&self) -> Vec<(&'static str, &Path)> {
        let report = self.report.as_deref().filter(|file| *file != Path::new("-"));
        let all = [
            ("--trace", self.trace.as_deref()),
            ("--plot", self.plot.as_deref()),
            ("--record", self.record.as_deref()),
            ("--report", report),
        ];
        all.into_iter().filter_map(|(option, path)| Some((option, path?))).collect()
    }

    /// The files that a run reads beside its program, each with what it is.
    pub fn inputs(&self) -> Vec<(&'static str, &Path)> {
        let robot = self.robot.as_deref().map(Path::new).filter(|robot| robot.is_file());
        let all = [("the cell", self.cell.as_deref()), ("the scenario", self.io.as_deref()), ("the robot", robot)];
        all.into_iter().filter_map(|(what, path)| Some((what, path?))).collect()
    }

    /// The changes given by `--set`.
    ///
    /// # Errors
    /// One of the arguments is not a valid change.
    pub fn changed(&self) -> Result<Changes, Failure> {
        Changes::of(&self.changes).map_err(Failure::Usage)
    }

    /// The part that the compiler needs.
    pub fn checking(&self) -> Checking {
        Checking {
            strict: false,
            background: false,
            robot: self.robot.clone(),
            cell: None,
            script_dir: self.script_dir.clone(),
            verbose: false,
        }
    }
}
