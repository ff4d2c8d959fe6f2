//! What the grammar's rules call to build the tree. Its depth is limited, since every later pass may recurse.

use crate::ast::*;
use crate::line::LineKind;
use crate::operators::binding;
use crate::span::Span;
use crate::symbol::Symbol;
use crate::syntax_error::{SyntaxError, SyntaxErrorKind};

/// The most levels that the tree of one expression may have.
pub const EXPRESSION_LEVELS: u16 = 256;

/// The depth of an expression that was too deep and is an error now.
const CUT: u16 = u16::MAX;

/// An expression and the number of levels of its tree.
#[derive(Debug)]
pub(crate) struct Deep {
    pub(crate) expr: Expr,
    pub(crate) depth: u16,
}

impl Deep {
    pub(crate) fn leaf(kind: ExprKind, start: u32, end: u32) -> Self {
        Self { expr: Expr { kind, span: Span::new(start, end) }, depth: 1 }
    }

    /// The same expression with parentheses around it.
    pub(crate) fn spanning(mut self, start: u32, end: u32) -> Self {
        self.expr.span = Span::new(start, end);
        self
    }
}

/// Arguments and the depth of the deepest.
#[derive(Debug)]
pub(crate) struct Args {
    args: Vec<Arg>,
    depth: u16,
}

impl Args {
    pub(crate) fn one(arg: Arg, depth: u16) -> Self {
        Self { args: vec![arg], depth }
    }

    pub(crate) fn add(&mut self, arg: Arg, depth: u16) {
        self.args.push(arg);
        self.depth = self.depth.max(depth);
    }
}

/// Elements between braces and the depth of the deepest.
#[derive(Debug)]
pub(crate) struct Items {
    items: Vec<BraceItem>,
    depth: u16,
}

impl Items {
    pub(crate) fn one(item: BraceItem, depth: u16) -> Self {
        Self { items: vec![item], depth }
    }

    pub(crate) fn add(&mut self, item: BraceItem, depth: u16) {
        self.items.push(item);
        self.depth = self.depth.max(depth);
    }
}

/// Operands with the operators between them, as far as they are not combined yet: each operator in `open` binds
/// tighter than the one before it.
#[derive(Debug)]
pub(crate) struct Chain {
    open: Vec<(Deep, BinaryOp)>,
    last: Deep,
}

impl Chain {
    pub(crate) fn new(left: Deep, op: BinaryOp, right: Deep) -> Self {
        Self { open: vec![(left, op)], last: right }
    }
}

/// What the rules of the grammar need besides the tokens.
pub(crate) struct Context<'source> {
    pub(crate) source: &'source str,
    pub(crate) errors: Vec<SyntaxError>,
    /// The symbol of `endl`.
    pub(crate) endl: Symbol,
}

