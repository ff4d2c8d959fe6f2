//! State that is kept when the controller is switched off: one file for each system variable, and one for the positions
//! of the programs.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::io;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::{Arc, Mutex, PoisonError};

use arl_robot::regular_file;

use crate::storage::disk::{Disk, Stage, Work};
use arl_robot::atomic_file;

/// A store of kept values, by name.
pub trait Storage {
    /// Called when a controller starts, before anything is loaded: removes leftovers of a process that was killed.
    fn begin(&mut self) {}

    /// The content that was stored last under this name; `None` if nothing was.
    ///
    /// # Errors
    /// The content exists, but cannot be read.
    fn load(&self, name: &str) -> io::Result<Option<Vec<u8>>>;

    /// Stores content under this name. Whatever happens meanwhile, afterwards either the old or the new content is
    /// there, complete.
    ///
    /// # Errors
    /// The content cannot be stored; then the old content is still there.
    fn store(&mut self, name: &str, content: &[u8]) -> io::Result<()>;

    /// A second access to the same values, for threads that store outside the cycle. Without one, values are stored in
    /// the cycle that saves them, and the positions of the programs, which change all the time, are not kept.
    fn another(&self) -> Option<Box<dyn Storage + Send>> {
        None
    }

    /// The place of this name, for messages.
    fn place(&self, name: &str) -> String {
        name.to_owned()
    }
}

/// Keeps values in memory, for its own lifetime.
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

/// Keeps values as files of a directory, which is created when the first value is stored.
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

impl Storage for Directory {
    fn begin(&mut self) {
        atomic_file::remove_leftovers(&self.0);
    }

    fn load(&self, name: &str) -> io::Result<Option<Vec<u8>>> {
        match regular_file::read(&self.path(name)) {
            Ok(content) => Ok(Some(content)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error),
        }
    }

    fn store(&mut self, name: &str, content: &[u8]) -> io::Result<()> {
        fs::create_dir_all(&self.0)?;
        atomic_file::write(&self.path(name), content)
    }

    fn another(&self) -> Option<Box<dyn Storage + Send>> {
        Some(Box::new(self.clone()))
    }

    fn place(&self, name: &str) -> String {
        self.path(name).display().to_string()
    }
}

/// The error of a controller state that cannot be read or written.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct StateError {
    /// The file.
    pub place: String,
    /// The problem with it.
    pub problem: String,
}

impl fmt::Display for StateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.problem)
    }
}

impl std::error::Error for StateError {}

/// The kept values, with the texts known to be stored.
pub(crate) struct KeptState {
    storage: Box<dyn Storage>,
    /// A second access to the values, for the thread that stores; without it they are stored at once.
    beside: Option<Arc<Mutex<Box<dyn Storage + Send>>>>,
    known: BTreeMap<&'static str, String>,
    /// The values that are being stored, in order.
    saving: Vec<Saving>,
}

/// A value that is being stored.
struct Saving {
    name: &'static str,
    text: String,
    work: Work<Result<(), StateError>>,
    asker: Saved,
}

/// The result of storing a value, for the caller: `None` until it is known; available once.
pub(crate) type Saved = Rc<Cell<Option<Result<(), StateError>>>>;

impl KeptState {
    pub(crate) fn new(mut storage: Box<dyn Storage>) -> Self {
        storage.begin();
        let beside = storage.another().map(|storage| Arc::new(Mutex::new(storage)));
        Self { storage, beside, known: BTreeMap::new(), saving: Vec::new() }
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

    /// Begins to write a value; [`KeptState::collect`] sets the result once it is stored.
    pub(crate) fn save(&mut self, name: &'static str, text: String, disk: &Disk) -> Saved {
        let asker = Saved::default();
        match &self.beside {
            Some(beside) => {
                let (beside, stored) = (Arc::clone(beside), text.clone());
                let work = disk.begin(move || {
                    let mut storage = beside.lock().unwrap_or_else(PoisonError::into_inner);
                    store(&mut **storage, name, &stored)
                });
                self.saving.push(Saving { name, text, work, asker: Rc::clone(&asker) });
            }
            None => {
                let stored = store(&mut *self.storage, name, &text);
                if stored.is_ok() {
                    self.known.insert(name, text);
                }
                asker.set(Some(stored));
            }
        }
        asker
    }

    /// Whether something is being stored.
    #[inline]
    pub(crate) fn is_saving(&self) -> bool {
        !self.saving.is_empty()
    }

    /// Records the values stored meanwhile. Returns the errors for which no caller waits.
    pub(crate) fn collect(&mut self) -> Vec<StateError> {
        let mut problems = Vec::new();
        for Saving { name, text, work, asker } in std::mem::take(&mut self.saving) {
            let stored = match work.stage() {
                Stage::InProgress => {
                    self.saving.push(Saving { name, text, work, asker });
                    continue;
                }
                Stage::Done(stored) => stored,
                Stage::Lost => Err(StateError { place: self.storage.place(name), ..panicked(name) }),
            };
            if stored.is_ok() {
                self.known.insert(name, text);
            }
            match stored {
                Err(error) if Rc::strong_count(&asker) == 1 => problems.push(error),
                stored => asker.set(Some(stored)),
            }
        }
        problems
    }

    /// A second access to the same values, for a thread.
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

/// Stores a text with a checksum, so that damage is noticed when it is read.
pub(crate) fn store(storage: &mut dyn Storage, name: &str, text: &str) -> Result<(), StateError> {
    storage.store(name, seal(name, text).as_bytes()).map_err(|error| {
        let problem = format!("cannot be written: {error}");
        StateError { place: storage.place(name), problem }
    })
}

/// The error of a storage that has panicked while it stored under this name.
pub(crate) fn panicked(name: &str) -> StateError {
    StateError { place: name.to_owned(), problem: "cannot be written: the storage has panicked".to_owned() }
}

/// The text with a last line that verifies that it is complete and belongs to this variable.
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
        let sealed = seal("$A", "1\n2\n3\n");
        assert_eq!(unseal("$A", sealed.as_bytes()), Some("1\n2\n3\n"));
        assert_eq!(unseal("$B", sealed.as_bytes()), None, "another variable's");
        for cut in 0..sealed.len() {
            assert_eq!(unseal("$A", &sealed.as_bytes()[..cut]), None, "cut at {cut}");
        }
        for at in 0..sealed.len() - 1 {
            let mut changed = sealed.clone().into_bytes();
            changed[at] ^= 1;
            assert_eq!(unseal("$A", &changed), None, "changed at {at}");
        }
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
        let mut state = KeptState::new(Box::new(directory));
        let error = state.load("I").unwrap_err();
        assert!(error.place.ends_with("I.state") && error.problem.contains("damaged"), "{error}");
        fs::remove_dir_all(&path).unwrap();
    }
}
