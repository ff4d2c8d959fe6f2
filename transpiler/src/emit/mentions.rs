//! Mentions of locals.

use crate::effects::flow;
use crate::effects::parts::children;
use crate::hir::{Expr, ExprKind, LocalId, Passed, Place, Projection, Root, Stmt};

/// Whether a statement mentions a local.
pub(super) fn in_statement(stmt: &Stmt, id: LocalId) -> bool {
    flow::expressions(stmt).any(|expr| in_expression(expr, id))
        || flow::blocks(stmt).any(|block| block.iter().any(|stmt| in_statement(stmt, id)))
}

/// Whether an expression mentions a local.
pub(super) fn in_expression(expr: &Expr, id: LocalId) -> bool {
    let is_it = |place: &Place| matches!(place.root, Root::Local(other) if other == id);
    let own = match &expr.kind {
        ExprKind::Place(place) | ExprKind::Step(_, place) => is_it(place),
        ExprKind::Assign(sides) | ExprKind::AssignOp(_, sides) => is_it(&sides.0),
        ExprKind::Builtin(builtin) => builtin.args.iter().any(|arg| match &arg.value {
            Passed::Out(place) => is_it(place),
            Passed::Value(_) => false,
        }),
        _ => false,
    };
    own || children(expr).into_iter().any(|child| in_expression(child, id))
}

/// Calls `see` for each mention of a local in a statement.
pub(super) fn each_local(stmt: &Stmt, see: &mut dyn FnMut(LocalId)) {
    flow::expressions(stmt).for_each(|expr| each_local_in(expr, see));
    flow::blocks(stmt).flatten().for_each(|stmt| each_local(stmt, see));
}

fn each_local_in(expr: &Expr, see: &mut dyn FnMut(LocalId)) {
    let mut root = |place: &Place| {
        if let Root::Local(id) = place.root {
            see(id);
        }
    };
    match &expr.kind {
        ExprKind::Place(place) | ExprKind::Step(_, place) => root(place),
        ExprKind::Assign(sides) | ExprKind::AssignOp(_, sides) => root(&sides.0),
        ExprKind::Builtin(builtin) => builtin.args.iter().for_each(|arg| match &arg.value {
            Passed::Out(place) => root(place),
            Passed::Value(_) => {}
        }),
        _ => {}
    }
    children(expr).into_iter().for_each(|child| each_local_in(child, see));
}

/// The index expressions of a place.
pub(super) fn indices(place: &Place) -> impl Iterator<Item = &Expr> {
    place.path.iter().flat_map(|step| match step {
        Projection::Index(indices, _) => indices.as_slice(),
        Projection::Field(..) => &[],
    })
}
