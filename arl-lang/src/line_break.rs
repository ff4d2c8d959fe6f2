//! Statements that continue on the next line without the `\` that joins lines: whether a statement is incomplete at the
//! end of its line, and whether the next line is the rest of it.

use crate::adapt::PlacedLexeme;
use crate::explain::is_infix;
use crate::habits::is_header;
use crate::lexer::Lexeme;
use crate::span::Span;
use crate::syntax_error::{Bracket, LineBreak, SyntaxError, SyntaxErrorKind};
use crate::token::{Placed, Token};
use crate::words::control_token;

/// Words of the language with which a value can begin.
const VALUES: [&str; 3] = ["endl", "false", "true"];

/// A statement as far as it was read.
#[derive(Default)]
pub(crate) struct Statement {
    open: Vec<Bracket>,
    last: Option<Lexeme>,
    /// More brackets were closed than opened.
    is_odd: bool,
}

impl Statement {
    /// The statement that begins with the lexemes of a line.
    pub(crate) fn of(lexemes: &[PlacedLexeme], source: &str) -> Self {
        let mut statement = Self::default();
        if lexemes.len() > 1 && !opens_block(lexemes, source) {
            statement.go_on(lexemes);
        }
        statement
    }

    /// Takes the lexemes of one more line.
    pub(crate) fn go_on(&mut self, lexemes: &[PlacedLexeme]) {
        for (_, lexeme, _) in lexemes {
            let closed = match lexeme {
                Lexeme::ParenOpen => {
                    self.open.push(Bracket::Paren);
                    continue;
                }
                Lexeme::BracketOpen => {
                    self.open.push(Bracket::Square);
                    continue;
                }
                Lexeme::BraceOpen => {
                    self.open.push(Bracket::Brace);
                    continue;
                }
                Lexeme::ParenClose => Bracket::Paren,
                Lexeme::BracketClose => Bracket::Square,
                Lexeme::BraceClose => Bracket::Brace,
                _ => continue,
            };
            self.is_odd |= self.open.pop() != Some(closed);
        }
        self.last = lexemes.last().map(|last| last.1);
    }

    /// Whether the statement cannot end here: a bracket is open, or an operator or comma needs a value after it.
    pub(crate) fn is_unfinished(&self) -> bool {
        !self.is_odd && (!self.open.is_empty() || self.last.is_some_and(waits))
    }

    /// Whether a line can be the rest of this statement. A line that is a statement itself cannot.
    pub(crate) fn can_go_on_with(&self, line: &[PlacedLexeme], source: &str) -> bool {
        let Some(first) = line.first() else { return false };
        let assigns = line.iter().any(|(_, lexeme, _)| writes(*lexeme));
        let labelled = matches!(line.get(1), Some((_, Lexeme::Colon, _)));
        if self.is_odd || assigns || (begins_statement(*first, source) && !labelled) {
            return false;
        }
        let second = line.get(1).map(|second| second.1);
        match self.open.last() {
            Some(Bracket::Brace) => true,
            Some(_) => first.1 != Lexeme::Word || second != Some(Lexeme::Word),
            None => {
                let calls = first.1 == Lexeme::Word && matches!(second, Some(Lexeme::ParenOpen | Lexeme::Scope));
                let declares = first.1 == Lexeme::Word && second == Some(Lexeme::Word);
                let takes_calls = !matches!(self.last, Some(Lexeme::Comma | Lexeme::Assign));
                !declares && (!calls || takes_calls)
            }
        }
    }
}

/// Whether something must follow this lexeme.
fn waits(lexeme: Lexeme) -> bool {
    use Lexeme as L;
    matches!(
        lexeme,
        L::Comma | L::Assign | L::And | L::Or | L::Plus | L::Minus | L::Star | L::Slash | L::Equal | L::NotEqual
    ) || matches!(lexeme, L::Less | L::LessEqual | L::Greater | L::GreaterEqual | L::BitAnd | L::BitOr)
}

/// Whether this lexeme writes a variable: the line is then a statement of its own.
fn writes(lexeme: Lexeme) -> bool {
    use Lexeme as L;
    matches!(lexeme, L::Assign | L::AddAssign | L::SubtractAssign | L::MultiplyAssign | L::DivideAssign)
        || matches!(lexeme, L::PlusPlus | L::MinusMinus)
}

fn word(lexeme: PlacedLexeme, source: &str) -> Option<&str> {
    (lexeme.1 == Lexeme::Word).then(|| Span::new(lexeme.0, lexeme.2).text(source))
}

/// Whether the `{` at the end of a line opens a block, as in other languages: after a condition, the head of a block,
/// or a word that stands alone (`try {`) and is not an instruction, whose braces would hold a value.
fn opens_block(lexemes: &[PlacedLexeme], source: &str) -> bool {
    let opens = |token| is_header(token) || matches!(token, Token::Case | Token::Default);
    match lexemes {
        [.., (_, Lexeme::ParenClose, _), (_, Lexeme::BraceOpen, _)] => true,
        [first, between @ .., (_, Lexeme::BraceOpen, _)] => word(*first, source).is_some_and(|word| {
            let stands_alone = || between.is_empty() && crate::catalog::instructions(word).is_empty();
            control_token(word).is_some_and(opens) || stands_alone()
        }),
        _ => false,
    }
}

/// Whether a statement or the line of a block begins with the word.
fn begins_statement(lexeme: PlacedLexeme, source: &str) -> bool {
    word(lexeme, source).is_some_and(|word| {
        let is_control = || crate::control_word(word).is_some_and(|word| !VALUES.contains(&word));
        is_control() || !crate::catalog::instructions(word).is_empty()
    })
}

/// The error for a statement that continues past the end of its line: where its first line ends, where it continues.
pub(crate) fn error(end: Span, rest: Span) -> SyntaxError {
    SyntaxError::new(SyntaxErrorKind::LineBreak(LineBreak::Behind), end).with(rest, "it continues here")
}

/// The error for a refused line that continues the statement of the line above, whose end is `above`.
pub(crate) fn begins_inside(tokens: &[Placed], above: Option<Span>) -> Option<SyntaxError> {
    let [(start, first, end), (_, second, _), ..] = *tokens else { return None };
    let continues = is_infix(first) && !matches!(first, Token::Semicolon | Token::Minus | Token::Assign(_));
    let goes_on = crate::explain::begins_value(second) || matches!(second, Token::ParenOpen | Token::Minus);
    if !continues || !goes_on {
        return None;
    }
    let error = SyntaxError::new(SyntaxErrorKind::LineBreak(LineBreak::Before), Span::new(start, end));
    Some(error.with(above?, "the line above ends here"))
}
