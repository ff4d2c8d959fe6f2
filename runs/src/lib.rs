//! What is made of a run: recordings, the view in the browser and the screen of the pendant, reports, plots, and what
//! robots touch.
//!
//! A program reports what it does, a line at a time ([`arl_wire`]); this crate has the receivers of these lines.
//! Nothing here compiles or checks programs.

#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod collide;
#[cfg(any(test, feature = "fuzzing"))]
pub mod fuzzing;
mod link;
pub mod listen;
pub mod pendant;
mod playback;
pub mod plot;
pub mod record;
pub mod report;
pub mod scenery;
pub mod signals;
pub mod texts;
pub mod urdf;
pub mod view;

use arl_robot::result_file::ResultFile;
use arl_terminal::failure::Failure;
use std::path::Path;

/// A file for a result: it can be written, and holds what it held until there is a result.
fn result_file(path: &Path) -> Result<ResultFile, Failure> {
    ResultFile::new(path).map_err(|error| Failure::io("write", path, &error))
}
