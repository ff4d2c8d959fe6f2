//! The texts of the program, to show the lines around the running one.

use std::path::PathBuf;

use crate::texts::{self, Text, file_name};

/// The lines of a file.
struct Source {
    /// The name that alarms show.
    name: String,
    lines: Vec<String>,
}

/// The texts of the program.
#[derive(Default)]
pub(super) struct Sources(Vec<Source>);

impl Sources {
    /// Reads the files; what cannot be read is not shown.
    pub(super) fn read(files: &[PathBuf]) -> Self {
        let source = |Text { name, text }| Source { name, lines: lines(&text) };
        Self(texts::read(files).into_iter().map(source).collect())
    }

    #[cfg(test)]
    pub(super) fn of(name: &str, text: &str) -> Self {
        Self(vec![Source { name: name.to_owned(), lines: lines(text) }])
    }

    /// Up to `height` lines of a file with `line` in their middle, as far as there are lines: each with its number.
    pub(super) fn around(&self, file: &str, line: usize, height: usize) -> Vec<(usize, &str)> {
        let Some(source) = self.0.iter().find(|source| source.name.eq_ignore_ascii_case(file_name(file))) else {
            return Vec::new();
        };
        let most = source.lines.len().saturating_sub(height);
        let first = line.saturating_sub(1).saturating_sub(height / 2).min(most);
        source.lines.iter().enumerate().skip(first).take(height).map(|(at, text)| (at + 1, text.as_str())).collect()
    }
}

/// Splits a text into lines, without tabs, which would break the columns of the screen.
fn lines(text: &str) -> Vec<String> {
    text.lines().map(|line| line.replace('\t', "    ")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_is_in_the_middle_where_that_can_be() {
        let sources = Sources::of("pick.arl", "a\nb\nc\nd\ne\nf");
        let numbers = |line, height| -> Vec<usize> {
            sources.around("programs/PICK.arl", line, height).into_iter().map(|(number, _)| number).collect()
        };
        assert_eq!(numbers(4, 3), [3, 4, 5]);
        assert_eq!(numbers(1, 3), [1, 2, 3]);
        assert_eq!(numbers(6, 3), [4, 5, 6]);
        assert_eq!(numbers(0, 9), [1, 2, 3, 4, 5, 6]);
        assert!(sources.around("other.arl", 1, 3).is_empty());
    }
}
