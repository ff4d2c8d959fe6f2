//! What the command understands.

use super::failure::Failure;
use super::show::MOST_SHOWN;
use arl_robot::changes::Changes;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Robot programs in ARL: checked, turned into Rust, compiled and run.
#[derive(Parser, Debug)]
#[command(name = "arl2rs", version, max_term_width = 100)]
pub(super) struct Cli {
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Subcommand, Debug)]
pub(super) enum Command {
    /// Make a folder with a program that runs, its points, a cell, a scenario and a test.
    New {
        /// The folder; its name is that of the program.
        #[arg(value_name = "NAME")]
        folder: PathBuf,
    },
    /// Find the mistakes in programs without running them.
    Check {
        /// Programs, and modules and data files that belong to them.
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// How to show what was found.
        #[arg(long, value_enum, default_value_t = Format::Human)]
        format: Format,
        /// Show people at most so many errors and warnings, errors first; 0 for all. JSON always has all.
        #[arg(long, value_name = "N", default_value_t = MOST_SHOWN)]
        max_errors: usize,
        /// Run programs without mistakes on the virtual clock, with the scenario of their arl.toml, and find what their robots run into.
        #[arg(long, conflicts_with = "background")]
        collisions: bool,
        /// With --collisions: also what comes nearer to each other than so many mm.
        #[arg(long, value_name = "MM", value_parser = clearance, requires = "collisions")]
        clearance: Option<f64>,
        #[command(flatten)]
        checking: Checking,
    },
    /// Show the Rust that a program becomes.
    Emit {
        /// The file that has `main`.
        file: PathBuf,
        /// Write NAME.rs into this folder instead of to standard output.
        #[arg(short, value_name = "DIR")]
        out: Option<PathBuf>,
        #[command(flatten)]
        checking: Checking,
    },
    /// Make a native program.
    Build {
        /// The file that has `main`.
        file: PathBuf,
        /// Where to put the program; the file's name without `.arl`, in the working directory, if absent.
        #[arg(short, value_name = "PROGRAM")]
        out: Option<PathBuf>,
        /// Compile longer for a faster program.
        #[arg(long)]
        release: bool,
        /// Make a library for other programs, behind the C interface of `arl.h`.
        #[arg(long)]
        library: bool,
        #[command(flatten)]
        checking: Checking,
    },
    /// Compile a program where needed and run it on a simulated robot.
    Run {
        /// The file that has `main`.
        file: PathBuf,
        #[command(flatten)]
        options: Box<RunOptions>,
    },
    /// Draw a trace that a run wrote.
    Plot {
        /// The trace.
        #[arg(value_name = "TRACE.csv")]
        trace: PathBuf,
        /// The picture.
        #[arg(value_name = "FILE.svg")]
        plot: PathBuf,
        /// The robot that ran: a built-in name or a robot file.
        #[arg(long, value_name = "NAME|FILE")]
        robot: Option<String>,
    },
    /// Show a run in the browser: robot, path, program and signals on one time line.
    ///
    /// Of a recording, or of a program that runs in real time, with the pendant's buttons in the page. The first line of the standard output
    /// is the address of the page.
    View {
        /// A program, or a recording that `arl2rs run --record` made, or two recordings to be compared.
        #[arg(required = true, num_args = 1..=2, value_name = "FILE.arl|RUN.mcap")]
        files: Vec<PathBuf>,
        #[command(flatten)]
        options: ViewOptions,
    },
    /// Tell what differs between two runs, line by line. The exit code is 1 where anything does.
    Compare {
        /// A recording, or a report of `arl2rs run --report=FILE --format json`.
        #[arg(value_name = "A")]
        one: PathBuf,
        /// The one that it is compared with.
        #[arg(value_name = "B")]
        other: PathBuf,
        /// How to tell it.
        #[arg(long, value_enum, default_value_t = Format::Human)]
        format: Format,
    },
    /// Run a program once for each row of a table of parameters, on all cores.
    ///
    /// A JSON object for each run comes on the standard output, in the order of the table. What is known from an earlier sweep does not run again.
    Sweep {
        /// The program and the table.
        #[arg(value_name = "S.toml")]
        file: PathBuf,
        #[command(flatten)]
        options: SweepOptions,
    },
    /// Run the cases in folders: every NAME.arl with a sidecar that says what is expected (.out, .err, .alarm).
    Test {
        /// Folders with cases, searched with their subfolders.
        #[arg(required = true, value_name = "DIR")]
        dirs: Vec<PathBuf>,
        #[command(flatten)]
        options: TestOptions,
    },
    /// Remove compiled programs and runtimes; they are compiled again when they are needed.
    ///
    /// They are in `~/.cache/arl2rs`, `~/Library/Caches/arl2rs` or `%LOCALAPPDATA%\arl2rs`, or in the folder that the variable
    /// ARL2RS_CACHE names. ARL2RS_CACHE_LIMIT is how many gigabytes they may take (4, or `none`): beyond that, what was not used
    /// for longest goes.
    Clean {
        /// Only what was not used for so many days.
        #[arg(long, value_name = "DAYS")]
        older: Option<u32>,
    },
    /// Explain a diagnostic or an alarm: `arl2rs explain ARL0203`, `arl2rs explain 20003`.
    Explain {
        /// The code of the diagnostic, or the number of the alarm.
        code: String,
    },
    /// Show the reference of a statement, type, operator, rule, or of anything built in. Without a name: what there is.
    Doc {
        /// Its name: `while`, `string`, `<<`, `blending`, `movej`, `$PI`.
        name: Option<String>,
        /// List the pages in which all of these words stand.
        #[arg(long, value_name = "WORDS", num_args = 1.., conflicts_with = "name")]
        search: Vec<String>,
    },
    /// Lay programs out: one way to indent, to space and to spell. Lines with mistakes stay as they are.
    Fmt {
        /// Programs, and folders with programs; `-` reads standard input and writes standard output.
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// Write nothing; print the names of the files that would change, and fail where there are any.
        #[arg(long)]
        check: bool,
    },
    /// Serve an editor: the language server protocol on standard input and output.
    Lsp,
    /// Debug a program for an editor: the debug adapter protocol on standard input and output.
    Dap,
    /// List the robots that are built in, print the file of one, or make a file of a URDF.
    Robots {
        /// The robot to print.
        name: Option<String>,
        /// Print a robot file for the robot of a URDF file: six axes with a spherical wrist, or a SCARA.
        #[arg(long, value_name = "FILE.urdf", conflicts_with = "name")]
        import: Option<PathBuf>,
    },
}

