//! What a running program sees of the controller: the context that emitted code passes on, the state of its channel, what
//! all channels share, and the system variables.

pub(crate) mod cx;
pub(crate) mod lane;
pub(crate) mod loadable;
pub(crate) mod output;
pub mod program;
pub mod system;
pub(crate) mod wiring;
pub(crate) mod world;
