//! Replaces files atomically: either the old or the new file is there, complete, at whatever moment the writer is
//! killed. Symbolic links, modes and owners are kept, and what other programs write meanwhile is not lost. Hard links
//! are separated: the other names keep the old content.

mod directory_lock;

use std::fmt;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use crate::regular_file;
use crate::renaming::rename;
use directory_lock::lock;

/// The ending of the name of a file that is to replace another one: `NAME.PROCESS-NUMBER` and this. No user names a
/// file like this.
const BESIDE: &str = ".arl-new";
/// The ending instead of `BESIDE` if the file may be the only copy of some content.
const KEPT: &str = "arl-kept";
/// How often a change is tried while others write the same file.
const TRIES: usize = 50;
/// The time after which an editor that has emptied a file has written it again.
const HALF_WRITTEN: Duration = Duration::from_millis(20);
/// The longest chain of symbolic links that is followed.
const MOST_LINKS: usize = 40;

/// The reason why a file was not changed; the old content is still there, except with [`ChangeError::Aside`].
#[derive(Debug)]
pub enum ChangeError<E> {
    /// The file cannot be read.
    Read(io::Error),
    /// The function that changes the content refuses.
    Refused(E),
    /// The file cannot be written.
    Write(io::Error),
    /// The file was replaced, but content that others may have written at that moment cannot be restored; it is kept in
    /// this file.
    Aside(PathBuf, io::Error),
}

impl<E: fmt::Display> fmt::Display for ChangeError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(error) => write!(f, "cannot be read: {error}"),
            Self::Refused(why) => why.fmt(f),
            Self::Write(error) => write!(f, "cannot be written: {error}"),
            Self::Aside(kept, error) => {
                write!(f, "was replaced; what it held just before is kept as {}: {error}", kept.display())
            }
        }
    }
}

impl<E: fmt::Debug + fmt::Display> std::error::Error for ChangeError<E> {}

/// Writes a file, whatever its old content. If the process is killed at any moment, either the old or the new content
/// is there, complete.
///
/// # Errors
/// The path is not a regular file, the file must not be written, or the file system fails; the old content is still
/// there.
pub fn write(path: &Path, content: &[u8]) -> io::Result<()> {
    let old = writable(path)?;
    let file = followed(path)?;
    let draft = Draft::new(&file, content, old.as_ref())?;
    {
        let _lock = lock(directory_of(&file))?;
        draft.replace(&file)?;
    }
    sync_directory(&file);
    Ok(())
}

/// Checks that [`write`] would write the file; whatever is at the path stays as it is, for others, too.
///
/// # Errors
/// The path is not a regular file, the file must not be written, or no file can be made in its directory.
pub fn expect_writable(path: &Path) -> io::Result<()> {
    /// Several threads may check the same directory.
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    if writable(path)?.is_some() {
        return Ok(());
    }
    let file = followed(path)?;
    if file.as_os_str().to_string_lossy().ends_with(std::path::is_separator) || file.file_name().is_none() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "this is the name of a directory"));
    }
    loop {
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let passing = directory_of(&file).join(format!("passing.{}-{number}{BESIDE}", std::process::id()));
        match create_held(&passing, true) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            held => return held.and_then(|_| fs::remove_file(&passing)),
        }
    }
}

/// Writes a file that does not exist yet.
///
/// # Errors
/// `AlreadyExists`, or an error of the file system.
pub fn create(path: &Path, content: &[u8]) -> io::Result<()> {
    if writable(path)?.is_some() {
        return Err(io::ErrorKind::AlreadyExists.into());
    }
    let file = followed(path)?;
    let _lock = lock(directory_of(&file))?;
    let draft = Draft::new(&file, content, None)?;
    draft.release();
    match fs::hard_link(&draft.path, &file) {
        Ok(()) => {}
        Err(_) if !file.exists() => rename(&draft.path, &file)?,
        Err(_) => return Err(io::ErrorKind::AlreadyExists.into()),
    }
    sync_directory(&file);
    Ok(())
}

