//! The variables that events use of the function that declares them. Conditions and actions of events may run after the
//! function has ended, so they keep the variables that they need: a copy if the variable no longer changes, otherwise
//! shared.

use super::{flow, loops};
use crate::hir::{Bound, Builtin, Expr, ExprKind, Func, LocalId, Passed, Place, Root, Stmt, StmtKind};
use crate::visit;
use arl_lang::catalog::{Base, Entry, Mode};

/// Whether an instruction declares an event: an interrupt, a timer, a trigger.
pub(crate) fn declares_event(entry: &Entry) -> bool {
    entry.params.iter().any(|param| param.mode == Mode::Action)
}

/// Whether an argument is evaluated when events are checked or handled, not where it stands.
pub(crate) fn is_later(entry: &Entry, arg: &Bound) -> bool {
    let mode = entry.params.get(arg.param).map(|param| param.mode);
    declares_event(entry) && matches!(mode, Some(Mode::Condition | Mode::Action))
}

/// The condition and the action of an event.
pub(crate) fn later(builtin: &Builtin) -> impl Iterator<Item = &Expr> {
    builtin.args.iter().filter(|arg| is_later(builtin.entry, arg)).filter_map(|arg| match &arg.value {
        Passed::Value(value) => Some(value),
        Passed::Out(_) => None,
    })
}

/// The locals that an expression mentions, each once.
pub(crate) fn mentioned(expr: &Expr) -> Vec<LocalId> {
    let mut found = Vec::new();
    let mut see = |place: &Place| {
        if let Root::Local(id) = place.root {
            found.push(id);
        }
    };
    visit::exprs(expr, &mut |expr| match &expr.kind {
        ExprKind::Place(place) | ExprKind::Step(_, place) => see(place),
        ExprKind::Assign(sides) | ExprKind::AssignOp(_, sides) => see(&sides.0),
        ExprKind::Builtin(builtin) => builtin.args.iter().for_each(|arg| {
            if let Passed::Out(place) = &arg.value {
                see(place);
            }
        }),
        _ => {}
    });
    found.sort_unstable();
    found.dedup();
    found
}

/// Marks the locals that a function shares with its events, and the loops that count such a local.
pub(crate) fn mark(func: &mut Func) {
    let mut seen = Vec::new();
    for stmt in &func.body {
        visit::exprs_in_stmt(stmt, &mut |expr| {
            if let ExprKind::Builtin(builtin) = &expr.kind {
                seen.extend(later(builtin).flat_map(mentioned));
            }
        });
    }
    if seen.is_empty() {
        return;
    }
    for LocalId(id) in seen {
        if let Some(local) = func.locals.get_mut(id as usize) {
            local.shared |= local.mutated || matches!(local.ty.base, Base::Handle(_));
        }
    }
    let shared: Vec<LocalId> =
        (0..).map(LocalId).zip(&func.locals).filter(|(_, it)| it.shared).map(|(id, _)| id).collect();
    mark_loops(&mut func.body, &shared);
}

fn mark_loops(block: &mut [Stmt], shared: &[LocalId]) {
    for stmt in block {
        if let StmtKind::For(each) = &mut stmt.kind {
            let head = each.init.iter().flat_map(flow::expressions).chain(&each.condition).chain(&each.step);
            let declared =
                each.init.iter().any(|stmt| matches!(stmt.kind, StmtKind::Let(id, _) if shared.contains(&id)));
            each.shared = declared || head.flat_map(mentioned).any(|id| shared.contains(&id));
        }
        loops::inner_blocks(stmt).into_iter().for_each(|block| mark_loops(block, shared));
    }
}
