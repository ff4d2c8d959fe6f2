//! Messages beside a run, on standard error. Where they cannot be written, they are lost: a robot does not stop for
//! that.

use std::fmt;
use std::io::{self, Write};

/// Writes a line.
pub(crate) fn tell(line: fmt::Arguments<'_>) {
    let _ = writeln!(io::stderr().lock(), "{line}");
}
