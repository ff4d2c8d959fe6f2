//! What people are told beside a run, on standard error. Where nobody can read it, it is lost: a robot does not stop
//! for that.

use std::fmt;
use std::io::{self, Write};

/// Tells a line.
pub(crate) fn tell(line: fmt::Arguments<'_>) {
    let _ = writeln!(io::stderr().lock(), "{line}");
}
