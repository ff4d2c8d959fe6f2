//! Determines which loops run a known number of rounds, and which must yield the cycle by themselves.

use super::facts::{self, FactScope};
use super::ranges::Ranges;
use super::walks::Walks;
use super::{flow, parts};
use crate::hir::{
    Block, Counting, Expr, ExprKind, For, Func, LocalId, LoopInfo, Passed, Place, Root, Stmt, StmtKind, Value,
};
use arl_lang::ast::BinaryOp;
use arl_lang::catalog::{Base, Effect};

/// The maximum number of rounds (of nested loops together) before they are counted and the cycle can be yielded.
pub(crate) const MOST_ROUNDS: u64 = 250_000;

/// Drops labels that no `goto` names and `default`s that are never reached, then fills in [`LoopInfo`] for every loop
/// of a function.
pub(super) fn judge(func: &mut Func) {
    let unused: Vec<bool> = func.labels.iter().map(|label| !label.used).collect();
    let any = unused.contains(&true);
    drop_unused(&mut func.body, if any { &unused } else { &[] });
    let (ranges, walks) = (Ranges::of_function(func), Walks::of_function(func));
    Judge { ranges, walks, number: 0 }.block(&mut func.body);
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

/// What happens in a block.
#[derive(Clone, Copy, Debug)]
struct Inside {
    /// The number of rounds that its loops run without counting them.
    rounds: u64,
    /// The maximum number of rounds that they run without yielding the cycle.
    most: u64,
    /// The part of `most` in loops whose rounds are counted after them, where the cycle can also be yielded.
    behind: u64,
    /// Whether the block only computes: nothing in it uses the context, yields the cycle or jumps.
    alone: bool,
}

impl Inside {
    fn and(self, other: Self) -> Self {
        Self {
            rounds: self.rounds.saturating_add(other.rounds),
            most: self.most.saturating_add(other.most),
            behind: self.behind.saturating_add(other.behind),
            alone: self.alone && other.alone,
        }
    }
}

struct Judge {
    ranges: Ranges,
    walks: Walks,
    /// The number of the last loop.
    number: u32,
}

impl Judge {
    fn block(&mut self, block: &mut Block) -> Inside {
        let nothing = Inside { rounds: 0, most: 0, behind: 0, alone: true };
        block.iter_mut().fold(nothing, |all, stmt| all.and(self.stmt(stmt)))
    }

    fn stmt(&mut self, stmt: &mut Stmt) -> Inside {
        let own = Inside { rounds: 0, most: 0, behind: 0, alone: calculates(stmt) };
        let inside = inner_blocks(stmt).into_iter().fold(own, |all, block| all.and(self.block(block)));
        let times = |rounds: u64| rounds.saturating_mul(inside.most.max(1));
        if let StmtKind::For(each) = &mut stmt.kind {
            if let Some(known) = known_rounds(each).filter(|known| times(*known) <= MOST_ROUNDS) {
                let rounds = known.saturating_mul(inside.rounds.max(1));
                return Inside { rounds, most: times(known), behind: 0, ..inside };
            }
            if let Some(most) = self.ranges.most_rounds(each).filter(|most| times(*most) <= MOST_ROUNDS)
                && inside.alone
                && !leaves(&each.body)
            {
                each.info = LoopInfo { counting: Counting::Behind, ..self.info(inside) };
                return Inside { rounds: 0, most: times(most), behind: times(most), alone: true };
            }
            let others = inside.most.saturating_sub(inside.behind).max(1);
            if inside.behind > 0
                && let Some(known) = known_rounds(each).filter(|known| known.saturating_mul(others) <= MOST_ROUNDS)
            {
                each.info.counting = Counting::Inside;
                wait_behind(&mut each.body);
                let rounds = known.saturating_mul(inside.rounds.max(1));
                return Inside { rounds, most: known.saturating_mul(others), behind: 0, alone: false };
            }
        }
        if let StmtKind::While(condition, body, info) = &mut stmt.kind
            && let Some((walk, most)) = self.walks.of_while(condition, body)
            && times(most) <= MOST_ROUNDS
            && inside.alone
            && !leaves(body)
        {
            *info = LoopInfo { counting: Counting::Walking(walk), ..self.info(inside) };
            return Inside { rounds: 0, most: times(most), behind: times(most), alone: true };
        }
        let spends = repeats(stmt);
        let Some(info) = info(stmt) else { return inside };
        // If a round is long anyway, nothing is gained.
        let alone = inside.alone && inside.rounds == 0;
        let counting = if alone { Counting::Alone } else { Counting::InContext };
        *info = LoopInfo { spends, counting, ..self.info(inside) };
        // Each round accounts for what is inside it.
        if spends { Inside { rounds: 0, most: 0, behind: 0, alone: false } } else { Inside { behind: 0, ..inside } }
    }

    /// The information about the next loop, given what is inside it.
    fn info(&mut self, inside: Inside) -> LoopInfo {
        self.number += 1;
        let rounds = i32::try_from(inside.rounds).map_or(i32::MAX, |all| all.saturating_add(1));
        LoopInfo { spends: false, rounds, counting: Counting::InContext, number: self.number }
    }
}

/// Makes the loops of a block whose rounds are counted after them yield the cycle there, except loops inside other
/// loops.
fn wait_behind(block: &mut Block) {
    for stmt in block {
        match info(stmt) {
            Some(info) => info.spends |= info.counting.is_behind(),
            None => inner_blocks(stmt).into_iter().for_each(wait_behind),
        }
    }
}

/// Whether a statement, apart from the blocks in it, only computes.
fn calculates(stmt: &Stmt) -> bool {
    !matches!(stmt.kind, StmtKind::Goto(_) | StmtKind::Label(_)) && flow::expressions(stmt).all(is_calculation)
}

fn is_calculation(expr: &Expr) -> bool {
    let itself = match &expr.kind {
        ExprKind::Call(..) => false,
        ExprKind::Builtin(builtin) => builtin.entry.effect == Effect::Pure,
        _ => true,
    };
    itself && parts::children(expr).into_iter().all(is_calculation)
}

/// Whether control may leave a block for anything other than the code after the loop.
fn leaves(block: &[Stmt]) -> bool {
    block.iter().any(|stmt| matches!(stmt.kind, StmtKind::Return(_)) || flow::blocks(stmt).any(leaves))
}

fn info(stmt: &mut Stmt) -> Option<&mut LoopInfo> {
    match &mut stmt.kind {
        StmtKind::While(_, _, info) | StmtKind::Repeat(_, _, info) | StmtKind::Loop(_, info) => Some(info),
        StmtKind::For(each) => Some(&mut each.info),
        _ => None,
    }
}

/// Whether a loop may run further rounds without yielding the cycle.
fn repeats(stmt: &Stmt) -> bool {
    let body = match &stmt.kind {
        StmtKind::While(_, body, _) | StmtKind::Repeat(body, _, _) | StmtKind::Loop(body, _) => body,
        StmtKind::For(each) => &each.body,
        _ => return false,
    };
    flow::goes_round(body) && !body.iter().take_while(|stmt| !may_skip(stmt)).any(gives_back)
}

/// Whether the rest of the block may be skipped.
fn may_skip(stmt: &Stmt) -> bool {
    flow::has_label(stmt) || matches!(stmt.kind, StmtKind::Continue) || flow::continues(std::slice::from_ref(stmt))
}

/// Whether the statement yields the cycle each time: a wait does, and so does a motion, as the look-ahead is finite.
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

/// Whether a loop that counts alone takes a round before it evaluates its condition. It evaluates it once more after it
/// has yielded the cycle, so a condition that changes something comes after.
pub(crate) fn takes_first(scope: FactScope<'_>, condition: &Expr) -> bool {
    let facts = facts::of_expr(scope, condition);
    facts.changes || !facts.writes.is_empty()
}

/// A `for` that can be written as a Rust range.
pub(crate) struct Range<'a> {
    /// The loop's variable.
    pub(crate) local: LocalId,
    /// The first value of the variable.
    pub(crate) from: &'a Expr,
    /// The first value that the variable does not reach.
    pub(crate) to: &'a Expr,
    /// Whether 1 is added to `to`: if the condition is `<=` with a constant.
    pub(crate) beyond: bool,
}

