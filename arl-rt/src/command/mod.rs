//! A compiled program as a command: its command line, a run that another program drives, and reports.
//!
//! It may import from every module, and only `lib.rs` imports from it.

mod asked;
mod between;
mod connection;
mod coverage;
mod debug;
pub mod in_process;
pub mod interrupts;
mod json;
mod live;
mod observation;
mod polling;
pub mod program_main;
mod report;
mod say;
mod serve;
mod stack;
mod summary;
