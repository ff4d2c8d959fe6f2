//! Connections to the outside world: sockets and serial lines.
//!
//! A `Link` is a stream of bytes that a thread beside the cycle serves. The cycle takes bytes from a bounded buffer and
//! puts bytes into another one, so that it never waits for the other side, whatever that does. Handles of programs own
//! links; `Connections` has all connections that a program has opened and closes them when it ends.

mod connections;
pub(crate) mod inbox;
pub(crate) mod line;
pub(crate) mod link;
mod network_driver;
pub(crate) mod opening;
pub(crate) mod shared;
pub(crate) mod slave;
mod stream;
mod worker;

pub(crate) use arl_robot::cell::NetworkSettings;
pub(crate) use connections::{Connections, Opener};
#[cfg(feature = "fuzzing")]
pub(crate) use inbox::Inbox;
pub use network_driver::{NetworkDriver, PortSettings};
