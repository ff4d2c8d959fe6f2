//! The handles: variables that stand for something outside the program.

use super::types::{Handle, HandleDef};

static CLOCK: HandleDef = HandleDef {
    id: Handle::Clock,
    name: "clock",
    aliases: &[],
    rust: "Clock",
    doc: "A stopwatch: clkstart, clkstop, clkreset, clkread.",
    section: "5.3.1",
};

static SOCKET: HandleDef = HandleDef {
    id: Handle::Socket,
    name: "socket",
    aliases: &[],
    rust: "Socket",
    doc: "A TCP connection: connect or accept, then write, read, readuntil, clearbuff, geterror, close.",
    section: "2.7.1",
};

static IODEV: HandleDef = HandleDef {
    id: Handle::Iodev,
    name: "iodev",
    aliases: &[],
    rust: "Iodev",
    doc: "A serial line: open, then write, read, readuntil, clearbuff, close.",
    section: "2.7.2",
};

static MODBUS_DEV: HandleDef = HandleDef {
    id: Handle::ModbusDev,
    name: "modbus_dev",
    aliases: &[],
    rust: "ModbusDev",
    doc: "A Modbus slave of the controller on a serial line: open, then read, write, clearbuff, setcycle, close.",
    section: "5.6.6",
};

static MELSEC_DEV: HandleDef = HandleDef {
    id: Handle::MelsecDev,
    name: "melsec_dev",
    aliases: &["melsec"],
    rust: "MelsecDev",
    doc: "A connection to a Melsec PLC: open, then read, write, close.",
    section: "5.6.5",
};

impl Handle {
    /// Every handle.
    pub const ALL: [Handle; 5] = [Handle::Clock, Handle::Socket, Handle::Iodev, Handle::ModbusDev, Handle::MelsecDev];

    /// The definition.
    pub fn def(self) -> &'static HandleDef {
        match self {
            Handle::Clock => &CLOCK,
            Handle::Socket => &SOCKET,
            Handle::Iodev => &IODEV,
            Handle::ModbusDev => &MODBUS_DEV,
            Handle::MelsecDev => &MELSEC_DEV,
        }
    }
}
