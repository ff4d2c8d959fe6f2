//! Explains, in terms of the program, what is wrong with a line that the grammar refuses.

use std::convert::Infallible;

use lalrpop_util::ParseError;

use crate::ast::BinaryOp;
use crate::span::Span;
use crate::symbol::Symbol;
use crate::syntax_error::{Bracket, Hint, SyntaxError, SyntaxErrorKind};
use crate::syntax_words::is_unit;
use crate::token::{Placed, Token, open_brackets};

/// A line and the place where the grammar refuses it.
struct Refused<'a> {
    source: &'a str,
    tokens: &'a [Placed],
    /// The index of the refused token; past the last token, the end of the line is refused.
    at: usize,
    /// Whether the given tokens can be followed by a token, or by the end of the line.
    goes_on: &'a dyn Fn(&[Placed], Option<Token>) -> bool,
    /// A symbol that stands for any name.
    symbol: Symbol,
    /// The brackets that are open at that place.
    open: Vec<(Bracket, Span)>,
}

/// The error for what the grammar refused, and the index of the token it is about.
///
/// `goes_on` returns whether the first tokens of a line can be followed by a token, or by the end of the line.
/// (lalrpop's own list of expected tokens is not enough: its states are merged, and the wrong token may have ended
/// something.)
pub(crate) fn explain(
    error: &ParseError<u32, Token, Infallible>,
    source: &str,
    tokens: &[Placed],
    symbol: Symbol,
    goes_on: &dyn Fn(&[Placed], Option<Token>) -> bool,
) -> (SyntaxError, usize) {
    let at = match error {
        ParseError::UnrecognizedToken { token, .. } | ParseError::ExtraToken { token } => position(tokens, token.0),
        ParseError::UnrecognizedEof { .. } => tokens.len(),
        ParseError::InvalidToken { location } => position(tokens, *location),
        ParseError::User { error } => match *error {},
    };
    let open = open_brackets(tokens.get(..at).unwrap_or(tokens));
    let refused = Refused { source, tokens, at, goes_on, symbol, open };
    let error = match refused.found() {
        None => refused.at_line_end(),
        Some(found) => refused.at_token(found, at > 0 && refused.can_follow(None)),
    };
    (error, at)
}

/// The index of the token that begins at `offset`.
fn position(tokens: &[Placed], offset: u32) -> usize {
    tokens.partition_point(|token| token.0 < offset)
}

