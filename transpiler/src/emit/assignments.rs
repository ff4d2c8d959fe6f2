//! Assignments, `++` and `--`, as statements and as values.

use super::body::Body;
use super::compound::{is_native, stepped};
use super::consts::{constant, typed_constant};
use super::fragment::Fragment;
use super::operators::{may_fail, text_mode};
use super::places::{Calm, Reached, Written};
use super::sequence::{Mode, OrderedOperand};
use super::types::is_copy;
use crate::effects::{facts, growth};
use crate::hir::{Expr, ExprKind, Place, Projection, Value};
use arl_lang::ast::{BinaryOp, Step};
use proc_macro2::TokenStream;
use quote::quote;

impl<'p> Body<'p, '_> {
    /// An assignment, `++` or `--` whose value is not used.
    pub(super) fn assignment(&mut self, expr: &'p Expr) -> TokenStream {
        if let Some(value) = facts::same_anyway(expr) {
            return self.assignment(value);
        }
        match &expr.kind {
            ExprKind::Assign(sides) => self.assign(&sides.0, &sides.1, false).0,
            ExprKind::AssignOp(op, sides) => self.assign_op(*op, &sides.0, &sides.1, false).0,
            ExprKind::Step(step, place) => self.step(Step { prefix: true, ..*step }, place, false).0,
            _ => TokenStream::new(),
        }
    }

    /// An assignment, `++` or `--` as a value: the assignment goes before it. `typed`: a constant must show its type.
    pub(super) fn assignment_value(&mut self, expr: &'p Expr, typed: bool) -> Fragment {
        if let Some(value) = facts::same_anyway(expr) {
            return self.value(value);
        }
        let (before, place) = match &expr.kind {
            ExprKind::Assign(sides) => {
                let (before, place) = self.assign(&sides.0, &sides.1, true);
                if let Some(known) = self.constant(&sides.1) {
                    let value = if typed { typed_constant(known) } else { constant(known) };
                    return value.after(before);
                }
                (before, place)
            }
            ExprKind::AssignOp(op, sides) => self.assign_op(*op, &sides.0, &sides.1, true),
            ExprKind::Step(step, place) => {
                let (before, place, old) = self.step(*step, place, true);
                if let Some(old) = old {
                    return old.after(before);
                }
                (before, place)
            }
            _ => return constant(&Value::Int(0)),
        };
        self.read_reached(&place).after(before)
    }

    /// `place = value`; `keep`: the place is read afterwards.
    fn assign(&mut self, place: &'p Place, value: &'p Expr, keep: bool) -> (TokenStream, Reached) {
        if let Some(more) = growth::appended(self.scope(), place, value) {
            return self.append_parts(place, &more);
        }
        if let Some((op, by)) = stepped(place, value) {
            return self.assign_op(op, place, by, keep);
        }
        let facts = self.facts(value);
        let item = matches!(place.path.as_slice(), [Projection::Index(..)]) && self.plain_local(place.root).is_none();
        let settle = keep || !(item || (self.plain_local(place.root).is_some() && facts.quiet()));
        let (before, reached, value_fragment) = self.sides(place, Some((value, Mode::Placed)), settle);
        let fragment = self.limited(place, value_fragment, Some(value));
        if let Some(declared) = self.deferred_let(place, Some(value)) {
            let (first, tokens) = (&fragment.before, &fragment.tokens);
            return (quote!(#before #first #declared = #tokens;), reached);
        }
        let write = self.write(&reached, Written::Value(fragment), Calm::of(&facts));
        (quote!(#before #write), reached)
    }

    /// `place op= value`: the old value is read first.
    fn assign_op(&mut self, op: BinaryOp, place: &'p Place, value: &'p Expr, keep: bool) -> (TokenStream, Reached) {
        let appends = growth::appends(op, place);
        if appends {
            let more = growth::parts(value);
            if growth::may_append(self.scope(), place, &more) {
                return self.append_parts(place, &more);
            }
        }
        let facts = self.facts(value);
        let own = facts::of_place(self.scope(), place);
        let disturbed =
            own.reads.iter().any(|read| facts.writes.contains(read)) || (own.world && (facts.acts || facts.waits));
        let limited = facts::limit(place, None).is_some();
        let native = is_native(op, place, value) && !disturbed && !limited;
        let settle = keep || !(native && facts.quiet() && self.plain_local(place.root).is_some());
        if disturbed {
            let (mut before, reached, _) = self.sides(place, None, true);
            let old = self.read_reached(&reached);
            let old = self.settle(old, "old");
            before.extend(old.before.clone());
            let right = self.value(value);
            before.extend(right.before.clone());
            let known = self.constant(value);
            let new = self.operation(op, place.ty, Fragment { before: TokenStream::new(), ..old }, &right, known);
            let new = if appends { self.fitting(new) } else { new };
            let new = self.limited(place, new, None);
            let write = self.write(&reached, Written::Value(new), Calm::No);
            return (quote!(#before #write), reached);
        }
        let (before, reached, right) = self.sides(place, Some((value, Mode::Value)), settle);
        let known = self.constant(value);
        let fails = limited || may_fail(op, place.ty, known);
        let written = if fails || !is_copy(place.ty) {
            let old = self.read_reached(&reached);
            let new = self.operation(op, place.ty, old, &right, known);
            let new = if appends { self.fitting(new) } else { new };
            Written::Value(self.limited(place, new, None).after(right.before))
        } else {
            Written::Step { op, value: right, known, native }
        };
        // The old value is copied, which must not happen while the variable is being changed.
        let calm = if fails || !is_copy(place.ty) { Calm::No } else { Calm::of(&facts) };
        let write = self.write(&reached, written, calm);
        (quote!(#before #write), reached)
    }

    /// `++`, `--`. With `keep`, also the value: the place to read, or the old value.
    fn step(&mut self, step: Step, place: &'p Place, keep: bool) -> (TokenStream, Reached, Option<Fragment>) {
        let simple = place.path.is_empty();
        let (before, reached, _) = self.sides(place, None, !simple || keep);
        if step.prefix && facts::limit(place, None).is_none() {
            let op = if step.up { BinaryOp::Add } else { BinaryOp::Subtract };
            let one = constant(&Value::Int(1));
            let written = Written::Step { op, value: one, known: None, native: false };
            let write = self.write(&reached, written, Calm::Local);
            return (quote!(#before #write), reached, None);
        }
        let read = self.read_reached(&reached);
        let old = if step.prefix { read } else { self.settle(read, "old") };
        let (old_before, receiver) = (&old.before, old.receiver());
        let method = if step.up { quote!(wrapping_add) } else { quote!(wrapping_sub) };
        let new = Fragment::postfix(quote!(#receiver.#method(1)));
        let new = self.limited(place, new, None);
        let write = self.write(&reached, Written::Value(new), Calm::No);
        let old_value = (!step.prefix).then(|| Fragment { before: TokenStream::new(), ..old.clone() });
        (quote!(#before #old_before #write), reached, old_value)
    }

    /// The indices of a place and a value, in order. The returned statements include those that the value needs.
    fn sides(
        &mut self,
        place: &'p Place,
        value: Option<(&'p Expr, Mode)>,
        settle: bool,
    ) -> (TokenStream, Reached, Fragment) {
        let mut operands = Self::index_operands(place);
        let count = operands.len();
        operands.extend(value.map(|(value, mode)| OrderedOperand::Expr(value, mode)));
        let (before, mut fragments) = self.sequence(&operands, |at| settle && at < count);
        let value = match value {
            Some(_) => fragments.pop(),
            None => None,
        };
        let reached = self.reached(place, fragments);
        (before, reached, value.unwrap_or_else(|| Fragment::settled(quote!(()))))
    }

    fn append_parts(&mut self, place: &'p Place, parts: &[&'p Expr]) -> (TokenStream, Reached) {
        let reached = self.reached(place, []);
        let mut out = TokenStream::new();
        for part in parts {
            let facts = self.facts(part);
            let fragment = self.expression(part, text_mode(part));
            out.extend(self.append_to(&reached, fragment, Calm::of(&facts)));
        }
        (out, reached)
    }
}
