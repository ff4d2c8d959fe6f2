//! Motions do not blend yet: they stop at each target. A program that asks for blending runs, but is told.

use super::context::{Body, Checker};
use crate::diagnostics::support::SupportProblem;
use crate::hir::{Bound, Expr, ExprKind, Passed, Value};
use arl_lang::catalog::{Effect, Entry};

/// The labels that ask for blending.
const LABELS: [&str; 3] = ["s", "sp", "sl"];

impl Checker<'_> {
    /// Warns of a motion whose blending is known to be wanted.
    pub(crate) fn warn_of_blending(&mut self, body: &Body, entry: &Entry, args: &[Bound]) {
        if entry.effect != Effect::Plans {
            return;
        }
        for bound in args {
            let Some(param) = entry.params.get(bound.param).filter(|param| LABELS.contains(&param.name)) else {
                continue;
            };
            let Passed::Value(value) = &bound.value else { continue };
            if asks(value) {
                let label = param.name.to_string();
                self.report::<()>(body, value.span, SupportProblem::NoBlending { label });
            }
        }
    }
}

/// Whether a value holds a positive constant.
fn asks(value: &Expr) -> bool {
    match &value.kind {
        ExprKind::Const(Value::Double(number)) => *number > 0.0,
        ExprKind::Struct(_, components) => components.iter().flatten().any(asks),
        _ => false,
    }
}
