//! Reads files of the user. Only regular ones are read: a named pipe may never be written, and a device may never end.
//! Links are followed.

use std::fs;
use std::io;
use std::path::Path;

/// The message for a path that exists, but is not a file.
const NOT_REGULAR: &str = "this is not a regular file";

/// Checks that a path, with links followed, is a regular file.
///
/// # Errors
/// The path does not exist (`NotFound`), cannot be inspected, or is a directory, a pipe, a socket or a device.
pub fn expect(path: &Path) -> io::Result<()> {
    let kind = fs::metadata(path)?.file_type();
    match kind.is_file() {
        true => Ok(()),
        false if kind.is_dir() => Err(io::Error::new(io::ErrorKind::IsADirectory, "this is a directory")),
        false => Err(io::Error::new(io::ErrorKind::InvalidInput, NOT_REGULAR)),
    }
}

/// The bytes of a regular file.
///
/// # Errors
/// The file cannot be read, or is not a regular file.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    expect(path)?;
    fs::read(path)
}

/// The text of a regular file.
///
/// # Errors
/// The file cannot be read, is not a regular file, or is not UTF-8 text.
pub fn read_text(path: &Path) -> io::Result<String> {
    expect(path)?;
    fs::read_to_string(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_are_read() {
        let text = read_text(&Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml")).unwrap();
        assert!(text.contains("arl-robot"));
        let kind = |path: &str| read(Path::new(path)).unwrap_err().kind();
        assert_eq!(kind("/nothing/here"), io::ErrorKind::NotFound);
        assert_eq!(kind(env!("CARGO_MANIFEST_DIR")), io::ErrorKind::IsADirectory);
        #[cfg(unix)]
        assert_eq!(kind("/dev/zero"), io::ErrorKind::InvalidInput);
    }
}
