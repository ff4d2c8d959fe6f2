//! What robot programs in ARL run on: the cycle, motion, io, system variables and a simulated robot.
//!
//! The compiler turns an ARL program into an implementation of [`Program`]; a [`Controller`] runs it, cycle by cycle.
//! Whoever embeds one needs little more than what stands here at the top:
//!
//! - [`Builder`] takes what a controller has: [`Robot`], [`Cell`], clock, drivers, more programs ([`Foreground`])
//! - [`Controller::step`] and [`Controller::run`] run it; [`Outcome`], [`State`] and [`Status`] say how it stands,
//!   [`Captured`] keeps what it prints, and an [`Alarm`] says what went wrong
//! - [`Handle`] is a controller as other threads have it, [`Running`] one on a thread of its own
//! - [`Cx`] is what a running program sees of its controller
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
//! A build without optimisation is slow, too slow for cycles of 1 ms in real time. The `Cargo.toml` of your workspace
//! can have what computes optimised in debug builds, too:
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
//! who keep what outlives a run ([`storage`]), who write programs in Rust ([`program`], [`fault`], [`values`]), or who
//! want to know more of a run ([`status`], [`output`], [`system`]). What is below is there, too: [`motion`], [`robot`],
//! [`kinematics`], [`cell`], [`dynamics`].
//!
//! The features: `macros` has `arl!` and `arl_file!`; `serial` (a default one) has serial lines; `realtime` has
//! [`clock::Realtime`] on Linux.

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

/// Where the time of cycles comes from: clocks, how late cycles began, and what the system gives the cycle.
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

/// How a controller, its channels and its robots stand.
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
