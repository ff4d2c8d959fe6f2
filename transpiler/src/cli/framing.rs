//! Messages of editors over streams: a header that tells the length, and JSON.
//!
//! What stands between messages and is no header is passed over.

use serde_json::Value;
use std::io::{BufRead, Read, Write};

/// The longest message that is read, in bytes: more is no robot program.
const MOST_BYTES: usize = 256 << 20;

/// Writes a message.
pub(super) fn write(output: &mut impl Write, message: &Value) -> std::io::Result<()> {
    let text = message.to_string();
    write!(output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    output.flush()
}

/// The bytes of the next message; `None` at the end of the input.
pub(super) fn read(input: &mut impl BufRead) -> Option<Vec<u8>> {
    let length = header(input)?;
    let mut body = Vec::new();
    let taken = input.take(length as u64).read_to_end(&mut body).ok()?;
    (taken == length).then_some(body)
}

/// The length of the body, from the header in front of it. What is no header is passed over.
fn header(input: &mut impl BufRead) -> Option<usize> {
    let mut length = None;
    let mut line = Vec::new();
    loop {
        line.clear();
        if input.read_until(b'\n', &mut line).ok()? == 0 {
            return None;
        }
        let text = String::from_utf8_lossy(&line);
        let text = text.trim();
        if let Some((name, value)) = text.split_once(':')
            && name.trim().eq_ignore_ascii_case("content-length")
        {
            length = value.trim().parse().ok().filter(|length| *length <= MOST_BYTES);
        }
        if let (true, Some(length)) = (text.is_empty(), length) {
            return Some(length);
        }
    }
}
