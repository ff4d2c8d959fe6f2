//! Peers: commands that may not be installed.

use std::ffi::OsString;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// A Python that has these modules; nothing, and a word about it, where it is missing.
///
/// # Panics
/// It is missing though it is required.
pub(crate) fn python(modules: &[&str]) -> Option<OsString> {
    let python = std::env::var_os("ARL_PEERS_PYTHON").unwrap_or_else(|| "python3".into());
    let import = format!("import {}", modules.join(", "));
    let found = Command::new(&python).args(["-c", &import]).stderr(Stdio::null()).status();
    if found.is_ok_and(|status| status.success()) {
        return Some(python);
    }
    missing(&format!("{} with {}", python.to_string_lossy(), modules.join(", ")));
    None
}

/// Whether a command is there.
///
/// # Panics
/// It is missing though it is required.
pub(crate) fn command(name: &str) -> bool {
    let found = Command::new(name).arg("-h").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok();
    if !found {
        missing(name);
    }
    found
}

fn missing(what: &str) {
    assert!(std::env::var("ARL_PEERS").as_deref() != Ok("required"), "{what} is not installed");
    eprintln!("skipped: {what} is not installed");
}

/// A script of this test.
pub(crate) fn script(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("peers/scripts").join(name)
}

/// A peer that serves until it is dropped.
pub(crate) struct Server {
    child: Child,
    /// The first line that it said: where it listens.
    pub(crate) first_line: String,
}

impl Server {
    /// Starts it; its first line on the standard output says that it is ready.
    pub(crate) fn start(command: &mut Command) -> Self {
        let mut child = command.stdout(Stdio::piped()).spawn().expect("a peer");
        let mut first_line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut first_line).unwrap();
        Self { child, first_line: first_line.trim().into() }
    }
}

impl Server {
    /// Starts one that says nothing.
    pub(crate) fn spawn(command: &mut Command) -> Self {
        Self { child: command.spawn().expect("a peer"), first_line: String::new() }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
