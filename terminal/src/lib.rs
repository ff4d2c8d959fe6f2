//! Terminal output and exit of the arl2rs tools: errors and warnings, answers, exit codes, Ctrl-C, and the ports and
//! folders that belong to a single run.

pub mod answer;
pub mod exit;
pub mod failure;
pub mod interrupt;
pub mod port;
pub mod private_folder;
pub mod progress;
pub mod show;
