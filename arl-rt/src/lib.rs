//! What robot programs in ARL run on: the cycle, motion, io, system variables and a simulated robot.
//!
//! The compiler turns an ARL program into an implementation of [`Program`]; a [`Controller`] runs it. Emitted code names
//! everything through the prelude [`emit`].

mod at_once;
pub mod bits;
pub mod calibration;
pub mod cell;
pub mod channel;
pub mod channel_id;
pub mod clock;
pub mod clock_source;
pub mod communication;
pub mod controller;
pub mod convert;
pub mod cx;
pub mod data;
mod disk;
pub mod dynamics;
pub mod emit;
pub mod event;
pub mod fault;
pub mod fieldbus;
pub mod files;
pub mod flow;
pub mod frames;
#[cfg(feature = "fuzzing")]
pub mod fuzzing;
pub mod io;
mod json;
mod keep;
mod lane;
pub mod live;
mod loadable;
pub mod math;
pub mod motion;
mod motion_instructions;
pub mod ops;
pub mod output;
mod pointers;
pub mod points;
pub mod pose;
pub mod program;
pub mod program_main;
pub mod random;
pub mod rate;
mod report;
pub mod robot_driver;
pub mod state;
pub mod strings;
pub mod system;
pub mod text;
pub mod time;
mod trace;
mod unit;
pub mod values;
mod whole;
mod world;

/// What can be wrong with a file that users write.
pub mod settings {
    pub use arl_robot::settings::SettingsError;
    pub(crate) use arl_robot::settings::{Section, Source, Value, hint, kind, number, table};
}

pub use arl_robot::{Family, Robot, islands, kinematics, robot};
pub use cell::Cell;
pub use channel_id::ChannelId;
pub use controller::{Builder, ChannelStatus, Controller, Foreground, Outcome, RobotStatus, SetupError, State, Status};
pub use cx::Cx;
pub use fault::{Alarm, Fault, Reason, Stop};
pub use output::{Captured, Message, Output, Stream};
pub use program::{BoxFuture, DataFile, DataVar, Elsewhere, Program};

#[cfg(feature = "macros")]
pub use arl_macros::{arl, arl_file};

/// Includes a program that `arl2rs::Build` compiled in the build script: `include_arl!("pick")`.
#[macro_export]
macro_rules! include_arl {
    ($name:literal) => {
        include!(concat!(env!("OUT_DIR"), "/", $name, ".rs"));
    };
}
