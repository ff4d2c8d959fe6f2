//! How the tools of arl2rs say what they have to say, and end: errors and warnings, answers, exit codes, Ctrl-C, and
//! the ports and folders that belong to one run alone.

pub mod answer;
pub mod exit;
pub mod failure;
pub mod interrupt;
pub mod port;
pub mod private_folder;
pub mod progress;
pub mod show;
