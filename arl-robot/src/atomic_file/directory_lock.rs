//! Locks that those who replace files of a directory hold meanwhile.

use std::fs::{File, TryLockError};
use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

/// The longest wait for other writers that replace files of the same directory.
const LONGEST_WAIT: Duration = Duration::from_secs(5);

/// Waits until no other user of this module replaces files of a directory. `None` if directories cannot be locked: then
/// files written meanwhile are only noticed.
pub(super) fn lock(directory: &Path) -> io::Result<Option<File>> {
    let Some(lock) = lockable(directory) else { return Ok(None) };
    let began = Instant::now();
    loop {
        match lock.try_lock() {
            Ok(()) => return Ok(Some(lock)),
            Err(TryLockError::WouldBlock) if began.elapsed() < LONGEST_WAIT => {
                std::thread::sleep(Duration::from_millis(1));
            }
            Err(TryLockError::WouldBlock) => {
                return Err(io::Error::new(io::ErrorKind::TimedOut, "another program keeps its directory locked"));
            }
            Err(TryLockError::Error(_)) => return Ok(None),
        }
    }
}

/// What is locked for a directory: itself.
#[cfg(not(windows))]
fn lockable(directory: &Path) -> Option<File> {
    File::open(directory).ok()
}

/// What is locked for a directory, which Windows does not open as a file: a file for it among the temporary ones of the
/// user. So writers of other users are not kept out, only noticed.
#[cfg(windows)]
fn lockable(directory: &Path) -> Option<File> {
    // FNV-1a: the same in all versions of this module.
    let add = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    let place = directory.canonicalize().ok()?;
    let name = place.as_os_str().as_encoded_bytes().iter().fold(0xcbf2_9ce4_8422_2325, add);
    let folder = std::env::temp_dir().join("arl2rs-locks");
    std::fs::create_dir_all(&folder).ok()?;
    let path = folder.join(format!("{name:016x}"));
    File::options().write(true).create(true).truncate(false).open(path).ok()
}
