//! The session's own copy of the program: others may make it again in the meantime, and stepping back runs it again.

use super::leftovers::PREFIX;
use arl_project::program::{Ready, command_of_code};
use arl_terminal::private_folder::PrivateFolder;
use std::path::PathBuf;
use std::process::Command;

/// A copy that is removed with the session.
pub(super) struct Executable {
    /// The copy of the program's code.
    path: PathBuf,
    _folder: PrivateFolder,
}

impl Executable {
    /// Copies the code of a program.
    ///
    /// # Errors
    /// The program cannot be copied.
    pub(super) fn of(ready: &Ready) -> Result<Self, String> {
        let folder = PrivateFolder::new(PREFIX)
            .map_err(|error| format!("cannot make a temporary folder for the program: {error}"))?;
        let path = folder.path().join("program");
        let original = ready.code.as_ref().ok_or("the program is not code")?;
        std::fs::hard_link(original, &path)
            .or_else(|_| std::fs::copy(original, &path).map(|_| ()))
            .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
        Ok(Self { path, _folder: folder })
    }

    /// The command that runs it.
    ///
    /// # Errors
    /// It is not known how this command is started.
    pub(super) fn command(&self) -> Result<Command, String> {
        command_of_code(&self.path).map_err(|failure| failure.to_string())
    }
}
