//! Locks folders of the cache, so that one process at a time changes them.

use crate::build_failure;
use arl_terminal::failure::Failure;
use arl_terminal::progress::Progress;
use std::fs::{File, TryLockError};
use std::io::ErrorKind;
use std::path::Path;
use std::time::SystemTime;

/// A lock, held until dropped, or until the process becomes the program.
#[derive(Debug)]
pub struct Lock {
    _file: File,
}

impl Lock {
    /// Locks a folder, which is created if it does not exist, and records that it is used now. `words` is the text
    /// shown while waiting.
    ///
    /// # Errors
    /// The folder cannot be created or cannot be locked.
    pub fn take(folder: &Path, shared: bool, words: &str) -> Result<Self, Failure> {
        loop {
            std::fs::create_dir_all(folder).map_err(|error| unusable("make the folder", folder, &error))?;
            let path = folder.join(NAME);
            let lock = lock(&path, shared, words).map_err(|error| unusable("lock", &path, &error))?;
            // The process that held the lock may have removed the folder.
            if path.exists() {
                // If the time cannot be set, it is older than it should be: the folder is removed earlier and made
                // again.
                let _ = lock.set_modified(SystemTime::now());
                return Ok(Self { _file: lock });
            }
        }
    }

    /// Locks a folder that is not in use; `None` if it is. Does not record a use.
    pub(super) fn of_unused(folder: &Path) -> Option<Self> {
        let file = File::options().read(true).write(true).open(folder.join(NAME)).ok()?;
        match file.try_lock() {
            Ok(()) => Some(Self { _file: file }),
            Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => Some(Self { _file: file }),
            Err(_) => None,
        }
    }
}

/// The reason why a file or folder of the cache cannot be used, and what to do.
fn unusable(doing: &str, path: &Path, error: &std::io::Error) -> Failure {
    match Failure::io(doing, path, error) {
        Failure::Other(text) => Failure::Other(build_failure::of(&text).unwrap_or(text)),
        other => other,
    }
}

/// Opens the file of a lock, which is created if it does not exist. To start a program, read access is sufficient.
fn open(path: &Path, shared: bool) -> std::io::Result<File> {
    let opened = File::options().read(true).write(true).create(true).truncate(false).open(path);
    match opened {
        Err(error) if shared && is_read_only(&error) => File::open(path).map_err(|_| error),
        opened => opened,
    }
}

fn is_read_only(error: &std::io::Error) -> bool {
    matches!(error.kind(), ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem)
}

fn lock(path: &Path, shared: bool, words: &str) -> std::io::Result<File> {
    let file = open(path, shared)?;
    match if shared { file.try_lock_shared() } else { file.try_lock() } {
        Ok(()) => {}
        Err(TryLockError::WouldBlock) => {
            let _waiting = Progress::start(words);
            if shared { file.lock_shared() } else { file.lock() }?;
        }
        // A file system without locks: the user must avoid two runs at once there.
        Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {}
        Err(TryLockError::Error(error)) => return Err(error),
    }
    Ok(file)
}

/// Whether a folder has ever been locked: it then belongs to the cache.
pub(super) fn is_lockable(folder: &Path) -> bool {
    folder.join(NAME).is_file()
}

/// The time of the last use of a folder or a file, or of its creation if it was never locked. A time in the future
/// comes from a clock that was or is wrong: it counts as now, is set to now, and ages from now on. Otherwise anything
/// used at that time would stay longer than everything used since.
pub(super) fn last_use(path: &Path) -> Option<SystemTime> {
    let of = |path: &Path| std::fs::metadata(path).and_then(|data| data.modified()).ok();
    let lock = path.join(NAME);
    let (used, noted) = of(&lock).map(|used| (used, lock.as_path())).or_else(|| Some((of(path)?, path)))?;
    let now = SystemTime::now();
    if used > now {
        // If it cannot be set, it will be in the future the next time, too.
        let _ = File::options().write(true).open(noted).and_then(|file| file.set_modified(now));
    }
    Some(used.min(now))
}

const NAME: &str = "lock";

/// Sets the time of the last use of a folder of the cache.
#[cfg(test)]
pub(super) fn used_at(folder: &Path, when: SystemTime) {
    let lock = File::options().write(true).open(folder.join(NAME)).expect("the lock");
    lock.set_modified(when).expect("the time is set");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn what_cannot_be_used_is_reported_with_what_to_do() {
        for (code, help) in [
            (13, "set ARL2RS_CACHE to a folder that can be written"),
            (30, "set ARL2RS_CACHE to a folder that can be written"),
            (28, "free some space; `arl2rs clean` removes what was compiled"),
        ] {
            let error = std::io::Error::from_raw_os_error(code);
            let message = unusable("lock", Path::new("/cache/lock"), &error).to_string();
            assert!(
                message.contains("cannot lock /cache/lock") && message.ends_with(&format!("help: {help}")),
                "{message}"
            );
        }
    }
}
