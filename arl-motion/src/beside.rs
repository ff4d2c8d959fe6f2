//! Threads beside the cycle: what takes its time must not take it from the cycle.

use std::io;
use std::sync::OnceLock;
use std::thread::{Builder, JoinHandle};

/// What each of them does first, where somebody says so.
static FIRST: OnceLock<fn()> = OnceLock::new();

/// Says what each thread beside the cycle does first, from now on: to take less of the computer than the cycle does.
/// What was said first holds.
pub fn each_does_first(first: fn()) {
    let _ = FIRST.set(first);
}

/// Starts a thread beside the cycle.
///
/// # Errors
/// The system has no threads left.
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
