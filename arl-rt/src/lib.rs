//! The runtime for robot programs in ARL: the control cycle, motion, io, system variables and a simulated robot.
//!
//! The compiler turns an ARL program into an implementation of [`Program`]; a [`Controller`] runs it, cycle by cycle.
//! To embed a controller you need little more than these items at the root of the crate:
//!
//! - [`Builder`] takes the parts of a controller: [`Robot`], [`Cell`], clock, drivers, more programs ([`Foreground`])
//! - [`Controller::step`] and [`Controller::run`] run it; [`Outcome`], [`State`] and [`Status`] report its state,
//!   [`Captured`] keeps what it prints, and an [`Alarm`] reports what went wrong
//! - [`Handle`] gives other threads access to a controller, [`Running`] is a controller on a thread of its own
//! - [`Cx`] is a running program's view of its controller
//!
//! ```
//! use arl_rt::emit::*; // what programs are made of
//! use arl_rt::{Captured, Controller, Outcome};
//!
//! /// `movej j:{j1 30, ..}`, then `print "there"`: by hand what the compiler emits.
//! struct Turn;
//!
//! impl arl_rt::Program for Turn {
//!     fn file(&self) -> File {
//!         File::new("turn.arl")
//!     }
//!     fn family(&self) -> Family {
//!         Family::SixAxis
//!     }
//!     fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
//!         Box::pin(async move {
//!             let target = Joint::of_axes([30.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
//!             motion::movej(target).run(cx).await.at(self.file(), 2)?;
//!             flow::waittime(0.0).run(cx).await.at(self.file(), 3)?; // until the robot is there
//!             text::print().argtoprint(&"there").run(cx).at(self.file(), 4)
//!         })
//!     }
//! }
//!
//! let messages = Captured::new();
//! let mut controller = Controller::builder().output(messages.clone()).build(Turn)?;
//! assert_eq!(controller.run(), Outcome::Ended);
//! assert_eq!(messages.text(), "there\n");
//! assert_eq!(controller.joints().axes[0], 30.0);
//! # Ok::<(), arl_rt::SetupError>(())
//! ```
//!
//! A build without optimisation is too slow for cycles of 1 ms in real time. The `Cargo.toml` of your workspace can
//! have the computing crates optimised in debug builds, too:
//!
//! ```toml
//! [profile.dev.package]
//! arl-motion = { opt-level = 2 }
//! arl-robot = { opt-level = 2 }
//! arl-rt = { opt-level = 1 }
//! nalgebra = { opt-level = 2 }
//! ```
//!
//! The modules are for those who drive a real arm ([`robot_driver`], [`io`], [`clock`], [`devicenet`], [`network`]),
//! keep data that outlives a run ([`storage`]), write programs in Rust ([`program`], [`fault`], [`values`]), or want
//! more details of a run ([`status`], [`output`], [`system`]). The layers below are public, too: [`motion`], [`robot`],
//! [`kinematics`], [`cell`], [`dynamics`].
//!
//! The features: `macros` provides `arl!` and `arl_file!`; `serial` (on by default) provides serial lines; `realtime`
//! provides [`clock::Realtime`] on Linux.

#![cfg_attr(test, allow(clippy::disallowed_methods))]

mod builtins;
mod command;
mod communication;
mod context;
mod controller;
mod cycle;
#[doc(hidden)]
pub mod emit;
pub mod fault;
mod fieldbus;
#[cfg(feature = "fuzzing")]
#[doc(hidden)]
pub mod fuzzing;
pub mod io;
pub mod storage;
mod unit;
pub mod values;

pub use arl_motion as motion;
pub use arl_motion::beside;
pub use arl_robot::cell::Cell;
pub use arl_robot::{Family, Robot, cell, kinematics, nalgebra, robot};
pub use context::cx::Cx;
pub use context::output::{Captured, Message};
pub use context::program::Program;
pub use context::system;
pub use controller::{Builder, Controller, Foreground, Handle, Outcome, Running, SetupError, State, Status};
pub use fault::Alarm;
pub use fieldbus::devicenet;
pub use unit::{dynamics, robot_driver};

/// Sources of cycle time: clocks, statistics of late cycles, and the real-time setup of the cycle's thread.
pub mod clock {
    pub use crate::cycle::clock_source::{Clock, Late, Lateness, RealClock, VirtualClock};
    pub use crate::cycle::realtime::Realtime;
    pub use arl_robot::cell::Rate;
}

/// The network ports of the host, which programs may set up.
pub mod network {
    pub use crate::communication::{NetworkDriver, PortSettings};
}

/// Where the messages of programs go.
pub mod output {
    pub use crate::context::output::{Captured, Message, Output, Stream};
    pub use crate::context::subscribers::Event;
}

/// Programs: what the compiler emits, and what Rust programmers write themselves.
pub mod program {
    pub use crate::context::program::{AsAny, Beside, BoxFuture, Elsewhere, Make, Other, Program};
    pub use crate::fault::{At, Called, Done, File};
    pub use crate::storage::data::{DataFile, DataVar};
}

/// The state of a controller, its channels and its robots.
pub mod status {
    pub use crate::context::named::GlobalError;
    pub use crate::context::standstill::{Standstill, WaitsFor};
    pub use crate::controller::{
        ChannelStatus, HandleError, OrderError, Outcome, RobotStatus, State, Status, StillRunning,
    };
    pub use crate::cycle::channel_id::ChannelId;
    pub use crate::unit::Motors;
}

#[cfg(feature = "macros")]
pub use arl_macros::{arl, arl_file};

/// Includes a program that `arl2rs::Build` compiled in the build script: `include_arl!("pick")`.
#[macro_export]
macro_rules! include_arl {
    ($name:literal) => {
        include!(concat!(env!("OUT_DIR"), "/", $name, ".rs"));
    };
}
