//! The trait of what sets up the network ports of the host.

use std::io;
use std::net::Ipv4Addr;

/// What a network port is set to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PortSettings {
    /// Its address.
    pub address: Ipv4Addr,
    /// The gateway of its subnet.
    pub gateway: Ipv4Addr,
    /// The mask of its subnet.
    pub mask: Ipv4Addr,
}

/// Sets up the network ports of the host. Without one the controller keeps the settings in its state directory, and
/// changes nothing on the host.
pub trait NetworkDriver {
    /// Sets a port up: `eth1` to `eth3`.
    ///
    /// # Errors
    /// It cannot be set so; `setip` is then false.
    fn set(&mut self, port: &str, settings: PortSettings) -> io::Result<()>;

    /// What a port is set to; nothing where that is not known.
    ///
    /// # Errors
    /// It cannot be found out; `getip` is then false.
    fn get(&mut self, port: &str) -> io::Result<Option<PortSettings>>;
}
