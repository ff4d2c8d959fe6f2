//! The settings of the cell for field buses.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};

use crate::outline;
use crate::settings::{Section, SettingsError};

/// The buses of a cell.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct BusSettings {
    /// The number of bytes that the simulated DeviceNet bus exchanges; other buses have their own size.
    pub devicenet: usize,
    /// The controller's Modbus TCP server, if the cell has one.
    pub modbus_tcp: Option<ModbusTcpSettings>,
}

impl Default for BusSettings {
    fn default() -> Self {
        Self { devicenet: outline::DEVICENET as usize, modbus_tcp: None }
    }
}

/// The controller's Modbus TCP server.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct ModbusTcpSettings {
    /// The address on which the server listens.
    pub address: SocketAddr,
    /// The most clients served at once.
    pub connections: usize,
}

impl Default for ModbusTcpSettings {
    fn default() -> Self {
        Self { address: SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 502), connections: 8 }
    }
}

const MODBUS_TCP: &[&str] = &["address", "port", "connections"];

impl BusSettings {
    /// Reads the settings from the cell file.
    ///
    /// # Errors
    /// The values are not settings of buses.
    pub fn read(top: &Section<'_>) -> Result<Self, SettingsError> {
        let modbus_tcp = top.table("modbus_tcp", "[modbus_tcp]", MODBUS_TCP)?;
        let devicenet = outline::devicenet(top)? as usize;
        Ok(Self { devicenet, modbus_tcp: modbus_tcp.as_ref().map(modbus_tcp_server).transpose()? })
    }
}

fn modbus_tcp_server(section: &Section<'_>) -> Result<ModbusTcpSettings, SettingsError> {
    let mut settings = ModbusTcpSettings::default();
    if let Some(address) = address(section, "address")? {
        settings.address.set_ip(address);
    }
    if let Some(port) = section.count("port", "a TCP port (0: any that is free)", u16::MAX.into())? {
        settings.address.set_port(port as u16);
    }
    if let Some(connections) = section.number("connections", "a whole number", 1.0, 64.0)? {
        settings.connections = connections as usize;
    }
    Ok(settings)
}

/// An IP address, if given.
fn address(section: &Section<'_>, key: &str) -> Result<Option<IpAddr>, SettingsError> {
    const WHAT: &str = "an IP address of this computer, like \"127.0.0.1\", or \"0.0.0.0\" for all of them";
    let Some(text) = section.text(key, WHAT)? else { return Ok(None) };
    match (text.parse(), section.find(key)) {
        (Ok(address), _) => Ok(Some(address)),
        (Err(_), Some(value)) => Err(section.wrong(key, value, WHAT)),
        (Err(_), None) => Ok(None),
    }
}
