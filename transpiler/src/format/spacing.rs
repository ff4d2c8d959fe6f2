//! Blanks between the lexemes of a line.

use super::lines::{Item, PlacedLexeme};
use arl_lang::lexer::Lexeme;
use arl_lang::outline::LexemeRole;

/// The number of blanks for one block level.
pub const LEVEL: usize = 4;

/// Words that are followed directly by their parentheses, like the name in a call.
const GUARDS: [&str; 6] = ["if", "elseif", "while", "for", "switch", "until"];

/// The class of a piece, which determines the blanks around it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Class {
    Open,
    Close,
    /// `,` and `;`
    Separator,
    /// `.` and `::`
    Dot,
    Colon,
    /// An operator before its only operand.
    Prefix,
    /// `++` and `--` after their operand.
    Postfix,
    /// An operator between two operands, or an assignment.
    Binary,
    Unit,
    /// A word, a number, a string.
    Word,
}

/// The previous piece and its class.
#[derive(Clone, Copy)]
struct Before<'a> {
    piece: PlacedLexeme<'a>,
    class: Class,
}

impl Before<'_> {
    /// Whether a value may end with it.
    fn ends_value(&self) -> bool {
        match self.class {
            Class::Close | Class::Postfix | Class::Unit => true,
            Class::Word => matches!(self.piece.role, LexemeRole::Name | LexemeRole::Constant | LexemeRole::Other),
            _ => false,
        }
    }
}

/// A line as text: the first line without its indentation, then the lines after a `\`, indented by `continued` blanks.
#[derive(Default)]
pub(super) struct Text {
    /// The line without a comment at its end.
    pub(super) body: String,
    /// A `//` comment after other text.
    pub(super) trailing: Option<String>,
}

/// Writes the items of a line.
pub(super) fn write(items: &[Item<'_>], continued: usize) -> Text {
    let mut writer = Writer { text: Text::default(), before: None, last: Last::Start };
    for item in items {
        match item {
            Item::Piece(piece) => writer.piece(*piece),
            Item::Comment(comment) => writer.comment(comment),
            Item::LineComment(comment) if writer.last == Last::Start => writer.text.body.push_str(comment),
            Item::LineComment(comment) => writer.text.trailing = Some((*comment).to_string()),
            Item::Continuation => writer.continuation(continued),
        }
    }
    let body = &mut writer.text.body;
    body.truncate(body.trim_end_matches(' ').len());
    writer.text
}

/// The kind of item written last.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Last {
    /// Nothing on this line of the text.
    Start,
    Piece,
    Comment,
}

struct Writer<'a> {
    text: Text,
    before: Option<Before<'a>>,
    last: Last,
}

impl<'a> Writer<'a> {
    fn piece(&mut self, piece: PlacedLexeme<'a>) {
        let before = self.before.filter(|_| !piece.begins);
        let class = class(&piece, before.is_some_and(|before| before.ends_value()));
        let blank = match self.last {
            Last::Start => false,
            Last::Comment => !matches!(class, Class::Close | Class::Separator),
            Last::Piece => before.is_none_or(|before| blank_between(before, &piece, class)),
        };
        self.push(blank, piece.text, Last::Piece);
        self.before = Some(Before { piece, class });
    }

    fn comment(&mut self, comment: &str) {
        let opened = self.last == Last::Piece && self.before.is_some_and(|before| before.class == Class::Open);
        self.push(self.last != Last::Start && !opened, comment, Last::Comment);
    }

    fn continuation(&mut self, continued: usize) {
        let body = &mut self.text.body;
        if self.last != Last::Start {
            body.push(' ');
        }
        body.push_str("\\\n");
        body.extend(std::iter::repeat_n(' ', continued));
        self.last = Last::Start;
    }

    fn push(&mut self, blank: bool, text: &str, last: Last) {
        if blank {
            self.text.body.push(' ');
        }
        self.text.body.push_str(text);
        self.last = last;
    }
}

fn class(piece: &PlacedLexeme<'_>, behind_value: bool) -> Class {
    use Lexeme as L;
    if piece.role == LexemeRole::Unit {
        return Class::Unit;
    }
    match piece.lexeme {
        L::ParenOpen | L::BracketOpen | L::BraceOpen => Class::Open,
        L::ParenClose | L::BracketClose | L::BraceClose => Class::Close,
        L::Comma | L::Semicolon => Class::Separator,
        L::Dot | L::Scope => Class::Dot,
        L::Colon => Class::Colon,
        L::PlusPlus | L::MinusMinus if behind_value => Class::Postfix,
        L::PlusPlus | L::MinusMinus | L::Not | L::Complement => Class::Prefix,
        L::Minus if !behind_value => Class::Prefix,
        L::Newline | L::Word | L::System | L::Number(_) | L::Text | L::Splice | L::Faulty => Class::Word,
        _ => Class::Binary,
    }
}

/// Whether there is a blank between two pieces of a statement.
fn blank_between(before: Before<'_>, piece: &PlacedLexeme<'_>, class: Class) -> bool {
    match (before.class, class) {
        (Class::Open, _) | (_, Class::Close | Class::Separator | Class::Colon | Class::Postfix) => false,
        // Otherwise the point would become a part of the number.
        (_, Class::Dot) => matches!(before.piece.lexeme, Lexeme::Number(_)),
        (Class::Dot, _) => false,
        (Class::Colon, _) => before.piece.role != LexemeRole::LabelColon,
        // `- -a` is not `--a`.
        (Class::Prefix, _) => before.piece.text.ends_with('-') && piece.text.starts_with('-'),
        (_, Class::Unit) => false,
        (Class::Word | Class::Close, Class::Open) => blank_before_bracket(before, piece),
        _ => true,
    }
}

/// Whether there is a blank between a word or a closing bracket and an opening one.
fn blank_before_bracket(before: Before<'_>, piece: &PlacedLexeme<'_>) -> bool {
    let word = before.piece;
    match piece.lexeme {
        Lexeme::ParenOpen if word.role == LexemeRole::Reserved => !GUARDS.iter().any(|guard| word.is_word(guard)),
        Lexeme::ParenOpen => word.role != LexemeRole::Name,
        Lexeme::BracketOpen => !before.ends_value(),
        _ => true,
    }
}
