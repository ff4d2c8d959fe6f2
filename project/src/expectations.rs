//! The files beside a program that make it a case of `arl2rs test`.

/// The extensions of the files that give the expected results.
pub const EXPECTATIONS: [&str; 3] = [".out", ".err", ".alarm"];
