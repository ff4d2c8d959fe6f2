//! Turns the bytes of a file into text: UTF-8, with or without byte order mark, or GB18030.

use std::borrow::Cow;
use std::fmt;
use std::ops::Range;

use encoding_rs::{DecoderResult, GB18030};

/// The byte order mark of UTF-8.
const MARK: &[u8] = b"\xef\xbb\xbf";

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

/// The text of a file; line ends stay as they are, a byte order mark is dropped.
///
/// # Errors
/// Bytes that are neither UTF-8 nor GB18030, with the offset of the first of them.
pub fn decode(bytes: &[u8]) -> Result<Cow<'_, str>, DecodeError> {
    let bytes = bytes.strip_prefix(MARK).map_or((bytes, 0), |rest| (rest, MARK.len()));
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

/// Lines of one file in two encodings.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Mixed {
    /// The first line that is UTF-8, from 1.
    pub utf8: usize,
    /// The first line that is not.
    pub other: usize,
}

/// Whether some lines of a file are UTF-8 and others are not, as where two editors wrote it.
///
/// ```
/// let file = [b"//\xb5\xe3\n".as_slice(), "print \"点\"".as_bytes()].concat();
/// let mixed = arl_lang::text::mixed(&file).unwrap();
/// assert_eq!((mixed.other, mixed.utf8), (1, 2));
/// ```
pub fn mixed(bytes: &[u8]) -> Option<Mixed> {
    // Two bytes of GB18030 are often a letter of UTF-8, too; three of Chinese in UTF-8 are hardly ever chance.
    let is_chinese = |text: &str| text.chars().filter(|c| !c.is_ascii()).all(|c| c >= '\u{2e80}');
    let (mut utf8, mut other) = (None, None);
    for (line, number) in bytes.split(|byte| *byte == b'\n').zip(1..).filter(|(line, _)| !line.is_ascii()) {
        match std::str::from_utf8(line) {
            Ok(text) if is_chinese(text) => _ = utf8.get_or_insert(number),
            Ok(_) => {}
            Err(_) => _ = other.get_or_insert(number),
        }
    }
    Some(Mixed { utf8: utf8?, other: other? })
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

/// The bytes of a file with a part of its text, as returned by [`decode`], replaced by ASCII characters; all other
/// bytes stay. `None` where the part is not within the text, or its bytes cannot be determined.
///
/// ```
/// let file = "\u{feff}pose p = {x 1}\r\n".as_bytes();
/// let changed = arl_lang::text::splice(file, 12..13, "2.5").unwrap();
/// assert_eq!(changed, "\u{feff}pose p = {x 2.5}\r\n".as_bytes());
/// ```
pub fn splice(bytes: &[u8], part: Range<usize>, with: &str) -> Option<Vec<u8>> {
    let text = decode(bytes).ok()?;
    let mark = if bytes.starts_with(MARK) { MARK.len() } else { 0 };
    let (before, behind) = (text.get(..part.start)?, text.get(part.end..)?);
    text.get(part)?;
    let utf8 = matches!(text, Cow::Borrowed(_));
    let length = |text: &str| if utf8 { text.len() } else { GB18030.encode(text).0.len() };
    let (start, end) = (mark + length(before), bytes.len().checked_sub(length(behind))?);
    let mut changed = bytes.get(..start)?.to_vec();
    changed.extend_from_slice(with.as_bytes());
    changed.extend_from_slice(bytes.get(end..)?);
    // Some characters have two encodings: then the lengths above may be wrong.
    let right = decode(&changed).is_ok_and(|now| now == format!("{before}{with}{behind}"));
    (right && with.is_ascii()).then_some(changed)
}

/// The bytes of `text` as a file in the encoding of another file, with a byte order mark where that file has one.
/// `None` where `file` is not a text, or could not itself be reproduced byte for byte: then other characters could
/// change, too.
///
/// ```
/// let file = b"//\xb5\xe3\nlin p1";
/// let text = arl_lang::text::decode(file).unwrap();
/// let changed = arl_lang::text::encode_like(file, &text.replace("p1", "p2"));
/// assert_eq!(changed.unwrap(), b"//\xb5\xe3\nlin p2");
/// ```
pub fn encode_like(file: &[u8], text: &str) -> Option<Vec<u8>> {
    let old = decode(file).ok()?;
    let utf8 = matches!(old, Cow::Borrowed(_));
    let mark = if file.starts_with(MARK) { MARK } else { b"" };
    let encoded = |text: &str| {
        let bytes = if utf8 { Cow::Owned(text.as_bytes().to_vec()) } else { GB18030.encode(text).0 };
        [mark, &bytes].concat()
    };
    let new = encoded(text);
    let same = encoded(&old) == file && decode(&new).is_ok_and(|read| read == text);
    same.then_some(new)
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
    fn encoded_as_before() {
        let (bytes, _, _) = GB18030.encode("//移动到点𠀀\r\nlin p1");
        assert_eq!(encode_like(&bytes, "//移动到点𠀀\n").unwrap(), GB18030.encode("//移动到点𠀀\n").0.as_ref());
        assert_eq!(encode_like("\u{feff}int a".as_bytes(), "int ä").unwrap(), "\u{feff}int ä".as_bytes());
        assert_eq!(encode_like(b"int a", "int b").unwrap(), b"int b");
        // The longer one of the two encodings of a character.
        assert_eq!(decode(b"//\x84\x31\x82\x36").unwrap(), decode(b"//\xa6\xd9").unwrap());
        assert_eq!(encode_like(b"//\x84\x31\x82\x36", "//"), None);
        assert_eq!(encode_like(b"\xff\xfeint", "int"), None);
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
