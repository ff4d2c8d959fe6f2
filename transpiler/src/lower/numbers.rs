//! Expressions whose value is a number: it fits into a register.

use super::body::FunctionCode;
use super::places::Spot;
use super::tables::constant_word;
use super::variables::is_number;
use crate::effects::growth;
use crate::hir::{Expr, ExprKind, Place as HirPlace, Type};
use arl_code::{Extent, Op, Place, Reg, Space};
use arl_lang::ast::{BinaryOp, Step, UnaryOp};
use arl_lang::catalog::Base;

impl<'p> FunctionCode<'p, '_> {
    /// A number in a register: in the wanted one; otherwise that of the variable, if the expression is one.
    ///
    /// The wanted register may be that of a variable that the expression reads: it is written last.
    pub(super) fn number(&mut self, expr: &'p Expr, wanted: Option<Reg>) -> Reg {
        if let Some(word) = self.constant(expr).and_then(constant_word) {
            let to = self.register_or(wanted);
            self.word_to(to, word);
            return to;
        }
        match &expr.kind {
            ExprKind::Place(place) => {
                let spot = self.spot(place);
                self.load(spot, wanted)
            }
            ExprKind::FieldOf(inner, id, index) => {
                let to = self.register_or(wanted);
                self.passing(|body| {
                    let whole = body.space_of(inner.ty);
                    body.set_new(Spot::new(whole, inner.ty), inner);
                    let component = whole.after(Extent::before(*id, *index, body.family()));
                    body.load(Spot::new(component, expr.ty), Some(to));
                });
                to
            }
            ExprKind::Convert(inner) => self.conversion(inner, expr.ty, wanted),
            ExprKind::Unary(op, inner) => self.unary(*op, inner, expr, wanted),
            ExprKind::Binary(op, sides) => self.binary(*op, &sides.0, &sides.1, expr, wanted),
            ExprKind::Assign(sides) => {
                let spot = self.assign(&sides.0, &sides.1);
                self.load(spot, wanted)
            }
            ExprKind::AssignOp(op, sides) => {
                let spot = self.assign_op(*op, &sides.0, &sides.1);
                self.load(spot, wanted)
            }
            ExprKind::Step(step, place) => self.step(*step, place, true, wanted),
            ExprKind::Call(id, args) => {
                let place = self.call(*id, args, expr.ty);
                self.load(Spot::new(place, expr.ty), wanted)
            }
            ExprKind::Builtin(builtin) => {
                let to = self.register_or(wanted);
                self.builtin(builtin, Place::start(Space::Register(to)));
                to
            }
            ExprKind::Const(_)
            | ExprKind::Grown(_)
            | ExprKind::Struct(..)
            | ExprKind::Array(_)
            | ExprKind::Splice(_) => {
                debug_assert!(false, "no number: {expr:?}");
                self.register_or(wanted)
            }
        }
    }

    /// A number that later expressions do not change.
    pub(super) fn steady_number(&mut self, expr: &'p Expr, later: &[&'p Expr]) -> Reg {
        let from = self.number(expr, None);
        if !self.is_disturbed(expr, later) {
            return from;
        }
        let to = self.register();
        self.op(Op::Copy { to, from });
        to
    }

    /// Puts a constant into a register.
    pub(super) fn word_to(&mut self, to: Reg, word: u64) {
        match u32::try_from(word) {
            Ok(value) => self.op(Op::Small { to, value: value as i32 }),
            Err(_) => {
                let at = self.lowering.word(word);
                self.op(Op::Word { to, at })
            }
        };
    }

    /// An implicit conversion. Words of whole numbers, bools and enumerations are alike.
    fn conversion(&mut self, inner: &'p Expr, to: Type, wanted: Option<Reg>) -> Reg {
        let from = inner.ty.base;
        let convert: fn(Reg, Reg) -> Op = match (from, to.base) {
            (from, to) if from == to => return self.number(inner, wanted),
            (Base::Double, Base::Bool) => |to, from| Op::IsSetDouble { to, from },
            (_, Base::Bool) => |to, from| Op::IsSet { to, from },
            (Base::Uint, Base::Double) => |to, from| Op::UintToDouble { to, from },
            (_, Base::Double) => |to, from| Op::IntToDouble { to, from },
            _ => return self.number(inner, wanted),
        };
        let register = self.register_or(wanted);
        self.passing(|body| {
            let from = body.number(inner, None);
            body.op(convert(register, from));
        });
        register
    }

    /// `-x`, `!x`, `~x`
    fn unary(&mut self, op: UnaryOp, inner: &'p Expr, expr: &'p Expr, wanted: Option<Reg>) -> Reg {
        if op == UnaryOp::Not {
            return self.truth(expr, wanted);
        }
        let to = self.register_or(wanted);
        self.passing(|body| {
            let from = body.number(inner, None);
            match (op, inner.ty.base) {
                (UnaryOp::Negate, Base::Double) => body.op(Op::NegDouble { to, from }),
                (UnaryOp::Negate, _) => body.op(Op::NegInt { to, from }),
                _ => body.op(Op::NotInt { to, from }),
            };
            if inner.ty.base == Base::Byte {
                body.op(Op::ToByte { to, from: to });
            }
        });
        to
    }

    /// `place = value`; returns the place, which can be read again.
    pub(super) fn assign(&mut self, place: &'p HirPlace, value: &'p Expr) -> Spot {
        if is_number(place.ty) && place.path.is_empty() {
            let spot = self.spot(place);
            if let Some(to) = spot.register() {
                self.passing(|body| body.number(value, Some(to)));
                return spot;
            }
        }
        let spot = self.spot_before(place, &[value]);
        let spot = self.settled(spot);
        if let Some(parts) = growth::appended(self.scope(), place, value) {
            parts.into_iter().for_each(|part| self.passing(|body| body.append(spot, part)));
            return spot;
        }
        self.passing(|body| {
            if is_number(place.ty) {
                let from = body.number(value, None);
                body.store(spot, from);
            } else if body.mentions(value, place) {
                body.set(spot, value);
            } else {
                body.set_new(spot, value);
            }
        });
        spot
    }

    /// `place op= value`; returns the place, which can be read again. The old value is read first.
    pub(super) fn assign_op(&mut self, op: BinaryOp, place: &'p HirPlace, value: &'p Expr) -> Spot {
        if !is_number(place.ty) {
            return self.assign_op_of_whole(op, place, value);
        }
        let spot = self.spot_before(place, &[value]);
        let spot = self.settled(spot);
        self.passing(|body| {
            let mut old = body.load(spot, None);
            if let crate::hir::Root::Local(id) = place.root
                && body.write(&[value], id)
                && spot.register().is_some()
            {
                let copy = body.register();
                body.op(Op::Copy { to: copy, from: old });
                old = copy;
            }
            if let Some(to) = spot.register() {
                body.operation(op, place.ty.base, to, old, value);
            } else {
                let to = body.register();
                body.operation(op, place.ty.base, to, old, value);
                body.store(spot, to);
            }
        });
        spot
    }

    /// `++`, `--`. With `keep`, the value: the new one of a prefix, the old one of a postfix.
    pub(super) fn step(&mut self, step: Step, place: &'p HirPlace, keep: bool, wanted: Option<Reg>) -> Reg {
        let spot = self.spot(place);
        let spot = self.settled(spot);
        let old = self.load(spot, None);
        let mut result = old;
        if keep && !step.prefix {
            // Not into the wanted register, which may be that of the variable.
            result = self.register();
            self.op(Op::Copy { to: result, from: old });
        }
        let to = match spot.register() {
            Some(register) => register,
            None => self.register(),
        };
        if place.ty.base == Base::Double {
            let one = self.register();
            self.word_to(one, 1_f64.to_bits());
            self.op(match step.up {
                true => Op::AddDouble { to, left: old, right: one },
                false => Op::SubDouble { to, left: old, right: one },
            });
        } else {
            self.op(Op::AddSmall { to, left: old, value: if step.up { 1 } else { -1 } });
            if place.ty.base == Base::Byte {
                self.op(Op::ToByte { to, from: to });
            }
        }
        self.store(spot, to);
        if step.prefix {
            result = to;
        }
        match wanted {
            Some(wanted) if keep && wanted != result => {
                self.op(Op::Copy { to: wanted, from: result });
                wanted
            }
            _ => result,
        }
    }
}
