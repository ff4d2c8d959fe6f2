//! How the locals of a function are used, so that the emitted variables are `mut`, initialised and named as rustc
//! expects: a value that is never read is not assigned at the declaration, and a variable that is never read is
//! prefixed with `_`.

use super::compound::stepped;
use super::mentions::indices;
use super::types::is_number;
use super::usage_graph::{Graph, Kept, Readers, Site, writes_only};
use crate::effects::facts;
use crate::effects::parts::children;
use crate::effects::{flow, loops};
use crate::hir::{Expr, ExprKind, Func, FuncId, LocalId, LoopInfo, Passed, Place, Root, Stmt, StmtKind};

/// How a local is used.
#[derive(Clone, Copy, Default, Debug)]
struct Local {
    /// Its value is used somewhere.
    read: bool,
    /// It is written (also in part) after its declaration.
    written: bool,
    /// A part of it is written, or a reference to it is passed to be written.
    parts: bool,
    /// Its first value is never used: `let x: i32;`.
    late: bool,
    /// It is assigned where it may already have been assigned, after a declaration without a value.
    again: bool,
}

/// The information about all locals of a function.
#[derive(Default, Debug)]
pub(super) struct Usage {
    locals: Vec<Local>,
    /// Whether values are assigned that are never read.
    pub(super) wastes: bool,
    /// Whether code that was counted here has been omitted.
    pub(super) drops: bool,
    /// What each loop keeps while it yields the cycle.
    kept: Kept,
}

impl Usage {
    /// Examines a function. `waits` returns which functions may wait when called. `scattered`: the statements are
    /// decomposed, so that rustc cannot follow the control flow.
    pub(super) fn of_function(func: &Func, scattered: bool, waits: &dyn Fn(FuncId) -> bool) -> Self {
        let mut usage = Self::of_plain_locals(func, scattered, waits);
        // A variable that events see is a cell: its readers are unknown, and writing to it does not change the
        // variable.
        for (usage, _) in usage.locals.iter_mut().zip(&func.locals).filter(|(_, local)| local.shared) {
            *usage = Local { read: true, ..Local::default() };
        }
        usage
    }

    fn of_plain_locals(func: &Func, scattered: bool, waits: &dyn Fn(FuncId) -> bool) -> Self {
        let mut usage = Self { locals: vec![Local::default(); func.locals.len()], ..Self::default() };
        usage.block(&func.body);
        if scattered {
            usage.wastes = !func.locals.is_empty();
            return usage;
        }
        let Some(graph) = Graph::of_function(func, waits) else {
            usage.wastes = true;
            return usage;
        };
        let shared = |id: LocalId| func.locals.get(id.0 as usize).is_some_and(|local| local.shared);
        for (id, site) in graph.wasted(Readers::All) {
            if let Some(local) = usage.locals.get_mut(id.0 as usize) {
                local.late |= site == Site::Declaration && local.read;
            }
        }
        for (id, site) in graph.wasted(Readers::Others).into_iter().filter(|(id, _)| !shared(*id)) {
            let local = usage.get(id);
            usage.wastes |= local.read && !(local.late && site == Site::Declaration);
        }
        let wanted = |id: LocalId| {
            let number = func.locals.get(id.0 as usize).is_some_and(|local| is_number(local.ty));
            let own = usage.get(id);
            number && own.read && own.written && !own.parts && !shared(id)
        };
        let plain = |id: LocalId| {
            let number = func.locals.get(id.0 as usize).is_some_and(|local| is_number(local.ty));
            number && !usage.get(id).parts && !shared(id)
        };
        usage.kept = graph.kept(&wanted, &plain);
        let late = |id: LocalId| usage.locals.get(id.0 as usize).is_some_and(|local| local.late);
        for id in graph.assigned_again(&late) {
            if let Some(local) = usage.locals.get_mut(id.0 as usize) {
                local.again = true;
            }
        }
        for id in usage.kept.handed.values().flatten() {
            if let Some(local) = usage.locals.get_mut(id.0 as usize) {
                local.again = true;
            }
        }
        usage
    }

    /// The locals that a loop passes to the wait while it yields the cycle.
    pub(super) fn kept(&self, info: LoopInfo) -> &[LocalId] {
        self.kept.handed.get(&info.number).map_or(&[], Vec::as_slice)
    }

