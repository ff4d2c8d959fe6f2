//! Conditions may read inputs and compute, but neither wait nor move: found through all functions that they call.

use crate::diagnostics::flow::FlowProblem;
use crate::diagnostics::{Diagnostic, Location, Problem};
use crate::hir::{Expr, ExprKind, FuncId, Passed, Program, Stmt};
use crate::visit;
use arl_lang::catalog::{Effect, Kind, Mode};
use arl_lang::span::Span;

/// Reports every condition that waits or moves.
pub(crate) fn check(program: &Program, locate: &dyn Fn(crate::hir::ModuleId, Span) -> Location) -> Vec<Diagnostic> {
    let culprits = culprits(program);
    let mut out = Vec::new();
    for func in &program.funcs {
        for stmt in &func.body {
            visit::exprs_in_stmt(stmt, &mut |expr| {
                for condition in conditions(expr) {
                    if let Some((span, culprit)) = waiting(program, condition, &culprits) {
                        out.push(FlowProblem::ConditionWaits { culprit }.at(locate(func.module, span)));
                    }
                }
            });
        }
    }
    out
}

/// The arguments of a built-in that are conditions.
fn conditions(expr: &Expr) -> Vec<&Expr> {
    let ExprKind::Builtin(builtin) = &expr.kind else { return Vec::new() };
    let is_condition =
        |param: usize| builtin.entry.params.get(param).is_some_and(|param| param.mode == Mode::Condition);
    let bound = builtin.args.iter().filter(|bound| is_condition(bound.param));
    bound
        .filter_map(|bound| match &bound.value {
            Passed::Value(value) => Some(value),
            Passed::Out(_) => None,
        })
        .collect()
}

/// For each function what in it waits or moves, if anything does.
fn culprits(program: &Program) -> Vec<Option<String>> {
    let mut found: Vec<Option<String>> = program.funcs.iter().map(|func| direct(&func.body)).collect();
    let calls: Vec<Vec<FuncId>> = program.funcs.iter().map(|func| calls(&func.body)).collect();
    let mut callers: Vec<Vec<usize>> = vec![Vec::new(); program.funcs.len()];
    for (caller, callees) in calls.iter().enumerate() {
        for callee in callees {
            if let Some(list) = callers.get_mut(callee.0 as usize) {
                list.push(caller);
            }
        }
    }
    let mut work: Vec<usize> = (0..found.len()).filter(|at| found.get(*at).is_some_and(Option::is_some)).collect();
    while let Some(callee) = work.pop() {
        let culprit = found.get(callee).cloned().flatten();
        for caller in callers.get(callee).into_iter().flatten() {
            if let Some(slot @ None) = found.get_mut(*caller) {
                *slot = culprit.clone();
                work.push(*caller);
            }
        }
    }
    found
}

fn direct(block: &[Stmt]) -> Option<String> {
    let mut found = None;
    for stmt in block {
        visit::exprs_in_stmt(stmt, &mut |expr| {
            if found.is_none() {
                found = instruction(expr);
            }
        });
    }
    found
}

/// The instruction that waits, moves or ends the program. Functions that read the outside are fine.
fn instruction(expr: &Expr) -> Option<String> {
    let ExprKind::Builtin(builtin) = &expr.kind else { return None };
    let entry = builtin.entry;
    let waits = matches!(entry.effect, Effect::Waits | Effect::Plans | Effect::Ends);
    (entry.kind == Kind::Instruction && waits).then(|| entry.name.to_string())
}

fn calls(block: &[Stmt]) -> Vec<FuncId> {
    let mut found = Vec::new();
    for stmt in block {
        visit::exprs_in_stmt(stmt, &mut |expr| {
            if let ExprKind::Call(func, _) = &expr.kind {
                found.push(*func);
            }
        });
    }
    found
}

/// Where in a condition something waits, and what it is.
fn waiting(program: &Program, condition: &Expr, culprits: &[Option<String>]) -> Option<(Span, String)> {
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
            found = Some((expr.span, culprit));
        }
    });
    found
}
