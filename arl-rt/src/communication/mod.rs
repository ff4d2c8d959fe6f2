//! Connections to the world: sockets and serial lines.
//!
//! A `Link` is a stream of bytes that a thread beside the cycle serves. The cycle takes from a bounded buffer and puts
//! into another one, so that nothing in it waits for the other side, whatever that does. Handles of programs own links;
//! `Connections` knows all that a program has opened and closes them when it ends.

mod connections;
mod handle;
mod inbox;
mod line;
mod link;
mod network;
mod opening;
mod settings;
mod shared;
mod slave;
mod transfer;
mod worker;

pub mod melsec;
pub mod modbus_rtu;
pub mod serial;
pub mod socket;

pub(crate) use connections::{Connections, Opener};
pub use network::{NetworkDriver, PortSettings};
pub use settings::{Listen, NetworkSettings};
#[cfg(feature = "fuzzing")]
pub(crate) use {inbox::Inbox, melsec::answer_size as melsec_answer};

/// How many different things a connection may tell the user, so that it never fills the memory.
const MOST_TOLD: usize = 100;
