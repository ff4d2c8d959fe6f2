//! Strings that could grow without limit. If a concatenation of strings is kept and one of its parts has no limit of
//! its own, its length is checked. A concatenation that is only read (printed, compared) needs no check: it consists of
//! a few strings, each within the maximum length.

use super::facts::{self, FactScope};
use super::loops;
use crate::hir::{Expr, ExprKind, LocalId, Passed, Place, Program, Projection, Root, Stmt, StmtKind, Value};
use arl_lang::ast::BinaryOp;
use arl_lang::catalog::Base;

/// Marks all such concatenations with [`ExprKind::Grown`].
pub(crate) fn mark(program: &mut Program) {
    let globals: Vec<bool> = program.globals.iter().map(|global| global.value.is_some()).collect();
    for func in &mut program.funcs {
        let locals: Vec<bool> = func.locals.iter().map(|local| local.value.is_some()).collect();
        Marker { globals: &globals, locals: &locals }.block(&mut func.body);
    }
}

/// Whether `place += value` makes a string longer.
pub(crate) fn appends(op: BinaryOp, place: &Place) -> bool {
    op == BinaryOp::Add && place.ty.base == Base::String && !place.ty.is_array()
}

/// The strings that `text = text + more + ..` appends, if the assignment amounts to appending them one by one.
pub(crate) fn appended<'p>(scope: FactScope<'_>, place: &Place, value: &'p Expr) -> Option<Vec<&'p Expr>> {
    if place.ty.base != Base::String || place.ty.is_array() || !place.path.is_empty() {
        return None;
    }
    let ExprKind::Grown(value) = &value.kind else { return None };
    let all = parts(value);
    let (first, more) = all.split_first()?;
    let ExprKind::Place(start) = &first.kind else { return None };
    let same = start.path.is_empty()
        && match (place.root, start.root) {
            (Root::Local(a), Root::Local(b)) => a == b,
            (Root::Global(a), Root::Global(b)) => a == b,
            (Root::System(a), Root::System(b)) => a.name == b.name,
            _ => false,
        };
    (same && !more.is_empty() && may_append(scope, place, more)).then(|| more.to_vec())
}

/// Whether the parts can be appended to a variable one by one: an alarm then names the length with the first part that
/// is too much.
pub(crate) fn may_append(scope: FactScope<'_>, place: &Place, parts: &[&Expr]) -> bool {
    let is_shared =
        |id: LocalId| scope.func.and_then(|func| func.locals.get(id.0 as usize)).is_some_and(|local| local.shared);
    place.path.is_empty()
        && parts.iter().all(|part| {
            let facts = facts::of_expr(scope, part);
            let untouched = match place.root {
                Root::Local(id) if !is_shared(id) => !facts.reads.contains(&id) && !facts.writes.contains(&id),
                _ => !facts.world && !facts.acts,
            };
            untouched && (parts.len() == 1 || facts.quiet())
        })
}

/// The parts of a sum of strings. A right operand that is a sum itself is one part: it is joined first.
pub(crate) fn parts(expr: &Expr) -> Vec<&Expr> {
    let mut parts = Vec::new();
    let mut rest = expr;
    while let ExprKind::Binary(BinaryOp::Add, sides) = &rest.kind
        && rest.ty.base == Base::String
    {
        parts.push(&sides.1);
        rest = &sides.0;
    }
    parts.push(rest);
    parts.reverse();
    parts
}

/// Which variables have known values, and therefore a limited length.
struct Marker<'a> {
    globals: &'a [bool],
    locals: &'a [bool],
}

impl Marker<'_> {
    fn block(&self, block: &mut [Stmt]) {
        block.iter_mut().for_each(|stmt| self.stmt(stmt));
    }

    fn stmt(&self, stmt: &mut Stmt) {
        match &mut stmt.kind {
            StmtKind::Let(_, value) | StmtKind::Return(value) => value.iter_mut().for_each(|value| self.kept(value)),
            StmtKind::Eval(expr)
            | StmtKind::While(expr, ..)
            | StmtKind::Repeat(_, expr, _)
            | StmtKind::Switch(expr, _) => {
                self.expr(expr);
            }
            StmtKind::If(arms, _) => arms.iter_mut().for_each(|(condition, _)| self.expr(condition)),
            StmtKind::For(each) => each.condition.iter_mut().chain(&mut each.step).for_each(|expr| self.expr(expr)),
            StmtKind::Loop(..) | StmtKind::Break | StmtKind::Continue | StmtKind::Goto(_) | StmtKind::Label(_) => {}
        }
        loops::inner_blocks(stmt).into_iter().for_each(|block| self.block(block));
    }

    /// An expression whose value is stored in a variable, passed to a function of the program, or returned by one.
    fn kept(&self, expr: &mut Expr) {
        self.expr(expr);
        let is_sum = matches!(&expr.kind, ExprKind::Binary(BinaryOp::Add, _));
        if is_sum && expr.ty.base == Base::String && self.is_unlimited(expr) {
            let sum = std::mem::replace(&mut expr.kind, ExprKind::Const(Value::Bool(false)));
            expr.kind = ExprKind::Grown(Box::new(Expr { kind: sum, ..*expr }));
        }
    }

    /// The parts of an expression.
    fn expr(&self, expr: &mut Expr) {
        match &mut expr.kind {
            ExprKind::Const(_) | ExprKind::Splice(_) => {}
            ExprKind::Place(place) | ExprKind::Step(_, place) => self.place(place),
            ExprKind::FieldOf(inner, ..)
            | ExprKind::Convert(inner)
            | ExprKind::Unary(_, inner)
            | ExprKind::Grown(inner) => self.expr(inner),
            ExprKind::Binary(_, sides) => {
                self.expr(&mut sides.0);
                self.expr(&mut sides.1);
            }
            ExprKind::Assign(sides) => {
                self.place(&mut sides.0);
                self.kept(&mut sides.1);
            }
            ExprKind::AssignOp(_, sides) => {
                self.place(&mut sides.0);
                self.expr(&mut sides.1);
            }
            ExprKind::Call(_, values) | ExprKind::Array(values) => values.iter_mut().for_each(|value| self.kept(value)),
            ExprKind::Struct(_, values) => values.iter_mut().flatten().for_each(|value| self.kept(value)),
            ExprKind::Builtin(builtin) => builtin.args.iter_mut().for_each(|arg| match &mut arg.value {
                Passed::Value(value) => self.expr(value),
                Passed::Out(place) => self.place(place),
            }),
        }
    }

    fn place(&self, place: &mut Place) {
        for step in &mut place.path {
            if let Projection::Index(indices, _) = step {
                indices.iter_mut().for_each(|index| self.expr(index));
            }
        }
    }

    /// Whether any of the strings in an expression may have any length.
    fn is_unlimited(&self, expr: &Expr) -> bool {
        match &expr.kind {
            ExprKind::Binary(_, sides) => self.is_unlimited(&sides.0) || self.is_unlimited(&sides.1),
            // Texts of numbers and other values are short, and no built-in function makes a string longer.
            ExprKind::Const(_) | ExprKind::Builtin(_) => false,
            ExprKind::Place(place) => {
                let known = match place.root {
                    Root::Local(id) => self.locals.get(id.0 as usize),
                    Root::Global(id) => self.globals.get(id.0 as usize),
                    Root::System(_) => None,
                };
                known != Some(&true)
            }
            _ => true,
        }
    }
}
