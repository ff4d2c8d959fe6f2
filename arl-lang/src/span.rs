//! Places in a source text.

/// A half-open range of bytes in one file.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default, PartialOrd, Ord)]
pub struct Span {
    /// Offset of the first byte.
    pub start: u32,
    /// Offset after the last byte.
    pub end: u32,
}

impl Span {
    /// The range `start..end`.
    pub const fn new(start: u32, end: u32) -> Self {
        Self { start, end }
    }

    /// The smallest span that holds both.
    pub fn to(self, other: Span) -> Span {
        Span { start: self.start.min(other.start), end: self.end.max(other.end) }
    }

    /// The text under the span; empty where the span does not fit the text.
    pub fn text(self, source: &str) -> &str {
        source.get(self.start as usize..self.end as usize).unwrap_or("")
    }
}

impl std::fmt::Debug for Span {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}..{}", self.start, self.end)
    }
}

/// How many bytes of a text share an entry of [`LineIndex`]'s count of characters.
const BLOCK: usize = 1024;

/// Where the lines of a text begin, to turn offsets into lines and columns. Each answer takes the same time, however
/// long the line is.
#[derive(Clone, Debug)]
pub struct LineIndex {
    starts: Vec<u32>,
    /// For each block of the text, how many bytes before it do not begin a character; empty where all of them do.
    continued: Vec<u32>,
}

impl LineIndex {
    /// Finds the line starts of `source`; `\n`, `\r\n` and a lone `\r` end a line.
    pub fn new(source: &str) -> Self {
        let bytes = source.as_bytes();
        let mut starts = vec![0];
        for (at, byte) in bytes.iter().enumerate() {
            let ends = *byte == b'\n' || (*byte == b'\r' && bytes.get(at + 1) != Some(&b'\n'));
            if ends {
                starts.push(at as u32 + 1);
            }
        }
        let mut continued = Vec::new();
        if !source.is_ascii() {
            let mut before = 0;
            for block in bytes.chunks(BLOCK) {
                continued.push(before);
                before += continuations(block);
            }
            continued.push(before);
        }
        Self { starts, continued }
    }

    /// The 1-based line that holds `offset`.
    pub fn line(&self, offset: u32) -> u32 {
        self.starts.partition_point(|start| *start <= offset) as u32
    }

    /// The 1-based line and column (in characters) of `offset`.
    pub fn line_column(&self, source: &str, offset: u32) -> (u32, u32) {
        let line = self.line(offset);
        let start = self.starts.get(line as usize - 1).copied().unwrap_or(0);
        let offset = offset.min(source.len() as u32).max(start);
        (line, self.characters(source, offset) - self.characters(source, start) + 1)
    }

    /// How many characters begin before `offset`.
    fn characters(&self, source: &str, offset: u32) -> u32 {
        let block = offset as usize / BLOCK;
        let Some(before) = self.continued.get(block) else { return offset };
        let rest = source.as_bytes().get(block * BLOCK..offset as usize).unwrap_or_default();
        offset - before - continuations(rest)
    }

    /// The bytes of the 1-based `line`, with its line end; `None` beyond the last.
    pub fn line_span(&self, source: &str, line: u32) -> Option<Span> {
        let start = *self.starts.get(line.checked_sub(1)? as usize)?;
        let end = self.starts.get(line as usize).copied().unwrap_or(source.len() as u32);
        Some(Span::new(start, end))
    }

    /// The number of lines.
    pub fn count(&self) -> u32 {
        self.starts.len() as u32
    }
}

/// How many bytes of UTF-8 do not begin a character.
fn continuations(bytes: &[u8]) -> u32 {
    bytes.iter().filter(|byte| **byte & 0xc0 == 0x80).count() as u32
}

#[cfg(test)]
mod tests {
    use super::LineIndex;

    #[test]
    fn columns_count_characters_in_lines_of_any_length() {
        let source = format!("a\r\n{}\rä{}b", "äx€".repeat(1000), "\u{1f916}".repeat(700));
        let index = LineIndex::new(&source);
        let mut expected = (1, 1);
        for (at, character) in source.char_indices() {
            assert_eq!(index.line_column(&source, at as u32), expected, "at {at}");
            let ends = character == '\n' || (character == '\r' && !source[at..].starts_with("\r\n"));
            expected = if ends { (expected.0 + 1, 1) } else { (expected.0, expected.1 + 1) };
        }
        assert_eq!(index.line_column(&source, source.len() as u32), expected);
        assert_eq!(index.line_column(&source, source.len() as u32 + 9), expected);
    }
}
