//! Locks that the cycle shares with threads beside it, and does not wait for.

use std::sync::{Mutex, MutexGuard, TryLockError};

/// How often the cycle looks again whether a lock is free: for some microseconds. Whoever has it copies some bytes.
const MAX_ATTEMPTS: usize = 100;

/// What is behind the lock, unless somebody else has it for longer than copying takes: its thread was interrupted just
/// then. The cycle does not wait for that. What a thread that panicked has left behind is whole: nothing between two
/// changes can panic.
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
