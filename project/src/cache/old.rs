//! The contents of the cache, and their removal.

use super::lock::{Lock, is_lockable, last_use};
use super::{Cache, Kind, PROGRAMS, RESULTS, RESULTS_END, RUNTIMES};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// What was removed and what was not.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub struct Removed {
    /// Compiled programs.
    pub programs: usize,
    /// Compiled runtimes.
    pub runtimes: usize,
    /// Files with results of sweeps.
    pub results: usize,
    /// The size of what was removed, in bytes.
    pub bytes: u64,
    /// The folders that were not removed: another process uses them, or they cannot be removed.
    pub kept: Vec<PathBuf>,
}

/// The kind of an entry of the cache.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum What {
    /// The folder of a program.
    Program,
    /// The folder of a runtime.
    Runtime,
    /// The file with the results of a sweep.
    Results,
}

/// A folder or a file of the cache.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) path: PathBuf,
    what: What,
    pub(super) used: SystemTime,
}

impl Cache {
    /// The contents of the cache: results, then programs, then runtimes; in each group the least recently used comes
    /// first.
    pub(super) fn entries(&self) -> Vec<Entry> {
        let mut all = Vec::new();
        for (name, what) in [(RESULTS, What::Results), (PROGRAMS, What::Program), (RUNTIMES, What::Runtime)] {
            let some = entries(&self.root.join(name)).filter(|path| is_ours(path, what));
            let mut some: Vec<Entry> = some
                .map(|path| Entry { used: last_use(&path).unwrap_or(SystemTime::UNIX_EPOCH), path, what })
                .collect();
            some.sort_by(|a, b| (a.used, &a.path).cmp(&(b.used, &b.path)));
            all.append(&mut some);
        }
        all
    }

    /// Removes everything that has not been used for this duration.
    pub fn clean(&self, unused_for: Duration) -> Removed {
        let now = SystemTime::now();
        let mut removed = Removed::default();
        // An entry with a time in the future is not old, unless everything is to be removed.
        let is_old = |entry: &Entry| {
            unused_for.is_zero() || now.duration_since(entry.used).is_ok_and(|unused| unused >= unused_for)
        };
        for entry in self.entries().iter().filter(|entry| is_old(entry)) {
            self.remove(entry, &mut removed);
        }
        removed
    }

    /// Removes a program with what cargo keeps of it, a runtime, or results; but not a folder that is in use.
    pub(super) fn remove(&self, Entry { path, what, .. }: &Entry, removed: &mut Removed) {
        // A process that is writing results continues in its open file; the next one starts a new file.
        let lock = (*what != What::Results).then(|| Lock::of_unused(path));
        if matches!(lock, Some(None)) {
            removed.kept.push(path.clone());
            return;
        }
        let mut bytes = 0;
        if *what == What::Program {
            let runtimes = folders(&self.root.join(RUNTIMES));
            bytes += runtimes.map(|runtime| remove_made(path, &runtime.join("target"))).sum::<u64>();
        }
        // Windows cannot remove a folder that contains an open file; on other systems the lock keeps other processes
        // out until the end.
        let lock = (!cfg!(windows)).then_some(lock);
        bytes += remove(path);
        drop(lock);
        removed.bytes += bytes;
        match what {
            _ if path.exists() => removed.kept.push(path.clone()),
            What::Program => removed.programs += 1,
            What::Runtime => removed.runtimes += 1,
            What::Results => removed.results += 1,
        }
    }
}

/// Whether an entry was made by this command: the folder given as the cache may contain other things and links to them.
fn is_ours(path: &Path, what: What) -> bool {
    let kind = std::fs::symlink_metadata(path).map(|about| about.file_type());
    match what {
        What::Results => {
            kind.is_ok_and(|kind| kind.is_file()) && path.extension().is_some_and(|end| end == RESULTS_END)
        }
        What::Program | What::Runtime => kind.is_ok_and(|kind| kind.is_dir()) && is_lockable(path),
    }
}

/// Removes what cargo made of a program for its own use; returns the number of bytes freed.
pub fn remove_made(program: &Path, target: &Path) -> u64 {
    made_of(program, target).iter().map(|path| remove(path)).sum()
}

