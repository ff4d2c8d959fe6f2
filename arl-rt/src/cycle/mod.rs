//! The control cycle: how long it is, where its time comes from, which channels run in it, and what it shares with threads
//! beside it.
//!
//! It imports no other room.

pub(crate) mod catch_panic;
pub(crate) mod channel_id;
pub mod clock_source;
pub(crate) mod try_lock;
