//! Operands in order: ARL evaluates from left to right, even where Rust would not.
//!
//! An operand may need statements before the expression (for example for an assignment inside it). These would run
//! before the operands to its left, which therefore go into temporaries wherever the difference could be noticed.

use super::body::Body;
use super::fragment::{Fragment, Precedence};
use crate::effects::facts::{self, Facts};
use crate::hir::{Expr, Type};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// The form in which a value is needed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Mode {
    /// As an owned value.
    Value,
    /// As an owned value where the type of a number does not follow from the context.
    Typed,
    /// As the value of a variable, whose type determines the type of a number.
    Placed,
    /// As `&T`.
    Reference,
    /// As `&dyn Print`.
    Printed,
    /// As an operand of a comparison, which only reads it.
    Compared,
}

/// An operand that is evaluated in order.
#[derive(Clone, Copy, Debug)]
pub(super) enum OrderedOperand<'p> {
    /// An expression.
    Expr(&'p Expr, Mode),
    /// Indices into an array of this type, together one `usize`.
    Index(&'p [Expr], Type),
}

impl<'p> Body<'p, '_> {
    /// Evaluates operands in order. Returns the statements that go first, and the expressions. If `settle` returns true
    /// for an operand, it goes into a temporary unless it is constant.
    pub(super) fn sequence(
        &mut self,
        operands: &[OrderedOperand<'p>],
        settle: impl Fn(usize) -> bool,
    ) -> (TokenStream, Vec<Fragment>) {
        let mut fragments: Vec<Fragment> = operands.iter().map(|operand| self.operand(*operand)).collect();
        let moved = |at: usize, fragment: &Fragment| !fragment.before.is_empty() || (settle(at) && !fragment.settled);
        let last = fragments.iter().enumerate().rposition(|(at, fragment)| moved(at, fragment));
        let mut before = TokenStream::new();
        for (at, operand) in operands.iter().enumerate() {
            let Some(fragment) = fragments.get_mut(at) else { continue };
            let rest = operands.get(at + 1..=last.unwrap_or(0)).unwrap_or(&[]);
            let disturbed = || {
                let own = self.operand_facts(operand);
                rest.iter().any(|later| own.disturbed_by(&self.operand_facts(later)))
            };
            if !fragment.settled && (settle(at) || (Some(at) < last && disturbed())) {
                *fragment = self.settled_operand(*operand, std::mem::replace(fragment, Fragment::settled(quote!(()))));
            }
            before.extend(std::mem::take(&mut fragment.before));
        }
        (before, fragments)
    }

    fn operand(&mut self, operand: OrderedOperand<'p>) -> Fragment {
        match operand {
            OrderedOperand::Expr(expr, mode) => self.expression(expr, mode),
            OrderedOperand::Index(indices, ty) => self.index(indices, ty),
        }
    }

    fn settled_operand(&mut self, operand: OrderedOperand<'p>, fragment: Fragment) -> Fragment {
        match operand {
            OrderedOperand::Index(..) => self.settle(fragment, "at"),
            OrderedOperand::Expr(_, Mode::Value | Mode::Typed | Mode::Placed) => self.settle(fragment, "value"),
            OrderedOperand::Expr(expr, mode) => {
                let value = self.expression(expr, Mode::Value);
                let value = self.settle(value, "value");
                match mode {
                    Mode::Reference | Mode::Printed => {
                        let reference = value.map(Precedence::Unary, |value| {
                            let value = value.at(Precedence::Unary);
                            quote!(&#value)
                        });
                        if mode == Mode::Printed { nested(reference, expr.ty) } else { reference }
                    }
                    Mode::Value | Mode::Typed | Mode::Placed | Mode::Compared => value,
                }
            }
        }
    }

    /// The facts about the evaluation of an operand.
    pub(super) fn operand_facts(&self, operand: &OrderedOperand<'p>) -> Facts {
        match operand {
            OrderedOperand::Expr(expr, _) => self.facts(expr),
            OrderedOperand::Index(indices, array) => facts::of_indices(self.scope(), indices, *array),
        }
    }
}

/// A reference for printing, with the sizes of a multidimensional array, which is flat in Rust.
pub(super) fn nested(reference: Fragment, ty: Type) -> Fragment {
    if ty.dims().len() < 2 {
        return reference;
    }
    let sizes = ty.dims().iter().map(|size| Literal::u16_unsuffixed(*size));
    reference.map(Precedence::Unary, |array| {
        let array = &array.tokens;
        quote!(&text::nested(#array, &[#(#sizes),*]))
    })
}
