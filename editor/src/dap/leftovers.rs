//! What adapters that were killed have left in the system's folder for temporary files.

use std::path::Path;

/// How their names begin; the number of the process follows.
pub(super) const PREFIX: &str = "arl2rs-debug-";

/// Removes what belongs to processes that are gone, where the system lists its processes.
pub(super) fn sweep() {
    let processes = Path::new("/proc");
    if !processes.join(std::process::id().to_string()).is_dir() {
        return;
    }
    let Ok(entries) = std::fs::read_dir(std::env::temp_dir()) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let Some((process, _)) = name.strip_prefix(PREFIX).and_then(|rest| rest.split_once('-')) else { continue };
        let is_number = !process.is_empty() && process.bytes().all(|digit| digit.is_ascii_digit());
        if is_number && !processes.join(process).exists() {
            // Another process may be removing it, too, or it may belong to another user.
            let path = entry.path();
            let _ = if path.is_dir() { std::fs::remove_dir_all(&path) } else { std::fs::remove_file(&path) };
        }
    }
}
