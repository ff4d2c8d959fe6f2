//! Locks that the cycle shares with threads beside it, and does not wait for.

use std::sync::{Mutex, MutexGuard, TryLockError};

/// How often the cycle tries to take a lock: for some microseconds. Its holder only copies some bytes.
const MAX_ATTEMPTS: usize = 100;

/// The value behind the lock, unless another thread holds it for longer than copying takes: then that thread has just
/// been interrupted, and the cycle does not wait for it. The value is consistent even after a panic of the other
/// thread: nothing between two changes can panic.
pub(crate) fn try_lock<T>(mutex: &Mutex<T>) -> Option<MutexGuard<'_, T>> {
    for _ in 0..MAX_ATTEMPTS {
        match mutex.try_lock() {
            Ok(guard) => return Some(guard),
            Err(TryLockError::Poisoned(guard)) => return Some(guard.into_inner()),
            Err(TryLockError::WouldBlock) => std::hint::spin_loop(),
        }
    }
    None
}
