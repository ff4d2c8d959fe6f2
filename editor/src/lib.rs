//! The language server and the debug adapter, for editors.

pub mod dap;
mod framing;
pub mod lsp;
