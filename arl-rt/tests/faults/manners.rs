//! What a peer may do once it has been asked.

use std::io::{Read, Write};

/// What a peer does once it has been asked.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Manner {
    /// It goes in the middle of its answer.
    LeavesHalfway,
    /// It goes without having read what it was asked: a reset of the connection.
    Resets,
    /// It never answers.
    Silent,
    /// It answers a byte at a time.
    ByteByByte,
    /// It answers something else.
    Garbage,
    /// It sends something else as fast as it can, as long as it can.
    Floods,
}

impl Manner {
    pub(crate) const ALL: [Manner; 6] =
        [Manner::LeavesHalfway, Manner::Resets, Manner::Silent, Manner::ByteByByte, Manner::Garbage, Manner::Floods];

    /// How many cycles a program waits for the answer: for one that comes, as long as a busy computer may need.
    pub(crate) fn patience(self) -> u64 {
        match self {
            Manner::LeavesHalfway | Manner::Resets | Manner::ByteByByte => 30_000,
            Manner::Silent | Manner::Garbage | Manner::Floods => 300,
        }
    }

    /// Takes a question of so many bytes and answers it in this manner. Returns when the other side has gone, or goes
    /// itself.
    pub(crate) fn play(self, mut stream: impl Read + Write, question: usize, answer: &[u8]) {
        let mut asked = vec![0; if self == Manner::Resets { 1 } else { question }];
        stream.read_exact(&mut asked).unwrap();
        match self {
            Manner::LeavesHalfway => return stream.write_all(&answer[..answer.len() / 2]).unwrap(),
            Manner::Resets => return,
            Manner::Silent => {}
            Manner::ByteByByte => answer.iter().for_each(|byte| stream.write_all(&[*byte]).unwrap()),
            Manner::Garbage => stream.write_all(&noise(4096)).unwrap(),
            Manner::Floods => {
                let noise = noise(1 << 16);
                while stream.write_all(&noise).is_ok() {}
            }
        }
        until_it_goes(stream);
    }
}

/// Reads until the other side has gone.
pub(crate) fn until_it_goes(mut stream: impl Read) {
    let mut piece = [0; 4096];
    while stream.read(&mut piece).is_ok_and(|count| count > 0) {}
}

/// Bytes of all values, but without ends of lines.
pub(crate) fn noise(count: usize) -> Vec<u8> {
    let byte = |at: usize| ((at * 7919 + at / 11) % 256) as u8;
    (1..=count).map(byte).map(|byte| if byte == b'\n' { 1 } else { byte }).collect()
}
