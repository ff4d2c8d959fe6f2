//! Text: how values are printed, and how they are read back.

pub mod format;
pub(crate) mod number;
pub mod scan;

pub use format::{Nested, Print, Style, Typed, nested};
pub use scan::{Scan, scan};
