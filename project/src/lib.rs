//! What belongs to a program (its robot, its cell, its `arl.toml`), and its way from source texts to a compiled
//! program, with as little work as the changes need.

pub mod arl_toml;
pub mod cache;
pub mod cargo;
pub mod expectations;
pub mod listing;
pub mod options;
pub mod package;
pub mod program;
pub mod program_path;
pub mod robots;
pub mod runtime;
pub mod several;
pub mod stamp;
mod trouble;
