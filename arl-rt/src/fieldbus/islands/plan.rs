//! The requests that read an island's inputs and write its outputs: as few as the protocol and the addresses allow.

use arl_robot::islands::{Analog, Bit, Points, Scale, Table};

use crate::fieldbus::modbus::client::{most_read, most_written};

/// The requests of one exchange.
#[derive(PartialEq, Debug)]
pub(super) struct ExchangePlan {
    pub(super) reads: Vec<SignalRange>,
    pub(super) writes: Vec<SignalRange>,
}

/// Adjacent coils or registers, as many as fit into one request.
#[derive(PartialEq, Debug)]
pub(super) struct SignalRange {
    pub(super) table: Table,
    pub(super) start: u16,
    pub(super) count: u16,
    points: Vec<Point>,
}

/// The signal of a coil or register in a range.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Point {
    /// Counted from the first of the range.
    offset: usize,
    signal: Signal,
}

/// A signal, by its index among the island's digital or analog signals of its direction.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Signal {
    /// One bit; the bit of a register if the table has registers.
    Bit { place: usize, bit: u8 },
    /// A whole register.
    Value { place: usize, scale: Scale },
}

/// The signals of one direction, in the order of the cell file.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Signals {
    pub(super) bits: Vec<bool>,
    /// V or mA.
    pub(super) values: Vec<f64>,
}

impl Signals {
    /// `bits` digital signals that are off, and analog signals with these values.
    pub(super) fn at_rest(bits: usize, values: &[f64]) -> Self {
        Self { bits: vec![false; bits], values: values.to_vec() }
    }

    /// Copies the signals of an image of the same size.
    pub(super) fn copy_from(&mut self, other: &Signals) {
        self.bits.clone_from_slice(&other.bits);
        self.values.clone_from_slice(&other.values);
    }
}

impl ExchangePlan {
    /// The requests for an island's points.
    pub(super) fn new(points: &Points) -> Self {
        Self { reads: runs(&points.di, &points.ai, most_read), writes: runs(&points.dout, &points.ao, most_written) }
    }
}

/// Groups adjacent signals.
fn runs(bits: &[Bit], analogs: &[Analog], most: fn(Table) -> usize) -> Vec<SignalRange> {
    let bits = bits.iter().enumerate().map(|(place, bit)| {
        let signal = Signal::Bit { place, bit: bit.bit };
        (bit.table, bit.address, signal)
    });
    let analogs = analogs.iter().enumerate().map(|(place, analog)| {
        let signal = Signal::Value { place, scale: analog.scale };
        (analog.table, analog.address, signal)
    });
    let mut all: Vec<_> = bits.chain(analogs).collect();
    all.sort_by_key(|(table, address, _)| (*table, *address));
    let mut runs: Vec<SignalRange> = Vec::new();
    for (table, address, signal) in all {
        let fits = |run: &&mut SignalRange| {
            let offset = usize::from(address - run.start);
            run.table == table && offset <= run.count.into() && offset < most(table)
        };
        // In the order of addresses, so that only the last range can contain the next signal.
        let last = runs.last_mut().filter(|run| run.table == table);
        match last.filter(fits) {
            Some(run) => {
                let offset = usize::from(address - run.start);
                run.count = run.count.max(offset as u16 + 1);
                run.points.push(Point { offset, signal });
            }
            None => {
                let points = vec![Point { offset: 0, signal }];
                runs.push(SignalRange { table, start: address, count: 1, points });
            }
        }
    }
    runs
}

impl SignalRange {
    /// Extracts the signals from the bytes of an answer.
    pub(super) fn take(&self, data: &[u8], into: &mut Signals) {
        for point in &self.points {
            match point.signal {
                Signal::Bit { place, bit } => {
                    let (byte, bit) = self.bit(point.offset, bit);
                    let level = data.get(byte).is_some_and(|byte| byte >> bit & 1 == 1);
                    into.bits.get_mut(place).into_iter().for_each(|signal| *signal = level);
                }
                Signal::Value { place, scale } => {
                    let register = data.get(2 * point.offset..).and_then(|data| data.first_chunk());
                    let value = register.map(|register| scale.value(u16::from_be_bytes(*register)));
                    into.values.get_mut(place).zip(value).into_iter().for_each(|(signal, value)| *signal = value);
                }
            }
        }
    }

    /// Puts the signals into the bytes of a request, which are 0.
    pub(super) fn put(&self, from: &Signals, data: &mut [u8]) {
        for point in &self.points {
            match point.signal {
                Signal::Bit { place, bit } => {
                    let (byte, bit) = self.bit(point.offset, bit);
                    let level = from.bits.get(place).copied().unwrap_or_default();
                    data.get_mut(byte).into_iter().for_each(|byte| *byte |= u8::from(level) << bit);
                }
                Signal::Value { place, scale } => {
                    let register = from.values.get(place).map(|value| scale.register(*value).to_be_bytes());
                    let room = data.get_mut(2 * point.offset..).and_then(|data| data.first_chunk_mut());
                    room.zip(register).into_iter().for_each(|(room, register)| *room = register);
                }
            }
        }
    }

