//! Which loops run a known number of rounds, and which have to give the cycle back by themselves.

use super::{flow, parts};
use crate::hir::{Block, Expr, ExprKind, For, Func, LocalId, LoopInfo, Passed, Place, Root, Stmt, StmtKind, Value};
use arl_lang::ast::BinaryOp;
use arl_lang::catalog::{Base, Effect};

/// The most rounds (of nested loops together) that may pass before they are counted and the cycle can be given back.
pub(crate) const MOST_ROUNDS: u64 = 250_000;

/// Drops labels that no `goto` names and `default`s that nothing reaches, then fills in [`LoopInfo`] and `counted` of every loop of a function.
pub(super) fn judge(func: &mut Func) {
    let unused: Vec<bool> = func.labels.iter().map(|label| !label.used).collect();
    let any = unused.contains(&true);
    drop_unused(&mut func.body, if any { &unused } else { &[] });
    block_rounds(&mut func.body, &mut 0);
}

fn drop_unused(block: &mut Block, unused: &[bool]) {
    if !unused.is_empty() {
        block.retain(|stmt| match stmt.kind {
            StmtKind::Label(id) => unused.get(id.0 as usize) != Some(&true),
            _ => true,
        });
    }
    for stmt in block {
        inner_blocks(stmt).into_iter().for_each(|block| drop_unused(block, unused));
        if let StmtKind::Switch(subject, arms) = &mut stmt.kind
            && flow::exhaustive(subject, arms.iter().map(|arm| arm.value.as_ref()).filter(Option::is_some))
        {
            arms.retain(|arm| arm.value.is_some() || arm.body.iter().any(flow::has_label));
        }
    }
}

pub(super) fn inner_blocks(stmt: &mut Stmt) -> Vec<&mut Block> {
    match &mut stmt.kind {
        StmtKind::If(arms, otherwise) => arms.iter_mut().map(|(_, block)| block).chain(otherwise).collect(),
        StmtKind::Switch(_, arms) => arms.iter_mut().map(|arm| &mut arm.body).collect(),
        StmtKind::While(_, body, _) | StmtKind::Repeat(body, _, _) | StmtKind::Loop(body, _) => vec![body],
        StmtKind::For(each) => vec![&mut each.body],
        _ => Vec::new(),
    }
}

/// The rounds that the loops of a block may run without giving the cycle back; `number` is that of the last loop.
fn block_rounds(block: &mut Block, number: &mut u32) -> u64 {
    let mut rounds: u64 = 0;
    for stmt in block {
        let inside =
            inner_blocks(stmt).into_iter().map(|block| block_rounds(block, number)).fold(0, u64::saturating_add);
        let counted = match &mut stmt.kind {
            StmtKind::For(each) => {
                let all = known_rounds(each).map(|known| known.saturating_mul(inside.max(1)));
                each.counted = all.is_some_and(|all| all <= MOST_ROUNDS);
                all.filter(|_| each.counted)
            }
            _ => None,
        };
        if counted.is_none() {
            let spends = repeats(stmt);
            if let Some(info) = info(stmt) {
                *number += 1;
                *info = LoopInfo {
                    spends,
                    rounds: u32::try_from(inside).map_or(u32::MAX, |all| all.saturating_add(1)),
                    number: *number,
                };
                if spends {
                    // Each round pays for what is inside.
                    continue;
                }
            }
        }
        rounds = rounds.saturating_add(counted.unwrap_or(inside));
    }
    rounds
}

fn info(stmt: &mut Stmt) -> Option<&mut LoopInfo> {
    match &mut stmt.kind {
        StmtKind::While(_, _, info) | StmtKind::Repeat(_, _, info) | StmtKind::Loop(_, info) => Some(info),
        StmtKind::For(each) => Some(&mut each.info),
        _ => None,
    }
}

/// Whether a loop may go round without giving the cycle back.
fn repeats(stmt: &Stmt) -> bool {
    let body = match &stmt.kind {
        StmtKind::While(_, body, _) | StmtKind::Repeat(body, _, _) | StmtKind::Loop(body, _) => body,
        StmtKind::For(each) => &each.body,
        _ => return false,
    };
    flow::goes_round(body) && !body.iter().take_while(|stmt| !may_skip(stmt)).any(gives_back)
}

/// Whether what follows in the block may be left out.
fn may_skip(stmt: &Stmt) -> bool {
    flow::has_label(stmt) || matches!(stmt.kind, StmtKind::Continue) || flow::continues(std::slice::from_ref(stmt))
}

/// Whether the statement gives the cycle back each time: a motion does, as the look-ahead is finite, and a wait.
fn gives_back(stmt: &Stmt) -> bool {
    let StmtKind::Eval(Expr { kind: ExprKind::Builtin(builtin), .. }) = &stmt.kind else { return false };
    let known_wait = || {
        builtin.args.iter().any(|arg| match &arg.value {
            Passed::Value(Expr { kind: ExprKind::Const(Value::Double(time)), .. }) => {
                *time > 0.0 && builtin.entry.params.get(arg.param).is_some_and(|param| param.delays)
            }
            _ => false,
        })
    };
    builtin.entry.effect == Effect::Plans || known_wait()
}

