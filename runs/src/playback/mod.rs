//! The run in a recording, laid out so that any stretch of time, any line and any signal can be queried.

mod bounds;
mod read;
mod store;

#[cfg(any(test, feature = "fuzzing"))]
pub(crate) use read::of;
pub(crate) use read::read;
pub(crate) use store::{REPORTED_AGAIN, Signal, Store, Took, Track};
