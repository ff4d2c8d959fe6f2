//! The language server and the debug adapter, for editors.

pub mod dap;
pub mod lsp;

/// The examples of the README run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
