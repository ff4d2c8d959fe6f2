//! The trait for setting up the network ports of the host.

use std::io;
use std::net::Ipv4Addr;

/// The settings of a network port.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PortSettings {
    /// Its address.
    pub address: Ipv4Addr,
    /// The gateway of its subnet.
    pub gateway: Ipv4Addr,
    /// The mask of its subnet.
    pub mask: Ipv4Addr,
}

/// Sets up the network ports of the host. Without a driver the controller keeps the settings in its state directory,
/// and changes nothing on the host.
pub trait NetworkDriver {
    /// Sets up a port: `eth1` to `eth3`.
    ///
    /// # Errors
    /// The port cannot take these settings; `setip` then returns false.
    fn set(&mut self, port: &str, settings: PortSettings) -> io::Result<()>;

    /// The settings of a port; `None` where they are not known.
    ///
    /// # Errors
    /// The settings cannot be read; `getip` then returns false.
    fn get(&mut self, port: &str) -> io::Result<Option<PortSettings>>;
}
