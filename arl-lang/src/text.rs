//! Bytes of a file to text: UTF-8, with or without byte order mark, or GB18030.

use std::borrow::Cow;
use std::fmt;

use encoding_rs::{DecoderResult, GB18030};

/// Bytes that are text in neither encoding.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct DecodeError {
    /// The offset of the first byte that does not fit, in the encoding that fits further.
    pub offset: usize,
    /// Whether the file begins like UTF-16.
    pub utf16: bool,
}

impl fmt::Display for DecodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.utf16 {
            return f.write_str("the file is UTF-16; save it as UTF-8 or GB18030");
        }
        write!(f, "byte {} is neither UTF-8 nor GB18030; save the file as UTF-8", self.offset)
    }
}

impl std::error::Error for DecodeError {}

/// The text of a file; line ends stay as they are, a byte order mark goes.
///
/// # Errors
/// Bytes that are neither UTF-8 nor GB18030, with the offset of the first of them.
pub fn decode(bytes: &[u8]) -> Result<Cow<'_, str>, DecodeError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").map_or((bytes, 0), |rest| (rest, 3));
    let (bytes, mark) = bytes;
    let utf8 = match std::str::from_utf8(bytes) {
        Ok(text) => return Ok(Cow::Borrowed(text)),
        Err(error) => error.valid_up_to(),
    };
    if matches!(bytes, [0xff, 0xfe, ..] | [0xfe, 0xff, ..]) {
        return Err(DecodeError { offset: 0, utf16: true });
    }
    if mark > 0 {
        return Err(DecodeError { offset: utf8 + mark, utf16: false });
    }
    match decode_gb18030(bytes) {
        Ok(text) => Ok(Cow::Owned(text)),
        Err(gb18030) => Err(DecodeError { offset: utf8.max(gb18030), utf16: false }),
    }
}

/// The text of GB18030 bytes, or the offset of the first byte that does not fit.
fn decode_gb18030(bytes: &[u8]) -> Result<String, usize> {
    let mut decoder = GB18030.new_decoder_without_bom_handling();
    // Enough for every input, so the decoder never runs out of room.
    let room = decoder.max_utf8_buffer_length_without_replacement(bytes.len()).unwrap_or(bytes.len() * 4);
    let mut text = String::with_capacity(room);
    let (result, read) = decoder.decode_to_string_without_replacement(bytes, &mut text, true);
    match result {
        DecoderResult::InputEmpty => Ok(text),
        DecoderResult::OutputFull => Err(read),
        DecoderResult::Malformed(bad, behind) => Err(read.saturating_sub(usize::from(bad) + usize::from(behind))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn utf8_with_and_without_mark() {
        assert_eq!(decode("print \"你好\"\r\n".as_bytes()).unwrap(), "print \"你好\"\r\n");
        assert_eq!(decode(b"\xef\xbb\xbfint a\rint b").unwrap(), "int a\rint b");
        assert!(matches!(decode(b"int a"), Ok(Cow::Borrowed(_))));
        assert_eq!(decode(b"").unwrap(), "");
    }

    #[test]
    fn gb18030() {
        let (bytes, _, _) = GB18030.encode("//移动到点𠀀\nlin p1");
        assert_eq!(decode(&bytes).unwrap(), "//移动到点𠀀\nlin p1");
    }

    #[test]
    fn neither() {
        assert_eq!(decode(b"int a\n\xff\xff"), Err(DecodeError { offset: 6, utf16: false }));
        assert_eq!(decode(b"\xef\xbb\xbfab\xff"), Err(DecodeError { offset: 5, utf16: false }));
        assert_eq!(decode(b"\xff\xfei\0n\0"), Err(DecodeError { offset: 0, utf16: true }));
        // A character that is cut off at the end of the file.
        assert_eq!(decode(b"ab\xc4\xe3\xc4"), Err(DecodeError { offset: 4, utf16: false }));
    }
}
