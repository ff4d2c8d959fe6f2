//! Who has sent a packet.

use std::net::SocketAddr;

/// Whether two are the same host and port, an IPv4 address that is written as one of IPv6 included.
pub(crate) fn is_same(one: SocketAddr, other: SocketAddr) -> bool {
    one.port() == other.port() && one.ip().to_canonical() == other.ip().to_canonical()
}
