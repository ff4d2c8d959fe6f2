//! What operators do: the types that they accept and convert their operands to, their result types, and the values that
//! they compute. Used by the checker and the debugger.

use crate::hir::Value;
use arl_lang::ast::{BinaryOp, UnaryOp};
use arl_lang::catalog::{Base, Enum, Struct};

/// How an integer constant was written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Literal {
    /// Nothing special.
    None,
    /// Binary or hexadecimal: 32 bits without a sign.
    Pattern,
    /// `~` of a pattern: as wide as its context requires.
    Complement,
    /// Decimal, 2^31 or more: only for a uint.
    Wide,
}

/// An operand that is not an array.
#[derive(Clone, Copy, Debug)]
pub struct Operand<'a> {
    /// Its type.
    pub base: Base,
    /// The value, if the operand is constant.
    pub constant: Option<&'a Value>,
    /// How the constant was written.
    pub literal: Literal,
}

impl<'a> Operand<'a> {
    /// Treats an enumeration as an int, as operators do.
    fn as_number(self) -> Self {
        if matches!(self.base, Base::Enum(_)) { Self { base: Base::Int, ..self } } else { self }
    }

    /// The constant as a value of a type, if the type can represent it.
    fn fitting(self, to: Base) -> Option<Value> {
        fit(self.constant?, self.literal, to)
    }
}

/// What an operator does with two operands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Operation {
    /// The type that the left operand is converted to.
    pub left: Base,
    /// The type that the right operand is converted to.
    pub right: Base,
    /// The type of the result.
    pub result: Base,
}

impl Operation {
    fn of(both: Base, result: Base) -> Option<Self> {
        Some(Self { left: both, right: both, result })
    }
}

/// The reason why there is no value, worded like the alarm at run time.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum OperatorAlarm {
    /// Division by zero.
    DivideByZero,
    /// A shift by `count`, where 0 to `most` is possible.
    ShiftCount {
        /// The requested shift.
        count: i64,
        /// One less than the number of bits of the type.
        most: u32,
    },
}

impl std::fmt::Display for OperatorAlarm {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            OperatorAlarm::DivideByZero => write!(f, "alarm 20001: division by zero"),
            OperatorAlarm::ShiftCount { count, most } => {
                let bits = most + 1;
                write!(f, "alarm 20002: shift by {count}: a value of {bits} bits can be shifted by 0 to {most}")
            }
        }
    }
}

/// What an operator does with these operands; `None` if it does not accept them.
pub fn binary(op: BinaryOp, left: Operand<'_>, right: Operand<'_>) -> Option<Operation> {
    match op {
        BinaryOp::And | BinaryOp::Or => {
            let is_condition = |operand: Operand<'_>| conversion(operand.base, Base::Bool).is_some();
            (is_condition(left) && is_condition(right)).then_some(())?;
            Operation::of(Base::Bool, Base::Bool)
        }
        BinaryOp::ShiftLeft | BinaryOp::ShiftRight => shift(left.as_number(), right.as_number()),
        _ => match (left.base, right.base) {
            (Base::String, Base::String) if op.compares() => Operation::of(Base::String, Base::Bool),
            (Base::String, Base::String) if op == BinaryOp::Add => Operation::of(Base::String, Base::String),
            (Base::String, _) | (_, Base::String) => None,
            (Base::Struct(one), Base::Struct(other)) => {
                let result = Base::Struct(of_structures(op, one, other)?);
                Some(Operation { left: left.base, right: right.base, result })
            }
            (Base::Bool, _) | (_, Base::Bool) => {
                let comparable = |base| matches!(base, Base::Bool | Base::Int | Base::Byte);
                let equality = matches!(op, BinaryOp::Equal | BinaryOp::NotEqual);
                (equality && comparable(left.base) && comparable(right.base)).then_some(())?;
                Operation::of(Base::Bool, Base::Bool)
            }
            _ => {
                let base = common(left.as_number(), right.as_number())?;
                let bits = matches!(op, BinaryOp::BitAnd | BinaryOp::BitOr | BinaryOp::BitXor);
                (!bits || base != Base::Double).then_some(())?;
                Operation::of(base, if op.compares() { Base::Bool } else { base })
            }
        },
    }
}

