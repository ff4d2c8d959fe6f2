//! The place where the user types: what kind of text is around it, and what the checker expects there.

use super::places::File;
use super::programs::Program;
use super::server::Server;
use super::text::Text;
use super::uri::path_of;
use arl_lang::lexer::{Lexeme, lexemes, look_alike};
use arl_lang::span::Span;
use arl2rs::check::clean;
use arl2rs::index::{Expectation, HERE};
use arl2rs::{SourceError, Sources};
use gen_lsp_types::TextDocumentPositionParams;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// What may be missing after a name for its line to be readable: nothing but brackets; the colon of a `case`; the rest
/// of a `for`; the action of an event.
const RESTS: [&str; 4] = ["", ":", ";", ", 0"];

/// Where the cursor is.
pub(super) struct Typing<'a> {
    pub(super) path: PathBuf,
    pub(super) text: Text<'a>,
    pub(super) offset: u32,
    /// The part of a name before the cursor, with its `$`.
    pub(super) word: Span,
    pub(super) surroundings: Surroundings,
}

/// What is around the cursor.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Surroundings {
    /// The first name of a statement.
    Statement,
    /// The type of a result, a parameter or a constant.
    Type,
    /// Any other place of the program's text.
    Code,
    /// After a number, at the byte where it begins.
    Number(u32),
    /// In the path of an `import`, at the byte after its quote.
    Import(u32),
    /// In a comment or a text.
    Quiet,
}

impl<'a> Typing<'a> {
    pub(super) fn at(server: &'a Server, at: &TextDocumentPositionParams) -> Option<Self> {
        let path = path_of(&at.text_document.uri);
        let document = server.documents.get(&path)?;
        let text = document.as_text(server.encoding);
        let offset = text.offset(at.position);
        let word = Span::new(word_start(text.text, offset), offset);
        Some(Self { path, text, offset, word, surroundings: surroundings(text.text, word.start) })
    }

    /// What the checker expects at the cursor, and the index of the program with the word [`HERE`] in it.
    pub(super) fn expectation(&self, server: &Server) -> Option<(Expectation, Program)> {
        let root = server.root(&self.path);
        for rest in RESTS {
            let Some(text) = self.marked(rest) else { break };
            let marked = Marked { server, path: &self.path, text };
            let program = Program::check(&root, &marked, &server.options_of(&root)).ok()?;
            if let Some(expectation) = program.index().expectation.clone() {
                return Some((expectation, program));
            }
        }
        None
    }

    /// The file without the name before the cursor: an incomplete unit would make its number unreadable.
    pub(super) fn without_word(&self, server: &Server) -> Option<File> {
        let mut text = self.text.text.to_string();
        text.replace_range(self.word.start as usize..self.word.end as usize, "");
        let (root, marked) = (server.root(&self.path), Marked { server, path: &self.path, text });
        let program = Program::check(&root, &marked, &server.options_of(&root)).ok()?;
        let id = program.file(&self.path)?;
        Some(File { program: Rc::new(program), id })
    }

    /// The text with [`HERE`] at the cursor, in place of the rest of a name there, and with what may be missing to the
    /// end of the line, if nothing but a comment follows there. `None` if something follows and `rest` would have to be
    /// put between.
    fn marked(&self, rest: &str) -> Option<String> {
        let (before, behind) = self.text.text.split_at(self.offset as usize);
        let behind = behind.trim_start_matches(|one: char| one.is_ascii_alphanumeric() || one == '_');
        let rest_of_line = behind.lines().next().unwrap_or_default().trim_start();
        let ends = rest_of_line.is_empty() || rest_of_line.starts_with("//");
        let closers = if ends { closers(before) } else { String::new() };
        (ends || rest.is_empty()).then(|| format!("{before}{HERE}{rest}{closers}{behind}"))
    }
}

/// Where the name begins that ends at a byte.
fn word_start(text: &str, offset: u32) -> u32 {
    let before = text.get(..offset as usize).unwrap_or_default();
    let name = before.trim_end_matches(|one: char| one.is_ascii_alphanumeric() || one == '_');
    let word = before.get(name.len()..).unwrap_or_default();
    if word.starts_with(|first: char| first.is_ascii_digit()) {
        // A number, and perhaps its unit.
        return (name.len() + word.len() - word.trim_start_matches(|one: char| one.is_ascii_digit()).len()) as u32;
    }
    name.strip_suffix('$').unwrap_or(name).len() as u32
}

/// The brackets that close what the last logical line leaves open.
fn closers(before: &str) -> String {
    let mut open = Vec::new();
    for (lexeme, _) in lexemes(before) {
        match lexeme {
            Ok(Lexeme::Newline) => open.clear(),
            Ok(Lexeme::ParenOpen) => open.push(')'),
            Ok(Lexeme::BracketOpen) => open.push(']'),
            Ok(Lexeme::BraceOpen) => open.push('}'),
            Ok(Lexeme::ParenClose | Lexeme::BracketClose | Lexeme::BraceClose) => {
                open.pop();
            }
            _ => {}
        }
    }
    open.into_iter().rev().collect()
}

