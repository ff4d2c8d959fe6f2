//! The codes: number, severity and title of every kind of diagnostic.

use super::{Code, Severity};

/// What is known of a code without a program.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct CodeInfo {
    /// The number.
    pub code: Code,
    /// Error or warning.
    pub severity: Severity,
    /// A few words, the page's title.
    pub title: &'static str,
}

/// All codes in ascending order.
pub fn registry() -> &'static [CodeInfo] {
    &[]
}

/// What is known of this code.
pub fn info(code: Code) -> Option<&'static CodeInfo> {
    registry().iter().find(|info| info.code == code)
}