/// The type of an operation on two structures.
fn of_structures(op: BinaryOp, left: Struct, right: Struct) -> Option<Struct> {
    match (op, left, right) {
        (BinaryOp::Add | BinaryOp::Subtract, Struct::Joint, Struct::Joint) => Some(Struct::Joint),
        (BinaryOp::Multiply, Struct::Frame, Struct::Frame) => Some(Struct::Frame),
        (BinaryOp::Multiply, Struct::Frame | Struct::Pose, Struct::Frame | Struct::Pose) => Some(Struct::Pose),
        _ => None,
    }
}

fn shift(left: Operand<'_>, right: Operand<'_>) -> Option<Operation> {
    let has_bits = |base| matches!(base, Base::Int | Base::Uint | Base::Byte);
    (has_bits(left.base) && has_bits(right.base)).then_some(())?;
    // A uint that is not constant stays as it is: the result has the type of the left operand anyway.
    let count = if right.base == Base::Uint && right.constant.is_none() { Base::Uint } else { Base::Int };
    Some(Operation { left: left.base, right: count, result: left.base })
}

/// The type that both numbers are converted to; `None` if they cannot be mixed.
fn common(left: Operand<'_>, right: Operand<'_>) -> Option<Base> {
    let (a, b) = (left.base, right.base);
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
    // A constant takes the type of the other operand if it fits; of two constants the int is converted.
    let type_of_constant = |constant: Operand<'_>, other: Operand<'_>| {
        if other.constant.is_some() && constant.base != Base::Int {
            return None;
        }
        constant.fitting(other.base).map(|_| other.base)
    };
    if let Some(base) = type_of_constant(left, right).or_else(|| type_of_constant(right, left)) {
        return Some(base);
    }
    match (a, b) {
        (Base::Byte, Base::Int) | (Base::Int, Base::Byte) => Some(Base::Int),
        (Base::Byte, Base::Uint) | (Base::Uint, Base::Byte) => Some(Base::Uint),
        _ => None,
    }
}

/// The type that the operand is converted to and the type of the result; `None` if the operator does not accept it.
pub fn unary(op: UnaryOp, operand: Operand<'_>) -> Option<[Base; 2]> {
    let base = operand.as_number().base;
    match (op, base) {
        (UnaryOp::Not, _) => conversion(operand.base, Base::Bool).map(|_| [Base::Bool; 2]),
        (UnaryOp::Negate, Base::Byte) => Some([Base::Int; 2]),
        // 2147483648 alone is out of range for int, but its negative is not.
        (UnaryOp::Negate, Base::Uint) => {
            let is_least = operand.literal == Literal::Wide && operand.constant == Some(&Value::Uint(0x8000_0000));
            is_least.then_some([Base::Uint, Base::Int])
        }
        (UnaryOp::Negate, Base::Int | Base::Double | Base::Struct(Struct::Joint))
        | (UnaryOp::Complement, Base::Int | Base::Uint | Base::Byte) => Some([base; 2]),
        _ => None,
    }
}

/// How a type converts to another.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Conversion {
    /// Nothing to do.
    Same,
    /// By Table 2-1 of the manual.
    Implicit,
    /// Beyond the manual.
    Extended,
}

/// The implicit conversion between two types, if there is one.
pub fn conversion(from: Base, to: Base) -> Option<Conversion> {
    if from == to {
        return Some(Conversion::Same);
    }
    match (from, to) {
        (Base::Byte, Base::Int | Base::Double | Base::Bool) | (Base::Int, Base::Double | Base::Bool) => {
            Some(Conversion::Implicit)
        }
        (Base::Enum(_), Base::Int) => Some(Conversion::Implicit),
        (Base::Double, Base::Bool) | (Base::Uint, Base::Double | Base::Bool) | (Base::Byte, Base::Uint) => {
            Some(Conversion::Extended)
        }
        _ => None,
    }
}

