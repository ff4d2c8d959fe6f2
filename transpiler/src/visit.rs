//! Walks over the expressions of a checked program.

use crate::hir::{Expr, ExprKind, Passed, Place, Projection, Stmt, StmtKind};

/// Calls `see` for every expression in a statement, including inner statements; each expression comes before its parts.
pub(crate) fn exprs_in_stmt<'a, F: FnMut(&'a Expr)>(stmt: &'a Stmt, see: &mut F) {
    match &stmt.kind {
        StmtKind::Let(_, init) => init.iter().for_each(|init| exprs(init, see)),
        StmtKind::Eval(expr) => exprs(expr, see),
        StmtKind::If(arms, otherwise) => {
            for (condition, inner) in arms {
                exprs(condition, see);
                block(inner, see);
            }
            otherwise.iter().for_each(|inner| block(inner, see));
        }
        StmtKind::While(condition, inner, _) | StmtKind::Repeat(inner, condition, _) => {
            exprs(condition, see);
            block(inner, see);
        }
        StmtKind::Loop(inner, _) => block(inner, see),
        StmtKind::For(each) => {
            block(&each.init, see);
            each.condition.iter().chain(&each.step).for_each(|expr| exprs(expr, see));
            block(&each.body, see);
        }
        StmtKind::Switch(subject, arms) => {
            exprs(subject, see);
            arms.iter().for_each(|arm| block(&arm.body, see));
        }
        StmtKind::Return(value) => value.iter().for_each(|value| exprs(value, see)),
        StmtKind::Break | StmtKind::Continue | StmtKind::Goto(_) | StmtKind::Label(_) => {}
    }
}

/// Calls `see` for an expression and all its parts.
pub(crate) fn exprs<'a, F: FnMut(&'a Expr)>(expr: &'a Expr, see: &mut F) {
    see(expr);
    match &expr.kind {
        ExprKind::Const(_) | ExprKind::Splice(_) => {}
        ExprKind::Place(inner) | ExprKind::Step(_, inner) => place(inner, see),
        ExprKind::FieldOf(inner, ..)
        | ExprKind::Convert(inner)
        | ExprKind::Unary(_, inner)
        | ExprKind::Grown(inner) => {
            exprs(inner, see);
        }
        ExprKind::Binary(_, both) => {
            exprs(&both.0, see);
            exprs(&both.1, see);
        }
        ExprKind::Assign(both) | ExprKind::AssignOp(_, both) => {
            place(&both.0, see);
            exprs(&both.1, see);
        }
        ExprKind::Call(_, args) | ExprKind::Array(args) => args.iter().for_each(|arg| exprs(arg, see)),
        ExprKind::Builtin(builtin) => {
            for bound in &builtin.args {
                match &bound.value {
                    Passed::Value(value) => exprs(value, see),
                    Passed::Out(out) => place(out, see),
                }
            }
        }
        ExprKind::Struct(_, values) => values.iter().flatten().for_each(|value| exprs(value, see)),
    }
}

fn block<'a, F: FnMut(&'a Expr)>(stmts: &'a [Stmt], see: &mut F) {
    stmts.iter().for_each(|stmt| exprs_in_stmt(stmt, see));
}

fn place<'a, F: FnMut(&'a Expr)>(place: &'a Place, see: &mut F) {
    for step in &place.path {
        if let Projection::Index(indices, _) = step {
            indices.iter().for_each(|index| exprs(index, see));
        }
    }
}
