//! The step between lexer and grammar: turns the lexemes of one line into its tokens. It interns names and decides what
//! depends on neighbouring lexemes: labels, components in braces, units, instructions whose names are not reserved.

use crate::ast::{BinaryOp, Radix, Unit};
use crate::lexer::Lexeme;
use crate::number::{Number, NumberValue};
use crate::span::Span;
use crate::symbol::{Interner, Symbol};
use crate::syntax_error::{BRACKET_LEVELS, Bracket, SyntaxError, SyntaxErrorKind};
use crate::token::{Placed, Token};
use crate::words::{Vocabulary, Word};

/// A lexeme with its first byte and the byte after its last one.
pub(crate) type PlacedLexeme = (u32, Lexeme, u32);

/// Makes tokens of lexemes, a line at a time.
pub(crate) struct Adapter<'a> {
    source: &'a str,
    interner: &'a mut Interner,
    words: Vocabulary,
    /// The tokens of the line.
    pub(crate) tokens: Vec<Placed>,
    /// The brackets that are open.
    open: Vec<Bracket>,
    /// The number of splices read so far.
    splices: u32,
}

/// The result of adapting a line.
pub(crate) struct Adapted {
    /// How many lexemes were taken; the rest is a line of its own.
    pub(crate) taken: usize,
    /// Whether the tokens cover only a part of the line, because of an error in it.
    pub(crate) broken: bool,
}

impl<'a> Adapter<'a> {
    pub(crate) fn new(source: &'a str, interner: &'a mut Interner) -> Self {
        let words = Vocabulary::new(interner);
        Self { source, interner, words, tokens: Vec::new(), open: Vec::new(), splices: 0 }
    }

    /// The symbol of `name`.
    pub(crate) fn intern(&mut self, name: &str) -> Symbol {
        self.interner.intern(name)
    }

    /// Fills `tokens` from `lexemes` (one line, not empty), or from its first part where a line ends before that.
    pub(crate) fn adapt(&mut self, lexemes: &[PlacedLexeme], errors: &mut Vec<SyntaxError>) -> Adapted {
        self.tokens.clear();
        self.open.clear();
        // Whether a statement begins here; another one begins after the condition of an `if`.
        let mut start = true;
        let mut at = 0;
        while let Some((from, lexeme, to)) = lexemes.get(at).copied() {
            let rest = lexemes.get(at + 1..).unwrap_or_default();
            at += 1;
            let starts = std::mem::take(&mut start);
            let token = match lexeme {
                Lexeme::Word => {
                    let symbol = self.interner.intern(Span::new(from, to).text(self.source));
                    let word = self.words.word(symbol);
                    if !starts && let Some((unit, used, end)) = self.spaced_unit(from, to, rest) {
                        self.tokens.push((from, Token::Unit(unit), end));
                        at += used;
                        continue;
                    }
                    let (token, used) = match starts {
                        true => self.first_word(symbol, word, rest),
                        false => self.later_word(symbol, word, rest),
                    };
                    if let (Token::Target(_), Some(behind)) = (token, rest.get(used)) {
                        errors.push(self.label_not_alone(Span::new(from, to), *behind, lexemes));
                        at = lexemes.len();
                    }
                    at += used;
                    token
                }
                Lexeme::System => Token::System(self.interner.intern(Span::new(from + 1, to).text(self.source))),
                Lexeme::Number(number) => {
                    self.push_number(number, from, to);
                    continue;
                }
                Lexeme::Percent if rest.first().is_none_or(|next| ends_value(next.1)) => Token::Unit(Unit::Percent),
                Lexeme::Percent => Token::Operator(BinaryOp::Remainder),
                Lexeme::Splice => {
                    self.splices += 1;
                    Token::Splice(self.splices - 1)
                }
                Lexeme::Colon if self.open.is_empty() && self.begins_case() => {
                    self.tokens.push((from, Token::Colon, to));
                    return Adapted { taken: at, broken: false };
                }
                Lexeme::ParenOpen | Lexeme::BracketOpen | Lexeme::BraceOpen => {
                    if self.open.len() >= BRACKET_LEVELS {
                        errors.push(SyntaxError::new(SyntaxErrorKind::TooManyLevels, Span::new(from, to)));
                        return Adapted { taken: lexemes.len(), broken: true };
                    }
                    let (bracket, token) = opening(lexeme);
                    self.open.push(bracket);
                    token
                }
                Lexeme::ParenClose => {
                    self.open.pop();
                    start = self.open.is_empty() && self.ends_condition();
                    Token::ParenClose
                }
                Lexeme::BracketClose => {
                    self.open.pop();
                    Token::BracketClose
                }
                Lexeme::BraceClose => {
                    self.open.pop();
                    Token::BraceClose
                }
                other => plain(other),
            };
            self.tokens.push((from, token, to));
        }
        Adapted { taken: lexemes.len(), broken: false }
    }

