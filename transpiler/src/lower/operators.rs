//! Operators with two operands.

use super::body::FunctionCode;
use super::variables::is_text;
use crate::hir::{Expr, Type, Value};
use arl_code::{Comparison, Op, Reg, Shifted};
use arl_lang::ast::BinaryOp;
use arl_lang::catalog::Base;

/// A comparison as the engine has it: `swapped` exchanges the operands, `negated` the result.
pub(super) struct Compared {
    pub(super) by: Comparison,
    pub(super) swapped: bool,
    pub(super) negated: bool,
}

/// How values of a type are compared; `None` if the operator is no comparison.
pub(super) fn comparison(op: BinaryOp, base: Base) -> Option<Compared> {
    use BinaryOp::*;
    let (less, less_equal, equal) = match base {
        Base::Double => (Comparison::LessDouble, Comparison::LessEqualDouble, Comparison::EqualDouble),
        Base::Int => (Comparison::LessInt, Comparison::LessEqualInt, Comparison::Equal),
        _ => (Comparison::LessUint, Comparison::LessEqualUint, Comparison::Equal),
    };
    let (by, swapped, negated) = match op {
        Less => (less, false, false),
        LessEqual => (less_equal, false, false),
        Greater => (less, true, false),
        GreaterEqual => (less_equal, true, false),
        Equal => (equal, false, false),
        NotEqual => (equal, false, true),
        _ => return None,
    };
    Some(Compared { by, swapped, negated })
}

/// A 32-bit constant of an int or uint.
pub(super) fn small(value: Option<&Value>) -> Option<i32> {
    match value? {
        Value::Int(value) => Some(*value),
        Value::Uint(value) => Some(*value as i32),
        _ => None,
    }
}

impl<'p> FunctionCode<'p, '_> {
    /// `left op right`, where the result is a number.
    pub(super) fn binary(
        &mut self,
        op: BinaryOp,
        left: &'p Expr,
        right: &'p Expr,
        whole: &'p Expr,
        wanted: Option<Reg>,
    ) -> Reg {
        if matches!(op, BinaryOp::And | BinaryOp::Or) {
            return self.truth(whole, wanted);
        }
        if is_text(left.ty) {
            return self.compared_texts(op, left, right, wanted);
        }
        let to = self.register_or(wanted);
        self.passing(|body| {
            if let Some(compared) = comparison(op, left.ty.base) {
                let (left, right) = body.operands(left, right);
                let (left, right) = if compared.swapped { (right, left) } else { (left, right) };
                body.op(Op::Compare { to, left, right, by: compared.by });
                if compared.negated {
                    body.op(Op::NotBool { to, from: to });
                }
                return;
            }
            // An operation with a constant on the left whose order makes no difference.
            let exchanged = matches!(
                op,
                BinaryOp::Add | BinaryOp::Multiply | BinaryOp::BitAnd | BinaryOp::BitOr | BinaryOp::BitXor
            ) && matches!(left.ty.base, Base::Int | Base::Uint)
                && body.constant(left).is_some();
            let (left, right) = if exchanged { (right, left) } else { (left, right) };
            let old = body.steady_number(left, &[right]);
            body.operation(op, left.ty.base, to, old, right);
        });
        to
    }

    /// Two operands; the left one is not changed by the right one.
    pub(super) fn operands(&mut self, left: &'p Expr, right: &'p Expr) -> (Reg, Reg) {
        let spills = self.is_deep();
        let first = self.steady_number(left, &[right]);
        if !spills {
            let second = self.number(right, None);
            return (first, second);
        }
        if self.aliased(left).is_some() {
            // It is the register of a variable, and stays there.
            let second = self.number(right, None);
            return (first, second);
        }
        // Deep inside of other expressions the left one waits in the frame.
        let place = self.space_of(Type::scalar(left.ty.base));
        self.op(Op::Store { from: first, at: place.word });
        let second = self.passing(|body| body.number(right, Some(first)));
        let register = self.register();
        self.op(Op::Load { to: register, at: place.word });
        (register, second)
    }

    /// Whether registers are few.
    fn is_deep(&self) -> bool {
        self.used.registers > 224
    }

    /// `to = left op right`
    pub(super) fn operation(&mut self, op: BinaryOp, base: Base, to: Reg, left: Reg, right: &'p Expr) {
        let known = self.constant(right);
        if let Some(value) = small(known)
            && matches!(base, Base::Int | Base::Uint)
            && let Some(op) = with_constant(op, base, to, left, value)
        {
            self.op(op);
            return;
        }
        if base == Base::Byte
            && let Some(Value::Byte(value)) = known
            && let Some(op) = byte_with_constant(op, to, left, *value)
        {
            self.op(op);
            self.op(Op::ToByte { to, from: to });
            return;
        }
        self.passing(|body| {
            let by_uint = right.ty.base == Base::Uint;
            let right = body.number(right, None);
            body.plain_operation(op, base, to, left, right, by_uint);
        });
    }

    fn plain_operation(&mut self, op: BinaryOp, base: Base, to: Reg, left: Reg, right: Reg, by_uint: bool) {
        use BinaryOp::*;
        let line = self.line;
        let is_double = base == Base::Double;
        let is_signed = base == Base::Int;
        let of = match (base, by_uint) {
            (Base::Int, false) => Shifted::Int,
            (Base::Int, true) => Shifted::IntByUint,
            (Base::Byte, false) => Shifted::Byte,
            (Base::Byte, true) => Shifted::ByteByUint,
            (_, false) => Shifted::Uint,
            (_, true) => Shifted::UintByUint,
        };
        self.op(match op {
            Add if is_double => Op::AddDouble { to, left, right },
            Subtract if is_double => Op::SubDouble { to, left, right },
            Multiply if is_double => Op::MulDouble { to, left, right },
            Divide if is_double => Op::DivDouble { to, left, right },
            Remainder if is_double => Op::RemDouble { to, left, right, line },
            Add => Op::AddInt { to, left, right },
            Subtract => Op::SubInt { to, left, right },
            Multiply => Op::MulInt { to, left, right },
            Divide if is_signed => Op::DivInt { to, left, right, line },
            Divide => Op::DivUint { to, left, right, line },
            Remainder if is_signed => Op::RemInt { to, left, right, line },
            Remainder => Op::RemUint { to, left, right, line },
            BitAnd => Op::And { to, left, right },
            BitOr => Op::Or { to, left, right },
            BitXor => Op::Xor { to, left, right },
            ShiftLeft => Op::ShiftLeft { to, left, right, of, line },
            ShiftRight => Op::ShiftRight { to, left, right, of, line },
            Less | LessEqual | Greater | GreaterEqual | Equal | NotEqual | And | Or => {
                debug_assert!(false, "comparisons and conditions have their own operations");
                return;
            }
        });
        if base == Base::Byte {
            self.op(Op::ToByte { to, from: to });
        }
    }
}

