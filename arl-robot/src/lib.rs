//! Robots: axes with their limits, kinematics in closed form, and robot and cell files.
//!
//! The runtime uses this crate to move robots, and the command to report, before a program runs, the targets that a
//! robot cannot reach.
//!
//! The feature `files` (on by default) adds files: robots that are built in or [loaded](Robot::load), and cells.
//! Without it the crate has only values and kinematics, robots come from [`Robot::new`], and neither a TOML parser nor
//! the language is compiled.

#![cfg_attr(test, allow(clippy::disallowed_methods))]

// The runtime and the command write files with this module; it is not part of the purpose of this crate.
#[cfg(feature = "files")]
#[doc(hidden)]
pub mod atomic_file;
#[cfg(feature = "files")]
pub mod cell;
#[cfg(feature = "files")]
pub mod change;
#[cfg(feature = "files")]
pub mod changes;
#[cfg(feature = "files")]
pub mod channels;
pub mod frames;
#[cfg(feature = "files")]
pub mod islands;
pub mod kinematics;
#[cfg(feature = "files")]
pub mod outline;
mod rate;
// Like `atomic_file`: the runtime and the command read files with this module.
#[cfg(feature = "files")]
#[doc(hidden)]
pub mod regular_file;
// Like `atomic_file`: the command renames files with this module.
#[cfg(feature = "files")]
#[doc(hidden)]
pub mod renaming;
// Like `atomic_file`: they write the results of runs with this module.
#[cfg(feature = "files")]
#[doc(hidden)]
pub mod result_file;
pub mod robot;
// With this module all crates of this project read the files that users write. Its error, `SettingsError`, is also
// [`cell::SettingsError`].
#[cfg(feature = "files")]
#[doc(hidden)]
pub mod settings;

pub use nalgebra;
pub use rate::Rate;
pub use robot::{Family, Robot};

/// Runs the examples of the README.
#[cfg(all(doctest, feature = "files"))]
#[doc = include_str!("../README.md")]
struct Readme;
