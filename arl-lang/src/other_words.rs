//! Operators and words of other languages in a line, and ARL words with a slip in them: the error is reported, and the
//! line is read as it was meant.

use crate::ast::BinaryOp;
use crate::elsewhere;
use crate::explain::{begins_value, ends_value};
use crate::line::LineKind;
use crate::near::within;
use crate::span::Span;
use crate::syntax_error::{Hint, SyntaxError, SyntaxErrorKind};
use crate::token::{Placed, Token};

/// Two signs that touch, what they are in ARL, and how that is written.
const PAIRS: [(Token, Token, Token, &str); 7] = [
    (Token::Colon, Token::Assign(None), Token::Assign(None), "="),
    (Token::Operator(BinaryOp::Less), Token::Operator(BinaryOp::Greater), Token::Operator(BinaryOp::NotEqual), "!="),
    (Token::Complement, Token::Assign(None), Token::Operator(BinaryOp::NotEqual), "!="),
    (Token::Assign(None), Token::Operator(BinaryOp::Less), Token::Operator(BinaryOp::LessEqual), "<="),
    (Token::Assign(None), Token::Operator(BinaryOp::Greater), Token::Operator(BinaryOp::GreaterEqual), ">="),
    (Token::Operator(BinaryOp::Equal), Token::Assign(None), Token::Operator(BinaryOp::Equal), "=="),
    (Token::Operator(BinaryOp::NotEqual), Token::Assign(None), Token::Operator(BinaryOp::NotEqual), "!="),
];

/// Reports the operators of other languages in a line, and replaces them with those of ARL.
pub(crate) fn replace_operators(tokens: &mut Vec<Placed>, source: &str, errors: &mut Vec<SyntaxError>) {
    let mut report = |span: Span, ours: &'static str| {
        errors.push(SyntaxError::new(SyntaxErrorKind::OtherOperator(span.text(source).into(), ours), span));
    };
    let (mut depth, mut assigned) = (0_usize, false);
    let mut at = 0;
    while let Some((start, token, end)) = tokens.get(at).copied() {
        let next = tokens.get(at + 1).copied();
        let pair = next.filter(|next| next.0 == end).and_then(|(_, second, end)| {
            let pair = PAIRS.iter().find(|(a, b, ..)| *a == token && *b == second)?;
            Some((pair.2, pair.3, end))
        });
        if let Some((meant, ours, end)) = pair {
            report(Span::new(start, end), ours);
            tokens.remove(at + 1);
            if let Some(place) = tokens.get_mut(at) {
                *place = (start, meant, end);
            }
        } else if let Token::Name(_) = token {
            let before = at.checked_sub(1).and_then(|before| tokens.get(before)).map(|before| before.1);
            let inside = depth > 0 || assigned;
            let word = Span::new(start, end).text(source);
            if let Some((meant, ours)) = operator_in_letters(word, before, next.map(|next| next.1), inside) {
                report(Span::new(start, end), ours);
                if let Some(place) = tokens.get_mut(at) {
                    *place = (start, meant, end);
                }
            }
        }
        match tokens.get(at).map(|token| token.1) {
            Some(Token::ParenOpen | Token::BracketOpen | Token::BraceOpen) => depth += 1,
            Some(Token::ParenClose | Token::BracketClose | Token::BraceClose) => {
                depth = depth.saturating_sub(1);
                // After the condition of an `if` on one line, a statement begins.
                assigned &= depth > 0 || !matches!(tokens.first(), Some((_, Token::If, _)));
            }
            Some(Token::Assign(_)) => assigned = true,
            _ => {}
        }
        at += 1;
    }
}

/// The operator that a name means where no name is possible: `and` between two values, `not` before one.
fn operator_in_letters(
    word: &str,
    before: Option<Token>,
    next: Option<Token>,
    inside: bool,
) -> Option<(Token, &'static str)> {
    let ours = elsewhere::operator(word)?;
    let next = next?;
    let token = match ours {
        "!" | "~" => {
            let opens = before.is_some_and(|before| !ends_value(before)) && begins_value(next);
            return opens.then_some((if ours == "!" { Token::Not } else { Token::Complement }, ours));
        }
        "&&" => BinaryOp::And,
        "||" => BinaryOp::Or,
        "&" => BinaryOp::BitAnd,
        "|" => BinaryOp::BitOr,
        "^" => BinaryOp::BitXor,
        "/" => BinaryOp::Divide,
        _ => BinaryOp::Remainder,
    };
    let goes_on = begins_value(next) || matches!(next, Token::ParenOpen | Token::Minus);
    let between = inside && before.is_some_and(ends_value) && goes_on;
    between.then_some((Token::Operator(token), ours))
}

