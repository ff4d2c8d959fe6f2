//! The control cycle: its length, the sources of its time and how late it may be, its resources of the operating
//! system, which channels run in it, and what it shares with threads beside it.
//!
//! It imports no other module.

pub(crate) mod catch_panic;
pub(crate) mod channel_id;
pub(crate) mod clock_source;
pub(crate) mod lateness;
pub(crate) mod realtime;
pub(crate) mod try_lock;
