//! Checks paths that should name a program.

use arl_lang::near::nearest;
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

/// What to say of a program that does not exist.
pub fn missing(program: &Path) -> Option<String> {
    if program.is_file() {
        return None;
    }
    let names: Vec<String> = sources_in(program.parent().unwrap_or(Path::new("")))
        .filter_map(|path| Some(path.file_name()?.to_str()?.to_owned()))
        .collect();
    let name = program.file_name().unwrap_or_default().to_string_lossy();
    let near = nearest(&name, names.iter().map(String::as_str)).map(|near| format!("; did you mean `{near}`?"));
    Some(format!("there is no file {}{}", show::path(program).display(), near.unwrap_or_default()))
}

/// The files of a folder that may be programs.
fn sources_in(folder: &Path) -> impl Iterator<Item = PathBuf> {
    // The folder of a bare name is the current one.
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let files = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    files.filter(|path| path.extension().is_some_and(|ending| ending == "arl"))
}

/// The first file of a folder, by name, that has a `main`.
fn program_in(folder: &Path) -> Option<PathBuf> {
    let mut files: Vec<PathBuf> = sources_in(folder).collect();
    files.sort();
    files.into_iter().find(|file| {
        file.is_file() && std::fs::read(file).is_ok_and(|bytes| decode(&bytes).is_ok_and(|text| names_main(&text)))
    })
}
