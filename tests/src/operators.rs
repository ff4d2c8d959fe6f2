//! What operators take and give.

use crate::machine::Alarm;
use crate::tree::{Expr, Op, Unary};
use crate::value::{Base, JOINT, UNSET, Value, convert};

/// The whole number of a constant.
fn integer(value: &Value) -> Option<i64> {
    match value {
        Value::Int(x) => Some(i64::from(*x)),
        Value::Uint(x) => Some(i64::from(*x)),
        Value::Byte(x) => Some(i64::from(*x)),
        _ => None,
    }
}

/// Whether the expression is a constant whole number that fits the type.
pub fn fits(expr: &Expr, base: Base) -> bool {
    let Some(value) = expr.constant.as_ref().and_then(integer) else { return false };
    match base {
        // The complement of a bit pattern is as wide as its place wants.
        Base::Byte => (0..=255).contains(&value) || (expr.is_complement() && value | 255 == -1),
        Base::Int => i32::try_from(value).is_ok(),
        Base::Uint => u32::try_from(value).is_ok() || (expr.pattern && matches!(expr.ty.base, Base::Int)),
        Base::Double => true,
        _ => false,
    }
}

/// Whether a value converts by itself.
pub fn converts(expr: &Expr, to: Base) -> bool {
    let from = expr.ty.base;
    if expr.ty.is_array() {
        return false;
    }
    from == to
        || fits(expr, to)
        || matches!(
            (from, to),
            (Base::Byte, Base::Int | Base::Uint | Base::Double | Base::Bool)
                | (Base::Int | Base::Uint, Base::Double | Base::Bool)
                | (Base::Double, Base::Bool)
                | (Base::Enum(_), Base::Int)
        )
}

/// The type to which the operands of an arithmetic operator or comparison are brought; none where they do not mix.
pub fn common(left: &Expr, right: &Expr) -> Option<Base> {
    let (a, b) = (counted(left.ty.base), counted(right.ty.base));
    let number = |base| matches!(base, Base::Int | Base::Uint | Base::Byte | Base::Double);
    if !number(a) || !number(b) {
        return None;
    }
    let enumeration = matches!(left.ty.base, Base::Enum(_)) || matches!(right.ty.base, Base::Enum(_));
    if enumeration && (matches!(a, Base::Byte | Base::Uint) || matches!(b, Base::Byte | Base::Uint)) {
        // Whether the constant of an enumeration is a constant number is nowhere said.
        return None;
    }
    if a == b {
        return Some(a);
    }
    if a == Base::Double || b == Base::Double {
        return Some(Base::Double);
    }
    let yields = |constant: &Expr, other: &Expr, base: Base| {
        let alone = other.constant.is_none() || constant.ty.base == Base::Int;
        constant.constant.is_some() && alone && fits(constant, base)
    };
    if yields(left, right, b) {
        return Some(b);
    }
    if yields(right, left, a) {
        return Some(a);
    }
    match (a, b) {
        (Base::Byte, Base::Int) | (Base::Int, Base::Byte) => Some(Base::Int),
        (Base::Byte, Base::Uint) | (Base::Uint, Base::Byte) => Some(Base::Uint),
        _ => None,
    }
}

/// Enumerations count as int.
fn counted(base: Base) -> Base {
    if matches!(base, Base::Enum(_)) { Base::Int } else { base }
}

