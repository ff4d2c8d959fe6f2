//! A text as logical lines: lexemes with their roles, and what is between them.

use super::trivia::{self, Trivia};
use arl_lang::lexer::{Lexeme, lexemes};
use arl_lang::outline;
use arl_lang::outline::{LexemeRole, Outline, PlacedRole, PlacedTurn};

/// A lexeme of a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlacedLexeme<'a> {
    /// The text as written.
    pub(super) text: &'a str,
    /// Its kind according to the lexer.
    pub(super) lexeme: Lexeme,
    /// Its role according to the grammar.
    pub(super) role: LexemeRole,
    /// Whether a statement begins with it.
    pub(super) begins: bool,
}

impl PlacedLexeme<'_> {
    /// Whether it is this word, in any case.
    pub(super) fn is_word(&self, word: &str) -> bool {
        self.lexeme == Lexeme::Word && self.text.eq_ignore_ascii_case(word)
    }
}

/// A part of a line.
#[derive(Clone, Copy, Debug)]
pub(super) enum Item<'a> {
    /// A lexeme.
    Piece(PlacedLexeme<'a>),
    /// `/* */`
    Comment(&'a str),
    /// `//`, without trailing blanks.
    LineComment(&'a str),
    /// `\` and the line end that it cancels.
    Continuation,
}

/// A logical line: up to a line end that is not cancelled.
#[derive(Debug)]
pub(super) struct LogicalLine<'a> {
    /// The whole line, without its line end.
    pub(super) raw: &'a str,
    /// The offset of its end.
    end: usize,
    /// The parts of the line.
    pub(super) items: Vec<Item<'a>>,
    /// Its effects on the blocks, in order.
    pub(super) turns: Vec<PlacedTurn>,
    /// Whether it contains an error, so that it stays as it is.
    pub(super) frozen: bool,
}

impl<'a> LogicalLine<'a> {
    /// Whether it is empty.
    pub(super) fn is_blank(&self) -> bool {
        self.items.is_empty() && !self.frozen
    }

    /// Whether it contains only comments.
    pub(super) fn is_comment(&self) -> bool {
        !self.frozen && self.pieces().next().is_none()
    }

    /// Whether it declares variables or constants, judging by its first words.
    pub(super) fn declares(&self) -> bool {
        self.pieces().next().is_some_and(|first| first.is_word("const") || first.role == LexemeRole::Type)
    }

    /// Its lexemes.
    pub(super) fn pieces(&self) -> impl Iterator<Item = &PlacedLexeme<'a>> {
        self.items.iter().filter_map(|item| match item {
            Item::Piece(piece) => Some(piece),
            _ => None,
        })
    }
}

/// The logical lines of a text whose line ends are all `\n`.
pub(super) fn read(text: &str) -> Vec<LogicalLine<'_>> {
    let Outline { roles, turns, mut mistakes } = outline(text);
    mistakes.sort_unstable();
    let mut reader =
        Reader { text, roles: roles.into_iter().peekable(), lines: Vec::new(), items: Vec::new(), start: 0 };
    let mut broken = Vec::new();
    let mut end = 0;
    for (lexeme, span) in lexemes(text) {
        let span = span.start as usize..span.end as usize;
        reader.between(end, span.start);
        end = span.end;
        match lexeme {
            Ok(Lexeme::Newline) => reader.end_line(span.start, span.end),
            Ok(lexeme) => reader.piece(span.start, span.end, lexeme),
            Err(_) => broken.push(span.start),
        }
    }
    reader.between(end, text.len());
    reader.end_line(text.len(), text.len());
    let mut lines = reader.lines;
    give_turns(&mut lines, &turns);
    let mistakes = mistakes.into_iter().map(|at| at as usize);
    freeze(&mut lines, mistakes.collect());
    freeze(&mut lines, broken);
    // Whether such a `}` closes anything depends on the lines around it.
    for line in &mut lines {
        let closes = line.pieces().next().is_some_and(|piece| piece.lexeme == Lexeme::BraceClose);
        line.frozen |= closes;
    }
    lines
}

/// Collects lines.
struct Reader<'a> {
    text: &'a str,
    roles: std::iter::Peekable<std::vec::IntoIter<PlacedRole>>,
    lines: Vec<LogicalLine<'a>>,
    /// The items of the current line, and the position where it begins.
    items: Vec<Item<'a>>,
    start: usize,
}

impl<'a> Reader<'a> {
    /// Takes the text between two lexemes.
    fn between(&mut self, from: usize, to: usize) {
        let text = self.text.get(from..to).unwrap_or_default();
        self.items.extend(trivia::split(text).map(|trivia| match trivia {
            Trivia::Block(text) => Item::Comment(text),
            Trivia::Line(text) => Item::LineComment(text),
            Trivia::Continuation => Item::Continuation,
        }));
    }

    fn piece(&mut self, from: usize, to: usize, lexeme: Lexeme) {
        while self.roles.next_if(|role| (role.start as usize) < from).is_some() {}
        let known = self.roles.next_if(|role| role.start as usize == from);
        let (role, begins) = known.map_or((LexemeRole::Other, false), |known| (known.role, known.begins));
        let text = self.text.get(from..to).unwrap_or_default();
        self.items.push(Item::Piece(PlacedLexeme { text, lexeme, role, begins }));
    }

    /// Ends the line at `end`; the next one begins at `next`.
    fn end_line(&mut self, end: usize, next: usize) {
        let raw = self.text.get(self.start..end).unwrap_or_default();
        let items = std::mem::take(&mut self.items);
        self.lines.push(LogicalLine { raw, end, items, turns: Vec::new(), frozen: false });
        self.start = next;
    }
}

fn give_turns(lines: &mut [LogicalLine<'_>], turns: &[PlacedTurn]) {
    let mut remaining = turns.iter().peekable();
    for line in lines {
        while let Some(turn) = remaining.next_if(|turn| (turn.start as usize) <= line.end) {
            line.turns.push(*turn);
        }
    }
}

/// Freezes the lines with errors at these offsets, which are sorted.
fn freeze(lines: &mut [LogicalLine<'_>], mistakes: Vec<usize>) {
    let mut remaining = mistakes.into_iter().peekable();
    for line in lines {
        while remaining.next_if(|at| *at <= line.end).is_some() {
            line.frozen = true;
        }
    }
}
