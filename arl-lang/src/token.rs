//! The tokens of the grammar: what the token adapter makes of the lexemes.

use crate::ast::{BinaryOp, Radix, Unit};
use crate::span::Span;
use crate::symbol::Symbol;
use crate::syntax_error::Bracket;

/// A token of the grammar; its text is under the span that travels with it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Token {
    /// A name, also a reserved word where only a name is possible (after `.` and `::`).
    Name(Symbol),
    /// `$NAME`, without the `$`.
    System(Symbol),
    /// The reserved name of a type.
    Type(Symbol),
    /// The name of an instruction at the start of a statement.
    Instruction(Symbol),
    /// `label:` in front of an argument, the colon included.
    Label(Symbol),
    /// The name of a component in braces, in front of its value.
    Component(Symbol),
    /// `label:` on a line of its own, the colon included.
    Target(Symbol),
    Int(u32, Radix),
    Double(f64),
    Text,
    True,
    False,
    Endl,
    /// A number or a string that could not be read; reported already.
    Faulty,
    /// A unit after a number.
    Unit(Unit),
    /// A Rust value of the macro.
    Splice(u32),
    /// An operator between two operands, minus excepted.
    Operator(BinaryOp),
    Minus,
    Not,
    Complement,
    PlusPlus,
    MinusMinus,
    /// `=`, `+=` and so on.
    Assign(Option<BinaryOp>),
    ParenOpen,
    ParenClose,
    BracketOpen,
    BracketClose,
    BraceOpen,
    BraceClose,
    Comma,
    Semicolon,
    Colon,
    Scope,
    Dot,
    Break,
    Case,
    Const,
    Continue,
    Default,
    Else,
    ElseIf,
    EndFor,
    EndFunc,
    EndIf,
    EndLoop,
    EndSwitch,
    EndWhile,
    For,
    Func,
    Goto,
    If,
    Import,
    Loop,
    Repeat,
    Return,
    Switch,
    Until,
    While,
}

/// A token with its first byte and the byte after its last one.
pub(crate) type Placed = (u32, Token, u32);

/// The brackets that `tokens` leave open, outermost first.
pub(crate) fn open_brackets(tokens: &[Placed]) -> Vec<(Bracket, Span)> {
    let mut open = Vec::new();
    for (start, token, end) in tokens {
        match token {
            Token::ParenOpen => open.push((Bracket::Paren, Span::new(*start, *end))),
            Token::BracketOpen => open.push((Bracket::Square, Span::new(*start, *end))),
            Token::BraceOpen => open.push((Bracket::Brace, Span::new(*start, *end))),
            Token::ParenClose | Token::BracketClose | Token::BraceClose => {
                open.pop();
            }
            _ => {}
        }
    }
    open
}
