//! Expressions.

use super::body::Body;
use super::consts::{constant, typed_constant};
use super::fragment::{Fragment, Precedence};
use super::names::ident;
use super::operators::infix;
use super::sequence::{Mode, OrderedOperand, nested};
use super::types::{array_type, base_type, component, is_copy, start_value, type_name};
use crate::hir::{Expr, ExprKind, Type, Value};
use arl_lang::ast::{BinaryOp, UnaryOp};
use arl_lang::catalog::{Base, Struct};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

impl<'p> Body<'p, '_> {
    /// An expression in the wanted mode.
    pub(super) fn expression(&mut self, expr: &'p Expr, mode: Mode) -> Fragment {
        if let Some(column) = self.position.columns.of(expr, mode) {
            return column;
        }
        match mode {
            Mode::Value => self.value(expr),
            Mode::Typed => self.typed_value(expr),
            Mode::Placed => match &expr.kind {
                ExprKind::Assign(_) => self.assignment_value(expr, false),
                _ => self.value(expr),
            },
            Mode::Reference => self.reference(expr),
            Mode::Printed => self.printed(expr),
            Mode::Compared => self.compared(expr),
        }
    }

    /// An expression as a value to keep.
    pub(super) fn value(&mut self, expr: &'p Expr) -> Fragment {
        match &expr.kind {
            ExprKind::Const(value) => self.position.columns.of(expr, Mode::Value).unwrap_or_else(|| constant(value)),
            ExprKind::Place(place) => self.read(place),
            ExprKind::FieldOf(inner, id, index) => {
                let field = component(*id, *index, self.family());
                self.value(inner).map(Precedence::Postfix, |value| {
                    let value = value.receiver();
                    quote!(#value.#field)
                })
            }
            ExprKind::Convert(inner) => self.conversion(inner, expr.ty),
            ExprKind::Unary(UnaryOp::Not, inner) => self.negated(inner),
            ExprKind::Unary(op, inner) => self.unary(*op, inner),
            ExprKind::Binary(op, sides) => self.binary(*op, &sides.0, &sides.1),
            ExprKind::Grown(sum) => {
                let sum = self.value(sum);
                self.fitting(sum)
            }
            ExprKind::Assign(_) | ExprKind::AssignOp(..) | ExprKind::Step(..) => self.assignment_value(expr, true),
            ExprKind::Call(id, args) => self.call(*id, args),
            ExprKind::Builtin(builtin) => match self.template_call(expr, builtin) {
                Some(call) => call,
                None => self.builtin(builtin),
            },
            ExprKind::Struct(id, values) => self.structure(*id, values),
            ExprKind::Array(values) => self.array(expr.ty, values),
            ExprKind::Splice(number) => {
                let name = ident(&format!("splice_{number}"));
                Fragment::postfix(quote!(#name))
            }
        }
    }

    /// The value as the receiver of a method, or as an argument whose type does not follow from anything else.
    pub(super) fn typed_value(&mut self, expr: &'p Expr) -> Fragment {
        match &expr.kind {
            ExprKind::Const(value) => {
                self.position.columns.of(expr, Mode::Value).unwrap_or_else(|| typed_constant(value))
            }
            _ => self.value(expr),
        }
    }

    /// `&value`, without copying the value of a variable if possible.
    pub(super) fn reference(&mut self, expr: &'p Expr) -> Fragment {
        let inner = match &expr.kind {
            ExprKind::Place(place) => self.look_at(place),
            _ => self.value(expr),
        };
        inner.map(Precedence::Unary, |value| {
            let value = value.at(Precedence::Unary);
            quote!(&#value)
        })
    }

    /// The value for an argument that may be anything printable.
    fn printed(&mut self, expr: &'p Expr) -> Fragment {
        match &expr.kind {
            ExprKind::Const(Value::String(text)) => {
                Fragment { settled: true, ..Fragment::new(quote!(&#text), Precedence::Unary) }
            }
            ExprKind::Const(value @ (Value::Uint(_) | Value::Byte(_))) => {
                typed_constant(value).map(Precedence::Unary, |value| {
                    let tokens = &value.tokens;
                    quote!(&#tokens)
                })
            }
            _ => nested(self.reference(expr), expr.ty),
        }
    }

    /// The value as an operand of a comparison.
    fn compared(&mut self, expr: &'p Expr) -> Fragment {
        match &expr.kind {
            ExprKind::Const(Value::String(text)) => Fragment::settled(quote!(#text)),
            ExprKind::Place(place) => self.look_at(place),
            _ => self.value(expr),
        }
    }

    /// A condition at a place where no statement can precede it.
    pub(super) fn inline_value(&mut self, expr: &'p Expr) -> Fragment {
        self.value(expr).inline()
    }

    /// `index(i, 6).at(FILE, 3)?`, or the number if it is known.
    pub(super) fn index(&mut self, indices: &'p [Expr], array: Type) -> Fragment {
        if let Some(at) = self.known_index(indices, array) {
            let at = Literal::usize_unsuffixed(at);
            return Fragment::settled(quote!(#at));
        }
        if self.locals.ranges.are_inside(indices, array) {
            return self.sure_index(indices, array);
        }
        let sizes: Vec<Literal> = array.dims().iter().map(|size| Literal::u16_unsuffixed(*size)).collect();
        let operands: Vec<_> = indices.iter().map(|index| OrderedOperand::Expr(index, Mode::Value)).collect();
        let (before, indices) = self.sequence(&operands, |_| false);
        let indices: Vec<&TokenStream> = indices.iter().map(|index| &index.tokens).collect();
        let call = match (indices.as_slice(), sizes.as_slice()) {
            ([index], [size]) => quote!(index(#index, #size)),
            _ => quote!(index2([#(#indices),*], [#(#sizes),*])),
        };
        Fragment::postfix(self.checked(call)).after(before)
    }

    /// `i as usize * 3 + k as usize`, if the indices cannot leave the array.
    fn sure_index(&mut self, indices: &'p [Expr], array: Type) -> Fragment {
        let operands: Vec<_> = indices.iter().map(|index| OrderedOperand::Expr(index, Mode::Value)).collect();
        let (before, fragments) = self.sequence(&operands, |_| false);
        let mut known = 0;
        let mut terms: Vec<TokenStream> = Vec::new();
        for (at, fragment) in fragments.iter().enumerate() {
            let row: usize = array.dims().iter().skip(at + 1).map(|size| usize::from(*size)).product();
            if let Some(Value::Int(index)) = indices.get(at).and_then(|index| self.constant(index)) {
                known += usize::try_from(*index).unwrap_or(0) * row;
                continue;
            }
            let index = fragment.at(Precedence::Cast);
            let row = Literal::usize_unsuffixed(row);
            terms.push(if row.to_string() == "1" { quote!(#index as usize) } else { quote!(#index as usize * #row) });
        }
        if known > 0 {
            let known = Literal::usize_unsuffixed(known);
            terms.push(quote!(#known));
        }
        let precedence = match terms.as_slice() {
            [_] if array.dims().len() == 1 => Precedence::Cast,
            _ => Precedence::Sum,
        };
        // Loop counters do not change within a round.
        let settled = indices.iter().all(|index| self.locals.ranges.is_counted(index));
        Fragment { settled, ..Fragment::new(quote!(#(#terms)+*), precedence) }.after(before)
    }

    fn known_index(&self, indices: &'p [Expr], array: Type) -> Option<usize> {
        let mut at = 0;
        for (index, size) in indices.iter().zip(array.dims()) {
            let Value::Int(index) = self.constant(index)? else { return None };
            let index = usize::try_from(*index).ok().filter(|index| *index < usize::from(*size))?;
            at = at * usize::from(*size) + index;
        }
        Some(at)
    }

    /// An implicit conversion.
    fn conversion(&mut self, inner: &'p Expr, to: Type) -> Fragment {
        let from = inner.ty.base;
        if let (Base::Enum(id), Some(Value::Int(index))) = (to.base, self.constant(inner)) {
            return constant(&Value::Enum(id, u16::try_from(*index).unwrap_or(0)));
        }
        let index = |value: &Fragment| {
            let value = value.receiver();
            quote!(#value.index())
        };
        match (from, to.base) {
            (from, to) if from == to => self.value(inner),
            (_, Base::Bool) => self.as_condition(inner, true),
            (Base::Enum(_), Base::Int) => self.value(inner).map(Precedence::Postfix, index),
            (Base::Enum(_), base) => {
                let ty = base_type(base, self.family());
                self.value(inner).map(Precedence::Postfix, |value| {
                    let index = index(value);
                    if base == Base::Double { quote!(#ty::from(#index)) } else { quote!((#index as #ty)) }
                })
            }
            (_, base) => {
                let ty = base_type(base, self.family());
                self.typed_value(inner).map(Precedence::Postfix, |value| {
                    let value = &value.tokens;
                    quote!(#ty::from(#value))
                })
            }
        }
    }

    /// A number as a condition: every value but zero is true. With `wanted` false, the opposite.
    pub(super) fn as_condition(&mut self, inner: &'p Expr, wanted: bool) -> Fragment {
        let op = if wanted { BinaryOp::NotEqual } else { BinaryOp::Equal };
        let zero = match inner.ty.base {
            Base::Bool => return self.truth(inner, wanted),
            Base::Double => constant(&Value::Double(0.0)),
            Base::Enum(id) => constant(&Value::Enum(id, 0)),
            _ => constant(&Value::Int(0)),
        };
        self.typed_value(inner).map(Precedence::Compare, |value| infix(op, value, &zero))
    }

    /// `Pose { x: 1.0, ..Pose::default() }`, with the components in the order of the program.
    fn structure(&mut self, id: Struct, values: &'p [Option<Expr>]) -> Fragment {
        let family = self.family();
        let name = type_name(Base::Struct(id), family);
        let mut given: Vec<(usize, &Expr)> =
            values.iter().enumerate().filter_map(|(at, value)| Some((at, value.as_ref()?))).collect();
        if given.is_empty() {
            return Fragment::postfix(quote!(#name::default()));
        }
        given.sort_by_key(|(_, value)| value.span.start);
        let operands: Vec<_> = given.iter().map(|(_, value)| OrderedOperand::Expr(value, Mode::Value)).collect();
        let (before, fragments) = self.sequence(&operands, |_| false);
        let fields = given.iter().zip(&fragments).map(|((at, _), value)| {
            let (field, value) = (component(id, *at, family), &value.tokens);
            if field == value.to_string() { quote!(#field) } else { quote!(#field: #value) }
        });
        let all = given.len() == id.def(family).components.len();
        let rest = if all { TokenStream::new() } else { quote!(..#name::default()) };
        Fragment::postfix(quote!(#name { #(#fields,)* #rest })).after(before)
    }

    /// `SmallArray::<i32, 3>::from_values(&[1, 2, 3])`
    fn array(&mut self, ty: Type, values: &'p [Expr]) -> Fragment {
        let family = self.family();
        if values.is_empty() {
            return Fragment::postfix(start_value(ty, family));
        }
        let operands: Vec<_> = values.iter().map(|value| OrderedOperand::Expr(value, Mode::Value)).collect();
        let (before, values) = self.sequence(&operands, |_| false);
        let values = values.iter().map(|value| &value.tokens);
        let (array, element) = (array_type(ty, family), base_type(ty.base, family));
        let count = Literal::usize_unsuffixed(ty.len());
        Fragment::postfix(quote!(#array::<#element, #count>::from_values(&[#(#values),*]))).after(before)
    }

    /// The value of a place that has been read, as an owned copy if it is not `Copy`.
    pub(super) fn owned(place: Fragment, ty: Type) -> Fragment {
        if is_copy(ty) {
            return place;
        }
        place.map(Precedence::Postfix, |place| {
            let place = place.receiver();
            quote!(#place.clone())
        })
    }
}
