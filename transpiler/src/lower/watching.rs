//! What code for a debugger has besides: halts before statements, and the variables that are seen.
//!
//! A variable has a place of its own in the frame of its function, so that one whose declaration was jumped over is
//! known by an empty place.

use super::body::FunctionCode;
use super::tables::value_type;
use crate::effects::flow;
use crate::hir::{LocalId, Stmt, StmtKind};
use arl_code::{Address, Local, Op, Space};
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

    /// The end of a block, in code for a debugger: the variables that it declares do not exist outside.
    pub(super) fn drop_declared(&mut self, block: &[Stmt]) {
        if !self.drops() {
            return;
        }
        for stmt in block {
            if let StmtKind::Let(id, _) = &stmt.kind {
                self.drop_local(*id);
            }
        }
    }

    /// Leads jumps out of a round of a loop here: in all blocks that they may come from the variables end.
    pub(super) fn land(&mut self, jumps: Vec<Address>, round: &[Stmt]) {
        let is_used = !jumps.is_empty();
        self.lead_here(jumps);
        if is_used && self.drops() {
            self.drop_round(round);
        }
    }

    /// Loops inside a round have ended their variables.
    fn drop_round(&mut self, block: &[Stmt]) {
        self.drop_declared(block);
        for stmt in block {
            if matches!(stmt.kind, StmtKind::If(..) | StmtKind::Switch(..)) {
                flow::blocks(stmt).for_each(|inner| self.drop_round(inner));
            }
        }
    }

    /// Whether variables end with their blocks: not in a function with `goto`.
    fn drops(&self) -> bool {
        self.is_watched() && !self.func.is_some_and(|func| func.has_goto)
    }

    pub(super) fn drop_local(&mut self, id: LocalId) {
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

#[cfg(test)]
mod tests {
    use crate::lower::lower_watched;
    use crate::{CheckOptions, SourceError, Sources, check};
    use arl_code::Op;
    use std::path::Path;

    struct Text(String);

    impl Sources for Text {
        fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
            if path == Path::new("t.arl") { Ok(self.0.clone().into_bytes()) } else { Err(SourceError::Missing) }
        }
    }

    /// How many operations end variables, in a loop with blocks so deep in each other.
    fn drops(depth: usize) -> usize {
        let (open, close) = ("if(true)\nint a = 1\nprint a\n".repeat(depth), "endif\n".repeat(depth));
        let text = format!("func void main()\nwhile(true)\n{open}break\n{close}endwhile\nendfunc\n");
        let mut checked = check(Path::new("t.arl"), &Text(text), &CheckOptions::default());
        let code = lower_watched(checked.program.as_mut().expect("correct")).expect("small");
        code.ops.iter().filter(|op| matches!(op, Op::DropBox { .. })).count()
    }

    #[test]
    fn ends_of_variables_grow_with_the_program_alone() {
        let (few, many) = (drops(5), drops(50));
        // Ten times as deep: as many for each level, not a hundred times as many.
        assert!(few >= 5 && many < 20 * few, "{few}, {many}");
    }
}
