//! Following the path: segments in a row, what limits the speed along them, and the governor, which chooses the speed
//! in each cycle.

pub(crate) mod governor;
pub(crate) mod remaining;
pub(crate) mod segment;
pub(crate) mod shared_deque;
pub(crate) mod timing;
