//! Where programs get the runtime from: the checkout that this command was built from, or the registry.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

/// The runtime that compiled programs use.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Runtime {
    /// The workspace that has the package `arl-rt`.
    Checkout(PathBuf),
    /// The version of this command, from the registry.
    Registry,
}

impl Runtime {
    /// The checkout that this command was built from, as long as it is there.
    pub(super) fn find() -> Self {
        let checkout = Path::new(env!("CARGO_MANIFEST_DIR")).parent().map(Path::to_path_buf);
        match checkout.filter(|folder| folder.join("arl-rt/Cargo.toml").is_file()) {
            Some(folder) => Self::Checkout(folder),
            None => Self::Registry,
        }
    }

    /// The value of `arl-rt` under `[dependencies]`.
    pub(super) fn dependency(&self) -> String {
        match self {
            Runtime::Checkout(folder) => {
                format!(
                    "{{ path = {:?}, default-features = false, features = [\"serial\"] }}",
                    folder.join("arl-rt").display().to_string()
                )
            }
            Runtime::Registry => {
                format!(
                    "{{ version = \"={}\", default-features = false, features = [\"serial\"] }}",
                    env!("CARGO_PKG_VERSION")
                )
            }
        }
    }

    /// The lock file that says which versions of other packages to take.
    pub(super) fn lock_file(&self) -> Option<PathBuf> {
        match self {
            Runtime::Checkout(folder) => Some(folder.join("Cargo.lock")),
            Runtime::Registry => None,
        }
    }

    /// A number that changes with the runtime's sources.
    pub(super) fn state(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        env!("CARGO_PKG_VERSION").hash(&mut hasher);
        if let Runtime::Checkout(folder) = self {
            folder.hash(&mut hasher);
            for part in ["arl-rt", "arl-motion", "arl-robot", "arl-lang"] {
                hash_state(&folder.join(part).join("Cargo.toml"), &mut hasher);
                hash_tree(&folder.join(part).join("src"), &mut hasher);
            }
            hash_state(&folder.join("Cargo.lock"), &mut hasher);
        }
        hasher.finish()
    }
}

/// Hashes names, sizes and times of change, not contents: this runs at each start.
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

/// Hashes the name, size and time of change of one file.
pub(super) fn hash_state(path: &Path, hasher: &mut DefaultHasher) {
    path.hash(hasher);
    if let Ok(data) = std::fs::metadata(path) {
        data.len().hash(hasher);
        data.modified().ok().hash(hasher);
    }
}
