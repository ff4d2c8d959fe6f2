//! Where control flow ends: which statements are reachable, and which never continue.

use crate::hir::{Arm, Block, Expr, ExprKind, Stmt, StmtKind, Value};
use arl_lang::catalog::{Base, Effect};

/// The statements of a block that can be reached, given that its start (or a label in it) can be.
pub fn reachable(block: &[Stmt]) -> Vec<&Stmt> {
    let mut kept = Vec::with_capacity(block.len());
    run_through(block, &mut |stmt| kept.push(stmt));
    kept
}

/// Whether the end of the block is never reached.
pub(crate) fn block_diverges(block: &[Stmt]) -> bool {
    !run_through(block, &mut |_| ())
}

/// Calls `see` for every statement of a block that can be reached. Returns whether the end of the block can be reached.
/// Each statement is examined only once, because the cost would otherwise multiply with the nesting.
fn run_through<'a>(block: &'a [Stmt], see: &mut dyn FnMut(&'a Stmt)) -> bool {
    let mut live = true;
    for stmt in block {
        live = live || has_label(stmt);
        if live {
            see(stmt);
            live = !diverges(stmt);
        }
    }
    live
}

/// Whether the statement never continues with the statement after it.
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
        StmtKind::Repeat(body, ..) => !goes_round(body) && !breaks(body),
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
pub fn exhaustive<'a>(subject: &Expr, values: impl Iterator<Item = Option<&'a Value>>) -> bool {
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

/// Whether control ever reaches what comes after a loop's body (a step, an `until`, the next round).
pub fn goes_round(body: &[Stmt]) -> bool {
    !block_diverges(body) || continues(body)
}

/// Whether a `break` in the body leaves this loop.
pub(crate) fn breaks(block: &[Stmt]) -> bool {
    leaves(block, &|kind| matches!(kind, StmtKind::Break))
}

/// Whether a `continue` in the body belongs to this loop.
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

/// Whether a statement contains a label.
pub(crate) fn has_label(stmt: &Stmt) -> bool {
    matches!(stmt.kind, StmtKind::Label(_)) || blocks(stmt).any(|block| block.iter().any(has_label))
}

/// The blocks directly inside a statement (also the declarations of a `for`).
pub fn blocks(stmt: &Stmt) -> impl Iterator<Item = &[Stmt]> {
    let mut conditional: &[(Expr, Block)] = &[];
    let mut cases: &[Arm] = &[];
    let mut plain: [Option<&Block>; 2] = [None, None];
    match &stmt.kind {
        StmtKind::If(arms, otherwise) => (conditional, plain) = (arms, [otherwise.as_ref(), None]),
        StmtKind::Switch(_, arms) => cases = arms,
        StmtKind::While(_, body, _) | StmtKind::Repeat(body, _, _) | StmtKind::Loop(body, _) => plain[0] = Some(body),
        StmtKind::For(each) => plain = [Some(&each.init), Some(&each.body)],
        _ => {}
    }
    let blocks = conditional.iter().map(|(_, block)| block).chain(cases.iter().map(|arm| &arm.body));
    blocks.chain(plain.into_iter().flatten()).map(Vec::as_slice)
}

/// The expressions directly inside a statement.
pub(crate) fn expressions(stmt: &Stmt) -> impl Iterator<Item = &Expr> {
    let mut conditional: &[(Expr, Block)] = &[];
    let mut plain: [Option<&Expr>; 2] = [None, None];
    match &stmt.kind {
        StmtKind::Let(_, value) | StmtKind::Return(value) => plain[0] = value.as_ref(),
        StmtKind::Eval(expr) | StmtKind::While(expr, ..) | StmtKind::Repeat(_, expr, _) | StmtKind::Switch(expr, _) => {
            plain[0] = Some(expr);
        }
        StmtKind::If(arms, _) => conditional = arms,
        StmtKind::For(each) => plain = [each.condition.as_ref(), each.step.as_ref()],
        _ => {}
    }
    conditional.iter().map(|(condition, _)| condition).chain(plain.into_iter().flatten())
}
