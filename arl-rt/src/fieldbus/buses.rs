//! The field buses of a controller, as configured in the cell.

use std::cell::{OnceCell, RefCell, RefMut};
use std::collections::HashSet;
use std::net::SocketAddr;

use super::devicenet::DeviceNet;
use super::modbus::SharedTables;
use super::modbus_tcp::ModbusTcp;
use super::{BusSettings, ModbusTcpSettings};

/// The largest number of different reports of a run, so that they never fill the memory.
const MAX_REPORTS: usize = 100;

/// The field buses of a controller.
pub(crate) struct Buses {
    devicenet: RefCell<Box<dyn DeviceNet>>,
    modbus_tcp: OnceCell<ModbusTcp>,
    settings: BusSettings,
    reported: RefCell<HashSet<String>>,
}

impl Buses {
    /// Creates the buses with the settings of the cell.
    pub(crate) fn new(settings: BusSettings, devicenet: Box<dyn DeviceNet>) -> Self {
        Self { devicenet: RefCell::new(devicenet), modbus_tcp: OnceCell::new(), settings, reported: RefCell::default() }
    }

    /// The DeviceNet bus.
    pub(crate) fn devicenet(&self) -> RefMut<'_, Box<dyn DeviceNet>> {
        self.devicenet.borrow_mut()
    }

    /// The registers and coils of the Modbus TCP server.
    pub(crate) fn modbus_tables(&self) -> &SharedTables {
        &self.modbus_tcp().tables
    }

    /// Whether this has not been reported to the user yet and there is room for one more report; records it as
    /// reported.
    pub(crate) fn is_new_report(&self, text: &str) -> bool {
        let mut reported = self.reported.borrow_mut();
        reported.len() < MAX_REPORTS && reported.insert(text.to_owned())
    }

    /// The Modbus TCP server and its tables.
    fn modbus_tcp(&self) -> &ModbusTcp {
        self.modbus_tcp.get_or_init(ModbusTcp::default)
    }

    /// Starts the server that the cell configures, whether a program uses it or not. Without settings in the cell,
    /// tries to start a server with all defaults if programs want one. Returns a message for the user: the address of
    /// the server, if the cell leaves the port open, or the reason why there is no server.
    ///
    /// # Errors
    /// The reason why the configured server cannot be started.
    pub(crate) fn start(&self, wanted: bool) -> Result<Option<String>, String> {
        let Some(settings) = &self.settings.modbus_tcp else {
            let tried = wanted.then(|| self.modbus_tcp().start(&ModbusTcpSettings::default()));
            return Ok(tried.and_then(Result::err));
        };
        self.modbus_tcp().start(settings)?;
        let address = self.modbus_tcp_address().filter(|_| settings.address.port() == 0);
        Ok(address.map(|address| format!("the Modbus TCP server listens on {address}")))
    }

    /// The address on which the Modbus TCP server listens, if it runs.
    pub(crate) fn modbus_tcp_address(&self) -> Option<SocketAddr> {
        self.modbus_tcp.get()?.address()
    }

    /// Whether the cell configures connections that exist from the start.
    pub(crate) fn is_outside(&self) -> bool {
        self.settings.modbus_tcp.is_some()
    }
}