/// The constant as a value of another type, if that type can represent it.
pub fn fit(value: &Value, literal: Literal, to: Base) -> Option<Value> {
    if value.base() == to {
        return Some(value.clone());
    }
    let number = integer(value);
    match (value, to) {
        (Value::Enum(_, index), Base::Int) => Some(Value::Int(i32::from(*index))),
        (Value::Int(number), Base::Enum(id)) => enum_constant(id, i64::from(*number)),
        (Value::Double(number), Base::Bool) => Some(Value::Bool(*number != 0.0)),
        (_, Base::Double) => number.map(|number| Value::Double(number as f64)),
        (_, Base::Bool) => number.map(|number| Value::Bool(number != 0)),
        (_, Base::Int) => i32::try_from(number?).ok().map(Value::Int),
        (Value::Int(bits), Base::Uint) if matches!(literal, Literal::Pattern | Literal::Complement) => {
            Some(Value::Uint(*bits as u32))
        }
        (_, Base::Uint) => u32::try_from(number?).ok().map(Value::Uint),
        (Value::Int(bits), Base::Byte) if literal == Literal::Complement => {
            let low = *bits as u8;
            (*bits as u32 | 0xff == u32::MAX || *bits as u32 <= 0xff).then_some(Value::Byte(low))
        }
        (Value::Int(bits), Base::Byte) if literal == Literal::Pattern => {
            u8::try_from(*bits as u32).ok().map(Value::Byte)
        }
        (_, Base::Byte) => u8::try_from(number?).ok().map(Value::Byte),
        _ => None,
    }
}

/// The range of an integer type, in words; empty for other types.
pub fn range(to: Base) -> &'static str {
    match to {
        Base::Byte => "a byte holds 0 to 255",
        Base::Int => "an int holds -2147483648 to 2147483647",
        Base::Uint => "a uint holds 0 to 4294967295",
        _ => "",
    }
}

/// The value of an integer constant.
pub fn integer(value: &Value) -> Option<i64> {
    match value {
        Value::Int(number) => Some(i64::from(*number)),
        Value::Uint(number) => Some(i64::from(*number)),
        Value::Byte(number) => Some(i64::from(*number)),
        _ => None,
    }
}

fn enum_constant(id: Enum, number: i64) -> Option<Value> {
    let index = u16::try_from(number).ok()?;
    id.def().constants.get(index as usize).map(|_| Value::Enum(id, index))
}

/// The number of bits of a type that can be shifted.
pub const fn width(base: Base) -> u32 {
    if matches!(base, Base::Byte) { 8 } else { 32 }
}

/// A value, and whether it overflowed its type.
#[derive(Clone, PartialEq, Debug)]
pub struct Computed {
    /// The value.
    pub value: Value,
    /// Whether only the lowest bits were kept.
    pub wrapped: bool,
}

impl From<Value> for Computed {
    fn from(value: Value) -> Self {
        Self { value, wrapped: false }
    }
}

impl Computed {
    fn integer(base: Base, exact: i64) -> Self {
        let value = lowest_bits(base, exact);
        let wrapped = integer(&value) != Some(exact);
        Self { value, wrapped }
    }
}

