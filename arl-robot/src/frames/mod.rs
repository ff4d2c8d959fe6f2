//! The frames between a programmed pose and the flange: tool, workpiece, base.

mod rig;
mod setting;
mod straight;

pub use rig::{Carried, Rig};
pub use setting::{Mount, Setting, Unmoved};
pub use straight::StraightPath;
