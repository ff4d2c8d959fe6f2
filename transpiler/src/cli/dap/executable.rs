//! The session's own copy of the compiled program: others may compile it anew in the meantime, and the way back runs it again.

use super::remains::PREFIX;
use crate::cli::program::Ready;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// A copy that goes with the session.
pub(super) struct Executable(PathBuf);

static COPIES: AtomicU64 = AtomicU64::new(0);

impl Executable {
    /// Copies a program.
    ///
    /// # Errors
    /// It cannot be copied.
    pub(super) fn of(ready: &Ready) -> Result<Self, String> {
        let number = COPIES.fetch_add(1, Ordering::Relaxed);
        let name = format!("{PREFIX}{}-{number}{}", std::process::id(), std::env::consts::EXE_SUFFIX);
        let copy = std::env::temp_dir().join(name);
        let failed = |error: std::io::Error| format!("cannot write {}: {error}", copy.display());
        // What lies there is of a process of the same number that has ended.
        let _ = std::fs::remove_file(&copy);
        std::fs::hard_link(&ready.program, &copy)
            .or_else(|_| std::fs::copy(&ready.program, &copy).map(|_| ()))
            .map_err(failed)?;
        Ok(Self(copy))
    }

    pub(super) fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Executable {
    fn drop(&mut self) {
        // It lies in the system's folder for files that go.
        let _ = std::fs::remove_file(&self.0);
    }
}
