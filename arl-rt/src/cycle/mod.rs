//! The control cycle: how long it is, where its time comes from, which channels run in it, and locks that it does not wait
//! for.

pub(crate) mod at_once;
pub(crate) mod channel_id;
pub mod clock_source;
pub(crate) mod rate;
