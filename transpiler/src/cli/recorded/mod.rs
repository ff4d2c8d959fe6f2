//! What a recording says of a run, laid out so that any stretch of time, any line and any signal can be asked for.

mod bounds;
mod read;
mod store;

#[cfg(any(test, feature = "fuzzing"))]
pub(super) use read::of;
pub(super) use read::read;
pub(super) use store::{Signal, Store, TOLD_AGAIN, Took, Track};
