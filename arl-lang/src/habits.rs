//! Habits from other languages that can be recognised from the ends of a line: the error is reported, and the line
//! is read as it was meant.

use crate::explain::open_brackets;
use crate::nest::Nest;
use crate::span::Span;
use crate::syntax_error::{BlockKind, Bracket, SyntaxError, SyntaxErrorKind};
use crate::token::{Placed, Token};

/// What was done with a line.
pub(crate) enum Habit {
    /// The tokens are a line to be read.
    None,
    /// They are, and a `{` stood at its end.
    Braced,
    /// There is nothing left to read.
    Done,
}

/// What other languages write behind a condition.
const THEN: [&str; 3] = ["then", "do", "begin"];

/// What other languages write at the end of a block.
const ENDS: [&str; 18] = [
    "done",
    "end",
    "endcase",
    "enddo",
    "endfunction",
    "endmain",
    "endprocedure",
    "endrepeat",
    "endselect",
    "endsub",
    "endwhil",
    "end_for",
    "end_func",
    "end_if",
    "end_while",
    "fi",
    "next",
    "wend",
];

/// The words of `ENDS` that end functions.
const FUNCTION_ENDS: [&str; 5] = ["endfunction", "endmain", "endprocedure", "endsub", "end_func"];

/// Whether `name` is what other languages write behind a condition.
pub(crate) fn is_then(name: &str) -> bool {
    THEN.iter().any(|then| then.eq_ignore_ascii_case(name))
}

/// Whether the token opens a block or a branch.
fn is_header(token: Token) -> bool {
    matches!(
        token,
        Token::If
            | Token::ElseIf
            | Token::Else
            | Token::While
            | Token::For
            | Token::Loop
            | Token::Repeat
            | Token::Switch
            | Token::Func
    )
}

fn span(token: Placed) -> Span {
    Span::new(token.0, token.2)
}

/// Reports such habits in the line and takes them out of its tokens.
pub(crate) fn repair(
    tokens: &mut Vec<Placed>,
    source: &str,
    nest: &mut Nest<'_>,
    errors: &mut Vec<SyntaxError>,
) -> Habit {
    let mut report = |kind, span| errors.push(SyntaxError::new(kind, span));
    if let [brace @ (_, Token::BraceClose, _), rest @ ..] = tokens.as_slice() {
        if !nest.is_braced() {
            report(SyntaxErrorKind::StrayClose(Bracket::Brace), span(*brace));
            if rest.is_empty() {
                return Habit::Done;
            }
        } else if rest.is_empty() {
            nest.close_brace(span(*brace));
            return Habit::Done;
        }
        tokens.remove(0);
    }
    if let [brace @ (_, Token::BraceOpen, _)] = tokens.as_slice() {
        report(SyntaxErrorKind::BlockBrace, span(*brace));
        nest.set_braced();
        return Habit::Done;
    }
    if let Some(last @ (_, Token::Semicolon, _)) = tokens.last().copied()
        && open_brackets(tokens).is_empty()
    {
        let first = tokens.iter().rposition(|token| token.1 != Token::Semicolon).map_or(0, |at| at + 1);
        let begin = tokens.get(first).map_or(last.0, |first| first.0);
        report(SyntaxErrorKind::Semicolon, Span::new(begin, last.2));
        tokens.truncate(first);
    }
    if let [first @ (_, Token::Else, _), second @ (_, Token::If, _), ..] = tokens.as_slice() {
        let whole = span(*first).to(span(*second));
        report(SyntaxErrorKind::ElseIf, whole);
        // Whoever means an `if` of its own inside of the `else` writes one `endif` more.
        nest.forgive_end(BlockKind::If);
        tokens.remove(0);
        if let Some(word) = tokens.first_mut() {
            *word = (whole.start, Token::ElseIf, whole.end);
        }
    }
    let Some((_, first, _)) = tokens.first().copied() else { return Habit::Done };
    let mut habit = Habit::None;
    if is_header(first) {
        if tokens.len() > 1
            && let Some(last @ (_, Token::BraceOpen, _)) = tokens.last().copied()
        {
            report(SyntaxErrorKind::BlockBrace, span(last));
            tokens.pop();
            habit = Habit::Braced;
        }
        if let [.., (_, before, _), last @ (_, Token::Name(_), _)] = tokens.as_slice()
            && matches!(before, Token::ParenClose | Token::Else | Token::Loop | Token::Repeat)
            && is_then(span(*last).text(source))
        {
            report(SyntaxErrorKind::Then(span(*last).text(source).into()), span(*last));
            tokens.pop();
        }
    } else if tokens.len() <= 2 && matches!(first, Token::Name(_)) && ends_block(tokens, source, nest, errors) {
        return Habit::Done;
    }
    habit
}

/// Takes a line like `end if`, `wend` or `endsub` for the end of the innermost block.
fn ends_block(tokens: &[Placed], source: &str, nest: &mut Nest<'_>, errors: &mut Vec<SyntaxError>) -> bool {
    let (Some(first), Some(last)) = (tokens.first(), tokens.last()) else { return false };
    let whole = span(*first).to(span(*last));
    let word = span(*first).text(source);
    let is = |list: &[&str]| list.iter().any(|end| end.eq_ignore_ascii_case(word));
    let (ends, function) = match tokens {
        [_] => (is(&ENDS), is(&FUNCTION_ENDS)),
        [_, (_, second, _)] => (word.eq_ignore_ascii_case("end") && is_header(*second), *second == Token::Func),
        _ => (false, false),
    };
    ends && nest.close_other(whole.text(source), whole, function, errors)
}