/// The range of a loop: `for(int i = a; i < b; i++)` whose body writes neither `i` nor `b`.
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

/// The range that a loop is emitted as; `None` if its variable is needed after the loop or kept while it waits.
pub(crate) fn emitted_range(each: &For) -> Option<Range<'_>> {
    range(each).filter(|_| each.info.counting == Counting::InContext)
}

/// A `for` whose variable is written only by its step, which adds to it: `for(int i = from; i op to; i = i + step)`.
pub(crate) struct Head<'a> {
    pub(crate) local: LocalId,
    pub(crate) from: &'a Expr,
    pub(crate) op: BinaryOp,
    pub(crate) to: &'a Expr,
    /// The increment; `None` for `i++`.
    pub(crate) step: Option<&'a Expr>,
}

impl<'a> Head<'a> {
    /// The header, if no event sees the variable.
    pub(crate) fn of(each: &'a For) -> Option<Self> {
        if each.shared { None } else { Self::of_any(each) }
    }

    /// The header, also if the variable is visible to other code, provided that this does not change it.
    pub(crate) fn of_any(each: &'a For) -> Option<Self> {
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
        (whole && reads_variable(&sides.0) && !elsewhere).then_some(Self {
            local: *local,
            from,
            op: *op,
            to: &sides.1,
            step,
        })
    }
}