    /// The error for a label that is not alone on its line: everything from `behind` on.
    fn label_not_alone(&self, label: Span, behind: PlacedLexeme, lexemes: &[PlacedLexeme]) -> SyntaxError {
        let span = Span::new(behind.0, lexemes.last().map_or(behind.2, |last| last.2));
        SyntaxError::new(SyntaxErrorKind::LabelNotAlone(label.text(self.source).into()), span)
    }

    /// A number, and its unit as a token of its own.
    fn push_number(&mut self, Number { value, unit }: Number, from: u32, to: u32) {
        let token = match value {
            NumberValue::Int(value, radix) => Token::Int(value, radix),
            NumberValue::Double(value) => Token::Double(value),
        };
        let end = unit.map_or(to, |(_, length)| to - u32::from(length));
        self.tokens.push((from, token, end));
        if let Some((unit, _)) = unit {
            self.tokens.push((end, Token::Unit(unit), to));
        }
    }

    /// The token of a word at the start of a statement, and how many more lexemes it takes.
    fn first_word(&self, symbol: Symbol, word: Word, rest: &[PlacedLexeme]) -> (Token, usize) {
        match word {
            Word::Fixed(token) => (token, 0),
            Word::Type => (Token::Type(symbol), 0),
            Word::Instruction => (Token::Instruction(symbol), 0),
            Word::OpenInstruction if self.is_instruction(rest, true) => (Token::Instruction(symbol), 0),
            Word::OpenInstruction | Word::Name => match rest.first() {
                Some((_, Lexeme::Colon, colon))
                    if self.tokens.is_empty()
                        && !matches!(rest.get(1), Some((start, Lexeme::Assign, _)) if start == colon) =>
                {
                    (Token::Target(symbol), 1)
                }
                _ if self.is_instruction(rest, false) => (Token::Instruction(symbol), 0),
                _ => (Token::Name(symbol), 0),
            },
        }
    }

    /// Whether what follows a name at the start of a statement can only be the arguments of an instruction. For a
    /// `known` instruction the line may also end at once, and a word after the name is not a declared variable.
    fn is_instruction(&self, rest: &[PlacedLexeme], known: bool) -> bool {
        match rest {
            [] => known,
            [(_, Lexeme::Number(_) | Lexeme::Text | Lexeme::BraceOpen | Lexeme::System | Lexeme::Splice, _), ..] => {
                true
            }
            [(_, Lexeme::Word, _), (_, Lexeme::Colon, _), ..] => true,
            // No declaration continues like this.
            [(_, Lexeme::Word, _), (_, next, _), ..] if begins_operation(*next) => true,
            [(_, Lexeme::Semicolon, _), ..] => known,
            [(from, Lexeme::Word, to), ..] => {
                known
                    || self.is_constant(*from, *to)
                    || rest.windows(3).any(|three| {
                        matches!(three, [(_, Lexeme::Comma, _), (_, Lexeme::Word, _), (_, Lexeme::Colon, _)])
                    }) && !rest.iter().any(|(_, lexeme, _)| *lexeme == Lexeme::Assign)
            }
            _ => false,
        }
    }

    fn is_constant(&self, from: u32, to: u32) -> bool {
        let text = Span::new(from, to).text(self.source);
        text.eq_ignore_ascii_case("true") || text.eq_ignore_ascii_case("false")
    }

