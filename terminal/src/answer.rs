//! The output of the command on standard output.

use crate::failure::Failure;
use clap::ValueEnum;
use std::io::{self, ErrorKind, Write};

/// The format of messages.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum, Debug)]
pub enum Format {
    /// For people, on standard error.
    Human,
    /// One JSON object per line, on standard output.
    Json,
}

/// The forms of a report.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum, Debug)]
pub enum ReportFormat {
    /// The table of motions, or with =FILE a JSON object for each of them.
    Human,
    /// One JSON object for the whole run.
    Json,
    /// A page for a browser.
    Html,
}

/// Writes text unchanged. A closed reader is not a failure.
///
/// # Errors
/// Writing fails, as on a full disk.
pub fn write(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    written(out.write_all(text.as_bytes()).and_then(|()| out.flush()))
}

/// Writes text that may have colours, without them if they are not wanted.
///
/// # Errors
/// As for [`write()`].
pub fn write_coloured(text: &str) -> Result<(), Failure> {
    let mut out = anstream::stdout().lock();
    written(out.write_all(text.as_bytes()).and_then(|()| out.flush()))
}

/// The result of writing to standard output.
///
/// # Errors
/// Writing failed, and not because the reader has closed the pipe.
pub fn written(outcome: io::Result<()>) -> Result<(), Failure> {
    match outcome {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::Other(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}
