//! The state that the controller keeps between runs: each run of a session begins with a copy of what is there, so that
//! runs repeat each other. What they keep goes with the session.

use super::leftovers::PREFIX;
use arl_terminal::private_folder::PrivateFolder;
use std::path::{Path, PathBuf};

/// Where it is where nobody says otherwise, below the program's folder.
const STATE_DIR: &str = ".arl-state";

/// A copy that goes with the session.
pub(super) struct State {
    original: PathBuf,
    /// None where none can be made.
    copy: std::io::Result<PrivateFolder>,
}

impl State {
    /// For programs that keep their state in a folder, or else below that of their files.
    pub(super) fn new(folder: Option<&Path>, files: &Path) -> Self {
        let original = folder.map_or_else(|| files.join(STATE_DIR), Path::to_path_buf);
        Self { original, copy: PrivateFolder::new(PREFIX) }
    }

    /// The folder for another run, which finds what is in the original.
    ///
    /// # Errors
    /// It cannot be copied.
    pub(super) fn begin(&self) -> Result<&Path, String> {
        let failed = |error: &std::io::Error| format!("cannot copy {}: {error}", self.original.display());
        let copy = self
            .copy
            .as_ref()
            .map_err(|error| format!("cannot make a temporary folder for the state: {error}"))?
            .path();
        for entry in std::fs::read_dir(copy).map_err(|error| failed(&error))?.flatten() {
            std::fs::remove_file(entry.path()).map_err(|error| failed(&error))?;
        }
        let Ok(entries) = std::fs::read_dir(&self.original) else { return Ok(copy) };
        for entry in entries.filter_map(Result::ok).filter(|entry| entry.path().is_file()) {
            std::fs::copy(entry.path(), copy.join(entry.file_name())).map_err(|error| failed(&error))?;
        }
        Ok(copy)
    }
}
