//! What the command understands.

use arl_project::listing::MOST_SHOWN;
use arl_project::options::{Checking, EngineChoice, Mode, RunOptions, clearance};
use arl_terminal::answer::Format;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::ffi::OsString;
use std::path::PathBuf;

/// Robot programs in ARL: checked, run on simulated and real robots, turned into Rust.
#[derive(Parser, Debug)]
#[command(name = "arl2rs", version, max_term_width = 100)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand, Debug)]
pub(crate) enum Command {
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
        /// Show at most this many errors and warnings, errors first; 0 shows all. JSON always has all.
        #[arg(long, value_name = "N", default_value_t = MOST_SHOWN)]
        max_errors: usize,
        /// Run correct programs on the virtual clock, with the scenario of their arl.toml, and find what their
        /// robots run into.
        #[arg(long, conflicts_with = "background")]
        collisions: bool,
        /// With --collisions: also report what comes closer to each other than this many mm.
        #[arg(long, value_name = "MM", value_parser = clearance, allow_negative_numbers = true, requires = "collisions")]
        clearance: Option<f64>,
        #[command(flatten)]
        checking: Checking,
    },
    /// Show the Rust code that a program is translated to.
    Emit {
        /// The file that has `main`.
        file: PathBuf,
        /// Write NAME.rs into this folder instead of to standard output.
        #[arg(short, value_name = "DIR")]
        out: Option<PathBuf>,
        #[command(flatten)]
        checking: Checking,
    },
    /// Compile a program into one of its own, with rustc.
    Build {
        /// The file that has `main`.
        file: PathBuf,
        /// Where to put the program; if absent, in the working directory, named after the file without `.arl`.
        #[arg(short, value_name = "PROGRAM")]
        out: Option<PathBuf>,
        /// Compile longer for a faster program.
        #[arg(long)]
        release: bool,
        /// Make a library for other programs, with the C interface of `arl.h`.
        #[arg(long)]
        library: bool,
        #[command(flatten)]
        checking: Checking,
    },
    /// Run a program on a simulated robot.
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
    /// Shows a recording, or a program that runs in real time, with the pendant's buttons in the page. The first line
    /// of standard output is the address of the page.
    View {
        /// A program, or a recording that `arl2rs run --record` made, or two recordings to be compared.
        #[arg(required = true, num_args = 1..=2, value_name = "FILE.arl|RUN.mcap")]
        files: Vec<PathBuf>,
        #[command(flatten)]
        options: ViewOptions,
    },
    /// Show what differs between two runs, line by line. The exit code is 1 if anything does.
    Compare {
        /// A recording, or a report of `arl2rs run --report=FILE --format json`.
        #[arg(value_name = "A")]
        one: PathBuf,
        /// The recording or report to compare it with.
        #[arg(value_name = "B")]
        other: PathBuf,
        /// How to show it.
        #[arg(long, value_enum, default_value_t = Format::Human)]
        format: Format,
    },
    /// Run a program once for each row of a table of parameters, on all cores.
    ///
    /// A JSON object for each run goes to standard output, in the order of the table. Results that are known from an
    /// earlier sweep are reused.
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
    /// Remove what is kept of programs: code, compiled programs and runtimes. It is made again when it is needed.
    ///
    /// They are in `~/.cache/arl2rs`, `~/Library/Caches/arl2rs` or `%LOCALAPPDATA%\arl2rs`, or in the folder that the
    /// variable ARL2RS_CACHE names. ARL2RS_CACHE_LIMIT is how many gigabytes they may take (4, or `none`): beyond that,
    /// those unused for longest are removed.
    Clean {
        /// Remove only what has not been used for this many days.
        #[arg(long, value_name = "DAYS")]
        older: Option<u32>,
    },
    /// Explain a diagnostic or an alarm: `arl2rs explain ARL0203`, `arl2rs explain 20003`.
    Explain {
        /// The code of the diagnostic, or the number of the alarm.
        code: String,
    },
    /// Show the reference page of a statement, type, operator, rule or built-in. Without a name: list all pages.
    Doc {
        /// Its name: `while`, `string`, `<<`, `blending`, `movej`, `$PI`.
        name: Option<String>,
        /// List the pages that contain all of these words.
        #[arg(long, value_name = "WORDS", num_args = 1.., conflicts_with = "name")]
        search: Vec<String>,
    },
    /// Format programs: indentation, spacing and spelling. Lines with mistakes stay as they are.
    Fmt {
        /// Programs, and folders with programs; `-` reads standard input and writes standard output.
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// Write nothing; print the names of the files that would change, and fail if there are any.
        #[arg(long)]
        check: bool,
    },
    /// Run the code of a program, with the options of a compiled one.
    #[command(hide = true)]
    Engine {
        /// The file with the code.
        bundle: PathBuf,
        /// The options.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        words: Vec<OsString>,
    },
    /// Serve an editor: the language server protocol on standard input and output.
    Lsp,
    /// Debug a program for an editor: the debug adapter protocol on standard input and output.
    Dap,
    /// List the built-in robots, print the robot file of one, or make a robot file from a URDF.
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
pub(crate) struct ViewOptions {
    /// The port on this computer; 0 takes a free one.
    #[arg(long, value_name = "P", default_value_t = 0)]
    pub port: u16,
    /// Do not open the browser.
    #[arg(long)]
    pub no_open: bool,
    /// Let the page write points of a program into its data files.
    #[arg(long)]
    pub teach: bool,
    /// The robot of a program: a built-in name or a robot file.
    #[arg(long, value_name = "NAME|FILE")]
    pub robot: Option<String>,
    /// The cell of a program.
    #[arg(long, value_name = "FILE")]
    pub cell: Option<PathBuf>,
    /// A scenario: what happens at the inputs of a program; `none`: no scenario, whatever arl.toml says.
    #[arg(long, value_name = "FILE|none")]
    pub io: Option<PathBuf>,
    /// The folder that the program's files are in; the program's folder if absent.
    #[arg(long, value_name = "DIR")]
    pub script_dir: Option<PathBuf>,
    /// The folder that keeps state between runs.
    #[arg(long, value_name = "DIR")]
    pub state_dir: Option<PathBuf>,
    /// The mode of operation of a program.
    #[arg(long, value_enum)]
    pub mode: Option<Mode>,
    /// How the program is run: at once from its code, or compiled with rustc.
    #[arg(long, value_enum)]
    pub engine: Option<EngineChoice>,
}

