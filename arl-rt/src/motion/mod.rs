//! Motion: commands become paths, paths get their timing, and an interpolator follows them cycle by cycle.
//!
//! Every motion runs over one path parameter from 0 to 1. Planning finds constant limits of that parameter's speed,
//! acceleration and jerk such that *whatever* moves along the path within them keeps every axis and the TCP within
//! theirs. Starting, stopping, resuming and changing the override are then problems of that one parameter and can never
//! leave the path or break a limit.

mod command;
mod error;
mod joints;
mod limits;
#[doc(hidden)]
pub mod optimal;
mod path;
mod plan;
mod profile;
mod queue;
mod survey;
#[cfg(test)]
mod tests;

pub use command::{Command, Settings, Speed, Target};
pub use error::PlanError;
pub use joints::{Joints, UNSET, is_unset};
pub use plan::{Motion, plan};
pub use queue::{LOOK_AHEAD, Progress, Queue, Step, Stop};

pub use crate::motion_instructions::{AccSet, Lin, MoveJ, Ptp, VelSet, accset, lin, movej, ptp, velset};
