//! Types of operators.

use super::context::{Body, Checker};
use super::convert::{Literal, Typed, fit, integer};
use super::fold::width;
use crate::diagnostics::constants::ConstantProblem;
use crate::diagnostics::types::TypeProblem;
use crate::hir::{Expr, ExprKind, Type, Value};
use arl_lang::ast::{BinaryOp, UnaryOp};
use arl_lang::catalog::{Base, Struct};
use arl_lang::span::Span;

const BOOL: Type = Type::scalar(Base::Bool);
const INT: Type = Type::scalar(Base::Int);

impl Checker<'_> {
    /// `left op right`
    pub(crate) fn binary(&mut self, body: &Body, op: BinaryOp, left: Typed, right: Typed, span: Span) -> Option<Typed> {
        for side in [&left, &right] {
            if side.expr.ty.base == Base::Void {
                return self.report_no_value(body, &side.expr);
            }
        }
        match op {
            BinaryOp::And | BinaryOp::Or => {
                let text = op.text();
                let what = format_args!("an operand of `{text}`");
                let left = self.coerce(body, left, BOOL, what);
                let right = self.coerce(body, right, BOOL, what);
                self.finish(body, op, left?, right?, Base::Bool, span)
            }
            BinaryOp::ShiftLeft | BinaryOp::ShiftRight => self.shift(body, op, left, right, span),
            _ => self.arithmetic(body, op, left, right, span),
        }
    }

    fn shift(&mut self, body: &Body, op: BinaryOp, left: Typed, right: Typed, span: Span) -> Option<Typed> {
        let left = self.number(left);
        let base = left.expr.ty.base;
        if left.expr.ty.is_array() || !matches!(base, Base::Int | Base::Uint | Base::Byte) {
            return self.operator_problem(body, op, &left, &right, span, None);
        }
        let right = self.number(right);
        if right.expr.ty.is_array() || !matches!(right.expr.ty.base, Base::Int | Base::Uint | Base::Byte) {
            return self.operator_problem(body, op, &left, &right, span, None);
        }
        // A uint that is no constant counts as it is: the result has the type of the left operand anyway.
        let count = match (right.expr.ty.base, right.value()) {
            (Base::Uint, None) => right.expr,
            _ => self.coerce(body, right, INT, "a shift count")?,
        };
        if let ExprKind::Const(Value::Int(count)) = count.kind
            && !(0..width(base) as i32).contains(&count)
        {
            let most = width(base) - 1;
            return self.report(body, span, ConstantProblem::ShiftCount { count: i64::from(count), most });
        }
        self.finish(body, op, left.expr, count, base, span)
    }

    fn arithmetic(&mut self, body: &Body, op: BinaryOp, left: Typed, right: Typed, span: Span) -> Option<Typed> {
        let (left_ty, right_ty) = (left.expr.ty, right.expr.ty);
        if left_ty.is_array() || right_ty.is_array() {
            if op.compares() {
                let ty = self.type_name(if left_ty.is_array() { left_ty } else { right_ty });
                return self.report(body, span, TypeProblem::Compare { ty });
            }
            return self.operator_problem(body, op, &left, &right, span, Some("work on the elements one by one"));
        }
        match (left_ty.base, right_ty.base) {
            (Base::String, Base::String) if op == BinaryOp::Add || op.compares() => {
                let base = if op.compares() { Base::Bool } else { Base::String };
                self.finish(body, op, left.expr, right.expr, base, span)
            }
            (Base::String, _) | (_, Base::String) => {
                let hint = (op == BinaryOp::Add).then_some("make a text of the other operand with `tostr(...)`");
                self.operator_problem(body, op, &left, &right, span, hint)
            }
            (Base::Struct(a), Base::Struct(b)) => match structure_operator(op, a, b) {
                Some(result) => self.finish(body, op, left.expr, right.expr, Base::Struct(result), span),
                None if op.compares() => {
                    let ty = self.type_name(left_ty);
                    self.report(body, span, TypeProblem::Compare { ty })
                }
                None => self.operator_problem(body, op, &left, &right, span, None),
            },
            (Base::Bool, _) | (_, Base::Bool) => self.compare_bools(body, op, left, right, span),
            _ => self.numbers(body, op, left, right, span),
        }
    }

    fn compare_bools(&mut self, body: &Body, op: BinaryOp, left: Typed, right: Typed, span: Span) -> Option<Typed> {
        let comparable = |typed: &Typed| matches!(typed.expr.ty.base, Base::Bool | Base::Int | Base::Byte);
        let equality = matches!(op, BinaryOp::Equal | BinaryOp::NotEqual);
        if !equality || !comparable(&left) || !comparable(&right) {
            let hint = match op {
                BinaryOp::BitAnd => Some("`&&` combines conditions"),
                BinaryOp::BitOr => Some("`||` combines conditions"),
                BinaryOp::BitXor => Some("`!=` tells whether two conditions differ"),
                _ => None,
            };
            return self.operator_problem(body, op, &left, &right, span, hint);
        }
        let left = self.coerce(body, left, BOOL, "an operand")?;
        let right = self.coerce(body, right, BOOL, "an operand")?;
        self.finish(body, op, left, right, Base::Bool, span)
    }

    fn numbers(&mut self, body: &Body, op: BinaryOp, left: Typed, right: Typed, span: Span) -> Option<Typed> {
        let left = self.number(left);
        let right = self.number(right);
        let Some(base) = common(&left, &right) else {
            let mixed = [left.expr.ty.base, right.expr.ty.base];
            let hint = (mixed.contains(&Base::Uint) && mixed.contains(&Base::Int))
                .then_some("uint and int do not mix: convert one of them through a double, or use constants that fit");
            return self.operator_problem(body, op, &left, &right, span, hint);
        };
        let bits = matches!(op, BinaryOp::BitAnd | BinaryOp::BitOr | BinaryOp::BitXor);
        if bits && base == Base::Double {
            return self.operator_problem(body, op, &left, &right, span, Some("bits are those of int, uint and byte"));
        }
        let divides = matches!(op, BinaryOp::Divide | BinaryOp::Remainder);
        let by_literal_zero = matches!(right.value(), Some(Value::Double(zero)) if *zero == 0.0)
            || right.value().and_then(integer) == Some(0);
        let ty = Type::scalar(base);
        let left = self.coerce(body, left, ty, "an operand")?;
        let right = self.coerce(body, right, ty, "an operand")?;
        if divides && by_literal_zero {
            if base != Base::Double || op == BinaryOp::Remainder {
                return self.report(body, span, ConstantProblem::DivideByZero);
            }
            self.report::<()>(body, span, ConstantProblem::DoubleByZero);
        }
        let result = if op.compares() { Base::Bool } else { base };
        self.finish(body, op, left, right, result, span)
    }

    /// Enumerations count as int where an operator meets them.
    fn number(&self, typed: Typed) -> Typed {
        if !matches!(typed.expr.ty.base, Base::Enum(_)) || typed.expr.ty.is_array() {
            return typed;
        }
        let span = typed.expr.span;
        if let Some(Value::Enum(_, index)) = typed.value() {
            let kind = ExprKind::Const(Value::Int(i32::from(*index)));
            return Typed::plain(Expr { ty: INT, kind, span });
        }
        Typed::plain(Expr { ty: INT, kind: ExprKind::Convert(Box::new(typed.expr)), span })
    }

    /// The finished operator; constant operands are computed.
    fn finish(
        &mut self,
        body: &Body,
        op: BinaryOp,
        left: Expr,
        right: Expr,
        result: Base,
        span: Span,
    ) -> Option<Typed> {
        let ty = Type::scalar(result);
        if let (ExprKind::Const(a), ExprKind::Const(b)) = (&left.kind, &right.kind)
            && let Ok(Some(value)) = self.fold_binary(body, op, a, b, span)
        {
            return Some(Typed::plain(Expr { ty, kind: ExprKind::Const(value), span }));
        }
        let kind = ExprKind::Binary(op, Box::new((left, right)));
        Some(Typed::plain(Expr { ty, kind, span }))
    }

    /// `op operand`
    pub(crate) fn unary(&mut self, body: &Body, op: UnaryOp, operand: Typed, span: Span) -> Option<Typed> {
        if operand.expr.ty.base == Base::Void {
            return self.report_no_value(body, &operand.expr);
        }
        if op == UnaryOp::Not {
            let operand = self.coerce(body, operand, BOOL, "the operand of `!`")?;
            return self.finish_unary(body, op, Typed::plain(operand), span);
        }
        let operand = self.number(operand);
        if op == UnaryOp::Negate && operand.literal == Literal::Wide {
            // 2147483648 alone is beyond int, but its negative is not.
            if let Some(Value::Uint(0x8000_0000)) = operand.value() {
                return Some(Typed::plain(Expr { ty: INT, kind: ExprKind::Const(Value::Int(i32::MIN)), span }));
            }
            let text = self.text(body.module, operand.expr.span).to_string();
            return self.report(body, operand.expr.span, TypeProblem::WideLiteral { text });
        }
        let ty = operand.expr.ty;
        match (op, ty.base) {
            _ if ty.is_array() => self.unary_problem(body, op, ty, span, None),
            (UnaryOp::Negate, Base::Byte) => {
                let operand = self.coerce(body, operand, INT, "the operand of `-`")?;
                self.finish_unary(body, op, Typed::plain(operand), span)
            }
            (UnaryOp::Negate, Base::Int | Base::Double | Base::Struct(Struct::Joint))
            | (UnaryOp::Complement, Base::Int | Base::Uint | Base::Byte) => self.finish_unary(body, op, operand, span),
            (UnaryOp::Negate, Base::Uint) => {
                self.unary_problem(body, op, ty, span, Some("a uint has no sign: keep the value in an int or a double"))
            }
            _ => self.unary_problem(body, op, ty, span, None),
        }
    }

    fn finish_unary(&mut self, body: &Body, op: UnaryOp, operand: Typed, span: Span) -> Option<Typed> {
        let ty = operand.expr.ty;
        if let Some(value) = operand.value()
            && let Some(value) = self.fold_unary(body, op, &value.clone(), span)
        {
            let complement = op == UnaryOp::Complement && operand.literal == Literal::Pattern;
            let literal = if complement { Literal::Complement } else { Literal::None };
            return Some(Typed { expr: Expr { ty, kind: ExprKind::Const(value), span }, literal });
        }
        Some(Typed::plain(Expr { ty, kind: ExprKind::Unary(op, Box::new(operand.expr)), span }))
    }

    fn unary_problem<T>(&mut self, body: &Body, op: UnaryOp, ty: Type, span: Span, hint: Option<&str>) -> Option<T> {
        let problem = TypeProblem::Operator {
            operator: op.text().into(),
            left: self.type_name(ty),
            right: None,
            hint: hint.map(Into::into),
        };
        self.report(body, span, problem)
    }

    fn operator_problem<T>(
        &mut self,
        body: &Body,
        op: BinaryOp,
        left: &Typed,
        right: &Typed,
        span: Span,
        hint: Option<&str>,
    ) -> Option<T> {
        let problem = TypeProblem::Operator {
            operator: op.text().into(),
            left: self.type_name(left.expr.ty),
            right: Some(self.type_name(right.expr.ty)),
            hint: hint.map(Into::into),
        };
        self.report(body, span, problem)
    }
}

