//! Errors of robot files.

use std::fmt;
#[cfg(feature = "files")]
use std::ops::Range;

#[cfg(feature = "files")]
use crate::settings::SettingsError;

/// An error in a robot file, with its position, or in the description of a robot.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct RobotError {
    /// The file, or the requested or described name.
    pub file: String,
    /// Line from 1; 0 for the whole file.
    pub line: u32,
    /// Column from 1, in characters; 0 for the whole file.
    pub column: u32,
    /// The problem, and what would be right.
    pub message: String,
}

impl RobotError {
    pub(super) fn of_file(file: &str, message: String) -> Self {
        Self { file: file.to_owned(), line: 0, column: 0, message }
    }

    #[cfg(feature = "files")]
    pub(super) fn at(file: &str, text: &str, span: Range<usize>, message: String) -> Self {
        let before = text.get(..span.start).unwrap_or(text);
        let line = before.bytes().filter(|byte| *byte == b'\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |start| start.chars().count()) + 1;
        Self { file: file.to_owned(), line: line as u32, column: column as u32, message }
    }
}

impl fmt::Display for RobotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line == 0 {
            write!(f, "{}: {}", self.file, self.message)
        } else {
            write!(f, "{}:{}:{}: {}", self.file, self.line, self.column, self.message)
        }
    }
}

impl std::error::Error for RobotError {}

#[cfg(feature = "files")]
impl From<SettingsError> for RobotError {
    fn from(error: SettingsError) -> Self {
        let SettingsError { file, line, column, message } = error;
        Self { file, line, column, message }
    }
}