/// The type of `left op right` and the type that both are brought to; none where it is an error, a constant division
/// by zero or shift out of range included.
pub fn typed(op: Op, left: &Expr, right: &Expr) -> Option<(Base, Base)> {
    if left.ty.is_array() || right.ty.is_array() {
        return None;
    }
    let (a, b) = (left.ty.base, right.ty.base);
    match op {
        Op::And | Op::Or => {
            (converts(left, Base::Bool) && converts(right, Base::Bool)).then_some((Base::Bool, Base::Bool))
        }
        Op::Shl | Op::Shr => {
            let width = match a {
                Base::Int | Base::Uint => 32,
                Base::Byte => 8,
                _ => return None,
            };
            let count = right.constant.as_ref().and_then(integer);
            let good = matches!(b, Base::Int | Base::Uint | Base::Byte)
                && count.is_none_or(|count| (0..width).contains(&count));
            good.then_some((a, a))
        }
        _ if a == Base::Str && b == Base::Str => match op {
            Op::Add => Some((a, a)),
            _ => op.compares().then_some((Base::Bool, a)),
        },
        Op::Add | Op::Sub if a == Base::Struct(JOINT) && a == b => Some((a, a)),
        Op::Equal | Op::NotEqual if a == Base::Bool || b == Base::Bool => {
            let good = |base| matches!(base, Base::Bool | Base::Int | Base::Byte);
            (good(a) && good(b)).then_some((Base::Bool, Base::Bool))
        }
        _ => {
            let base = common(left, right)?;
            let bits = matches!(op, Op::BitAnd | Op::BitOr | Op::BitXor);
            if bits && base == Base::Double {
                return None;
            }
            let zero = match right.constant.clone().map(|value| convert(value, counted(b))) {
                Some(Value::Double(value)) => value == 0.0,
                Some(value) => integer(&value) == Some(0),
                None => false,
            };
            if zero && matches!(op, Op::Div | Op::Rem) && (op == Op::Rem || base != Base::Double) {
                return None;
            }
            // As a double, a bit pattern could be with or without sign.
            if base == Base::Double && (left.pattern || right.pattern) {
                return None;
            }
            Some((if op.compares() { Base::Bool } else { base }, base))
        }
    }
}

/// `left op right` of operands that were brought to their common type; not for `&&`, `||`.
pub fn binary(op: Op, left: Value, right: Value) -> Result<Value, Alarm> {
    if op.compares() {
        return Ok(Value::Bool(compare(op, &left, &right)));
    }
    if matches!(op, Op::Shl | Op::Shr) {
        return shift(op, left, right);
    }
    Ok(match (left, right) {
        (Value::Int(a), Value::Int(b)) => Value::Int(match op {
            Op::Div | Op::Rem if b == 0 => return Err(Alarm::DIVISION),
            Op::Mul => a.wrapping_mul(b),
            Op::Div => a.wrapping_div(b),
            Op::Rem => a.wrapping_rem(b),
            Op::Add => a.wrapping_add(b),
            Op::Sub => a.wrapping_sub(b),
            Op::BitAnd => a & b,
            Op::BitXor => a ^ b,
            _ => a | b,
        }),
        (Value::Uint(a), Value::Uint(b)) => Value::Uint(whole(op, a.into(), b.into())? as u32),
        (Value::Byte(a), Value::Byte(b)) => Value::Byte(whole(op, a.into(), b.into())? as u8),
        (Value::Double(a), Value::Double(b)) => Value::Double(match op {
            Op::Rem if b == 0.0 => return Err(Alarm::DIVISION),
            Op::Mul => a * b,
            Op::Div => a / b,
            Op::Rem => a % b,
            Op::Add => a + b,
            _ => a - b,
        }),
        (Value::Str(a), Value::Str(b)) => Value::Str([a, b].concat()),
        (Value::Struct(JOINT, a), Value::Struct(JOINT, b)) => {
            let each = |(a, b): (Value, Value)| match (a, b) {
                (Value::Double(a), Value::Double(b)) if a == UNSET || b == UNSET => Value::Double(UNSET),
                (Value::Double(a), Value::Double(b)) => Value::Double(if op == Op::Add { a + b } else { a - b }),
                (a, _) => a,
            };
            Value::Struct(JOINT, a.into_iter().zip(b).map(each).collect())
        }
        (a, b) => panic!("no {op:?} of {a:?} and {b:?}"),
    })
}

/// Operators of unsigned numbers, before they are cut to their width.
fn whole(op: Op, a: i64, b: i64) -> Result<i64, Alarm> {
    Ok(match op {
        Op::Div | Op::Rem if b == 0 => return Err(Alarm::DIVISION),
        Op::Mul => a.wrapping_mul(b),
        Op::Div => a / b,
        Op::Rem => a % b,
        Op::Add => a + b,
        Op::Sub => a - b,
        Op::BitAnd => a & b,
        Op::BitXor => a ^ b,
        _ => a | b,
    })
}

