//! Where the flow of control ends: what is reachable, what never goes on.

use crate::hir::{Expr, ExprKind, Stmt, StmtKind, Value};
use arl_lang::catalog::{Base, Effect};

/// The statements of a block that can be reached, given that its start can be (or a label in it).
pub(crate) fn reachable(block: &[Stmt]) -> Vec<&Stmt> {
    let mut live = true;
    let mut kept = Vec::with_capacity(block.len());
    for stmt in block {
        live = live || has_label(stmt);
        if live {
            live = !diverges(stmt);
            kept.push(stmt);
        }
    }
    kept
}

/// Whether the end of the block is never reached.
pub(crate) fn block_diverges(block: &[Stmt]) -> bool {
    reachable(block).last().is_some_and(|stmt| diverges(stmt))
}

/// Whether what follows the statement is never reached from it.
pub(crate) fn diverges(stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Return(_) | StmtKind::Break | StmtKind::Continue | StmtKind::Goto(_) => true,
        StmtKind::Eval(expr) => ends(expr),
        StmtKind::If(arms, Some(otherwise)) => {
            arms.iter().all(|(_, block)| block_diverges(block)) && block_diverges(otherwise)
        }
        StmtKind::Switch(subject, arms) => {
            exhaustive(subject, arms.iter().map(|arm| arm.value.as_ref()))
                && arms.iter().all(|arm| block_diverges(&arm.body))
        }
        StmtKind::Loop(body, _) => !breaks(body),
        StmtKind::While(condition, body, _) => always(condition) && !breaks(body),
        StmtKind::For(each) => each.condition.as_ref().is_none_or(always) && !breaks(&each.body),
        _ => false,
    }
}

/// Whether the expression is `exit` or `restart`.
pub(crate) fn ends(expr: &Expr) -> bool {
    matches!(&expr.kind, ExprKind::Builtin(builtin) if builtin.entry.effect == Effect::Ends)
}

/// Whether a condition is `true`.
pub(crate) fn always(condition: &Expr) -> bool {
    matches!(condition.kind, ExprKind::Const(Value::Bool(true)))
}

/// Whether a switch has an arm for each value of its subject.
pub(crate) fn exhaustive<'a>(subject: &Expr, values: impl Iterator<Item = Option<&'a Value>>) -> bool {
    let (mut count, mut default) = (0, false);
    for value in values {
        count += 1;
        default |= value.is_none();
    }
    default
        || match subject.ty.base {
            Base::Bool => count == 2,
            Base::Enum(id) => count == id.def().constants.len(),
            _ => false,
        }
}

/// Whether a `break` in the statements leaves the loop whose body they are.
pub(crate) fn breaks(block: &[Stmt]) -> bool {
    leaves(block, &|kind| matches!(kind, StmtKind::Break))
}

/// Whether a `continue` in the statements belongs to the loop whose body they are.
pub(crate) fn continues(block: &[Stmt]) -> bool {
    leaves(block, &|kind| matches!(kind, StmtKind::Continue))
}

fn leaves(block: &[Stmt], wanted: &dyn Fn(&StmtKind) -> bool) -> bool {
    reachable(block).into_iter().any(|stmt| match &stmt.kind {
        StmtKind::If(arms, otherwise) => {
            arms.iter().map(|(_, block)| block).chain(otherwise).any(|block| leaves(block, wanted))
        }
        StmtKind::Switch(_, arms) => arms.iter().any(|arm| leaves(&arm.body, wanted)),
        kind => wanted(kind),
    })
}

/// Whether a label stands in the statement.
pub(crate) fn has_label(stmt: &Stmt) -> bool {
    matches!(stmt.kind, StmtKind::Label(_)) || blocks(stmt).iter().any(|block| block.iter().any(has_label))
}

/// The blocks directly inside a statement (also the declarations of a `for`).
pub(crate) fn blocks(stmt: &Stmt) -> Vec<&[Stmt]> {
    match &stmt.kind {
        StmtKind::If(arms, otherwise) => {
            arms.iter().map(|(_, block)| block).chain(otherwise).map(Vec::as_slice).collect()
        }
        StmtKind::Switch(_, arms) => arms.iter().map(|arm| arm.body.as_slice()).collect(),
        StmtKind::While(_, body, _) | StmtKind::Repeat(body, _, _) | StmtKind::Loop(body, _) => vec![body],
        StmtKind::For(each) => vec![&each.init, &each.body],
        _ => Vec::new(),
    }
}

/// The expressions directly inside a statement.
pub(crate) fn expressions(stmt: &Stmt) -> Vec<&Expr> {
    match &stmt.kind {
        StmtKind::Let(_, value) | StmtKind::Return(value) => value.iter().collect(),
        StmtKind::Eval(expr) | StmtKind::While(expr, ..) | StmtKind::Repeat(_, expr, _) | StmtKind::Switch(expr, _) => {
            vec![expr]
        }
        StmtKind::If(arms, _) => arms.iter().map(|(condition, _)| condition).collect(),
        StmtKind::For(each) => each.condition.iter().chain(&each.step).collect(),
        _ => Vec::new(),
    }
}
