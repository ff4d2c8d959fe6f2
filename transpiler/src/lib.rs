//! Checks robot programs in ARL and turns them into Rust.
//!
//! The core does no file or process work: sources come in through [`Sources`], text and diagnostics go out. The doors
//! (the command, `build.rs`, the macro) read files and show what the core has to say.

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
    /// [`SourceError::Missing`] where there is no such file, [`SourceError::Unreadable`] with the reason otherwise.
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError>;
}

/// Why a source could not be read.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum SourceError {
    /// There is no such file.
    Missing,
    /// There is one, but it cannot be read.
    Unreadable(String),
}

/// How to check.
#[derive(Clone, Debug, Default)]
pub struct CheckOptions {
    /// The kind of robot.
    pub family: Family,
    /// Warn where more is accepted than the controller would take.
    pub strict: bool,
    /// The folder that `/home/ae/script/` in an import means; the main file's folder if absent.
    pub script_dir: Option<std::path::PathBuf>,
    /// The program is for a background channel, which has no robot.
    pub background: bool,
    /// A file without `main` is fine: it is checked as a module.
    pub library: bool,
    /// Record what every name means, for editors. The program that comes out is not for the emitter: its effects are
    /// not looked at.
    pub index: bool,
    /// The robot, where it is known: targets that it can never reach are warned of.
    #[cfg(feature = "tools")]
    pub robot: Option<arl_robot::Robot>,
    /// The cell, where it is known: channels, lines and bytes that it does not have are errors.
    #[cfg(feature = "tools")]
    pub cell: Option<arl_robot::outline::Outline>,
}

/// What came out of a check.
#[derive(Debug)]
pub struct Checked {
    /// The program, unless there was an error.
    pub program: Option<hir::Program>,
    /// Errors and warnings, by file and place.
    pub diagnostics: Vec<Diagnostic>,
    /// The files that were read.
    pub files: Files,
    /// What every name means, where [`CheckOptions::index`] asks for it.
    pub index: Option<index::Index>,
    /// The syntax trees, kept only to be freed with the rest: a command that ends anyway need not wait for it.
    _syntax: check::Syntax,
    /// The paths of the files that were read, in the order of `files`, and those that were looked for in vain.
    pub read: Vec<std::path::PathBuf>,
}

/// What only the emitter needs, to be freed when there is time.
#[cfg(feature = "tools")]
#[derive(Debug)]
pub struct Unneeded {
    _program: Option<hir::Program>,
    _syntax: check::Syntax,
}

impl Checked {
    /// Takes out what only the emitter needs, to be freed when there is time.
    #[cfg(feature = "tools")]
    pub fn take_program(&mut self) -> Unneeded {
        Unneeded { _program: self.program.take(), _syntax: std::mem::take(&mut self._syntax) }
    }

    /// Whether the program is refused.
    pub fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error)
    }
}

/// The examples of the README run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
