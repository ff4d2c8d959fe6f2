//! The reads and writes of a function's locals along the control flow, to find values that are never read.
//!
//! The graph follows the emitted code, so that it gives the same results about assignments as rustc. Functions with
//! `goto` are left out, as their states hide the control flow from rustc.

use super::compound::{is_native, stepped};
use super::mentions::{in_expression, indices};
use crate::effects::facts;
use crate::effects::parts::children;
use crate::effects::{flow, loops};
use crate::hir::{
    Arm, Block, Expr, ExprKind, For, Func, FuncId, LocalId, LoopInfo, Passed, Place, Root, Stmt, StmtKind,
};
use arl_lang::ast::BinaryOp;
use arl_lang::catalog::{Entry, Mode};
use std::collections::HashMap;

/// An analysis that needs more bits than this is not worth it.
const MOST_BITS: usize = 1 << 26;

/// More locals than this are not kept while a loop yields the cycle, for readability.
const MOST_KEPT: usize = 8;

/// What the loops with these numbers do with locals while they yield the cycle.
#[derive(Default, Debug)]
pub(super) struct Kept {
    /// The locals passed to the wait and returned from it.
    pub(super) handed: HashMap<u32, Vec<LocalId>>,
    /// The locals that stay in memory during the wait and are needed after it.
    pub(super) in_memory: HashMap<u32, Vec<LocalId>>,
}

/// The kind of a write.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Site {
    /// The declaration, with no value or a constant one.
    Declaration,
    /// Any other, parameters included.
    Other,
}

#[derive(Clone, Copy, Debug)]
enum Op {
    Read(LocalId),
    Write(LocalId, Site),
    /// A write that needs the old value only for the write itself: of a part, or `x += 1`.
    Update(LocalId),
    /// A declaration that is not a write: the variable is new.
    Fresh(LocalId),
    /// The loop with this number yields the cycle.
    Pause(u32),
    /// Something else waits.
    Wait,
}

/// The readers of a value.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Readers {
    /// All readers: the variable must have a value there.
    All,
    /// All except updates of the variable itself: rustc finds unused values in this manner.
    Others,
}

/// Operations that run one after another.
#[derive(Default, Debug)]
struct Node {
    ops: Vec<Op>,
    next: Vec<usize>,
}

/// The control flow of a function.
#[derive(Debug)]
pub(super) struct Graph {
    nodes: Vec<Node>,
    words: usize,
    /// Locals that are written inside loops.
    repeated: Vec<LocalId>,
}

impl Graph {
    /// The graph of a function; `waits` returns which functions may wait when called. `None` if the graph would be too
    /// large.
    pub(super) fn of_function(func: &Func, waits: &dyn Fn(FuncId) -> bool) -> Option<Graph> {
        let mut builder =
            Builder { nodes: vec![Node::default()], current: Some(0), loops: Vec::new(), repeated: Vec::new(), waits };
        for param in &func.params {
            builder.op(Op::Write(*param, Site::Other));
        }
        builder.block(&func.body);
        let words = func.locals.len().div_ceil(64);
        let bits = builder.nodes.len().saturating_mul(func.locals.len());
        (bits <= MOST_BITS).then_some(Graph { nodes: builder.nodes, words, repeated: builder.repeated })
    }

    /// The writes whose value is never read.
    pub(super) fn wasted(&self, readers: Readers) -> Vec<(LocalId, Site)> {
        let live = self.live_at_start(readers);
        let mut found = Vec::new();
        for node in &self.nodes {
            let mut set = self.live_at_end(node, &live);
            for op in node.ops.iter().rev() {
                match op {
                    Op::Write(id, site) if !set.contains(*id) => found.push((*id, *site)),
                    Op::Update(id) if !set.contains(*id) => found.push((*id, Site::Other)),
                    _ => {}
                }
                set.before(*op, readers);
            }
        }
        found
    }

