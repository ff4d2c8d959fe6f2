//! The texts of a program, for display.

use arl_robot::regular_file;
use std::path::PathBuf;

/// A file of a program.
#[derive(Clone, PartialEq, Debug)]
pub struct Text {
    /// Its name without folders, as in alarms and states.
    pub name: String,
    /// Its content.
    pub text: String,
}

/// Reads the files; what cannot be read is left out.
pub fn read(files: &[PathBuf]) -> Vec<Text> {
    let read = |path: &PathBuf| {
        let bytes = regular_file::read(path).ok()?;
        let text = arl_lang::text::decode(&bytes).ok()?.into_owned();
        Some(Text { name: file_name(&path.to_string_lossy()).to_owned(), text })
    };
    files.iter().filter_map(read).collect()
}

/// The last part of a path, whichever system wrote it.
pub fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}
