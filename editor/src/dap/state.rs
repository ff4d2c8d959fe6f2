//! The state that the controller keeps between runs: each run of a session begins with a copy of the present state, so
//! that runs repeat each other. What they keep is removed with the session.

use super::leftovers::PREFIX;
use arl_terminal::private_folder::PrivateFolder;
use std::path::{Path, PathBuf};

/// Where the state is by default, below the program's folder.
const STATE_DIR: &str = ".arl-state";

/// A copy that is removed with the session.
pub(super) struct State {
    original: PathBuf,
    /// An error where no folder can be made.
    copy: std::io::Result<PrivateFolder>,
}

impl State {
    /// For programs that keep their state in a folder, or else below the folder of their files.
    pub(super) fn new(folder: Option<&Path>, files: &Path) -> Self {
        let original = folder.map_or_else(|| files.join(STATE_DIR), Path::to_path_buf);
        Self { original, copy: PrivateFolder::new(PREFIX) }
    }

    /// The folder for another run, with the content of the original.
    ///
    /// # Errors
    /// The state cannot be copied.
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