impl Context<'_> {
    /// A node above children of which the deepest has `depth` levels.
    fn node(&mut self, kind: ExprKind, span: Span, depth: u16) -> Deep {
        if depth < EXPRESSION_LEVELS {
            return Deep { expr: Expr { kind, span }, depth: depth + 1 };
        }
        if depth != CUT {
            self.errors.push(SyntaxError::new(SyntaxErrorKind::TooManyLevels, span));
        }
        Deep { expr: Expr { kind: ExprKind::Error, span }, depth: CUT }
    }

    pub(crate) fn unary(&mut self, start: u32, op: UnaryOp, value: Deep) -> Deep {
        let span = Span::new(start, value.expr.span.end);
        self.node(ExprKind::Unary(op, Box::new(value.expr)), span, value.depth)
    }

    pub(crate) fn prefix_step(&mut self, start: u32, up: bool, value: Deep) -> Deep {
        let span = Span::new(start, value.expr.span.end);
        self.node(ExprKind::Step(Step { up, prefix: true }, Box::new(value.expr)), span, value.depth)
    }

    pub(crate) fn postfix_step(&mut self, value: Deep, up: bool, end: u32) -> Deep {
        let span = Span::new(value.expr.span.start, end);
        self.node(ExprKind::Step(Step { up, prefix: false }, Box::new(value.expr)), span, value.depth)
    }

    pub(crate) fn index(&mut self, base: Deep, index: Deep, end: u32) -> Deep {
        let span = Span::new(base.expr.span.start, end);
        let depth = base.depth.max(index.depth);
        self.node(ExprKind::Index(Box::new((base.expr, index.expr))), span, depth)
    }

    pub(crate) fn field(&mut self, base: Deep, name: Ident) -> Deep {
        let span = base.expr.span.to(name.span);
        self.node(ExprKind::Field(Box::new(base.expr), name), span, base.depth)
    }

    pub(crate) fn call(&mut self, module: Option<Ident>, name: Ident, args: Option<Args>, end: u32) -> Deep {
        let span = Span::new(module.unwrap_or(name).span.start, end);
        let (mut args, depth) = args.map_or((Vec::new(), 0), |args| (args.args, args.depth));
        args.shrink_to_fit();
        self.node(ExprKind::Call(Box::new(Call { module, name, args })), span, depth)
    }

    pub(crate) fn brace(&mut self, start: u32, mut items: Items, end: u32) -> Deep {
        items.items.shrink_to_fit();
        self.node(ExprKind::Brace(items.items), Span::new(start, end), items.depth)
    }

    pub(crate) fn assign(&mut self, target: Deep, op: Option<BinaryOp>, value: Deep) -> Deep {
        let span = target.expr.span.to(value.expr.span);
        let depth = target.depth.max(value.depth);
        self.node(ExprKind::Assign(op, Box::new((target.expr, value.expr))), span, depth)
    }

    fn binary(&mut self, left: Deep, op: BinaryOp, right: Deep) -> Deep {
        let span = left.expr.span.to(right.expr.span);
        let depth = left.depth.max(right.depth);
        self.node(ExprKind::Binary(op, Box::new((left.expr, right.expr))), span, depth)
    }

    /// Adds `op right` to the chain, after combining what binds at least as tightly as `op`.
    pub(crate) fn extend(&mut self, chain: &mut Chain, op: BinaryOp, right: Deep) {
        let mut left = std::mem::replace(&mut chain.last, right);
        while let Some((first, before)) = chain.open.pop_if(|(_, before)| binding(*before) >= binding(op)) {
            left = self.binary(first, before, left);
        }
        chain.open.push((left, op));
    }

    /// The tree of the whole chain.
    pub(crate) fn chain(&mut self, chain: Chain) -> Deep {
        let Chain { mut open, last } = chain;
        let mut right = last;
        while let Some((left, op)) = open.pop() {
            right = self.binary(left, op, right);
        }
        right
    }

    pub(crate) fn arg(&mut self, label: Option<Ident>, value: Deep, unit: Option<(Unit, Span)>) -> (Arg, u16) {
        (Arg { label, value: value.expr, unit }, value.depth)
    }

    pub(crate) fn instruction(&mut self, name: Ident, args: Option<Args>, mut events: Vec<(Expr, Expr)>) -> StmtKind {
        let mut args = args.map_or(Vec::new(), |args| args.args);
        args.shrink_to_fit();
        events.shrink_to_fit();
        StmtKind::Instr(Box::new(Instr { name, args, events }))
    }

    /// A variable with a start value; only a plain `=` may give one.
    pub(crate) fn var(&mut self, name: Ident, dims: Vec<Expr>, op: Option<BinaryOp>, init: Deep) -> Var {
        if op.is_some() {
            let before = Span::new(name.span.start, init.expr.span.start);
            let length = before.text(self.source).trim_end().len();
            let span = Span::new(before.start, before.start + length as u32);
            self.errors.push(SyntaxError::new(SyntaxErrorKind::CompoundStartValue, span));
        }
        Var { name, dims, init: Some(init.expr) }
    }

    pub(crate) fn for_line(&mut self, init: Option<Stmt>, condition: Option<Deep>, step: Option<Deep>) -> LineKind {
        let condition = condition.map(|condition| condition.expr);
        let step = step.map(|step| step.expr);
        LineKind::For(Box::new(For { init, condition, step, body: Vec::new() }))
    }

    pub(crate) fn import_line(&mut self, span: Span, path_span: Span) -> LineKind {
        LineKind::Import(Box::new(Import { path: self.string(path_span), span, path_span }))
    }

    /// The text of the string token at `span`, escapes resolved.
    pub(crate) fn string(&self, span: Span) -> Box<str> {
        let token = span.text(self.source);
        let inside = token.strip_prefix('"').unwrap_or(token);
        let inside = inside.strip_suffix('"').unwrap_or(inside);
        if inside.contains('\\') { resolve_escapes(inside).into() } else { inside.into() }
    }
}

/// The text with its escapes resolved; one that ARL does not have (reported already) stands for its character.
fn resolve_escapes(inside: &str) -> String {
    let mut text = String::with_capacity(inside.len());
    let mut chars = inside.chars();
    while let Some(c) = chars.next() {
        if c != '\\' {
            text.push(c);
            continue;
        }
        text.extend(chars.next().map(|escaped| match escaped {
            'n' => '\n',
            'r' => '\r',
            't' => '\t',
            other => other,
        }));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escapes() {
        assert_eq!(resolve_escapes(r#"a\n\r\t\"\\b"#), "a\n\r\t\"\\b");
    }
}
