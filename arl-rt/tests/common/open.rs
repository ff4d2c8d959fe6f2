//! What the process has open. It belongs to the process: tests that look at it run one at a time.

use std::path::Path;
use std::time::{Duration, Instant};

/// The names that our threads have.
const THREADS: [&str; 3] = ["connection", "connections", "modbus-tcp"];

/// What descriptors of connections lead to.
const KINDS: [&str; 4] = ["socket:", "anon_inode:", "/dev/pts/", "/dev/ptmx"];

/// Sockets, polls and terminals that are open, and our threads beside the cycle.
pub fn all() -> (usize, usize) {
    let links = std::fs::read_dir("/proc/self/fd").unwrap().filter_map(|entry| entry.unwrap().path().read_link().ok());
    let is_ours = |link: &Path| {
        let text = link.to_string_lossy();
        KINDS.iter().any(|kind| text.starts_with(kind))
    };
    let names = std::fs::read_dir("/proc/self/task").unwrap();
    let names = names.filter_map(|entry| std::fs::read_to_string(entry.unwrap().path().join("comm")).ok());
    (links.filter(|link| is_ours(link)).count(), names.filter(|name| THREADS.contains(&name.trim())).count())
}

/// Waits a while until no more is open than was then.
///
/// # Panics
/// Something is left.
pub fn wait_for(then: (usize, usize)) {
    let start = Instant::now();
    while all() != then && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(all(), then, "descriptors and threads are left");
}
