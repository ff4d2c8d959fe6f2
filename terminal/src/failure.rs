//! How the command ends when it does not go well.

use crate::exit::Exit;
use std::path::Path;

/// Exit codes, as the book lists them.
/// A program has mistakes, or something around it went wrong.
pub const COMPILE_ERRORS: u8 = 1;
/// The command line asks for something that cannot be.
pub const USAGE: u8 = 2;
/// Ctrl-C.
pub const INTERRUPTED: u8 = 130;

/// Why a command gave up. What is to be said was not said yet, but for [`Failure::Shown`].
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
    /// A file or folder that the command itself could not use.
    pub fn io(doing: &str, path: &Path, error: &std::io::Error) -> Self {
        Self::Other(format!("cannot {doing} {}: {error}", path.display()))
    }

    /// Says it, and gives the exit code.
    pub fn report(self) -> Exit {
        match self {
            Failure::Shown => Exit::from(COMPILE_ERRORS),
            Failure::Usage(text) => {
                super::show::error(&text);
                Exit::from(USAGE)
            }
            Failure::Other(text) => {
                super::show::error(&text);
                Exit::from(COMPILE_ERRORS)
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
