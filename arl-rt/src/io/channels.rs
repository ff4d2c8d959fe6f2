//! How many channels of io there are.

/// What an analog channel carries.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum AnalogType {
    /// A voltage, -10 to 10 V.
    Volt,
    /// A current, 4 to 20 mA.
    Milliampere,
}

impl AnalogType {
    /// The least and the greatest value.
    pub const fn range(self) -> (f64, f64) {
        match self {
            AnalogType::Volt => (-10.0, 10.0),
            AnalogType::Milliampere => (4.0, 20.0),
        }
    }

    /// The value of a channel that carries no signal.
    pub const fn without_signal(self) -> f64 {
        match self {
            AnalogType::Volt => 0.0,
            AnalogType::Milliampere => 4.0,
        }
    }

    /// The unit, as messages write it.
    pub const fn unit(self) -> &'static str {
        match self {
            AnalogType::Volt => "V",
            AnalogType::Milliampere => "mA",
        }
    }
}

/// The channels of io of a cell.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Channels {
    /// Digital inputs.
    pub di: u32,
    /// Digital outputs.
    pub dout: u32,
    /// Analog inputs.
    pub ai: Vec<AnalogType>,
    /// Analog outputs.
    pub ao: Vec<AnalogType>,
    /// Internal signals, in each direction.
    pub internal: u32,
}

impl Default for Channels {
    fn default() -> Self {
        Self { di: 64, dout: 64, ai: vec![AnalogType::Volt; 8], ao: vec![AnalogType::Volt; 8], internal: 32 }
    }
}
