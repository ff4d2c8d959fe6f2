//! The frame of Modbus RTU around a request or an answer: unit before, checksum after it; and requests in the bytes of
//! a line.

use super::pdu::LONGEST;

/// The most bytes of a frame.
pub(crate) const LONGEST_FRAME: usize = LONGEST + 3;

/// The start of the bytes received over the line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Start<'a> {
    /// A request with the right checksum: the addressed unit, the request itself, and the size in bytes.
    Request(u8, &'a [u8], usize),
    /// The possible beginning of a request.
    Part,
    /// Not a request: damaged, or the answer of another slave.
    Noise,
}

/// A request to a unit.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Request {
    pub(crate) unit: u8,
    pub(crate) pdu: Vec<u8>,
}

/// Bytes received over the line that have not been processed. The line also carries the answers of other slaves, whose
/// length is not that of a request: bytes after a silence may be a new request although the bytes before are still
/// incomplete.
#[derive(Default, Debug)]
pub(crate) struct ReceiveBuffer {
    bytes: Vec<u8>,
    /// The positions of bytes that came after a silence, except the first byte; ascending.
    starts: Vec<usize>,
}

impl ReceiveBuffer {
    pub(crate) fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// Adds received bytes. If the bytes so far are as long as a frame without a request, they are discarded.
    pub(crate) fn push(&mut self, piece: &[u8], after_silence: bool) {
        if self.bytes.len() >= LONGEST_FRAME {
            self.clear();
        }
        if after_silence && !self.bytes.is_empty() && !piece.is_empty() {
            self.starts.push(self.bytes.len());
        }
        self.bytes.extend_from_slice(piece);
    }

    /// Takes the next complete request, and discards the bytes before it and bytes that cannot become a request.
    pub(crate) fn take(&mut self) -> Option<Request> {
        let whole = std::iter::once(0).chain(self.starts.iter().copied()).find_map(|start| {
            match first(self.bytes.get(start..)?) {
                Start::Request(unit, pdu, size) => Some((Request { unit, pdu: pdu.to_vec() }, start + size)),
                Start::Part | Start::Noise => None,
            }
        });
        if let Some((request, end)) = whole {
            self.skip(end);
            return Some(request);
        }
        while !self.bytes.is_empty() && first(&self.bytes) == Start::Noise {
            self.skip(self.starts.first().copied().unwrap_or(self.bytes.len()));
        }
        None
    }

    /// Discards all bytes.
    pub(crate) fn clear(&mut self) {
        self.bytes.clear();
        self.starts.clear();
    }

    fn skip(&mut self, count: usize) {
        self.bytes.drain(..count.min(self.bytes.len()));
        self.starts.retain(|start| *start > count);
        self.starts.iter_mut().for_each(|start| *start -= count);
    }
}

/// The request at the start of the bytes.
fn first(bytes: &[u8]) -> Start<'_> {
    let Some(length) = request_length(bytes) else {
        // The length of unknown functions is unknown, too: all bytes must be one request.
        return match split(bytes) {
            Some((unit, pdu)) => Start::Request(unit, pdu, bytes.len()),
            None if bytes.len() < 4 => Start::Part,
            None => Start::Noise,
        };
    };
    match bytes.get(..length) {
        Some(frame) => split(frame).map_or(Start::Noise, |(unit, pdu)| Start::Request(unit, pdu, length)),
        None if length > LONGEST_FRAME => Start::Noise,
        None => Start::Part,
    }
}

/// The length of a request, as soon as it is known.
fn request_length(bytes: &[u8]) -> Option<usize> {
    let counted = |at: usize| bytes.get(at).map(|count| at + 1 + usize::from(*count) + 2);
    match bytes.get(1)? {
        1..=6 => Some(8),
        // Until the count has arrived, at least the bytes up to it.
        15 | 16 => Some(counted(6).unwrap_or(9)),
        22 => Some(10),
        23 => Some(counted(10).unwrap_or(13)),
        _ => None,
    }
}

/// Unit and request of a frame whose checksum is right.
fn split(frame: &[u8]) -> Option<(u8, &[u8])> {
    let (body, sum) = frame.split_last_chunk::<2>()?;
    match body {
        [unit, pdu @ ..] if !pdu.is_empty() && checksum(body) == u16::from_le_bytes(*sum) => Some((*unit, pdu)),
        _ => None,
    }
}

