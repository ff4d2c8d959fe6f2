//! Lines as the grammar reads them, before they are nested.

use crate::ast::{Expr, For, FuncParam, Ident, Import, StmtKind, TypeRef};
use crate::span::Span;

/// One line.
#[derive(Debug)]
pub(crate) struct Line {
    /// What it is.
    pub(crate) kind: LineKind,
    /// From its first token to its last one.
    pub(crate) span: Span,
}

/// The kinds of lines.
#[derive(Debug)]
pub(crate) enum LineKind {
    /// A statement that is complete on its line, including declarations, labels and the compact `if`.
    Statement(StmtKind),
    Import(Box<Import>),
    Func(Box<FuncHead>),
    EndFunc,
    If(Expr),
    ElseIf(Expr),
    Else,
    EndIf,
    While(Expr),
    EndWhile,
    Repeat,
    Until(Expr),
    Loop,
    EndLoop,
    /// The body is still empty.
    For(Box<For>),
    EndFor,
    Switch(Expr),
    Case(Expr),
    Default,
    EndSwitch,
    /// A `{` alone.
    BraceOpen,
    /// A `}` alone.
    BraceClose,
    /// `end if` and the like, and whether it names the end of a function.
    OtherEnd(Box<str>, bool),
}

/// The first line of a function.
#[derive(Debug)]
pub(crate) struct FuncHead {
    pub(crate) result: TypeRef,
    pub(crate) name: Ident,
    pub(crate) params: Vec<FuncParam>,
}
