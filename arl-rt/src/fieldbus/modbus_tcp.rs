//! The controller's Modbus TCP server, and the tables that programs share with its clients.

use std::cell::OnceCell;
use std::net::SocketAddr;

use super::ModbusTcpSettings;
use super::modbus::SharedTables;
use super::modbus::server::Server;

/// The tables, and the server if it runs.
#[derive(Default)]
pub(crate) struct ModbusTcp {
    pub(super) tables: SharedTables,
    server: OnceCell<Server>,
}

impl ModbusTcp {
    /// Starts the server.
    ///
    /// # Errors
    /// The server cannot listen; the message has the reason and a remedy.
    pub(super) fn start(&self, settings: &ModbusTcpSettings) -> Result<(), String> {
        let address = settings.address;
        let server = Server::start(address, settings.connections, self.tables.clone());
        let server = server.map_err(|error| {
            format!(
                "the Modbus TCP server cannot listen on {address}, so no PLC can reach the registers: {error}; the \
                 table [modbus_tcp] of the cell file may name another `address` or `port`{}",
                if address.port() < 1024 { " (ports below 1024 often need special rights)" } else { "" }
            )
        })?;
        self.server.get_or_init(|| server);
        Ok(())
    }

    /// The address on which the server listens, if it runs.
    pub(super) fn address(&self) -> Option<SocketAddr> {
        self.server.get().map(Server::address)
    }
}
