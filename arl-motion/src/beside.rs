//! Threads in parallel with the cycle, for work that must not take time from the cycle.

use std::io;
use std::sync::OnceLock;
use std::thread::{Builder, JoinHandle};

/// What each of these threads does first, where it was set.
static FIRST: OnceLock<fn()> = OnceLock::new();

/// Sets what each thread in parallel with the cycle does first, from now on, for example to lower its priority below
/// that of the cycle. Only the first call takes effect.
pub fn each_does_first(first: fn()) {
    let _ = FIRST.set(first);
}

/// Starts a thread in parallel with the cycle.
///
/// # Errors
/// The system cannot start another thread.
pub fn spawn<T: Send + 'static>(
    thread: Builder,
    work: impl FnOnce() -> T + Send + 'static,
) -> io::Result<JoinHandle<T>> {
    thread.spawn(move || {
        if let Some(first) = FIRST.get() {
            first();
        }
        work()
    })
}
