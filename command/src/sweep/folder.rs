//! The folder in which a worker's program runs; before each run it is restored to that of the bundle.

use super::bundle::{Bundle, CODE, PROGRAM};
use arl_project::cache::Content;
use arl_project::program::command_of_code;
use arl_terminal::private_folder::PrivateFolder;
use std::fs::File;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant, SystemTime};

/// A bundle on the disk: its program once, its other files for each worker.
#[derive(Clone, Debug)]
pub struct Spread {
    files: Arc<Vec<(String, Vec<u8>)>>,
    /// The program, which is written again if it is damaged.
    program: Arc<Vec<u8>>,
    /// Its name: [`PROGRAM`] or [`CODE`].
    name: &'static str,
    root: Arc<Root>,
}

/// A folder that is removed with its last owner. A file in it is locked as long as there is an owner: what an owner
/// that was killed has left is removed when the next folder is made.
#[derive(Debug)]
struct Root {
    folder: PrivateFolder,
    _lock: File,
}

/// How the names of these folders begin, before a number.
const ROOT: &str = "arl2rs-sweep-";
/// The file that is locked while a folder is made.
const TURN: &str = "arl2rs-sweeps.lock";
/// The most time that making a folder takes.
const LONGEST_TURN: Duration = Duration::from_secs(2);
/// The file that is locked.
const LOCK: &str = "lock";

impl Root {
    fn new() -> io::Result<Self> {
        let turn = turn();
        if turn.is_some() {
            remove_abandoned();
        }
        let folder = PrivateFolder::new(ROOT)?;
        let lock = File::create(folder.path().join(LOCK))?;
        lock.lock()?;
        Ok(Self { folder, _lock: lock })
    }
}

/// As long as this value lives, no other process removes what was left: it would mistake a folder that is not locked
/// yet for a leftover. `None` if the file is another user's, who cannot remove our folder either, or stays locked: no
/// sweep waits for that.
fn turn() -> Option<File> {
    let path = std::env::temp_dir().join(TURN);
    let file = File::options().write(true).create(true).truncate(false).open(path).ok()?;
    let until = Instant::now() + LONGEST_TURN;
    while file.try_lock().is_err() {
        if Instant::now() >= until {
            return None;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    Some(file)
}

/// Removes folders whose owners are gone.
fn remove_abandoned() {
    let Ok(entries) = std::fs::read_dir(std::env::temp_dir()) else { return };
    let ours = entries.filter_map(Result::ok).filter(|entry| entry.file_name().to_string_lossy().starts_with(ROOT));
    for folder in ours.map(|entry| entry.path()) {
        let is_abandoned = File::open(folder.join(LOCK)).is_ok_and(|lock| lock.try_lock().is_ok());
        if is_abandoned {
            let _ = std::fs::remove_dir_all(&folder);
        }
    }
}

impl Spread {
    /// Writes the program into a new folder.
    ///
    /// # Errors
    /// The program cannot be written.
    pub fn new(bundle: &Bundle) -> io::Result<Self> {
        Self::of(bundle.files.clone())
    }

    /// The same for the files of a bundle.
    ///
    /// # Errors
    /// They cannot be written, or include no program.
    pub fn of(mut files: Vec<(String, Vec<u8>)>) -> io::Result<Self> {
        let is_inside = |place: &str| Path::new(place).components().all(|part| matches!(part, Component::Normal(_)));
        if let Some((place, _)) = files.iter().find(|(place, _)| !is_inside(place)) {
            return Err(io::Error::other(format!("{place} lies outside of the bundle")));
        }
        let root = Root::new()?;
        files.sort();
        let found = files
            .iter()
            .enumerate()
            .find_map(|(at, (path, _))| [PROGRAM, CODE].into_iter().find(|name| path == name).map(|name| (at, name)));
        let (at, name) = found.ok_or_else(|| io::Error::other("the bundle has no program"))?;
        let (_, program) = files.remove(at);
        let spread = Self { files: Arc::new(files), program: Arc::new(program), name, root: Arc::new(root) };
        spread.write_program()?;
        Ok(spread)
    }

    /// Writes the program to the disk. A running program cannot be written over, but another file can take its name.
    fn write_program(&self) -> io::Result<()> {
        static NEXT: AtomicUsize = AtomicUsize::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let beside = self.root.folder.path().join(format!("{}-{number}", self.name));
        std::fs::write(&beside, &**self.program)?;
        #[cfg(unix)]
        std::fs::set_permissions(&beside, std::os::unix::fs::PermissionsExt::from_mode(0o755))?;
        arl_robot::renaming::rename(&beside, &self.root.folder.path().join(self.name))
    }
}

/// The modification time of the files that no run has changed.
const LONG_AGO: SystemTime = SystemTime::UNIX_EPOCH;

/// The folder of a worker.
#[derive(Debug)]
pub(super) struct Folder {
    spread: Spread,
    path: PathBuf,
    /// The files as they were written: path, length, time.
    written: Vec<Seen>,
}

type Seen = (PathBuf, u64, Option<SystemTime>);

impl Folder {
    pub(super) fn new(spread: &Spread) -> io::Result<Self> {
        static NEXT: AtomicUsize = AtomicUsize::new(1);
        let path = spread.root.folder.path().join(NEXT.fetch_add(1, Ordering::Relaxed).to_string());
        let mut folder = Self { spread: spread.clone(), path, written: Vec::new() };
        folder.write()?;
        Ok(folder)
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The command that runs the program, as it was put into the bundle.
    ///
    /// # Errors
    /// The program is damaged, and cannot be written again.
    pub(super) fn program(&self) -> io::Result<Command> {
        let path = self.spread.root.folder.path().join(self.spread.name);
        if !Content::of(&self.spread.program).is_in(&path) {
            self.spread.write_program()?;
        }
        match self.spread.name {
            CODE => command_of_code(&path).map_err(|failure| io::Error::other(failure.to_string())),
            _ => Ok(Command::new(path)),
        }
    }

    /// Restores the folder to that of the bundle, if a run has changed something.
    pub(super) fn restore(&mut self) -> io::Result<()> {
        let mut seen = Vec::new();
        if look(&self.path, &mut seen).is_ok() {
            seen.sort();
            if seen == self.written {
                return Ok(());
            }
        }
        // The folder itself stays: a process works in it.
        for entry in std::fs::read_dir(&self.path)? {
            let path = entry?.path();
            if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) }?;
        }
        self.write()
    }

    fn write(&mut self) -> io::Result<()> {
        std::fs::create_dir_all(&self.path)?;
        for (place, bytes) in self.spread.files.iter() {
            let path = self.path.join(place);
            path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
            std::fs::write(&path, bytes)?;
            // So that a change within a tick of the disk's clock is seen, too.
            File::options().write(true).open(&path)?.set_modified(LONG_AGO)?;
        }
        self.written.clear();
        look(&self.path, &mut self.written)?;
        self.written.sort();
        Ok(())
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // It is removed with the root at the latest.
        let _ = std::fs::remove_dir_all(&self.path);
    }
}

/// All files and folders in a folder.
fn look(folder: &Path, seen: &mut Vec<Seen>) -> io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let about = entry.metadata()?;
        if about.is_dir() {
            look(&entry.path(), seen)?;
            seen.push((entry.path(), 0, None));
        } else {
            seen.push((entry.path(), about.len(), about.modified().ok()));
        }
    }
    Ok(())
}