/// A `for` that a Rust range can stand for.
pub(crate) struct Range<'a> {
    /// The loop's variable.
    pub(crate) local: LocalId,
    /// Its first value.
    pub(crate) from: &'a Expr,
    /// The first value that it does not reach any more.
    pub(crate) to: &'a Expr,
    /// Added to `to`: 1 where the condition is `<=` with a constant.
    pub(crate) beyond: bool,
}

/// The range that a loop runs through: `for(int i = a; i < b; i++)` whose body writes neither `i` nor `b`.
pub(crate) fn range(each: &For) -> Option<Range<'_>> {
    let Head { local, from, op, to, step } = Head::of(each)?;
    if step.is_some_and(|step| whole_number(step) != Some(1)) {
        return None;
    }
    let bound = match &to.kind {
        ExprKind::Const(_) => None,
        ExprKind::Place(place) if place.path.is_empty() => match place.root {
            Root::Local(id) => Some(id),
            Root::Global(_) | Root::System(_) => return None,
        },
        _ => return None,
    };
    let beyond = match op {
        BinaryOp::Less => false,
        BinaryOp::LessEqual => is_below_the_greatest(to),
        _ => return None,
    };
    if op == BinaryOp::LessEqual && !beyond {
        return None;
    }
    if bound.is_some_and(|id| id == local || each.body.iter().any(|stmt| stmt_writes(stmt, id))) {
        return None;
    }
    Some(Range { local, from, to, beyond })
}

/// A `for` whose variable only its step writes, by adding to it: `for(int i = from; i op to; i = i + step)`.
pub(crate) struct Head<'a> {
    pub(crate) local: LocalId,
    pub(crate) from: &'a Expr,
    pub(crate) op: BinaryOp,
    pub(crate) to: &'a Expr,
    /// What is added; none for `i++`.
    pub(crate) step: Option<&'a Expr>,
}

impl<'a> Head<'a> {
    pub(crate) fn of(each: &'a For) -> Option<Self> {
        let [Stmt { kind: StmtKind::Let(local, Some(from)), .. }] = each.init.as_slice() else { return None };
        let ExprKind::Binary(op, sides) = &each.condition.as_ref()?.kind else { return None };
        let is_variable =
            |place: &Place| matches!(place.root, Root::Local(id) if id == *local) && place.path.is_empty();
        let reads_variable = |expr: &Expr| matches!(&expr.kind, ExprKind::Place(place) if is_variable(place));
        let step = match &each.step.as_ref()?.kind {
            ExprKind::Step(step, place) if step.up && is_variable(place) => None,
            ExprKind::AssignOp(BinaryOp::Add, sides) if is_variable(&sides.0) => Some(&sides.1),
            ExprKind::Assign(sides) if is_variable(&sides.0) => match &sides.1.kind {
                ExprKind::Binary(BinaryOp::Add, sum) if reads_variable(&sum.0) => Some(&sum.1),
                _ => return None,
            },
            _ => return None,
        };
        let whole = matches!(from.ty.base, Base::Int | Base::Uint | Base::Byte);
        let elsewhere = each.body.iter().any(|stmt| flow::has_label(stmt) || stmt_writes(stmt, *local));
        (whole && reads_variable(&sides.0) && !each.shared && !elsewhere).then_some(Self {
            local: *local,
            from,
            op: *op,
            to: &sides.1,
            step,
        })
    }
}

/// The number of rounds of a loop with constant bounds.
fn known_rounds(each: &For) -> Option<u64> {
    let range = range(each)?;
    let (from, to) = (whole_number(range.from)?, whole_number(range.to)?);
    Some((to + i64::from(range.beyond) - from).max(0).unsigned_abs())
}

/// The value of a constant integer.
pub(crate) fn whole_number(expr: &Expr) -> Option<i64> {
    match &expr.kind {
        ExprKind::Const(Value::Int(value)) => Some(i64::from(*value)),
        ExprKind::Const(Value::Uint(value)) => Some(i64::from(*value)),
        ExprKind::Const(Value::Byte(value)) => Some(i64::from(*value)),
        _ => None,
    }
}

fn is_below_the_greatest(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Const(Value::Int(value)) => *value < i32::MAX,
        ExprKind::Const(Value::Uint(value)) => *value < u32::MAX,
        ExprKind::Const(Value::Byte(value)) => *value < u8::MAX,
        _ => false,
    }
}

/// Whether a statement (or one inside it) writes a local variable.
fn stmt_writes(stmt: &Stmt, id: LocalId) -> bool {
    matches!(stmt.kind, StmtKind::Let(declared, _) if declared == id)
        || flow::expressions(stmt).any(|expr| expr_writes(expr, id))
        || flow::blocks(stmt).any(|block| block.iter().any(|stmt| stmt_writes(stmt, id)))
}

fn expr_writes(expr: &Expr, id: LocalId) -> bool {
    let mut writes = Vec::new();
    parts::local_writes(expr, &mut writes);
    writes.contains(&id)
}
