//! Modbus requests that the controller sends as a client, and the evaluation of the answers: bytes without the frame,
//! Modbus Application Protocol 1.1b3.

use arl_robot::islands::Table;

/// The most coils or registers that one request may read, by the specification.
pub(crate) const fn most_read(table: Table) -> usize {
    if table.has_bits() { super::pdu::MOST_READ_COILS } else { super::pdu::MOST_READ_REGISTERS }
}

/// The most coils or registers that one request may write, by the specification.
pub(crate) const fn most_written(table: Table) -> usize {
    if table.has_bits() { super::pdu::MOST_WRITTEN_COILS } else { super::pdu::MOST_WRITTEN_REGISTERS }
}

/// The reason why an answer has no data.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Refusal {
    /// The server has answered with this exception code.
    Exception(u8),
    /// The bytes are not an answer to this request.
    Garbage,
}

/// The size in bytes of `count` coils or registers.
pub(crate) const fn size(table: Table, count: usize) -> usize {
    if table.has_bits() { count.div_ceil(8) } else { 2 * count }
}

/// Builds a request to read `count` coils or registers from `start` on.
pub(crate) fn read_request(out: &mut Vec<u8>, table: Table, start: u16, count: u16) {
    let function = match table {
        Table::Coil => 1,
        Table::DiscreteInput => 2,
        Table::HoldingRegister => 3,
        Table::InputRegister => 4,
    };
    out.clear();
    out.push(function);
    out.extend_from_slice(&start.to_be_bytes());
    out.extend_from_slice(&count.to_be_bytes());
}

/// Builds a request to set `count` coils or registers from `start` on; returns the place for their bytes, all 0.
pub(crate) fn write_request(out: &mut Vec<u8>, table: Table, start: u16, count: u16) -> &mut [u8] {
    let bytes = size(table, count.into());
    out.clear();
    out.push(if table.has_bits() { 15 } else { 16 });
    out.extend_from_slice(&start.to_be_bytes());
    out.extend_from_slice(&count.to_be_bytes());
    out.push(bytes as u8);
    let head = out.len();
    out.resize(head + bytes, 0);
    out.get_mut(head..).unwrap_or_default()
}

/// The data bytes of the answer to a read request.
///
/// # Errors
/// The answer has none.
pub(crate) fn read_answer(table: Table, function: u8, count: usize, answer: &[u8]) -> Result<&[u8], Refusal> {
    match answer {
        [code, bytes, data @ ..]
            if *code == function && usize::from(*bytes) == data.len() && data.len() == size(table, count) =>
        {
            Ok(data)
        }
        _ => Err(refusal(function, answer)),
    }
}

/// Checks whether a write request was carried out: the answer repeats its function, start and count.
///
/// # Errors
/// The request was not carried out.
pub(crate) fn write_answer(request: &[u8], answer: &[u8]) -> Result<(), Refusal> {
    match (request.get(..5), request.first()) {
        (Some(head), _) if head == answer => Ok(()),
        (_, function) => Err(refusal(function.copied().unwrap_or_default(), answer)),
    }
}

fn refusal(function: u8, answer: &[u8]) -> Refusal {
    match answer {
        [code, exception] if *code == function | 0x80 => Refusal::Exception(*exception),
        _ => Refusal::Garbage,
    }
}

/// The meaning of an exception code, as a part of a message.
pub(crate) const fn exception(code: u8) -> &'static str {
    match code {
        1 => "it does not have this function",
        2 => "it does not have these addresses",
        3 => "it does not take this value or count",
        4 => "it has failed",
        6 => "it is busy",
        10 | 11 => "the gateway does not reach the unit",
        _ => "the protocol does not define this code",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fieldbus::modbus::pdu::{self, Answer};
    use crate::fieldbus::modbus::{SIZE, Tables};
    use crate::fieldbus::noise::Noise;

    fn served(tables: &mut Tables, request: &[u8]) -> Vec<u8> {
        let mut answer = Answer::new();
        pdu::serve(request, tables, &mut answer);
        answer.bytes().to_vec()
    }

    #[test]
    fn a_server_understands_what_a_client_asks() {
        let (mut tables, mut request) = (Tables::default(), Vec::new());
        for (table, start, count) in [
            (Table::Coil, 3, 1),
            (Table::Coil, 100, 1968),
            (Table::HoldingRegister, 65535, 1),
            (Table::HoldingRegister, 9, 123),
        ] {
            let data = write_request(&mut request, table, start, count);
            data.iter_mut().enumerate().for_each(|(at, byte)| *byte = at as u8 | 1);
            // Surplus bits cannot be read.
            if table == Table::Coil && count % 8 != 0 {
                data.iter_mut().last().into_iter().for_each(|byte| *byte &= (1 << (count % 8)) - 1);
            }
            let sent = data.to_vec();
            let answer = served(&mut tables, &request);
            assert_eq!(write_answer(&request, &answer), Ok(()));
            read_request(&mut request, table, start, count);
            let answer = served(&mut tables, &request);
            assert_eq!(read_answer(table, request[0], count.into(), &answer), Ok(&*sent));
        }
        assert_eq!(usize::from(u16::MAX) + 1, SIZE);
    }

    #[test]
    fn exceptions_and_garbage_are_distinguished() {
        let (mut tables, mut request) = (Tables::default(), Vec::new());
        read_request(&mut request, Table::HoldingRegister, 65535, 2);
        let answer = served(&mut tables, &request);
        assert_eq!(read_answer(Table::HoldingRegister, 3, 2, &answer), Err(Refusal::Exception(2)));
        for answer in [&[][..], &[3], &[3, 2, 0, 0], &[3, 4, 0, 0, 0], &[4, 4, 0, 0, 0, 0], &[0x84, 2], &[0x83, 2, 0]] {
            assert_eq!(read_answer(Table::HoldingRegister, 3, 2, answer), Err(Refusal::Garbage), "{answer:?}");
        }
        write_request(&mut request, Table::Coil, 7, 3);
        assert_eq!(write_answer(&request, &[0x8f, 6]), Err(Refusal::Exception(6)));
        for answer in [&[15, 0, 7, 0, 4][..], &[15, 0, 7, 0], &[16, 0, 7, 0, 3], &[15, 0, 7, 0, 3, 0]] {
            assert_eq!(write_answer(&request, answer), Err(Refusal::Garbage), "{answer:?}");
        }
    }

    #[test]
    fn random_answers_are_read_without_harm() {
        let (mut noise, mut request) = (Noise::new(7), Vec::new());
        for _ in 0..20_000 {
            let table =
                [Table::Coil, Table::DiscreteInput, Table::HoldingRegister, Table::InputRegister][noise.below(4)];
            let count = 1 + noise.below(most_read(table));
            read_request(&mut request, table, 0, count as u16);
            let answer = noise.bytes(pdu::LONGEST);
            if let Ok(data) = read_answer(table, request[0], count, &answer) {
                assert_eq!(data.len(), size(table, count));
            }
        }
    }
}
