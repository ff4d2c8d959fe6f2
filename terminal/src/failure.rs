//! How a tool ends when it does not go well.

use crate::exit::Exit;
use crate::show;
use std::path::Path;

/// Why a tool gave up. What is to be said was not said yet, but for [`Failure::Shown`].
#[derive(Debug)]
pub enum Failure {
    /// The program has errors, and they were shown.
    Shown,
    /// The command line asks for something that cannot be.
    Usage(String),
    /// Something around the compiler went wrong: a folder that cannot be written, cargo missing.
    Other(String),
}

impl Failure {
    /// A file or folder that the command itself could not use: `doing` is `read`, `write` and so on.
    pub fn io(doing: &str, path: &Path, error: &std::io::Error) -> Self {
        Self::Other(format!("cannot {doing} {}: {error}", path.display()))
    }

    /// Says it, and gives the exit code.
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
