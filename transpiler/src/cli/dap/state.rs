//! The state that the controller keeps between runs: each run of a session begins with a copy of what is there, so that runs
//! repeat each other. What they keep goes with the session.

use super::remains::PREFIX;
use std::path::{Path, PathBuf};

/// Where it is where nobody says otherwise, below the program's folder.
const STATE_DIR: &str = ".arl-state";

/// A copy that goes with the session.
pub(super) struct State {
    original: PathBuf,
    copy: PathBuf,
}

impl State {
    /// For programs that keep their state in a folder, or else below that of their files.
    pub(super) fn new(folder: Option<&Path>, files: &Path) -> Self {
        let original = folder.map_or_else(|| files.join(STATE_DIR), Path::to_path_buf);
        let copy = std::env::temp_dir().join(format!("{PREFIX}{}-state", std::process::id()));
        Self { original, copy }
    }

    /// The folder for another run, which finds what is in the original.
    ///
    /// # Errors
    /// It cannot be copied.
    pub(super) fn begin(&self) -> Result<&Path, String> {
        let failed = |error: std::io::Error| format!("cannot copy {}: {error}", self.original.display());
        let _ = std::fs::remove_dir_all(&self.copy);
        std::fs::create_dir_all(&self.copy).map_err(failed)?;
        let Ok(entries) = std::fs::read_dir(&self.original) else { return Ok(&self.copy) };
        for entry in entries.filter_map(Result::ok).filter(|entry| entry.path().is_file()) {
            std::fs::copy(entry.path(), self.copy.join(entry.file_name())).map_err(failed)?;
        }
        Ok(&self.copy)
    }
}

impl Drop for State {
    fn drop(&mut self) {
        // It lies in the system's folder for files that go.
        let _ = std::fs::remove_dir_all(&self.copy);
    }
}
