//! Robots: what a robot file says, the axes with their limits, and kinematics in closed form.
//!
//! The runtime moves robots with it, and the command tells before a program runs which targets a robot cannot reach.

pub mod atomic_file;
pub mod cell;
pub mod change;
pub mod changes;
pub mod channels;
pub mod frames;
pub mod islands;
pub mod kinematics;
pub mod outline;
pub mod regular_file;
pub mod robot;
pub mod settings;

pub use nalgebra;
pub use robot::{Family, Robot};

/// The examples of the README run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
