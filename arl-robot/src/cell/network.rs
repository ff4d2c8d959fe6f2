//! The settings of the cell for connections: where programs listen, and the names of serial lines.

use crate::outline;
use crate::settings::{Section, SettingsError};
use std::collections::BTreeMap;

/// The default address on which programs listen: only this computer.
const LOOPBACK: &str = "127.0.0.1";

/// The network settings of the cell: `[network]`.
#[derive(Clone, Default, PartialEq, Eq, Debug)]
pub struct NetworkSettings {
    /// The address on which `accept` listens.
    pub listen: Listen,
    /// The names of serial lines in programs, and their devices: `[serial]`.
    pub devices: BTreeMap<String, String>,
}

/// The address on which `accept` listens.
#[derive(Clone, Default, PartialEq, Eq, Debug)]
pub enum Listen {
    /// On the loopback address, whatever address the program gives: only programs of this computer can connect.
    #[default]
    Loopback,
    /// On the address that the program gives.
    Program,
    /// On this address, whatever address the program gives.
    Address(String),
}

const NETWORK: &[&str] = &["listen"];

impl NetworkSettings {
    /// Reads `[network]` and `[serial]` of a cell file.
    ///
    /// # Errors
    /// The values are neither an address nor a list of devices.
    pub fn read(top: &Section<'_>) -> Result<Self, SettingsError> {
        let network = top.table("network", "[network]", NETWORK)?;
        let listen = network.map_or(Ok(Listen::default()), |network| listen(&network))?;
        Ok(Self { listen, devices: outline::lines(top)? })
    }

    /// The path of the device with this name in a program.
    pub fn device(&self, name: &str) -> String {
        self.devices.get(name).map_or(name, String::as_str).to_owned()
    }

    /// The address to listen on if the program gives this one.
    pub fn listen(&self, program: &str) -> String {
        match &self.listen {
            Listen::Loopback => LOOPBACK.into(),
            Listen::Program => program.into(),
            Listen::Address(address) => address.clone(),
        }
    }
}

fn listen(network: &Section<'_>) -> Result<Listen, SettingsError> {
    let Some(value) = network.find("listen") else { return Ok(Listen::Loopback) };
    match value.get_ref().as_str() {
        Some("loopback") => Ok(Listen::Loopback),
        Some("program") => Ok(Listen::Program),
        Some(address) if address.parse::<std::net::IpAddr>().is_ok() => Ok(Listen::Address(address.into())),
        _ => Err(network.wrong("listen", value, "\"loopback\", \"program\", or an address like \"192.168.0.40\"")),
    }
}
