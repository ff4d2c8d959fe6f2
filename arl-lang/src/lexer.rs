//! Turns text into lexemes. The lexer never fails: what it cannot read becomes an error in the place of a lexeme.

use crate::number::{Number, NumberError, read_number};
use crate::span::Span;
use logos::FilterResult;

pub use crate::lexeme::Lexeme;

/// Text that cannot be read.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum LexicalError {
    /// A character that means nothing in ARL.
    #[default]
    UnknownCharacter,
    /// A character from outside ASCII that looks like this one.
    LooksLike(char),
    /// Letters from outside ASCII in the place of a name.
    ForeignLetters,
    /// A `"` without its partner on the line.
    UnclosedText,
    /// A `/*` without `*/`.
    UnclosedComment,
    /// An escape in a string that ARL does not have: the offset of its backslash from the string's start.
    BadEscape(u32),
    /// A malformed number.
    Number(NumberError),
    /// A `$` without a name.
    BareDollar,
    /// A `\` that is not the last character of its line.
    Backslash,
    /// Text in single quotes.
    SingleQuotes,
    /// A `#` without a Rust name or parentheses after it.
    BareSplice,
    /// A `#(` without its `)`.
    UnclosedSplice,
}

/// The lexemes of a text with their places. Between them are blanks, comments and continued line ends.
///
/// ```
/// use arl_lang::lexer::{Lexeme, lexemes};
/// let kinds: Vec<_> = lexemes("a /* b */ + // c").map(|(lexeme, _)| lexeme).collect();
/// assert_eq!(kinds, [Ok(Lexeme::Word), Ok(Lexeme::Plus)]);
/// ```
pub fn lexemes(text: &str) -> impl Iterator<Item = (Result<Lexeme, LexicalError>, Span)> {
    let placed = <Lexeme as logos::Logos>::lexer(text).spanned();
    placed.map(|(lexeme, at)| (lexeme, Span::new(at.start as u32, at.end as u32)))
}

type Lexer<'source> = logos::Lexer<'source, Lexeme>;

pub(crate) fn bare_dollar(_: &mut Lexer<'_>) -> Result<(), LexicalError> {
    Err(LexicalError::BareDollar)
}

pub(crate) fn number(lexer: &mut Lexer<'_>) -> Result<Number, LexicalError> {
    let start = lexer.span().start;
    let (length, number) = read_number(lexer.source().get(start..).unwrap_or_default());
    lexer.bump(length.saturating_sub(lexer.span().len()));
    number.map_err(LexicalError::Number)
}

/// The bytes of `rest` up to the end of the line.
fn to_line_end(rest: &str) -> usize {
    rest.bytes().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(rest.len())
}

pub(crate) fn text(lexer: &mut Lexer<'_>) -> Result<(), LexicalError> {
    let rest = lexer.remainder();
    let mut bad = None;
    let mut bytes = rest.bytes().enumerate();
    while let Some((at, byte)) = bytes.next() {
        match byte {
            b'"' => {
                lexer.bump(at + 1);
                return bad.map_or(Ok(()), |at| Err(LexicalError::BadEscape(at)));
            }
            b'\n' | b'\r' => break,
            b'\\' => match bytes.next() {
                Some((_, b'n' | b'r' | b't' | b'"' | b'\\')) => {}
                Some((_, b'\n' | b'\r')) | None => break,
                Some(_) => bad = bad.or(Some(at as u32 + 1)),
            },
            _ => {}
        }
    }
    lexer.bump(to_line_end(rest));
    Err(LexicalError::UnclosedText)
}

pub(crate) fn single_quotes(lexer: &mut Lexer<'_>) -> Result<(), LexicalError> {
    let rest = lexer.remainder();
    let stop = rest.bytes().enumerate().find(|(_, byte)| matches!(byte, b'\'' | b'\n' | b'\r'));
    lexer.bump(match stop {
        Some((at, b'\'')) => at + 1,
        Some((at, _)) => at,
        None => rest.len(),
    });
    Err(LexicalError::SingleQuotes)
}

pub(crate) fn comment(lexer: &mut Lexer<'_>) -> FilterResult<(), LexicalError> {
    let rest = lexer.remainder();
    match rest.find("*/") {
        Some(at) => {
            lexer.bump(at + 2);
            FilterResult::Skip
        }
        None => {
            lexer.bump(rest.len());
            FilterResult::Error(LexicalError::UnclosedComment)
        }
    }
}