/// The files that cargo made of a program in its target folder.
fn made_of(program: &Path, target: &Path) -> Vec<PathBuf> {
    let Some(package) = program.file_name().map(|name| name.to_string_lossy().into_owned()) else { return Vec::new() };
    let profiles = folders(target);
    let places = profiles.flat_map(|profile| {
        ["", "deps", "incremental", ".fingerprint"]
            .map(|name| if name.is_empty() { profile.clone() } else { profile.join(name) })
    });
    let paths = places.flat_map(|place| entries(&place));
    paths.filter(|path| path.file_name().is_some_and(|name| is_made_of(&name.to_string_lossy(), &package))).collect()
}

/// Whether this is the name of something that cargo makes of a package: `package`, `package-0123456789abcdef.d`,
/// `libpackage.so`, or the parts of a program of tests, `package-part1`; but not of what it makes of the same program
/// for another purpose, `package-debug`.
fn is_made_of(name: &str, package: &str) -> bool {
    let name = name.strip_prefix(std::env::consts::DLL_PREFIX).unwrap_or(name);
    let is_other =
        |rest: &str| Kind::ENDINGS.iter().any(|ending| rest.get(1..).is_some_and(|it| it.starts_with(ending)));
    let same = |(a, b): (u8, u8)| a == b || (a == b'_' && b == b'-');
    let rest = name.get(package.len()..);
    name.len() >= package.len()
        && name.bytes().zip(package.bytes()).all(same)
        && rest.is_some_and(|rest| {
            rest.is_empty() || (rest.starts_with(['-', '.']) && !is_other(rest)) || rest.starts_with("_part")
        })
}

/// The size in bytes of a file, or of all files below a folder; a file with several names counts once among them.
pub(super) fn bytes(path: &Path) -> u64 {
    let Ok(data) = std::fs::symlink_metadata(path) else { return 0 };
    if data.is_dir() { entries(path).map(|path| bytes(&path)).sum() } else { data.len() / names(&data) }
}

#[cfg(unix)]
fn names(data: &std::fs::Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::nlink(data).max(1)
}

#[cfg(not(unix))]
fn names(_: &std::fs::Metadata) -> u64 {
    1
}

/// Removes a folder or a file and returns the number of bytes freed. What cannot be removed stays.
fn remove(path: &Path) -> u64 {
    let before = bytes(path);
    let _ = if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
    before - bytes(path).min(before)
}

fn entries(folder: &Path) -> impl Iterator<Item = PathBuf> + use<> {
    std::fs::read_dir(folder).into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path()))
}

fn folders(folder: &Path) -> impl Iterator<Item = PathBuf> + use<> {
    entries(folder).filter(|path| path.is_dir())
}

#[cfg(test)]
mod tests {
    use super::super::lock::used_at;
    use super::*;

    #[test]
    fn names_of_what_cargo_makes() {
        let package = "arl-pick_me-0a1b2c3d";
        // As the system names libraries: `libNAME.so`, `NAME.dll`.
        let library = |name: &str, end: &str| format!("{}{name}{end}", std::env::consts::DLL_PREFIX);
        for name in [
            "arl-pick_me-0a1b2c3d",
            "arl-pick_me-0a1b2c3d.d",
            "arl_pick_me_0a1b2c3d-00ff.d",
            "arl-pick_me-0a1b2c3d-part1",
            &library("arl_pick_me_0a1b2c3d", std::env::consts::DLL_SUFFIX),
            &library("arl_pick_me_0a1b2c3d", ".d"),
        ] {
            assert!(is_made_of(name, package), "{name}");
        }
        for name in [
            "arl-pick_me-0a1b2c3",
            "arl-pick_me-0a1b2c3d4",
            "libarl_rt-00ff.rlib",
            "arl-pick-me-0a1b2c3d",
            "arl-pick_me-0a1b2c3d-library-0123456789abcdef",
            "arl_pick_me_0a1b2c3d_debug-00ff.d",
            "",
        ] {
            assert!(!is_made_of(name, package), "{name}");
        }
        let library = library("arl_pick_me_0a1b2c3d_library", std::env::consts::DLL_SUFFIX);
        assert!(is_made_of(&library, "arl-pick_me-0a1b2c3d-library"));
    }

