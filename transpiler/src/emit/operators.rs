//! Operators. Integers wrap, so their arithmetic is written as method calls.

use super::body::Body;
use super::consts::constant;
use super::fragment::{Fragment, Precedence};
use super::sequence::{Mode, OrderedOperand};
use crate::effects::facts::compared_with_bool;
use crate::hir::{Expr, ExprKind, Root, Type, Value};
use arl_lang::ast::{BinaryOp, UnaryOp};
use arl_lang::catalog::{Base, Enum};
use proc_macro2::{TokenStream, TokenTree};
use quote::quote;

impl<'p> Body<'p, '_> {
    /// `-x`, `!x`, `~x`
    pub(super) fn unary(&mut self, op: UnaryOp, inner: &'p Expr) -> Fragment {
        if op == UnaryOp::Negate && matches!(inner.ty.base, Base::Int | Base::Uint | Base::Byte) {
            return self.typed_value(inner).map(Precedence::Postfix, |value| {
                let value = value.receiver();
                quote!(#value.wrapping_neg())
            });
        }
        self.typed_value(inner).map(Precedence::Unary, |value| {
            let value = value.at(Precedence::Unary);
            match op {
                // Two signs in a row look like the `--` of other languages, about which rustc warns.
                UnaryOp::Negate if is_signed(&value) => quote!(-(#value)),
                UnaryOp::Negate => quote!(-#value),
                _ => quote!(!#value),
            }
        })
    }

    /// The opposite of a condition.
    pub(super) fn negated(&mut self, condition: &'p Expr) -> Fragment {
        self.truth(condition, false)
    }

    /// A condition, or its opposite if `wanted` is false. `x == true` is `x`, `!(a < b)` is `a >= b`.
    pub(super) fn truth(&mut self, condition: &'p Expr, wanted: bool) -> Fragment {
        match &condition.kind {
            ExprKind::Const(Value::Bool(value)) => return constant(&Value::Bool(*value == wanted)),
            ExprKind::Unary(UnaryOp::Not, inner) => return self.truth(inner, !wanted),
            ExprKind::Binary(op, sides) => {
                if let Some((other, same)) = compared_with_bool(*op, &sides.0, &sides.1) {
                    return self.truth(other, same == wanted);
                }
                if wanted {
                    return self.binary(*op, &sides.0, &sides.1);
                }
                if let Some(op) = opposite(*op, sides.0.ty) {
                    return self.binary(op, &sides.0, &sides.1);
                }
            }
            ExprKind::Convert(inner) if condition.ty.base == Base::Bool => return self.as_condition(inner, wanted),
            _ => {}
        }
        let value = self.value_of_condition(condition);
        if wanted {
            return value;
        }
        value.map(Precedence::Unary, |value| {
            let value = value.at(Precedence::Unary);
            quote!(!#value)
        })
    }

    /// A condition, without looking for a simpler form.
    fn value_of_condition(&mut self, condition: &'p Expr) -> Fragment {
        match &condition.kind {
            ExprKind::Binary(op, sides) => self.binary(*op, &sides.0, &sides.1),
            _ => self.value(condition),
        }
    }

    /// `left op right`
    pub(super) fn binary(&mut self, op: BinaryOp, left: &'p Expr, right: &'p Expr) -> Fragment {
        if matches!(op, BinaryOp::And | BinaryOp::Or) {
            let (left, right) = (self.value(left), self.inline_value(right));
            return left.map(precedence(op), |left| infix(op, left, &right));
        }
        if let Some((other, same)) = compared_with_bool(op, left, right) {
            return self.truth(other, same);
        }
        if let Some(compared) = self.compared_enums(op, left, right) {
            return compared;
        }
        let text = left.ty.base == Base::String && !left.ty.is_array();
        if text && op == BinaryOp::Add {
            return self.joined(left, right);
        }
        let (left_mode, right_mode) = match op {
            _ if text => (Mode::Compared, Mode::Compared),
            op if needs_type(op) || self.constant(right) == Some(&Value::Int(-1)) => (Mode::Typed, Mode::Value),
            _ => (Mode::Value, Mode::Value),
        };
        let operands = [OrderedOperand::Expr(left, left_mode), OrderedOperand::Expr(right, right_mode)];
        let (before, mut sides) = self.sequence(&operands, |_| false);
        let right_side = sides.pop().unwrap_or_else(|| Fragment::settled(quote!(())));
        let left_side = sides.pop().unwrap_or_else(|| Fragment::settled(quote!(())));
        let known = self.constant(right);
        self.operation(op, left.ty, left_side, &right_side, known).after(before)
    }

    /// The operation on emitted operands; `known` is the value of the right one if it is constant.
    pub(super) fn operation(
        &self,
        op: BinaryOp,
        ty: Type,
        left: Fragment,
        right: &Fragment,
        known: Option<&Value>,
    ) -> Fragment {
        use BinaryOp::*;
        let whole = matches!(ty.base, Base::Int | Base::Uint | Base::Byte);
        let call = |name: TokenStream| {
            let (left, right) = (&left.tokens, &right.tokens);
            Fragment::postfix(self.checked(quote!(#name(#left, #right))))
        };
        let method = |name: TokenStream| {
            let (left, right) = (left.receiver(), &right.tokens);
            Fragment::postfix(quote!(#left.#name(#right)))
        };
        match op {
            Add if whole => method(quote!(wrapping_add)),
            Subtract if whole => method(quote!(wrapping_sub)),
            Multiply if whole => method(quote!(wrapping_mul)),
            Divide if whole && known == Some(&Value::Int(-1)) => method(quote!(wrapping_div)),
            Remainder if whole && known == Some(&Value::Int(-1)) => method(quote!(wrapping_rem)),
            Divide if whole && !known.is_some_and(is_divisor) => call(quote!(div)),
            Remainder if whole && !known.is_some_and(is_divisor) => call(quote!(rem)),
            Remainder if ty.base == Base::Double && !known.is_some_and(is_divisor) => call(quote!(rem_double)),
            ShiftLeft if known.is_none() => call(quote!(shl)),
            ShiftRight if known.is_none() => call(quote!(shr)),
            Less | LessEqual | Greater | GreaterEqual if whole => {
                let upward = matches!(op, Less | GreaterEqual);
                let (left, right) = (limit(left, ty.base, !upward), limit(right.clone(), ty.base, upward));
                Fragment::new(infix(op, &left, &right), precedence(op))
            }
            _ if precedence(op) == Precedence::Compare => {
                let (left, right) = (nan_with_sign(left), nan_with_sign(right.clone()));
                Fragment::new(infix(op, &left, &right), Precedence::Compare)
            }
            _ => Fragment::new(infix(op, &left, right), precedence(op)),
        }
    }

    /// `v == VelProfile::S`, if the program compares the numbers of enumeration constants.
    fn compared_enums(&mut self, op: BinaryOp, left: &'p Expr, right: &'p Expr) -> Option<Fragment> {
        if !matches!(op, BinaryOp::Equal | BinaryOp::NotEqual) {
            return None;
        }
        match (enumeration(left), enumeration(right)) {
            (Some((id, left)), Some((other, right))) if id == other => {
                let operands = [OrderedOperand::Expr(left, Mode::Value), OrderedOperand::Expr(right, Mode::Value)];
                let (before, sides) = self.sequence(&operands, |_| false);
                let [left, right] = sides.as_slice() else { return None };
                Some(Fragment::new(infix(op, left, right), Precedence::Compare).after(before))
            }
            (Some((id, left)), None) => {
                let right = constant_of(id, right)?;
                Some(self.value(left).map(Precedence::Compare, |left| infix(op, left, &right)))
            }
            (None, Some((id, right))) => {
                let left = constant_of(id, left)?;
                Some(self.value(right).map(Precedence::Compare, |right| infix(op, &left, right)))
            }
            _ => None,
        }
    }

    /// A string that may have become too long: `fits(a + &b).at(FILE, 3)?`
    pub(super) fn fitting(&self, text: Fragment) -> Fragment {
        text.map(Precedence::Postfix, |text| {
            let tokens = &text.tokens;
            self.checked(quote!(fits(#tokens)))
        })
    }

    /// `a + b` of strings: the left one is copied or is a temporary; the right one is only read.
    fn joined(&mut self, left: &'p Expr, right: &'p Expr) -> Fragment {
        let left_mode = match text_mode(left) {
            Mode::Reference => Mode::Reference,
            _ => Mode::Value,
        };
        let operands = [OrderedOperand::Expr(left, left_mode), OrderedOperand::Expr(right, text_mode(right))];
        let (before, sides) = self.sequence(&operands, |_| false);
        match sides.as_slice() {
            [left, right] => Fragment::new(infix(BinaryOp::Add, left, right), Precedence::Sum).after(before),
            _ => constant(&Value::String("".into())),
        }
    }
}

/// Whether an expression begins with a minus sign.
fn is_signed(value: &TokenStream) -> bool {
    matches!(value.clone().into_iter().next(), Some(TokenTree::Punct(sign)) if sign.as_char() == '-')
}

/// The value of an enumeration that is used as a number.
fn enumeration(expr: &Expr) -> Option<(Enum, &Expr)> {
    match &expr.kind {
        ExprKind::Convert(inner) => match inner.ty.base {
            Base::Enum(id) => Some((id, inner)),
            _ => None,
        },
        _ => None,
    }
}

/// The enumeration constant for a known number.
fn constant_of(id: Enum, expr: &Expr) -> Option<Fragment> {
    let ExprKind::Const(Value::Int(index)) = expr.kind else { return None };
    let index = u16::try_from(index).ok().filter(|index| usize::from(*index) < id.def().constants.len())?;
    Some(constant(&Value::Enum(id, index)))
}

/// Whether the left operand must show its type: the receiver of a method, the first argument of a shift.
fn needs_type(op: BinaryOp) -> bool {
    use BinaryOp::*;
    matches!(op, Add | Subtract | Multiply | ShiftLeft | ShiftRight)
}

/// The mode of a string to be appended: a literal as it is, a local variable by reference.
pub(super) fn text_mode(expr: &Expr) -> Mode {
    match &expr.kind {
        ExprKind::Const(Value::String(_)) => Mode::Compared,
        ExprKind::Place(place) if matches!(place.root, Root::Local(_)) => Mode::Reference,
        _ => Mode::Value,
    }
}

/// Whether an operation may end in an alarm.
pub(super) fn may_fail(op: BinaryOp, ty: Type, known: Option<&Value>) -> bool {
    match op {
        BinaryOp::Divide => ty.base != Base::Double && !known.is_some_and(is_divisor),
        BinaryOp::Remainder => !known.is_some_and(is_divisor),
        BinaryOp::ShiftLeft | BinaryOp::ShiftRight => known.is_none(),
        _ => false,
    }
}

/// Whether a number is not zero, so that dividing by it needs no check.
fn is_divisor(value: &Value) -> bool {
    !matches!(value, Value::Int(0) | Value::Uint(0) | Value::Byte(0)) && *value != Value::Double(0.0)
}

/// rustc warns about comparisons that a literal decides alone; a named limit shows the intention. With `least`, the
/// side is checked for the least value of its type, otherwise for the greatest.
fn limit(side: Fragment, base: Base, least: bool) -> Fragment {
    let text = side.tokens.to_string();
    let text = text.trim_end_matches(base_suffix(base));
    let tokens = match (base, least, text) {
        (Base::Int, false, "2147483647") => quote!(i32::MAX),
        (Base::Byte, true, "0") => quote!(u8::MIN),
        (Base::Byte, false, "255") => quote!(u8::MAX),
        (Base::Uint, true, "0") => quote!(u32::MIN),
        (Base::Uint, false, "4294967295") => quote!(u32::MAX),
        _ => return side,
    };
    Fragment { tokens, ..side }
}

/// rustc warns about comparisons with the name NAN, which no number equals; with a sign the result is the same.
fn nan_with_sign(side: Fragment) -> Fragment {
    let is_nan = side.tokens.to_string() == quote!(f64::NAN).to_string();
    if is_nan { Fragment::new(quote!(-f64::NAN), Precedence::Unary) } else { side }
}

fn base_suffix(base: Base) -> &'static str {
    match base {
        Base::Int => "i32",
        Base::Uint => "u32",
        _ => "u8",
    }
}

/// The operator that is true where `op` is false; not for ordering doubles, because nan is unordered.
fn opposite(op: BinaryOp, ty: Type) -> Option<BinaryOp> {
    let ordered = ty.base != Base::Double;
    match op {
        BinaryOp::Equal => Some(BinaryOp::NotEqual),
        BinaryOp::NotEqual => Some(BinaryOp::Equal),
        BinaryOp::Less if ordered => Some(BinaryOp::GreaterEqual),
        BinaryOp::GreaterEqual if ordered => Some(BinaryOp::Less),
        BinaryOp::Greater if ordered => Some(BinaryOp::LessEqual),
        BinaryOp::LessEqual if ordered => Some(BinaryOp::Greater),
        _ => None,
    }
}

/// How tightly an operator binds.
pub(super) fn precedence(op: BinaryOp) -> Precedence {
    match op {
        BinaryOp::Add | BinaryOp::Subtract => Precedence::Sum,
        BinaryOp::Multiply | BinaryOp::Divide | BinaryOp::Remainder => Precedence::Product,
        BinaryOp::ShiftLeft | BinaryOp::ShiftRight => Precedence::Shift,
        BinaryOp::BitAnd => Precedence::BitAnd,
        BinaryOp::BitXor => Precedence::BitXor,
        BinaryOp::BitOr => Precedence::BitOr,
        BinaryOp::And => Precedence::And,
        BinaryOp::Or => Precedence::Or,
        _ => Precedence::Compare,
    }
}

/// `left op right`
pub(super) fn infix(op: BinaryOp, left: &Fragment, right: &Fragment) -> TokenStream {
    let own = precedence(op);
    let left = left.at(if own == Precedence::Compare { own.tighter() } else { own });
    let right = right.at(own.tighter());
    let sign = sign(op);
    quote!(#left #sign #right)
}

/// The operator in Rust.
pub(super) fn sign(op: BinaryOp) -> TokenStream {
    match op {
        BinaryOp::Add => quote!(+),
        BinaryOp::Subtract => quote!(-),
        BinaryOp::Multiply => quote!(*),
        BinaryOp::Divide => quote!(/),
        BinaryOp::Remainder => quote!(%),
        BinaryOp::ShiftLeft => quote!(<<),
        BinaryOp::ShiftRight => quote!(>>),
        BinaryOp::Less => quote!(<),
        BinaryOp::LessEqual => quote!(<=),
        BinaryOp::Greater => quote!(>),
        BinaryOp::GreaterEqual => quote!(>=),
        BinaryOp::Equal => quote!(==),
        BinaryOp::NotEqual => quote!(!=),
        BinaryOp::BitAnd => quote!(&),
        BinaryOp::BitXor => quote!(^),
        BinaryOp::BitOr => quote!(|),
        BinaryOp::And => quote!(&&),
        BinaryOp::Or => quote!(||),
    }
}
