//! Messages of editors over streams: a header that gives the length, and JSON.
//!
//! What is between messages and is not a header is skipped. A wrong length costs its own message only: JSON has no line
//! ends in its strings, so a header within a message is that of the next one.

use serde_json::Value;
use std::io::{BufRead, ErrorKind, Read, Write};

/// The longest message that is read, in bytes; no robot program is longer.
const MOST_BYTES: usize = 256 << 20;
/// The header field that counts.
const LENGTH: &[u8] = b"content-length";
/// The end of a header.
const END: &[u8] = b"\r\n\r\n";

/// Writes a message.
pub(crate) fn write(output: &mut impl Write, message: &Value) -> std::io::Result<()> {
    let text = message.to_string();
    write!(output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    output.flush()
}

/// A stream of messages.
pub(crate) struct Messages<R> {
    input: R,
    /// Bytes that were read beyond a message.
    ahead: Vec<u8>,
    /// Whether there was a message, and whether there was something that is none.
    has_read: bool,
    has_skipped: bool,
}

impl<R: BufRead> Messages<R> {
    /// The messages that come from an input.
    pub(crate) fn new(input: R) -> Self {
        Self { input, ahead: Vec::new(), has_read: false, has_skipped: false }
    }

    /// Whether all that came was no message.
    pub(crate) fn is_something_else(&self) -> bool {
        self.has_skipped && !self.has_read
    }

    /// The bytes of the next message; `None` at the end of the input.
    pub(crate) fn next_message(&mut self) -> Option<Vec<u8>> {
        let length = self.header()?;
        self.has_read = true;
        let mut body = Vec::new();
        while body.len() < length {
            let searched = body.len().saturating_sub(END.len());
            let some = match self.fill_buf() {
                Ok([]) => return None,
                Ok(some) => some,
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(_) => return None,
            };
            let taken = some.len().min(length - body.len());
            body.extend(some.iter().take(taken));
            self.consume(taken);
            if let Some(at) = header_within(&body, searched) {
                self.put_back(&mut body, at);
                return Some(body);
            }
        }
        if let Some(at) = end_of_json(&body) {
            self.put_back(&mut body, at);
        }
        Some(body)
    }

    /// Puts back the bytes from a place on, so that they are read again.
    fn put_back(&mut self, body: &mut Vec<u8>, at: usize) {
        let mut ahead = body.split_off(at);
        ahead.append(&mut self.ahead);
        self.ahead = ahead;
    }

    /// The length of the body, from the header before it. What is not a header is skipped.
    fn header(&mut self) -> Option<usize> {
        let mut length = None;
        let mut line = Vec::new();
        loop {
            line.clear();
            if self.read_until(b'\n', &mut line).ok()? == 0 {
                return None;
            }
            let text = line.trim_ascii();
            match last_length(text) {
                Some(at) => length = text.get(at..).and_then(length_in),
                None => self.has_skipped |= !text.is_empty(),
            }
            if let (true, Some(length)) = (text.is_empty(), length) {
                return Some(length);
            }
        }
    }
}

impl<R: BufRead> Read for Messages<R> {
    fn read(&mut self, bytes: &mut [u8]) -> std::io::Result<usize> {
        let mut some = self.fill_buf()?;
        let count = some.read(bytes)?;
        self.consume(count);
        Ok(count)
    }
}

impl<R: BufRead> BufRead for Messages<R> {
    fn fill_buf(&mut self) -> std::io::Result<&[u8]> {
        if self.ahead.is_empty() { self.input.fill_buf() } else { Ok(&self.ahead) }
    }

    fn consume(&mut self, count: usize) {
        if self.ahead.is_empty() {
            self.input.consume(count);
        } else {
            self.ahead.drain(..count);
        }
    }
}

/// Where a line names the length for the last time: after a message that was longer than its header said, there is no
/// line end.
fn last_length(line: &[u8]) -> Option<usize> {
    let mut starts = (0..line.len().saturating_sub(LENGTH.len() - 1)).rev();
    starts.find(|at| line.get(*at..*at + LENGTH.len()).is_some_and(|name| name.eq_ignore_ascii_case(LENGTH)))
}

/// The length in a field that names it.
fn length_in(field: &[u8]) -> Option<usize> {
    let (_, value) = std::str::from_utf8(field).ok()?.split_once(':')?;
    value.trim().parse().ok().filter(|length| *length <= MOST_BYTES)
}

/// Where a complete header begins within a message, searched from a place on.
fn header_within(body: &[u8], from: usize) -> Option<usize> {
    let ends =
        (from..body.len().saturating_sub(END.len() - 1)).find(|at| body.get(*at..*at + END.len()) == Some(END))?;
    let before = body.get(..ends)?;
    let at = last_length(before)?;
    // Another field may be between it and the end.
    let field = before.get(at..)?.split(|byte| *byte == b'\n').next()?;
    length_in(field).map(|_| at)
}

/// Where the JSON of a message ends, if something follows it.
fn end_of_json(body: &[u8]) -> Option<usize> {
    let mut values = serde_json::Deserializer::from_slice(body).into_iter::<serde::de::IgnoredAny>();
    let is_json = values.next().is_some_and(|value| value.is_ok());
    let end = values.byte_offset();
    (is_json && body.get(end..).is_some_and(|rest| !rest.trim_ascii().is_empty())).then_some(end)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is read from an input, whatever pieces it comes in.
    fn all(input: &str) -> Vec<String> {
        let read = |piece: usize| {
            let mut messages = Messages::new(std::io::BufReader::with_capacity(piece, input.as_bytes()));
            let next = || messages.next_message().map(|body| String::from_utf8_lossy(&body).into_owned());
            std::iter::from_fn(next).collect::<Vec<_>>()
        };
        let whole = read(1 << 16);
        for piece in [1, 2, 3, 7, 64] {
            assert_eq!(read(piece), whole, "in pieces of {piece}: {input}");
        }
        whole
    }

    #[test]
    fn a_length_that_is_wrong_costs_its_own_message_only() {
        const WRONG: &str = r#"{"id":1}"#;
        const NEXT: &str = r#"{"id":2,"text":"Content-Length: 3"}"#;
        let good = format!("Content-Length: {}\r\n\r\n{NEXT}", NEXT.len());
        let fields = [
            "Content-Length: 8",
            "Content-Length: 1",
            "Content-Length: 0",
            "Content-Length: 9",
            "Content-Length: 20",
            "Content-Length: 25",
            "Content-Length: 28",
            "Content-Length: 30",
            "Content-Length: 70",
            "Content-Length: 1000",
            "Content-Length: 268435456",
            "Content-Length: 268435457",
            "Content-Length: 99999999999999999999999",
            "Content-Length: -8",
            "Content-Length: 8.0",
            "Content-Length: 0x8",
            "Content-Length: eight",
            "Content-Length:",
            "Content-Length 8",
            "Content-Length: 8, 8",
            "Content-Length: 8\r\nContent-Length: x",
            "content-length: 3",
            "Content-Type: x",
            "",
        ];
        for field in fields {
            for input in [format!("{field}\r\n\r\n{WRONG}{good}"), format!("{good}{field}\r\n\r\n{WRONG}{good}{good}")]
            {
                let found = all(&input);
                assert_eq!(found.last().map(String::as_str), Some(NEXT), "{field}: {found:?}");
                let count = found.iter().filter(|body| *body == NEXT).count();
                assert_eq!(count, input.matches(NEXT).count(), "{field}: {found:?}");
            }
        }
    }

    #[test]
    fn what_is_too_long_is_read_to_the_end_of_its_json() {
        let input = "Content-Length: 12\r\n\r\n{\"id\":1}Content-Length: 2\r\n\r\n[]";
        assert_eq!(all(input), ["{\"id\":1}", "[]"]);
    }

    #[test]
    fn what_is_cut_off_is_no_message() {
        assert!(all("Content-Length: 9\r\n\r\n{\"id\":1").is_empty());
        assert!(all("Content-Length: 9").is_empty());
    }
}