impl ViewOptions {
    /// Whether there are options that apply to programs only.
    pub(crate) fn is_of_program(&self) -> bool {
        let paths = [&self.cell, &self.io, &self.script_dir, &self.state_dir];
        self.teach
            || self.robot.is_some()
            || self.mode.is_some()
            || self.engine.is_some()
            || paths.iter().any(|path| path.is_some())
    }

    /// The options of a program that is shown.
    pub(crate) fn run(&self) -> RunOptions {
        let Self { robot, cell, io, script_dir, state_dir, mode, engine, .. } = self.clone();
        RunOptions { robot, cell, io, script_dir, state_dir, mode, engine, ..RunOptions::default() }
    }
}

/// Options of a sweep.
#[derive(Args, Clone, Default, Debug)]
pub(crate) struct SweepOptions {
    /// Also write the results to a Parquet file.
    #[arg(short, value_name = "FILE.parquet")]
    pub out: Option<PathBuf>,
    /// How many processes; one for each core if absent.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..))]
    pub jobs: Option<u8>,
    /// Make only the I-th of N parts of the runs.
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
    /// Make all runs, even those whose results are known, and keep no results.
    #[arg(long)]
    pub no_cache: bool,
}

/// Options of a test run.
#[derive(Args, Clone, Default, Debug)]
pub(crate) struct TestOptions {
    /// Run only the I-th of N parts of the cases.
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
    /// How to show the results.
    #[arg(long, value_enum, default_value_t)]
    pub format: TestFormat,
    /// Write the actual results into the files with the expected ones where they differ.
    #[arg(long)]
    pub bless: bool,
    /// Write which lines of the programs ran, and how often, as lcov.
    #[arg(long, value_name = "FILE")]
    pub coverage: Option<PathBuf>,
    /// Emit the forms for large programs wherever they are possible, also in small ones.
    #[arg(long, hide = true)]
    pub all_forms: bool,
    /// Run programs as for a debugger.
    #[arg(long, hide = true)]
    pub debug: bool,
    /// Keep what each run leaves in this folder, with its trace.
    #[arg(long, hide = true, value_name = "DIR")]
    pub keep: Option<PathBuf>,
    /// How the programs are run: at once from their code, or compiled with rustc.
    #[arg(long, value_enum)]
    pub engine: Option<EngineChoice>,
}

impl TestOptions {
    /// Whether the statements of programs are counted or can be halted at.
    pub(crate) fn is_watched(&self) -> bool {
        self.debug || self.coverage.is_some()
    }
}

/// How test results are shown.
#[derive(Clone, Copy, PartialEq, Eq, Default, ValueEnum, Debug)]
pub(crate) enum TestFormat {
    /// What failed, with the differences, and how many cases passed and failed.
    #[default]
    Human,
    /// A JSON object for each case.
    Jsonl,
    /// The XML of JUnit.
    Junit,
}

/// A part of the cases: parts are disjoint, and together all.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Shard {
    /// From 0.
    pub index: usize,
    pub count: usize,
}

impl std::str::FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
        match numbers {
            Some((index @ 1.., count)) if index <= count => Ok(Self { index: index - 1, count }),
            _ => Err("expected the number of a part and the number of parts, like 2/4".into()),
        }
    }
}
