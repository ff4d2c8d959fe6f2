//! The `arl.toml` files that apply to the files of an editor, and how their programs are checked.

use arl_project::arl_toml::{self, ArlToml};
use arl2rs::CheckOptions;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// What was found since the settings, a robot, a cell or an `arl.toml` last changed.
#[derive(Debug, Default)]
pub(super) struct Projects {
    /// The file that applies to the programs of a folder.
    files: RefCell<BTreeMap<PathBuf, Option<PathBuf>>>,
    /// How the programs that a file applies to are checked; `None` if the file is wrong, which was reported.
    options: RefCell<BTreeMap<PathBuf, Option<Rc<CheckOptions>>>>,
}

impl Projects {
    pub(super) fn forget(&self) {
        self.files.borrow_mut().clear();
        self.options.borrow_mut().clear();
    }

    /// The `arl.toml` that applies to a program.
    pub(super) fn find(&self, program: &Path) -> Option<PathBuf> {
        let folder = program.parent()?.to_path_buf();
        self.files.borrow_mut().entry(folder).or_insert_with(|| arl_toml::find(program)).clone()
    }

    /// How the programs of a project are checked.
    ///
    /// # Errors
    /// What is wrong with its files, the first time that they are needed.
    pub(super) fn options(
        &self,
        file: &Path,
        make: impl FnOnce(&ArlToml) -> Result<CheckOptions, String>,
    ) -> Result<Rc<CheckOptions>, String> {
        if let Some(known) = self.options.borrow().get(file) {
            return known.clone().ok_or_else(String::new);
        }
        let read =
            arl_toml::read(file).map_err(|failure| failure.to_string()).and_then(|read| make(&read)).map(Rc::new);
        self.options.borrow_mut().insert(file.to_path_buf(), read.clone().ok());
        read
    }
}
