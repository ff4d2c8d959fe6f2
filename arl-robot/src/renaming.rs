//! Renames files that others have open for a moment: virus scanners, indexers, readers. Windows then refuses; other
//! systems never do.

use std::fs;
use std::io;
use std::path::Path;
use std::time::Duration;

/// The waits between the tries, in ms; together about 2 s.
const WAITS_MS: [u64; 12] = [1, 2, 5, 10, 20, 50, 100, 200, 300, 400, 400, 500];

/// Gives a file another name; a file that had it is replaced. It may take 2 s: nothing that a control cycle waits
/// for calls it.
///
/// # Errors
/// The file system refuses, also after tries for about 2 s where another program has one of the files open.
pub fn rename(from: &Path, to: &Path) -> io::Result<()> {
    tried_again(|| fs::rename(from, to), is_held, std::thread::sleep)
}

/// Does something again and again as long as it fails like this.
fn tried_again(
    mut act: impl FnMut() -> io::Result<()>,
    may_pass: impl Fn(&io::Error) -> bool,
    wait: impl Fn(Duration),
) -> io::Result<()> {
    for milliseconds in WAITS_MS {
        match act() {
            Err(error) if may_pass(&error) => wait(Duration::from_millis(milliseconds)),
            done => return done,
        }
    }
    act()
}

/// Whether an error says that another program has the file open.
fn is_held(error: &io::Error) -> bool {
    /// Of Windows: access denied (also where the target is open), sharing violation, lock violation, and a file that
    /// is mapped into memory.
    const HELD: [i32; 4] = [5, 32, 33, 1224];
    cfg!(windows) && error.raw_os_error().is_some_and(|code| HELD.contains(&code))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn what_is_held_for_a_moment_is_tried_again() {
        let (tries, waited) = (Cell::new(0), Cell::new(Duration::ZERO));
        let wait = |time| waited.set(waited.get() + time);
        let until = |last: u32| {
            let tries = &tries;
            move || {
                tries.set(tries.get() + 1);
                if tries.get() < last { Err(io::ErrorKind::PermissionDenied.into()) } else { Ok(()) }
            }
        };
        assert!(tried_again(until(4), |_| true, wait).is_ok());
        assert_eq!((tries.take(), waited.take()), (4, Duration::from_millis(8)));
        assert!(tried_again(until(2), |_| false, wait).is_err());
        assert_eq!((tries.take(), waited.take()), (1, Duration::ZERO));
        assert!(tried_again(until(100), |_| true, wait).is_err());
        assert_eq!(tries.get(), 13);
        assert!(waited.get() > Duration::from_millis(1500) && waited.get() < Duration::from_millis(2500));
    }
}
