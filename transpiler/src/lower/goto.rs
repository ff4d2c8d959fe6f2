//! Functions with `goto`.
//!
//! Their local variables keep their places for the whole function. A jump gives the variables that are visible at the
//! label but not at the jump their start values: it skips their declarations. Loops that contain a label count their
//! rounds at the start of each round, as the machine does that the emitter makes of them.
//! Where control comes from other blocks, clocks and connections that are not visible are dropped, as in that machine.

use super::body::FunctionCode;
use super::control_flow::OpenLoop;
use crate::effects::flow;
use crate::effects::visibility::{self, Visibility};
use crate::hir::{Arm, Expr, For, Func, LabelId, LocalId, LoopInfo, Stmt, StmtKind};
use arl_code::Op;
use arl_lang::span::Span;

impl<'p> FunctionCode<'p, '_> {
    /// Gives all local variables their places.
    pub(super) fn lay_out_all(&mut self, func: &'p Func) {
        for (at, local) in func.locals.iter().enumerate() {
            let known = local.constant && local.value.is_some();
            let id = LocalId(at as u32);
            if !known && !self.locals.contains_key(&id) {
                self.declare(id);
            }
        }
        self.flow.visibility = Visibility::of(func);
    }

    /// `goto label`
    pub(super) fn goto(&mut self, label: LabelId, span: Span) {
        for id in self.flow.visibility.skipped(label, span) {
            self.passing(|body| body.reset(id));
        }
        let backwards = self
            .func
            .and_then(|func| func.labels.get(label.0 as usize))
            .is_some_and(|label| label.span.start <= span.start);
        if backwards {
            self.op(Op::Spend { rounds: 1 });
        }
        let jump = self.op(Op::Jump { to: 0 });
        self.flow.gotos.push((label, jump));
    }

    /// Begins a place that control gets to from other blocks: what these have declared has ended.
    fn begin(&mut self) {
        for id in visibility::ended_handles(self.func, &self.flow.visible) {
            self.drop_local(id);
        }
    }

    /// Leads all jumps to their labels.
    pub(super) fn complete_gotos(&mut self) {
        for (label, jump) in std::mem::take(&mut self.flow.gotos) {
            if let Some(target) = self.flow.labels.get(&label).copied() {
                self.lead(jump, target);
            }
        }
    }

    /// The statements of a block that may have labels.
    pub(super) fn states(&mut self, block: &'p [Stmt]) {
        let visible = self.flow.visible.len();
        for stmt in flow::reachable(block) {
            self.stand_at(stmt.span);
            match &stmt.kind {
                StmtKind::Label(label) => {
                    let here = self.here();
                    self.flow.labels.insert(*label, here);
                    self.begin();
                }
                _ if flow::has_label(stmt) => self.taken_apart(stmt),
                _ => self.statement(stmt),
            }
        }
        self.end_scope(visible);
    }

    /// A statement with a label inside.
    fn taken_apart(&mut self, stmt: &'p Stmt) {
        match &stmt.kind {
            StmtKind::If(arms, otherwise) => self.if_with_labels(arms, otherwise.as_deref()),
            StmtKind::Switch(subject, arms) => self.switch_with_labels(subject, arms),
            StmtKind::While(condition, body, info) => self.while_with_labels(Some(condition), body, *info),
            StmtKind::Loop(body, info) => self.while_with_labels(None, body, *info),
            StmtKind::Repeat(body, until, info) => self.repeat_with_labels(body, until, *info),
            StmtKind::For(each) => self.for_with_labels(each),
            _ => {}
        }
    }

    fn if_with_labels(&mut self, arms: &'p [(Expr, Vec<Stmt>)], otherwise: Option<&'p [Stmt]>) {
        let mut ends = Vec::new();
        for (at, (condition, block)) in arms.iter().enumerate() {
            self.stand_at(condition.span);
            self.halt();
            if at == 0 {
                self.pointer(condition);
            }
            let unmet = self.jump_if(condition, false);
            self.states(block);
            ends.push(self.op(Op::Jump { to: 0 }));
            self.lead_here(unmet);
        }
        otherwise.into_iter().for_each(|block| self.states(block));
        self.lead_here(ends);
        self.begin();
    }

    fn switch_with_labels(&mut self, subject: &'p Expr, arms: &'p [Arm]) {
        let (entries, otherwise) = self.choose(subject, arms);
        let mut ends = Vec::new();
        let mut otherwise = Some(otherwise);
        for (arm, entry) in arms.iter().zip(entries) {
            if arm.value.is_none() {
                self.lead_here(otherwise.take());
            }
            self.lead_here(entry);
            self.states(&arm.body);
            ends.push(self.op(Op::Jump { to: 0 }));
        }
        self.lead_here(otherwise);
        self.lead_here(ends);
        self.begin();
    }

    /// The body of a loop.
    fn round_with_labels(&mut self, body: &'p [Stmt]) -> OpenLoop {
        self.flow.loops.push(OpenLoop::default());
        self.states(body);
        self.flow.loops.pop().unwrap_or_default()
    }

    fn while_with_labels(&mut self, condition: Option<&'p Expr>, body: &'p [Stmt], info: LoopInfo) {
        let line = self.line;
        let head = self.here();
        self.begin();
        if info.counts_in_context() {
            self.op(Op::Spend { rounds: info.rounds });
        }
        self.halt();
        let mut leave = Vec::new();
        if let Some(condition) = condition.filter(|condition| !flow::always(condition)) {
            self.pointer(condition);
            leave = self.jump_if(condition, false);
        }
        let OpenLoop { breaks, continues } = self.round_with_labels(body);
        self.op(Op::Jump { to: head });
        continues.into_iter().for_each(|jump| self.lead(jump, head));
        self.lead_here(leave.into_iter().chain(breaks));
        self.begin();
        self.line = line;
    }

    fn repeat_with_labels(&mut self, body: &'p [Stmt], until: &'p Expr, info: LoopInfo) {
        self.halt();
        let head = self.here();
        let OpenLoop { breaks, continues } = self.round_with_labels(body);
        self.lead_here(continues);
        self.begin();
        self.stand_at(until.span);
        self.halt();
        self.pointer(until);
        let leave = self.jump_if(until, true);
        if info.counts_in_context() {
            self.op(Op::Spend { rounds: info.rounds });
        }
        self.op(Op::Jump { to: head });
        self.lead_here(leave.into_iter().chain(breaks));
        self.begin();
    }

    fn for_with_labels(&mut self, each: &'p For) {
        let visible = self.flow.visible.len();
        let line = self.line;
        self.halt_at_head(&each.init);
        for stmt in &each.init {
            self.statement(stmt);
        }
        self.line = line;
        let head = self.here();
        let mut leave = Vec::new();
        if let Some(condition) = each.condition.as_ref().filter(|condition| !flow::always(condition)) {
            self.pointer(condition);
            leave = self.jump_if(condition, false);
        }
        let OpenLoop { breaks, continues } = self.round_with_labels(&each.body);
        self.lead_here(continues);
        self.begin();
        self.line = line;
        self.halt();
        if each.info.counts_in_context() {
            self.op(Op::Spend { rounds: each.info.rounds });
        }
        each.step.iter().for_each(|step| self.effect(step));
        self.op(Op::Jump { to: head });
        self.lead_here(leave.into_iter().chain(breaks));
        self.begin();
        self.end_scope(visible);
    }
}
