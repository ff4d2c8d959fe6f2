//! Conditions may read inputs and compute, but neither wait nor move: found through all functions that they call.

use crate::diagnostics::flow::FlowProblem;
use crate::diagnostics::{Diagnostic, Location, Problem};
use crate::hir::{Builtin, Expr, ExprKind, FuncId, Passed, Program, Stmt};
use crate::visit;
use arl_lang::catalog::{Effect, Kind, Mode};
use arl_lang::span::Span;

/// Reports every condition that waits or moves.
pub(crate) fn check(program: &Program, locate: &dyn Fn(crate::hir::ModuleId, Span) -> Location) -> Vec<Diagnostic> {
    let facts: Vec<Facts> = program.funcs.iter().map(|func| facts(&func.body)).collect();
    let culprits = culprits(&facts);
    let mut out = Vec::new();
    for (func, facts) in program.funcs.iter().zip(&facts) {
        for condition in &facts.conditions {
            if let Some((span, culprit)) = waiting(program, condition, &culprits) {
                out.push(FlowProblem::ConditionWaits { culprit }.at(locate(func.module, span)));
            }
        }
    }
    out
}

/// What matters of a function.
#[derive(Default)]
struct Facts<'a> {
    /// The first instruction that waits or moves.
    culprit: Option<&'static str>,
    /// The functions that it calls.
    calls: Vec<FuncId>,
    /// The conditions in it.
    conditions: Vec<&'a Expr>,
}

fn facts(block: &[Stmt]) -> Facts<'_> {
    let mut facts = Facts::default();
    for stmt in block {
        visit::exprs_in_stmt(stmt, &mut |expr| match &expr.kind {
            ExprKind::Call(func, _) => facts.calls.push(*func),
            ExprKind::Builtin(builtin) => {
                facts.culprit = facts.culprit.or(instruction(expr));
                facts.conditions.extend(conditions(builtin));
            }
            _ => {}
        });
    }
    facts
}

/// The arguments of a built-in that are conditions.
fn conditions(builtin: &Builtin) -> impl Iterator<Item = &Expr> {
    let is_condition =
        |param: usize| builtin.entry.params.get(param).is_some_and(|param| param.mode == Mode::Condition);
    let bound = builtin.args.iter().filter(move |bound| is_condition(bound.param));
    bound.filter_map(|bound| match &bound.value {
        Passed::Value(value) => Some(value),
        Passed::Out(_) => None,
    })
}

/// For each function what in it waits or moves, if anything does: itself, or what it calls.
fn culprits(facts: &[Facts<'_>]) -> Vec<Option<&'static str>> {
    let mut found: Vec<Option<&str>> = facts.iter().map(|facts| facts.culprit).collect();
    let mut callers: Vec<Vec<usize>> = vec![Vec::new(); facts.len()];
    for (caller, facts) in facts.iter().enumerate() {
        for callee in &facts.calls {
            if let Some(list) = callers.get_mut(callee.0 as usize) {
                list.push(caller);
            }
        }
    }
    let mut work: Vec<usize> = (0..found.len()).filter(|at| found.get(*at).is_some_and(Option::is_some)).collect();
    while let Some(callee) = work.pop() {
        let culprit = found.get(callee).copied().flatten();
        for caller in callers.get(callee).into_iter().flatten() {
            if let Some(slot @ None) = found.get_mut(*caller) {
                *slot = culprit;
                work.push(*caller);
            }
        }
    }
    found
}

/// The instruction that waits, moves or ends the program. Functions that read the outside are fine.
fn instruction(expr: &Expr) -> Option<&'static str> {
    let ExprKind::Builtin(builtin) = &expr.kind else { return None };
    let entry = builtin.entry;
    let waits = entry.effect.takes_time() || entry.effect == Effect::Ends;
    (entry.kind == Kind::Instruction && waits).then_some(entry.name)
}

/// Where in a condition something waits, and what it is.
fn waiting(program: &Program, condition: &Expr, culprits: &[Option<&str>]) -> Option<(Span, String)> {
    let mut found = None;
    visit::exprs(condition, &mut |expr| {
        if found.is_some() {
            return;
        }
        if let ExprKind::Call(func, _) = &expr.kind
            && let Some(Some(culprit)) = culprits.get(func.0 as usize)
        {
            let name = program.funcs.get(func.0 as usize).map(|func| func.name.as_str()).unwrap_or_default();
            found = Some((expr.span, format!("{name}` with its `{culprit}")));
        } else if let Some(culprit) = instruction(expr) {
            found = Some((expr.span, culprit.to_string()));
        }
    });
    found
}
