//! Programs that talk to real peers: other people's clients and servers, on this computer only. A test starts and stops
//! its peers. One that is not installed makes the test say that it is skipped, or fail where `ARL_PEERS=required` is
//! set.
//!
//! Debian: `apt-get install mbpoll socat`. Python: `pip install pymodbus pymcprotocol pyserial slmp-connect-python`,
//! into the Python that `ARL_PEERS_PYTHON` names (`python3` where it names none).

#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test")]

mod field_buses;
mod islands;
mod peer;
mod robot;
mod streams;
