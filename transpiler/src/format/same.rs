//! Whether two texts say the same: the last thing that is looked at before a text is given away.

use super::lines::{Item, LogicalLine};
use arl_lang::lexer::Lexeme;
use arl_lang::outline::{LexemeRole, Turn};
use std::borrow::Cow;

/// What must stay of a line.
#[derive(PartialEq, Eq, Debug)]
enum Kept<'a> {
    /// A word, folded.
    Word(LexemeRole, String),
    /// Another lexeme.
    Lexeme(LexemeRole, Cow<'a, str>),
    Comment(&'a str),
    Continuation,
    /// All of a line that stays as it is.
    Raw(&'a str),
    /// What the line means for the blocks.
    Turn(Turn),
    End,
}

/// Whether the lexemes, comments and lines of both texts are the same but for blanks, blank lines and the case of
/// words.
pub(super) fn same(before: &[LogicalLine<'_>], after: &[LogicalLine<'_>]) -> bool {
    kept(before) == kept(after)
}

fn kept<'a>(lines: &[LogicalLine<'a>]) -> Vec<Kept<'a>> {
    let mut kept = Vec::new();
    let last = lines.iter().rposition(|line| !line.is_blank());
    for (at, line) in lines.iter().enumerate().filter(|(_, line)| !line.is_blank()) {
        // Line ends at the end of the text are not part of a line.
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
            // With or without a blank in front of its unit, a number is the same one.
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
