//! A folder, or nothing, where a program was to be named.

use super::failure::Failure;
use super::show;
use arl_lang::lexer::lexemes;
use arl_lang::text::decode;
use std::path::{Path, PathBuf};

/// Refuses a folder, and names a program that lies in it; and a name without its ending.
///
/// # Errors
/// It is a folder, or what was meant lies beside it.
pub(super) fn refuse(program: &Path) -> Result<(), Failure> {
    if !program.is_dir() {
        let meant = program.with_extension("arl");
        let is_meant = program.extension().is_none() && !program.exists() && meant.is_file();
        let (named, meant) = (show::path(program).display(), show::path(&meant).display());
        let text = || format!("there is no file {named}; did you mean {meant}?");
        return if is_meant { Err(Failure::Usage(text())) } else { Ok(()) };
    }
    let such_as = program_in(program).map(|file| format!(", such as {}", show::path(&file).display()));
    let such_as = such_as.unwrap_or_default();
    let folder = show::path(program).display().to_string();
    Err(Failure::Usage(format!("{folder} is a folder: name the file that has `main`{such_as}")))
}

/// The first file of a folder, by name, that has a `main`.
#[expect(clippy::disallowed_methods, reason = "a message looks around")]
fn program_in(folder: &Path) -> Option<PathBuf> {
    let files = std::fs::read_dir(folder).ok()?.flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|ending| ending == "arl")).collect();
    files.sort();
    files.into_iter().find(|file| file.is_file() && std::fs::read(file).is_ok_and(|bytes| has_main(&bytes)))
}

fn has_main(bytes: &[u8]) -> bool {
    let Ok(text) = decode(bytes) else { return false };
    let mut words = lexemes(&text).map(|(_, span)| span.text(&text));
    words.any(|word| word.eq_ignore_ascii_case("main"))
}