/// What is around the place where `word` begins, found by reading another word there.
fn surroundings(text: &str, word: u32) -> Surroundings {
    let before = text.get(..word as usize).unwrap_or_default();
    let probed = format!("{before} x");
    let mut line: Vec<(Lexeme, Span)> = Vec::new();
    for (lexeme, span) in lexemes(&probed) {
        match lexeme {
            Ok(Lexeme::Newline) => line.clear(),
            lexeme => line.push((lexeme.unwrap_or(Lexeme::Faulty), span)),
        }
    }
    let is_read = |(_, span): &(Lexeme, Span)| span.start == word + 1;
    if line.pop_if(|last| is_read(last)).is_none() {
        return unread(&probed, &line);
    }
    match line.last() {
        None => Surroundings::Statement,
        Some((Lexeme::Number(_), span)) if span.end == word => Surroundings::Number(span.start),
        Some((last, span)) if wants_type(before, &line, *last, *span) => Surroundings::Type,
        Some((Lexeme::ParenClose, _)) if closes_condition(before, &line) => Surroundings::Statement,
        _ => Surroundings::Code,
    }
}

/// Where a word is not read as a word: in a text, which may be the path of an import, or in a comment.
fn unread(text: &str, line: &[(Lexeme, Span)]) -> Surroundings {
    if let [(_, first), .., (Lexeme::Faulty, last)] = line
        && first.text(text).eq_ignore_ascii_case("import")
        && let Some(quote) = last.text(text).chars().next().filter(|first| look_alike(*first).unwrap_or(*first) == '"')
    {
        return Surroundings::Import(last.start + quote.len_utf8() as u32);
    }
    Surroundings::Quiet
}

/// Whether a type is expected: after `const`, after `func`, and before each of a function's parameters.
fn wants_type(text: &str, line: &[(Lexeme, Span)], last: Lexeme, at: Span) -> bool {
    let is = |span: Span, word: &str| span.text(text).eq_ignore_ascii_case(word);
    let of_func = line.first().is_some_and(|(_, first)| is(*first, "func"));
    is(at, "const") || is(at, "func") || of_func && matches!(last, Lexeme::ParenOpen | Lexeme::Comma)
}

/// Whether the last `)` of a line that begins with `if` closes its condition: a statement may follow.
fn closes_condition(text: &str, line: &[(Lexeme, Span)]) -> bool {
    let begins = line.first().is_some_and(|(_, first)| first.text(text).eq_ignore_ascii_case("if"));
    let depth = |(lexeme, _): &(Lexeme, Span)| match lexeme {
        Lexeme::ParenOpen => 1,
        Lexeme::ParenClose => -1,
        _ => 0,
    };
    let opened_twice = line.iter().scan(0, |open, one| {
        *open += depth(one);
        Some(*open)
    });
    begins && opened_twice.filter(|open| *open == 0).count() == 2
}

/// The sources with one text replaced.
struct Marked<'a> {
    server: &'a Server,
    path: &'a Path,
    text: String,
}

impl Sources for Marked<'_> {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        if clean(path) == self.path { Ok(self.text.clone().into_bytes()) } else { self.server.documents.read(path) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The surroundings of the `|` in a text.
    fn around(text: &str) -> Surroundings {
        let offset = text.find('|').unwrap() as u32;
        let text = text.replacen('|', "", 1);
        surroundings(&text, word_start(&text, offset))
    }

    #[test]
    fn comments_and_texts_are_quiet() {
        for text in ["a // b|", "a /* b| */", "print \"a|\"", "/* a\n|", "print \"a|", "// |", "a\n// b |\nc"] {
            assert_eq!(around(text), Surroundings::Quiet, "{text}");
        }
        for text in ["a /* b */ + |", "print \"a\", |", "// a\nb = |", "x = \"//\" + |"] {
            assert_eq!(around(text), Surroundings::Code, "{text}");
        }
    }

    #[test]
    fn statements_begin_lines_and_follow_conditions() {
        for text in ["mo|", "a\n  |", "if(a) |", "if((a) && b) s|", "a \\\n b\n|"] {
            assert_eq!(around(text), Surroundings::Statement, "{text}");
        }
        for text in ["movej |", "if(|", "if(a|)", "if((a) |", "a \\\n |"] {
            assert_eq!(around(text), Surroundings::Code, "{text}");
        }
    }

    #[test]
    fn numbers_and_imports() {
        assert_eq!(around("lin p, vl:100|"), Surroundings::Number(10));
        assert_eq!(around("lin p, vl:100m|"), Surroundings::Number(10));
        assert_eq!(around("const |"), Surroundings::Type);
        assert_eq!(around("func void f(int a, |"), Surroundings::Type);
        assert_eq!(around("func void f(int |"), Surroundings::Code);
        assert_eq!(around("import \"ra|\""), Surroundings::Import(8));
        assert_eq!(around("import \"ra|"), Surroundings::Import(8));
    }

    #[test]
    fn open_brackets_are_closed() {
        assert_eq!(closers("f(a[1\nmovej j:{1, f(2, g(), "), ")}");
        assert_eq!(closers("f(a)"), "");
    }
}
