//! Strings.

use super::body::FunctionCode;
use super::operators::comparison;
use super::places::Spot;
use crate::hir::{Expr, ExprKind, Value};
use arl_code::{Extent, Op, Place, Reg, Space};
use arl_lang::ast::BinaryOp;
use arl_lang::catalog::Base;

/// The extent of one string.
pub(super) const ONE_TEXT: Extent = Extent { words: 0, texts: 1, handles: 0 };

impl<'p> FunctionCode<'p, '_> {
    /// A string of the frame: that of the variable, if the expression is one of the frame.
    pub(super) fn text(&mut self, expr: &'p Expr) -> u16 {
        if let ExprKind::Place(place) = &expr.kind
            && self.constant(expr).is_none()
        {
            let spot = self.spot(place);
            if let Some(text) = spot.frame_text() {
                return self.slot_number(text);
            }
            let to = self.text_slot();
            self.load_text(spot, to);
            return to;
        }
        let to = self.text_slot();
        self.text_to(expr, to);
        to
    }

    /// A string that later expressions do not change.
    pub(super) fn steady_text(&mut self, expr: &'p Expr, later: &[&'p Expr]) -> u16 {
        let from = self.text(expr);
        if !self.is_disturbed(expr, later) {
            return from;
        }
        let to = self.text_slot();
        self.op(Op::CopyText { to, from });
        to
    }

    /// Puts a string into a slot of the frame, which the expression does not read.
    pub(super) fn text_to(&mut self, expr: &'p Expr, to: u16) {
        if let Some(Value::String(text)) = self.constant(expr) {
            let at = self.lowering.text(text);
            self.op(Op::Text { to, at });
            return;
        }
        match &expr.kind {
            ExprKind::Place(place) => self.passing(|body| {
                let spot = body.spot(place);
                body.load_text(spot, to);
            }),
            ExprKind::Binary(BinaryOp::Add, sides) => {
                self.text_to(&sides.0, to);
                self.passing(|body| {
                    let right = body.text(&sides.1);
                    body.op(Op::Join { to, right });
                });
            }
            ExprKind::Grown(sum) => {
                self.text_to(sum, to);
                let line = self.line;
                self.op(Op::CheckLength { of: to, line });
            }
            ExprKind::Call(id, args) => self.passing(|body| {
                let result = body.call(*id, args, expr.ty);
                let from = body.slot_number(result.text);
                body.op(Op::CopyText { to, from });
            }),
            ExprKind::Builtin(builtin) => self.passing(|body| body.builtin(builtin, text_place(to))),
            ExprKind::Assign(sides) => self.passing(|body| {
                let spot = body.assign(&sides.0, &sides.1);
                body.load_text(spot, to);
            }),
            ExprKind::AssignOp(op, sides) => self.passing(|body| {
                let spot = body.assign_op(*op, &sides.0, &sides.1);
                body.load_text(spot, to);
            }),
            ExprKind::FieldOf(inner, id, index) => self.passing(|body| {
                let whole = body.space_of(inner.ty);
                body.set_new(Spot::new(whole, inner.ty), inner);
                let component = whole.after(Extent::before(*id, *index, body.family()));
                body.load_text(Spot::new(component, expr.ty), to);
            }),
            _ => debug_assert!(false, "no string: {expr:?}"),
        }
    }

    /// Copies a string into a slot of the frame.
    pub(super) fn load_text(&mut self, spot: Spot, to: u16) {
        let at = spot.place.text;
        match (spot.place.space, spot.place.element) {
            (Space::Frame, None) => {
                let from = self.slot_number(at);
                if from != to {
                    self.op(Op::CopyText { to, from });
                }
            }
            (Space::Global, None) => {
                self.op(Op::LoadGlobalText { to, at });
            }
            (Space::Frame, Some((index, one))) if one == ONE_TEXT => {
                self.op(Op::LoadText { to, index, at });
            }
            _ => {
                self.transfer(spot.place, text_place(to), ONE_TEXT);
            }
        }
    }

    /// Writes a string of the frame to a place.
    pub(super) fn store_text(&mut self, spot: Spot, from: u16) {
        let at = spot.place.text;
        match (spot.place.space, spot.place.element) {
            (Space::Frame, None) => {
                let to = self.slot_number(at);
                if from != to {
                    self.op(Op::CopyText { to, from });
                }
            }
            (Space::Global, None) => {
                self.op(Op::StoreGlobalText { from, at });
            }
            (Space::Frame, Some((index, one))) if one == ONE_TEXT => {
                self.op(Op::StoreText { from, index, at });
            }
            _ => {
                self.transfer(text_place(from), spot.place, ONE_TEXT);
            }
        }
    }

    /// `text += more`
    pub(super) fn append(&mut self, spot: Spot, more: &'p Expr) {
        let line = self.line;
        let more = self.text(more);
        match (spot.place.space, spot.place.element) {
            (Space::Frame, None) => {
                let to = self.slot_number(spot.place.text);
                self.op(Op::Append { to, more, line });
            }
            (Space::Global, None) => {
                self.op(Op::AppendGlobal { to: spot.place.text, more, line });
            }
            _ => {
                let to = self.text_slot();
                self.load_text(spot, to);
                self.op(Op::Append { to, more, line });
                self.store_text(spot, to);
            }
        }
    }

    /// A comparison of strings.
    pub(super) fn compared_texts(&mut self, op: BinaryOp, left: &'p Expr, right: &'p Expr, wanted: Option<Reg>) -> Reg {
        let to = self.register_or(wanted);
        self.passing(|body| {
            let left = body.steady_text(left, &[right]);
            let right = body.text(right);
            let Some(compared) = comparison(op, Base::String) else { return };
            let (left, right) = if compared.swapped { (right, left) } else { (left, right) };
            body.op(Op::CompareTexts { to, left, right, by: compared.by });
            if compared.negated {
                body.op(Op::NotBool { to, from: to });
            }
        });
        to
    }
}

/// A string of the frame as a place.
pub(super) fn text_place(slot: u16) -> Place {
    Place { text: u32::from(slot), ..Place::start(Space::Frame) }
}
