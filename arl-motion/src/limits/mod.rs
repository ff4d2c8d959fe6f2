//! Limits of one parameter: constant ones, and jerk-limited changes of speed within them.

pub(crate) mod constant;
pub(crate) mod duration;
pub(crate) mod profile;
pub(crate) mod search;