/// Replaces the content of a file with the result of `change`, under a lock shared by all callers in all processes of
/// this computer. If another program, such as an editor, writes the file meanwhile, this is noticed and `change` is
/// called again.
///
/// # Errors
/// The file cannot be read or written, `change` refuses, or another program keeps writing. The file is as the others
/// have left it, except with [`ChangeError::Aside`].
pub fn change<E>(path: &Path, mut change: impl FnMut(&[u8]) -> Result<Vec<u8>, E>) -> Result<(), ChangeError<E>> {
    let read = |path: &Path| regular_file::read(path).map_err(ChangeError::Read);
    let file = followed(path).map_err(ChangeError::Read)?;
    let _lock = lock(directory_of(&file)).map_err(ChangeError::Write)?;
    for _ in 0..TRIES {
        let old = read(&file)?;
        match change(&old) {
            Ok(new) if new == old => return Ok(()),
            Ok(new) if replace(&file, &old, &new)? => {
                sync_directory(&file);
                return Ok(());
            }
            Ok(_) => std::thread::sleep(Duration::from_millis(1)),
            // A half-written file may make no sense: the writer gets time to finish it.
            Err(why) => {
                std::thread::sleep(HALF_WRITTEN);
                if read(&file)? == old {
                    return Err(ChangeError::Refused(why));
                }
            }
        }
    }
    Err(ChangeError::Write(io::Error::new(io::ErrorKind::ResourceBusy, "another program keeps writing it")))
}

/// Replaces the content if it is still the old one; returns whether it was.
fn replace<E>(file: &Path, old: &[u8], new: &[u8]) -> Result<bool, ChangeError<E>> {
    let metadata = writable(file).map_err(ChangeError::Write)?;
    let draft = Draft::new(file, new, metadata.as_ref()).map_err(ChangeError::Write)?;
    if fs::read(file).map_err(ChangeError::Read)? != old {
        return Ok(false);
    }
    match exchange(&draft.path, file) {
        Ok(()) => put_back_news(&draft.path, file, old, new).map_err(|error| ChangeError::Aside(draft.keep(), error)),
        Err(_) if !file.exists() => Ok(false),
        // Not every file system supports this. On such ones, what is written at this very moment is lost.
        Err(_) => draft.replace(file).map(|()| true).map_err(ChangeError::Write),
    }
}

/// After an exchange the file `beside` has the previous content. If that is not the content that was read, another
/// program has written in between, and its content is put back. Returns whether the new content stayed. After an error,
/// `beside` may have the content of the other program.
fn put_back_news(beside: &Path, file: &Path, old: &[u8], new: &[u8]) -> io::Result<bool> {
    let (mut expected, mut placed) = (old.to_vec(), new.to_vec());
    let mut stays = true;
    loop {
        let found = fs::read(beside)?;
        if found == expected {
            return Ok(stays);
        }
        stays = false;
        if exchange(beside, file).is_err() {
            return rename(beside, file).map(|()| stays);
        }
        (expected, placed) = (placed, found);
    }
}

/// Exchanges two files atomically.
#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
fn exchange(one: &Path, other: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    Ok(renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE)?)
}

#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
fn exchange(_one: &Path, _other: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

/// The target of a path with its links followed; it need not exist.
fn followed(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            Ok(target) => path = directory_of(&path).join(target),
            // Not a link; whether it exists is checked later.
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("its links form a loop"))
}

/// The metadata of a file that may be written; `None` if it does not exist.
fn writable(path: &Path) -> io::Result<Option<Metadata>> {
    match regular_file::expect(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        kind => kind?,
    }
    let file = OpenOptions::new().write(true).open(path)?;
    let metadata = file.metadata()?;
    // The superuser could open the file all the same.
    if metadata.permissions().readonly() {
        return Err(io::ErrorKind::PermissionDenied.into());
    }
    Ok(Some(metadata))
}

/// The directory of a file.
pub fn directory_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Writes a file's directory to the disk, so that a new name is there, too.
fn sync_directory(file: &Path) {
    // Some systems cannot sync a directory, but do so by themselves.
    if let Ok(directory) = File::open(directory_of(file)) {
        let _ = directory.sync_all();
    }
}

/// A file beside another one that it is to replace; removed again if it does not.
struct Draft {
    path: PathBuf,
    is_kept: bool,
    /// As long as this is open and locked, the file does not count as abandoned.
    held: File,
}

impl Draft {
    /// Creates a draft with this content, written to the disk, with the access rights of the file that it is to
    /// replace.
    fn new(file: &Path, content: &[u8], old: Option<&Metadata>) -> io::Result<Self> {
        /// Several threads may write the same file.
        static NUMBER: AtomicU64 = AtomicU64::new(0);
        let (path, mut held) = loop {
            let mut path = file.as_os_str().to_owned();
            path.push(format!(".{}-{}{BESIDE}", std::process::id(), NUMBER.fetch_add(1, Ordering::Relaxed)));
            let path = PathBuf::from(path);
            match create_held(&path, old.is_some()) {
                // Another computer, or a container, has a process with the same number.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                held => break (path, held?),
            }
        };
        let written = (|| {
            held.write_all(content)?;
            old.map_or(Ok(()), |old| make_alike(&held, old))?;
            held.sync_all()
        })();
        let draft = Self { path, is_kept: false, held };
        written.map(|()| draft)
    }