/// Words that other languages put in front of a declaration.
const PREFIXES: [&str; 10] = ["var", "pers", "decl", "local", "global", "dim", "let", "static", "retain", "persistent"];

/// Words with which other languages begin a function.
const FUNCTIONS: [&str; 8] = ["def", "deffct", "function", "proc", "procedure", "sub", "thread", "trap"];

fn is_word(token: Option<Token>) -> bool {
    token.is_some_and(crate::explain::is_word)
}

/// How a refused line was meant that begins with a word of another language or with a slip.
pub(crate) enum Meant {
    /// Nothing of the line is kept.
    Nothing,
    /// It declares what follows its first word.
    Declaration,
    /// Its first word is this one.
    Word(Token),
    /// It begins a function.
    Function,
}

/// The error for a refused line that begins with a word of another language, or with a word of ARL that has a slip in
/// it; and what to keep of the line.
pub(crate) fn first_word(tokens: &[Placed], source: &str) -> Option<(SyntaxError, Meant)> {
    let (start, token @ (Token::Name(_) | Token::Instruction(_)), end) = *tokens.first()? else { return None };
    let span = Span::new(start, end);
    let word = span.text(source);
    let next = tokens.get(1).map(|next| next.1);
    let is = |list: &[&str]| list.iter().any(|other| other.eq_ignore_ascii_case(word));
    if let Some((meant, opener)) = slip(word, token, next) {
        let error = SyntaxError::new(SyntaxErrorKind::Misspelt(word.into(), opener), span);
        return Some((error, Meant::Word(meant)));
    }
    if let Some(second) = tokens.get(1).filter(|second| begins_value(second.1))
        && !crate::catalog::functions(word).is_empty()
    {
        let found = format!("`{}`", Span::new(second.0, second.2).text(source)).into();
        let kind = SyntaxErrorKind::Unexpected { found, expected: "`(`".into(), hint: Hint::FunctionParens };
        return Some((SyntaxError::new(kind, Span::new(second.0, second.2)), Meant::Nothing));
    }
    let ours = elsewhere::word(word)?;
    // What may follow this name where the program itself defines it.
    let own = matches!(
        next,
        None | Some(
            Token::ParenOpen
                | Token::BracketOpen
                | Token::Assign(_)
                | Token::Dot
                | Token::Scope
                | Token::PlusPlus
                | Token::MinusMinus
        )
    );
    let meant = match word {
        _ if is(&["elif", "elsif"]) => Meant::Word(Token::ElseIf),
        _ if own => return None,
        _ if is(&FUNCTIONS) && is_word(next) => Meant::Function,
        _ if is(&["select", "test"]) => Meant::Word(Token::Switch),
        _ if is(&PREFIXES) => Meant::Declaration,
        _ => Meant::Nothing,
    };
    Some((SyntaxError::new(SyntaxErrorKind::OtherWord(word.into(), ours), span), meant))
}

/// The error for a line that begins a function in another language's words, though the grammar takes it for an
/// instruction: `DEF main()`.
pub(crate) fn function_of_others(tokens: &[Placed], source: &str) -> Option<SyntaxError> {
    let [(start, Token::Instruction(_), end), (_, Token::Name(_), _), (_, Token::ParenOpen, _), ..] = *tokens else {
        return None;
    };
    let span = Span::new(start, end);
    let word = span.text(source);
    let begins = FUNCTIONS.iter().any(|other| other.eq_ignore_ascii_case(word));
    let ours = elsewhere::word(word).filter(|_| begins)?;
    Some(SyntaxError::new(SyntaxErrorKind::OtherWord(word.into(), ours), span))
}

