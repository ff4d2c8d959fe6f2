//! Limits the size of the cache.

use super::old::{Entry, Removed, bytes};
use super::{Cache, Place};
use arl_terminal::failure::Failure;
use std::path::Path;

/// The environment variable that limits the size of the cache, in gigabytes.
const VARIABLE: &str = "ARL2RS_CACHE_LIMIT";

/// The default limit: some hundred programs.
const USUAL: u64 = 4_000_000_000;

/// The minimum limit: less would not hold a runtime with a program and its tests.
const LEAST: u64 = 1_000_000_000;

/// The maximum size of the cache in bytes; `None` for no limit.
///
/// # Errors
/// The variable is not a number, or the number is too small.
pub(super) fn read() -> Result<Option<u64>, Failure> {
    match std::env::var(VARIABLE) {
        Ok(words) if !words.trim().is_empty() => of(words.trim()).ok_or_else(|| {
            Failure::Usage(format!(
                "{VARIABLE} is `{words}`: expected how many gigabytes the cache may take, at least {}, or `none`",
                LEAST / 1_000_000_000
            ))
        }),
        _ => Ok(Some(USUAL)),
    }
}

impl Cache {
    /// Removes programs, runtimes and results of sweeps, the least recently used first, until the rest is within the
    /// limit. The program that was just made stays. Its runtime is removed last: the next program would then compile it
    /// again.
    pub fn keep_limit(&self, made: &Place, runtime: &Path) -> Removed {
        let mut removed = Removed::default();
        let Some(limit) = self.limit else { return removed };
        let mut total = bytes(&self.root);
        if total <= limit {
            return removed;
        }
        let mut entries = self.entries();
        entries.retain(|entry| entry.path != made.folder);
        let is_last = |entry: &Entry| entry.path == runtime;
        entries.sort_by(|a, b| (is_last(a), a.used, &a.path).cmp(&(is_last(b), b.used, &b.path)));
        for entry in &entries {
            if total <= limit {
                break;
            }
            let before = removed.bytes;
            self.remove(entry, &mut removed);
            total = total.saturating_sub(removed.bytes - before);
        }
        removed
    }
}

fn of(words: &str) -> Option<Option<u64>> {
    if words == "none" {
        return Some(None);
    }
    let gigabytes: f64 = words.parse().ok()?;
    let bytes = gigabytes * 1e9;
    (bytes >= LEAST as f64 && bytes < u64::MAX as f64).then_some(Some(bytes as u64))
}

#[cfg(test)]
mod tests {
    use super::super::lock::{Lock, used_at};
    use super::*;
    use std::time::{Duration, SystemTime};

    #[test]
    fn limits_are_gigabytes() {
        assert_eq!(of("none"), Some(None));
        assert_eq!(of("2.5"), Some(Some(2_500_000_000)));
        for wrong in ["0", "0.5", "-3", "nan", "inf", "4 GB", "many"] {
            assert_eq!(of(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn what_was_not_used_for_longest_goes_first() {
        let root = std::env::temp_dir().join(format!("arl2rs-limit-{}", std::process::id()));
        let with = |limit| Cache { root: root.clone(), limit };
        let add = |name: &str, age: u64| {
            let folder = root.join(name);
            drop(Lock::take(&folder, true, "").expect("a lock"));
            std::fs::write(folder.join("data"), [0; 100]).expect("written");
            used_at(&folder, SystemTime::now() - Duration::from_secs(age));
            folder
        };
        let made = Place { folder: add("programs/made", 90), name: "made".into() };
        let runtime = add("runtime/used", 100);
        let old = [add("programs/a", 40), add("runtime/older", 50), add("programs/b", 60)];
        let there = || old.each_ref().map(|folder| folder.exists());
        assert_eq!(with(Some(500)).keep_limit(&made, &runtime), Removed::default());
        assert_eq!(with(None).keep_limit(&made, &runtime), Removed::default());
        assert_eq!(with(Some(450)).keep_limit(&made, &runtime).programs, 1);
        assert_eq!(there(), [true, true, false]);
        assert_eq!(with(Some(300)).keep_limit(&made, &runtime).runtimes, 1);
        assert_eq!(there(), [true, false, false]);
        with(Some(10)).keep_limit(&made, &runtime);
        assert!(made.folder.exists() && !runtime.exists(), "the program that was just made stays, whatever the limit");
        std::fs::remove_dir_all(&root).expect("removed");
    }
}
