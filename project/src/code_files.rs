//! Files with the code of programs, in their places of the cache or, where there is none, in folders of their own.

use crate::cache::Place;
use arl_terminal::failure::Failure;
use arl_terminal::private_folder::PrivateFolder;
use std::hash::{BuildHasher, DefaultHasher, Hash, Hasher, RandomState};
use std::path::PathBuf;
use std::time::Duration;

/// How the names of files with the code of a program begin, in its place of the cache: as no program is called.
pub(crate) const CODE: &str = ".code-";
/// How long old code is kept for processes that are about to read it.
const OLD_CODE: Duration = Duration::from_secs(3600);

/// Writes code under a name of its own, so that other processes keep reading what they were started with.
pub(crate) fn write(place: &Place, bytes: &[u8]) -> Result<PathBuf, Failure> {
    let mut hasher = DefaultHasher::new();
    bytes.hash(&mut hasher);
    let path = place.folder.join(format!("{CODE}{:016x}", hasher.finish()));
    let written = || -> std::io::Result<()> {
        std::fs::create_dir_all(&place.folder)?;
        for entry in std::fs::read_dir(&place.folder)?.filter_map(Result::ok) {
            let is_code = entry.file_name().to_string_lossy().starts_with(CODE);
            let age = entry.metadata().and_then(|about| about.modified()).ok().and_then(|time| time.elapsed().ok());
            if is_code && age > Some(OLD_CODE) {
                // A file that cannot be removed now is removed next time.
                let _ = std::fs::remove_file(entry.path());
            }
        }
        // Anew each time, because alarms show the lines of files that are no newer than the code; and under another
        // name first, because several processes and threads may write at once.
        let fresh = place.folder.join(format!("{CODE}{:016x}.new", RandomState::new().hash_one(std::process::id())));
        std::fs::write(&fresh, bytes)?;
        arl_robot::renaming::rename(&fresh, &path)
    };
    match written() {
        // Where nothing can be written, code that is there is as good.
        Err(_) if std::fs::read(&path).is_ok_and(|kept| kept == bytes) => Ok(path),
        Err(error) => Err(Failure::io("write", &path, &error)),
        Ok(()) => Ok(path),
    }
}

/// Writes code where there is no cache: into a folder of its own.
pub(crate) fn write_apart(bytes: &[u8]) -> Result<(PathBuf, PrivateFolder), Failure> {
    let folder = PrivateFolder::new("arl2rs-code-")
        .map_err(|error| Failure::Other(format!("cannot make a temporary folder for the program: {error}")))?;
    let path = folder.path().join("program");
    std::fs::write(&path, bytes).map_err(|error| Failure::io("write", &path, &error))?;
    Ok((path, folder))
}