    /// The byte and the bit in it of a coil, or of a bit of a register, whose high byte comes first.
    fn bit(&self, offset: usize, bit: u8) -> (usize, u8) {
        match self.table.has_bits() {
            true => (offset / 8, (offset % 8) as u8),
            false => (2 * offset + usize::from(bit < 8), bit % 8),
        }
    }

    /// A description for messages.
    pub(super) fn describe(&self) -> String {
        let (start, last) = (self.start, u32::from(self.start) + u32::from(self.count) - 1);
        match self.count {
            1 => format!("{} {start}", self.table.singular()),
            _ => format!("{}s {start} to {last}", self.table.singular()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_robot::outline::Outline;

    fn plan(points: &str) -> ExchangePlan {
        let text = format!("[io]\ndi = 5000\ndo = 5000\nai = 200\n[[island]]\naddress = \"10.0.0.7\"\n{points}\n");
        ExchangePlan::new(&Outline::of_cell("cell.toml", &text).unwrap().islands[0].points)
    }

    fn shapes(runs: &[SignalRange]) -> Vec<(Table, u16, u16)> {
        runs.iter().map(|run| (run.table, run.start, run.count)).collect()
    }

    #[test]
    fn neighbours_go_together() {
        let plan = plan(
            "di = [{ channel = 9, count = 8, discrete_input = 8 }, { channel = 1, count = 8, discrete_input = 0 },
                   { channel = 17, discrete_input = 17 }, { channel = 18, coil = 0 }]
             ai = [{ channel = 1, count = 2, input_register = 0 }, { channel = 3, input_register = 1 }]
             do = [{ channel = 1, count = 17, holding_register = 3, bit = 8 }]
             ao = [{ channel = 1, holding_register = 5 }]",
        );
        assert_eq!(
            shapes(&plan.reads),
            [
                (Table::Coil, 0, 1),
                (Table::DiscreteInput, 0, 16),
                (Table::DiscreteInput, 17, 1),
                (Table::InputRegister, 0, 2),
            ]
        );
        assert_eq!(shapes(&plan.writes), [(Table::HoldingRegister, 3, 3)]);
        assert_eq!(plan.reads[1].describe(), "discrete inputs 0 to 15");
        assert_eq!(plan.reads[0].describe(), "coil 0");
    }

    #[test]
    fn no_request_is_longer_than_the_protocol_allows() {
        let plan = plan(
            "di = [{ channel = 1, count = 4500, discrete_input = 100 }]
             ai = [{ channel = 1, count = 200, input_register = 0 }]
             do = [{ channel = 1, count = 2000, coil = 0 }, { channel = 2001, count = 2000, holding_register = 0 }]",
        );
        let counts = |runs: &[SignalRange]| runs.iter().map(|run| run.count).collect::<Vec<_>>();
        assert_eq!(counts(&plan.reads), [2000, 2000, 500, 125, 75]);
        assert_eq!(counts(&plan.writes), [1968, 32, 123, 2]);
    }

    #[test]
    fn signals_are_at_their_places() {
        let plan = plan(
            "di = [{ channel = 1, count = 10, discrete_input = 0 }, { channel = 20, count = 2, input_register = 0, bit = 7 }]
             ai = [{ channel = 1, input_register = 1, raw = [-1000, 1000] }]
             do = [{ channel = 1, count = 9, coil = 4 }, { channel = 20, count = 2, holding_register = 0, bit = 7 }]
             ao = [{ channel = 1, holding_register = 1, raw = [-1000, 1000] }]",
        );
        let mut inputs = Signals::at_rest(12, &[0.0]);
        plan.reads[0].take(&[0b1000_0001, 0b10], &mut inputs);
        plan.reads[1].take(&[0x01, 0x00, 0xff, 0x9c], &mut inputs);
        let on: Vec<usize> = (0..12).filter(|at| inputs.bits[*at]).collect();
        assert_eq!((on, inputs.values[0]), (vec![0, 7, 9, 11], -1.0));
        let mut outputs = Signals::at_rest(11, &[-1.0]);
        for at in [0, 8, 9] {
            outputs.bits[at] = true;
        }
        let (mut coils, mut registers) = ([0; 2], [0; 4]);
        plan.writes[0].put(&outputs, &mut coils);
        plan.writes[1].put(&outputs, &mut registers);
        assert_eq!((coils, registers), ([1, 1], [0x00, 0x80, 0xff, 0x9c]));
        plan.reads[0].take(&[], &mut inputs);
        assert!(!inputs.bits[0], "what is not there is off");
    }
}
