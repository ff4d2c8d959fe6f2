//! The control cycle: how long it is, where its time comes from and how late it may be, what it has of the operating
//! system, which channels run in it, and what it shares with threads beside it.
//!
//! It imports no other room.

pub(crate) mod catch_panic;
pub(crate) mod channel_id;
pub(crate) mod clock_source;
pub(crate) mod lateness;
pub(crate) mod realtime;
pub(crate) mod try_lock;
