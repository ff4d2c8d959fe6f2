//! The values that integers may have, as far as the loops that count them show: an index that cannot leave its array
//! needs no check.

use super::{flow, loops};
use crate::hir::{Expr, ExprKind, For, Func, LocalId, Root, Stmt, StmtKind, Type, Value};
use arl_lang::ast::BinaryOp;
use arl_lang::catalog::Base;
use std::collections::HashMap;

/// A least and a greatest value.
type Interval = (i64, i64);

/// The values of the variables that are written only by loops that count them.
#[derive(Default, Debug)]
pub(crate) struct Ranges(HashMap<LocalId, Interval>);

impl Ranges {
    /// The ranges of a function.
    pub(crate) fn of_function(func: &Func) -> Self {
        let mut ranges = Self::default();
        ranges.block(&func.body);
        ranges
    }

    fn block(&mut self, block: &[Stmt]) {
        for stmt in block {
            if let StmtKind::For(each) = &stmt.kind
                && let Some(range) = loops::range(each)
                && let Some((least, greatest)) = limits(range.from.ty)
            {
                let from = self.interval(range.from).map_or(least, |(from, _)| from);
                // The variable does not reach `to`; if it may equal `to`, then `to` is not a limit of its type.
                let to = self.interval(range.to).map_or(greatest, |(_, to)| to) - i64::from(!range.beyond);
                self.0.insert(range.local, (from, to.max(from)));
            } else if let StmtKind::For(each) = &stmt.kind
                && let Some((local, range)) = self.climbing(each)
            {
                self.0.insert(local, range);
            }
            for inner in flow::blocks(stmt) {
                self.block(inner);
            }
        }
    }

    /// The values in the rounds of a loop whose variable rises to a constant in non-negative steps, and never so far
    /// that it wraps.
    fn climbing(&self, each: &For) -> Option<(LocalId, Interval)> {
        let head = loops::Head::of(each)?;
        let (least, greatest) = limits(head.from.ty)?;
        let (from, _) = self.interval(head.from).unwrap_or((least, greatest));
        let last = match head.op {
            BinaryOp::Less => loops::whole_number(head.to)? - 1,
            BinaryOp::LessEqual => loops::whole_number(head.to)?,
            _ => return None,
        };
        let (shortest, longest) = head.step.map_or(Some((1, 1)), |step| self.interval(step))?;
        (shortest >= 0 && last + longest <= greatest).then_some((head.local, (from, last.max(from))))
    }

    /// The maximum number of rounds of a loop whose variable rises from 0 or more to a constant in equal steps; `None`
    /// if unknown.
    pub(crate) fn most_rounds(&self, each: &For) -> Option<u64> {
        let head = loops::Head::of(each)?;
        let (_, (from, last)) = self.climbing(each)?;
        let equal = head.step.is_none_or(|step| self.is_counted(step));
        let (shortest, _) = head.step.map_or(Some((1, 1)), |step| self.interval(step))?;
        let known = equal && from >= 0 && shortest > 0 && head.from.ty.base == Base::Int;
        known.then(|| ((last - from) / shortest + 1).unsigned_abs())
    }

    /// The values of a variable that a loop counts.
    pub(crate) fn of_local(&self, id: LocalId) -> Option<Interval> {
        self.0.get(&id).copied()
    }

    /// Whether an expression is a constant or a variable that a loop counts.
    pub(crate) fn is_counted(&self, expr: &Expr) -> bool {
        match &expr.kind {
            ExprKind::Const(_) => true,
            ExprKind::Place(place) => match place.root {
                Root::Local(id) => place.path.is_empty() && self.0.contains_key(&id),
                _ => false,
            },
            _ => false,
        }
    }

    /// The values that an expression may have; `None` if too little is known.
    pub(crate) fn interval(&self, expr: &Expr) -> Option<Interval> {
        let limits = limits(expr.ty)?;
        let found = match &expr.kind {
            ExprKind::Const(Value::Int(value)) => (i64::from(*value), i64::from(*value)),
            ExprKind::Const(Value::Uint(value)) => (i64::from(*value), i64::from(*value)),
            ExprKind::Const(Value::Byte(value)) => (i64::from(*value), i64::from(*value)),
            ExprKind::Place(place) => match place.root {
                Root::Local(id) if place.path.is_empty() => *self.0.get(&id)?,
                _ => return own_limits(expr.ty),
            },
            ExprKind::Convert(inner) => self.interval(inner)?,
            ExprKind::Binary(op, sides) => {
                return self.operation(*op, &sides.0, &sides.1).filter(|it| is_within(*it, limits));
            }
            _ => return own_limits(expr.ty),
        };
        is_within(found, limits).then_some(found)
    }

