//! Motion: commands become paths, paths get their timing, and an interpolator follows them cycle by cycle.
//!
//! Every motion, and every blend between two, is a stretch of one way with one parameter. Planning finds limits of that
//! parameter's speed, acceleration and jerk, constant for each stretch, such that *whatever* moves along it within them
//! keeps every axis and the TCP within theirs. Starting, stopping, resuming and changing the override are then problems of
//! that one parameter and can never leave the path or break a limit. In the profile O every place has limits of its own, and
//! the whole of the way ahead is timed at once.

mod blend;
mod command;
mod follow;
mod geometry;
mod limits;
mod overlay;
mod plan;
mod queue;
#[cfg(test)]
mod tests;
pub mod time_optimal;

pub use blend::zone::Rounding;
pub use command::{
    Command, Compensation, Gate, Joints, Lift, PlanError, Reference, Settings, Speed, Target, UNSET, Weave, WeaveShape,
    Zone, is_unset,
};
pub use plan::circle_steps::circle_steps;
pub use plan::motion::Motion;
pub use plan::planner::plan;
pub use queue::{
    Closest, Figure, LOOK_AHEAD, Limited, MotionRecord, Progress, Queue, Rate, Recorder, Start, Step, Stop,
    UnblendedTarget,
};
