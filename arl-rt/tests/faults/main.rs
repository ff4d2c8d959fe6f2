//! What the other side of a connection may do wrong, protocol by protocol, and what becomes of it: the documented
//! result or alarm, memory that stays bounded, nothing left open, and a program that goes on. docs/communication.md has
//! the table. The peers are plain Rust on ports that the system chooses, and pseudo terminals.
//!
//! Floods take a second each; `cargo test -p arl-rt --test faults -- --ignored` has them for ten.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test")]
#![cfg(target_os = "linux")]

#[path = "../common/mod.rs"]
mod common;

mod client;
mod devicenet;
mod manners;
mod melsec;
mod modbus_rtu;
mod modbus_tcp;
mod serial;
mod sockets;
mod terminal;
mod watch;
