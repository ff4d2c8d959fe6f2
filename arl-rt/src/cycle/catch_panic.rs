//! Threads beside the cycle go on after a panic, and so does the cycle where others hear of something: it costs the
//! work in which it happens, and no more.

use std::panic::{AssertUnwindSafe, catch_unwind};

/// Does work that may panic. `None`: it has panicked, which the panic hook has reported. What threads share
/// with the cycle is whole then, too: nothing between two changes of it can panic.
pub(crate) fn catch_panic<T>(work: impl FnOnce() -> T) -> Option<T> {
    catch_unwind(AssertUnwindSafe(work)).ok()
}
