//! Data that outlives a run: values that are kept when the controller is switched off, data files of programs, and the
//! thread that writes files outside the cycle.
//!
//! It imports `cycle`, `fault` and `values`.

pub(crate) mod data;
pub(crate) mod disk;
pub(crate) mod pointers;
pub(crate) mod script_dir;
pub(crate) mod slots;
pub(crate) mod state;
pub(crate) mod state_format;

pub use state::{Directory, Memory, StateError, Storage};
