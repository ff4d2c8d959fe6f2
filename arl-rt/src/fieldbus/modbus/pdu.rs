//! Modbus requests and their answers, as bytes without the frame: Modbus Application Protocol 1.1b3.
//!
//! Own code: of the crates that answer requests without a runtime of their own, rmodbus 0.13 drops requests of more
//! than 250 bytes and answers unknown functions whatever their checksum, and modbus-core 0.2 trusts the counts of the
//! sender.

use super::tables::Tables;

/// The most bytes of a request or an answer.
pub(crate) const LONGEST: usize = 253;

/// The most that one request may read or write, by the specification.
pub(crate) const MOST_READ_COILS: usize = 2000;
pub(crate) const MOST_WRITTEN_COILS: usize = 1968;
pub(crate) const MOST_READ_REGISTERS: usize = 125;
pub(crate) const MOST_WRITTEN_REGISTERS: usize = 123;
const MOST_EXCHANGED_REGISTERS: usize = 121;

/// The functions of this server, by their numbers.
mod function {
    pub(super) const READ_COILS: u8 = 1;
    pub(super) const READ_REGISTERS: u8 = 3;
    pub(super) const WRITE_COIL: u8 = 5;
    pub(super) const WRITE_REGISTER: u8 = 6;
    pub(super) const WRITE_COILS: u8 = 15;
    pub(super) const WRITE_REGISTERS: u8 = 16;
    pub(super) const MASK_REGISTER: u8 = 22;
    pub(super) const EXCHANGE_REGISTERS: u8 = 23;
}

/// The reason why a request is refused; the numbers are those of the protocol.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Exception {
    /// A function that the server does not have.
    Function = 1,
    /// Registers or coils that do not exist.
    Address = 2,
    /// A count or a value that is not allowed, or a request of the wrong length.
    Value = 3,
}

/// An answer of variable length.
#[derive(Clone, Debug)]
pub(crate) struct Answer {
    bytes: [u8; LONGEST],
    len: usize,
}

impl Answer {
    /// No answer yet.
    pub(crate) const fn new() -> Self {
        Self { bytes: [0; LONGEST], len: 0 }
    }

    /// The answer's bytes.
    pub(crate) fn bytes(&self) -> &[u8] {
        self.bytes.get(..self.len).unwrap_or_default()
    }

    fn set(&mut self, parts: &[&[u8]]) {
        self.len = 0;
        for part in parts {
            if let Some(place) = self.bytes.get_mut(self.len..self.len + part.len()) {
                place.copy_from_slice(part);
                self.len += part.len();
            }
        }
    }

    /// Writes the function and the number of bytes; returns the room for these.
    fn data(&mut self, function: u8, count: usize) -> Option<&mut [u8]> {
        self.len = 2 + count;
        let place = self.bytes.get_mut(..self.len)?;
        let (head, data) = place.split_at_mut(2);
        head.copy_from_slice(&[function, u8::try_from(count).ok()?]);
        Some(data)
    }
}

/// Carries out a request, completely or not at all; `answer` is set to the bytes to send back. An empty request has no
/// answer.
pub(crate) fn serve(request: &[u8], tables: &mut Tables, answer: &mut Answer) {
    let Some(function) = request.first().copied() else {
        answer.set(&[]);
        return;
    };
    if let Err(exception) = execute(request, tables, answer) {
        answer.set(&[&[function | 0x80, exception as u8]]);
    }
}

