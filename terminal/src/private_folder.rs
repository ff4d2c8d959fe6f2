//! Folders in the system's folder for temporary files. Any user can write there: so each folder is a new one,
//! inaccessible to other users.

use std::fs::DirBuilder;
use std::io::{ErrorKind, Result};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// The folders of this process.
static FOLDERS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Creates folders that only this user may enter.
#[cfg(unix)]
fn private() -> DirBuilder {
    let mut make = DirBuilder::new();
    std::os::unix::fs::DirBuilderExt::mode(&mut make, 0o700);
    make
}

/// On Windows the folder for temporary files is the user's own.
#[cfg(not(unix))]
fn private() -> DirBuilder {
    DirBuilder::new()
}

/// Removes all folders of a process that ends without dropping them.
pub(crate) fn remove_all() {
    let folders = std::mem::take(&mut *FOLDERS.lock().unwrap_or_else(PoisonError::into_inner));
    folders.iter().for_each(|folder| drop(std::fs::remove_dir_all(folder)));
}

/// A folder that is removed when dropped.
#[derive(Debug)]
pub struct PrivateFolder(PathBuf);

impl PrivateFolder {
    /// Creates a new folder whose name begins with `prefix`, followed by the numbers of the process and of the folder.
    ///
    /// # Errors
    /// The folder cannot be created.
    pub fn new(prefix: &str) -> Result<Self> {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        let make = private();
        loop {
            let number = NEXT.fetch_add(1, Ordering::Relaxed);
            let path = std::env::temp_dir().join(format!("{prefix}{}-{number}", std::process::id()));
            match make.create(&path) {
                // It belongs to another user, or to a process with the same number that has ended.
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                made => {
                    made?;
                    FOLDERS.lock().unwrap_or_else(PoisonError::into_inner).push(path.clone());
                    return Ok(Self(path));
                }
            }
        }
    }

    /// The path of the folder.
    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for PrivateFolder {
    fn drop(&mut self) {
        // The system removes what is left.
        let _ = std::fs::remove_dir_all(&self.0);
        FOLDERS.lock().unwrap_or_else(PoisonError::into_inner).retain(|folder| *folder != self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nobody_else_gets_into_a_new_folder() {
        let prefix = "arl2rs-private-test-";
        // The next folders already exist, one of them as a link.
        let taken = |number: u64| std::env::temp_dir().join(format!("{prefix}{}-{number}", std::process::id()));
        let first = PrivateFolder::new(prefix).expect("a folder");
        let name = first.path().display().to_string();
        let own: u64 = name.rsplit('-').next().and_then(|number| number.parse().ok()).expect("a number");
        let numbers = own + 1..own + 64;
        numbers.clone().for_each(|number| {
            #[cfg(unix)]
            std::os::unix::fs::symlink("/nowhere", taken(number)).expect("a link");
            #[cfg(not(unix))]
            std::fs::create_dir(taken(number)).expect("a folder");
        });
        let folder = PrivateFolder::new(prefix).expect("a folder");
        assert!(numbers.clone().all(|number| taken(number) != folder.path()), "{folder:?}");
        #[cfg(unix)]
        {
            let mode =
                std::os::unix::fs::PermissionsExt::mode(&folder.path().metadata().expect("it is there").permissions());
            assert_eq!(mode & 0o777, 0o700);
        }
        let path = folder.path().to_path_buf();
        drop(folder);
        assert!(!path.exists());
        drop(first);
        numbers.for_each(|number| {
            let _ = std::fs::remove_file(taken(number)).or_else(|_| std::fs::remove_dir(taken(number)));
        });
    }
}
