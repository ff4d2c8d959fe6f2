//! Failures of tools.

use crate::exit::Exit;
use crate::show;
use std::path::Path;

/// The reason why a tool gave up. The message has not been shown yet, except for [`Failure::Shown`].
#[derive(Debug)]
pub enum Failure {
    /// The program has errors, and they were shown.
    Shown,
    /// The command line requests something impossible.
    Usage(String),
    /// Something around the compiler failed: a folder cannot be written, or cargo is missing.
    Other(String),
}

impl Failure {
    /// The failure of a file or folder that the command itself could not use: `doing` is `read`, `write` and so on.
    pub fn io(doing: &str, path: &Path, error: &std::io::Error) -> Self {
        Self::Other(format!("cannot {doing} {}: {error}", path.display()))
    }

    /// Shows the message, and returns the exit code.
    pub fn report(self) -> Exit {
        match self {
            Failure::Shown => Exit::FAILURE,
            Failure::Usage(text) => {
                show::error(&text);
                Exit::USAGE
            }
            Failure::Other(text) => {
                show::error(&text);
                Exit::FAILURE
            }
        }
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Failure::Shown => f.write_str("the program has errors"),
            Failure::Usage(text) | Failure::Other(text) => f.write_str(text),
        }
    }
}
