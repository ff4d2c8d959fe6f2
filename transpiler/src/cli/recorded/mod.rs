//! What a recording says of a run, laid out so that any stretch of time, any line and any signal can be asked for.

mod read;
mod store;

pub(super) use read::read;
pub(super) use store::{Signal, Store, TOLD_AGAIN, Took, Track};