/// The error for a refused line that is a motion in another language.
pub(crate) fn motion_of_others(tokens: &[Placed], source: &str) -> Option<SyntaxError> {
    let (first, last) = (tokens.first()?, tokens.last()?);
    let (Token::Name(_) | Token::Instruction(_)) = first.1 else { return None };
    let span = Span::new(first.0, last.2);
    let motion = crate::other_motions::other_motion(span.text(source))?;
    Some(SyntaxError::new(SyntaxErrorKind::OtherMotion(Box::new(motion)), span))
}

/// The error for a line that begins with the sign of another language's comments.
pub(crate) fn comment(tokens: &[Placed], source: &str) -> Option<SyntaxError> {
    let (start, Token::Semicolon | Token::Not, end) = *tokens.first()? else { return None };
    let span = Span::new(start, end);
    let found = format!("`{}`", span.text(source)).into();
    let expected = "a statement, a declaration or the beginning or end of a block".into();
    Some(SyntaxError::new(SyntaxErrorKind::Unexpected { found, expected, hint: Hint::Comment }, span))
}

/// The error for a refused word, not the first of its line, that other languages give a motion.
pub(crate) fn argument(found: Placed, source: &str) -> Option<SyntaxError> {
    let (start, Token::Name(_), end) = found else { return None };
    let span = Span::new(start, end);
    let word = span.text(source);
    Some(SyntaxError::new(SyntaxErrorKind::OtherWord(word.into(), elsewhere::argument_word(word)?), span))
}

/// The words that begin a function, or a line with parentheses after the word.
const OPENERS: [(&str, Token); 7] = [
    ("if", Token::If),
    ("elseif", Token::ElseIf),
    ("while", Token::While),
    ("for", Token::For),
    ("switch", Token::Switch),
    ("until", Token::Until),
    ("func", Token::Func),
];

/// The opener that the first word of a refused line was meant to be.
fn slip(word: &str, token: Token, next: Option<Token>) -> Option<(Token, &'static str)> {
    if word.len() < 3 || !is_plain(word) || !matches!(token, Token::Name(_)) {
        return None;
    }
    let limit = if word.len() < 6 { 1 } else { 2 };
    let meant = within(word, limit, OPENERS.iter().map(|(opener, _)| *opener))?;
    let found = OPENERS.iter().find(|(opener, _)| *opener == meant)?;
    let fits = match found.1 {
        Token::Func => matches!(next, Some(Token::Type(_) | Token::Name(_))),
        _ => next == Some(Token::ParenOpen),
    };
    fits.then_some((found.1, found.0))
}

/// The word that closes a block, and its kind of line, where `word`, alone on a line, is a misspelling of it.
pub(crate) fn closing_slip(word: &str) -> Option<(&'static str, LineKind)> {
    const CLOSERS: [&str; 6] = ["endfor", "endfunc", "endif", "endloop", "endswitch", "endwhile"];
    // With a digit it is a name: `endwhile2`.
    let begins = is_plain(word) && word.get(..3).is_some_and(|first| first.eq_ignore_ascii_case("end"));
    let limit = if word.len() < 8 { 1 } else { 2 };
    let meant = within(word, limit, CLOSERS.into_iter()).filter(|_| begins)?;
    let line = match meant {
        "endfor" => LineKind::EndFor,
        "endfunc" => LineKind::EndFunc,
        "endif" => LineKind::EndIf,
        "endloop" => LineKind::EndLoop,
        "endswitch" => LineKind::EndSwitch,
        _ => LineKind::EndWhile,
    };
    Some((meant, line))
}

/// Whether `word` was meant to be the `opener` of a block.
pub(crate) fn opening_slip(word: &str, opener: &str) -> bool {
    let limit = if opener.len() < 3 { 1 } else { 2 };
    is_plain(word) && word.len() > 2 && within(word, limit, std::iter::once(opener)).is_some()
}

/// Whether a word consists of letters only, as all words of control structures do.
fn is_plain(word: &str) -> bool {
    word.bytes().all(|letter| letter.is_ascii_alphabetic())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_begins_lines_of_other_languages_is_known_with_what_arl_has() {
        for word in PREFIXES.iter().chain(&FUNCTIONS) {
            assert!(elsewhere::word(word).is_some(), "{word}");
        }
    }
}