fn execute(request: &[u8], tables: &mut Tables, answer: &mut Answer) -> Result<(), Exception> {
    use Exception::{Address, Function, Value};
    match *request {
        [code @ function::READ_COILS, a, b, c, d] => {
            let count = count(word(c, d), MOST_READ_COILS)?;
            let data = answer.data(code, count.div_ceil(8)).ok_or(Value)?;
            tables.read_coils(address(a, b), count, data).ok_or(Address)
        }
        [code @ function::READ_REGISTERS, a, b, c, d] => {
            let count = count(word(c, d), MOST_READ_REGISTERS)?;
            let from = tables.registers(address(a, b), count).ok_or(Address)?;
            answer.data(code, 2 * count).ok_or(Value)?.copy_from_slice(from);
            Ok(())
        }
        [function::WRITE_COIL, a, b, c, d] => {
            tables.write_coils(address(a, b), 1, &[level(c, d)?]).ok_or(Address)?;
            answer.set(&[request]);
            Ok(())
        }
        [function::WRITE_REGISTER, a, b, c, d] => {
            tables.registers_mut(address(a, b), 1).ok_or(Address)?.copy_from_slice(&[c, d]);
            answer.set(&[request]);
            Ok(())
        }
        [function::WRITE_COILS, a, b, c, d, bytes, ref data @ ..] => {
            let count = count(word(c, d), MOST_WRITTEN_COILS)?;
            if usize::from(bytes) != count.div_ceil(8) || data.len() != usize::from(bytes) {
                return Err(Value);
            }
            tables.write_coils(address(a, b), count, data).ok_or(Address)?;
            answer.set(&[&[function::WRITE_COILS, a, b, c, d]]);
            Ok(())
        }
        [function::WRITE_REGISTERS, a, b, c, d, bytes, ref data @ ..] => {
            let count = count(word(c, d), MOST_WRITTEN_REGISTERS)?;
            if usize::from(bytes) != 2 * count || data.len() != 2 * count {
                return Err(Value);
            }
            tables.registers_mut(address(a, b), count).ok_or(Address)?.copy_from_slice(data);
            answer.set(&[&[function::WRITE_REGISTERS, a, b, c, d]]);
            Ok(())
        }
        [function::MASK_REGISTER, a, b, and_high, and_low, or_high, or_low] => {
            let register = tables.registers_mut(address(a, b), 1).ok_or(Address)?;
            mask(register, [and_high, and_low], [or_high, or_low]);
            answer.set(&[request]);
            Ok(())
        }
        [function::EXCHANGE_REGISTERS, a, b, c, d, e, f, g, h, bytes, ref data @ ..] => {
            let read = count(word(c, d), MOST_READ_REGISTERS)?;
            let written = count(word(g, h), MOST_EXCHANGED_REGISTERS)?;
            if usize::from(bytes) != 2 * written || data.len() != 2 * written {
                return Err(Value);
            }
            exchange_registers(address(a, b), read, address(e, f), data, tables, answer)
        }
        [
            function::READ_COILS
            | function::READ_REGISTERS
            | function::WRITE_COIL
            | function::WRITE_REGISTER
            | function::WRITE_COILS
            | function::WRITE_REGISTERS
            | function::MASK_REGISTER
            | function::EXCHANGE_REGISTERS,
            ..,
        ] => Err(Value),
        _ => Err(Function),
    }
}

/// The count of a request: 1 to `most`.
fn count(asked: u16, most: usize) -> Result<usize, Exception> {
    match usize::from(asked) {
        count if (1..=most).contains(&count) => Ok(count),
        _ => Err(Exception::Value),
    }
}

/// The level to which a coil is set.
fn level(high: u8, low: u8) -> Result<u8, Exception> {
    match word(high, low) {
        0xff00 => Ok(1),
        0 => Ok(0),
        _ => Err(Exception::Value),
    }
}

fn mask(register: &mut [u8], and: [u8; 2], or: [u8; 2]) {
    for (byte, (and, or)) in register.iter_mut().zip(and.into_iter().zip(or)) {
        *byte = *byte & and | or & !and;
    }
}

/// Writes registers from `to` on, then reads `read` registers from `from` on.
fn exchange_registers(
    from: usize,
    read: usize,
    to: usize,
    data: &[u8],
    tables: &mut Tables,
    answer: &mut Answer,
) -> Result<(), Exception> {
    use Exception::{Address, Value};
    // Nothing is written if the registers to read do not exist.
    tables.registers(from, read).ok_or(Address)?;
    tables.registers_mut(to, data.len() / 2).ok_or(Address)?.copy_from_slice(data);
    let from = tables.registers(from, read).ok_or(Address)?;
    answer.data(function::EXCHANGE_REGISTERS, 2 * read).ok_or(Value)?.copy_from_slice(from);
    Ok(())
}

fn word(high: u8, low: u8) -> u16 {
    u16::from_be_bytes([high, low])
}