    /// For the `wanted` locals that are written inside loops: those that are live where each loop yields the cycle.
    /// Locals that are live where something else waits stay in memory, as do all that are not passed to the wait;
    /// `plain` returns which of these may be read there.
    pub(super) fn kept(&self, wanted: &dyn Fn(LocalId) -> bool, plain: &dyn Fn(LocalId) -> bool) -> Kept {
        let live = self.live_at_start(Readers::All);
        let (mut waiting, mut pauses) = (Set::new(self.words), Vec::new());
        for node in &self.nodes {
            let mut set = self.live_at_end(node, &live);
            for op in node.ops.iter().rev() {
                match op {
                    Op::Wait => _ = waiting.add_all(&set),
                    Op::Pause(number) => pauses.push((*number, set.clone())),
                    _ => set.before(*op, Readers::All),
                }
            }
        }
        let mut candidates: Vec<LocalId> =
            self.repeated.iter().copied().filter(|id| wanted(*id) && !waiting.contains(*id)).collect();
        candidates.sort_unstable_by_key(|id| id.0);
        candidates.dedup();
        // A local that is not kept everywhere stays in memory everywhere. Locals of inner blocks have higher numbers.
        while let Some(first) = pauses.iter().find_map(|(_, live)| {
            let mut kept = candidates.iter().filter(|id| live.contains(**id));
            kept.next().copied().filter(|_| kept.count() >= MOST_KEPT)
        }) {
            candidates.retain(|id| *id != first);
        }
        let handed = |live: &Set| candidates.iter().copied().filter(|id| live.contains(*id)).collect();
        let in_memory = |live: &Set| {
            let others = live.iter().filter(|id| plain(*id) && !candidates.contains(id));
            let others: Vec<LocalId> = others.collect();
            others.get(others.len().saturating_sub(MOST_KEPT)..).unwrap_or_default().to_vec()
        };
        Kept {
            handed: pauses.iter().map(|(number, live)| (*number, handed(live))).collect(),
            in_memory: pauses.iter().map(|(number, live)| (*number, in_memory(live))).collect(),
        }
    }

    fn live_at_end(&self, node: &Node, live: &[Set]) -> Set {
        let mut set = Set::new(self.words);
        for next in node.next.iter().filter_map(|next| live.get(*next)) {
            set.add_all(next);
        }
        set
    }

    fn live_at_start(&self, readers: Readers) -> Vec<Set> {
        let mut live = vec![Set::new(self.words); self.nodes.len()];
        let mut changed = true;
        while changed {
            changed = false;
            for (at, node) in self.nodes.iter().enumerate().rev() {
                let mut set = self.live_at_end(node, &live);
                node.ops.iter().rev().for_each(|op| set.before(*op, readers));
                if let Some(old) = live.get_mut(at)
                    && *old != set
                {
                    *old = set;
                    changed = true;
                }
            }
        }
        live
    }

    /// The `late` locals that are assigned where they may already have been assigned.
    pub(super) fn assigned_again(&self, late: &dyn Fn(LocalId) -> bool) -> Vec<LocalId> {
        let mut assigned = vec![Set::new(self.words); self.nodes.len()];
        let mut found = Vec::new();
        let mut changed = true;
        while changed {
            changed = false;
            found.clear();
            for (at, node) in self.nodes.iter().enumerate() {
                let Some(mut set) = assigned.get(at).cloned() else { continue };
                for op in &node.ops {
                    match op {
                        Op::Write(id, Site::Other) if late(*id) => {
                            if set.contains(*id) {
                                found.push(*id);
                            }
                            set.add(*id);
                        }
                        Op::Write(id, Site::Declaration) | Op::Fresh(id) => set.remove(*id),
                        Op::Update(id) if late(*id) => found.push(*id),
                        Op::Write(..) | Op::Read(_) | Op::Update(_) | Op::Pause(_) | Op::Wait => {}
                    }
                }
                for next in &node.next {
                    if let Some(start) = assigned.get_mut(*next) {
                        changed |= start.add_all(&set);
                    }
                }
            }
        }
        found
    }
}

/// A set of locals.
#[derive(Clone, PartialEq, Eq, Debug)]
struct Set(Vec<u64>);

impl Set {
    fn new(words: usize) -> Self {
        Self(vec![0; words])
    }

    fn contains(&self, id: LocalId) -> bool {
        self.0.get(id.0 as usize / 64).is_some_and(|word| word & (1 << (id.0 % 64)) != 0)
    }

    fn iter(&self) -> impl Iterator<Item = LocalId> {
        let ids = 0..u32::try_from(self.0.len() * 64).unwrap_or(u32::MAX);
        ids.map(LocalId).filter(|id| self.contains(*id))
    }

