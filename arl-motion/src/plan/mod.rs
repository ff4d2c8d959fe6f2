//! From a command to a motion: its curve, the checks along it, and the limits of its parameter.

pub(crate) mod chain;
pub(crate) mod circle_steps;
pub(crate) mod constraints;
pub(crate) mod curve;
pub(crate) mod gate;
pub(crate) mod lay_overlay;
pub(crate) mod motion;
pub(crate) mod path_check;
pub(crate) mod planner;
