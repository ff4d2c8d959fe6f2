//! Under construction.

pub mod kinematics;
pub mod robot;
pub mod fault;
pub mod ops;
pub mod text;
pub mod values;
pub mod bits;
pub mod convert;
pub mod frames;
pub mod math;
pub mod strings;
