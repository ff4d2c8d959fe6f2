//! Runs checked programs at once, on the same runtime as compiled ones.
//!
//! [`Engine`] is an [`arl_rt::Program`]: the controller cannot tell it from one that rustc made. What it runs is the
//! [`Code`](arl_code::Code) of the compiler.
//!
//! ```
//! use arl_engine::Engine;
//! use arl_rt::{Captured, Controller, Outcome};
//! use std::path::Path;
//!
//! struct Answer;
//!
//! impl arl2rs::Sources for Answer {
//!     fn read(&self, path: &Path) -> Result<Vec<u8>, arl2rs::SourceError> {
//!         if path != Path::new("answer.arl") {
//!             return Err(arl2rs::SourceError::Missing);
//!         }
//!         Ok(b"func void main()\n  print 6 * 7\nendfunc\n".to_vec())
//!     }
//! }
//!
//! let checked = arl2rs::check(Path::new("answer.arl"), &Answer, &arl2rs::CheckOptions::default());
//! let program = checked.program.expect("it has no mistakes");
//! let code = arl2rs::lower::lower(&program)?;
//!
//! let output = Captured::default();
//! let mut controller = Controller::builder().output(output.clone()).build(Engine::new(code))?;
//! assert_eq!(controller.run(), Outcome::Ended);
//! assert_eq!(output.text(), "42\n");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! - `exec.rs` is the loop over the operations. It is a plain function and leaves at an operation that waits.
//! - `run.rs` has the one `async` function: it waits, and goes back into the loop.
//! - `adapters.rs` and `system.rs` are generated from the catalog: they bring arguments from where the code has them to
//!   the functions of the runtime.

#[allow(clippy::all, clippy::too_many_lines, reason = "generated")]
mod adapters;
mod args;
mod engine;
mod events;
mod exec;
mod frame;
mod handles;
mod intern;
mod reach;
mod run;
#[allow(clippy::all, clippy::too_many_lines, reason = "generated")]
mod system;
mod teach;
mod types;
mod values;
mod watching;

pub use engine::Engine;