    fn operation(&self, op: BinaryOp, left: &Expr, right: &Expr) -> Option<Interval> {
        let (left, right) = (self.interval(left), self.interval(right));
        match op {
            BinaryOp::Add => either(left, right, |left, right| (left.0 + right.0, left.1 + right.1)),
            BinaryOp::Subtract => either(left, right, |left, right| (left.0 - right.1, left.1 - right.0)),
            BinaryOp::Multiply => either(left, right, |left, right| {
                let corners = [left.0 * right.0, left.0 * right.1, left.1 * right.0, left.1 * right.1];
                (corners.into_iter().min().unwrap_or(i64::MIN), corners.into_iter().max().unwrap_or(i64::MAX))
            }),
            // A bitwise and with a non-negative number is at most that number.
            BinaryOp::BitAnd => match (left, right) {
                (Some((0.., most)), Some((0.., other))) => Some((0, most.min(other))),
                (Some((0.., most)), _) | (_, Some((0.., most))) => Some((0, most)),
                _ => None,
            },
            BinaryOp::Remainder => match (left, right?) {
                (Some((0.., most)), (1.., by)) => Some((0, most.min(by - 1))),
                _ => None,
            },
            BinaryOp::Divide => match (left?, right?) {
                ((least @ 0.., most), (from @ 1.., to)) => Some((least / to, most / from)),
                _ => None,
            },
            BinaryOp::ShiftRight => match (left?, right?) {
                ((least @ 0.., most), (count @ 0..=31, same)) if count == same => Some((least >> count, most >> count)),
                _ => None,
            },
            _ => None,
        }
    }

    /// Whether the indices cannot leave an array of this type.
    pub(crate) fn are_inside(&self, indices: &[Expr], array: Type) -> bool {
        indices.len() == array.dims().len()
            && indices.iter().zip(array.dims()).all(|(index, size)| {
                index.ty.base == Base::Int
                    && self.interval(index).is_some_and(|it| is_within(it, (0, i64::from(*size) - 1)))
            })
    }
}

fn either(
    left: Option<Interval>,
    right: Option<Interval>,
    both: impl Fn(Interval, Interval) -> Interval,
) -> Option<Interval> {
    Some(both(left?, right?))
}

fn is_within(inner: Interval, outer: Interval) -> bool {
    inner.0 >= outer.0 && inner.1 <= outer.1
}

/// The values of a type.
fn limits(ty: Type) -> Option<Interval> {
    match ty.base {
        _ if ty.is_array() => None,
        Base::Int => Some((i64::from(i32::MIN), i64::from(i32::MAX))),
        Base::Uint => Some((0, i64::from(u32::MAX))),
        Base::Byte => Some((0, 255)),
        _ => None,
    }
}

/// The values of a type if the type alone gives a useful limit: those of a byte.
fn own_limits(ty: Type) -> Option<Interval> {
    limits(ty).filter(|_| ty.base == Base::Byte)
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_lang::span::Span;

    fn int(value: i32) -> Expr {
        Expr { ty: Type::scalar(Base::Int), kind: ExprKind::Const(Value::Int(value)), span: Span::default() }
    }

    fn local(id: u32) -> Expr {
        let ty = Type::scalar(Base::Int);
        let place = crate::hir::Place { root: Root::Local(LocalId(id)), path: vec![], ty, span: Span::default() };
        Expr { ty, kind: ExprKind::Place(Box::new(place)), span: Span::default() }
    }

    fn op(op: BinaryOp, left: Expr, right: Expr) -> Expr {
        Expr { ty: left.ty, kind: ExprKind::Binary(op, Box::new((left, right))), span: Span::default() }
    }

    #[test]
    fn intervals_follow_the_operators() {
        use BinaryOp::*;
        let ranges = Ranges(HashMap::from([(LocalId(0), (0, 9)), (LocalId(1), (-3, 4))]));
        let interval = |expr: Expr| ranges.interval(&expr);
        assert_eq!(interval(op(Add, local(0), int(1))), Some((1, 10)));
        assert_eq!(interval(op(Subtract, int(9), local(0))), Some((0, 9)));
        assert_eq!(interval(op(Multiply, local(1), int(-2))), Some((-8, 6)));
        assert_eq!(interval(op(BitAnd, local(7), int(3))), Some((0, 3)));
        assert_eq!(interval(op(BitAnd, local(7), local(1))), None);
        assert_eq!(interval(op(Remainder, local(0), int(4))), Some((0, 3)));
        assert_eq!(interval(op(Remainder, local(1), int(4))), None, "the remainder of a negative number is negative");
        assert_eq!(interval(op(Divide, local(0), int(2))), Some((0, 4)));
        assert_eq!(interval(op(ShiftRight, local(0), int(1))), Some((0, 4)));
        assert_eq!(interval(op(Add, local(0), int(i32::MAX))), None, "it may wrap");
        assert_eq!(interval(local(7)), None);
        let array = Type::array(Base::Double, &[10, 4]).unwrap();
        assert!(ranges.are_inside(&[local(0), op(Remainder, local(0), int(4))], array));
        assert!(!ranges.are_inside(&[local(0), local(0)], array));
        assert!(!ranges.are_inside(&[local(1), int(0)], array));
    }
}
