//! Checks paths that should name a program.

use arl_lang::text::decode;
use arl_terminal::failure::Failure;
use arl_terminal::show;
use arl2rs::check::names_main;
use std::path::{Path, PathBuf};

/// Checks whether a path may name a program: a folder may not, and neither may a name without its extension.
///
/// # Errors
/// The path does not name a program; the error names the file that is probably meant.
pub fn check(program: &Path) -> Result<(), Failure> {
    let shown = show::path(program).display();
    if program.is_dir() {
        let such_as = program_in(program).map(|file| format!(", such as {}", show::path(&file).display()));
        let such_as = such_as.unwrap_or_default();
        return Err(Failure::Usage(format!("{shown} is a folder: name the file that has `main`{such_as}")));
    }
    let meant = program.with_extension("arl");
    if program.extension().is_none() && !program.exists() && meant.is_file() {
        let meant = show::path(&meant).display();
        return Err(Failure::Usage(format!("there is no file {shown}; did you mean {meant}?")));
    }
    Ok(())
}

/// The first file of a folder, by name, that has a `main`.
fn program_in(folder: &Path) -> Option<PathBuf> {
    let files = std::fs::read_dir(folder).ok()?.flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|ending| ending == "arl")).collect();
    files.sort();
    files.into_iter().find(|file| {
        file.is_file() && std::fs::read(file).is_ok_and(|bytes| decode(&bytes).is_ok_and(|text| names_main(&text)))
    })
}
