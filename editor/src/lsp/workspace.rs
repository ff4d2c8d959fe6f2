//! The files of the workspace: which of them use which, so that all that depend on a changed file are updated.

use super::programs::Program;
use arl_lang::files::is_data;
use arl2rs::{CheckOptions, Sources};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The most files that are looked for in a workspace.
const MOST_FILES: usize = 5_000;
/// The most levels of folders that are searched.
const MOST_DEPTH: usize = 12;
/// The most folders that are searched.
const MOST_FOLDERS: usize = 5_000;
/// Folders that hold no programs.
const PASSED_OVER: [&str; 2] = ["target", "node_modules"];

/// The programs of the workspace's folders.
#[derive(Debug, Default)]
pub(super) struct Workspace {
    /// What each looked-at file reads or looks for.
    reads: BTreeMap<PathBuf, Vec<PathBuf>>,
    /// The files that were not looked at since they changed.
    open: BTreeSet<PathBuf>,
}

impl Workspace {
    /// Finds the programs below the folders.
    pub(super) fn search(folders: &[PathBuf]) -> Self {
        let mut workspace = Self::default();
        let mut searched = 0;
        for folder in folders {
            workspace.search_in(folder, 0, &mut searched);
        }
        workspace
    }

    fn search_in(&mut self, folder: &Path, depth: usize, searched: &mut usize) {
        *searched += 1;
        if *searched > MOST_FOLDERS {
            return;
        }
        let Ok(entries) = std::fs::read_dir(folder) else { return };
        for entry in entries.flatten() {
            let (path, name) = (entry.path(), entry.file_name());
            let name = name.to_string_lossy();
            let Ok(kind) = entry.file_type() else { continue };
            let passed_over = name.starts_with('.') || PASSED_OVER.contains(&&*name);
            if kind.is_dir() && !passed_over && depth < MOST_DEPTH {
                self.search_in(&path, depth + 1, searched);
            } else if is_program(&path) && !is_data(&path) && self.open.len() < MOST_FILES && path.is_file() {
                self.open.insert(path);
            }
        }
    }

    /// Marks all files to be looked at again: what an import means has changed.
    pub(super) fn look_again(&mut self) {
        self.open.extend(self.reads.keys().cloned());
    }

    /// Whether there are files that were not looked at.
    pub(super) fn is_open(&self) -> bool {
        !self.open.is_empty()
    }

    /// The next file to be looked at.
    pub(super) fn next(&mut self) -> Option<PathBuf> {
        self.open.pop_first()
    }

    /// Looks at a file.
    pub(super) fn look(&mut self, path: &Path, sources: &dyn Sources, options: &CheckOptions) {
        if let Ok(program) = Program::check(path, sources, options) {
            self.learn(path, &program);
        }
    }

    /// Remembers what a program reads.
    pub(super) fn learn(&mut self, root: &Path, program: &Program) {
        self.open.remove(root);
        self.reads.insert(root.to_path_buf(), program.read().to_vec());
    }

    /// Notes that a file changed, appeared or is gone.
    pub(super) fn changed(&mut self, path: &Path, is_there: bool) {
        if !is_there {
            self.open.remove(path);
            self.reads.remove(path);
        } else if is_program(path) && !is_data(path) {
            self.open.insert(path.to_path_buf());
        }
    }

    /// The main files of all programs that depend on a file, not counting the file itself.
    pub(super) fn dependents(&self, path: &Path) -> Vec<PathBuf> {
        let reading = self.reads.iter().filter(|(root, read)| *root != path && read.iter().any(|read| read == path));
        reading.map(|(root, _)| root.clone()).collect()
    }

    /// Whether a file is one of the workspace that uses others, or is used.
    pub(super) fn knows(&self, path: &Path) -> bool {
        self.reads.contains_key(path) || self.open.contains(path)
    }

    /// All programs that were looked at.
    pub(super) fn programs(&self) -> impl Iterator<Item = &PathBuf> {
        self.reads.keys()
    }
}

/// Whether a path has the ending of a program.
pub(super) fn is_program(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("arl"))
}