fn shift(op: Op, left: Value, right: Value) -> Result<Value, Alarm> {
    let count = integer(&right).expect("a count is a whole number");
    let width = if matches!(left, Value::Byte(_)) { 8 } else { 32 };
    if !(0..width).contains(&count) {
        return Err(Alarm::SHIFT);
    }
    let left_shift = op == Op::Shl;
    Ok(match left {
        Value::Int(a) => Value::Int(if left_shift { (i64::from(a) << count) as i32 } else { a >> count }),
        Value::Uint(a) => Value::Uint(if left_shift { (u64::from(a) << count) as u32 } else { a >> count }),
        Value::Byte(a) => Value::Byte(if left_shift { (u32::from(a) << count) as u8 } else { a >> count }),
        other => panic!("no shift of {other:?}"),
    })
}

fn compare(op: Op, left: &Value, right: &Value) -> bool {
    use std::cmp::Ordering;
    let order = match (left, right) {
        (Value::Int(a), Value::Int(b)) => Some(a.cmp(b)),
        (Value::Uint(a), Value::Uint(b)) => Some(a.cmp(b)),
        (Value::Byte(a), Value::Byte(b)) => Some(a.cmp(b)),
        (Value::Bool(a), Value::Bool(b)) => Some(a.cmp(b)),
        (Value::Str(a), Value::Str(b)) => Some(a.cmp(b)),
        (Value::Double(a), Value::Double(b)) => a.partial_cmp(b),
        (a, b) => panic!("no comparison of {a:?} and {b:?}"),
    };
    match op {
        Op::Less => order == Some(Ordering::Less),
        Op::LessEqual => matches!(order, Some(Ordering::Less | Ordering::Equal)),
        Op::Greater => order == Some(Ordering::Greater),
        Op::GreaterEqual => matches!(order, Some(Ordering::Greater | Ordering::Equal)),
        Op::Equal => order == Some(Ordering::Equal),
        _ => order != Some(Ordering::Equal),
    }
}

/// The type of `op operand`, and the type it is brought to.
pub fn typed_unary(op: Unary, operand: &Expr) -> Option<(Base, Base)> {
    if operand.ty.is_array() {
        return None;
    }
    let base = operand.ty.base;
    match op {
        Unary::Not => converts(operand, Base::Bool).then_some((Base::Bool, Base::Bool)),
        Unary::Negate => match base {
            Base::Byte | Base::Enum(_) => Some((Base::Int, Base::Int)),
            Base::Int | Base::Double | Base::Struct(JOINT) => Some((base, base)),
            _ => None,
        },
        Unary::Complement => match base {
            Base::Enum(_) => Some((Base::Int, Base::Int)),
            Base::Int | Base::Uint | Base::Byte => Some((base, base)),
            _ => None,
        },
    }
}

/// `op operand` of an operand that was brought to its type.
pub fn unary(op: Unary, operand: Value) -> Value {
    match (op, operand) {
        (Unary::Not, Value::Bool(x)) => Value::Bool(!x),
        (Unary::Negate, Value::Int(x)) => Value::Int(x.wrapping_neg()),
        (Unary::Negate, Value::Double(x)) => Value::Double(-x),
        (Unary::Negate, Value::Struct(JOINT, parts)) => {
            let negative = |part| match part {
                Value::Double(x) if x != UNSET => Value::Double(-x),
                part => part,
            };
            Value::Struct(JOINT, parts.into_iter().map(negative).collect())
        }
        (Unary::Complement, Value::Int(x)) => Value::Int(!x),
        (Unary::Complement, Value::Uint(x)) => Value::Uint(!x),
        (Unary::Complement, Value::Byte(x)) => Value::Byte(!x),
        (op, operand) => panic!("no {op:?} of {operand:?}"),
    }
}
