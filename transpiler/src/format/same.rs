//! Whether two texts have the same meaning: the final check before a formatted text is returned.

use super::lines::{Item, LogicalLine};
use arl_lang::lexer::Lexeme;
use arl_lang::outline::{LexemeRole, Turn};
use std::borrow::Cow;

/// The parts of a line that must be preserved.
#[derive(PartialEq, Eq, Debug)]
enum Kept<'a> {
    /// A word, folded.
    Word(LexemeRole, String),
    /// Another lexeme.
    Lexeme(LexemeRole, Cow<'a, str>),
    Comment(&'a str),
    Continuation,
    /// The whole of a line that stays as it is.
    Raw(&'a str),
    /// The effect of the line on the blocks.
    Turn(Turn),
    End,
}

/// Whether the lexemes, comments and lines of both texts are the same except for blanks, blank lines and the case of
/// words.
pub(super) fn same(before: &[LogicalLine<'_>], after: &[LogicalLine<'_>]) -> bool {
    kept(before) == kept(after)
}

fn kept<'a>(lines: &[LogicalLine<'a>]) -> Vec<Kept<'a>> {
    let mut kept = Vec::new();
    let last = lines.iter().rposition(|line| !line.is_blank());
    for (at, line) in lines.iter().enumerate().filter(|(_, line)| !line.is_blank()) {
        // Line ends at the end of the text do not belong to a line.
        let raw = if last == Some(at) { line.raw.trim_end_matches('\n') } else { line.raw };
        if line.frozen {
            kept.push(Kept::Raw(raw));
        } else {
            line.items.iter().for_each(|item| add(&mut kept, item));
        }
        kept.extend(line.turns.iter().map(|turn| Kept::Turn(turn.turn)));
        kept.push(Kept::End);
    }
    kept
}

fn add<'a>(kept: &mut Vec<Kept<'a>>, item: &Item<'a>) {
    match item {
        Item::Piece(piece) if piece.role == LexemeRole::Unit => match kept.last_mut() {
            // A number is the same with or without a blank before its unit.
            Some(Kept::Lexeme(_, before)) => before.to_mut().push_str(piece.text),
            _ => kept.push(Kept::Lexeme(piece.role, piece.text.into())),
        },
        Item::Piece(piece) if matches!(piece.lexeme, Lexeme::Word | Lexeme::System) => {
            kept.push(Kept::Word(piece.role, piece.text.to_ascii_lowercase()));
        }
        Item::Piece(piece) => kept.push(Kept::Lexeme(piece.role, piece.text.into())),
        Item::Comment(comment) | Item::LineComment(comment) => kept.push(Kept::Comment(comment)),
        Item::Continuation => kept.push(Kept::Continuation),
    }
}
