//! Types of operators.

use super::context::{CheckedBody, Checker};
use super::convert::Typed;
use crate::diagnostics::constants::ConstantProblem;
use crate::diagnostics::types::TypeProblem;
use crate::hir::{Expr, ExprKind, Type, Value};
use crate::operators::{self, Computed, Literal, integer, width};
use arl_lang::ast::{BinaryOp, UnaryOp};
use arl_lang::catalog::Base;
use arl_lang::span::Span;

const BOOL: Type = Type::scalar(Base::Bool);
const INT: Type = Type::scalar(Base::Int);

impl Checker<'_> {
    /// `left op right`
    pub(crate) fn binary(
        &mut self,
        body: &CheckedBody,
        op: BinaryOp,
        left: Typed,
        right: Typed,
        span: Span,
    ) -> Option<Typed> {
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

    fn shift(&mut self, body: &CheckedBody, op: BinaryOp, left: Typed, right: Typed, span: Span) -> Option<Typed> {
        let (left, right) = (self.number(left), self.number(right));
        let is_array = left.expr.ty.is_array() || right.expr.ty.is_array();
        let operation = operators::binary(op, left.operand(), right.operand()).filter(|_| !is_array);
        let Some(operation) = operation else { return self.operator_problem(body, op, &left, &right, span, None) };
        let count = self.coerce(body, right, Type::scalar(operation.right), "a shift count")?;
        let base = operation.left;
        if let ExprKind::Const(Value::Int(count)) = count.kind
            && !(0..width(base) as i32).contains(&count)
        {
            let most = width(base) - 1;
            return self.report(body, span, ConstantProblem::ShiftCount { count: i64::from(count), most });
        }
        self.finish(body, op, left.expr, count, operation.result, span)
    }

    fn arithmetic(&mut self, body: &CheckedBody, op: BinaryOp, left: Typed, right: Typed, span: Span) -> Option<Typed> {
        let (left_ty, right_ty) = (left.expr.ty, right.expr.ty);
        if left_ty.is_array() || right_ty.is_array() {
            if op.compares() {
                let ty = self.type_name(if left_ty.is_array() { left_ty } else { right_ty });
                return self.report(body, span, TypeProblem::Compare { ty });
            }
            return self.operator_problem(body, op, &left, &right, span, Some("work on the elements one by one"));
        }
        let operation = operators::binary(op, left.operand(), right.operand());
        let bases = (left_ty.base, right_ty.base);
        if let Some(operation) = operation
            && matches!(bases, (Base::String, Base::String) | (Base::Struct(_), Base::Struct(_)))
        {
            return self.finish(body, op, left.expr, right.expr, operation.result, span);
        }
        match bases {
            (Base::String, _) | (_, Base::String) => {
                let hint = (op == BinaryOp::Add).then_some("make a text of the other operand with `tostr(...)`");
                self.operator_problem(body, op, &left, &right, span, hint)
            }
            (Base::Struct(_), Base::Struct(_)) if op.compares() => {
                let ty = self.type_name(left_ty);
                self.report(body, span, TypeProblem::Compare { ty })
            }
            (Base::Struct(_), Base::Struct(_)) => self.operator_problem(body, op, &left, &right, span, None),
            (Base::Bool, _) | (_, Base::Bool) => self.compare_bools(body, op, left, right, span),
            _ => self.numbers(body, op, left, right, span),
        }
    }

    fn compare_bools(
        &mut self,
        body: &CheckedBody,
        op: BinaryOp,
        left: Typed,
        right: Typed,
        span: Span,
    ) -> Option<Typed> {
        if operators::binary(op, left.operand(), right.operand()).is_none() {
            let hint = match op {
                BinaryOp::BitAnd => Some("`&&` combines conditions"),
                BinaryOp::BitOr => Some("`||` combines conditions"),
                BinaryOp::BitXor => Some("`!=` is true where two conditions differ"),
                _ => None,
            };
            return self.operator_problem(body, op, &left, &right, span, hint);
        }
        let left = self.coerce(body, left, BOOL, "an operand")?;
        let right = self.coerce(body, right, BOOL, "an operand")?;
        self.finish(body, op, left, right, Base::Bool, span)
    }

    fn numbers(&mut self, body: &CheckedBody, op: BinaryOp, left: Typed, right: Typed, span: Span) -> Option<Typed> {
        let left = self.number(left);
        let right = self.number(right);
        let Some(operation) = operators::binary(op, left.operand(), right.operand()) else {
            let bases = [left.expr.ty.base, right.expr.ty.base];
            let bits = matches!(op, BinaryOp::BitAnd | BinaryOp::BitOr | BinaryOp::BitXor);
            let numbers = bases.iter().all(|base| matches!(base, Base::Byte | Base::Int | Base::Uint | Base::Double));
            let hint = if bits && numbers && bases.contains(&Base::Double) {
                Some("bit operators work on int, uint and byte only")
            } else if bases.contains(&Base::Uint) && bases.contains(&Base::Int) {
                Some("uint and int do not mix: convert one of them through a double, or use constants that fit")
            } else {
                None
            };
            return self.operator_problem(body, op, &left, &right, span, hint);
        };
        let divides = matches!(op, BinaryOp::Divide | BinaryOp::Remainder);
        let by_literal_zero = matches!(right.value(), Some(Value::Double(zero)) if *zero == 0.0)
            || right.value().and_then(integer) == Some(0);
        let left = self.coerce(body, left, Type::scalar(operation.left), "an operand")?;
        let right = self.coerce(body, right, Type::scalar(operation.right), "an operand")?;
        if divides && by_literal_zero {
            if operation.left != Base::Double || op == BinaryOp::Remainder {
                return self.report(body, span, ConstantProblem::DivideByZero);
            }
            self.report::<()>(body, span, ConstantProblem::DoubleByZero);
        }
        self.finish(body, op, left, right, operation.result, span)
    }

    /// Converts an enumeration to int, as operators do.
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

    /// The finished operator expression; constant operands are computed.
    fn finish(
        &mut self,
        body: &CheckedBody,
        op: BinaryOp,
        left: Expr,
        right: Expr,
        result: Base,
        span: Span,
    ) -> Option<Typed> {
        let ty = Type::scalar(result);
        if let (ExprKind::Const(a), ExprKind::Const(b)) = (&left.kind, &right.kind)
            // An alarm has been reported already.
            && let Ok(Some(computed)) = operators::compute(op, a, b)
        {
            let value = self.warn_if_wrapped(body, computed, span);
            return Some(Typed::plain(Expr { ty, kind: ExprKind::Const(value), span }));
        }
        let kind = ExprKind::Binary(op, Box::new((left, right)));
        Some(Typed::plain(Expr { ty, kind, span }))
    }

    /// `op operand`
    pub(crate) fn unary(&mut self, body: &CheckedBody, op: UnaryOp, operand: Typed, span: Span) -> Option<Typed> {
        if operand.expr.ty.base == Base::Void {
            return self.report_no_value(body, &operand.expr);
        }
        if op == UnaryOp::Not {
            let operand = self.coerce(body, operand, BOOL, "the operand of `!`")?;
            return self.finish_unary(body, op, Typed::plain(operand), Base::Bool, span);
        }
        let operand = self.number(operand);
        let ty = operand.expr.ty;
        let taken = operators::unary(op, operand.operand()).filter(|_| !ty.is_array());
        if op == UnaryOp::Negate && operand.literal == Literal::Wide && taken.is_none() {
            let text = self.text(body.module, operand.expr.span).to_string();
            return self.report(body, operand.expr.span, TypeProblem::WideLiteral { text });
        }
        let Some([wanted, result]) = taken else {
            let hint = (op == UnaryOp::Negate && ty == Type::scalar(Base::Uint))
                .then_some("a uint has no sign: keep the value in an int or a double");
            return self.unary_problem(body, op, ty, span, hint);
        };
        let operand = if ty == Type::scalar(wanted) {
            operand
        } else {
            Typed::plain(self.coerce(body, operand, Type::scalar(wanted), "the operand of `-`")?)
        };
        self.finish_unary(body, op, operand, result, span)
    }

    fn finish_unary(
        &mut self,
        body: &CheckedBody,
        op: UnaryOp,
        operand: Typed,
        result: Base,
        span: Span,
    ) -> Option<Typed> {
        let ty = Type::scalar(result);
        if let Some(computed) = operand.value().and_then(|value| operators::compute_unary(op, value)) {
            let value = self.warn_if_wrapped(body, computed, span);
            let complement = op == UnaryOp::Complement && operand.literal == Literal::Pattern;
            let literal = if complement { Literal::Complement } else { Literal::None };
            return Some(Typed { expr: Expr { ty, kind: ExprKind::Const(value), span }, literal });
        }
        Some(Typed::plain(Expr { ty, kind: ExprKind::Unary(op, Box::new(operand.expr)), span }))
    }

    /// The value, with a warning if it has wrapped.
    fn warn_if_wrapped(&mut self, body: &CheckedBody, computed: Computed, span: Span) -> Value {
        let Computed { value, wrapped } = computed;
        if wrapped {
            let text = integer(&value).unwrap_or_default().to_string();
            let ty = self.base_name(value.base());
            self.report::<()>(body, span, ConstantProblem::Overflow { ty, value: text });
        }
        value
    }

    fn unary_problem<T>(
        &mut self,
        body: &CheckedBody,
        op: UnaryOp,
        ty: Type,
        span: Span,
        hint: Option<&str>,
    ) -> Option<T> {
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
        body: &CheckedBody,
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
