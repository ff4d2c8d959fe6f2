//! Connections of programs: sockets, serial lines, and the protocols on top of them.

mod handle;
mod network;
mod transfer;

pub mod melsec;
pub mod modbus_rtu;
pub mod serial;
pub mod socket;

#[cfg(feature = "fuzzing")]
pub(crate) use melsec::answer_size as melsec_answer;

/// The largest number of different messages of a connection, so that they never fill the memory.
const MAX_REPORTED_ERRORS: usize = 100;
