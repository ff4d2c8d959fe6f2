//! Which local variables a `goto` skips the declarations of.

use super::flow;
use crate::hir::{Func, LabelId, LocalId, Stmt, StmtKind};
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
