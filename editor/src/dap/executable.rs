//! The session's own copy of the compiled program: others may compile it again in the meantime, and stepping back runs
//! it again.

use super::leftovers::PREFIX;
use arl_project::program::Ready;
use arl_terminal::private_folder::PrivateFolder;
use std::path::{Path, PathBuf};

/// A copy that is removed with the session.
pub(super) struct Executable {
    path: PathBuf,
    _folder: PrivateFolder,
}

impl Executable {
    /// Copies a program.
    ///
    /// # Errors
    /// The program cannot be copied.
    pub(super) fn of(ready: &Ready) -> Result<Self, String> {
        let folder = PrivateFolder::new(PREFIX)
            .map_err(|error| format!("cannot make a temporary folder for the program: {error}"))?;
        let path = folder.path().join(format!("program{}", std::env::consts::EXE_SUFFIX));
        std::fs::hard_link(&ready.program, &path)
            .or_else(|_| std::fs::copy(&ready.program, &path).map(|_| ()))
            .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
        Ok(Self { path, _folder: folder })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }
}
