//! Diagnostics as text: in the style of rustc for people, one JSON object per line for tools, one plain line for build
//! logs.

#[cfg(feature = "tools")]
mod human;
mod json;
mod plain;

#[cfg(feature = "tools")]
pub use human::human;
pub use json::json;
pub use plain::{plain, plain_block};

use crate::diagnostics::{Files, Location, Severity};

/// A location as people count: lines and columns from 1, columns in characters.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Position {
    /// Line of the first character; 0 if the file has no text.
    pub line: u32,
    /// Column of the first character.
    pub column: u32,
    /// Line of the end.
    pub end_line: u32,
    /// Column after the last character.
    pub end_column: u32,
}

impl Position {
    /// The position of `location`; all zero if its file is not among `files`.
    pub fn of(location: Location, files: &Files) -> Self {
        let Some(file) = files.get(location.file) else {
            return Self { line: 0, column: 0, end_line: 0, end_column: 0 };
        };
        let (line, column) = file.lines.line_column(&file.text, location.span.start);
        let (end_line, end_column) = file.lines.line_column(&file.text, location.span.end.max(location.span.start));
        Self { line, column, end_line, end_column }
    }
}

/// The word for a severity.
pub const fn severity_word(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    }
}

#[cfg(test)]
mod tests;