    /// The locals that a loop needs after the wait and that stay in memory meanwhile.
    pub(super) fn in_memory(&self, info: LoopInfo) -> &[LocalId] {
        self.kept.in_memory.get(&info.number).map_or(&[], Vec::as_slice)
    }

    fn get(&self, id: LocalId) -> Local {
        self.locals.get(id.0 as usize).copied().unwrap_or_default()
    }

    /// Whether its value is used.
    pub(super) fn is_read(&self, id: LocalId) -> bool {
        self.get(id).read
    }

    /// Whether it has to be `mut`.
    pub(super) fn is_mutable(&self, id: LocalId) -> bool {
        let local = self.get(id);
        if local.late { local.again || local.parts } else { local.written }
    }

    /// Whether it is declared without a value.
    pub(super) fn is_late(&self, id: LocalId) -> bool {
        self.get(id).late
    }

    fn mark(&mut self, place: &Place, change: impl FnOnce(&mut Local)) {
        if let Root::Local(id) = place.root
            && let Some(local) = self.locals.get_mut(id.0 as usize)
        {
            change(local);
        }
    }

    fn mark_written(&mut self, place: &Place) {
        let part = !place.path.is_empty();
        self.mark(place, |local| {
            local.written = true;
            local.parts |= part;
        });
    }

    fn block(&mut self, block: &[Stmt]) {
        for stmt in flow::reachable(block) {
            self.stmt(stmt);
        }
    }

    fn stmt(&mut self, stmt: &Stmt) {
        match &stmt.kind {
            StmtKind::Eval(expr) => self.effect(expr),
            StmtKind::For(each) => {
                if let Some(range) = loops::emitted_range(each) {
                    self.expr(range.from);
                    self.expr(range.to);
                } else {
                    self.block(&each.init);
                    each.condition.iter().for_each(|condition| self.expr(condition));
                    each.step.iter().filter(|_| flow::goes_round(&each.body)).for_each(|step| self.effect(step));
                }
                self.block(&each.body);
            }
            StmtKind::Repeat(body, ..) if !flow::goes_round(body) => self.block(body),
            _ => {
                flow::expressions(stmt).for_each(|expr| self.expr(expr));
                flow::blocks(stmt).for_each(|block| self.block(block));
            }
        }
    }

    /// An expression whose value is not used: assigning to a variable does not count as reading it.
    fn effect(&mut self, expr: &Expr) {
        if let Some(value) = facts::same_anyway(expr) {
            if !matches!(value.kind, ExprKind::Place(_)) {
                self.effect(value);
            }
            return;
        }
        match &expr.kind {
            ExprKind::Assign(sides) if stepped(&sides.0, &sides.1).is_some() => {
                self.mark_written(&sides.0);
                stepped(&sides.0, &sides.1).into_iter().for_each(|(_, by)| self.expr(by));
            }
            ExprKind::Assign(sides) | ExprKind::AssignOp(_, sides) => {
                self.mark_written(&sides.0);
                indices(&sides.0).for_each(|index| self.expr(index));
                self.expr(&sides.1);
            }
            ExprKind::Step(_, place) => {
                self.mark_written(place);
                indices(place).for_each(|index| self.expr(index));
            }
            _ => self.expr(expr),
        }
    }

    fn expr(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Place(place) => self.mark(place, |local| local.read = true),
            ExprKind::Assign(_) if facts::same_anyway(expr).is_some() => {}
            // The value is known, so that the variable is not read for it.
            ExprKind::Assign(sides) if matches!(sides.1.kind, ExprKind::Const(_)) => self.mark_written(&sides.0),
            ExprKind::Assign(sides) | ExprKind::AssignOp(_, sides) => self.used_and_written(&sides.0),
            ExprKind::Step(_, place) => self.used_and_written(place),
            ExprKind::Builtin(builtin) => {
                for arg in &builtin.args {
                    if let Passed::Out(place) = &arg.value {
                        let handle = super::types::is_handle(place.ty);
                        let only = writes_only(builtin.entry);
                        self.mark(place, |local| {
                            local.read |= !only;
                            local.parts |= !only && !handle;
                            local.written |= !handle;
                        });
                    }
                }
            }
            _ => {}
        }
        children(expr).into_iter().for_each(|child| self.expr(child));
    }

    fn used_and_written(&mut self, place: &Place) {
        self.mark(place, |local| local.read = true);
        self.mark_written(place);
    }
}
