//! What can be wrong with a robot file.

use std::fmt;
#[cfg(feature = "files")]
use std::ops::Range;

#[cfg(feature = "files")]
use crate::settings::SettingsError;

/// What is wrong with a robot file, and where; or with the description of a robot.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct RobotError {
    /// The file, or the name that was asked for or described.
    pub file: String,
    /// Line from 1; 0 where the whole file is meant.
    pub line: u32,
    /// Column from 1, in characters; 0 where the whole file is meant.
    pub column: u32,
    /// What is wrong and what would be right.
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
