//! What is kept when the controller is switched off: one file for each system variable, and one for where the programs stand.

use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Where kept values live, by name.
pub trait Storage {
    /// Called when a controller starts, before anything is loaded: removes what a process that was killed has left behind.
    fn begin(&mut self) {}

    /// What was stored under this name last; nothing where nothing was.
    ///
    /// # Errors
    /// It is there, but cannot be read.
    fn load(&self, name: &str) -> io::Result<Option<Vec<u8>>>;

    /// Stores under this name. Whatever happens meanwhile, afterwards the old or the new content is there, whole.
    ///
    /// # Errors
    /// It cannot be stored; then the old content is still there.
    fn store(&mut self, name: &str, content: &[u8]) -> io::Result<()>;

    /// Another way to the same values, for a thread that stores beside the cycle. Without one, what changes all the time is not
    /// kept: where the programs stand.
    fn another(&self) -> Option<Box<dyn Storage + Send>> {
        None
    }

    /// How messages name the place of this name.
    fn place(&self, name: &str) -> String {
        name.to_owned()
    }
}

/// Keeps values for as long as it lives.
#[derive(Clone, Default, Debug)]
pub struct Memory(BTreeMap<String, Vec<u8>>);

impl Storage for Memory {
    fn load(&self, name: &str) -> io::Result<Option<Vec<u8>>> {
        Ok(self.0.get(name).cloned())
    }

    fn store(&mut self, name: &str, content: &[u8]) -> io::Result<()> {
        self.0.insert(name.to_owned(), content.to_vec());
        Ok(())
    }
}

/// Keeps values as files of a directory, which is made when the first one is stored.
#[derive(Clone, Debug)]
pub struct Directory(PathBuf);

impl Directory {
    /// The state directory at this path.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self(path.into())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(format!("{name}.state"))
    }
}

/// What the files are called that [`write_whole`] makes for state files: `NAME.state.PROCESS.new`.
fn is_in_the_making(name: &str) -> bool {
    let process = name.strip_suffix(BESIDE).and_then(|name| name.rsplit_once(".state."));
    process.is_some_and(|(_, process)| !process.is_empty() && process.bytes().all(|byte| byte.is_ascii_digit()))
}

impl Storage for Directory {
    fn begin(&mut self) {
        // What cannot be looked at or removed stays: it does no harm.
        let Ok(entries) = fs::read_dir(&self.0) else { return };
        for entry in entries.filter_map(Result::ok) {
            if is_in_the_making(&entry.file_name().to_string_lossy()) {
                remove_abandoned(&entry.path());
            }
        }
    }

    fn load(&self, name: &str) -> io::Result<Option<Vec<u8>>> {
        match fs::read(self.path(name)) {
            Ok(content) => Ok(Some(content)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error),
        }
    }

    fn store(&mut self, name: &str, content: &[u8]) -> io::Result<()> {
        fs::create_dir_all(&self.0)?;
        write_whole(&self.path(name), content)
    }

    fn another(&self) -> Option<Box<dyn Storage + Send>> {
        Some(Box::new(self.clone()))
    }

    fn place(&self, name: &str) -> String {
        self.path(name).display().to_string()
    }
}

/// How the name of a file ends that is to take the place of another one.
const BESIDE: &str = ".new";

/// Writes a file so that a kill at any moment leaves the old or the new content, whole: to a file beside it, which
/// then takes its name.
///
/// # Errors
/// What the file system says; the old content is still there.
pub(crate) fn write_whole(path: &Path, content: &[u8]) -> io::Result<()> {
    let directory = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut beside = path.as_os_str().to_owned();
    beside.push(format!(".{}{BESIDE}", std::process::id()));
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
    if let Ok(directory) = fs::File::open(directory) {
        let _ = directory.sync_all();
    }
    Ok(())
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

/// Removes a file that nobody holds.
fn remove_abandoned(path: &Path) {
    if let Ok(file) = fs::File::open(path)
        && file.try_lock().is_ok()
    {
        let _ = fs::remove_file(path);
    }
}

/// Why the state of the controller cannot be read or written.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct StateError {
    /// The file.
    pub place: String,
    /// What is wrong with it.
    pub problem: String,
}

impl fmt::Display for StateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.problem)
    }
}

impl std::error::Error for StateError {}

/// The kept values, with what is known to be stored.
pub(crate) struct State {
    storage: Box<dyn Storage>,
    known: BTreeMap<&'static str, String>,
}

impl State {
    pub(crate) fn new(mut storage: Box<dyn Storage>) -> Self {
        storage.begin();
        Self { storage, known: BTreeMap::new() }
    }

    /// The value that was saved last, as far as this controller knows.
    pub(crate) fn known(&self, name: &str) -> Option<&str> {
        self.known.get(name).map(String::as_str)
    }