    fn add(&mut self, id: LocalId) {
        if let Some(word) = self.0.get_mut(id.0 as usize / 64) {
            *word |= 1 << (id.0 % 64);
        }
    }

    fn remove(&mut self, id: LocalId) {
        if let Some(word) = self.0.get_mut(id.0 as usize / 64) {
            *word &= !(1 << (id.0 % 64));
        }
    }

    /// Adds a set; returns whether that changed anything.
    fn add_all(&mut self, other: &Set) -> bool {
        let mut changed = false;
        for (word, more) in self.0.iter_mut().zip(&other.0) {
            changed |= *more & !*word != 0;
            *word |= more;
        }
        changed
    }

    /// Computes what is live before an operation from what is live after it.
    fn before(&mut self, op: Op, readers: Readers) {
        match op {
            Op::Read(id) => self.add(id),
            Op::Update(id) if readers == Readers::All => self.add(id),
            Op::Update(_) => {}
            Op::Write(id, _) | Op::Fresh(id) => self.remove(id),
            Op::Pause(_) | Op::Wait => {}
        }
    }
}

/// Whether a built-in assigns its output and takes no reference to it.
pub(super) fn writes_only(entry: &Entry) -> bool {
    entry.params.iter().any(|param| param.mode == Mode::Condition)
}

struct Loop {
    breaks: Vec<usize>,
    continues: usize,
    /// Whether there is a `continue`.
    continued: bool,
}

struct Builder<'a> {
    nodes: Vec<Node>,
    /// The node being extended; `None` after a jump.
    current: Option<usize>,
    loops: Vec<Loop>,
    /// The locals that are written inside a loop.
    repeated: Vec<LocalId>,
    /// Returns which functions may wait.
    waits: &'a dyn Fn(FuncId) -> bool,
}

