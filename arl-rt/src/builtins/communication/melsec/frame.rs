//! Frames of the MC protocol (SLMP), 3E, binary: reading and writing D registers.

/// The most registers that one request may read or write.
pub(super) const MOST_REGISTERS: usize = 960;

/// The last register number that a frame can name.
pub(super) const LAST_REGISTER: i32 = 0xff_ffff;

/// Bytes in front of the length: mark, network, PC, module, station.
const ROUTE: usize = 7;
const HEAD: usize = ROUTE + 2;

const READ: u16 = 0x0401;
const WRITE: u16 = 0x1401;
/// The code of D registers.
const D: u8 = 0xa8;

/// How long the PLC may take for its answer, in units of 0.25 s: 4 s.
const TIMER: u16 = 16;

/// The start of the received bytes.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum ReceivedFrame {
    /// An answer: its end code (0: done), its data, and its size in bytes.
    Answer { code: u16, data: Vec<u8>, size: usize },
    /// The beginning of an answer.
    Part,
    /// Not an answer of the MC protocol.
    Garbage,
}

/// The request to read registers.
pub(super) fn read(pc: u8, start: u32, count: u16) -> Vec<u8> {
    request(pc, READ, start, count, &[])
}

/// The request to write bytes into registers, low bytes first; a register that is only half filled gets 0 in its high
/// byte.
pub(super) fn write(pc: u8, start: u32, bytes: &[u8]) -> Vec<u8> {
    let count = bytes.len().div_ceil(2) as u16;
    let mut request = request(pc, WRITE, start, count, bytes);
    if bytes.len() % 2 == 1 {
        request.push(0);
    }
    request
}

fn request(pc: u8, command: u16, start: u32, count: u16, data: &[u8]) -> Vec<u8> {
    // From the timer to the end.
    let length = 2 + 10 + data.len() + data.len() % 2;
    // Network 0, the PLC's own module, its own station.
    let mut request = vec![0x50, 0, 0, pc, 0xff, 0x03, 0];
    request.extend_from_slice(&(length as u16).to_le_bytes());
    request.extend_from_slice(&TIMER.to_le_bytes());
    request.extend_from_slice(&command.to_le_bytes());
    request.extend_from_slice(&[0, 0]);
    request.extend_from_slice(start.to_le_bytes().get(..3).unwrap_or_default());
    request.push(D);
    request.extend_from_slice(&count.to_le_bytes());
    request.extend_from_slice(data);
    request
}

/// The answer at the start of the received bytes.
pub(super) fn first(bytes: &[u8]) -> ReceivedFrame {
    const MARK: [u8; 2] = [0xd0, 0];
    if !MARK.starts_with(bytes.get(..bytes.len().min(2)).unwrap_or_default()) {
        return ReceivedFrame::Garbage;
    }
    let Some([low, high]) = bytes.get(ROUTE..HEAD) else { return ReceivedFrame::Part };
    let length = usize::from(u16::from_le_bytes([*low, *high]));
    // An end code, followed by registers or the PLC's error information.
    if !(2..=2 + 2 * MOST_REGISTERS).contains(&length) {
        return ReceivedFrame::Garbage;
    }
    match bytes.get(HEAD..HEAD + length) {
        Some([low, high, data @ ..]) => {
            ReceivedFrame::Answer { code: u16::from_le_bytes([*low, *high]), data: data.to_vec(), size: HEAD + length }
        }
        _ => ReceivedFrame::Part,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fieldbus::noise::Noise;

    /// The example frames of the protocol's public description, for D registers.
    #[test]
    fn requests_are_laid_out_as_described() {
        let head = [0x50, 0, 0, 0xff, 0xff, 3, 0];
        let found = read(255, 6000, 5);
        assert_eq!(found[..7], head);
        assert_eq!(found[7..], [12, 0, 16, 0, 1, 4, 0, 0, 0x70, 0x17, 0, 0xa8, 5, 0]);
        let found = write(2, 100, b"abc");
        assert_eq!(found[3], 2);
        assert_eq!(found[7..], [16, 0, 16, 0, 1, 0x14, 0, 0, 100, 0, 0, 0xa8, 2, 0, b'a', b'b', b'c', 0]);
    }

    #[test]
    fn an_answer_is_found_when_it_is_whole() {
        let bytes = [0xd0, 0, 0, 0xff, 0xff, 3, 0, 6, 0, 0, 0, 1, 2, 3, 4, 0xd0];
        for end in 0..15 {
            assert_eq!(first(&bytes[..end]), ReceivedFrame::Part, "{end}");
        }
        assert_eq!(first(&bytes), ReceivedFrame::Answer { code: 0, data: vec![1, 2, 3, 4], size: 15 });
        let refused = [0xd0, 0, 0, 0xff, 0xff, 3, 0, 2, 0, 0x51, 0xc0];
        assert_eq!(first(&refused), ReceivedFrame::Answer { code: 0xc051, data: vec![], size: 11 });
        for garbage in
            [&b"\x50\0"[..], b"G", &[0xd0, 1], &[0xd0, 0, 0, 0, 0, 0, 0, 1, 0], &[0xd0, 0, 0, 0, 0, 0, 0, 0, 9]]
        {
            assert_eq!(first(garbage), ReceivedFrame::Garbage, "{garbage:?}");
        }
    }

    #[test]
    fn random_bytes_are_read_without_harm() {
        let mut noise = Noise::new(4);
        for _ in 0..20_000 {
            let mut bytes = noise.bytes(40);
            for (place, byte) in bytes.iter_mut().zip([0xd0, 0]) {
                *place = byte;
            }
            if let ReceivedFrame::Answer { data, size, .. } = first(&bytes) {
                assert!(size <= bytes.len() && size == HEAD + 2 + data.len());
            }
        }
    }
}
