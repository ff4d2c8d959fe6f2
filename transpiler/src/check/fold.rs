//! Computes constant expressions, as the program would at run time.

use super::context::{Body, Checker};
use crate::diagnostics::constants::ConstantProblem;
use crate::hir::Value;
use arl_lang::ast::{BinaryOp, UnaryOp};
use arl_lang::catalog::Base;
use arl_lang::span::Span;

/// The bits of a shiftable type.
pub(crate) const fn width(base: Base) -> u32 {
    if matches!(base, Base::Byte) { 8 } else { 32 }
}

impl Checker<'_> {
    /// The value of `left op right`, both of one type (shifts: an int count). `None` where it is left to run time.
    /// Reports division by zero and shift counts out of range; `Err` then.
    pub(crate) fn fold_binary(
        &mut self,
        body: &Body,
        op: BinaryOp,
        left: &Value,
        right: &Value,
        span: Span,
    ) -> Result<Option<Value>, ()> {
        Ok(match (left, right) {
            (Value::Bool(a), Value::Bool(b)) => fold_bool(op, *a, *b).map(Value::Bool),
            (Value::Double(a), Value::Double(b)) => fold_double(op, *a, *b),
            (Value::String(a), Value::String(b)) => match op {
                BinaryOp::Add => Some(Value::String(format!("{a}{b}").into())),
                _ => compare(op, a.as_bytes().cmp(b.as_bytes())).map(Value::Bool),
            },
            (Value::Int(a), Value::Int(b)) => {
                self.fold_integer(body, op, Base::Int, i64::from(*a), i64::from(*b), span)?
            }
            (Value::Uint(a), Value::Uint(b)) => {
                self.fold_integer(body, op, Base::Uint, i64::from(*a), i64::from(*b), span)?
            }
            (Value::Byte(a), Value::Byte(b)) => {
                self.fold_integer(body, op, Base::Byte, i64::from(*a), i64::from(*b), span)?
            }
            (Value::Uint(a), Value::Int(b)) => {
                self.fold_integer(body, op, Base::Uint, i64::from(*a), i64::from(*b), span)?
            }
            (Value::Byte(a), Value::Int(b)) => {
                self.fold_integer(body, op, Base::Byte, i64::from(*a), i64::from(*b), span)?
            }
            _ => None,
        })
    }

    fn fold_integer(
        &mut self,
        body: &Body,
        op: BinaryOp,
        base: Base,
        left: i64,
        right: i64,
        span: Span,
    ) -> Result<Option<Value>, ()> {
        let exact = match op {
            BinaryOp::Add => left + right,
            BinaryOp::Subtract => left - right,
            BinaryOp::Multiply => left.wrapping_mul(right),
            BinaryOp::Divide | BinaryOp::Remainder if right == 0 => return Err(()),
            BinaryOp::Divide => left / right,
            BinaryOp::Remainder => left % right,
            BinaryOp::ShiftLeft | BinaryOp::ShiftRight if !(0..i64::from(width(base))).contains(&right) => {
                return Err(());
            }
            BinaryOp::ShiftLeft => return Ok(Some(wrap(base, left << right))),
            BinaryOp::ShiftRight => return Ok(Some(wrap(base, left >> right))),
            BinaryOp::BitAnd => left & right,
            BinaryOp::BitOr => left | right,
            BinaryOp::BitXor => return Ok(Some(wrap(base, left ^ right))),
            BinaryOp::And | BinaryOp::Or => return Ok(None),
            _ => return Ok(compare(op, left.cmp(&right)).map(Value::Bool)),
        };
        Ok(Some(self.wrapped(body, base, exact, span)))
    }

    /// The value as the type holds it, with a warning where it had to wrap.
    pub(crate) fn wrapped(&mut self, body: &Body, base: Base, exact: i64, span: Span) -> Value {
        let value = wrap(base, exact);
        let held = super::convert::integer(&value);
        if held != Some(exact) {
            let value = held.unwrap_or_default().to_string();
            let ty = self.base_name(base);
            self.report::<()>(body, span, ConstantProblem::Overflow { ty, value });
        }
        value
    }

    /// The value of `op operand`.
    pub(crate) fn fold_unary(&mut self, body: &Body, op: UnaryOp, operand: &Value, span: Span) -> Option<Value> {
        match (op, operand) {
            (UnaryOp::Negate, Value::Int(value)) => Some(self.wrapped(body, Base::Int, -i64::from(*value), span)),
            (UnaryOp::Negate, Value::Double(value)) => Some(Value::Double(-value)),
            (UnaryOp::Not, Value::Bool(value)) => Some(Value::Bool(!value)),
            (UnaryOp::Complement, Value::Int(value)) => Some(Value::Int(!value)),
            (UnaryOp::Complement, Value::Uint(value)) => Some(Value::Uint(!value)),
            (UnaryOp::Complement, Value::Byte(value)) => Some(Value::Byte(!value)),
            _ => None,
        }
    }
}

/// The lowest bits of a number as a value of the type.
fn wrap(base: Base, exact: i64) -> Value {
    match base {
        Base::Byte => Value::Byte(exact as u8),
        Base::Uint => Value::Uint(exact as u32),
        _ => Value::Int(exact as i32),
    }
}

fn fold_bool(op: BinaryOp, left: bool, right: bool) -> Option<bool> {
    match op {
        BinaryOp::And => Some(left && right),
        BinaryOp::Or => Some(left || right),
        BinaryOp::Equal => Some(left == right),
        BinaryOp::NotEqual => Some(left != right),
        _ => None,
    }
}

fn fold_double(op: BinaryOp, left: f64, right: f64) -> Option<Value> {
    let number = match op {
        BinaryOp::Add => left + right,
        BinaryOp::Subtract => left - right,
        BinaryOp::Multiply => left * right,
        BinaryOp::Divide => left / right,
        // A remainder by zero is an alarm at run time.
        BinaryOp::Remainder if right == 0.0 => return None,
        BinaryOp::Remainder => left % right,
        BinaryOp::Less => return Some(Value::Bool(left < right)),
        BinaryOp::LessEqual => return Some(Value::Bool(left <= right)),
        BinaryOp::Greater => return Some(Value::Bool(left > right)),
        BinaryOp::GreaterEqual => return Some(Value::Bool(left >= right)),
        BinaryOp::Equal => return Some(Value::Bool(left == right)),
        BinaryOp::NotEqual => return Some(Value::Bool(left != right)),
        _ => return None,
    };
    Some(Value::Double(number))
}

fn compare(op: BinaryOp, order: std::cmp::Ordering) -> Option<bool> {
    match op {
        BinaryOp::Less => Some(order.is_lt()),
        BinaryOp::LessEqual => Some(order.is_le()),
        BinaryOp::Greater => Some(order.is_gt()),
        BinaryOp::GreaterEqual => Some(order.is_ge()),
        BinaryOp::Equal => Some(order.is_eq()),
        BinaryOp::NotEqual => Some(order.is_ne()),
        _ => None,
    }
}
