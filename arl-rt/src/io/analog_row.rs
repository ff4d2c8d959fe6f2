//! A row of analog channels: their types and values.

use super::AnalogType;
use super::channel::{channel_fault, place};
use crate::fault::Fault;

/// Analog channels of one direction. Channels count from 1.
#[derive(Debug)]
pub(crate) struct AnalogRow {
    /// The name of the channels in messages.
    name: &'static str,
    types: Box<[AnalogType]>,
    /// The values, V or mA.
    values: Box<[f64]>,
}

impl AnalogRow {
    /// Channels of these types, without signal: at 0 V and 4 mA.
    pub(crate) fn new(name: &'static str, types: &[AnalogType]) -> Self {
        Self { name, types: types.into(), values: types.iter().map(|ty| ty.without_signal()).collect() }
    }

    /// The value of a channel in V or mA.
    pub(crate) fn get(&self, channel: i32) -> Result<f64, Fault> {
        let at = place(self.name, channel, self.values.len())?;
        Ok(self.values.get(at).copied().unwrap_or_default())
    }

    /// Sets a channel, in V or mA, to a value that its type can carry.
    pub(crate) fn set(&mut self, channel: i32, value: f64) -> Result<(), Fault> {
        let at = self.check(channel, value)?;
        self.put(at, value);
        Ok(())
    }

    /// Checks whether a channel can have this value; returns the channel's index, from 0.
    pub(crate) fn check(&self, channel: i32, value: f64) -> Result<usize, Fault> {
        let at = place(self.name, channel, self.values.len())?;
        let ty = self.types.get(at).copied().unwrap_or(AnalogType::Volt);
        let (low, high) = ty.range();
        if !(low..=high).contains(&value) {
            let (name, unit) = (self.name, ty.unit());
            return Err(channel_fault(format!("{name} {channel} carries {low} to {high} {unit}, not {value} {unit}")));
        }
        Ok(at)
    }

    /// Takes any value measured outside for the channel with this index, from 0, if it exists.
    pub(crate) fn put(&mut self, at: usize, value: f64) {
        if let Some(place) = self.values.get_mut(at) {
            *place = value;
        }
    }

    /// The values, in order.
    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row() -> AnalogRow {
        AnalogRow::new("AO", &[AnalogType::Volt, AnalogType::Milliampere])
    }

    #[test]
    fn channels_begin_without_signal() {
        assert_eq!((row().get(1), row().get(2)), (Ok(0.0), Ok(4.0)));
    }

    #[test]
    fn types_limit_what_is_set() {
        let mut row = row();
        for (channel, value) in [(1, -10.0), (1, 10.0), (2, 4.0), (2, 20.0)] {
            row.set(channel, value).unwrap();
            assert_eq!(row.get(channel), Ok(value));
        }
        for (channel, value, words) in [
            (1, 10.001, "AO 1 carries -10 to 10 V, not 10.001 V"),
            (1, f64::NAN, "not NaN V"),
            (2, 3.999, "AO 2 carries 4 to 20 mA, not 3.999 mA"),
            (2, 20.5, "not 20.5 mA"),
            (3, 5.0, "AO 3 does not exist: this cell has channels 1 to 2"),
        ] {
            let error = row.set(channel, value).unwrap_err();
            assert_eq!(error.number(), 20010);
            assert!(error.to_string().contains(words), "{error}");
        }
    }
}
