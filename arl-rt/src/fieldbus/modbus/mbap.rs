//! The frame of Modbus TCP around a request or an answer.

use super::pdu::LONGEST;

/// The size of the header: transaction, protocol, length, unit.
pub(crate) const HEAD: usize = 7;

/// The most bytes of a frame.
pub(crate) const LONGEST_FRAME: usize = HEAD + LONGEST;

/// The content and the header of a frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct ModbusFrame<'a> {
    /// The number that identifies the answer.
    pub(crate) transaction: u16,
    /// The unit at the address.
    pub(crate) unit: u8,
    /// The request or answer, at least one byte.
    pub(crate) pdu: &'a [u8],
}

/// The start of the received bytes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Received<'a> {
    /// A frame, and its size in bytes.
    Frame(ModbusFrame<'a>, usize),
    /// The beginning of a frame.
    Part,
    /// Not Modbus: the bytes that follow can no longer be separated into frames.
    Garbage,
}

/// The frame at the start of the received bytes.
pub(crate) fn first(bytes: &[u8]) -> Received<'_> {
    // Checked as early as possible: protocol and length may be wrong before the whole frame has arrived.
    let protocol = bytes.get(2..4.min(bytes.len())).unwrap_or_default();
    if protocol.iter().any(|byte| *byte != 0) {
        return Received::Garbage;
    }
    let Some([t1, t2, _, _, l1, l2]) = bytes.first_chunk() else { return Received::Part };
    let length = usize::from(u16::from_be_bytes([*l1, *l2]));
    if !(2..=LONGEST + 1).contains(&length) {
        return Received::Garbage;
    }
    match bytes.get(HEAD - 1..HEAD - 1 + length) {
        Some([unit, pdu @ ..]) => {
            let frame = ModbusFrame { transaction: u16::from_be_bytes([*t1, *t2]), unit: *unit, pdu };
            Received::Frame(frame, HEAD - 1 + length)
        }
        _ => Received::Part,
    }
}

/// Appends a frame.
pub(crate) fn append(out: &mut Vec<u8>, frame: &ModbusFrame<'_>) {
    let length = frame.pdu.len() as u16 + 1;
    let ([t1, t2], [l1, l2]) = (frame.transaction.to_be_bytes(), length.to_be_bytes());
    out.extend_from_slice(&[t1, t2, 0, 0, l1, l2, frame.unit]);
    out.extend_from_slice(frame.pdu);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fieldbus::noise::Noise;

    #[test]
    fn a_frame_is_found_when_it_is_whole() {
        let bytes = [0, 5, 0, 0, 0, 6, 9, 3, 0, 100, 0, 2, 0, 6];
        for end in 0..12 {
            assert_eq!(first(&bytes[..end]), Received::Part, "{end}");
        }
        let frame = ModbusFrame { transaction: 5, unit: 9, pdu: &[3, 0, 100, 0, 2] };
        assert_eq!(first(&bytes), Received::Frame(frame, 12));
        let mut out = Vec::new();
        append(&mut out, &frame);
        assert_eq!(out, bytes[..12]);
    }

    #[test]
    fn what_is_no_modbus_is_reported_early() {
        for bytes in [&b"GET / HTTP"[..], b"GET", &[0, 0, 0, 0, 0, 1], &[0, 0, 0, 0, 0, 255], &[0, 0, 0, 1]] {
            assert_eq!(first(bytes), Received::Garbage, "{bytes:?}");
        }
    }

    #[test]
    fn random_bytes_are_read_without_harm() {
        let mut noise = Noise::new(2);
        for _ in 0..20_000 {
            let bytes = noise.bytes(2 * LONGEST_FRAME);
            if let Received::Frame(frame, len) = first(&bytes) {
                assert!(len <= LONGEST_FRAME && len == HEAD + frame.pdu.len() && !frame.pdu.is_empty());
            } else {
                assert!(first(&bytes) == Received::Garbage || bytes.len() < LONGEST_FRAME);
            }
        }
    }
}
