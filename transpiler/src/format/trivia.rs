//! The text between two lexemes: blanks, comments, line ends after a `\`.

/// The characters that count as blanks.
pub(super) const BLANKS: [char; 4] = [' ', '\t', '\u{b}', '\u{c}'];

/// Text between lexemes that is not a blank.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Trivia<'a> {
    /// `/* */`
    Block(&'a str),
    /// `//`, without trailing blanks.
    Line(&'a str),
    /// `\` and the line end after it.
    Continuation,
}

/// Splits the text between two lexemes.
pub(super) fn split(text: &str) -> impl Iterator<Item = Trivia<'_>> {
    let mut rest = text;
    std::iter::from_fn(move || {
        rest = rest.trim_start_matches(BLANKS);
        if rest.starts_with("//") {
            let (comment, behind) = rest.split_at(rest.find('\n').unwrap_or(rest.len()));
            rest = behind;
            return Some(Trivia::Line(comment.trim_end_matches(BLANKS)));
        }
        if rest.starts_with("/*") {
            // The lexer has found its end.
            let end = rest.get(2..).and_then(|inside| inside.find("*/")).map_or(rest.len(), |at| at + 4);
            let (comment, behind) = rest.split_at(end);
            rest = behind;
            return Some(Trivia::Block(comment));
        }
        rest = rest.strip_prefix('\\')?.trim_start_matches(BLANKS);
        rest = rest.strip_prefix('\n').unwrap_or(rest);
        Some(Trivia::Continuation)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_that_is_no_blank() {
        let found: Vec<_> = split(" \t/* a\n b */ \\ \n// c \\ ").collect();
        assert_eq!(found, [Trivia::Block("/* a\n b */"), Trivia::Continuation, Trivia::Line("// c \\")]);
        assert_eq!(split("/*/ */\\").collect::<Vec<_>>(), [Trivia::Block("/*/ */"), Trivia::Continuation]);
        assert_eq!(split("   ").count(), 0);
    }
}
