//! `arl2rs check`

use super::args::{Checking, Format};
use super::failure::{COMPILE_ERRORS, Failure};
use super::program::check_options;
use super::robot;
use super::show;
use crate::CheckOptions;
use crate::compile::{Compiled, check_program};
use crate::render::json;
use crate::sources::FileSystem;
use std::collections::HashSet;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Checks each file as a program. A data file, and a file that an earlier one uses, is a module and needs no `main`.
pub(super) fn check(files: &[PathBuf], format: Format, checking: &Checking) -> Result<ExitCode, Failure> {
    let mut options = check_options(checking)?;
    // A program that runs meets its robot itself, and one that is compiled may meet several.
    if let Some(robot) = &checking.robot {
        options.robot = Some(robot::load(Some(robot))?);
    }
    let mut reporter = Reporter { format, said: HashSet::new() };
    let mut used = HashSet::new();
    let (programs, modules): (Vec<&PathBuf>, Vec<&PathBuf>) = files.iter().partition(|file| !is_data(file));
    let mut refused = false;
    let mut later = Vec::new();
    for file in programs {
        let compiled = check_program(file, &FileSystem, &options)?;
        used.extend(compiled.read().skip(1).filter_map(|path| path.canonicalize().ok()));
        later.push((file, compiled));
    }
    for (file, mut compiled) in later {
        if compiled.checked.program.is_none() && file.canonicalize().is_ok_and(|path| used.contains(&path)) {
            compiled = as_module(file, &options)?;
        }
        refused |= reporter.report(compiled);
    }
    for file in modules {
        refused |= reporter.report(as_module(file, &options)?);
    }
    Ok(if refused { ExitCode::from(COMPILE_ERRORS) } else { ExitCode::SUCCESS })
}

fn as_module(file: &Path, options: &CheckOptions) -> Result<Compiled, Failure> {
    Ok(check_program(file, &FileSystem, &CheckOptions { library: true, ..options.clone() })?)
}

fn is_data(file: &Path) -> bool {
    file.file_stem().is_some_and(|stem| stem.to_string_lossy().to_ascii_lowercase().ends_with("_data"))
}

/// Shows what was found, a module's mistakes only once.
struct Reporter {
    format: Format,
    said: HashSet<String>,
}

impl Reporter {
    /// Says whether there were errors.
    fn report(&mut self, mut compiled: Compiled) -> bool {
        let refused = compiled.checked.has_errors();
        let files = compiled.shown_files();
        let lines: Vec<String> =
            compiled.checked.diagnostics.iter().map(|diagnostic| json(diagnostic, &files)).collect();
        let mut new = lines.iter().map(|line| self.said.insert(line.clone()));
        compiled.checked.diagnostics.retain(|_| new.next().unwrap_or(true));
        match self.format {
            Format::Human => show::diagnostics(&compiled),
            Format::Json => {
                let mut out = std::io::stdout().lock();
                for diagnostic in &compiled.checked.diagnostics {
                    // Nobody reads on: then there is nobody to tell.
                    let _ = writeln!(out, "{}", json(diagnostic, &files));
                }
            }
        }
        refused
    }
}
