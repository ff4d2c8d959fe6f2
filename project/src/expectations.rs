//! The files beside a program that make it a case of `arl2rs test`.

/// Endings of those that say what is expected of it.
pub const EXPECTATIONS: [&str; 3] = [".out", ".err", ".alarm"];