/// The frame around an answer.
pub(crate) fn frame(unit: u8, pdu: &[u8]) -> Vec<u8> {
    let mut frame = vec![unit];
    frame.extend_from_slice(pdu);
    frame.extend_from_slice(&checksum(&frame).to_le_bytes());
    frame
}

/// CRC-16 with the reversed polynomial A001h.
fn checksum(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0xffff, |sum, byte| {
        (0..8).fold(sum ^ u16::from(*byte), |sum, _| if sum & 1 == 1 { (sum >> 1) ^ 0xa001 } else { sum >> 1 })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fieldbus::noise::Noise;

    #[test]
    fn requests_are_found_when_they_are_whole() {
        // The example of the specification for serial lines: 02 07 has the checksum 1241h, low byte first 41h.
        assert_eq!(frame(2, &[7]), [2, 7, 0x41, 0x12]);
        assert_eq!(first(&[2, 7, 0x41, 0x12]), Start::Request(2, &[7], 4));
        let write = frame(1, &[16, 0, 1, 0, 2, 4, 0, 10, 1, 2]);
        for end in 0..write.len() {
            assert_eq!(first(&write[..end]), Start::Part, "{end}");
        }
        let mut two = write.clone();
        two.extend(frame(9, &[3, 0, 0, 0, 1]));
        assert_eq!(first(&two), Start::Request(1, &write[1..write.len() - 2], write.len()));
        assert_eq!(first(&two[write.len()..]), Start::Request(9, &[3, 0, 0, 0, 1], 8));
        two[3] ^= 1;
        assert_eq!(first(&two), Start::Noise);
        assert_eq!(first(&[1, 16, 0, 0, 0, 0, 255]), Start::Noise, "longer than any frame");
    }

    #[test]
    fn a_request_is_found_behind_what_others_say() {
        let request = frame(17, &[3, 0, 0, 0, 1]);
        let wanted = Some(Request { unit: 17, pdu: vec![3, 0, 0, 0, 1] });
        // Answers of another slave, complete or cut: too short for a request to write registers, and not a request to
        // read them.
        for other in [frame(5, &[16, 0, 0, 0, 2]), frame(5, &[3, 4, 1, 2, 3, 4]), frame(5, &[16, 0, 0])] {
            let mut buffer = ReceiveBuffer::default();
            buffer.push(&other, true);
            assert_eq!(buffer.take(), None);
            buffer.push(&request[..3], true);
            assert_eq!(buffer.take(), None);
            buffer.push(&request[3..], false);
            assert_eq!(buffer.take(), wanted, "{other:?}");
            assert!(buffer.is_empty() && buffer.starts.is_empty());
        }
    }

    #[test]
    fn a_request_may_come_in_pieces_and_be_followed_by_the_next() {
        let write = frame(17, &[16, 0, 1, 0, 2, 4, 0, 10, 1, 2]);
        let read = frame(17, &[3, 0, 0, 0, 1]);
        let mut buffer = ReceiveBuffer::default();
        for piece in write.chunks(1) {
            assert_eq!(buffer.take(), None);
            buffer.push(piece, true);
        }
        buffer.push(&read, false);
        assert_eq!(buffer.take().map(|request| request.pdu[0]), Some(16));
        assert_eq!(buffer.take().map(|request| request.pdu[0]), Some(3));
        assert_eq!(buffer.take(), None);
        assert!(buffer.is_empty());
    }

    #[test]
    fn noise_does_not_grow() {
        let mut noise = Noise::new(6);
        let mut buffer = ReceiveBuffer::default();
        for at in 0..20_000 {
            buffer.push(&noise.bytes(LONGEST_FRAME), at % 3 == 0);
            if at % 2 == 0 {
                while buffer.take().is_some() {}
            }
            assert!(
                buffer.bytes.len() < 2 * LONGEST_FRAME && buffer.starts.iter().all(|start| *start < buffer.bytes.len())
            );
        }
    }

    #[test]
    fn random_bytes_are_read_without_harm() {
        let mut noise = Noise::new(5);
        for _ in 0..20_000 {
            let bytes = noise.bytes(LONGEST_FRAME);
            match first(&bytes) {
                Start::Request(_, pdu, size) => assert!(size <= bytes.len() && size == pdu.len() + 3),
                Start::Part => assert!(bytes.len() < LONGEST_FRAME),
                Start::Noise => {}
            }
        }
    }
}