/// Options of the view.
#[derive(Args, Clone, Default, Debug)]
pub(super) struct ViewOptions {
    /// The port on this computer; a free one where there is none.
    #[arg(long, value_name = "P", default_value_t = 0)]
    pub(super) port: u16,
    /// Do not open the browser.
    #[arg(long)]
    pub(super) no_open: bool,
    /// Let the page write points of a program into its data files.
    #[arg(long)]
    pub(super) teach: bool,
    /// The robot of a program: a built-in name or a robot file.
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) robot: Option<String>,
    /// The cell of a program.
    #[arg(long, value_name = "FILE")]
    pub(super) cell: Option<PathBuf>,
    /// A scenario: what the outside does to the inputs of a program; `none` for none, whatever arl.toml says.
    #[arg(long, value_name = "FILE|none")]
    pub(super) io: Option<PathBuf>,
    /// The folder that the program's files are in; the program's folder if absent.
    #[arg(long, value_name = "DIR")]
    pub(super) script_dir: Option<PathBuf>,
    /// The folder that keeps state between runs.
    #[arg(long, value_name = "DIR")]
    pub(super) state_dir: Option<PathBuf>,
    /// The mode of operation of a program.
    #[arg(long, value_enum)]
    pub(super) mode: Option<Mode>,
}

impl ViewOptions {
    /// Whether there are options that only programs have.
    pub(super) fn is_of_program(&self) -> bool {
        let paths = [&self.cell, &self.io, &self.script_dir, &self.state_dir];
        self.teach || self.robot.is_some() || self.mode.is_some() || paths.iter().any(|path| path.is_some())
    }

    /// The options of a program that is shown.
    pub(super) fn run(&self) -> RunOptions {
        let Self { robot, cell, io, script_dir, state_dir, mode, .. } = self.clone();
        RunOptions { robot, cell, io, script_dir, state_dir, mode, ..RunOptions::default() }
    }
}

/// Options of a sweep.
#[derive(Args, Clone, Default, Debug)]
pub(super) struct SweepOptions {
    /// Write the results into a Parquet file, too.
    #[arg(short, value_name = "FILE.parquet")]
    pub(super) out: Option<PathBuf>,
    /// How many processes; one for each core if absent.
    #[arg(long, value_name = "N")]
    pub(super) jobs: Option<std::num::NonZeroU8>,
    /// Make the I-th of N parts of the runs only.
    #[arg(long, value_name = "I/N")]
    pub(super) shard: Option<Shard>,
    /// Make all runs, also those whose results are known, and keep none.
    #[arg(long)]
    pub(super) no_cache: bool,
}