impl Builder<'_> {
    fn op(&mut self, op: Op) {
        if let Op::Write(id, _) | Op::Update(id) = op
            && !self.loops.is_empty()
        {
            self.repeated.push(id);
        }
        if let Some(node) = self.current.and_then(|at| self.nodes.get_mut(at)) {
            node.ops.push(op);
        }
    }

    fn node(&mut self) -> usize {
        self.nodes.push(Node::default());
        self.nodes.len() - 1
    }

    fn link(&mut self, from: Option<usize>, to: usize) {
        if let Some(node) = from.and_then(|at| self.nodes.get_mut(at)) {
            node.next.push(to);
        }
    }

    /// Continues in a new node that follows all of these.
    fn join(&mut self, ends: impl IntoIterator<Item = Option<usize>>) {
        let node = self.node();
        let mut reached = false;
        for end in ends {
            self.link(end, node);
            reached |= end.is_some();
        }
        self.current = reached.then_some(node);
    }

    /// Starts a new node after the current one.
    fn step(&mut self) -> usize {
        let (from, node) = (self.current, self.node());
        self.link(from, node);
        self.current = from.map(|_| node);
        node
    }

    fn block(&mut self, block: &[Stmt]) {
        for stmt in flow::reachable(block) {
            self.stmt(stmt);
        }
    }

    fn stmt(&mut self, stmt: &Stmt) {
        match &stmt.kind {
            StmtKind::Let(id, value) => {
                value.iter().for_each(|value| self.expr(value, true));
                let plain = value.as_ref().is_none_or(|value| matches!(value.kind, ExprKind::Const(_)));
                self.op(Op::Write(*id, if plain { Site::Declaration } else { Site::Other }));
            }
            StmtKind::Eval(expr) => {
                self.expr(expr, false);
                if flow::ends(expr) {
                    self.current = None;
                }
            }
            StmtKind::If(arms, otherwise) => self.choice(arms, otherwise.as_ref()),
            StmtKind::Switch(subject, arms) => self.switch(subject, arms),
            StmtKind::While(condition, body, info) => {
                let head = self.head(*info);
                self.expr(condition, true);
                let out = if flow::always(condition) { None } else { self.current };
                self.step();
                self.round(body, *info, head, out);
                self.pause_behind(*info);
            }
            StmtKind::Loop(body, info) => {
                let head = self.head(*info);
                self.round(body, *info, head, None);
            }
            StmtKind::Repeat(body, until, info) => self.repeat(body, until, *info),
            StmtKind::For(each) => match loops::emitted_range(each) {
                Some(range) => self.counted_for(each, &range),
                None => self.general_for(each),
            },
            StmtKind::Return(value) => {
                value.iter().for_each(|value| self.expr(value, true));
                self.current = None;
            }
            StmtKind::Break => {
                let from = self.current.take();
                if let (Some(from), Some(innermost)) = (from, self.loops.last_mut()) {
                    innermost.breaks.push(from);
                }
            }
            StmtKind::Continue => {
                let from = self.current.take();
                if let Some(innermost) = self.loops.last_mut() {
                    innermost.continued |= from.is_some();
                    let to = innermost.continues;
                    self.link(from, to);
                }
            }
            StmtKind::Goto(_) | StmtKind::Label(_) => {}
        }
    }

    fn choice(&mut self, arms: &[(Expr, Block)], otherwise: Option<&Block>) {
        let mut ends = Vec::new();
        for (condition, block) in arms {
            self.expr(condition, true);
            let from = self.current;
            self.step();
            self.block(block);
            ends.push(self.current);
            self.current = from;
            self.step();
        }
        otherwise.iter().for_each(|block| self.block(block));
        ends.push(self.current);
        self.join(ends);
    }

    fn switch(&mut self, subject: &Expr, arms: &[Arm]) {
        self.expr(subject, true);
        let from = self.current;
        let mut ends = Vec::new();
        for arm in arms {
            self.current = from;
            self.step();
            self.block(&arm.body);
            ends.push(self.current);
        }
        if !flow::exhaustive(subject, arms.iter().map(|arm| arm.value.as_ref())) {
            ends.push(from);
        }
        self.join(ends);
    }

    fn counted_for(&mut self, each: &For, range: &loops::Range) {
        self.expr(range.from, true);
        self.expr(range.to, true);
        let head = self.step();
        let out = self.current;
        self.step();
        self.op(Op::Fresh(range.local));
        self.round(&each.body, each.info, head, out);
    }

    /// The start of a round. Loops that count alone yield the cycle there.
    fn head(&mut self, info: LoopInfo) -> usize {
        let head = self.step();
        if info.counts_alone() {
            self.op(Op::Pause(info.number));
        }
        head
    }

    /// The point where other loops yield the cycle.
    fn pause(&mut self, info: LoopInfo) {
        if info.counts_in_context() {
            self.op(Op::Pause(info.number));
        }
    }

    /// The point after a loop whose rounds are counted there.
    fn pause_behind(&mut self, info: LoopInfo) {
        if info.spends && info.counting.is_behind() {
            self.op(Op::Pause(info.number));
        }
    }

    /// The body of a loop from the current node on, followed by the exit.
    fn round(&mut self, body: &[Stmt], info: LoopInfo, head: usize, out: Option<usize>) {
        self.loops.push(Loop { breaks: Vec::new(), continues: head, continued: false });
        let first = flow::continues(body);
        if first {
            self.pause(info);
        }
        self.block(body);
        if !first {
            self.pause(info);
        }
        let end = self.current;
        self.link(end, head);
        let breaks = self.loops.pop().map_or_else(Vec::new, |done| done.breaks);
        self.join(std::iter::once(out).chain(breaks.into_iter().map(Some)));
    }

    /// Continues after the body of the innermost loop, if its end or a `continue` leads there.
    fn go_on_if_reached(&mut self, end: Option<usize>, node: usize) {
        let continued = self.loops.last().is_some_and(|innermost| innermost.continued);
        self.current = (end.is_some() || continued).then_some(node);
    }

    fn repeat(&mut self, body: &[Stmt], until: &Expr, info: LoopInfo) {
        let head = self.head(info);
        let test = self.node();
        self.loops.push(Loop { breaks: Vec::new(), continues: test, continued: false });
        self.block(body);
        let end = self.current;
        self.link(end, test);
        self.go_on_if_reached(end, test);
        self.expr(until, true);
        let out = self.current;
        self.step();
        self.pause(info);
        let back = self.current;
        self.link(back, head);
        let breaks = self.loops.pop().map_or_else(Vec::new, |done| done.breaks);
        self.join(std::iter::once(out).chain(breaks.into_iter().map(Some)));
    }

    fn general_for(&mut self, each: &For) {
        self.block(&each.init);
        let head = self.head(each.info);
        each.condition.iter().for_each(|condition| self.expr(condition, true));
        let out = if each.condition.as_ref().is_none_or(flow::always) { None } else { self.current };
        self.step();
        let next = self.node();
        self.loops.push(Loop { breaks: Vec::new(), continues: next, continued: false });
        self.block(&each.body);
        let end = self.current;
        self.link(end, next);
        self.go_on_if_reached(end, next);
        each.step.iter().for_each(|step| self.expr(step, false));
        self.pause(each.info);
        let back = self.current;
        self.link(back, head);
        let breaks = self.loops.pop().map_or_else(Vec::new, |done| done.breaks);
        self.join(std::iter::once(out).chain(breaks.into_iter().map(Some)));
        self.pause_behind(each.info);
    }

    /// An expression in the order of its evaluation; `wanted`: its value is used.
    fn expr(&mut self, expr: &Expr, wanted: bool) {
        if let Some(value) = facts::same_anyway(expr) {
            if wanted || !matches!(value.kind, ExprKind::Place(_)) {
                self.expr(value, wanted);
            }
            return;
        }
        match &expr.kind {
            ExprKind::Place(place) => {
                self.indices(place);
                self.read(place);
            }
            ExprKind::Binary(BinaryOp::And | BinaryOp::Or, sides) => {
                self.expr(&sides.0, true);
                let from = self.current;
                self.step();
                self.expr(&sides.1, true);
                let end = self.current;
                self.join([from, end]);
            }
            ExprKind::Assign(sides) if stepped(&sides.0, &sides.1).is_some() => {
                stepped(&sides.0, &sides.1).into_iter().for_each(|(_, by)| self.expr(by, true));
                self.update(&sides.0, wanted);
            }
            ExprKind::AssignOp(op, sides) if is_update(*op, sides) => {
                self.indices(&sides.0);
                self.expr(&sides.1, true);
                self.update(&sides.0, wanted);
            }
            ExprKind::Assign(sides) => {
                self.indices(&sides.0);
                self.expr(&sides.1, true);
                self.write(&sides.0, wanted && !matches!(sides.1.kind, ExprKind::Const(_)));
            }
            ExprKind::AssignOp(_, sides) => {
                self.indices(&sides.0);
                self.read(&sides.0);
                self.expr(&sides.1, true);
                self.write(&sides.0, wanted);
            }
            ExprKind::Step(step, place) => {
                self.indices(place);
                self.read(place);
                self.write(place, wanted && step.prefix);
            }
            ExprKind::Call(callee, _) => {
                children(expr).into_iter().for_each(|child| self.expr(child, true));
                if (self.waits)(*callee) {
                    self.op(Op::Wait);
                }
            }
            ExprKind::Builtin(builtin) => {
                children(expr).into_iter().for_each(|child| self.expr(child, true));
                if builtin.entry.effect.takes_time() {
                    self.op(Op::Wait);
                }
                for arg in &builtin.args {
                    if let Passed::Out(place) = &arg.value {
                        if writes_only(builtin.entry) {
                            self.write(place, false);
                        } else {
                            self.read(place);
                        }
                    }
                }
            }
            _ => children(expr).into_iter().for_each(|child| self.expr(child, true)),
        }
    }

    fn indices(&mut self, place: &Place) {
        indices(place).for_each(|index| self.expr(index, true));
    }

    fn read(&mut self, place: &Place) {
        if let Root::Local(id) = place.root {
            self.op(Op::Read(id));
        }
    }

    fn write(&mut self, place: &Place, wanted: bool) {
        let Root::Local(id) = place.root else { return };
        if place.path.is_empty() {
            self.op(Op::Write(id, Site::Other));
        } else {
            // Writing a part needs the whole variable.
            self.op(Op::Update(id));
        }
        if wanted {
            self.op(Op::Read(id));
        }
    }

    fn update(&mut self, place: &Place, wanted: bool) {
        let Root::Local(id) = place.root else { return };
        self.op(Op::Update(id));
        if wanted {
            self.op(Op::Read(id));
        }
    }
}

/// Whether `place op= value` is emitted in this form, for a local variable.
fn is_update(op: BinaryOp, sides: &(Place, Expr)) -> bool {
    let (place, value) = sides;
    let Root::Local(id) = place.root else { return false };
    is_native(op, place, value) && !in_expression(value, id)
}
