//! `place op= value`, if Rust has the operator in this form with the meaning of ARL.

use crate::hir::{Expr, ExprKind, Place, Root, Value};
use arl_lang::ast::BinaryOp;
use arl_lang::catalog::Base;

/// Whether `place op= value` can be written as such in Rust.
pub(super) fn is_native(op: BinaryOp, place: &Place, value: &Expr) -> bool {
    use BinaryOp::*;
    let known = match &value.kind {
        ExprKind::Const(known) => Some(known),
        _ => None,
    };
    match (place.ty.base, op) {
        (Base::Double, Add | Subtract | Multiply | Divide) => true,
        (Base::Double, Remainder) => known.is_some_and(|known| *known != Value::Double(0.0)),
        (Base::Int | Base::Uint | Base::Byte, BitAnd | BitOr | BitXor) => true,
        (Base::Int | Base::Uint | Base::Byte, ShiftLeft | ShiftRight) => known.is_some(),
        (Base::Int | Base::Uint | Base::Byte, Divide | Remainder) => {
            known.is_some_and(|known| !matches!(known, Value::Int(0 | -1) | Value::Uint(0) | Value::Byte(0)))
        }
        _ => false,
    }
}

/// `x = x * 2.0` of a local variable is `x *= 2.0`.
pub(super) fn stepped<'p>(place: &Place, value: &'p Expr) -> Option<(BinaryOp, &'p Expr)> {
    let ExprKind::Binary(op, sides) = &value.kind else { return None };
    let ExprKind::Place(from) = &sides.0.kind else { return None };
    let same = matches!((place.root, from.root), (Root::Local(a), Root::Local(b)) if a == b)
        && place.path.is_empty()
        && from.path.is_empty();
    (same && is_native(*op, place, &sides.1)).then_some((*op, &sides.1))
}
