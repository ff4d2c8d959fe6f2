//! A compiled program as a command: its command line, a run that another program drives, and reports.
//!
//! It may import from every module, and only `lib.rs` imports from it.

mod asked;
mod between;
mod channel_traces;
mod connection;
mod coverage;
mod debug;
mod ending;
pub mod in_process;
pub mod interrupts;
mod json;
mod live;
mod observation;
mod options;
mod polling;
pub mod program_main;
mod report;
mod results;
mod say;
mod serve;
mod set_up;
mod stack;
mod summary;
mod words;
