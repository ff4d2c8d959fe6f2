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
