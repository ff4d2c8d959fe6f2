//! The programs that open files belong to, checked as they are now.
//!
//! A file is checked as a program of its own, as `arl2rs check` does; a data file with the program beside it. The
//! results stay until a file that was read for them, or looked for in vain, changes.

use super::documents::Documents;
use super::text::{Encoding, Text};
use arl_lang::catalog::Family;
use arl_lang::files::owner;
use arl_robot::cell::Names;
use arl2rs::check::clean;
use arl2rs::compile::{Bug, check_program};
use arl2rs::diagnostics::{FileId, Location};
use arl2rs::index::Index;
use arl2rs::{CheckOptions, Checked, Sources, Unneeded};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// A checked program.
#[derive(Debug)]
pub(super) struct Program {
    /// Files and diagnostics.
    pub(super) checked: Checked,
    index: Index,
    /// The paths of the files in `checked.files`.
    paths: Vec<PathBuf>,
    /// The files that were read or looked for.
    read: Vec<PathBuf>,
    /// The kind of robot that it is for.
    pub(super) family: Family,
    /// The cell's names of signals.
    pub(super) names: Names,
    /// Freeing the trees takes a good part of the time of a check; no request should wait for it.
    unneeded: RefCell<Option<Unneeded>>,
}

impl Program {
    /// Checks the program whose main file is `root`; without `main` it is a module.
    ///
    /// # Errors
    /// The compiler itself failed.
    pub(super) fn check(root: &Path, sources: &dyn Sources, options: &CheckOptions) -> Result<Self, Bug> {
        let options = CheckOptions { index: true, library: true, ..options.clone() };
        let compiled = check_program(root, sources, &options)?;
        let shown = compiled.checked.files.iter().map(|(_, file)| clean(&compiled.folder.join(&file.name)));
        let paths = shown.collect();
        let read = compiled.read().map(|path| clean(&path)).collect();
        let mut checked = compiled.checked;
        let index = checked.index.take().unwrap_or_default();
        let names = options.cell.map(|cell| cell.names).unwrap_or_default();
        let unneeded = RefCell::new(Some(checked.take_program()));
        Ok(Self { checked, index, paths, read, family: options.family, names, unneeded })
    }

    pub(super) fn index(&self) -> &Index {
        &self.index
    }

    /// The number of a file.
    pub(super) fn file(&self, path: &Path) -> Option<FileId> {
        self.paths.iter().position(|known| known == path).map(|at| FileId(at as u32))
    }

    /// The path of a file.
    pub(super) fn path(&self, file: FileId) -> Option<&Path> {
        self.paths.get(file.0 as usize).map(PathBuf::as_path)
    }

    /// The text of a file, as it was checked.
    pub(super) fn text(&self, file: FileId, encoding: Encoding) -> Option<Text<'_>> {
        let file = self.checked.files.get(file)?;
        Some(Text { text: &file.text, lines: &file.lines, encoding })
    }

    /// The text at a place.
    pub(super) fn at(&self, at: Location) -> &str {
        self.checked.files.get(at.file).map_or("", |file| at.span.text(&file.text))
    }

    /// The line that a place begins in.
    pub(super) fn line(&self, at: Location) -> u32 {
        self.checked.files.get(at.file).map_or(0, |file| file.lines.line(at.span.start))
    }

    /// Whether it depends on a file, or would if there were such a file.
    pub(super) fn reads(&self, path: &Path) -> bool {
        self.read.iter().any(|read| read == path)
    }

    pub(super) fn read(&self) -> &[PathBuf] {
        &self.read
    }
}

/// All programs that were checked, by their main files.
#[derive(Debug, Default)]
pub(super) struct CheckedPrograms {
    known: RefCell<BTreeMap<PathBuf, Result<Rc<Program>, Bug>>>,
}

impl CheckedPrograms {
    /// The main file of the program that a file is checked with: a data file is checked with the program beside it.
    pub(super) fn root(&self, path: &Path, documents: &Documents) -> PathBuf {
        owner(path).filter(|owner| documents.exists(owner)).unwrap_or_else(|| path.to_path_buf())
    }

    /// The program that a file is checked with, checked now if it was not since the last change.
    ///
    /// # Errors
    /// The compiler itself failed at it.
    pub(super) fn of(&self, path: &Path, documents: &Documents, options: &CheckOptions) -> Result<Rc<Program>, Bug> {
        let root = self.root(path, documents);
        if let Some(known) = self.known.borrow().get(&root) {
            return known.clone();
        }
        let program = Program::check(&root, documents, options).map(Rc::new);
        self.known.borrow_mut().insert(root, program.clone());
        program
    }

    /// The program with this main file, if it was checked since the last change.
    pub(super) fn known(&self, root: &Path) -> Option<Rc<Program>> {
        self.known.borrow().get(root)?.clone().ok()
    }

    /// Forgets what depends on a file; returns the main files of those programs.
    pub(super) fn forget(&self, path: &Path) -> Vec<PathBuf> {
        let mut gone = Vec::new();
        self.known.borrow_mut().retain(|root, program| {
            let stays = root != path && program.as_ref().is_ok_and(|program| !program.reads(path));
            if !stays {
                gone.push(root.clone());
            }
            stays
        });
        gone
    }

    /// Frees what no request needs.
    pub(super) fn free(&self) {
        for program in self.known.borrow().values().flatten() {
            program.unneeded.take();
        }
    }

    /// Forgets everything, as after a change of options.
    pub(super) fn forget_all(&self) {
        self.known.borrow_mut().clear();
    }

    /// Keeps only what open files need.
    pub(super) fn keep(&self, documents: &Documents) {
        let roots: Vec<PathBuf> = documents.paths().map(|path| self.root(path, documents)).collect();
        self.known.borrow_mut().retain(|root, _| roots.contains(root));
    }
}