/// The type that both numbers are brought to; `None` where they do not mix.
fn common(left: &Typed, right: &Typed) -> Option<Base> {
    let (a, b) = (left.expr.ty.base, right.expr.ty.base);
    let number = |base| matches!(base, Base::Byte | Base::Int | Base::Uint | Base::Double);
    if !number(a) || !number(b) {
        return None;
    }
    if a == b {
        return Some(a);
    }
    if a == Base::Double || b == Base::Double {
        return Some(Base::Double);
    }
    // A constant takes the type of the other operand where it fits; of two constants the int gives way.
    let gives_way = |constant: &Typed, other: &Typed| {
        let value = constant.value()?;
        if other.value().is_some() && constant.expr.ty.base != Base::Int {
            return None;
        }
        fit(value, constant.literal, other.expr.ty.base).map(|_| other.expr.ty.base)
    };
    if let Some(base) = gives_way(left, right).or_else(|| gives_way(right, left)) {
        return Some(base);
    }
    match (a, b) {
        (Base::Byte, Base::Int) | (Base::Int, Base::Byte) => Some(Base::Int),
        (Base::Byte, Base::Uint) | (Base::Uint, Base::Byte) => Some(Base::Uint),
        _ => None,
    }
}

/// What an operator makes of two structures.
fn structure_operator(op: BinaryOp, left: Struct, right: Struct) -> Option<Struct> {
    match (op, left, right) {
        (BinaryOp::Add | BinaryOp::Subtract, Struct::Joint, Struct::Joint) => Some(Struct::Joint),
        (BinaryOp::Multiply, Struct::Frame, Struct::Frame) => Some(Struct::Frame),
        (BinaryOp::Multiply, Struct::Frame | Struct::Pose, Struct::Frame | Struct::Pose) => Some(Struct::Pose),
        _ => None,
    }
}
