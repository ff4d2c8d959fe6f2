//! The command `arl2rs`, as it is now.

use std::path::PathBuf;
use std::process::{Command, Stdio};

/// The command, and a folder with a build cache of its own.
pub struct Place {
    /// The command.
    pub command: PathBuf,
    /// The folder, which stays: what was compiled there is not compiled again.
    pub folder: PathBuf,
}

impl Place {
    /// Builds the command, and makes the folder for a bench of this name.
    ///
    /// # Errors
    /// Cargo fails, or there is no such folder.
    pub fn new(name: &str) -> Result<Self, String> {
        let command = build()?;
        let folder = std::env::temp_dir().join(format!("arl-benches-{name}"));
        std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
        Ok(Self { command, folder })
    }

    /// The command with these words, in the folder.
    pub fn arl2rs(&self, words: &[&str]) -> Command {
        let mut command = Command::new(&self.command);
        command.args(words).env("ARL2RS_CACHE", self.folder.join("cache")).current_dir(&self.folder);
        command
    }
}

/// Builds the command with optimisation, and gives its path.
///
/// # Errors
/// Cargo fails, or makes no command next to the bench that asks.
pub fn build() -> Result<PathBuf, String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let arguments = ["build", "--quiet", "--release", "-p", "arl2rs-cli"];
    let status = Command::new(cargo).args(arguments).stdin(Stdio::null()).status();
    if !status.map_err(|error| error.to_string())?.success() {
        return Err("cargo could not build arl2rs".into());
    }
    // A bench lies in target/release/deps.
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let command = own.ancestors().nth(2).map(|folder| folder.join("arl2rs")).filter(|path| path.is_file());
    command.ok_or_else(|| "cargo made no arl2rs next to this bench".into())
}