    /// Unlocks the draft before it gets the name of a file: on Windows nobody can read a file that is locked. The
    /// caller holds the lock of the directory, so that nobody takes the draft for an abandoned one.
    fn release(&self) {
        // A draft that could not be locked is not.
        let _ = self.held.unlock();
    }

    /// Lets the draft take the place of a file; as for [`release`](Self::release), the directory is locked.
    fn replace(&self, file: &Path) -> io::Result<()> {
        self.release();
        rename(&self.path, file)
    }

    /// Keeps the draft, if possible under a name that [`remove_leftovers`] ignores; returns its path.
    fn keep(mut self) -> PathBuf {
        self.is_kept = true;
        // Another computer, or a container, may have kept a draft of a process with the same number.
        let mut names = (0..).map(|number| self.path.with_extension(format!("{number}.{KEPT}")));
        let Some(kept) = names.find(|kept| !kept.exists()) else { return self.path.clone() };
        if rename(&self.path, &kept).is_ok() { kept } else { self.path.clone() }
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        if !self.is_kept {
            // If the draft has replaced the file, it no longer exists. An error here has no consequences.
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Gives a file the owner, group and mode of another one.
#[cfg(unix)]
fn make_alike(file: &File, old: &Metadata) -> io::Result<()> {
    use std::os::unix::fs::{MetadataExt, fchown};
    let own = file.metadata()?;
    if own.uid() != old.uid() {
        // Only few users may give files away: otherwise the writer of the file becomes its owner.
        let _ = fchown(file, Some(old.uid()), None);
    }
    if own.gid() != old.gid() && fchown(file, None, Some(old.gid())).is_err() {
        let mode = old.mode();
        if (mode >> 3) & 0o7 != mode & 0o7 {
            let words = "its group cannot be kept, and the group has other rights than everybody else";
            return Err(io::Error::new(io::ErrorKind::PermissionDenied, words));
        }
    }
    file.set_permissions(old.permissions())
}

#[cfg(not(unix))]
fn make_alike(file: &File, old: &Metadata) -> io::Result<()> {
    file.set_permissions(old.permissions())
}

/// Creates a file and holds its lock: as long as this process lives and has the file open, it does not count as
/// abandoned. A `private` file is not yet readable by other users.
fn create_held(path: &Path, private: bool) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    if private {
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    }
    #[cfg(not(unix))]
    let _ = private;
    loop {
        let file = options.open(path)?;
        // If files cannot be locked, none counts as abandoned.
        if file.lock().is_err() || path.exists() {
            return Ok(file);
        }
        // Another process has removed it before it was locked.
    }
}

/// Removes from a directory the leftovers of processes that were killed while writing.
pub fn remove_leftovers(directory: &Path) {
    // Files that cannot be inspected or removed stay; they do no harm.
    let Ok(entries) = fs::read_dir(directory) else { return };
    let leftovers =
        entries.filter_map(Result::ok).filter(|entry| is_in_the_making(&entry.file_name().to_string_lossy()));
    let mut leftovers = leftovers.map(|entry| entry.path()).peekable();
    if leftovers.peek().is_some() {
        // Another process may be exchanging two files: the file beside then is not an abandoned draft.
        let Ok(locked) = lock(directory) else { return };
        leftovers.for_each(|path| remove_abandoned(&path, &locked));
    }
}

fn is_in_the_making(name: &str) -> bool {
    let named = name.strip_suffix(BESIDE).and_then(|name| name.rsplit_once('.'));
    named.is_some_and(|(name, process)| {
        !name.is_empty() && !process.is_empty() && process.bytes().all(|byte| byte.is_ascii_digit() || byte == b'-')
    })
}

/// Removes a file that no process holds, in a directory that is locked (if directories can be).
fn remove_abandoned(path: &Path, _locked: &Option<File>) {
    if let Ok(file) = File::open(path)
        && file.try_lock().is_ok()
    {
        let _ = fs::remove_file(path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn folder(name: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("arl-robot-whole-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        path
    }

    fn names(path: &Path) -> BTreeSet<String> {
        fs::read_dir(path).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn leftovers_of_dead_processes_are_removed_and_files_of_living_ones_are_not() {
        let path = folder("left");
        // This process represents another living one: it holds its file.
        let alive = create_held(&path.join("I.state.17.arl-new"), false).unwrap();
        for name in ["I.state.1.arl-new", "BASE.2.state.12345678.arl-new", "p_data.arl.3.arl-new"] {
            fs::write(path.join(name), "part").unwrap();
        }
        let others = ["I.state", "I.state.arl-new", "I.state.1a.arl-new", "1.arl-new", "log.2024.new", "p_data.arl"];
        for name in others {
            fs::write(path.join(name), "a user's").unwrap();
        }
        remove_leftovers(&path);
        let mut remaining: BTreeSet<String> = others.map(String::from).into();
        remaining.insert("I.state.17.arl-new".into());
        assert_eq!(names(&path), remaining);
        drop(alive);
        remove_leftovers(&path);
        assert!(!names(&path).contains("I.state.17.arl-new"));
        remove_leftovers(&path.join("nowhere"));
        fs::remove_dir_all(&path).unwrap();
    }

    /// The file beside is not held by any process while two files are exchanged.
    #[test]
    fn nothing_is_removed_while_others_replace_files() {
        let path = folder("locked");
        let leftover = path.join("I.state.1.arl-new");
        fs::write(&leftover, "an editor's").unwrap();
        let held = lock(&path).unwrap().unwrap();
        std::thread::scope(|scope| {
            let removes = scope.spawn(|| remove_leftovers(&path));
            std::thread::sleep(Duration::from_millis(100));
            assert!(leftover.exists() && !removes.is_finished());
            drop(held);
        });
        assert!(!leftover.exists());
        fs::remove_dir_all(&path).unwrap();
    }

    #[test]
    fn what_may_be_the_only_copy_stays() {
        let folder = folder("only");
        let path = folder.join("a.arl");
        fs::write(&path, "new").unwrap();
        // A directory cannot be read.
        assert!(put_back_news(&folder, &path, b"old", b"new").is_err());
        let kept = Draft::new(&path, b"an editor's", None).unwrap().keep();
        remove_leftovers(&folder);
        assert_eq!((fs::read(&path).unwrap(), fs::read(&kept).unwrap()), (b"new".into(), b"an editor's".into()));
        let error = ChangeError::<String>::Aside(kept, io::ErrorKind::Interrupted.into()).to_string();
        assert!(error.contains(".arl-kept: ") && !error.contains("cannot be written"), "{error}");
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn nothing_remains_beside_a_file() {
        let path = folder("beside");
        for content in ["one", "two"] {
            write(&path.join("a.txt"), content.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(path.join("a.txt")).unwrap(), content);
        }
        fs::create_dir(path.join("b")).unwrap();
        assert!(write(&path.join("b"), b"no file").is_err());
        assert_eq!(names(&path), ["a.txt", "b"].map(String::from).into());
        fs::remove_dir_all(&path).unwrap();
    }

    #[test]
    fn threads_that_write_one_file_leave_it_whole() {
        let folder = folder("threads");
        let path = folder.join("kept");
        let texts = [[b'a'; 4096], [b'b'; 4096]];
        std::thread::scope(|scope| {
            for text in &texts {
                scope.spawn(|| (0..50).for_each(|_| write(&path, text).unwrap()));
            }
            for _ in 0..50 {
                let read = fs::read(&path).unwrap_or_else(|_| texts[0].into());
                assert!(texts.iter().any(|text| read == text), "{} bytes", read.len());
            }
        });
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "nothing is left beside it");
        fs::remove_dir_all(&folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn links_and_modes_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = folder("links");
        let (real, link, second) = (folder.join("real.arl"), folder.join("link.arl"), folder.join("second.arl"));
        symlink("real.arl", &link).unwrap();
        symlink(&link, &second).unwrap();
        // Also through a link whose target does not exist yet.
        write(&second, b"new").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o7777;
        for bits in [0o660, 0o600, 0o4755] {
            fs::set_permissions(&real, fs::Permissions::from_mode(bits)).unwrap();
            write(&second, b"one").unwrap();
            assert_eq!((mode(&real), fs::read(&real).unwrap()), (bits, b"one".to_vec()));
            change(&link, |old| Ok::<_, String>([old, b"two"].concat())).unwrap();
            assert_eq!((mode(&real), fs::read(&real).unwrap()), (bits, b"onetwo".to_vec()));
            assert!([&link, &second].iter().all(|path| path.is_symlink()) && !real.is_symlink());
        }
        fs::set_permissions(&real, fs::Permissions::from_mode(0o444)).unwrap();
        assert_eq!(write(&link, b"three").unwrap_err().kind(), io::ErrorKind::PermissionDenied);
        let refused = change(&link, |_| Ok::<_, String>(b"three".to_vec())).unwrap_err();
        assert!(matches!(refused, ChangeError::Write(_)), "{refused}");
        symlink("round.arl", folder.join("round.arl")).unwrap();
        assert!(write(&folder.join("round.arl"), b"nowhere").is_err());
        assert!(write(Path::new("/dev/null"), b"nothing").is_err(), "a device stays one");
        assert_eq!(fs::read(&real).unwrap(), b"onetwo");
        assert_eq!(names(&folder), ["link.arl", "real.arl", "round.arl", "second.arl"].map(String::from).into());
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn changes_of_several_are_all_there() {
        let folder = folder("changes");
        let path = folder.join("kept");
        fs::write(&path, "").unwrap();
        std::thread::scope(|scope| {
            for who in 0..4 {
                let add = move |old: &[u8], number| [old, format!("{who}.{number}\n").as_bytes()].concat();
                let path = &path;
                scope.spawn(move || {
                    for number in 0..25 {
                        change(path, |old| Ok::<_, String>(add(old, number))).unwrap();
                    }
                });
            }
        });
        let lines: BTreeSet<_> = fs::read_to_string(&path).unwrap().lines().map(str::to_owned).collect();
        assert_eq!(lines.len(), 100);
        assert_eq!(names(&folder), ["kept"].map(String::from).into());
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn what_others_write_meanwhile_is_not_lost() {
        let folder = folder("others");
        let path = folder.join("kept");
        fs::write(&path, "a").unwrap();
        // An editor writes after the file was read, twice: in place, and by a file that replaces it.
        let mut asked = 0;
        let changed = change(&path, |old| {
            asked += 1;
            match asked {
                1 => fs::write(&path, "b").unwrap(),
                2 => {
                    fs::write(folder.join("new"), "c").unwrap();
                    fs::rename(folder.join("new"), &path).unwrap();
                }
                _ => {}
            }
            Ok::<_, String>([old, b"!"].concat())
        });
        changed.unwrap();
        assert_eq!((asked, fs::read_to_string(&path).unwrap()), (3, "c!".to_owned()));
        // A program that keeps writing keeps its file.
        let mut number = 0;
        let never = change(&path, |old| {
            number += 1;
            fs::write(&path, number.to_string()).unwrap();
            Ok::<_, String>([old, b"!"].concat())
        });
        assert!(never.unwrap_err().to_string().contains("keeps writing"));
        assert_eq!(fs::read_to_string(&path).unwrap(), number.to_string());
        // A function that refuses a half-written file is called again.
        let mut asked = 0;
        let whole = |old: &[u8]| if old == b"half" { Err("half") } else { Ok(b"done".to_vec()) };
        fs::write(&path, "half").unwrap();
        let changed = change(&path, |old| {
            asked += 1;
            fs::write(&path, "whole").unwrap();
            whole(old)
        });
        assert!(changed.is_ok() && asked == 2);
        fs::write(&path, "half").unwrap();
        assert!(matches!(change(&path, whole), Err(ChangeError::Refused("half"))));
        fs::remove_dir_all(&folder).unwrap();
    }

    /// Content written between the last check and the exchange is found beside, and put back.
    #[cfg(target_os = "linux")]
    #[test]
    fn what_was_exchanged_unseen_comes_back() {
        let folder = folder("unseen");
        let (beside, path) = (folder.join("beside"), folder.join("kept"));
        fs::write(&path, "new").unwrap();
        fs::write(&beside, "an editor's").unwrap();
        assert!(!put_back_news(&beside, &path, b"old", b"new").unwrap());
        assert_eq!((fs::read(&path).unwrap(), fs::read(&beside).unwrap()), (b"an editor's".into(), b"new".into()));
        fs::write(&path, "new").unwrap();
        fs::write(&beside, "old").unwrap();
        assert!(put_back_news(&beside, &path, b"old", b"new").unwrap());
        assert_eq!(fs::read(&path).unwrap(), b"new");
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn what_is_there_is_not_made_anew() {
        let folder = folder("anew");
        let path = folder.join("kept");
        create(&path, b"first").unwrap();
        assert_eq!(create(&path, b"second").unwrap_err().kind(), io::ErrorKind::AlreadyExists);
        assert_eq!((fs::read(&path).unwrap(), names(&folder).len()), (b"first".into(), 1));
        fs::remove_dir_all(&folder).unwrap();
    }
}