/// Options of a test run.
#[derive(Args, Clone, Default, Debug)]
pub(super) struct TestOptions {
    /// Run the I-th of N parts of the cases only.
    #[arg(long, value_name = "I/N")]
    pub(super) shard: Option<Shard>,
    /// How to tell what came out.
    #[arg(long, value_enum, default_value_t)]
    pub(super) format: TestFormat,
    /// Write what came into the files that say what is expected, where it is something else.
    #[arg(long)]
    pub(super) bless: bool,
    /// Write which lines of the programs ran, and how often, as lcov.
    #[arg(long, value_name = "FILE")]
    pub(super) coverage: Option<PathBuf>,
    /// Emit the forms for large programs wherever they are possible, also in small ones.
    #[arg(long, hide = true)]
    pub(super) all_forms: bool,
    /// Emit programs as for a debugger.
    #[arg(long, hide = true)]
    pub(super) debug: bool,
}

/// How tests are told of.
#[derive(Clone, Copy, PartialEq, Eq, Default, ValueEnum, Debug)]
pub(super) enum TestFormat {
    /// What failed, with its difference, and how many there were.
    #[default]
    Human,
    /// A JSON object a case.
    Jsonl,
    /// The XML of JUnit.
    Junit,
}

/// A part of the cases: parts are disjoint, and together all.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Shard {
    /// From 0.
    pub(super) index: usize,
    pub(super) count: usize,
}

impl std::str::FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
        match numbers {
            Some((index @ 1.., count)) if index <= count => Ok(Self { index: index - 1, count }),
            _ => Err("expected the number of a part and how many there are, like 2/4".into()),
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum, Debug)]
pub(super) enum Format {
    /// For people, on standard error.
    Human,
    /// One JSON object a line, on standard output.
    Json,
}

/// Options of the compiler.
#[derive(Args, Clone, Default, PartialEq, Debug)]
pub(super) struct Checking {
    /// Warn also where more is accepted than the controller would take.
    #[arg(long)]
    pub(super) strict: bool,
    /// The robot that the program is for: a built-in name or a robot file.
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) robot: Option<String>,
    /// The program is for a background channel: it has no robot.
    #[arg(long)]
    pub(super) background: bool,
    /// The cell that the program is for: channels, lines and bytes that its file does not have are errors.
    #[arg(long, value_name = "FILE")]
    pub(super) cell: Option<PathBuf>,
    /// The folder that `/home/ae/script/` in an import means; the program's folder if absent.
    #[arg(long, value_name = "DIR")]
    pub(super) script_dir: Option<PathBuf>,
    /// Tell what came from the command line and what from an `arl.toml` beside the program or above it.
    #[arg(long)]
    pub(super) verbose: bool,
}

