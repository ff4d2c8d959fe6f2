//! Statements and blocks.

use super::body::FunctionCode;
use super::tables::constant_word;
use super::variables::is_text;
use crate::effects::{flow, visibility};
use crate::hir::{Arm, Expr, Stmt, StmtKind, Value};
use arl_code::{Address, Comparison, Op};
use arl_lang::catalog::Base;

impl<'p> FunctionCode<'p, '_> {
    /// The statements of a block, as a scope.
    pub(super) fn block(&mut self, block: &'p [Stmt]) {
        let visible = self.flow.visible.len();
        self.passing(|body| {
            for stmt in flow::reachable(block) {
                body.statement(stmt);
            }
        });
        if !flow::block_diverges(block) {
            self.drop_handles(block);
            self.drop_declared(block);
        }
        self.end_scope(visible);
    }

    /// Drops the clocks and connections of a block that ends here: their connections are closed.
    pub(super) fn drop_handles(&mut self, block: &[Stmt]) {
        let handles = visibility::handles(block, self.func);
        if handles.is_empty() {
            return;
        }
        if self.func.is_some_and(|func| func.has_goto) {
            return handles.into_iter().for_each(|id| self.drop_local(id));
        }
        let at = self.used.frame.handles;
        let count = self.most_handles().saturating_sub(at);
        if count > 0 && !self.keeps_places() {
            self.op(Op::DropHandles { at, count });
        }
    }

    /// One statement.
    pub(super) fn statement(&mut self, stmt: &'p Stmt) {
        self.stand_at(stmt.span);
        let line = self.line;
        self.halt_before(stmt);
        match &stmt.kind {
            // The variable stays when the statement is over.
            StmtKind::Let(id, value) => self.let_statement(*id, value.as_ref()),
            kind => self.passing(|body| body.bare_statement(kind, stmt)),
        }
        self.line = line;
    }

    fn bare_statement(&mut self, kind: &'p StmtKind, stmt: &'p Stmt) {
        match kind {
            StmtKind::Let(..) | StmtKind::Label(_) => {}
            StmtKind::Eval(expr) => self.effect(expr),
            StmtKind::If(arms, otherwise) => self.branches(arms, otherwise.as_deref()),
            StmtKind::While(condition, body, info) => self.while_loop(condition, body, *info),
            StmtKind::Repeat(body, until, info) => self.repeat_loop(body, until, *info),
            StmtKind::Loop(body, info) => self.endless_loop(body, *info),
            StmtKind::For(each) => self.for_loop(each),
            StmtKind::Switch(subject, arms) => self.switch(subject, arms),
            StmtKind::Break => {
                let jump = self.op(Op::Jump { to: 0 });
                self.flow.loops.last_mut().into_iter().for_each(|innermost| innermost.breaks.push(jump));
            }
            StmtKind::Continue => {
                let jump = self.op(Op::Jump { to: 0 });
                self.flow.loops.last_mut().into_iter().for_each(|innermost| innermost.continues.push(jump));
            }
            StmtKind::Goto(label) => self.goto(*label, stmt.span),
            StmtKind::Return(value) => self.return_statement(value.as_ref()),
        }
    }

    /// An expression that is used for its effect.
    pub(super) fn effect(&mut self, expr: &'p Expr) {
        self.passing(|body| {
            body.pointer(expr);
            body.effect_of(expr);
        });
    }

    /// `if`, `elseif`, `else`: the program pointer is set before the first condition only.
    fn branches(&mut self, arms: &'p [(Expr, Vec<Stmt>)], otherwise: Option<&'p [Stmt]>) {
        let mut ends = Vec::new();
        for (at, (condition, block)) in arms.iter().enumerate() {
            self.stand_at(condition.span);
            self.halt();
            if at == 0 {
                self.pointer(condition);
            }
            let unmet = self.jump_if(condition, false);
            self.block(block);
            let is_last = at + 1 == arms.len() && otherwise.is_none();
            if !is_last && !flow::block_diverges(block) {
                ends.push(self.op(Op::Jump { to: 0 }));
            }
            self.lead_here(unmet);
        }
        if let Some(block) = otherwise {
            self.block(block);
        }
        self.lead_here(ends);
    }

    /// `switch`: the arm without a value is taken last, wherever it stands.
    fn switch(&mut self, subject: &'p Expr, arms: &'p [Arm]) {
        let (entries, otherwise) = self.choose(subject, arms);
        let mut ends = Vec::new();
        let mut otherwise = Some(otherwise);
        for (arm, entry) in arms.iter().zip(entries) {
            if arm.value.is_none() {
                self.lead_here(otherwise.take());
            }
            self.lead_here(entry);
            self.block(&arm.body);
            if !flow::block_diverges(&arm.body) {
                ends.push(self.op(Op::Jump { to: 0 }));
            }
        }
        self.lead_here(otherwise);
        self.lead_here(ends);
    }

    /// The jumps to the arms of a `switch`, and the one that is taken if no value is that of the subject.
    pub(super) fn choose(&mut self, subject: &'p Expr, arms: &'p [Arm]) -> (Vec<Vec<Address>>, Address) {
        self.stand_at(subject.span);
        self.halt();
        self.pointer(subject);
        self.passing(|body| {
            let entries = if is_text(subject.ty) {
                let left = body.text(subject);
                arms.iter().map(|arm| body.jump_to_text_arm(left, arm)).collect()
            } else {
                let left = body.number(subject, None);
                arms.iter().map(|arm| body.jump_to_arm(left, subject.ty.base, arm)).collect()
            };
            (entries, body.op(Op::Jump { to: 0 }))
        })
    }

    fn jump_to_text_arm(&mut self, left: u16, arm: &'p Arm) -> Vec<Address> {
        let Some(Value::String(text)) = &arm.value else { return Vec::new() };
        self.passing(|body| {
            let at = body.lowering.text(text);
            let right = body.text_slot();
            let to = body.register();
            body.op(Op::Text { to: right, at });
            body.op(Op::CompareTexts { to, left, right, by: Comparison::Equal });
            vec![body.op(Op::JumpIf { from: to, to: 0 })]
        })
    }

    fn jump_to_arm(&mut self, left: u8, base: Base, arm: &'p Arm) -> Vec<Address> {
        let Some(word) = arm.value.as_ref().and_then(constant_word) else { return Vec::new() };
        if base != Base::Double {
            return vec![self.op(Op::JumpEqualSmall { left, value: word as u32 as i32, to: 0 })];
        }
        self.passing(|body| {
            let right = body.register();
            body.word_to(right, word);
            vec![body.op(Op::JumpCompare { left, right, by: Comparison::EqualDouble, wanted: true, to: 0 })]
        })
    }
}
