//! How fast emitted programs run, and how fast programs are checked. See `docs/speed.md` for the figures.

#![allow(clippy::disallowed_methods)]

pub mod cell;
pub mod chains;
pub mod command;
pub mod cost;
pub mod engine;
pub mod inputs;
pub mod instructions;
pub mod kernels;
pub mod lua;
pub mod programs;
pub mod protocol;
pub mod random;
pub mod rivals;
pub mod run;
pub mod script;
pub mod sizes;
pub mod splines;
pub mod statistics;
pub mod waits;
