//! Sources from the file system. Only regular files are read: a named pipe may never be written to, and a device may
//! never end.

use crate::{SourceError, Sources};
use std::io::ErrorKind;
use std::path::Path;

/// Reads sources from the file system; relative paths start at the working directory.
#[derive(Clone, Copy, Debug, Default)]
pub struct FileSystem;

impl Sources for FileSystem {
    #[expect(clippy::disallowed_methods, reason = "this is where the doors read files")]
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        let failed = |error: std::io::Error| match error.kind() {
            ErrorKind::NotFound | ErrorKind::NotADirectory => SourceError::Missing,
            ErrorKind::IsADirectory => SourceError::Unreadable("it is a directory".into()),
            _ => SourceError::Unreadable(error.to_string()),
        };
        match std::fs::metadata(path).map_err(failed)?.file_type() {
            kind if kind.is_file() => std::fs::read(path).map_err(failed),
            kind if kind.is_dir() => Err(SourceError::Unreadable("it is a directory".into())),
            _ => Err(SourceError::Unreadable("it is not a regular file, but a pipe, a socket or a device".into())),
        }
    }
}

/// Writes a file unless it already has this content, so that its modification time changes only with the content.
/// Creates the folder if necessary. Returns whether the file was written.
///
/// # Errors
/// The file cannot be written.
#[expect(clippy::disallowed_methods, reason = "this is where the doors write files")]
pub fn write_if_changed(path: &Path, content: &[u8]) -> std::io::Result<bool> {
    if std::fs::read(path).is_ok_and(|old| old == content) {
        return Ok(false);
    }
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    std::fs::write(path, content)?;
    Ok(true)
}