/// The value of `left op right`, whose operands have the types that [`binary`] converts them to; `None` if the operator
/// is not defined for them.
///
/// # Errors
/// The alarm that the operation raises at run time.
pub fn compute(op: BinaryOp, left: &Value, right: &Value) -> Result<Option<Computed>, OperatorAlarm> {
    Ok(match (left, right) {
        (Value::Bool(a), Value::Bool(b)) => of_bools(op, *a, *b).map(|value| Value::Bool(value).into()),
        (Value::Double(a), Value::Double(b)) => of_doubles(op, *a, *b)?.map(Computed::from),
        (Value::String(a), Value::String(b)) => match op {
            BinaryOp::Add => Some(Value::String(format!("{a}{b}").into()).into()),
            _ => compare(op, a.as_bytes().cmp(b.as_bytes())).map(|value| Value::Bool(value).into()),
        },
        // The count of a shift may have another type.
        (Value::Int(_) | Value::Uint(_) | Value::Byte(_), _) => match (integer(left), integer(right)) {
            (Some(a), Some(b)) => of_integers(op, left.base(), a, b)?,
            _ => None,
        },
        _ => None,
    })
}

/// The value of `op operand`, whose operand has the type that [`unary`] converts it to; `None` if the operator is not
/// defined for it.
pub fn compute_unary(op: UnaryOp, operand: &Value) -> Option<Computed> {
    match (op, operand) {
        (UnaryOp::Negate, Value::Int(value)) => Some(Computed::integer(Base::Int, -i64::from(*value))),
        (UnaryOp::Negate, Value::Uint(0x8000_0000)) => Some(Value::Int(i32::MIN).into()),
        (UnaryOp::Negate, Value::Double(value)) => Some(Value::Double(-value).into()),
        (UnaryOp::Not, Value::Bool(value)) => Some(Value::Bool(!value).into()),
        (UnaryOp::Complement, Value::Int(value)) => Some(Value::Int(!value).into()),
        (UnaryOp::Complement, Value::Uint(value)) => Some(Value::Uint(!value).into()),
        (UnaryOp::Complement, Value::Byte(value)) => Some(Value::Byte(!value).into()),
        _ => None,
    }
}

fn of_integers(op: BinaryOp, base: Base, left: i64, right: i64) -> Result<Option<Computed>, OperatorAlarm> {
    let most = width(base) - 1;
    let exact = match op {
        BinaryOp::Add => left + right,
        BinaryOp::Subtract => left - right,
        BinaryOp::Multiply => left.wrapping_mul(right),
        BinaryOp::Divide | BinaryOp::Remainder if right == 0 => return Err(OperatorAlarm::DivideByZero),
        BinaryOp::Divide => left / right,
        BinaryOp::Remainder => left % right,
        BinaryOp::ShiftLeft | BinaryOp::ShiftRight if !(0..=i64::from(most)).contains(&right) => {
            return Err(OperatorAlarm::ShiftCount { count: right, most });
        }
        // Losing the bits that are shifted out is intended.
        BinaryOp::ShiftLeft => return Ok(Some(lowest_bits(base, left << right).into())),
        BinaryOp::ShiftRight => return Ok(Some(lowest_bits(base, left >> right).into())),
        BinaryOp::BitAnd => left & right,
        BinaryOp::BitOr => left | right,
        BinaryOp::BitXor => return Ok(Some(lowest_bits(base, left ^ right).into())),
        BinaryOp::And | BinaryOp::Or => return Ok(None),
        _ => return Ok(compare(op, left.cmp(&right)).map(|value| Value::Bool(value).into())),
    };
    Ok(Some(Computed::integer(base, exact)))
}

/// The lowest bits of a number, as a value of the type.
fn lowest_bits(base: Base, exact: i64) -> Value {
    match base {
        Base::Byte => Value::Byte(exact as u8),
        Base::Uint => Value::Uint(exact as u32),
        _ => Value::Int(exact as i32),
    }
}

fn of_bools(op: BinaryOp, left: bool, right: bool) -> Option<bool> {
    match op {
        BinaryOp::And => Some(left && right),
        BinaryOp::Or => Some(left || right),
        BinaryOp::Equal => Some(left == right),
        BinaryOp::NotEqual => Some(left != right),
        _ => None,
    }
}

