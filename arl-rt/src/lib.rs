//! Under construction.

pub mod kinematics;
pub mod robot;