impl Refused<'_> {
    fn found(&self) -> Option<Placed> {
        self.tokens.get(self.at).copied()
    }

    fn before(&self) -> Option<Placed> {
        self.tokens.get(self.at.checked_sub(1)?).copied()
    }

    fn first(&self) -> Option<Token> {
        self.tokens.first().map(|token| token.1)
    }

    /// Whether the line could continue with the token, or end, where it is refused.
    fn can_follow(&self, token: Option<Token>) -> bool {
        (self.goes_on)(self.tokens.get(..self.at).unwrap_or(self.tokens), token)
    }

    fn expects(&self, token: Token) -> bool {
        self.can_follow(Some(token))
    }

    /// Whether a value is possible here.
    fn expects_value(&self) -> bool {
        self.expects(Token::Text) && self.expects(Token::True)
    }

    fn expects_name(&self) -> bool {
        self.expects(Token::Name(self.symbol))
    }

    fn expects_operator(&self) -> bool {
        self.expects(Token::Operator(BinaryOp::Multiply))
    }

    fn expects_close(&self, bracket: Bracket) -> bool {
        self.expects(match bracket {
            Bracket::Paren => Token::ParenClose,
            Bracket::Square => Token::BracketClose,
            Bracket::Brace => Token::BraceClose,
        })
    }

    /// A token as the reader sees it.
    fn show(&self, token: Placed) -> String {
        let text = Span::new(token.0, token.2).text(self.source);
        match token.1 {
            Token::Text => "this string".into(),
            _ => format!("`{text}`"),
        }
    }

    fn text(&self, token: Placed) -> Box<str> {
        Span::new(token.0, token.2).text(self.source).into()
    }

    /// The error where the line ends too early.
    fn at_line_end(&self) -> SyntaxError {
        let Some(last) = self.before() else {
            return SyntaxError::new(self.ends_early(Hint::None), Span::default());
        };
        let place = Span::new(last.0, last.2);
        if let Some((bracket, span)) = self.open.last()
            && self.expects_close(*bracket)
        {
            let error = SyntaxError::new(SyntaxErrorKind::MissingClose(*bracket), place);
            return error.with(*span, format!("this `{}` is open", bracket.open()));
        }
        if matches!(self.first(), Some(Token::Case | Token::Default)) && self.expects(Token::Colon) {
            return SyntaxError::new(SyntaxErrorKind::MissingColon, place);
        }
        if matches!(last.1, Token::Type(_)) && self.at > 1 && !self.expects_name() {
            return SyntaxError::new(SyntaxErrorKind::ReservedWord(self.text(last)), place);
        }
        if self.expects_value() && self.at > 1 {
            return SyntaxError::new(SyntaxErrorKind::MissingValue(self.show(last).into(), "".into()), place);
        }
        let hint = match self.first() {
            Some(Token::Func) if matches!(last.1, Token::Name(_)) => Hint::ResultType,
            Some(Token::Instruction(_)) if self.has_semicolon() => Hint::Events,
            Some(Token::If | Token::While | Token::Until | Token::ElseIf) if self.at == 1 => Hint::ConditionParens,
            Some(Token::For) => Hint::For,
            _ => Hint::None,
        };
        SyntaxError::new(self.ends_early(hint), place)
    }

    fn ends_early(&self, hint: Hint) -> SyntaxErrorKind {
        SyntaxErrorKind::EndsEarly { expected: self.describe(false).into(), hint }
    }

    fn has_semicolon(&self) -> bool {
        self.tokens.iter().any(|token| token.1 == Token::Semicolon)
    }

    /// The error at the token `found`; `complete`: whether the tokens before it form a complete line.
    fn at_token(&self, found: Placed, complete: bool) -> SyntaxError {
        let place = Span::new(found.0, found.2);
        if let Some(bracket) = closed(found.1) {
            return self.at_close(found, bracket);
        }
        if let Some(error) = self.at_reserved(found, complete) {
            return error;
        }
        let before = self.before();
        let kind = match (before.map(|before| before.1), found.1) {
            (Some(Token::Name(_)), _) if self.is_then(before) => {
                let then = before.map_or("".into(), |before| self.text(before));
                let place = before.map_or(place, |before| Span::new(before.0, before.2));
                return SyntaxError::new(SyntaxErrorKind::Then(then), place);
            }
            (Some(before), Token::Semicolon) if !self.open.is_empty() && ends_value(before) => {
                return self.between_values(found, complete);
            }
            (_, Token::Semicolon) if complete => {
                let next = self.tokens.get(self.at + 1).map_or(place, |next| Span::new(next.0, next.2));
                return SyntaxError::new(SyntaxErrorKind::SeveralStatements, next);
            }
            (Some(Token::Name(_)), Token::Colon) if self.is_in(Bracket::Brace) => {
                SyntaxErrorKind::ComponentColon(before.map_or("".into(), |before| self.text(before)))
            }
            (_, Token::Unit(_)) if before.is_some_and(|before| ends_value(before.1)) => SyntaxErrorKind::MisplacedUnit,
            (Some(before), Token::Assign(_)) if ends_value(before) && self.expects_operator() => {
                SyntaxErrorKind::NotAssignable("the result of an operator".into())
            }
            (Some(before), token) if begins_value(token) && ends_value(before) => {
                return self.between_values(found, complete);
            }
            (Some(_), token) if is_infix(token) && !complete && self.expects_value() => {
                let after = before.map_or(String::new(), |before| self.show(before));
                SyntaxErrorKind::MissingValue(after.into(), self.show(found).into())
            }
            _ => self.unexpected(found, self.hint(found, complete), complete),
        };
        SyntaxError::new(kind, place)
    }

    /// The error at a closing bracket.
    fn at_close(&self, found: Placed, bracket: Bracket) -> SyntaxError {
        let place = Span::new(found.0, found.2);
        let Some((open, opened)) = self.open.last().copied() else {
            return SyntaxError::new(SyntaxErrorKind::StrayClose(bracket), place);
        };
        let related = format!("this `{}` is open", open.open());
        if open != bracket {
            let error = SyntaxError::new(SyntaxErrorKind::WrongClose(open, bracket), place);
            return error.with(opened, related);
        }
        let before = self.before();
        if matches!(before, Some((_, Token::Type(_), _))) && !self.expects_name() {
            let (word, place) =
                before.map_or(("".into(), place), |before| (self.text(before), Span::new(before.0, before.2)));
            return SyntaxError::new(SyntaxErrorKind::ReservedWord(word), place);
        }
        let kind = match before {
            Some((_, Token::BracketOpen, _)) => self.unexpected(found, Hint::ArraySize, false),
            Some(before) if self.expects_value() => {
                SyntaxErrorKind::MissingValue(self.show(before).into(), self.show(found).into())
            }
            _ => self.unexpected(found, self.hint(found, false), false),
        };
        SyntaxError::new(kind, place).with(opened, related)
    }

    /// The error where a reserved word is in the place of a name or begins a statement in the middle of a line.
    fn at_reserved(&self, found: Placed, complete: bool) -> Option<SyntaxError> {
        let reserved = |token: Placed| {
            let place = Span::new(token.0, token.2);
            Some(SyntaxError::new(SyntaxErrorKind::ReservedWord(self.text(token)), place))
        };
        let before = self.before();
        match (before, found.1) {
            (Some((_, Token::Type(_), _)), Token::Func) if self.at == 1 => {
                let place = Span::new(found.0, found.2);
                return Some(SyntaxError::new(self.unexpected(found, Hint::TypeBehindFunc, complete), place));
            }
            (Some((_, Token::Type(_), _)), Token::ParenOpen) => {
                let place = Span::new(found.0, found.2);
                return Some(SyntaxError::new(self.unexpected(found, Hint::Conversion, complete), place));
            }
            (Some((_, Token::Type(_), _)), Token::BracketOpen | Token::System(_)) => {
                let hint = if found.1 == Token::BracketOpen { Hint::SizeBehindName } else { Hint::PlainName };
                let place = Span::new(found.0, found.2);
                return Some(SyntaxError::new(self.unexpected(found, hint, complete), place));
            }
            (Some(word @ (_, Token::Type(_), _)), token) if !is_word(token) && !self.is_reference(token) => {
                return reserved(word);
            }
            (Some(word @ (_, Token::Instruction(_), _)), Token::Assign(_) | Token::Dot | Token::Scope) => {
                return reserved(word);
            }
            (Some(word @ (_, Token::Type(_), _)), Token::Name(_)) if !self.open.is_empty() => return reserved(word),
            (Some((start, Token::Type(_), end)), Token::Name(_)) if self.first() == Some(Token::If) => {
                let word = (start, found.1, end);
                return Some(SyntaxError::new(
                    self.unexpected(word, Hint::CompactDeclaration, true),
                    Span::new(start, end),
                ));
            }
            _ => {}
        }
        if !is_word(found.1) || matches!(found.1, Token::Name(_)) {
            return None;
        }
        let behind_if = matches!(self.first(), Some(Token::If)) && complete;
        let place = Span::new(found.0, found.2);
        match found.1 {
            Token::Type(_) | Token::Const if behind_if => {
                Some(SyntaxError::new(self.unexpected(found, Hint::CompactDeclaration, true), place))
            }
            Token::If | Token::While | Token::For | Token::Switch | Token::Loop | Token::Repeat if behind_if => {
                Some(SyntaxError::new(self.unexpected(found, Hint::CompactIf, true), place))
            }
            _ if complete && !begins_value(found.1) => {
                Some(SyntaxError::new(SyntaxErrorKind::SeveralStatements, place))
            }
            Token::Instruction(_) if self.expects_value() => {
                Some(SyntaxError::new(self.unexpected(found, Hint::InstructionValue, false), place))
            }
            _ if self.expects_name() && !(begins_value(found.1) && self.expects_value()) => reserved(found),
            _ => None,
        }
    }

    /// The error where two values follow each other.
    fn between_values(&self, found: Placed, complete: bool) -> SyntaxError {
        let place = Span::new(found.0, found.2);
        // `lin p1 ; go down` is not an event that lacks a comma.
        let before = self.tokens.get(..self.at).unwrap_or_default();
        let events = matches!(self.first(), Some(Token::Instruction(_)))
            && before.iter().any(|token| token.1 == Token::Semicolon);
        let kind = if events {
            self.unexpected(found, Hint::Events, complete)
        } else if self.before().is_some_and(|before| is_number(before.1)) && is_unit(&self.text(found)) {
            self.unexpected(found, Hint::Units, complete)
        } else if self.expects(Token::Comma) && found.1 != Token::Semicolon {
            SyntaxErrorKind::MissingComma(self.show(found).into())
        } else if let Some((bracket, opened)) = self.open.last()
            && self.expects_close(*bracket)
        {
            let error = SyntaxError::new(SyntaxErrorKind::MissingClose(*bracket), self.place_before(place));
            return error.with(*opened, format!("this `{}` is open", bracket.open()));
        } else {
            self.unexpected(found, self.hint(found, complete), complete)
        };
        SyntaxError::new(kind, place)
    }

    fn place_before(&self, otherwise: Span) -> Span {
        self.before().map_or(otherwise, |before| Span::new(before.0, before.2))
    }

    fn unexpected(&self, found: Placed, hint: Hint, complete: bool) -> SyntaxErrorKind {
        let expected = self.describe(complete).into();
        SyntaxErrorKind::Unexpected { found: self.show(found).into(), expected, hint }
    }

    /// A hint where nothing more is known of the mistake.
    fn hint(&self, found: Placed, complete: bool) -> Hint {
        let before = self.before().map(|before| before.1);
        match (self.first(), before, found.1) {
            (Some(Token::If | Token::While | Token::Until | Token::ElseIf | Token::Switch), ..) if self.at == 1 => {
                Hint::ConditionParens
            }
            (Some(Token::For), ..) if self.at == 1 => Hint::For,
            (Some(Token::If | Token::While | Token::Until | Token::ElseIf), Some(Token::ParenClose), token)
                if complete && is_infix(token) =>
            {
                Hint::WholeCondition
            }
            (Some(Token::Else), ..) if complete => Hint::ElseAlone,
            (Some(Token::Func), Some(Token::Name(_)), Token::ParenOpen) if self.at == 2 => Hint::ResultType,
            (Some(Token::Func), _, token) if self.is_reference(token) => Hint::References,
            (_, _, Token::Comma) if self.is_in(Bracket::Square) && self.is_pose_literal() => Hint::PoseLiteral,
            (_, _, Token::Comma) if self.is_in(Bracket::Square) => Hint::OneIndex,
            (Some(Token::Instruction(_)), _, Token::Comma)
                if self.open.len() == 1 && matches!(self.tokens.get(1), Some((_, Token::ParenOpen, _))) =>
            {
                Hint::InstructionParens
            }
            (Some(Token::For), ..) if !self.open.is_empty() => Hint::For,
            (Some(Token::Import), ..) if self.at == 1 => Hint::ImportQuotes,
            (Some(Token::Case), _, Token::Comma) => Hint::OneCase,
            (_, Some(Token::Unit(_)), Token::Operator(BinaryOp::Divide)) => Hint::Units,
            (Some(Token::Type(_)), _, Token::Comma) if self.is_in(Bracket::Paren) && self.is_behind_equals() => {
                Hint::Braces
            }
            (Some(Token::Type(_)), Some(Token::Comma), token) if self.open.is_empty() && is_number(token) => {
                Hint::DecimalPoint
            }
            (_, Some(Token::Name(_)), Token::ParenOpen) if self.is_component() => Hint::ModuleCall,
            (_, Some(Token::Name(_)), Token::Colon) => Hint::Label,
            (Some(Token::Instruction(_)), ..) if self.has_semicolon() => Hint::Events,
            _ => Hint::None,
        }
    }

    /// Whether the tokens before are the name of a component.
    fn is_component(&self) -> bool {
        self.at >= 2 && matches!(self.tokens.get(self.at - 2), Some((_, Token::Dot, _)))
    }

    /// Whether the open bracket follows the `=` of a declaration.
    fn is_behind_equals(&self) -> bool {
        let opened = self.open.last().and_then(|(_, span)| self.tokens.iter().position(|token| token.0 == span.start));
        let before = opened.and_then(|at| self.tokens.get(at.checked_sub(1)?));
        matches!(before, Some((_, Token::Assign(None), _)))
    }

    /// Whether the open bracket follows a `p`.
    fn is_pose_literal(&self) -> bool {
        let opened = self.open.last().map(|(_, span)| span.start);
        let before = self.tokens.iter().rfind(|token| opened.is_some_and(|start| token.2 <= start));
        before.is_some_and(|token| self.text(*token).eq_ignore_ascii_case("p"))
    }

    fn is_in(&self, bracket: Bracket) -> bool {
        self.open.last().is_some_and(|(open, _)| *open == bracket)
    }

    fn is_reference(&self, token: Token) -> bool {
        self.first() == Some(Token::Func) && token == Token::Operator(BinaryOp::BitAnd)
    }

    /// Whether the name is one that other languages write after a condition.
    fn is_then(&self, name: Option<Placed>) -> bool {
        let header = matches!(self.first(), Some(Token::If | Token::While | Token::ElseIf | Token::For));
        let behind_condition = self.at >= 2 && matches!(self.tokens.get(self.at - 2), Some((_, Token::ParenClose, _)));
        header && behind_condition && name.is_some_and(|name| crate::habits::is_then(&self.text(name)))
    }

    /// What would have been accepted at the refused place.
    fn describe(&self, line_end: bool) -> String {
        if self.at == 0 {
            return "a statement, a declaration or the beginning or end of a block".into();
        }
        let behind_if = self.first() == Some(Token::If) && self.open.is_empty();
        if line_end && behind_if && matches!(self.before(), Some((_, Token::ParenClose | Token::Type(_), _))) {
            return "a statement or the end of the line".into();
        }
        let mut parts: Vec<String> = Vec::new();
        let value = self.expects_value();
        let operator = self.expects_operator();
        let line_end = line_end || (self.at < self.tokens.len() && self.can_follow(None));
        if value {
            parts.push("a value".into());
        }
        let words =
            [(Token::Name(self.symbol), "a name"), (Token::Type(self.symbol), "a type"), (Token::Text, "a string")];
        for (token, words) in words {
            if !value && self.expects(token) {
                parts.push(words.into());
            }
        }
        let signs = [
            (Token::Comma, "`,`"),
            (Token::Semicolon, "`;`"),
            (Token::Colon, "`:`"),
            (Token::Scope, "`::`"),
            (Token::ParenOpen, "`(`"),
            (Token::ParenClose, "`)`"),
            (Token::BracketClose, "`]`"),
            (Token::BraceClose, "`}`"),
            (Token::Assign(None), "`=`"),
        ];
        for (token, words) in signs {
            let implied = (value && token == Token::ParenOpen)
                || (token == Token::Scope && parts.iter().any(|part| part == "a name"))
                || (operator && matches!(token, Token::ParenOpen | Token::Assign(_) | Token::Scope));
            if !implied && self.expects(token) {
                parts.push(words.into());
            }
        }
        if operator {
            parts.push("an operator".into());
        }
        if line_end {
            parts.push("the end of the line".into());
        }
        match parts.as_slice() {
            [] => "something else".into(),
            [only] => only.clone(),
            [some @ .., last] => format!("{} or {last}", some.join(", ")),
        }
    }
}

