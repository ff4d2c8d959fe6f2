//! Files are replaced atomically: they are there whole, old or new, at whatever moment their writer is killed.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// How the name of a file ends that is to take the place of another one: `NAME.PROCESS-NUMBER` and this. No user calls a file so.
const BESIDE: &str = ".arl-new";

/// Writes a file so that a kill at any moment leaves the old or the new content, whole: to a file beside it, which
/// then takes its name.
///
/// # Errors
/// What the file system says; the old content is still there.
pub fn write(path: &Path, content: &[u8]) -> io::Result<()> {
    /// Several threads may write the same file.
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    let mut beside = path.as_os_str().to_owned();
    beside.push(format!(".{}-{}{BESIDE}", std::process::id(), NUMBER.fetch_add(1, Ordering::Relaxed)));
    let beside = PathBuf::from(beside);
    let written = (|| {
        let mut file = create_held(&beside)?;
        file.write_all(content)?;
        file.sync_all()?;
        fs::rename(&beside, path)
    })();
    if written.is_err() {
        // It is of no use to anybody; that it cannot be removed changes nothing.
        let _ = fs::remove_file(&beside);
        return written;
    }
    // The new name is on the disk when its directory is. Some systems cannot sync a directory; they do it themselves.
    if let Ok(directory) = fs::File::open(directory_of(path)) {
        let _ = directory.sync_all();
    }
    Ok(())
}

/// The directory that a file lies in.
pub fn directory_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Makes a file and holds its lock: as long as this process lives and has the file open, nobody takes it for abandoned.
fn create_held(path: &Path) -> io::Result<fs::File> {
    loop {
        let file = fs::File::create(path)?;
        // Where files cannot be locked none is taken for abandoned.
        if file.lock().is_err() || path.exists() {
            return Ok(file);
        }
        // Somebody has removed it before it was locked.
    }
}

/// Removes from a directory what processes that were killed while they wrote have left there.
pub fn remove_leftovers(directory: &Path) {
    // What cannot be looked at or removed stays: it does no harm.
    let Ok(entries) = fs::read_dir(directory) else { return };
    for entry in entries.filter_map(Result::ok) {
        if is_in_the_making(&entry.file_name().to_string_lossy()) {
            remove_abandoned(&entry.path());
        }
    }
}

fn is_in_the_making(name: &str) -> bool {
    let named = name.strip_suffix(BESIDE).and_then(|name| name.rsplit_once('.'));
    named.is_some_and(|(name, process)| {
        !name.is_empty() && !process.is_empty() && process.bytes().all(|byte| byte.is_ascii_digit() || byte == b'-')
    })
}

/// Removes a file that nobody holds.
fn remove_abandoned(path: &Path) {
    if let Ok(file) = fs::File::open(path)
        && file.try_lock().is_ok()
    {
        let _ = fs::remove_file(path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn folder(name: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("arl-robot-whole-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        path
    }

    fn names(path: &Path) -> BTreeSet<String> {
        fs::read_dir(path).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn what_the_dead_have_left_is_removed_and_what_the_living_make_is_not() {
        let path = folder("left");
        // This process stands for another one that lives: it holds its file.
        let alive = create_held(&path.join("I.state.17.arl-new")).unwrap();
        for name in ["I.state.1.arl-new", "BASE.2.state.12345678.arl-new", "p_data.arl.3.arl-new"] {
            fs::write(path.join(name), "part").unwrap();
        }
        let others = ["I.state", "I.state.arl-new", "I.state.1a.arl-new", "1.arl-new", "log.2024.new", "p_data.arl"];
        for name in others {
            fs::write(path.join(name), "a user's").unwrap();
        }
        remove_leftovers(&path);
        let mut left: BTreeSet<String> = others.map(String::from).into();
        left.insert("I.state.17.arl-new".into());
        assert_eq!(names(&path), left);
        drop(alive);
        remove_leftovers(&path);
        assert!(!names(&path).contains("I.state.17.arl-new"));
        remove_leftovers(&path.join("nowhere"));
        fs::remove_dir_all(&path).unwrap();
    }

    #[test]
    fn nothing_is_left_beside_a_file() {
        let path = folder("beside");
        for content in ["one", "two"] {
            write(&path.join("a.txt"), content.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(path.join("a.txt")).unwrap(), content);
        }
        fs::create_dir(path.join("b")).unwrap();
        assert!(write(&path.join("b"), b"no file").is_err());
        assert_eq!(names(&path), ["a.txt", "b"].map(String::from).into());
        fs::remove_dir_all(&path).unwrap();
    }

    #[test]
    fn threads_that_write_one_file_leave_it_whole() {
        let folder = folder("threads");
        let path = folder.join("kept");
        let texts = [[b'a'; 4096], [b'b'; 4096]];
        std::thread::scope(|scope| {
            for text in &texts {
                scope.spawn(|| (0..50).for_each(|_| write(&path, text).unwrap()));
            }
            for _ in 0..50 {
                let read = fs::read(&path).unwrap_or_else(|_| texts[0].into());
                assert!(texts.iter().any(|text| read == text), "{} bytes", read.len());
            }
        });
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "nothing is left beside it");
        fs::remove_dir_all(&folder).unwrap();
    }
}
