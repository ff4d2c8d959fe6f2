//! A compiled program as a command: its command line, a run that another program drives, and reports.

mod json;
mod live;
pub mod program_main;
mod report;
