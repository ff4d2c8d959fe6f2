//! The session's own copy of the program: others may make it again in the meantime, and stepping back runs it again.

use super::leftovers::PREFIX;
use arl_project::program::{Ready, command_of_code};
use arl_terminal::private_folder::PrivateFolder;
use std::path::PathBuf;
use std::process::Command;

/// A copy that is removed with the session.
pub(super) struct Executable {
    /// The copy of the program, or of its code.
    path: PathBuf,
    is_code: bool,
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
        let original = ready.code.as_ref().unwrap_or(&ready.program);
        std::fs::hard_link(original, &path)
            .or_else(|_| std::fs::copy(original, &path).map(|_| ()))
            .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
        Ok(Self { path, is_code: ready.code.is_some(), _folder: folder })
    }

    /// The command that runs it.
    ///
    /// # Errors
    /// It is not known how this command is started.
    pub(super) fn command(&self) -> Result<Command, String> {
        if self.is_code {
            command_of_code(&self.path).map_err(|failure| failure.to_string())
        } else {
            Ok(Command::new(&self.path))
        }
    }
}