fn is_number(token: Token) -> bool {
    matches!(token, Token::Int(..) | Token::Double(_))
}

/// The bracket that a token closes.
fn closed(token: Token) -> Option<Bracket> {
    match token {
        Token::ParenClose => Some(Bracket::Paren),
        Token::BracketClose => Some(Bracket::Square),
        Token::BraceClose => Some(Bracket::Brace),
        _ => None,
    }
}

/// Whether a value can end with the token.
pub(crate) fn ends_value(token: Token) -> bool {
    matches!(
        token,
        Token::Name(_)
            | Token::System(_)
            | Token::Int(..)
            | Token::Double(_)
            | Token::Text
            | Token::Faulty
            | Token::True
            | Token::False
            | Token::Endl
            | Token::Unit(_)
            | Token::Splice(_)
            | Token::ParenClose
            | Token::BracketClose
            | Token::BraceClose
            | Token::PlusPlus
            | Token::MinusMinus
    )
}

/// Whether a value can begin with the token; a sign, which may also stand between two values, does not count.
pub(crate) fn begins_value(token: Token) -> bool {
    matches!(
        token,
        Token::Name(_)
            | Token::System(_)
            | Token::Type(_)
            | Token::Label(_)
            | Token::Component(_)
            | Token::Int(..)
            | Token::Double(_)
            | Token::Text
            | Token::Faulty
            | Token::True
            | Token::False
            | Token::Endl
            | Token::Splice(_)
            | Token::BraceOpen
            | Token::Not
            | Token::Complement
    )
}

/// Whether the token separates values.
pub(crate) fn is_infix(token: Token) -> bool {
    matches!(token, Token::Operator(_) | Token::Minus | Token::Assign(_) | Token::Comma | Token::Semicolon)
}

/// Whether the token is a word.
pub(crate) fn is_word(token: Token) -> bool {
    !matches!(
        token,
        Token::System(_)
            | Token::Int(..)
            | Token::Double(_)
            | Token::Text
            | Token::Faulty
            | Token::Unit(_)
            | Token::Splice(_)
            | Token::Operator(_)
            | Token::Minus
            | Token::Not
            | Token::Complement
            | Token::PlusPlus
            | Token::MinusMinus
            | Token::Assign(_)
            | Token::ParenOpen
            | Token::ParenClose
            | Token::BracketOpen
            | Token::BracketClose
            | Token::BraceOpen
            | Token::BraceClose
            | Token::Comma
            | Token::Semicolon
            | Token::Colon
            | Token::Scope
            | Token::Dot
    )
}
