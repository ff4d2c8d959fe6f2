//! The I/O channels of a cell, from `[io]` of its file.

use toml::de::DeValue;

use crate::settings::{Section, SettingsError};

const IO: &[&str] = &["di", "do", "ai", "ao", "internal"];

/// The most channels of a kind, far more than any cell has.
pub const MOST_CHANNELS: u32 = 10_000;

/// The signal type of an analog channel.
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

/// The I/O channels of a cell.
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

impl Channels {
    /// The channels of a cell file: those of `[io]`, if it exists.
    ///
    /// # Errors
    /// The values are not channels.
    pub fn read(top: &Section<'_>) -> Result<Channels, SettingsError> {
        let mut channels = Channels::default();
        if let Some(io) = top.table("io", "[io]", IO)? {
            fill(&io, &mut channels)?;
        }
        Ok(channels)
    }
}

fn fill(io: &Section<'_>, channels: &mut Channels) -> Result<(), SettingsError> {
    let digital = [("di", &mut channels.di), ("do", &mut channels.dout), ("internal", &mut channels.internal)];
    for (key, count) in digital {
        if let Some(found) = io.count(key, "a number of channels", MOST_CHANNELS)? {
            *count = found;
        }
    }
    for (key, types) in [("ai", &mut channels.ai), ("ao", &mut channels.ao)] {
        if let Some(found) = analog(io, key)? {
            *types = found;
        }
    }
    Ok(())
}

/// A number of channels, all in V, or a list of their types.
fn analog(io: &Section<'_>, key: &str) -> Result<Option<Vec<AnalogType>>, SettingsError> {
    let Some(value) = io.find(key) else { return Ok(None) };
    let Some(list) = value.get_ref().as_array() else {
        let what = "a list of \"V\" and \"mA\", or a number of channels";
        let count = io.count(key, what, MOST_CHANNELS)?.unwrap_or(0);
        return Ok(Some(vec![AnalogType::Volt; count as usize]));
    };
    let types = list.iter().map(|item| match item.get_ref() {
        DeValue::String(word) if word.eq_ignore_ascii_case("V") => Ok(AnalogType::Volt),
        DeValue::String(word) if word.eq_ignore_ascii_case("mA") => Ok(AnalogType::Milliampere),
        _ => Err(io.wrong(key, item, "\"V\" or \"mA\"")),
    });
    types.collect::<Result<_, _>>().map(Some)
}
