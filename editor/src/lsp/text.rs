//! Places in a text as editors count them.

use arl_lang::span::{LineIndex, Span};
use gen_lsp_types::{Position, PositionEncodingKind, Range};

/// The units in which the characters of a line are counted.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) enum Encoding {
    Utf8,
    /// What every client supports.
    #[default]
    Utf16,
}

impl Encoding {
    /// The encoding to use with a client that knows these: bytes if it supports them, as they need no counting.
    pub(super) fn of(offered: &[PositionEncodingKind]) -> Self {
        if offered.contains(&PositionEncodingKind::UTF8) { Self::Utf8 } else { Self::Utf16 }
    }

    pub(super) fn kind(self) -> PositionEncodingKind {
        match self {
            Self::Utf8 => PositionEncodingKind::UTF8,
            Self::Utf16 => PositionEncodingKind::UTF16,
        }
    }

    /// The length of a text.
    pub(super) fn length(self, text: &str) -> u32 {
        match self {
            Self::Utf8 => text.len() as u32,
            Self::Utf16 if text.is_ascii() => text.len() as u32,
            Self::Utf16 => text.chars().map(char::len_utf16).sum::<usize>() as u32,
        }
    }

    /// The bytes of `line` before the character with this number; all if the line is shorter.
    fn bytes(self, line: &str, character: u32) -> usize {
        let mut counted = 0;
        for (at, one) in line.char_indices() {
            if counted >= character {
                return at;
            }
            counted += match self {
                Self::Utf8 => one.len_utf8(),
                Self::Utf16 => one.len_utf16(),
            } as u32;
        }
        line.len()
    }
}

/// A text in which places are looked up.
#[derive(Clone, Copy)]
pub(super) struct Text<'a> {
    pub(super) text: &'a str,
    pub(super) lines: &'a LineIndex,
    pub(super) encoding: Encoding,
}

impl<'a> Text<'a> {
    /// The byte at a position; the end of its line, or of the text, if there is no such place.
    pub(super) fn offset(&self, position: Position) -> u32 {
        let Some(span) = self.lines.line_span(self.text, position.line.saturating_add(1)) else {
            return self.text.len() as u32;
        };
        let line = span.text(self.text).trim_end_matches(['\r', '\n']);
        span.start + self.encoding.bytes(line, position.character) as u32
    }

    /// Where a byte is.
    pub(super) fn position(&self, offset: u32) -> Position {
        let line = self.lines.line(offset).max(1);
        let start = self.lines.line_span(self.text, line).unwrap_or_default().start;
        let before = Span::new(start, offset.min(self.text.len() as u32)).text(self.text);
        Position { line: line - 1, character: self.encoding.length(before) }
    }

    pub(super) fn range(&self, span: Span) -> Range {
        Range { start: self.position(span.start), end: self.position(span.end) }
    }

    /// The bytes of a range.
    pub(super) fn span(&self, range: Range) -> Span {
        let (start, end) = (self.offset(range.start), self.offset(range.end));
        Span::new(start.min(end), end.max(start))
    }

    /// The line that holds a byte, without its line end, and where it begins.
    pub(super) fn line_at(&self, offset: u32) -> (u32, &'a str) {
        let span = self.lines.line_span(self.text, self.lines.line(offset)).unwrap_or_default();
        (span.start, span.text(self.text).trim_end_matches(['\r', '\n']))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_and_bytes_are_each_others_inverse() {
        let source = "ab\r\n\u{1f916}x\u{e4}\n\nend";
        let lines = LineIndex::new(source);
        for encoding in [Encoding::Utf8, Encoding::Utf16] {
            let text = Text { text: source, lines: &lines, encoding };
            for (at, _) in source.char_indices().filter(|(at, _)| *at != 3) {
                assert_eq!(text.offset(text.position(at as u32)), at as u32, "{at} {encoding:?}");
            }
        }
        let text = Text { text: source, lines: &lines, encoding: Encoding::Utf16 };
        assert_eq!(text.position(9), Position { line: 1, character: 3 });
    }

    #[test]
    fn places_beyond_a_line_or_the_text_are_its_end() {
        let source = "ab\ncd";
        let text = Text { text: source, lines: &LineIndex::new(source), encoding: Encoding::Utf16 };
        assert_eq!(text.offset(Position { line: 0, character: 99 }), 2);
        assert_eq!(text.offset(Position { line: u32::MAX, character: 0 }), 5);
    }
}
