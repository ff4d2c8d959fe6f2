//! Files for the results of a run. Whether such a file can be written is known at once, but what it held stays until
//! there is a result: a run that is refused destroys nothing.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::{atomic_file, regular_file};

/// A file for a result that does not exist yet: it is either [replaced](ResultFile::replace) at the end, or written
/// from the first byte on as a stream.
#[derive(Debug)]
pub struct ResultFile {
    path: PathBuf,
    /// The stream, once something was written.
    stream: Option<File>,
}

impl ResultFile {
    /// Checks that the file can be written; nothing of it changes.
    ///
    /// # Errors
    /// The path is a directory, its folder does not exist, or the file must not be written.
    pub fn new(path: &Path) -> io::Result<Self> {
        // A named pipe that is opened would wait for its reader, who is there once.
        if !is_special(path) {
            atomic_file::expect_writable(path)?;
        }
        Ok(Self { path: path.to_owned(), stream: None })
    }

    /// The path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Puts a whole result in the place of what the file held. If the process is killed meanwhile, either of them is
    /// there, except where only the file may be written and nothing can be made or renamed beside it. A device or a
    /// pipe gets the bytes.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn replace(self, content: &[u8]) -> io::Result<()> {
        if is_special(&self.path) {
            return OpenOptions::new().write(true).open(&self.path)?.write_all(content);
        }
        match atomic_file::write(&self.path, content) {
            Err(error) if is_of_the_folder(error.kind()) => fs::write(&self.path, content),
            written => written,
        }
    }

    /// The stream: the file is emptied when it is first used.
    fn stream(&mut self) -> io::Result<&mut File> {
        match &mut self.stream {
            Some(stream) => Ok(stream),
            none => Ok(none.insert(File::create(&self.path)?)),
        }
    }
}

impl Write for ResultFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream()?.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.as_mut().map_or(Ok(()), File::flush)
    }
}

impl Seek for ResultFile {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.stream()?.seek(position)
    }
}

/// Whether an error may come from the folder of a file, while the file itself can be written: it is mounted on its own,
/// others hold the folder, or a name beside it is too long. A full disk is not such an error: what the file held is
/// better than nothing.
fn is_of_the_folder(error: io::ErrorKind) -> bool {
    use io::ErrorKind::{
        CrossesDevices, InvalidFilename, PermissionDenied, ReadOnlyFilesystem, ResourceBusy, TimedOut, Unsupported,
    };
    let kinds =
        [CrossesDevices, InvalidFilename, PermissionDenied, ReadOnlyFilesystem, ResourceBusy, TimedOut, Unsupported];
    kinds.contains(&error)
}

/// Whether the path is a device, a pipe or a socket.
fn is_special(path: &Path) -> bool {
    regular_file::expect(path).is_err_and(|error| error.kind() == io::ErrorKind::InvalidInput)
}

/// Checks that no result would be written over another one or over an input. Each path stands behind what it is for:
/// `--trace`, `the program`. Devices and pipes do not count.
///
/// # Errors
/// What would be overwritten, and by what.
pub fn expect_apart(results: &[(&str, &Path)], inputs: &[(&str, &Path)]) -> Result<(), String> {
    for (at, (option, path)) in results.iter().enumerate() {
        let is_same = |(_, other): &&(&str, &Path)| !is_special(path) && same_file(path, other);
        if let Some((input, _)) = inputs.iter().find(is_same) {
            return Err(format!("{option} would overwrite {}, which is {input}: name another file", path.display()));
        }
        if let Some((other, _)) = results.iter().skip(at + 1).find(is_same) {
            return Err(format!("{option} and {other} would write the same file, {}", path.display()));
        }
    }
    Ok(())
}

