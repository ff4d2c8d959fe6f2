//! Uses of what is built in.

use super::body::FunctionCode;
use super::variables::{is_number, is_text};
use crate::effects::{captures, pointer};
use crate::hir::{Bound, Builtin, Expr, Passed, Projection, Type};
use arl_code::{Address, Arg, Op, Place, Site, Space, Target};
use arl_lang::catalog::{Base, Effect, Form};

impl<'p> FunctionCode<'p, '_> {
    /// A use of a built-in; its result goes to a place.
    pub(super) fn builtin(&mut self, builtin: &'p Builtin, result: Place) {
        match builtin.entry.form {
            Form::WaitUntil => return self.wait_until(builtin),
            Form::Exit => {
                self.op(Op::Exit);
                return;
            }
            Form::Restart => {
                self.op(Op::Restart);
                return;
            }
            Form::Event => return self.event(builtin),
            Form::Jump => {
                if let Some(condition) = pointer::condition(builtin) {
                    return self.jump_with_sig(builtin, condition);
                }
            }
            Form::Call | Form::TypeOf => {}
        }
        let site = self.use_of(builtin, result);
        let takes_time = builtin.entry.effect.takes_time();
        self.site(site, |site| if takes_time { Op::Await { site } } else { Op::BuiltIn { site } });
    }

    /// Evaluates the arguments of a built-in in the order of the program, and sets the program pointer again where they
    /// moved it.
    pub(super) fn use_of(&mut self, builtin: &'p Builtin, result: Place) -> Site {
        let entry = builtin.entry;
        let now: Vec<&'p Bound> = builtin.args.iter().filter(|arg| !is_condition_or_action(builtin, arg)).collect();
        let mut args = Vec::new();
        for (at, bound) in now.iter().enumerate() {
            let later: Vec<&'p Expr> = now.iter().skip(at + 1).flat_map(|bound| evaluated(bound)).collect();
            let (ty, place) = match &bound.value {
                Passed::Value(value) => (value.ty, self.argument(value, &later)),
                Passed::Out(place) => {
                    let spot = self.spot_before(place, &later);
                    (place.ty, self.settled(spot).place)
                }
            };
            args.push(Arg { param: bound.param as u8, ty: self.lowering.type_number(ty), place });
        }
        if entry.effect != Effect::Pure && pointer::is_moved(self.scope(), &self.lowering.movers, builtin) {
            let line = self.line;
            self.op(Op::Line { line });
        }
        Site { target: Target::Entry(self.lowering.entry_number(entry)), args, result, line: self.line }
    }

    /// Appends an operation that refers to a site.
    pub(super) fn site(&mut self, site: Site, op: impl FnOnce(u32) -> Op) -> Address {
        self.lowering.code.sites.push(site);
        let number = self.lowering.code.sites.len() as u32 - 1;
        self.op(op(number))
    }

    /// A `jump` that looks at its `sig` above the target.
    fn jump_with_sig(&mut self, builtin: &'p Builtin, condition: &'p Expr) {
        let site = self.use_of(builtin, Place::NOWHERE);
        self.site(site, |site| Op::Above { site });
        let met = self.jump_if(condition, true);
        let line = self.line;
        if pointer::is_moved(self.scope(), &self.lowering.movers, builtin) {
            self.op(Op::Line { line });
        }
        self.op(Op::Sink { line });
        let over = self.op(Op::Jump { to: 0 });
        self.lead_here(met);
        self.op(Op::StayAbove);
        self.lead_here([over]);
    }

    /// An expression that is evaluated for its effect; the program pointer is set already.
    pub(super) fn effect_of(&mut self, expr: &'p Expr) {
        use crate::hir::ExprKind;
        match &expr.kind {
            ExprKind::Assign(sides) => {
                self.assign(&sides.0, &sides.1);
            }
            ExprKind::AssignOp(op, sides) => {
                self.assign_op(*op, &sides.0, &sides.1);
            }
            ExprKind::Step(step, place) => {
                self.step(*step, place, false, None);
            }
            ExprKind::Call(id, args) => {
                self.call(*id, args, expr.ty);
            }
            ExprKind::Builtin(builtin) => {
                let result = self.place_for(expr.ty);
                self.builtin(builtin, result);
            }
            ExprKind::Const(_) => {}
            _ => self.evaluate(expr),
        }
    }

    /// An expression whose value is not used.
    fn evaluate(&mut self, expr: &'p Expr) {
        if is_number(expr.ty) {
            self.number(expr, None);
        } else if is_text(expr.ty) {
            self.text(expr);
        } else if !matches!(expr.ty.base, Base::Void | Base::Handle(_)) {
            self.whole(expr);
        }
    }

    /// New space for a result.
    fn place_for(&mut self, ty: Type) -> Place {
        if ty.base == Base::Void {
            return Place::NOWHERE;
        }
        if is_number(ty) {
            return Place::start(Space::Register(self.register()));
        }
        self.space_of(ty)
    }
}

/// Whether an argument is evaluated repeatedly, or later.
fn is_condition_or_action(builtin: &Builtin, arg: &Bound) -> bool {
    use arl_lang::catalog::Mode;
    let mode = builtin.entry.params.get(arg.param).map(|param| param.mode);
    captures::is_later(builtin.entry, arg) || matches!(mode, Some(Mode::Condition | Mode::Action))
}

/// The expressions that are evaluated for an argument.
fn evaluated(bound: &Bound) -> Vec<&Expr> {
    match &bound.value {
        Passed::Value(value) => vec![value],
        Passed::Out(place) => place
            .path
            .iter()
            .flat_map(|step| match step {
                Projection::Index(indices, _) => indices.as_slice(),
                Projection::Field(..) => &[],
            })
            .collect(),
    }
}
