//! The script directory, which contains all files of a program.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use arl_robot::regular_file;

use crate::fault::Fault;
use crate::values::Str;

/// The path of the script directory on a controller; programs may name files with it.
const ON_CONTROLLER: &str = "/home/ae/script/";

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

    /// The path of the file with this name in the directory.
    ///
    /// # Errors
    /// The name is empty, absolute, or leads out of the directory.
    pub(crate) fn file(&self, name: &Str) -> Result<PathBuf, Fault> {
        self.below(name, Path::new(""))
    }

    /// The path of the file with this name in `inner`, a directory in this one.
    ///
    /// # Errors
    /// The name is empty, absolute, or leads out of the directory.
    pub(crate) fn below(&self, name: &Str, inner: &Path) -> Result<PathBuf, Fault> {
        let text = name.to_text();
        let problem = |problem: &str| Fault::File { path: text.clone().into(), problem: problem.into() };
        let relative = text.strip_prefix(ON_CONTROLLER).unwrap_or(&text);
        if relative.starts_with('/') {
            return Err(problem("paths are relative to the script directory, or begin with /home/ae/script/"));
        }
        let mut path = self.0.join(inner);
        let mut named = false;
        // By the rules of the controller on every system: `/` alone separates.
        for part in relative.split('/').filter(|part| !["", "."].contains(part)) {
            if part == ".." {
                return Err(problem("a path with `..` may lead out of the script directory"));
            }
            if cfg!(windows) && !is_a_name_on_windows(part) {
                return Err(problem("Windows has no files of this name"));
            }
            path.push(part);
            named = true;
        }
        if named && !text.contains('\0') { Ok(path) } else { Err(problem("this is not a file name")) }
    }

    /// Appends to a file; a missing file is created, a missing directory is not.
    ///
    /// # Errors
    /// The name is not a file name, or the file cannot be written.
    pub(crate) fn append(&self, name: &Str, text: &[u8]) -> Result<(), Fault> {
        let path = self.file(name)?;
        let fault = |problem: String| Fault::File { path: name.to_text().into(), problem: problem.into() };
        let directory = path.parent().unwrap_or(&self.0);
        if !directory.is_dir() {
            return Err(fault(format!("its directory {} does not exist", directory.display())));
        }
        match regular_file::expect(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                return Err(fault(format!("cannot be written: {error}")));
            }
            _ => {}
        }
        let mut file = fs::OpenOptions::new()
            .append(true)
            .create(true)
            .open(&path)
            .map_err(|error| fault(format!("cannot be opened for writing: {error}")))?;
        append_whole(&mut file, text).map_err(|error| fault(format!("cannot be written: {error}")))
    }
}

/// Whether Windows can give a file this name: no separators, streams, patterns or devices.
fn is_a_name_on_windows(part: &str) -> bool {
    const DEVICES: [&str; 6] = ["CON", "PRN", "AUX", "NUL", "CONIN$", "CONOUT$"];
    const NUMBERED: [&str; 2] = ["COM", "LPT"];
    let stem = part.split('.').next().unwrap_or_default().trim_end().to_ascii_uppercase();
    let is_digit = |number: &str| number.len() == 1 && number.bytes().all(|byte| byte.is_ascii_digit());
    let is_numbered = |device: &&str| stem.strip_prefix(*device).is_some_and(is_digit);
    !part.contains(|c: char| c.is_control() || "\\:*?\"<>|".contains(c))
        && !part.ends_with(['.', ' '])
        && !DEVICES.contains(&&*stem)
        && !NUMBERED.iter().any(is_numbered)
}

/// Appends a whole text, or nothing of it if the disk is full.
fn append_whole(file: &mut fs::File, text: &[u8]) -> io::Result<()> {
    let before = file.metadata()?.len();
    file.write_all(text).inspect_err(|_| {
        // If this fails, a part of the text stays.
        let _ = file.set_len(before);
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// If this is set, the test runs in a process of its own whose files may have 2048 bytes (4096 with some shells).
    #[cfg(target_os = "linux")]
    const FOLDER: &str = "ARL_TEST_SMALL_FILES";

    #[cfg(target_os = "linux")]
    #[test]
    fn a_message_that_finds_no_room_leaves_no_part_of_itself() {
        if let Ok(folder) = std::env::var(FOLDER) {
            let (scripts, line) = (ScriptDir::new(folder.clone().into()), [b'x'; 100]);
            let written = (0..100_u64).find(|_| scripts.append(&"log.txt".into(), &line).is_err()).unwrap();
            assert!((20..=40).contains(&written));
            return assert_eq!(fs::metadata(Path::new(&folder).join("log.txt")).unwrap().len(), 100 * written);
        }
        let folder = std::env::temp_dir().join(format!("arl-rt-no-room-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let name = "storage::script_dir::tests::a_message_that_finds_no_room_leaves_no_part_of_itself";
        let alone = std::process::Command::new("sh")
            .args(["-c", "trap '' XFSZ; ulimit -f 4; exec \"$0\" --exact \"$1\""])
            .arg(std::env::current_exe().unwrap())
            .arg(name)
            .env(FOLDER, &folder)
            .output()
            .unwrap();
        fs::remove_dir_all(&folder).unwrap();
        let output = String::from_utf8_lossy(&alone.stdout);
        assert!(alone.status.success() && output.contains("1 passed"), "{output}");
    }

    #[test]
    fn paths_stay_below_the_script_directory() {
        let scripts = ScriptDir::new(PathBuf::from("/robot/scripts"));
        let file = |name: &str| scripts.file(&name.into()).map(|path| path.display().to_string().replace('\\', "/"));
        assert_eq!(file("mylog/a.log").unwrap(), "/robot/scripts/mylog/a.log");
        assert_eq!(file("./a.log").unwrap(), "/robot/scripts/a.log");
        assert_eq!(file("/home/ae/script/sub/a.log").unwrap(), "/robot/scripts/sub/a.log");
        for wrong in
            ["", ".", "/", "/etc/passwd", "../a", "a/../../b", "/home/ae/script/../a", "/home/ae/script/", "a\0b"]
        {
            assert!(file(wrong).is_err(), "{wrong:?}");
        }
    }

    #[test]
    fn names_that_windows_has_no_files_for() {
        for name in ["a.log", "a b", "CONSOLE.log", "COM10", "com.txt", "点.txt", ".hidden"] {
            assert!(is_a_name_on_windows(name), "{name}");
        }
        for name in
            ["a\\b", "..\\a", "C:a", "a:b", "con", "Nul.txt", "COM1", "lpt9.log", "aux .x", "a.", "a ", "a*", "a\n"]
        {
            assert!(!is_a_name_on_windows(name), "{name}");
        }
    }
}
