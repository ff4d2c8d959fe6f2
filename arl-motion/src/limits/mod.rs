//! Limits of one parameter: constant limits, and jerk-limited changes of speed within them.

pub(crate) mod constant;
pub(crate) mod duration;
pub(crate) mod profile;
pub(crate) mod search;
