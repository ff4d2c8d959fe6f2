//! Motion of robot arms: commands in, a set-point each cycle out.
//!
//! A [`Queue`] takes [`Command`]s (lines, circles, splines, axis motions) and plans them ahead, blended where their
//! zones request it. Each [`Queue::step`] advances the robot by one cycle, within the limits of every axis and of the
//! TCP. The robot stops on its path ([`Queue::stop_on_path`]), continues, follows an override that may change at any
//! time, and suspends its motion for other motion and returns to it ([`Queue::request_suspension`]). A [`Recorder`]
//! shows what each motion really did.
//!
//! Lengths are in mm, angles in deg, times in s; rotation vectors are in rad.
//!
//! # Real time or reproducible runs
//!
//! [`Queue::new`] is for a control loop: a step never waits, and what threads find in parallel (blends, time laws) is
//! taken over when it is ready. [`Queue::repeatable`] is for simulation and planning: there a step waits for the
//! threads, and a queue that is stepped with the same commands at the same cycles gives the same set-points to the last
//! bit, on every machine. `arl-rt` uses the former with its real clock, the latter with its virtual one.
//!
//! A build without optimisation is about 50 times slower, too slow for real time. Optimise the computing crates in
//! debug builds as well, in the `Cargo.toml` of the workspace:
//!
//! ```toml
//! [profile.dev.package]
//! arl-motion = { opt-level = 2 }
//! arl-robot = { opt-level = 2 }
//! nalgebra = { opt-level = 2 }
//! ```
//!
//! # Features
//!
//! `files` (enabled by default) provides the built-in robots, and robots from files. Without it, a robot is created
//! from its description by [`robot::Robot::new`], and neither the language nor a TOML reader is compiled.
//!
//! # Example
//!
//! ```
//! use arl_motion::{Command, Cycle, Joints, Override, Queue, Settings, Speed, Stop, Target, Zone, robot::Robot};
//! use std::sync::Arc;
//!
//! let robot = Arc::new(Robot::builtin("kr10-r1420").expect("a built-in robot"));
//! let mut queue = Queue::repeatable(Arc::clone(&robot), Joints::home(&robot));
//! let settings = Settings::default();
//!
//! // Over to a start position, then two lines, the corner between them blended within 20 mm.
//! queue.add(&Command::new(Target::axes([0.0, -90.0, 90.0, 0.0, 30.0, 0.0])), &settings)?;
//! for _ in 0..2000 {
//!     queue.step(Cycle::MS, Override::FULL);
//! }
//! let [x, y, z, a, b, c] = arl_motion::kinematics::frame_components(&queue.tcp());
//! let slow = Speed { tcp: 250.0, ..Speed::FULL };
//! let corner = Target::line([x, y + 100.0, z, a, b, c]);
//! let first = Command { speed: slow, zone: Zone::within(20.0), ..Command::new(corner) };
//! let second = Command { speed: slow, ..Command::new(Target::line([x + 100.0, y + 100.0, z, a, b, c])) };
//! queue.add(&first, &settings)?;
//! queue.add(&second, &settings)?;
//!
//! // A set-point each ms; half a second later the robot is told to stop, and goes on once it rests.
//! let mut cycles = 0;
//! while !queue.idle() {
//!     let set_point = queue.step(Cycle::MS, Override::FULL);
//!     cycles += 1;
//!     match cycles {
//!         500 => queue.stop_on_path(Stop::General),
//!         _ if queue.stopped() && set_point.rests => queue.resume(),
//!         _ => {}
//!     }
//!     assert!(set_point.joints.axes.iter().all(|axis| axis.is_finite()));
//! }
//! let end = queue.tcp().translation.vector;
//! assert!((end.x - (x + 100.0)).abs() < 0.001 && (end.y - (y + 100.0)).abs() < 0.001);
//! # Ok::<(), arl_motion::PlanError>(())
//! ```
//!
//! Every motion, and every blend between two, is a stretch of one path with one parameter. Planning finds limits of
//! that parameter's speed, acceleration and jerk, constant for each stretch, such that *any* motion along it within
//! these limits keeps every axis and the TCP within theirs. Starting, stopping, resuming and changing the override then
//! concern that one parameter alone, and can never leave the path or exceed a limit. Where a motion has neither a given
//! duration nor an overlay (a weave, a compensation), every place has limits of its own, and the whole path ahead is
//! timed at once.
//!
//! The folders are the stages: `command`, `geometry`, `limits`, `overlay`, `plan`, `blend`, `follow`, `time_optimal`,
//! `junction`, `queue`. Each imports only from those before it. [`beside`] starts the threads that find blends and time
//! laws.

#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod beside;
mod blend;
mod command;
mod follow;
mod geometry;
mod junction;
mod limits;
mod overlay;
mod plan;
mod queue;
#[cfg(test)]
#[cfg(feature = "files")]
mod tests;
pub mod time_optimal;

pub use arl_robot::{frames, kinematics, nalgebra, robot};
pub use blend::no_blend::NoBlend;
pub use blend::zone::Rounding;
pub use command::{
    Command, Compensation, Cycle, CycleError, Gate, GatePart, Joints, Lift, MotionKind, Override, OverrideError,
    PlanError, Reference, Settings, Speed, Target, UNSET, Weave, WeaveShape, Zone, is_unset,
};
pub use plan::circle_steps::circle_steps;
pub use plan::motion::Motion;
pub use plan::path_check::NearSingular;
pub use plan::planner::plan;
pub use queue::{
    Closest, Figure, LOOK_AHEAD, Limited, MotionRecord, Preview, Progress, Queue, Rate, Recorder, SmallerZone, Start,
    Step, Stop, UnblendedTarget,
};

/// Runs the examples of the README.
#[cfg(all(doctest, feature = "files"))]
#[doc = include_str!("../README.md")]
struct Readme;