fn address(high: u8, low: u8) -> usize {
    usize::from(word(high, low))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fieldbus::noise::Noise;

    fn served(tables: &mut Tables, request: &[u8]) -> Vec<u8> {
        let mut answer = Answer::new();
        serve(request, tables, &mut answer);
        answer.bytes().to_vec()
    }

    /// The example exchanges of the specification, with its addresses.
    #[test]
    fn the_specifications_examples() {
        let mut tables = Tables::default();
        tables.registers_mut(0x6b, 3).unwrap().copy_from_slice(&[0x02, 0x2b, 0, 0, 0, 0x64]);
        assert_eq!(served(&mut tables, &[3, 0, 0x6b, 0, 3]), [3, 6, 0x02, 0x2b, 0, 0, 0, 0x64]);
        tables.write_coils(0x13, 19, &[0xcd, 0x6b, 0x05]).unwrap();
        assert_eq!(served(&mut tables, &[1, 0, 0x13, 0, 0x13]), [1, 3, 0xcd, 0x6b, 0x05]);
        assert_eq!(served(&mut tables, &[5, 0, 0xac, 0xff, 0]), [5, 0, 0xac, 0xff, 0]);
        assert_eq!(served(&mut tables, &[6, 0, 1, 0, 3]), [6, 0, 1, 0, 3]);
        assert_eq!(served(&mut tables, &[15, 0, 0x13, 0, 10, 2, 0xcd, 1]), [15, 0, 0x13, 0, 10]);
        assert_eq!(served(&mut tables, &[16, 0, 1, 0, 2, 4, 0, 10, 1, 2]), [16, 0, 1, 0, 2]);
        tables.registers_mut(4, 1).unwrap().copy_from_slice(&[0, 0x12]);
        assert_eq!(served(&mut tables, &[22, 0, 4, 0, 0xf2, 0, 0x25]), [22, 0, 4, 0, 0xf2, 0, 0x25]);
        assert_eq!(tables.registers(4, 1).unwrap(), [0, 0x17]);
        let request = [23, 0, 3, 0, 6, 0, 14, 0, 3, 6, 0, 0xff, 0, 0xff, 0, 0xff];
        tables.registers_mut(3, 6).unwrap().copy_from_slice(&[0, 0xfe, 0x0a, 0xcd, 0, 1, 0, 3, 0, 13, 0, 0xff]);
        assert_eq!(served(&mut tables, &request), [23, 12, 0, 0xfe, 0x0a, 0xcd, 0, 1, 0, 3, 0, 13, 0, 0xff]);
        assert_eq!(tables.registers(14, 3).unwrap(), [0, 0xff, 0, 0xff, 0, 0xff]);
    }

    #[test]
    fn what_is_refused() {
        let tables = &mut Tables::default();
        for (request, answer) in [
            (&[2, 0, 0, 0, 1][..], [0x82, 1]),
            (&[4, 0, 0, 0, 1], [0x84, 1]),
            (&[7], [0x87, 1]),
            (&[0x83, 0], [0x83, 1]),
            (&[3, 0xff, 0xff, 0, 2], [0x83, 2]),
            (&[1, 0xff, 0xff, 0, 2], [0x81, 2]),
            (&[3, 0, 0, 0, 0], [0x83, 3]),
            (&[3, 0, 0, 0, 126], [0x83, 3]),
            (&[1, 0, 0, 0x07, 0xd1], [0x81, 3]),
            (&[3, 0, 0, 0], [0x83, 3]),
            (&[3, 0, 0, 0, 1, 0], [0x83, 3]),
            (&[5, 0, 0, 1, 0], [0x85, 3]),
            (&[15, 0, 0, 0, 9, 1, 0xff], [0x8f, 3]),
            (&[16, 0, 0, 0, 2, 4, 1, 2, 3], [0x90, 3]),
            (&[16, 0, 0, 0, 2, 3, 1, 2, 3], [0x90, 3]),
            (&[16, 0xff, 0xff, 0, 2, 4, 1, 2, 3, 4], [0x90, 2]),
            (&[23, 0xff, 0xff, 0, 2, 0, 0, 0, 1, 2, 9, 9], [0x97, 2]),
            (&[23, 0, 0, 0, 1, 0, 0, 0, 122, 244], [0x97, 3]),
        ] {
            assert_eq!(served(tables, request), answer, "{request:?}");
        }
        assert!(served(tables, &[]).is_empty());
        assert_eq!(tables.registers(0, 2).unwrap(), [0; 4], "what is refused changes nothing");
    }

    #[test]
    fn the_longest_requests_are_served() {
        let tables = &mut Tables::default();
        let registers: Vec<u8> = [16, 0, 0, 0, 123, 246].into_iter().chain(1..=246).collect();
        assert_eq!(served(tables, &registers), [16, 0, 0, 0, 123]);
        assert_eq!(served(tables, &[3, 0, 0, 0, 125]).len(), 252);
        assert_eq!(served(tables, &[1, 0, 0, 0x07, 0xd0]).len(), 252);
    }

    #[test]
    fn random_bytes_get_an_answer_of_their_function() {
        let tables = &mut Tables::default();
        let mut noise = Noise::new(1);
        for _ in 0..20_000 {
            let mut request = noise.bytes(LONGEST);
            if let Some(code) = request.first_mut()
                && noise.below(4) > 0
            {
                *code = [1, 3, 5, 6, 15, 16, 22, 23][noise.below(8)];
            }
            let answer = served(tables, &request);
            match request.first() {
                None => assert!(answer.is_empty()),
                Some(code) => {
                    assert!(answer[0] | 0x80 == code | 0x80 && answer.len() <= LONGEST, "{request:?}: {answer:?}");
                    assert!(answer[0] & 0x80 == 0 || answer.len() == 2, "{request:?}: {answer:?}");
                }
            }
        }
    }
}
