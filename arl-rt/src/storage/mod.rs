//! What outlives a run: values that are kept when the controller is switched off, data files of programs, and the thread
//! that writes files beside the cycle.
//!
//! It imports `cycle`, `fault` and `values`.

pub mod data;
pub(crate) mod disk;
pub(crate) mod pointers;
pub(crate) mod script_dir;
pub(crate) mod slots;
pub mod state;
pub(crate) mod state_format;
