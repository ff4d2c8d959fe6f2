//! Robots: the axes with their limits, kinematics in closed form, and what robot and cell files say.
//!
//! The runtime moves robots with it, and the command tells before a program runs which targets a robot cannot reach.
//!
//! The feature `files` (a default one) has the files: robots that are built in or [loaded](Robot::load), and cells.
//! Without it there are values and kinematics alone, a robot is one from [`Robot::new`], and neither a reader of TOML
//! nor the language is compiled.

// The runtime and the command write files so; it is not part of what this crate is for.
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
// As `atomic_file`: the runtime and the command read files so.
#[cfg(feature = "files")]
#[doc(hidden)]
pub mod regular_file;
pub mod robot;
// How all our crates read the files that users write. `SettingsError`, which they all give, is [`cell::SettingsError`],
// too.
#[cfg(feature = "files")]
#[doc(hidden)]
pub mod settings;

pub use nalgebra;
pub use rate::Rate;
pub use robot::{Family, Robot};

/// The examples of the README run.
#[cfg(all(doctest, feature = "files"))]
#[doc = include_str!("../README.md")]
struct Readme;
