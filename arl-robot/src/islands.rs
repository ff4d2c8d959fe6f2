//! I/O islands of a cell: the mapping of I/O channels to coils and registers of a Modbus TCP server, from the tables
//! `[[island]]` of the cell file.
//!
//! ```toml
//! [[island]]
//! name = "valves"              # how messages call it
//! address = "192.168.0.20"
//! port = 502
//! unit = 1
//! poll = 10                    # ms
//! timeout = 500                # ms
//! lost = "alarm"               # or "warning"
//! inputs = "zero"              # or "hold"
//! end = "zero"                 # or "hold"
//! di = [{ channel = 1, count = 8, discrete_input = 0 }]
//! do = [{ channel = 1, count = 8, coil = 0 }]
//! ai = [{ channel = 1, input_register = 0, raw = [0, 27648] }]
//! ao = [{ channel = 1, holding_register = 0 }]
//! ```

mod read;

use std::net::SocketAddr;
use std::time::Duration;

use crate::channels::AnalogType;

/// A Modbus TCP server with inputs and outputs of the cell.
#[derive(Clone, PartialEq, Debug)]
pub struct Island {
    /// The name in messages.
    pub name: String,
    /// The address on which the server listens.
    pub address: SocketAddr,
    /// The unit number in its requests.
    pub unit: u8,
    /// The period of the exchange.
    pub poll: Duration,
    /// The longest time for an answer, and for connecting.
    pub timeout: Duration,
    /// The consequence of losing the island.
    pub lost: Lost,
    /// The state of its inputs while it is lost.
    pub inputs: Rest,
    /// The state of its outputs when the run ends.
    pub end: Rest,
    /// The mapping of its channels.
    pub points: Points,
}

/// The consequence of losing an island.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Lost {
    /// All robots stop, with an alarm.
    Alarm,
    /// The user is warned.
    Warning,
}

/// The state of signals that are no longer driven.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Rest {
    /// Off, 0 V, 4 mA.
    Zero,
    /// The last state.
    Hold,
}

/// The channels of an island, by direction and kind. Here, channels count from 0.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Points {
    /// Digital inputs.
    pub di: Vec<Bit>,
    /// Digital outputs.
    pub dout: Vec<Bit>,
    /// Analog inputs.
    pub ai: Vec<Analog>,
    /// Analog outputs.
    pub ao: Vec<Analog>,
}

/// A digital channel and its location in the island.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Bit {
    /// The channel, from 0.
    pub channel: usize,
    /// The table of the island.
    pub table: Table,
    /// The address in that table.
    pub address: u16,
    /// The bit of a register, 0 the lowest; 0 in tables of bits.
    pub bit: u8,
}

/// An analog channel and its location in the island.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Analog {
    /// The channel, from 0.
    pub channel: usize,
    /// The table of the island.
    pub table: Table,
    /// The address in that table.
    pub address: u16,
    /// The scale between its register and V or mA.
    pub scale: Scale,
}

/// The four tables of Modbus.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Table {
    /// Bits that can be written.
    Coil,
    /// Bits that can be read only.
    DiscreteInput,
    /// Registers that can be written.
    HoldingRegister,
    /// Registers that can be read only.
    InputRegister,
}

impl Table {
    const ALL: [Table; 4] = [Table::Coil, Table::DiscreteInput, Table::HoldingRegister, Table::InputRegister];

    /// The key in the cell file.
    pub const fn key(self) -> &'static str {
        match self {
            Table::Coil => "coil",
            Table::DiscreteInput => "discrete_input",
            Table::HoldingRegister => "holding_register",
            Table::InputRegister => "input_register",
        }
    }

    /// The name of one entry in messages; the plural has an s appended.
    pub const fn singular(self) -> &'static str {
        match self {
            Table::Coil => "coil",
            Table::DiscreteInput => "discrete input",
            Table::HoldingRegister => "holding register",
            Table::InputRegister => "input register",
        }
    }

    /// Whether the table has bits instead of registers.
    pub const fn has_bits(self) -> bool {
        matches!(self, Table::Coil | Table::DiscreteInput)
    }
}

/// The linear scale between a register and the value of an analog channel, defined by two points.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Scale {
    /// The register at the least and at the greatest value of the channel.
    raw: (i32, i32),
    ty: AnalogType,
}

impl Scale {
    /// The line through the ends of a channel's range. Without `raw`, the whole range of a signed register for V, its
    /// upper half for mA.
    fn new(ty: AnalogType, raw: Option<(i32, i32)>) -> Self {
        let usual = match ty {
            AnalogType::Volt => (-32767, 32767),
            AnalogType::Milliampere => (0, 32767),
        };
        Self { raw: raw.unwrap_or(usual), ty }
    }

    /// Whether the register is signed: if both ends fit a signed register.
    fn is_signed(self) -> bool {
        self.raw.0.max(self.raw.1) <= i32::from(i16::MAX)
    }

    /// The value of a channel that carries no signal, in V or mA.
    pub fn without_signal(self) -> f64 {
        self.ty.without_signal()
    }

    /// The value of a register, in V or mA.
    pub fn value(self, register: u16) -> f64 {
        let raw = if self.is_signed() { f64::from(register.cast_signed()) } else { f64::from(register) };
        let ((r0, r1), (low, high)) = (self.raw, self.ty.range());
        low + (raw - f64::from(r0)) / f64::from(r1 - r0) * (high - low)
    }

    /// The register nearest to a value in V or mA, limited to the scale.
    pub fn register(self, value: f64) -> u16 {
        let ((r0, r1), (low, high)) = (self.raw, self.ty.range());
        let raw = f64::from(r0) + (value - low) / (high - low) * f64::from(r1 - r0);
        let raw = raw.round().clamp(f64::from(r0.min(r1)), f64::from(r0.max(r1))) as i32;
        // Values below 0 become their two's complement.
        raw as u16
    }
}
