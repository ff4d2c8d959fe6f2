//! Files of a program: everything happens below the script directory.

use std::fs;
use std::io::Write;
use std::path::{Component, Path, PathBuf};

use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::values::Str;

/// Where the script directory is on a controller; programs name files by it.
const ON_CONTROLLER: &str = "/home/ae/script/";

/// The directory below the script directory that stands for the USB store.
const USB: &str = "USB";

/// The directory that holds a program's files.
#[derive(Clone, Debug)]
pub(crate) struct ScriptDir(PathBuf);

impl ScriptDir {
    pub(crate) fn new(path: PathBuf) -> Self {
        Self(path)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    /// The file of this name below the directory.
    ///
    /// # Errors
    /// The name is empty, absolute, or leads out of the directory.
    pub(crate) fn file(&self, name: &Str) -> Result<PathBuf, Fault> {
        self.below(name, Path::new(""))
    }

    fn below(&self, name: &Str, inner: &Path) -> Result<PathBuf, Fault> {
        let text = name.to_text();
        let problem = |problem: &str| Fault::File { path: text.clone().into(), problem: problem.into() };
        let relative = Path::new(text.strip_prefix(ON_CONTROLLER).unwrap_or(&text));
        let mut path = self.0.join(inner);
        let mut named = false;
        for component in relative.components() {
            match component {
                Component::Normal(part) => {
                    path.push(part);
                    named = true;
                }
                Component::CurDir => {}
                Component::ParentDir => {
                    return Err(problem("a path with `..` may lead out of the script directory"));
                }
                Component::RootDir | Component::Prefix(_) => {
                    return Err(problem("paths are relative to the script directory, or begin with /home/ae/script/"));
                }
            }
        }
        if named && !text.contains('\0') { Ok(path) } else { Err(problem("this is no name of a file")) }
    }

    /// Appends to a file; it is made where it is missing, its directory is not.
    ///
    /// # Errors
    /// The name is not one for files, or the file cannot be written.
    pub(crate) fn append(&self, name: &Str, text: &[u8]) -> Result<(), Fault> {
        let path = self.file(name)?;
        let fault = |problem: String| Fault::File { path: name.to_text().into(), problem: problem.into() };
        let directory = path.parent().unwrap_or(&self.0);
        if !directory.is_dir() {
            return Err(fault(format!("its directory {} does not exist", directory.display())));
        }
        let mut file = fs::OpenOptions::new()
            .append(true)
            .create(true)
            .open(&path)
            .map_err(|error| fault(format!("cannot be opened for writing: {error}")))?;
        file.write_all(text).map_err(|error| fault(format!("cannot be written: {error}")))
    }
}

/// A line of a text file, without its end; lines count from 1. `external_file` looks below `USB`.
///
/// # Errors
/// 10064: there is no such file, or it cannot be read; 10065: it has no such line; a path that leads out of the script
/// directory.
pub async fn gettextstr(cx: &Cx, file_path: &Str, line_no: i32, external_file: bool) -> Result<Str, Fault> {
    cx.motion_end().await;
    let inner = Path::new(if external_file { USB } else { "" });
    let path = cx.world().scripts.below(file_path, inner)?;
    let text = fs::read(path).map_err(|_| Fault::NoSuchFile(file_path.to_text().into()))?;
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
/// There is no such file, or its path leads out of the script directory.
pub async fn filesize(cx: &Cx, file_name: &Str) -> Result<i32, Fault> {
    cx.motion_end().await;
    let path = cx.world().scripts.file(file_name)?;
    match fs::metadata(path) {
        Ok(data) if data.is_file() => Ok(i32::try_from(data.len()).unwrap_or(i32::MAX)),
        _ => Err(Fault::NoSuchFile(file_name.to_text().into())),
    }
}

/// Gives a file another name; whether it worked. A file that has the new name already stays as it is: false.
///
/// # Errors
/// A path leads out of the script directory.
pub async fn renamefile(cx: &Cx, file_name: &Str, new_file_name: &Str) -> Result<bool, Fault> {
    cx.motion_end().await;
    let scripts = &cx.world().scripts;
    let (from, to) = (scripts.file(file_name)?, scripts.file(new_file_name)?);
    Ok(from.is_file() && !to.exists() && fs::rename(from, to).is_ok())
}

/// Deletes a file; whether it worked.
///
/// # Errors
/// The path leads out of the script directory.
pub async fn removefile(cx: &Cx, file_name: &Str) -> Result<bool, Fault> {
    cx.motion_end().await;
    let path = cx.world().scripts.file(file_name)?;
    Ok(fs::remove_file(path).is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_stay_below_the_script_directory() {
        let scripts = ScriptDir::new(PathBuf::from("/robot/scripts"));
        let file = |name: &str| scripts.file(&name.into()).map(|path| path.display().to_string());
        assert_eq!(file("mylog/a.log").unwrap(), "/robot/scripts/mylog/a.log");
        assert_eq!(file("./a.log").unwrap(), "/robot/scripts/a.log");
        assert_eq!(file("/home/ae/script/sub/a.log").unwrap(), "/robot/scripts/sub/a.log");
        for wrong in
            ["", ".", "/", "/etc/passwd", "../a", "a/../../b", "/home/ae/script/../a", "/home/ae/script/", "a\0b"]
        {
            assert!(file(wrong).is_err(), "{wrong:?}");
        }
    }
}