/// Options of a running program. They are handed on to it, but for the plot, which is made from its trace.
#[derive(Args, Clone, Default, Debug)]
pub(super) struct RunOptions {
    /// The robot: a built-in name or a robot file.
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) robot: Option<String>,
    /// The cell: io, buses, home points.
    #[arg(long, value_name = "FILE")]
    pub(super) cell: Option<PathBuf>,
    /// Move the robots that the cell has a `[driver]` for. Without this all robots are simulated, whatever the cell says.
    #[arg(long)]
    pub(super) drive: bool,
    /// Run as fast as possible, or in real time.
    #[arg(long, value_enum)]
    pub(super) clock: Option<Clock>,
    /// Run in real time, with what the system gives the control cycle: the highest priority, its memory locked, a core of its own (the last
    /// one, or this). What it does not allow is told.
    #[arg(long, value_name = "CORE", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    pub(super) realtime: Option<String>,
    /// The folder that the program's files are in; the program's folder if absent.
    #[arg(long, value_name = "DIR")]
    pub(super) script_dir: Option<PathBuf>,
    /// The folder that keeps state between runs.
    #[arg(long, value_name = "DIR")]
    pub(super) state_dir: Option<PathBuf>,
    /// A scenario: what the outside does to the inputs.
    #[arg(long, value_name = "FILE")]
    pub(super) io: Option<PathBuf>,
    /// Write the motion, one row a cycle.
    #[arg(long, value_name = "FILE.csv")]
    pub(super) trace: Option<PathBuf>,
    /// Columns of the trace behind those that it always has, with commas between: `file`, the file that the line is of.
    #[arg(long, value_name = "COLUMN", requires = "trace")]
    pub(super) trace_columns: Option<String>,
    /// Record the run for viewers of robot data (Foxglove, Lichtblick, Rerun): frames, joints, io, program and motion pointer, messages,
    /// alarms, what each motion did. A description of the robots is written beside it: cell.urdf.
    #[arg(long, value_name = "FILE.mcap")]
    pub(super) record: Option<PathBuf>,
    /// Look for collisions, and warn also where robots, bodies of the cell and what is carried come nearer to each other than so many
    /// mm. Without it they are looked for where the cell has bodies.
    #[arg(long, value_name = "MM", value_parser = clearance)]
    pub(super) clearance: Option<f64>,
    /// Say at the end what each line's motions did: speeds, times, blends, the closest limit. With =FILE: each motion as
    /// a JSON object in a line of the file.
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true, default_missing_value = "-")]
    pub(super) report: Option<PathBuf>,
    /// The report of the whole run in another form: cycle time by line, moving and waiting, signals, contacts. Without --report=FILE it goes
    /// to the standard error.
    #[arg(long, value_enum, requires = "report")]
    pub(super) format: Option<ReportFormat>,
    /// Draw the motion afterwards: the way of the TCP, its speed, the axes' speeds.
    #[arg(long, value_name = "FILE.svg")]
    pub(super) plot: Option<PathBuf>,
    /// Show a live screen with the program, the robot and io, and keys for start, pause, step, reset, override and inputs.
    /// The program runs in real time. Where the standard output is no terminal, it runs as without this option.
    #[arg(long, conflicts_with_all = ["plot", "clock"])]
    pub(super) pendant: bool,
    /// The loop running mode: a program that ends is reset and begins again.
    #[arg(long = "loop")]
    pub(super) repeats: bool,
    /// End after so many controller seconds, with exit code 4.
    #[arg(long, value_name = "S")]
    pub(super) max_time: Option<f64>,
    /// The mode of operation.
    #[arg(long, value_enum)]
    pub(super) mode: Option<Mode>,
    /// The override in percent.
    #[arg(long = "override", value_name = "PCT")]
    pub(super) override_percent: Option<f64>,
    /// The seed of `rand` on the virtual clock.
    #[arg(long, value_name = "N")]
    pub(super) seed: Option<u64>,
    /// The date at the start on the virtual clock: `now`, or a time like 2000-01-01T00:00:00.
    #[arg(long, value_name = "T")]
    pub(super) start_time: Option<String>,
    /// Another value at one place for this run: `global.pitch=80`, `robot.axis.1.vel=90`, `io.event.2.at=1.5`, `cell.KEYS=VALUE`. Entries
    /// of lists count from 1. As often as there are places.
    #[arg(long = "set", value_name = "PLACE=VALUE")]
    pub(super) changes: Vec<String>,
    /// Tell what came from the command line and what from an `arl.toml` beside the program or above it.
    #[arg(long)]
    pub(super) verbose: bool,
}

/// The forms of a report.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum, Debug)]
pub(super) enum ReportFormat {
    /// The table of motions, or with =FILE a JSON object for each of them.
    Human,
    /// One JSON object for the whole run.
    Json,
    /// A page for a browser.
    Html,
}

/// A distance in mm.
fn clearance(text: &str) -> Result<f64, String> {
    let distance = text.parse::<f64>().ok().filter(|distance| distance.is_finite() && *distance >= 0.0);
    distance.ok_or_else(|| "expected a distance in mm, 0 or more".into())
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum, Debug)]
pub(super) enum Clock {
    /// As fast as the machine can, the same on every run.
    Virtual,
    /// In real time.
    Real,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum, Debug)]
pub(super) enum Mode {
    /// Automatic.
    Auto,
    /// Manual at low speed.
    Manual,
    /// Manual at high speed.
    Manufast,
}

impl RunOptions {
    /// The options as the program takes them.
    pub(super) fn arguments(&self) -> Vec<std::ffi::OsString> {
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
        // Another form of the report is made of what the program says.
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

    /// What `--set` changes.
    ///
    /// # Errors
    /// One of the words is no change.
    pub(super) fn changed(&self) -> Result<Changes, Failure> {
        Changes::of(&self.changes).map_err(Failure::Usage)
    }

    /// The part that the compiler needs.
    pub(super) fn checking(&self) -> Checking {
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
