//! The command `arl2rs`, as it is now.

use std::path::PathBuf;
use std::process::{Command, Stdio};

/// Builds the command with optimisation, and gives its path.
///
/// # Errors
/// Cargo fails, or makes no command next to the bench that asks.
pub fn build() -> Result<PathBuf, String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let arguments = ["build", "--quiet", "--release", "-p", "arl2rs"];
    let status = Command::new(cargo).args(arguments).stdin(Stdio::null()).status();
    if !status.map_err(|error| error.to_string())?.success() {
        return Err("cargo could not build arl2rs".into());
    }
    // A bench lies in target/release/deps.
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let command = own.ancestors().nth(2).map(|folder| folder.join("arl2rs")).filter(|path| path.is_file());
    command.ok_or_else(|| "cargo made no arl2rs next to this bench".into())
}
