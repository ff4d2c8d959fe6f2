//! Habits from other languages that can be recognised from the ends of a line: the error is reported, and the line
//! is read as it was meant.

use crate::line::{Line, LineKind};
use crate::other_words::closing_slip;
use crate::span::Span;
use crate::syntax_error::{SyntaxError, SyntaxErrorKind};
use crate::token::{Placed, Token, open_brackets};

/// What was found in a line.
#[derive(Default)]
pub(crate) struct Habits {
    /// The line, if it consists of nothing else.
    pub(crate) whole: Option<Line>,
    /// The line ended with a `{`.
    pub(crate) opens_brace: bool,
    /// The line began with a `}`.
    pub(crate) closes_brace: Option<Span>,
    /// `else if`: one more `endif` may follow.
    pub(crate) else_if: bool,
}

/// What other languages write after a condition.
const THEN: [&str; 3] = ["then", "do", "begin"];

/// What other languages write at the end of a block.
const ENDS: [&str; 26] = [
    "done",
    "end",
    "endcase",
    "enddef",
    "enddo",
    "endfct",
    "endproc",
    "endtest",
    "endtrap",
    "end_case",
    "end_function",
    "end_loop",
    "end_switch",
    "endfunction",
    "endmain",
    "endprocedure",
    "endrepeat",
    "endselect",
    "endsub",
    "end_for",
    "end_func",
    "end_if",
    "end_while",
    "fi",
    "next",
    "wend",
];

/// The words of `ENDS` that end functions.
const FUNCTION_ENDS: [&str; 10] = [
    "enddef",
    "endfct",
    "endfunction",
    "endmain",
    "endproc",
    "endprocedure",
    "endsub",
    "endtrap",
    "end_func",
    "end_function",
];

/// Whether `name` is what other languages write after a condition.
pub(crate) fn is_then(name: &str) -> bool {
    THEN.iter().any(|then| then.eq_ignore_ascii_case(name))
}

/// Whether the token opens a block or a branch.
pub(crate) fn is_header(token: Token) -> bool {
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

/// Reports these habits in the line and removes them from its tokens.
pub(crate) fn repair(tokens: &mut Vec<Placed>, source: &str, errors: &mut Vec<SyntaxError>) -> Habits {
    let mut report = |kind, span| errors.push(SyntaxError::new(kind, span));
    let mut habits = Habits::default();
    let whole = |kind, span| Some(Line { kind, span });
    match tokens.as_slice() {
        [brace @ (_, Token::BraceOpen, _)] => habits.whole = whole(LineKind::BraceOpen, span(*brace)),
        [brace @ (_, Token::BraceClose, _)] => habits.whole = whole(LineKind::BraceClose, span(*brace)),
        [brace @ (_, Token::BraceClose, _), ..] => {
            habits.closes_brace = Some(span(*brace));
            tokens.remove(0);
        }
        _ => {}
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
        let words = span(*first).to(span(*second));
        report(SyntaxErrorKind::ElseIf, words);
        habits.else_if = true;
        tokens.remove(0);
        if let Some(word) = tokens.first_mut() {
            *word = (words.start, Token::ElseIf, words.end);
        }
    }
    let Some((_, first, _)) = tokens.first().copied() else { return habits };
    if is_header(first) {
        if tokens.len() > 1
            && let Some(last @ (_, Token::BraceOpen, _)) = tokens.last().copied()
        {
            report(SyntaxErrorKind::BlockBrace, span(last));
            tokens.pop();
            habits.opens_brace = true;
        }
        if let [.., (_, before, _), last @ (_, Token::Name(_), _)] = tokens.as_slice()
            && matches!(before, Token::ParenClose | Token::Else | Token::Loop | Token::Repeat)
            && is_then(span(*last).text(source))
        {
            report(SyntaxErrorKind::Then(span(*last).text(source).into()), span(*last));
            tokens.pop();
        }
    } else if tokens.len() <= 2 && matches!(first, Token::Name(_)) {
        habits.whole = other_end(tokens, source);
        if let ([only], None) = (tokens.as_slice(), &habits.whole)
            && let Some((closer, kind)) = closing_slip(span(*only).text(source))
        {
            report(SyntaxErrorKind::Misspelt(span(*only).text(source).into(), closer), span(*only));
            habits.whole = whole(kind, span(*only));
        }
    }
    habits
}

/// The line `end if`, `wend`, `endsub` and the like.
fn other_end(tokens: &[Placed], source: &str) -> Option<Line> {
    let (first, last) = (tokens.first()?, tokens.last()?);
    let whole = span(*first).to(span(*last));
    let word = span(*first).text(source);
    let is = |list: &[&str]| list.iter().any(|end| end.eq_ignore_ascii_case(word));
    let (ends, function) = match tokens {
        [_] => (is(&ENDS), is(&FUNCTION_ENDS)),
        [_, (_, second, _)] => (word.eq_ignore_ascii_case("end") && is_header(*second), *second == Token::Func),
        _ => (false, false),
    };
    let kind = LineKind::OtherEnd(whole.text(source).into(), function);
    ends.then_some(Line { kind, span: whole })
}
