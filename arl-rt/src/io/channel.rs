//! I/O channels by number, counted from 1.

use crate::fault::Fault;

/// An output by its channel, counted from 1.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum OutputSignal {
    /// A digital output.
    Digital(usize),
    /// An analog output.
    Analog(usize),
}

/// The index, from 0, of a channel among `count` channels that messages call `name`.
pub(super) fn place(name: &str, channel: i32, count: usize) -> Result<usize, Fault> {
    match usize::try_from(channel) {
        Ok(number) if (1..=count).contains(&number) => Ok(number - 1),
        _ if count == 0 => Err(channel_fault(format!("{name} {channel} does not exist: this cell has no {name}"))),
        _ => Err(channel_fault(format!("{name} {channel} does not exist: this cell has channels 1 to {count}"))),
    }
}

pub(super) fn channel_fault(text: String) -> Fault {
    Fault::Channel(text.into())
}
