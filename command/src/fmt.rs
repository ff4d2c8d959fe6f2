//! `arl2rs fmt`

use arl_lang::symbol::Interner;
use arl_lang::text::{decode, encode_like};
use arl_lang::{ParseOptions, parse};
use arl_robot::atomic_file::{self, ChangeError};
use arl_robot::regular_file;
use arl_terminal::answer;
use arl_terminal::exit::Exit;
use arl_terminal::failure::Failure;
use arl_terminal::show;
use arl2rs::format::format;
use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// Formats the files, those below folders, and standard input for `-`; with `check` only names those that would change.
pub(crate) fn fmt(files: &[PathBuf], check: bool) -> Result<Exit, Failure> {
    let mut good = true;
    for file in files {
        if file.as_os_str() == "-" {
            good &= succeeds(standard_input(check))?;
            continue;
        }
        match programs(file) {
            Ok(programs) => {
                for program in programs {
                    good &= succeeds(in_place(&program, check))?;
                }
            }
            Err(failure) => good &= succeeds(Err(failure))?,
        }
    }
    Ok(if good { Exit::SUCCESS } else { Exit::FAILURE })
}

/// Whether a file caused no error, and did not have to be named. Errors are reported, and the other files are still
/// handled.
fn succeeds(outcome: Result<Option<PathBuf>, Failure>) -> Result<bool, Failure> {
    match outcome {
        Ok(None) => Ok(true),
        Ok(Some(changes)) => answer::write(&format!("{}\n", changes.display())).map(|()| false),
        Err(failure) => {
            failure.report();
            Ok(false)
        }
    }
}

/// The file itself, or the programs below a folder, in the order of their names. Links to folders are not followed.
fn programs(path: &Path) -> Result<Vec<PathBuf>, Failure> {
    if !path.is_dir() {
        return Ok(vec![path.to_path_buf()]);
    }
    let mut programs = Vec::new();
    let mut folders = vec![path.to_path_buf()];
    while let Some(folder) = folders.pop() {
        let unreadable = |error: io::Error| Failure::io("read", &folder, &error);
        for entry in fs::read_dir(&folder).map_err(unreadable)? {
            let entry = entry.map_err(unreadable)?;
            let path = entry.path();
            if entry.file_type().map_err(unreadable)?.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("arl")) && path.is_file() {
                programs.push(path);
            }
        }
    }
    programs.sort();
    Ok(programs)
}

/// Says where lines stay as they are because of a mistake in their form.
fn warn_of_mistakes(name: &Path, bytes: &[u8]) {
    let Ok(text) = decode(bytes) else { return };
    let errors = parse(&text, &mut Interner::default(), ParseOptions::default()).errors;
    let Some(first) = errors.first() else { return };
    let before = text.get(..first.span.start as usize).unwrap_or_default();
    let line = before.matches('\n').count() + 1;
    let mistakes = match errors.len() {
        1 => "it has a mistake".to_owned(),
        count => format!("it has {count} mistakes, the first one here"),
    };
    show::warning(&format!("{}:{line}: {mistakes}; such lines stay as they are", name.display()));
}

/// The bytes of a program, formatted.
fn laid_out(name: &Path, bytes: &[u8]) -> Result<Vec<u8>, Failure> {
    let text = decode(bytes).map_err(|error| Failure::Other(format!("cannot read {}: {error}", name.display())))?;
    let new = format(&text);
    if new == text {
        return Ok(bytes.to_vec());
    }
    let words = "it has characters that could not be written back as they are; save it as UTF-8";
    encode_like(bytes, &new).ok_or_else(|| Failure::Other(format!("cannot format {}: {words}", name.display())))
}

/// Formats a file; returns its name if it would change and is only to be named.
fn in_place(file: &Path, check: bool) -> Result<Option<PathBuf>, Failure> {
    if check {
        let bytes = regular_file::read(file).map_err(|error| Failure::io("read", file, &error))?;
        warn_of_mistakes(file, &bytes);
        return Ok((laid_out(file, &bytes)? != bytes).then(|| file.to_path_buf()));
    }
    let mut had = Vec::new();
    let change = |bytes: &[u8]| {
        had = bytes.to_vec();
        laid_out(file, bytes)
    };
    let changed = atomic_file::change(file, change);
    warn_of_mistakes(file, &had);
    changed.map(|()| None).map_err(|error| match error {
        ChangeError::Read(error) => Failure::io("read", file, &error),
        ChangeError::Refused(failure) => failure,
        ChangeError::Write(error) => Failure::io("write", file, &error),
        aside @ ChangeError::Aside(..) => Failure::Other(format!("{} {aside}", file.display())),
    })
}

fn standard_input(check: bool) -> Result<Option<PathBuf>, Failure> {
    let name = Path::new("standard input");
    let mut bytes = Vec::new();
    io::stdin().lock().read_to_end(&mut bytes).map_err(|error| Failure::io("read", name, &error))?;
    warn_of_mistakes(name, &bytes);
    let new = laid_out(name, &bytes)?;
    if check {
        return Ok((new != bytes).then(|| PathBuf::from("-")));
    }
    let mut out = io::stdout().lock();
    answer::written(out.write_all(&new).and_then(|()| out.flush())).map(|()| None)
}
