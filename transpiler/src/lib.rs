//! Checks robot programs in ARL and turns them into Rust.
//!
//! The core does no file or process work: it takes sources through [`Sources`] and returns text and diagnostics. The
//! front ends, called doors here (the command, `build.rs`, the macro), read files and show the results.

#[cfg(feature = "tools")]
pub mod alarms;
mod build_door;
pub mod check;
pub mod compile;
pub mod diagnostics;
pub mod effects;
pub mod emit;
pub mod format;
pub mod hir;
pub mod index;
#[cfg(feature = "tools")]
pub mod lower;
mod near;
pub mod operators;
#[cfg(feature = "tools")]
pub mod reference;
pub mod render;
pub mod sources;
mod visit;

pub use build_door::Build;
pub use check::{SplicedValue, check, check_statements, check_text};

use arl_lang::catalog::Family;
use diagnostics::{Diagnostic, Files, Severity};
use std::path::Path;

/// Where the compiler gets its source texts from.
pub trait Sources {
    /// The bytes of the file at `path`.
    ///
    /// # Errors
    /// [`SourceError::Missing`] if there is no such file, otherwise [`SourceError::Unreadable`] with the reason.
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError>;
}

/// The reason why a source could not be read.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum SourceError {
    /// There is no such file.
    Missing,
    /// The file exists but cannot be read.
    Unreadable(String),
}

/// Options of a check.
#[derive(Clone, Debug, Default)]
pub struct CheckOptions {
    /// The kind of robot.
    pub family: Family,
    /// Warn where the compiler accepts what the controller would not.
    pub strict: bool,
    /// The folder that `/home/ae/script/` stands for in an import; the main file's folder if absent.
    pub script_dir: Option<std::path::PathBuf>,
    /// The program is for a background channel, which has no robot.
    pub background: bool,
    /// A file without `main` is accepted: it is checked as a module.
    pub library: bool,
    /// Record what every name means, for editors. The resulting program must not be emitted: its effects are not
    /// inferred.
    pub index: bool,
    /// The robot, if known: targets that it can never reach cause a warning.
    #[cfg(feature = "tools")]
    pub robot: Option<arl_robot::Robot>,
    /// The cell, if known: channels, lines and bytes that it does not have are errors.
    #[cfg(feature = "tools")]
    pub cell: Option<arl_robot::outline::Outline>,
}

/// The result of a check.
#[derive(Debug)]
pub struct Checked {
    /// The program, unless there was an error.
    pub program: Option<hir::Program>,
    /// Errors and warnings, by file and position.
    pub diagnostics: Vec<Diagnostic>,
    /// The files that were read.
    pub files: Files,
    /// What every name means, if [`CheckOptions::index`] is set.
    pub index: Option<index::Index>,
    /// The syntax trees, kept only so that a command that is about to exit need not wait for them to be freed.
    _syntax: check::Syntax,
    /// The paths of the files that were read, in the order of `files`, and of those that were not found.
    pub read: Vec<std::path::PathBuf>,
}

/// Data that only the emitter needs, to be freed when there is time.
#[cfg(feature = "tools")]
#[derive(Debug)]
pub struct Unneeded {
    _program: Option<hir::Program>,
    _syntax: check::Syntax,
}

impl Checked {
    /// Takes out the data that only the emitter needs, to be freed when there is time.
    #[cfg(feature = "tools")]
    pub fn take_program(&mut self) -> Unneeded {
        Unneeded { _program: self.program.take(), _syntax: std::mem::take(&mut self._syntax) }
    }

    /// Whether there are errors.
    pub fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error)
    }
}

/// Runs the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
