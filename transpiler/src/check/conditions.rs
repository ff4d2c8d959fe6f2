//! Conditions may read inputs and compute, but neither wait nor move. All functions that they call are searched.

use crate::diagnostics::flow::FlowProblem;
use crate::diagnostics::{Diagnostic, Location, Problem};
use crate::hir::{Builtin, Expr, ExprKind, FuncId, Passed, Program, Stmt};
use crate::visit;
use arl_lang::catalog::{Effect, Entry, Form, Kind, Mode};
use arl_lang::span::Span;

/// Reports every condition that waits or moves.
pub(crate) fn check(program: &Program, locate: &dyn Fn(crate::hir::ModuleId, Span) -> Location) -> Vec<Diagnostic> {
    let facts: Vec<Facts> = program.funcs.iter().map(|func| facts(&func.body)).collect();
    let of_waits = culprits(&facts, waits);
    let of_events = culprits(&facts, takes_cycles);
    let mut out = Vec::new();
    for (func, facts) in program.funcs.iter().zip(&facts) {
        for (form, condition) in &facts.conditions {
            let found = match form {
                Form::WaitUntil => waiting(program, condition, &of_waits, waits),
                _ => waiting(program, condition, &of_events, takes_cycles),
            };
            if let Some((span, culprit)) = found {
                out.push(FlowProblem::ConditionWaits { culprit }.at(locate(func.module, span)));
            }
        }
    }
    out
}

/// The relevant facts about a function.
#[derive(Default)]
struct Facts<'a> {
    /// The built-ins that it uses.
    uses: Vec<&'static Entry>,
    /// The functions that it calls.
    calls: Vec<FuncId>,
    /// The conditions in it, each with the form of the instruction that it belongs to.
    conditions: Vec<(Form, &'a Expr)>,
}

fn facts(block: &[Stmt]) -> Facts<'_> {
    let mut facts = Facts::default();
    for stmt in block {
        visit::exprs_in_stmt(stmt, &mut |expr| match &expr.kind {
            ExprKind::Call(func, _) => facts.calls.push(*func),
            ExprKind::Builtin(builtin) => {
                facts.uses.push(builtin.entry);
                facts.conditions.extend(conditions(builtin).map(|condition| (builtin.entry.form, condition)));
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

/// For each function, a built-in that is not allowed in conditions, if the function or one that it calls uses any.
fn culprits(facts: &[Facts<'_>], is_culprit: fn(&Entry) -> bool) -> Vec<Option<&'static str>> {
    let first = |facts: &Facts<'_>| facts.uses.iter().find(|entry| is_culprit(entry)).map(|entry| entry.name);
    let mut found: Vec<Option<&str>> = facts.iter().map(first).collect();
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

/// Whether it is an instruction that waits, moves or ends the program. Functions that read inputs are allowed.
fn waits(entry: &Entry) -> bool {
    entry.kind == Kind::Instruction && (entry.effect.takes_time() || entry.effect == Effect::Ends)
}

/// Whether it waits, or is a function that takes cycles even if there is nothing to wait for: the condition of an event
/// has only one cycle.
fn takes_cycles(entry: &Entry) -> bool {
    waits(entry) || entry.effect == Effect::Lasts || entry.uses_disk
}

/// The position in a condition where something waits, and its name.
fn waiting(
    program: &Program,
    condition: &Expr,
    culprits: &[Option<&str>],
    is_culprit: fn(&Entry) -> bool,
) -> Option<(Span, String)> {
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
        } else if let ExprKind::Builtin(builtin) = &expr.kind
            && is_culprit(builtin.entry)
        {
            found = Some((expr.span, builtin.entry.name.to_string()));
        }
    });
    found
}
