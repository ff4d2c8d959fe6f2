//! Threads beside the cycle go on after a panic, and so does the cycle when a listener panics: only the work in which
//! the panic happens is lost.

use std::panic::{AssertUnwindSafe, catch_unwind};

/// Does work that may panic. `None`: it has panicked, which the panic hook has reported. The data that threads share
/// with the cycle is consistent even then: nothing between two changes of it can panic.
pub(crate) fn catch_panic<T>(work: impl FnOnce() -> T) -> Option<T> {
    catch_unwind(AssertUnwindSafe(work)).ok()
}
