//! Motion: commands become paths, paths get their timing, and an interpolator follows them cycle by cycle.
//!
//! Every motion, and every blend between two, is a stretch of one way with one parameter. Planning finds limits of that
//! parameter's speed, acceleration and jerk, constant for each stretch, such that *whatever* moves along it within them
//! keeps every axis and the TCP within theirs. Starting, stopping, resuming and changing the override are then problems of
//! that one parameter and can never leave the path or break a limit. In the profile O every place has limits of its own, and
//! the whole of the way ahead is timed at once.

mod arc;
mod bend;
mod blend;
mod bounds;
mod chain;
mod command;
mod course;
mod crossing;
mod curve;
mod ease;
mod error;
mod finder;
mod foresight;
mod gate;
mod governor;
mod halves;
mod joints;
mod junction;
mod limits;
#[doc(hidden)]
pub mod optimal;
mod overlay;
mod piece;
mod pilot;
mod place;
mod plan;
mod planned;
mod plot;
mod preparer;
mod profile;
mod progress;
mod queue;
mod quintic;
mod ramp;
mod record;
mod remaining;
mod rotation;
mod scout;
mod search;
mod set_points;
mod spline;
mod survey;
#[cfg(test)]
mod tests;
mod timing;
mod zone;

pub use command::{Command, Settings, Speed, Target, Zone};
pub use course::Sharp;
pub use error::PlanError;
pub use gate::{Gate, Lift};
pub(crate) use halves::halves;
pub use joints::{Joints, UNSET, is_unset};
pub use overlay::{Compensation, Reference, Weave, WeaveShape};
pub use plan::plan;
pub use planned::Motion;
pub use queue::{LOOK_AHEAD, Progress, Queue, Start, Step, Stop};
pub(crate) use record::Recorder;
pub use record::{Closest, Figure, Limited, MotionRecord, Rate};
pub use zone::Rounding;

pub use crate::motion_instructions::{
    Above, AccSet, Ccir, Cir, Compen, CompenFrame, EndCompen, EndDetect, EndWeave, Jump, Lin, MoveJ, Ptp, Spl,
    StartCompen, StartDetect, StartWeave, ToolLoad, ToolSwitch, VelSet, accset, ccir, cir, compen, endcompen,
    enddetect, endweave, jump, lin, movej, ptp, spl, startcompen, startdetect, startweave, toolload, toolswitch,
    velset,
};
