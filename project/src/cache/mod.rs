//! The storage of compiled programs: a folder `programs` with a folder for each program; a folder `runtime` with a
//! folder for each runtime, which contains its sources if the command carries them, and what cargo made with it; and a
//! folder `results` with the results of sweeps.

mod content;
mod limit;
mod lock;
mod made;
mod old;

pub use content::{Content, read_sealed, sealed};
pub use lock::Lock;
pub use made::{Made, RECORD};
pub use old::{Removed, remove_made};

use arl_terminal::failure::Failure;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

const PROGRAMS: &str = "programs";
const RUNTIMES: &str = "runtime";
const RESULTS: &str = "results";
/// The extension of result files.
const RESULTS_END: &str = "jsonl";

/// The folder of all compiled programs of a user.
#[derive(Clone, Debug)]
pub struct Cache {
    root: PathBuf,
    /// The maximum size in bytes; `None` for no limit.
    limit: Option<u64>,
}

impl Cache {
    /// `$ARL2RS_CACHE`, otherwise the user's cache folder.
    ///
    /// # Errors
    /// There is no such folder, or `$ARL2RS_CACHE_LIMIT` is not a valid limit.
    pub fn find() -> Result<Self, Failure> {
        let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        let home = || {
            if cfg!(windows) {
                set("LOCALAPPDATA")
            } else if cfg!(target_os = "macos") {
                set("HOME").map(|home| home.join("Library/Caches"))
            } else {
                set("HOME").map(|home| home.join(".cache"))
            }
        };
        let shared = || set("XDG_CACHE_HOME").filter(|path| path.is_absolute()).or_else(home);
        let root = set("ARL2RS_CACHE").or_else(|| shared().map(|folder| folder.join("arl2rs")));
        let root = root.ok_or_else(|| {
            Failure::Other("there is no folder for compiled programs: set ARL2RS_CACHE to one".into())
        })?;
        let root = std::path::absolute(&root).map_err(|error| Failure::io("use", &root, &error))?;
        Ok(Self { root, limit: limit::read()? })
    }

    /// The root folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The file with the results of runs, by a key of what they depend on.
    pub fn results(&self, key: &str) -> PathBuf {
        self.root.join(RESULTS).join(key).with_extension(RESULTS_END)
    }

    /// The folder of a program that was given as text, by the hash of the text. It belongs to the programs.
    pub fn text(&self, hash: &str) -> PathBuf {
        self.root.join(PROGRAMS).join(format!("text-{hash}"))
    }

    /// The folder of a runtime.
    pub fn runtime(&self, name: &str) -> PathBuf {
        self.root.join(RUNTIMES).join(name)
    }

    /// The place of the program whose main file is `main`, an absolute path.
    pub fn program(&self, main: &Path) -> Place {
        self.place(main, None)
    }

    /// The place of the programs that run in a cell, `main` first; both are absolute paths.
    pub fn programs(&self, main: &Path, cell: &Path) -> Place {
        self.place(main, Some(cell))
    }

    fn place(&self, main: &Path, cell: Option<&Path>) -> Place {
        let mut hasher = DefaultHasher::new();
        main.hash(&mut hasher);
        cell.inspect(|cell| cell.hash(&mut hasher));
        let stem: String = main
            .file_stem()
            .map(|stem| stem.to_string_lossy().to_lowercase())
            .unwrap_or_default()
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
            .take(40)
            .collect();
        // The name of a package must begin with a letter.
        let name = format!("arl-{stem}-{:08x}", hasher.finish() as u32);
        Place { folder: self.root.join(PROGRAMS).join(&name), name }
    }
}

/// The folder of one program, and the name of its package.
#[derive(Clone, Debug)]
pub struct Place {
    /// The path of the folder.
    pub folder: PathBuf,
    /// The name of the package.
    pub name: String,
}

/// What a program is compiled into. Each kind has a place of its own.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub enum Kind {
    /// A program.
    #[default]
    Program,
    /// A program for a debugger: code for the engine.
    Watched,
    /// A library for another program.
    Library,
    /// A program whose global variables can be set from outside.
    Named,
}

impl Kind {
    /// The endings of package names for kinds other than `Program`.
    const ENDINGS: [&str; 3] = ["debug", "library", "named"];

    fn ending(self) -> Option<&'static str> {
        let [debug, library, named] = Self::ENDINGS;
        match self {
            Kind::Program => None,
            Kind::Watched => Some(debug),
            Kind::Library => Some(library),
            Kind::Named => Some(named),
        }
    }
}

impl Place {
    /// The place of this program when compiled into `kind`.
    pub fn of(self, kind: Kind) -> Self {
        let Some(ending) = kind.ending() else { return self };
        let name = format!("{}-{ending}", self.name);
        Self { folder: self.folder.with_file_name(&name), name }
    }

    /// The file that records what the program was compiled from.
    pub fn stamp(&self) -> PathBuf {
        self.folder.join("stamp")
    }

    /// The file with the messages shown when the program was checked.
    pub fn messages(&self) -> PathBuf {
        self.folder.join("said")
    }

    /// Waits until no other process compiles this program. `shared` is for starting it.
    ///
    /// # Errors
    /// As for [`Lock::take`].
    pub fn lock(&self, shared: bool) -> Result<Lock, Failure> {
        Lock::take(&self.folder, shared, "waiting for another arl2rs that is compiling this program")
    }
}

/// Writes a file unless it already has this content; returns whether the file was written.
///
/// # Errors
/// The file cannot be written.
pub fn write_if_changed(path: &Path, content: &[u8]) -> Result<bool, Failure> {
    match arl2rs::sources::write_if_changed(path, content) {
        Ok(written) => Ok(written),
        Err(error) => Err(Failure::io("write", path, &error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_differ_by_path_and_are_package_names() {
        let cache = Cache { root: "/cache".into(), limit: None };
        let one = cache.program(Path::new("/a/Pick me.arl"));
        let other = cache.program(Path::new("/b/Pick me.arl"));
        assert!(one.name.starts_with("arl-pick_me-"), "{}", one.name);
        assert_ne!(one.folder, other.folder);
        assert_ne!(cache.programs(Path::new("/a/Pick me.arl"), Path::new("/a/c.toml")).folder, one.folder);
    }
}