fn of_doubles(op: BinaryOp, left: f64, right: f64) -> Result<Option<Value>, OperatorAlarm> {
    let number = match op {
        BinaryOp::Add => left + right,
        BinaryOp::Subtract => left - right,
        BinaryOp::Multiply => left * right,
        BinaryOp::Divide => left / right,
        BinaryOp::Remainder if right == 0.0 => return Err(OperatorAlarm::DivideByZero),
        BinaryOp::Remainder => left % right,
        BinaryOp::Less => return Ok(Some(Value::Bool(left < right))),
        BinaryOp::LessEqual => return Ok(Some(Value::Bool(left <= right))),
        BinaryOp::Greater => return Ok(Some(Value::Bool(left > right))),
        BinaryOp::GreaterEqual => return Ok(Some(Value::Bool(left >= right))),
        BinaryOp::Equal => return Ok(Some(Value::Bool(left == right))),
        BinaryOp::NotEqual => return Ok(Some(Value::Bool(left != right))),
        _ => return Ok(None),
    };
    Ok(Some(Value::Double(number)))
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

#[cfg(test)]
mod tests {
    use super::*;

    fn operand(value: &Value, is_constant: bool) -> Operand<'_> {
        Operand { base: value.base(), constant: is_constant.then_some(value), literal: Literal::None }
    }

    /// The result of an operator on variables with these values.
    fn of_variables(op: BinaryOp, left: &Value, right: &Value) -> Option<Result<Value, OperatorAlarm>> {
        let operation = binary(op, operand(left, false), operand(right, false))?;
        let left = fit(left, Literal::None, operation.left)?;
        let right = fit(right, Literal::None, operation.right)?;
        compute(op, &left, &right).transpose().map(|done| done.map(|computed| computed.value))
    }

    #[test]
    fn shifts_have_the_width_of_what_is_shifted() {
        let left = BinaryOp::ShiftLeft;
        assert_eq!(
            of_variables(left, &Value::Byte(1), &Value::Int(9)),
            Some(Err(OperatorAlarm::ShiftCount { count: 9, most: 7 }))
        );
        assert_eq!(of_variables(left, &Value::Byte(0x81), &Value::Int(1)), Some(Ok(Value::Byte(2))));
        assert_eq!(of_variables(left, &Value::Uint(1), &Value::Uint(31)), Some(Ok(Value::Uint(0x8000_0000))));
        assert_eq!(of_variables(BinaryOp::ShiftRight, &Value::Int(-8), &Value::Byte(1)), Some(Ok(Value::Int(-4))));
    }

    #[test]
    fn integers_wrap_and_say_so() {
        let computed = compute(BinaryOp::Add, &Value::Int(i32::MAX), &Value::Int(1)).unwrap().unwrap();
        assert_eq!((computed.value, computed.wrapped), (Value::Int(i32::MIN), true));
        let computed = compute_unary(UnaryOp::Negate, &Value::Int(i32::MIN)).unwrap();
        assert_eq!((computed.value, computed.wrapped), (Value::Int(i32::MIN), true));
    }

    #[test]
    fn uint_and_int_mix_by_constants_alone() {
        let (one, other) = (Value::Uint(7), Value::Int(2));
        assert_eq!(binary(BinaryOp::Add, operand(&one, false), operand(&other, false)), None);
        let operation = binary(BinaryOp::Add, operand(&one, false), operand(&other, true));
        assert_eq!(operation.map(|it| it.result), Some(Base::Uint));
    }

    #[test]
    fn division_by_zero_is_none() {
        for (left, right) in [(Value::Int(1), Value::Int(0)), (Value::Byte(1), Value::Byte(0))] {
            assert_eq!(of_variables(BinaryOp::Remainder, &left, &right), Some(Err(OperatorAlarm::DivideByZero)));
        }
        let zero = Value::Double(0.0);
        assert_eq!(of_variables(BinaryOp::Remainder, &zero, &zero), Some(Err(OperatorAlarm::DivideByZero)));
        assert_eq!(of_variables(BinaryOp::Divide, &Value::Double(1.0), &zero), Some(Ok(Value::Double(f64::INFINITY))));
    }
}
