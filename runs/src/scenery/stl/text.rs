//! STL files as text: words, with the line of each.

use super::Corners;

/// What some programs write first.
const MARK: &[u8] = b"\xef\xbb\xbf";
const SOLID: &[u8] = b"solid";
/// Where the binary form has the number of triangles; no text has a byte 0 there.
const COUNT_OF_BYTES: std::ops::Range<usize> = 80..84;
/// How much of a word is shown.
const SHOWN_CHARS: usize = 40;

/// Whether it is text: the binary form, too, may begin with the word.
pub(super) fn is_text(bytes: &[u8]) -> bool {
    begins(bytes) && !bytes.get(COUNT_OF_BYTES).is_some_and(|count| count.contains(&0))
}

/// Whether it begins as a text does.
pub(super) fn begins(bytes: &[u8]) -> bool {
    let begins = bytes.strip_prefix(MARK).unwrap_or(bytes).trim_ascii_start();
    begins.get(..SOLID.len()).is_some_and(|word| word.eq_ignore_ascii_case(SOLID))
}

/// Passes on the triangles of all its solids.
pub(super) fn each(bytes: &[u8], mut take: impl FnMut(Corners) -> Result<(), String>) -> Result<(), String> {
    let mut words = Words::of(bytes.strip_prefix(MARK).unwrap_or(bytes));
    let mut is_in_solid = false;
    while let Some(word) = words.next() {
        if word.is("solid") {
            // The rest of the line is its name. If the solid before has no end, this one begins all the same.
            words.skip_line();
            is_in_solid = true;
        } else if is_in_solid && word.is("facet") {
            take(facet(&mut words)?)?;
        } else if is_in_solid && words.is_end(word, "solid") {
            words.skip_line();
            is_in_solid = false;
        } else {
            let wanted = if is_in_solid { "`facet` or `endsolid`" } else { "`solid`" };
            return Err(word.instead_of(wanted));
        }
    }
    Ok(())
}

/// The corners of a triangle, after its `facet`.
fn facet(words: &mut Words<'_>) -> Result<Corners, String> {
    let mut word = words.need("`outer loop`")?;
    if word.is("normal") {
        for _ in 0..3 {
            word = words.need("`outer loop`")?;
            if word.is("outer") {
                break;
            }
        }
        if !word.is("outer") {
            word = words.need("`outer loop`")?;
        }
    }
    if !word.is("outer") {
        return Err(word.instead_of("`outer loop`"));
    }
    words.take("loop")?;
    let mut corners = [[0.0; 3]; 3];
    for corner in &mut corners {
        words.take("vertex")?;
        for value in corner {
            *value = words.need("a number")?.number()?;
        }
    }
    words.take_end("loop")?;
    words.take_end("facet")?;
    Ok(corners)
}

/// A word and its line.
#[derive(Clone, Copy)]
struct Word<'a> {
    text: &'a [u8],
    line: usize,
}

impl Word<'_> {
    fn is(self, word: &str) -> bool {
        self.text.eq_ignore_ascii_case(word.as_bytes())
    }

    fn number(self) -> Result<f32, String> {
        let number = std::str::from_utf8(self.text).ok().and_then(|text| text.parse::<f32>().ok());
        number.filter(|number| number.is_finite()).ok_or_else(|| self.instead_of("a finite number"))
    }

    fn instead_of(self, wanted: &str) -> String {
        let text: String = String::from_utf8_lossy(self.text).chars().take(SHOWN_CHARS).collect();
        let hint = if wanted.contains("endloop") && self.is("vertex") { "; STL has triangles only" } else { "" };
        format!("line {}: expected {wanted}, found `{}`{hint}", self.line, text.escape_debug())
    }
}

/// The words of a text. A line ends with CR, LF, or both.
struct Words<'a> {
    rest: &'a [u8],
    line: usize,
}

impl<'a> Words<'a> {
    fn of(text: &'a [u8]) -> Self {
        Self { rest: text, line: 1 }
    }

    /// Skips a line's end, if one is next.
    fn line_end(&mut self) -> bool {
        let size = match self.rest {
            [b'\r', b'\n', ..] => 2,
            [b'\r' | b'\n', ..] => 1,
            _ => return false,
        };
        self.rest = self.rest.get(size..).unwrap_or_default();
        self.line += 1;
        true
    }

    fn next(&mut self) -> Option<Word<'a>> {
        loop {
            if self.line_end() {
                continue;
            }
            match self.rest {
                [] => return None,
                [blank, rest @ ..] if blank.is_ascii_whitespace() || matches!(blank, 0 | 0x0b) => self.rest = rest,
                _ => break,
            }
        }
        let end = self.rest.iter().position(|byte| byte.is_ascii_whitespace() || matches!(byte, 0 | 0x0b));
        let (text, rest) = self.rest.split_at_checked(end.unwrap_or(self.rest.len()))?;
        self.rest = rest;
        Some(Word { text, line: self.line })
    }

    /// Skips to the end of the line.
    fn skip_line(&mut self) {
        let end = self.rest.iter().position(|byte| matches!(byte, b'\r' | b'\n')).unwrap_or(self.rest.len());
        self.rest = self.rest.get(end..).unwrap_or_default();
    }

    fn need(&mut self, wanted: &str) -> Result<Word<'a>, String> {
        let line = self.line;
        self.next().ok_or_else(|| format!("line {line}: the file ends where {wanted} is expected"))
    }

    fn take(&mut self, wanted: &str) -> Result<(), String> {
        let quoted = format!("`{wanted}`");
        let word = self.need(&quoted)?;
        if word.is(wanted) { Ok(()) } else { Err(word.instead_of(&quoted)) }
    }

    /// Whether this word ends something: `endloop`, or `end loop`, of which it then takes the second word.
    fn is_end(&mut self, word: Word<'_>, of: &str) -> bool {
        let Some((end, rest)) = word.text.split_at_checked(3) else { return false };
        if !end.eq_ignore_ascii_case(b"end") {
            return false;
        }
        if !rest.is_empty() {
            return rest.eq_ignore_ascii_case(of.as_bytes());
        }
        let (before, line) = (self.rest, self.line);
        let is_end = self.next().is_some_and(|next| next.is(of));
        if !is_end {
            (self.rest, self.line) = (before, line);
        }
        is_end
    }

    fn take_end(&mut self, of: &str) -> Result<(), String> {
        let quoted = format!("`end{of}`");
        let word = self.need(&quoted)?;
        if self.is_end(word, of) { Ok(()) } else { Err(word.instead_of(&quoted)) }
    }
}
