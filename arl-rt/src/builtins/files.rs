//! `gettextstr`, `filesize`, `renamefile`, `removefile`: files of a program.

use std::fs;
use std::path::Path;

use arl_robot::regular_file;

use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::values::Str;

/// The directory below the script directory that stands for the USB store.
const USB: &str = "USB";

/// A line of a text file, without its end; lines count from 1. `external_file` looks below `USB`.
///
/// # Errors
/// 10064: the file does not exist or cannot be read; 10065: it does not have the line; a path that leads out of the
/// script directory.
pub async fn gettextstr(cx: &Cx, file_path: &Str, line_no: i32, external_file: bool) -> Result<Str, Fault> {
    cx.motion_end().await;
    let inner = Path::new(if external_file { USB } else { "" });
    let path = cx.shared().scripts.below(file_path, inner)?;
    let text = regular_file::read(&path).map_err(|_| Fault::NoSuchFile(file_path.to_text().into()))?;
    let whole = text.strip_suffix(b"\n").unwrap_or(&text);
    let mut lines = whole.split(|byte| *byte == b'\n').take(if text.is_empty() { 0 } else { usize::MAX });
    let count = lines.clone().count();
    let line = usize::try_from(line_no).ok().and_then(|line| line.checked_sub(1)).and_then(|at| lines.nth(at));
    match line {
        Some(line) => Ok(line.strip_suffix(b"\r").unwrap_or(line).into()),
        None => Err(Fault::NoSuchLine { line: line_no, count: count as u32 }),
    }
}

/// The size of a file in bytes.
///
/// # Errors
/// The file does not exist, or its path leads out of the script directory.
pub async fn filesize(cx: &Cx, file_name: &Str) -> Result<i32, Fault> {
    cx.motion_end().await;
    let path = cx.shared().scripts.file(file_name)?;
    match fs::metadata(path) {
        Ok(data) if data.is_file() => Ok(i32::try_from(data.len()).unwrap_or(i32::MAX)),
        _ => Err(Fault::NoSuchFile(file_name.to_text().into())),
    }
}

/// Gives a file another name; true on success. False if a file with the new name already exists, which stays as it is.
///
/// # Errors
/// A path leads out of the script directory.
pub async fn renamefile(cx: &Cx, file_name: &Str, new_file_name: &Str) -> Result<bool, Fault> {
    cx.motion_end().await;
    let scripts = &cx.shared().scripts;
    let (from, to) = (scripts.file(file_name)?, scripts.file(new_file_name)?);
    Ok(from.is_file() && !to.exists() && fs::rename(from, to).is_ok())
}

/// Deletes a file; true on success.
///
/// # Errors
/// The path leads out of the script directory.
pub async fn removefile(cx: &Cx, file_name: &Str) -> Result<bool, Fault> {
    cx.motion_end().await;
    let path = cx.shared().scripts.file(file_name)?;
    Ok(fs::remove_file(path).is_ok())
}
