//! A running program's view of the controller: the context that emitted code passes on, the state of its channel, the
//! state that all channels share, and the system variables.
//!
//! It imports the modules of what it holds: `unit`, `communication`, `fieldbus`, `io`, `storage`, `motion`, `values`,
//! `fault` and `cycle`.

pub(crate) mod channel_state;
pub(crate) mod cx;
pub(crate) mod events;
pub(crate) mod frames;
pub(crate) mod function_frame;
pub(crate) mod named;
pub(crate) mod nesting;
pub(crate) mod output;
pub(crate) mod program;
pub(crate) mod programs;
pub(crate) mod random;
pub(crate) mod rounds;
pub(crate) mod run_state;
pub(crate) mod shared_state;
pub(crate) mod shown;
pub(crate) mod standard_error;
pub(crate) mod standstill;
pub(crate) mod subscribers;
pub mod system;
pub(crate) mod watcher;
pub(crate) mod wiring;