/// `\` and blanks up to the line end, which no longer ends the line.
pub(crate) fn continuation(lexer: &mut Lexer<'_>) -> FilterResult<(), LexicalError> {
    let rest = lexer.remainder();
    let end = rest.bytes().take_while(|byte| matches!(byte, b' ' | b'\t' | 0x0b | 0x0c)).count();
    let line_end = match rest.as_bytes().get(end..) {
        Some([b'\r', b'\n', ..]) => 2,
        Some([b'\r' | b'\n', ..]) => 1,
        None | Some([]) => 0,
        Some(_) => return FilterResult::Error(LexicalError::Backslash),
    };
    lexer.bump(end + line_end);
    FilterResult::Skip
}

/// Characters outside ASCII and the ones they are taken for.
const LOOK_ALIKES: [(char, char); 22] = [
    ('。', '.'),
    ('、', ','),
    ('“', '"'),
    ('”', '"'),
    ('„', '"'),
    ('«', '"'),
    ('»', '"'),
    ('‘', '"'),
    ('’', '"'),
    ('【', '['),
    ('】', ']'),
    ('《', '<'),
    ('》', '>'),
    ('×', '*'),
    ('÷', '/'),
    ('–', '-'),
    ('—', '-'),
    ('−', '-'),
    ('￥', '$'),
    ('￠', '~'),
    ('\u{3000}', ' '),
    ('\u{a0}', ' '),
];

/// The ASCII character that `found` is taken for.
pub fn look_alike(found: char) -> Option<char> {
    if let '\u{ff01}'..='\u{ff5e}' = found {
        return char::from_u32(u32::from(found) - 0xfee0);
    }
    LOOK_ALIKES.iter().find(|(foreign, _)| *foreign == found).map(|(_, ascii)| *ascii)
}

pub(crate) fn foreign(lexer: &mut Lexer<'_>) -> FilterResult<(), LexicalError> {
    let Some(first) = lexer.slice().chars().next() else {
        return FilterResult::Error(LexicalError::UnknownCharacter);
    };
    if let Some(ascii) = look_alike(first) {
        if ascii == '"' {
            let rest = lexer.remainder();
            let ends = |c: char| matches!(c, '"' | '\n' | '\r') || look_alike(c) == Some('"');
            let stop = rest.char_indices().find(|(_, c)| ends(*c));
            let close = stop.filter(|(_, c)| !matches!(c, '\n' | '\r'));
            lexer.bump(close.map_or(0, |(at, c)| at + c.len_utf8()));
        }
        return FilterResult::Error(LexicalError::LooksLike(ascii));
    }
    if !first.is_alphanumeric() {
        return FilterResult::Error(LexicalError::UnknownCharacter);
    }
    let rest = lexer.remainder();
    let of_name = |c: &char| (c.is_alphanumeric() || *c == '_') && look_alike(*c).is_none();
    let length = rest.chars().take_while(of_name).map(char::len_utf8).sum();
    lexer.bump(length);
    FilterResult::Error(LexicalError::ForeignLetters)
}

pub(crate) fn splice(lexer: &mut Lexer<'_>) -> Result<(), LexicalError> {
    let rest = lexer.remainder();
    if !rest.starts_with('(') {
        let length = rest.bytes().take_while(|byte| byte.is_ascii_alphanumeric() || *byte == b'_').count();
        let starts_well = rest.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_');
        if !starts_well {
            return Err(LexicalError::BareSplice);
        }
        lexer.bump(length);
        return Ok(());
    }
    let end = splice_end(rest);
    lexer.bump(end.unwrap_or_else(|| to_line_end(rest)));
    end.map(|_| ()).ok_or(LexicalError::UnclosedSplice)
}

/// The most bytes of Rust that may be spliced in at one place.
const SPLICE_BYTES: usize = 16 * 1024;

/// The length from a `(` to the end of its `)`; Rust strings and characters inside are skipped.
fn splice_end(rest: &str) -> Option<usize> {
    let bytes = rest.as_bytes();
    let bytes = bytes.get(..SPLICE_BYTES).unwrap_or(bytes);
    let mut depth = 0_usize;
    let mut at = 0;
    while let Some(byte) = bytes.get(at) {
        match byte {
            b'(' => depth += 1,
            b')' => {
                depth -= 1;
                if depth == 0 {
                    return Some(at + 1);
                }
            }
            b'"' => {
                at += 1;
                while *bytes.get(at)? != b'"' {
                    at += if bytes.get(at) == Some(&b'\\') { 2 } else { 1 };
                }
            }
            b'\'' => match bytes.get(at + 1..at + 4) {
                Some([b'\\', _, b'\'']) => at += 3,
                Some([_, b'\'', _]) => at += 2,
                _ => {}
            },
            _ => {}
        }
        at += 1;
    }
    None
}
