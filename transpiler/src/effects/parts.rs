//! The parts of expressions, and the locals that they write.

use crate::hir::{Expr, ExprKind, LocalId, Passed, Place, Projection, Root};

/// The expressions directly inside an expression, including those of its indices.
pub(crate) fn children(expr: &Expr) -> Vec<&Expr> {
    fn indices(place: &Place) -> impl Iterator<Item = &Expr> {
        place.path.iter().flat_map(|step| match step {
            Projection::Index(indices, _) => indices.as_slice(),
            Projection::Field(..) => &[],
        })
    }
    match &expr.kind {
        ExprKind::Const(_) | ExprKind::Splice(_) => Vec::new(),
        ExprKind::Place(place) | ExprKind::Step(_, place) => indices(place).collect(),
        ExprKind::FieldOf(inner, ..)
        | ExprKind::Convert(inner)
        | ExprKind::Unary(_, inner)
        | ExprKind::Grown(inner) => {
            vec![inner]
        }
        ExprKind::Binary(_, sides) => vec![&sides.0, &sides.1],
        ExprKind::Assign(sides) | ExprKind::AssignOp(_, sides) => {
            indices(&sides.0).chain(std::iter::once(&sides.1)).collect()
        }
        ExprKind::Call(_, values) | ExprKind::Array(values) => values.iter().collect(),
        ExprKind::Builtin(builtin) => {
            let mut all = Vec::new();
            for arg in &builtin.args {
                match &arg.value {
                    Passed::Value(value) => all.push(value),
                    Passed::Out(place) => all.extend(indices(place)),
                }
            }
            all
        }
        ExprKind::Struct(_, values) => values.iter().flatten().collect(),
    }
}

/// Adds the locals that an expression writes, including arguments that a built-in writes.
pub(crate) fn local_writes(expr: &Expr, out: &mut Vec<LocalId>) {
    let mut target = |place: &Place| {
        if let Root::Local(id) = place.root {
            out.push(id);
        }
    };
    match &expr.kind {
        ExprKind::Assign(sides) | ExprKind::AssignOp(_, sides) => target(&sides.0),
        ExprKind::Step(_, place) => target(place),
        ExprKind::Builtin(builtin) => {
            for arg in &builtin.args {
                if let Passed::Out(place) = &arg.value {
                    target(place);
                }
            }
        }
        _ => {}
    }
    children(expr).into_iter().for_each(|child| local_writes(child, out));
}
