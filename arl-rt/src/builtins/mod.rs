//! The functions and instructions that programs in ARL call.

pub mod bits;
pub mod calibration;
pub mod channel;
pub mod clock;
pub(crate) mod communication;
pub mod convert;
pub mod event;
pub mod files;
pub mod flow;
pub mod frames;
pub mod math;
pub mod motion;
pub mod ops;
pub mod points;
pub mod pose;
pub(crate) mod random;
pub mod strings;
pub mod text;
pub mod time;
