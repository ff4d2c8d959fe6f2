//! Where the program pointer is set: before a statement whose built-ins look at it, and again before a built-in whose
//! arguments call a function that moves it.

use super::facts::{self, FactScope};
use super::{captures, parts};
use crate::hir::{Bound, Builtin, Expr, ExprKind, Passed, Value};
use arl_lang::catalog::{Effect, Form, Mode};

/// Whether the pointer is set before a statement that evaluates this expression. `movers` says for each function
/// whether it moves the pointer.
pub(crate) fn is_needed(scope: FactScope<'_>, movers: &[bool], expr: &Expr) -> bool {
    if let ExprKind::Builtin(builtin) = &expr.kind {
        if always_needs(builtin) {
            return true;
        }
        let acts = !matches!(builtin.entry.effect, Effect::Pure | Effect::Ends);
        if acts && !is_moved(scope, movers, builtin) {
            return true;
        }
    }
    parts::children(expr).into_iter().any(|part| is_needed(scope, movers, part))
}

/// Whether evaluating an argument moves the pointer away, so that it is set again before the call.
pub(crate) fn is_moved(scope: FactScope<'_>, movers: &[bool], builtin: &Builtin) -> bool {
    let now = builtin.args.iter().filter(|arg| !captures::is_later(builtin.entry, arg));
    now.into_iter().any(|arg| moves(scope, movers, arg))
}

/// Whether evaluating an argument calls a function that moves the pointer.
pub(crate) fn moves(scope: FactScope<'_>, movers: &[bool], arg: &Bound) -> bool {
    let facts = match &arg.value {
        Passed::Value(value) => facts::of_expr(scope, value),
        Passed::Out(place) => facts::of_place(scope, place),
    };
    facts.calls.iter().any(|id| movers.get(id.0 as usize) == Some(&true))
}

/// Whether a built-in evaluates something repeatedly or later, and therefore needs the pointer in any case.
fn always_needs(builtin: &Builtin) -> bool {
    match builtin.entry.form {
        Form::WaitUntil | Form::Event => true,
        Form::Jump => condition(builtin).is_some(),
        Form::Call | Form::TypeOf | Form::Exit | Form::Restart => false,
    }
}

/// The condition of a `jump` that may stop above its target: one that is not just `false`.
pub(crate) fn condition(builtin: &Builtin) -> Option<&Expr> {
    let is_condition =
        |arg: &&Bound| builtin.entry.params.get(arg.param).map(|param| param.mode) == Some(Mode::Condition);
    match &builtin.args.iter().find(is_condition)?.value {
        Passed::Value(Expr { kind: ExprKind::Const(Value::Bool(false)), .. }) | Passed::Out(_) => None,
        Passed::Value(condition) => Some(condition),
    }
}
