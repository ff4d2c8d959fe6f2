//! `arl2rs fmt`

use super::answer;
use super::failure::{COMPILE_ERRORS, Failure};
use crate::format::format;
use arl_lang::text::{decode, encode_like};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Lays programs out: in place, or from standard input to standard output for `-`. With `check` nothing is written;
/// the names of files that would change are printed. A folder stands for all programs below it.
pub(super) fn fmt(paths: &[PathBuf], check: bool) -> Result<ExitCode, Failure> {
    let (mut differs, mut failed) = (false, false);
    for path in paths {
        if path.as_os_str() == "-" {
            differs |= standard_input(check)?;
            continue;
        }
        for file in files(path) {
            match file.and_then(|file| one(&file, check)) {
                Ok(changed) => differs |= changed,
                // The other files are done all the same.
                Err(failure) => {
                    failure.report();
                    failed = true;
                }
            }
        }
    }
    let is_wrong = failed || check && differs;
    Ok(if is_wrong { ExitCode::from(COMPILE_ERRORS) } else { ExitCode::SUCCESS })
}

/// Whether the text that comes in changes.
fn standard_input(check: bool) -> Result<bool, Failure> {
    let mut bytes = Vec::new();
    let failed = |error: std::io::Error| Failure::Other(format!("cannot read standard input: {error}"));
    std::io::stdin().lock().read_to_end(&mut bytes).map_err(failed)?;
    let name = Path::new("<standard input>");
    let new = laid_out(name, &bytes)?;
    let differs = new != bytes;
    if check {
        if differs {
            answer::write(&format!("{}\n", name.display()))?;
        }
    } else {
        let mut out = std::io::stdout().lock();
        answer::written(out.write_all(&new).and_then(|()| out.flush()))?;
    }
    Ok(differs)
}

/// Lays one file out; whether it changes.
fn one(path: &Path, check: bool) -> Result<bool, Failure> {
    let old = std::fs::read(path).map_err(|error| Failure::io("read", path, &error))?;
    let new = laid_out(path, &old)?;
    if new == old {
        return Ok(false);
    }
    if check {
        answer::write(&format!("{}\n", path.display()))?;
    } else {
        replace(path, &new).map_err(|error| Failure::io("write", path, &error))?;
    }
    Ok(true)
}

/// The bytes of a file in its layout, in the encoding that it has.
fn laid_out(path: &Path, bytes: &[u8]) -> Result<Vec<u8>, Failure> {
    let shown = path.display();
    let text = decode(bytes).map_err(|error| {
        Failure::Other(format!("{shown} is neither UTF-8 nor GB18030 from byte {} on", error.offset))
    })?;
    let lost = || Failure::Other(format!("{shown} would not keep all its characters: save it in UTF-8 first"));
    encode_like(bytes, &format(&text)).ok_or_else(lost)
}

/// Puts new content in the place of a file, all of it or nothing; the file keeps its permissions. A link stays one.
fn replace(path: &Path, content: &[u8]) -> std::io::Result<()> {
    let path = path.canonicalize()?;
    let permissions = std::fs::metadata(&path)?.permissions();
    if permissions.readonly() {
        return Err(std::io::ErrorKind::PermissionDenied.into());
    }
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.new", std::process::id()));
    let new = path.with_file_name(name);
    let written = std::fs::write(&new, content)
        .and_then(|()| std::fs::set_permissions(&new, permissions))
        .and_then(|()| std::fs::rename(&new, &path));
    if written.is_err() {
        let _ = std::fs::remove_file(&new);
    }
    written
}

/// The file itself, or all programs below a folder, in the order of their names.
fn files(path: &Path) -> Vec<Result<PathBuf, Failure>> {
    if !path.is_dir() {
        return vec![Ok(path.to_path_buf())];
    }
    let entries = match std::fs::read_dir(path) {
        Ok(entries) => entries,
        Err(error) => return vec![Err(Failure::io("read", path, &error))],
    };
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    let wanted =
        |path: &PathBuf| path.is_dir() || path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("arl"));
    let is_link_to_folder = |path: &PathBuf| path.is_dir() && path.is_symlink();
    paths.into_iter().filter(wanted).filter(|path| !is_link_to_folder(path)).flat_map(|path| files(&path)).collect()
}