/// An operation with a constant on the right.
fn with_constant(op: BinaryOp, base: Base, to: Reg, left: Reg, value: i32) -> Option<Op> {
    use BinaryOp::*;
    let count = u8::try_from(value).ok().filter(|count| *count < 32);
    Some(match op {
        Add => Op::AddSmall { to, left, value },
        Subtract => Op::AddSmall { to, left, value: value.wrapping_neg() },
        Multiply => Op::MulSmall { to, left, value },
        Divide if value != 0 && base == Base::Int => Op::DivSmall { to, left, value },
        Remainder if value != 0 && base == Base::Int => Op::RemSmall { to, left, value },
        BitAnd => Op::AndSmall { to, left, value },
        BitOr => Op::OrSmall { to, left, value },
        BitXor => Op::XorSmall { to, left, value },
        ShiftLeft => Op::ShiftLeftSmall { to, left, count: count? },
        ShiftRight if base == Base::Int => Op::ShiftRightSmall { to, left, count: count? },
        _ => return None,
    })
}

/// An operation of bytes with a constant on the right; the result is cut to 8 bits afterwards.
fn byte_with_constant(op: BinaryOp, to: Reg, left: Reg, value: u8) -> Option<Op> {
    let value = i32::from(value);
    Some(match op {
        BinaryOp::Add => Op::AddSmall { to, left, value },
        BinaryOp::Subtract => Op::AddSmall { to, left, value: -value },
        BinaryOp::Multiply => Op::MulSmall { to, left, value },
        BinaryOp::Divide if value != 0 => Op::DivSmall { to, left, value },
        BinaryOp::Remainder if value != 0 => Op::RemSmall { to, left, value },
        BinaryOp::BitAnd => Op::AndSmall { to, left, value },
        BinaryOp::BitOr => Op::OrSmall { to, left, value },
        BinaryOp::BitXor => Op::XorSmall { to, left, value },
        _ => return None,
    })
}
