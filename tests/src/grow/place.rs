//! Places: variables, elements and components that can be read and written.

use super::Grower;
use super::constant::int;
use crate::tree::{Expr, Kind, Op, Unary, Var};
use crate::value::{Base, Type, components};

impl Grower {
    /// A place of exactly this type; one that may be written where `written`.
    pub(super) fn place(&mut self, ty: Type, written: bool, depth: usize) -> Option<Expr> {
        let visible = self.visible();
        let count = visible.len();
        let from = self.random.below(count.max(1));
        let direct = self.random.chance(60);
        for turn in 0..2 {
            for at in 0..count {
                let (var, hidden) = visible[(from + at) % count];
                if written && !self.may_write(var) {
                    continue;
                }
                let found = self.variable(var).ty;
                // First what was drawn, then the other kind.
                if (direct == (turn == 0)) && found == ty {
                    return Some(self.var(var, hidden));
                }
                if (direct != (turn == 0)) && (found.is_array() || matches!(found.base, Base::Struct(_))) {
                    let whole = self.var(var, hidden);
                    if let Some(place) = self.inside(whole, ty, depth) {
                        return Some(place);
                    }
                }
            }
        }
        None
    }

    pub(super) fn may_write(&self, var: Var) -> bool {
        let guarded = matches!(var, Var::Local(local) if self.guards.contains(&local));
        !guarded && !self.variable(var).constant
    }

    /// A part of this type inside a place.
    fn inside(&mut self, whole: Expr, ty: Type, depth: usize) -> Option<Expr> {
        if whole.ty == ty {
            return Some(whole);
        }
        if whole.ty.is_array() {
            let element = Type::one(whole.ty.base);
            if ty.is_array() || (ty != element && !has(element.base, ty.base)) {
                return None;
            }
            let mut indices = Vec::new();
            for size in whole.ty.sizes.into_iter().filter(|size| *size > 0) {
                indices.push(self.index(size, depth));
            }
            let element = Expr::new(Kind::Index(Box::new(whole), indices), element);
            return self.inside(element, ty, depth);
        }
        let Base::Struct(number) = whole.ty.base else { return None };
        if ty.is_array() || !has(whole.ty.base, ty.base) {
            return None;
        }
        let good: Vec<usize> = (0..components(number).len())
            .filter(|at| components(number)[*at].1 == ty.base || has(components(number)[*at].1, ty.base))
            .collect();
        let at = *self.random.pick(&good);
        let part = Expr::one(Kind::Component(Box::new(whole), at), components(number)[at].1);
        self.inside(part, ty, depth)
    }

    /// An index for a size.
    pub(super) fn index(&mut self, size: usize, depth: usize) -> Expr {
        if depth == 0 || self.random.chance(40) {
            return self.small(size);
        }
        let number = self.like(Base::Int, depth - 1);
        if self.random.chance(self.risk) && number.constant.is_none() {
            return number;
        }
        if size.is_power_of_two() {
            let mask = int(size as i32 - 1);
            if let Some(index) = self.binary(Op::BitAnd, number.clone(), mask)
                && matches!(index.ty.base, Base::Int | Base::Byte)
            {
                return index;
            }
        } else if let Some(rest) = self.binary(Op::Rem, number, int(size as i32))
            && rest.constant.is_none()
            && rest.ty.base == Base::Int
        {
            let sum = self.binary(Op::Add, rest, int(size as i32)).expect("ints");
            return self.binary(Op::Rem, sum, int(size as i32)).expect("ints");
        }
        self.small(size)
    }

    /// Parentheses that change nothing, now and then.
    pub(super) fn perhaps_parentheses(&mut self, expr: Expr) -> Expr {
        if !self.random.chance(6) || matches!(expr.kind, Kind::List(_) | Kind::Named(_)) {
            return expr;
        }
        let (ty, constant, pattern) = (expr.ty, expr.constant.clone(), expr.pattern);
        Expr { kind: Kind::Paren(Box::new(expr)), ty, constant, pattern }
    }

    /// The operator applied, computed where the operand is constant.
    pub(super) fn unary(&mut self, op: Unary, inner: Expr) -> Option<Expr> {
        let (result, operand) = crate::operators::typed_unary(op, &inner)?;
        let value =
            inner.constant.clone().map(|value| crate::operators::unary(op, crate::value::convert(value, operand)));
        let pattern = op == Unary::Complement && inner.pattern && !inner.is_complement();
        Some(Expr { kind: Kind::Unary(op, Box::new(inner)), ty: Type::one(result), constant: value, pattern })
    }
}

/// Whether values of a type have parts of another.
fn has(whole: Base, part: Base) -> bool {
    let Base::Struct(number) = whole else { return false };
    components(number).iter().any(|component| component.1 == part || has(component.1, part))
}
