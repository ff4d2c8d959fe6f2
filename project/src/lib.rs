//! Handles everything that belongs to a program (its robot, its cell, its `arl.toml`), and compiles it from its source
//! texts with as little work as the changes require.

pub mod arl_toml;
mod build_failure;
pub mod cache;
pub mod cargo;
pub mod cell_programs;
mod code_files;
pub mod expectations;
pub mod listing;
pub mod options;
pub mod package;
pub mod program;
pub mod program_path;
pub mod robots;
pub mod runtime;
pub mod stamp;