    /// The token of a word inside a statement, and how many more lexemes it takes.
    fn later_word(&self, symbol: Symbol, word: Word, rest: &[PlacedLexeme]) -> (Token, usize) {
        let before = self.tokens.last().map(|token| token.1);
        let next = rest.first().map(|lexeme| lexeme.1);
        let in_brace = self.open.last() == Some(&Bracket::Brace);
        match before {
            Some(Token::Dot | Token::Scope) => return (Token::Name(symbol), 0),
            Some(Token::ParenOpen | Token::Comma | Token::Instruction(_))
                if next == Some(Lexeme::Colon) && !in_brace =>
            {
                return (Token::Label(symbol), 1);
            }
            Some(Token::BraceOpen | Token::Comma) if in_brace && next.is_some_and(begins_component_value) => {
                return (Token::Component(symbol), 0);
            }
            // `weaveshape` is a type, which cannot be called, and a component.
            Some(Token::BraceOpen | Token::Comma)
                if in_brace && word == Word::Type && next == Some(Lexeme::ParenOpen) =>
            {
                return (Token::Component(symbol), 0);
            }
            _ => {}
        }
        let token = match word {
            Word::Fixed(token) => token,
            Word::Type => {
                let argument = matches!(before, Some(Token::Label(_) | Token::Comma | Token::Instruction(_)));
                let alone = next.is_none_or(ends_value);
                if argument && alone { Token::Name(symbol) } else { Token::Type(symbol) }
            }
            Word::Instruction => Token::Instruction(symbol),
            Word::OpenInstruction | Word::Name => Token::Name(symbol),
        };
        (token, 0)
    }

    /// The unit named by a word that follows a number and a blank, how many more lexemes it takes, and its end.
    fn spaced_unit(&self, from: u32, to: u32, rest: &[PlacedLexeme]) -> Option<(Unit, usize, u32)> {
        if !matches!(self.tokens.last(), Some((_, Token::Int(_, Radix::Decimal) | Token::Double(_), _))) {
            return None;
        }
        let text = Span::new(from, to).text(self.source);
        let is = |unit: &str| text.eq_ignore_ascii_case(unit);
        let per_second = match rest {
            [(_, Lexeme::Slash, _), (from, Lexeme::Word, to), ..] => {
                Some(*to).filter(|_| Span::new(*from, *to).text(self.source).eq_ignore_ascii_case("s"))
            }
            _ => None,
        };
        match per_second {
            Some(end) if is("mm") => Some((Unit::MillimetrePerSecond, 2, end)),
            Some(end) if is("deg") => Some((Unit::DegreePerSecond, 2, end)),
            _ if is("mm") => Some((Unit::Millimetre, 0, to)),
            _ if is("deg") => Some((Unit::Degree, 0, to)),
            _ if is("s") => Some((Unit::Second, 0, to)),
            _ => None,
        }
    }

    fn begins_case(&self) -> bool {
        matches!(self.tokens.first(), Some((_, Token::Case | Token::Default, _)))
    }

    /// Whether the parenthesis being closed is that of the `if` at the start of the line.
    fn ends_condition(&self) -> bool {
        if !matches!(self.tokens.first(), Some((_, Token::If, _))) {
            return false;
        }
        let mut depth = 0_usize;
        for (_, token, _) in self.tokens.get(1..).unwrap_or_default() {
            match token {
                Token::ParenOpen | Token::BracketOpen | Token::BraceOpen => depth += 1,
                Token::ParenClose | Token::BracketClose | Token::BraceClose => depth = depth.saturating_sub(1),
                _ => {}
            }
            // Closed before: this parenthesis is part of the statement after the condition.
            if depth == 0 {
                return false;
            }
        }
        true
    }
}

/// The bracket that a lexeme opens, and its token.
fn opening(lexeme: Lexeme) -> (Bracket, Token) {
    match lexeme {
        Lexeme::ParenOpen => (Bracket::Paren, Token::ParenOpen),
        Lexeme::BracketOpen => (Bracket::Square, Token::BracketOpen),
        _ => (Bracket::Brace, Token::BraceOpen),
    }
}

