//! Field buses: DeviceNet, Modbus and the MC protocol of Melsec PLCs.
//!
//! Whatever talks to the outside does so on threads beside the cycle. What turns bytes into requests and back is pure
//! functions, which take any bytes without harm.

pub mod devicenet;
pub(crate) mod islands;
pub(crate) mod modbus;
pub mod modbus_tcp;
#[cfg(test)]
pub(crate) mod noise;
mod settings;

use std::cell::{OnceCell, RefCell};
use std::collections::HashSet;
use std::net::SocketAddr;

use devicenet::DeviceNet;
use modbus_tcp::ModbusTcp;

pub use settings::{BusSettings, ModbusTcpSettings};

use crate::context::cx::Cx;
use crate::values::Str;

/// How many different reports a run may give, so that they never fill the memory.
const MOST_REPORTS: usize = 100;

/// The field buses of a controller.
pub(crate) struct Buses {
    devicenet: RefCell<Box<dyn DeviceNet>>,
    modbus_tcp: OnceCell<ModbusTcp>,
    settings: BusSettings,
    reported: RefCell<HashSet<String>>,
}

impl Buses {
    /// Buses as the cell has them.
    pub(crate) fn new(settings: BusSettings, devicenet: Box<dyn DeviceNet>) -> Self {
        Self { devicenet: RefCell::new(devicenet), modbus_tcp: OnceCell::new(), settings, reported: RefCell::default() }
    }

    /// The Modbus TCP server and its tables.
    fn modbus_tcp(&self) -> &ModbusTcp {
        self.modbus_tcp.get_or_init(ModbusTcp::default)
    }

    /// Starts what the cell asks for, whether a program uses it or not. Where the cell says nothing of it, a server with all
    /// defaults is tried, if programs want one. What the user should know: where the server listens, if the cell left that
    /// open; why there is none.
    ///
    /// # Errors
    /// Why some of what the cell asks for cannot be had.
    pub(crate) fn start(&self, wanted: bool) -> Result<Option<String>, String> {
        let Some(settings) = &self.settings.modbus_tcp else {
            let tried = wanted.then(|| self.modbus_tcp().start(&ModbusTcpSettings::default()));
            return Ok(tried.and_then(Result::err));
        };
        self.modbus_tcp().start(settings)?;
        let address = self.modbus_tcp_address().filter(|_| settings.address.port() == 0);
        Ok(address.map(|address| format!("the Modbus TCP server listens on {address}")))
    }

    /// Where the Modbus TCP server listens, if there is one.
    pub(crate) fn modbus_tcp_address(&self) -> Option<SocketAddr> {
        self.modbus_tcp.get()?.address()
    }

    /// Whether the cell asks for connections that stand from the start.
    pub(crate) fn is_outside(&self) -> bool {
        self.settings.modbus_tcp.is_some()
    }
}

/// Says why a function gives false, with its place in the program; the same thing once only, as programs try again in
/// each cycle.
fn report(cx: &Cx, problem: String) {
    let world = cx.world();
    let (file, line) = cx.place();
    let text = format!("{problem} ({}:{line})", file.name());
    let mut reported = world.buses.reported.borrow_mut();
    if reported.len() < MOST_REPORTS && reported.insert(text.clone()) {
        world.warn(text);
    }
}

/// `len` bytes of a text; behind its end zeros.
fn padded(text: &Str, len: usize) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    bytes.resize(len, 0);
    bytes
}