/// Whether two paths lead to the same file, which need not exist.
fn same_file(one: &Path, other: &Path) -> bool {
    let place = |path: &Path| {
        let there = path.canonicalize();
        there
            .or_else(|_| Ok(atomic_file::directory_of(path).canonicalize()?.join(path.file_name().unwrap_or_default())))
    };
    match (place(one), place(other)) {
        (Ok(one), Ok(other)) => one == other,
        (Err::<_, io::Error>(_), _) | (_, Err(_)) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("arl-result-{name}-{}", std::process::id()));
            fs::create_dir_all(&path).unwrap();
            Self(path)
        }

        fn file(&self, name: &str) -> PathBuf {
            self.0.join(name)
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn what_a_file_held_stays_until_there_is_a_result() {
        let folder = Folder::new("stays");
        let (old, new) = (folder.file("old"), folder.file("new"));
        fs::write(&old, "as it was").unwrap();
        drop(ResultFile::new(&old).unwrap());
        drop(ResultFile::new(&new).unwrap());
        assert_eq!((fs::read_to_string(&old).unwrap(), new.exists()), ("as it was".to_owned(), false));
        let mut stream = ResultFile::new(&old).unwrap();
        stream.flush().unwrap();
        assert_eq!(fs::read_to_string(&old).unwrap(), "as it was");
        stream.write_all(b"new").unwrap();
        stream.seek(SeekFrom::Start(1)).unwrap();
        stream.write_all(b"o").unwrap();
        assert_eq!(fs::read_to_string(&old).unwrap(), "now");
        ResultFile::new(&new).unwrap().replace(b"whole").unwrap();
        assert_eq!(fs::read_to_string(&new).unwrap(), "whole");
    }

    // Wine finds no file of a name that is too long, where Windows refuses the name.
    #[cfg(unix)]
    #[test]
    fn a_file_is_written_where_nothing_can_be_made_beside_it() {
        let folder = Folder::new("beside");
        // No name beside this one can be made from it.
        let file = folder.file(&"a".repeat(255));
        for old in ["as it was", "and again"] {
            ResultFile::new(&file).unwrap().replace(old.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(&file).unwrap(), old);
        }
        assert!(ResultFile::new(&folder.file(&"a".repeat(256))).is_err());
    }

    #[test]
    fn what_cannot_be_written_is_known_at_once() {
        let folder = Folder::new("refused");
        assert!(ResultFile::new(&folder.0).is_err());
        assert!(ResultFile::new(&folder.file("nowhere/a.csv")).is_err());
        assert!(ResultFile::new(&folder.file("nowhere/")).is_err() && ResultFile::new(&folder.file("..")).is_err());
        #[cfg(unix)]
        {
            ResultFile::new(Path::new("/dev/null")).unwrap().replace(b"gone").unwrap();
            let link = folder.file("link");
            std::os::unix::fs::symlink("target", &link).unwrap();
            drop(ResultFile::new(&link).unwrap());
            assert!(!folder.file("target").exists(), "nothing is made before there is a result");
            ResultFile::new(&link).unwrap().replace(b"through a link").unwrap();
            assert_eq!(fs::read_to_string(folder.file("target")).unwrap(), "through a link");
            assert!(link.is_symlink());
        }
    }

    #[test]
    fn results_stay_apart_from_inputs_and_each_other() {
        let folder = Folder::new("apart");
        fs::create_dir_all(folder.file("inner")).unwrap();
        fs::write(folder.file("a.arl"), "").unwrap();
        let (program, around) = (folder.file("a.arl"), folder.file("inner/../a.arl"));
        let inputs: &[(&str, &Path)] = &[("the program", &program)];
        let refused = expect_apart(&[("--plot", &around)], inputs).unwrap_err();
        assert!(refused.starts_with("--plot would overwrite") && refused.contains("the program"), "{refused}");
        let (new, again) = (folder.file("new.csv"), folder.file("inner/../new.csv"));
        let refused = expect_apart(&[("--trace", &new), ("--record", &again)], inputs).unwrap_err();
        assert!(refused.starts_with("--trace and --record would write the same file"), "{refused}");
        let other = folder.file("other.csv");
        assert_eq!(expect_apart(&[("--trace", &new), ("--record", &other)], inputs), Ok(()));
        #[cfg(unix)]
        assert_eq!(
            expect_apart(&[("--trace", Path::new("/dev/null")), ("--record", Path::new("/dev/null"))], &[]),
            Ok(())
        );
    }
}