/// Whether a `%` before this lexeme is a unit, and a reserved type before it a constant.
fn ends_value(lexeme: Lexeme) -> bool {
    matches!(lexeme, Lexeme::Comma | Lexeme::Semicolon | Lexeme::ParenClose | Lexeme::BraceClose | Lexeme::BracketClose)
}

/// Whether a value before this lexeme continues with it.
fn begins_operation(lexeme: Lexeme) -> bool {
    use Lexeme as L;
    matches!(
        lexeme,
        L::ParenOpen | L::Dot | L::Scope | L::Plus | L::Minus | L::Star | L::Slash | L::Equal | L::NotEqual | L::Less
    ) || matches!(lexeme, L::LessEqual | L::Greater | L::GreaterEqual | L::And | L::Or | L::BitAnd | L::BitOr)
}

/// Whether a name in braces before this lexeme is a component.
fn begins_component_value(lexeme: Lexeme) -> bool {
    matches!(
        lexeme,
        Lexeme::Word
            | Lexeme::System
            | Lexeme::Number(_)
            | Lexeme::Text
            | Lexeme::Splice
            | Lexeme::BraceOpen
            | Lexeme::Minus
            | Lexeme::Not
            | Lexeme::Complement
    )
}

/// The token of a lexeme that always becomes the same token.
fn plain(lexeme: Lexeme) -> Token {
    use Lexeme as L;
    match lexeme {
        L::Text => Token::Text,
        L::Plus => Token::Operator(BinaryOp::Add),
        L::Minus => Token::Minus,
        L::Star => Token::Operator(BinaryOp::Multiply),
        L::Slash => Token::Operator(BinaryOp::Divide),
        L::ShiftLeft => Token::Operator(BinaryOp::ShiftLeft),
        L::ShiftRight => Token::Operator(BinaryOp::ShiftRight),
        L::Less => Token::Operator(BinaryOp::Less),
        L::LessEqual => Token::Operator(BinaryOp::LessEqual),
        L::Greater => Token::Operator(BinaryOp::Greater),
        L::GreaterEqual => Token::Operator(BinaryOp::GreaterEqual),
        L::Equal => Token::Operator(BinaryOp::Equal),
        L::NotEqual => Token::Operator(BinaryOp::NotEqual),
        L::BitAnd => Token::Operator(BinaryOp::BitAnd),
        L::BitXor => Token::Operator(BinaryOp::BitXor),
        L::BitOr => Token::Operator(BinaryOp::BitOr),
        L::And => Token::Operator(BinaryOp::And),
        L::Or => Token::Operator(BinaryOp::Or),
        L::Not => Token::Not,
        L::Complement => Token::Complement,
        L::PlusPlus => Token::PlusPlus,
        L::MinusMinus => Token::MinusMinus,
        L::Assign => Token::Assign(None),
        L::AddAssign => Token::Assign(Some(BinaryOp::Add)),
        L::SubtractAssign => Token::Assign(Some(BinaryOp::Subtract)),
        L::MultiplyAssign => Token::Assign(Some(BinaryOp::Multiply)),
        L::DivideAssign => Token::Assign(Some(BinaryOp::Divide)),
        L::RemainderAssign => Token::Assign(Some(BinaryOp::Remainder)),
        L::ShiftLeftAssign => Token::Assign(Some(BinaryOp::ShiftLeft)),
        L::ShiftRightAssign => Token::Assign(Some(BinaryOp::ShiftRight)),
        L::AndAssign => Token::Assign(Some(BinaryOp::BitAnd)),
        L::OrAssign => Token::Assign(Some(BinaryOp::BitOr)),
        L::XorAssign => Token::Assign(Some(BinaryOp::BitXor)),
        L::Comma => Token::Comma,
        L::Semicolon => Token::Semicolon,
        L::Colon => Token::Colon,
        L::Scope => Token::Scope,
        L::Dot => Token::Dot,
        // The other lexemes never get here: the caller has a rule of its own for each.
        _ => Token::Faulty,
    }
}
