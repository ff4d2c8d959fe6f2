//! The sources of the runtime that programs are compiled with.

use crate::cache::{Cache, Lock, write_if_changed};
use arl_sources::{Carried, Origin};
use arl_terminal::failure::Failure;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

/// The runtime that programs are compiled with.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Runtime(Origin);

/// A runtime ready for compiling programs; it is not removed from the cache while this value lives.
#[derive(Debug)]
pub struct Unpacked {
    /// Its folder in the cache.
    pub folder: PathBuf,
    /// The value of `arl-rt` under `[dependencies]`.
    pub dependency: String,
    /// The value of `arl-drivers` in the same table.
    pub drivers: String,
    /// The value of `arl-library` in the same table.
    pub library: String,
    /// The lock file with the versions of other packages.
    pub lock_file: Option<PathBuf>,
    _lock: Lock,
}

impl Unpacked {
    /// The folder in which all programs are compiled, so that the runtime is compiled only once.
    pub fn target(&self) -> PathBuf {
        self.folder.join("target")
    }

    /// Releases the runtime, which may be removed from now on. Returns its folder.
    pub fn give_back(self) -> PathBuf {
        self.folder
    }
}

impl Runtime {
    /// The runtime of this command.
    pub fn find() -> Self {
        Self(arl_sources::ORIGIN)
    }

    /// A number that changes with the runtime's sources.
    pub fn state(self) -> u64 {
        let mut hasher = DefaultHasher::new();
        env!("CARGO_PKG_VERSION").hash(&mut hasher);
        match self.0 {
            Origin::Checkout(folder) => {
                let folder = Path::new(folder);
                for part in ["arl-rt", "arl-motion", "arl-robot", "arl-lang", "drivers", "library"] {
                    hash_state(&folder.join(part).join("Cargo.toml"), &mut hasher);
                    hash_tree(&folder.join(part).join("src"), &mut hasher);
                }
                hash_state(&folder.join("Cargo.lock"), &mut hasher);
            }
            Origin::Carried(carried) => carried.state.hash(&mut hasher),
            Origin::Registry => {}
        }
        hasher.finish()
    }

    /// The name in the cache.
    fn name(self) -> String {
        let version = env!("CARGO_PKG_VERSION");
        match self.0 {
            Origin::Checkout(folder) => {
                let mut hasher = DefaultHasher::new();
                folder.hash(&mut hasher);
                format!("checkout-{:016x}", hasher.finish())
            }
            Origin::Carried(carried) => format!("{version}-{}", carried.state),
            Origin::Registry => version.into(),
        }
    }

    /// Its folder in the cache.
    pub(crate) fn folder(self, cache: &Cache) -> PathBuf {
        cache.runtime(&self.name())
    }

    /// Prepares the runtime: carried sources are written to the cache.
    ///
    /// # Errors
    /// The checkout no longer exists, or the cache cannot be written.
    pub fn unpack(self, cache: &Cache) -> Result<Unpacked, Failure> {
        let folder = self.folder(cache);
        let lock = Lock::take(&folder, true, "waiting for another arl2rs that is removing this runtime")?;
        let options = "default-features = false, features = [\"serial\", \"realtime\"]";
        let below = |workspace: &Path| {
            let path = |package: &str| workspace.join(package).display().to_string();
            let plain = |package: &str| format!("{{ path = {:?} }}", path(package));
            [format!("{{ path = {:?}, {options} }}", path("arl-rt")), plain("drivers"), plain("library")]
        };
        let ([dependency, drivers, library], lock_file) = match self.0 {
            Origin::Checkout(workspace) => {
                let workspace = Path::new(workspace);
                if !workspace.join("arl-rt/Cargo.toml").is_file() {
                    return Err(gone(workspace));
                }
                (below(workspace), Some(workspace.join("Cargo.lock")))
            }
            Origin::Carried(carried) => {
                let workspace = folder.join("sources");
                write(carried, &workspace)?;
                (below(&workspace), Some(workspace.join("Cargo.lock")))
            }
            Origin::Registry => {
                let version = format!("version = \"={}\"", env!("CARGO_PKG_VERSION"));
                let plain = format!("{{ {version} }}");
                ([format!("{{ {version}, {options} }}"), plain.clone(), plain], None)
            }
        };
        Ok(Unpacked { folder, dependency, drivers, library, lock_file, _lock: lock })
    }
}

fn gone(checkout: &Path) -> Failure {
    Failure::Other(format!(
        "this arl2rs uses the checkout {}, which no longer exists, so no program can be compiled\n\
         help: `cargo install --locked --path command` in a checkout installs a command that contains what it needs",
        checkout.display()
    ))
}

/// Writes the files that are missing or differ, for example because the cache was cleaned up. Unchanged files keep
/// their time, so that cargo does not compile them again.
fn write(carried: &Carried, workspace: &Path) -> Result<(), Failure> {
    let Some(parent) = workspace.parent() else { return Ok(()) };
    let _alone =
        Lock::take(&parent.join("unpacking"), false, "waiting for another arl2rs that is unpacking the runtime")?;
    for (name, text) in carried.files {
        write_if_changed(&workspace.join(name), text.as_bytes())?;
    }
    Ok(())
}

/// Hashes names, sizes and modification times instead of contents, because this runs at each start.
fn hash_tree(folder: &Path, hasher: &mut DefaultHasher) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            hash_tree(&path, hasher);
        } else {
            hash_state(&path, hasher);
        }
    }
}

/// Hashes the name, size and modification time of one file.
pub fn hash_state(path: &Path, hasher: &mut DefaultHasher) {
    path.hash(hasher);
    if let Ok(data) = std::fs::metadata(path) {
        data.len().hash(hasher);
        data.modified().ok().hash(hasher);
    }
}
