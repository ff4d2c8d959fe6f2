//! Which local variables a `goto` skips the declarations of, and which clocks and connections end with a block.
//!
//! A local connection is closed when control leaves the block that declares it, whatever way it takes: at the end of
//! the block, before the condition of a `repeat`, by `break`, `continue`, `goto` or `return`.

use super::flow;
use crate::hir::{Func, LabelId, LocalId, Stmt, StmtKind};
use arl_lang::catalog::Base;
use arl_lang::span::Span;
use std::collections::HashMap;

/// The local variables that are visible at each label and at each jump of a function, whether control gets to their
/// declarations or not.
#[derive(Clone, Default, Debug)]
pub(crate) struct Visibility {
    at_labels: HashMap<LabelId, Vec<LocalId>>,
    /// By the position of the jump.
    at_jumps: HashMap<u32, Vec<LocalId>>,
}

impl Visibility {
    /// Of a function.
    pub(crate) fn of(func: &Func) -> Self {
        let mut found = Self::default();
        found.look(&func.body, &mut func.params.clone());
        found
    }

    /// The variables that are visible at the label, but not at the jump: the jump skips their declarations, so they get
    /// their start values.
    pub(crate) fn skipped(&self, label: LabelId, jump: Span) -> Vec<LocalId> {
        let at_label = self.at_labels.get(&label).map_or(&[][..], Vec::as_slice);
        let at_jump = self.at_jumps.get(&jump.start).map_or(&[][..], Vec::as_slice);
        at_label.iter().filter(|id| !at_jump.contains(id)).copied().collect()
    }

    fn look(&mut self, block: &[Stmt], visible: &mut Vec<LocalId>) {
        let before = visible.len();
        for stmt in block {
            match &stmt.kind {
                StmtKind::Let(id, _) => visible.push(*id),
                StmtKind::Label(label) => {
                    self.at_labels.insert(*label, visible.clone());
                }
                StmtKind::Goto(_) => {
                    self.at_jumps.insert(stmt.span.start, visible.clone());
                }
                StmtKind::For(each) => {
                    let outside = visible.len();
                    visible.extend(each.init.iter().filter_map(|stmt| match stmt.kind {
                        StmtKind::Let(id, _) => Some(id),
                        _ => None,
                    }));
                    self.look(&each.body, visible);
                    visible.truncate(outside);
                }
                _ => flow::blocks(stmt).for_each(|inner| self.look(inner, visible)),
            }
        }
        visible.truncate(before);
    }
}

/// The clocks and connections that a block declares, or one inside it.
pub(crate) fn handles(block: &[Stmt], func: Option<&Func>) -> Vec<LocalId> {
    let mut found = Vec::new();
    for stmt in block {
        match &stmt.kind {
            StmtKind::Let(id, _) => found.extend(is_handle(*id, func).then_some(*id)),
            _ => flow::blocks(stmt).for_each(|inner| found.extend(handles(inner, func))),
        }
    }
    found
}

/// The clocks and connections of a function that end before a place where only these variables are visible.
pub(crate) fn ended_handles(func: Option<&Func>, visible: &[LocalId]) -> Vec<LocalId> {
    let all = func.map_or(&[][..], |func| &func.body);
    handles(all, func).into_iter().filter(|id| !visible.contains(id)).collect()
}

fn is_handle(id: LocalId, func: Option<&Func>) -> bool {
    let local = func.and_then(|func| func.locals.get(id.0 as usize));
    local.is_some_and(|local| matches!(local.ty.base, Base::Handle(_)))
}