    /// Reads a value.
    pub(crate) fn load(&mut self, name: &'static str) -> Result<Option<String>, StateError> {
        let content = self.storage.load(name).map_err(|error| self.error(name, format!("cannot be read: {error}")))?;
        let Some(content) = content else { return Ok(None) };
        let text = unseal(name, &content).ok_or_else(|| self.damaged(name))?;
        self.known.insert(name, text.to_owned());
        Ok(Some(text.to_owned()))
    }

    /// Writes a value.
    pub(crate) fn save(&mut self, name: &'static str, text: String) -> Result<(), StateError> {
        store(&mut *self.storage, name, &text)?;
        self.known.insert(name, text);
        Ok(())
    }

    /// Another way to the same values, for a thread.
    pub(crate) fn another(&self) -> Option<Box<dyn Storage + Send>> {
        self.storage.another()
    }

    pub(crate) fn damaged(&self, name: &str) -> StateError {
        self.error(name, "the file is damaged; remove it to start with the default".to_owned())
    }

    fn error(&self, name: &str, problem: String) -> StateError {
        StateError { place: self.storage.place(name), problem }
    }
}

/// Stores a text so that damage is noticed when it is read.
pub(crate) fn store(storage: &mut dyn Storage, name: &str, text: &str) -> Result<(), StateError> {
    storage.store(name, seal(name, text).as_bytes()).map_err(|error| {
        let problem = format!("cannot be written: {error}");
        StateError { place: storage.place(name), problem }
    })
}

/// The text with a last line that tells whether it is whole, and this variable's.
fn seal(name: &str, text: &str) -> String {
    format!("{text}check {:016x}\n", check(name, text))
}

fn unseal<'a>(name: &str, content: &'a [u8]) -> Option<&'a str> {
    let text = std::str::from_utf8(content).ok()?.strip_suffix('\n')?;
    let (body, sum) = text.rsplit_once("check ")?;
    (u64::from_str_radix(sum, 16) == Ok(check(name, body))).then_some(body)
}

/// FNV-1a.
fn check(name: &str, text: &str) -> u64 {
    name.bytes()
        .chain([0])
        .chain(text.bytes())
        .fold(0xcbf2_9ce4_8422_2325, |sum, byte| (sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_damaged_is_noticed() {
        let whole = seal("$A", "1\n2\n3\n");
        assert_eq!(unseal("$A", whole.as_bytes()), Some("1\n2\n3\n"));
        assert_eq!(unseal("$B", whole.as_bytes()), None, "another variable's");
        for cut in 0..whole.len() {
            assert_eq!(unseal("$A", &whole.as_bytes()[..cut]), None, "cut at {cut}");
        }
        for at in 0..whole.len() - 1 {
            let mut changed = whole.clone().into_bytes();
            changed[at] ^= 1;
            assert_eq!(unseal("$A", &changed), None, "changed at {at}");
        }
    }

    #[test]
    fn what_the_dead_have_left_is_removed_and_what_the_living_make_is_not() {
        let path = std::env::temp_dir().join(format!("arl-rt-left-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        // This process stands for another one that lives: it holds its file.
        let alive = create_held(&path.join("I.state.17.new")).unwrap();
        for name in ["I.state.1.new", "BASE.2.state.12345678.new", "I.state", "I.new", "I.state.new", "I.state.1a.new"]
        {
            fs::write(path.join(name), "part").unwrap();
        }
        let names = || {
            let names = fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
            names.collect::<std::collections::BTreeSet<String>>()
        };
        State::new(Box::new(Directory::new(&path)));
        let others = ["I.new", "I.state", "I.state.17.new", "I.state.1a.new", "I.state.new"];
        assert_eq!(names(), others.map(String::from).into());
        drop(alive);
        Directory::new(&path).begin();
        assert!(!names().contains("I.state.17.new"));
        Directory::new(path.join("nowhere")).begin();
        fs::remove_dir_all(&path).unwrap();
    }

    #[test]
    fn files_hold_what_was_stored_last() {
        let path = std::env::temp_dir().join(format!("arl-rt-state-{}", std::process::id()));
        let mut directory = Directory::new(&path);
        assert_eq!(directory.load("I").unwrap(), None);
        directory.store("I", b"one").unwrap();
        directory.store("I", b"two").unwrap();
        assert_eq!(directory.load("I").unwrap().as_deref(), Some(&b"two"[..]));
        assert_eq!(fs::read_dir(&path).unwrap().count(), 1, "nothing is left beside it");
        let mut state = State::new(Box::new(directory));
        let error = state.load("I").unwrap_err();
        assert!(error.place.ends_with("I.state") && error.problem.contains("damaged"), "{error}");
        fs::remove_dir_all(&path).unwrap();
    }
}
