//! What robot programs in ARL run on: the cycle, motion, io, system variables and a simulated robot.
//!
//! The compiler turns an ARL program into an implementation of [`Program`]; a [`Controller`] runs it. Emitted code names
//! everything through the prelude [`emit`].
//!
//! The rooms, from the ground up; each imports only those before it:
//!
//! - `cycle`: the control cycle, its length and its clock, and what it shares with threads beside it
//! - [`fault`]: what goes wrong in a program, and the alarms that it becomes
//! - [`values`]: the values of ARL, and how they are printed and read
//! - `storage`: what outlives a run, and the thread that writes it
//! - [`io`]: the image of inputs and outputs, the driver, and the scenario
//! - [`fieldbus`]: DeviceNet, Modbus and io islands
//! - [`communication`]: sockets and serial lines, with a thread for each
//! - [`motion`]: commands become set-points
//! - `unit`: the robot with its motion, its driver and its dynamics
//! - `context`: what a running program sees of the controller
//! - `builtins`: the functions and instructions that programs call
//! - `controller`: runs programs cycle by cycle
//! - `command`: a compiled program as a command

mod builtins;
mod command;
pub mod communication;
mod context;
mod controller;
mod cycle;
pub mod emit;
pub mod fault;
pub mod fieldbus;
#[cfg(feature = "fuzzing")]
pub mod fuzzing;
pub mod io;
mod storage;
mod unit;
pub mod values;

/// What can be wrong with a file that users write.
pub mod settings {
    pub use arl_robot::settings::SettingsError;
}

/// Commands of motion in, a set-point each cycle out: the planner that moves robots.
pub use arl_motion as motion;
/// Threads beside the cycle: those of drivers, too.
pub use arl_motion::beside;
pub use arl_robot::cell::{self, Cell, Rate};
pub use arl_robot::{Family, Robot, islands, kinematics, robot};
pub use builtins::{frames, ops, text};
pub use command::program_main;
pub use context::cx::Cx;
pub use context::function_frame::{Frame as FunctionFrame, Runs};
pub use context::output::{Captured, Message, Output, Stream};
pub use context::program::{BoxFuture, Elsewhere, Program};
pub use context::shown::{Shown, ShownHandle};
pub use context::standstill::{Standstill, WaitsFor};
pub use context::{program, system};
pub use controller::{
    Builder, ChannelStatus, Controller, Foreground, Outcome, RobotStatus, SetupError, State, Status, StillRunning,
};
pub use cycle::channel_id::ChannelId;
pub use cycle::clock_source;
pub use cycle::realtime::Realtime;
pub use fault::{Alarm, Calls, Fault, Reason, Stop};
pub use storage::data::{DataFile, DataVar};
pub use storage::{data, state};
pub use unit::{dynamics, robot_driver};

#[cfg(feature = "macros")]
pub use arl_macros::{arl, arl_file};

/// Includes a program that `arl2rs::Build` compiled in the build script: `include_arl!("pick")`.
#[macro_export]
macro_rules! include_arl {
    ($name:literal) => {
        include!(concat!(env!("OUT_DIR"), "/", $name, ".rs"));
    };
}
