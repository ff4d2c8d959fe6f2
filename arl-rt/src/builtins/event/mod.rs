//! Interrupts, timers and triggers: actions that a program declares for events (manual 6 and 7).
//!
//! Declarations go into one table per channel. Each cycle, before the program runs, `scan` evaluates their conditions;
//! the channel runs the actions of those that have become true.

mod code;
mod declare;
mod halt;
mod progress;
mod scan;
mod switch;

pub use declare::{DuringMotion, EventDeclaration, Every, Holds, interrupt, timer, trigger};
pub use halt::{Skip, StartMove, StopMove, startmove, stopmove};
pub use progress::{elapsed_distance, elapsed_percent, elapsed_time, left_distance};
pub use switch::{DelInt, DisableInt, EnableInt, delint, disableint, enableint};

pub(crate) use scan::scan;
