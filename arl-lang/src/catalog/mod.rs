//! Everything that ARL has built in, declared once: names, types, parameters, effects, texts and examples.

mod entry;
mod types;

pub use entry::*;
pub use types::*;
