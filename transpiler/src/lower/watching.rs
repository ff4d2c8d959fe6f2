//! What code for a debugger has besides: halts before statements, and the variables that are seen.
//!
//! A variable has a place of its own in the frame of its function, so that one whose declaration was jumped over is
//! known by an empty place.

use super::body::FunctionCode;
use super::tables::value_type;
use crate::effects::flow;
use crate::hir::{LocalId, Stmt, StmtKind};
use arl_code::{Local, Op, Space};
use arl_lang::catalog::Base;

impl FunctionCode<'_, '_> {
    /// Whether the code is for a debugger.
    pub(super) fn is_watched(&self) -> bool {
        self.lowering.code.watched
    }

    /// The beginning of a function, or of the action of an event.
    pub(super) fn open(&mut self, is_action: bool) {
        if self.is_watched() {
            let line = self.line;
            self.op(Op::Open { line, is_action });
        }
    }

    /// The program may be halted here.
    pub(super) fn halt(&mut self) {
        if self.is_watched() {
            let line = self.line;
            self.op(Op::Halt { line });
        }
    }

    /// A halt before a statement; those with blocks have halts of their own.
    pub(super) fn halt_before(&mut self, stmt: &Stmt) {
        if !matches!(
            stmt.kind,
            StmtKind::Label(_)
                | StmtKind::Let(_, None)
                | StmtKind::If(..)
                | StmtKind::Switch(..)
                | StmtKind::While(..)
                | StmtKind::Loop(..)
                | StmtKind::Repeat(..)
                | StmtKind::For(..)
        ) {
            self.halt();
        }
    }

    /// A halt before a `for` that has nothing else to halt at there.
    pub(super) fn halt_at_head(&mut self, init: &[Stmt]) {
        if init.iter().all(|stmt| matches!(stmt.kind, StmtKind::Let(_, None))) {
            self.halt();
        }
    }

    /// A variable that was declared is seen from here on.
    pub(super) fn show(&mut self, id: LocalId) {
        let local = self.func.and_then(|func| func.locals.get(id.0 as usize));
        let (Some(local), Some(place)) = (local.filter(|local| local.shared), self.locals.get(&id).copied()) else {
            return;
        };
        if !self.is_watched() {
            return;
        }
        let here = self.here();
        let known = self.shown.get(&id).copied();
        let number = known.unwrap_or_else(|| {
            let (name, ty) = (local.name.as_str().into(), value_type(local.ty));
            let scope = here..here;
            self.lowering.code.locals.push(Local { name, number: id.0, ty, place, scope });
            self.lowering.code.locals.len() as u32 - 1
        });
        self.shown.insert(id, number);
        self.op(Op::Show { local: number });
    }

    /// The end of the scope of the variables that became visible since there were `visible` of them.
    pub(super) fn end_scope(&mut self, visible: usize) {
        let ended = self.flow.visible.split_off(visible.min(self.flow.visible.len()));
        let here = self.here();
        for id in ended {
            if let Some(local) = self.shown.get(&id).and_then(|at| self.lowering.code.locals.get_mut(*at as usize)) {
                local.scope.end = here;
            }
        }
    }

    /// The end of the function: variables whose declarations are never reached have been visible behind labels.
    pub(super) fn end_scopes(&mut self) {
        self.end_scope(0);
        let here = self.here();
        for at in self.shown.values() {
            if let Some(local) = self.lowering.code.locals.get_mut(*at as usize).filter(|local| local.scope.is_empty())
            {
                local.scope.end = here;
            }
        }
    }

    /// Drops the variables that blocks declare, in code for a debugger: they do not exist outside.
    pub(super) fn drop_declared(&mut self, block: &[Stmt]) {
        if !self.is_watched() || self.func.is_some_and(|func| func.has_goto) {
            return;
        }
        for stmt in block {
            if let StmtKind::Let(id, _) = &stmt.kind {
                self.drop_local(*id);
            }
            if let StmtKind::For(each) = &stmt.kind {
                self.drop_declared(&each.init);
            }
            flow::blocks(stmt).for_each(|inner| self.drop_declared(inner));
        }
    }

    fn drop_local(&mut self, id: LocalId) {
        let Some(place) = self.locals.get(&id).copied() else { return };
        let ty = self.local_type(id);
        match (place.space, ty.base) {
            (Space::Boxed(at), _) => {
                self.op(Op::DropBox { at });
            }
            (_, Base::Handle(_)) => {
                self.op(Op::DropHandles { at: place.handle, count: ty.len() as u32 });
            }
            _ => {}
        }
    }
}
