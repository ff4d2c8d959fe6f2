//! The ARL text of an invocation, with a mapping from its bytes back to tokens.
//!
//! The text is taken from the Rust file, with comments and line ends. If the compiler does not provide it (behind
//! `macro_rules`), it is put together from the positions of the tokens. If not even those are known (rust-analyzer),
//! there is no text.

use crate::leaf::Leaf;

/// ARL text, laid out so that its lines have the same numbers as in the Rust file.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Text {
    /// The text, preceded by one line end for each line above it.
    pub(crate) text: String,
    /// For each leaf, the range of bytes that it covers.
    ranges: Vec<(usize, usize)>,
}

impl Text {
    /// The text of `leaves`. `source` is the text of the whole invocation and its start.
    pub(crate) fn of<S>(leaves: &[Leaf<S>], source: Option<(&str, (usize, usize))>) -> Option<Self> {
        if !placed(leaves) {
            return None;
        }
        let cut = source.and_then(|(source, start)| Self::from_source(leaves, source, start));
        let mut text = cut.unwrap_or_else(|| Self::laid_out(leaves));
        text.rewrite_hexadecimal();
        Some(text)
    }

    /// In Rust, `3eh` must be written `0x3e`, because Rust cannot read `3eh`. It becomes `03eh`, which has the same
    /// length.
    fn rewrite_hexadecimal(&mut self) {
        for (from, to) in &self.ranges {
            let digits = self.text.get(*from..*to).and_then(|token| token.strip_prefix("0x"));
            let digits = digits.filter(|digits| digits.bytes().all(|digit| digit.is_ascii_hexdigit()));
            if let Some(digits) = digits.filter(|digits| !digits.is_empty()) {
                let number = format!("0{digits}h");
                self.text.replace_range(*from..*to, &number);
            }
        }
    }

    /// Cuts the text out of the invocation; `None` if the tokens are not found there.
    fn from_source<S>(leaves: &[Leaf<S>], source: &str, start: (usize, usize)) -> Option<Self> {
        let places = Places::new(source, start);
        let mut ranges = Vec::with_capacity(leaves.len());
        for leaf in leaves {
            let range = (places.offset(leaf.start)?, places.offset(leaf.end)?);
            // A Rust documentation comment is split into tokens that all cover the whole comment.
            let found = source.get(range.0..range.1)?;
            if found != leaf.text && !found.starts_with("//") && !found.starts_with("/*") {
                return None;
            }
            ranges.push(range);
        }
        let (first, last) = (ranges.first()?.0, ranges.last()?.1);
        let lead = lead(leaves.first()?.start);
        let text = lead.clone() + source.get(first..last)?;
        let ranges =
            ranges.into_iter().map(|(from, to)| (from - first + lead.len(), to - first + lead.len())).collect();
        Some(Self { text, ranges })
    }

    /// Puts the text together from the tokens alone.
    fn laid_out<S>(leaves: &[Leaf<S>]) -> Self {
        let mut text = String::new();
        let mut ranges = Vec::with_capacity(leaves.len());
        let mut at = (1, 1);
        for leaf in leaves {
            while at.0 < leaf.start.0 {
                text.push('\n');
                at = (at.0 + 1, 1);
            }
            text.extend(std::iter::repeat_n(' ', leaf.start.1.saturating_sub(at.1)));
            let from = text.len();
            text += &leaf.text;
            ranges.push((from, text.len()));
            at = leaf.end;
        }
        Self { text, ranges }
    }

    /// The first and the last leaf that a range of bytes touches. A range between tokens belongs to the preceding
    /// token.
    pub(crate) fn leaves(&self, start: usize, end: usize) -> Option<(usize, usize)> {
        let touched = |(from, to): &(usize, usize)| *from < end.max(start + 1) && start < *to;
        let first = self.ranges.iter().position(touched);
        let last = self.ranges.iter().rposition(touched);
        match (first, last) {
            (Some(first), Some(last)) => Some((first, last)),
            _ => {
                let before = self.ranges.iter().rposition(|(_, to)| *to <= start).unwrap_or(0);
                (!self.ranges.is_empty()).then_some((before, before))
            }
        }
    }

    /// The leaves that lie within a range of bytes.
    pub(crate) fn within(&self, start: usize, end: usize) -> std::ops::Range<usize> {
        let first = self.ranges.iter().position(|(from, to)| *from >= start && *to <= end);
        let last = self.ranges.iter().rposition(|(from, to)| *from >= start && *to <= end);
        match (first, last) {
            (Some(first), Some(last)) => first..last + 1,
            _ => 0..0,
        }
    }

    /// Replaces leaves that are not ARL by blanks.
    pub(crate) fn blank(&mut self, leaves: std::ops::Range<usize>) {
        let ranges = self.ranges.get(leaves).unwrap_or(&[]);
        if let (Some((from, _)), Some((_, to))) = (ranges.first(), ranges.last()) {
            let blanks = " ".repeat(to - from);
            self.text.replace_range(*from..*to, &blanks);
        }
    }
}