/// The number of rounds of a loop with constant bounds and a constant step.
fn known_rounds(each: &For) -> Option<u64> {
    let head = Head::of(each)?;
    let step = head.step.map_or(Some(1), whole_number).filter(|step| *step > 0)?;
    let (from, to) = (whole_number(head.from)?, whole_number(head.to)?);
    let beyond = match head.op {
        BinaryOp::Less => 0,
        BinaryOp::LessEqual => 1,
        _ => return None,
    };
    let distance = (to + beyond - from).max(0);
    // The variable must not wrap when it goes beyond the end.
    let last = from + (distance + step - 1) / step * step;
    let rounds = ((distance + step - 1) / step).unsigned_abs();
    (last <= greatest(head.from)?).then_some(rounds)
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

fn is_below_the_greatest(constant: &Expr) -> bool {
    whole_number(constant).zip(greatest(constant)).is_some_and(|(value, greatest)| value < greatest)
}

/// The greatest value of an integer's type.
fn greatest(expr: &Expr) -> Option<i64> {
    match expr.ty.base {
        Base::Int => Some(i64::from(i32::MAX)),
        Base::Uint => Some(i64::from(u32::MAX)),
        Base::Byte => Some(i64::from(u8::MAX)),
        _ => None,
    }
}

/// Whether a statement (or one inside it) writes a local variable.
fn stmt_writes(stmt: &Stmt, id: LocalId) -> bool {
    matches!(stmt.kind, StmtKind::Let(declared, _) if declared == id)
        || flow::expressions(stmt).any(|expr| expr_writes(expr, id))
        || flow::blocks(stmt).any(|block| block.iter().any(|stmt| stmt_writes(stmt, id)))
}

/// How often a statement and those inside it write a local variable.
pub(super) fn writes_in(stmt: &Stmt, id: LocalId) -> usize {
    let mut writes = Vec::new();
    flow::expressions(stmt).for_each(|expr| parts::local_writes(expr, &mut writes));
    let own = writes.into_iter().filter(|written| *written == id).count();
    let declared = usize::from(matches!(stmt.kind, StmtKind::Let(declared, _) if declared == id));
    own + declared + flow::blocks(stmt).flatten().map(|stmt| writes_in(stmt, id)).sum::<usize>()
}

pub(super) fn expr_writes(expr: &Expr, id: LocalId) -> bool {
    let mut writes = Vec::new();
    parts::local_writes(expr, &mut writes);
    writes.contains(&id)
}