    #[test]
    fn what_is_old_goes_with_what_cargo_made_of_it() {
        let root = std::env::temp_dir().join(format!("arl2rs-old-{}", std::process::id()));
        let cache = Cache { root: root.clone(), limit: None };
        let day = Duration::from_secs(24 * 3600);
        let program = |name: &str, age: u32| {
            let folder = root.join("programs").join(name);
            drop(Lock::take(&folder, true, "").expect("a lock"));
            used_at(&folder, SystemTime::now() - day * age);
            std::fs::write(folder.join("stamp"), "four").expect("written");
            let deps = root.join("runtime/r/target/debug/deps");
            std::fs::create_dir_all(&deps).expect("a folder");
            std::fs::write(deps.join(format!("{}-00ff", name.replace('-', "_"))), "seven..").expect("written");
        };
        program("arl-a-00000001", 3);
        program("arl-b-00000002", 1);
        program("arl-c-00000003", 3);
        drop(Lock::take(&root.join("runtime/r"), true, "").expect("a lock"));
        std::fs::write(root.join("not ours"), "stays").expect("written");
        // Folders and files of other programs, and links to them.
        std::fs::create_dir_all(root.join("programs/mine")).expect("a folder");
        std::fs::create_dir_all(root.join("results")).expect("a folder");
        std::fs::write(root.join("results/mine.txt"), "stays").expect("written");
        #[cfg(unix)]
        std::os::unix::fs::symlink(root.join("programs/mine"), root.join("programs/link")).expect("a link");
        let results = cache.results("0a1b");
        std::fs::create_dir_all(results.parent().expect("a folder")).expect("a folder");
        std::fs::write(&results, "12345").expect("written");
        let old = std::fs::File::options().write(true).open(&results).expect("the file");
        old.set_modified(SystemTime::now() - day * 3).expect("the time is set");
        drop(old);
        let used = Lock::take(&root.join("programs/arl-c-00000003"), true, "").expect("a lock");
        used_at(&root.join("programs/arl-c-00000003"), SystemTime::now() - day * 3);

        let removed = cache.clean(day * 2);
        let kept = vec![root.join("programs/arl-c-00000003")];
        assert_eq!(removed, Removed { programs: 1, runtimes: 0, results: 1, bytes: 16, kept });
        let remaining: Vec<_> = entries(&root.join("runtime/r/target/debug/deps")).collect();
        assert_eq!(remaining.len(), 2, "{remaining:?}");

        drop(used);
        let removed = cache.clean(Duration::ZERO);
        assert_eq!((removed.programs, removed.runtimes, removed.kept), (2, 1, Vec::new()));
        for name in ["not ours", "results/mine.txt"] {
            assert_eq!(std::fs::read_to_string(root.join(name)).expect("it is there"), "stays");
        }
        assert_eq!(entries(&root.join("programs/mine")).count(), 0, "it is there, and nothing was left in it");
        assert_eq!(root.join("programs/link").exists(), cfg!(unix));
        std::fs::remove_dir_all(&root).expect("removed");
    }

    /// The clock of the computer was set back since the entry was used.
    #[test]
    fn what_was_used_in_the_future_ages_from_now_on() {
        let root = std::env::temp_dir().join(format!("arl2rs-future-{}", std::process::id()));
        let cache = Cache { root: root.clone(), limit: None };
        let day = Duration::from_secs(24 * 3600);
        let stamped = |name: &str, when: SystemTime| {
            let folder = root.join("programs").join(name);
            drop(Lock::take(&folder, true, "").expect("a lock"));
            used_at(&folder, when);
            folder
        };
        let future = stamped("arl-a-00000001", SystemTime::now() + day * 3650);
        let results = cache.results("0a1b");
        std::fs::create_dir_all(results.parent().expect("a folder")).expect("a folder");
        std::fs::write(&results, "12345").expect("written");
        let file = std::fs::File::options().write(true).open(&results).expect("the file");
        file.set_modified(SystemTime::now() + day).expect("the time is set");
        drop(file);
        assert_eq!(cache.clean(day), Removed::default());
        let is_now =
            |path: &Path| path.metadata().and_then(|data| data.modified()).expect("a time") <= SystemTime::now();
        assert!(is_now(&future.join("lock")) && is_now(&results), "they would stay for ten years");
        // An entry used after that is removed later.
        let later = stamped("arl-b-00000002", SystemTime::now());
        let order: Vec<PathBuf> = cache.entries().into_iter().map(|entry| entry.path).collect();
        assert_eq!(order, [results, future, later]);
        std::fs::remove_dir_all(&root).expect("removed");
    }
}