/// The line ends and blanks before a position.
fn lead(start: (usize, usize)) -> String {
    "\n".repeat(start.0.saturating_sub(1)) + &" ".repeat(start.1.saturating_sub(1))
}

/// Whether the positions of the tokens are known: in rust-analyzer all tokens have the same one.
fn placed<S>(leaves: &[Leaf<S>]) -> bool {
    let known = leaves.iter().all(|leaf| leaf.start.0 > 0 && leaf.start <= leaf.end);
    // Tokens of one documentation comment share their position.
    let ascending = leaves.windows(2).all(|pair| match pair {
        [one, next] => one.start <= next.start,
        _ => true,
    });
    let spread = match (leaves.first(), leaves.last()) {
        (Some(first), Some(last)) => leaves.len() == 1 || first.start != last.start,
        _ => false,
    };
    known && ascending && spread && leaves.iter().all(|leaf| leaf.start != leaf.end)
}

/// Offsets of the lines of a text that begins anywhere in a file.
struct Places<'a> {
    text: &'a str,
    start: (usize, usize),
    lines: Vec<usize>,
}

impl<'a> Places<'a> {
    fn new(text: &'a str, start: (usize, usize)) -> Self {
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Self { text, start, lines }
    }

    /// The offset of a position in the file; `None` outside the text.
    fn offset(&self, (line, column): (usize, usize)) -> Option<usize> {
        let index = line.checked_sub(self.start.0)?;
        let begin = *self.lines.get(index)?;
        let first = if index == 0 { self.start.1 } else { 1 };
        let skip = column.checked_sub(first)?;
        let rest = self.text.get(begin..)?;
        let mut chars = rest.char_indices().map(|(at, _)| at).chain(std::iter::once(rest.len()));
        Some(begin + chars.nth(skip)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tokens of a text that begins at a position, separated by blanks; `§` is a position without a token.
    fn tokens(text: &str, start: (usize, usize)) -> Vec<Leaf<()>> {
        let mut all = Vec::new();
        let (mut line, mut column) = start;
        for c in text.chars() {
            if c == '\n' {
                (line, column) = (line + 1, 1);
                continue;
            }
            if c != ' ' {
                let fresh = all.last().is_none_or(|leaf: &Leaf<()>| leaf.end != (line, column));
                if fresh {
                    all.push(Leaf { text: String::new(), start: (line, column), end: (line, column), span: () });
                }
                if let Some(leaf) = all.last_mut() {
                    leaf.text.push(c);
                    leaf.end = (line, column + 1);
                }
            }
            column += 1;
        }
        all
    }

    #[test]
    fn text_keeps_its_lines_and_comments() {
        let source = "arl! {\n    grün = 1 // why\n  b }";
        let mut leaves = tokens(source, (10, 5));
        leaves.retain(|leaf| ["grün", "=", "1", "b"].contains(&leaf.text.as_str()));
        let text = Text::of(&leaves, Some((source, (10, 5)))).expect("a text");
        assert_eq!(text.text.trim_start(), "grün = 1 // why\n  b");
        assert_eq!(text.text.lines().count(), 12);
        let b = text.text.find("b").expect("b");
        assert_eq!(text.leaves(b, b + 1), Some((3, 3)));
        let equals = text.text.find('=').expect("=");
        assert_eq!(text.leaves(equals, equals + 3), Some((1, 2)));
        assert_eq!(text.leaves(equals - 1, equals - 1), Some((0, 0)));
    }

    #[test]
    fn text_is_laid_out_from_tokens_where_the_source_is_not_theirs() {
        let leaves = tokens("ab c\n\n d", (3, 2));
        let text = Text::of(&leaves, Some(("arl! { $($t)* }", (90, 1)))).expect("a text");
        assert_eq!(text.text, "\n\n ab c\n\n d");
        assert_eq!(Text::of(&leaves, None), Some(text));
    }

    #[test]
    fn no_text_where_no_token_knows_its_place() {
        let mut leaves = tokens("a b", (1, 1));
        for leaf in &mut leaves {
            leaf.start = (1, 1);
            leaf.end = (1, 1);
        }
        assert_eq!(Text::of(&leaves, None), None);
        assert_eq!(Text::of::<()>(&[], None), None);
    }

    #[test]
    fn hexadecimal_numbers_may_be_those_of_rust() {
        let text = Text::of(&tokens("0x3e + 0xFF - 0x", (1, 1)), None).expect("a text");
        assert_eq!(text.text, "03eh + 0FFh - 0x");
    }

    #[test]
    fn blanked_leaves_keep_the_places_of_the_others() {
        let mut text = Text::of(&tokens("# x\ny", (1, 1)), None).expect("a text");
        text.blank(0..2);
        assert_eq!(text.text, "   \ny");
        assert_eq!(text.within(4, 5), 2..3);
    }
}
