//! The controller of a run, by the options of its command line.

use std::path::Path;
use std::sync::OnceLock;

use crate::builtins::time;
use crate::command::channel_traces;
use crate::command::ending::{EXIT_ALARM, EXIT_USAGE};
use crate::command::live::{Recording, Wishes};
use crate::command::options::{ClockKind, Options};
use crate::command::results;
use crate::command::stack::PROGRAM_STACK_BYTES;
use crate::context::program::Other;
use crate::controller::{Builder, Controller, SetupError};
use crate::cycle::clock_source::{RealClock, VirtualClock};
use crate::io::Scenario;
use crate::storage::state::Directory;
use crate::unit::robot_driver::Connect;
use arl_robot::cell::{Cell, Names};
use arl_robot::changes::Part;
use arl_robot::result_file;
use arl_robot::robot::Robot;

/// The default directory for system variables, below the script directory.
const STATE_DIR: &str = ".arl-state";

/// Makes drivers for `--drive`.
static CONNECT: OnceLock<Connect> = OnceLock::new();

/// Sets the function that makes the drivers that a cell file asks for, before `main` runs a program:
/// `arl_drivers::connect`. Without it `--drive` is refused.
pub fn drivers(connect: Connect) {
    let _ = CONNECT.set(connect);
}

/// The reason why there is no controller, and the exit code for it.
pub(super) struct SetupFailure {
    pub(super) code: u8,
    pub(super) text: String,
}

impl SetupFailure {
    pub(super) fn usage(text: impl ToString) -> Self {
        Self { code: EXIT_USAGE, text: text.to_string() }
    }
}

impl From<SetupError> for SetupFailure {
    fn from(error: SetupError) -> Self {
        let code = if matches!(error, SetupError::State(_)) { EXIT_ALARM } else { EXIT_USAGE };
        Self { code, text: error.to_string() }
    }
}

/// A controller with the options of a command line; `others` are the programs that its cell may name.
pub(super) fn set_up(options: Options, others: &[Other]) -> Result<Builder, SetupFailure> {
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
        builder = channel_traces::trace(builder, &options).map_err(SetupFailure::usage)?;
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

/// The connection to a listener at an address.
pub(super) fn connect_to(address: &str, wishes: Wishes) -> Result<Recording, String> {
    Recording::connect(address, wishes).map_err(|error| format!("there is no listener at {address}: {error}"))
}
