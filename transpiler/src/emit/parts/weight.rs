//! Counts the `.await`s in the code of statements.

use super::plan::{BlockPiece, plan, weight_of};
use crate::effects::captures;
use crate::effects::flow;
use crate::effects::parts::children;
use crate::emit::body::Body;
use crate::emit::rows::Group;
use crate::hir::{Expr, ExprKind, For, Func, Passed, Stmt, StmtKind};
use arl_lang::catalog::Form;
use std::collections::{HashMap, HashSet};

/// The weights of a function's statements.
#[derive(Default, Debug)]
pub(in crate::emit) struct Weights {
    of: HashMap<*const Stmt, usize>,
    /// Whether any block of the function has parts.
    pub(in crate::emit) cut: bool,
}

impl<'p> Body<'p, '_> {
    /// The weights of all statements of a function that waits.
    pub(in crate::emit) fn weigh(&self, func: &'p Func) -> Weights {
        let mut weights = Weights::default();
        if func.effects.waits {
            self.block_weight(&func.body, &mut weights);
        }
        weights
    }

    /// The weight of a block whose statements are split into parts if there are many.
    fn block_weight(&self, block: &'p [Stmt], weights: &mut Weights) -> usize {
        let groups = self.groups(flow::reachable(block));
        let of_groups: Vec<usize> = groups.iter().map(|group| self.weigh_group(group, weights)).collect();
        let pieces = self.planned(&groups, &of_groups);
        weights.cut |= pieces.iter().any(|piece| matches!(piece, BlockPiece::Part(_)));
        weight_of(&pieces, &of_groups)
    }

    /// The pieces of a block.
    pub(super) fn planned(&self, groups: &[Group<'p>], weights: &[usize]) -> Vec<BlockPiece> {
        let stays = groups.last().is_some_and(|group| matches!(group, Group::Alone(stmt) if flow::diverges(stmt)));
        plan(weights, stays, self.unit.sizes)
    }

    fn weigh_group(&self, group: &Group<'p>, weights: &mut Weights) -> usize {
        match group {
            Group::Alone(stmt) => {
                let weight = self.statement_weight(stmt, weights);
                weights.of.insert(std::ptr::from_ref(*stmt), weight);
                weight
            }
            Group::Table(rows) => {
                let mut seen = HashSet::new();
                let kinds = rows.iter().filter(|row| seen.insert(&row.shape));
                let weight = kinds.map(|row| self.expression_weight(row.expr)).sum();
                weights.of.extend(rows.first().map(|row| (std::ptr::from_ref(row.stmt), weight)));
                weight
            }
        }
    }

    /// The weight of a group that has been weighed already.
    pub(super) fn group_weight(&self, group: &Group<'p>) -> usize {
        let first = match group {
            Group::Alone(stmt) => Some(*stmt),
            Group::Table(rows) => rows.first().map(|row| row.stmt),
        };
        first.and_then(|stmt| self.flow.weights.of.get(&std::ptr::from_ref(stmt))).copied().unwrap_or(0)
    }

    fn statement_weight(&self, stmt: &'p Stmt, weights: &mut Weights) -> usize {
        let gives_back = match &stmt.kind {
            StmtKind::While(_, _, info) | StmtKind::Repeat(_, _, info) | StmtKind::Loop(_, info) => info.spends,
            StmtKind::For(each) => each.info.spends,
            StmtKind::Goto(_) => true,
            _ => false,
        };
        let own: usize = flow::expressions(stmt).map(|expr| self.expression_weight(expr)).sum();
        let inside: usize = match &stmt.kind {
            // Its declarations are not a block.
            StmtKind::For(each) => self.for_weight(each, weights),
            _ => flow::blocks(stmt).map(|block| self.block_weight(block, weights)).sum(),
        };
        usize::from(gives_back) + own + inside
    }

    fn for_weight(&self, each: &'p For, weights: &mut Weights) -> usize {
        let init: usize = each.init.iter().map(|stmt| self.statement_weight(stmt, weights)).sum();
        init + self.block_weight(&each.body, weights)
    }

    fn expression_weight(&self, expr: &Expr) -> usize {
        if let (ExprKind::Builtin(builtin), true) = (&expr.kind, self.unit.templates.have(expr)) {
            return usize::from(builtin.entry.effect.takes_time());
        }
        let own = match &expr.kind {
            ExprKind::Builtin(builtin) if builtin.entry.effect.takes_time() => match builtin.entry.form {
                Form::WaitUntil | Form::Jump => 2,
                _ => 1,
            },
            ExprKind::Call(id, _) => {
                usize::from(self.program().funcs.get(id.0 as usize).is_some_and(|func| func.effects.waits))
            }
            _ => 0,
        };
        let inside: usize = match &expr.kind {
            // What an event does later is a separate body.
            ExprKind::Builtin(builtin) if builtin.entry.form == Form::Event => {
                let now = builtin.args.iter().filter(|arg| !captures::is_later(builtin.entry, arg));
                let values = now.filter_map(|arg| match &arg.value {
                    Passed::Value(value) => Some(value),
                    Passed::Out(_) => None,
                });
                values.map(|value| self.expression_weight(value)).sum()
            }
            _ => children(expr).into_iter().map(|child| self.expression_weight(child)).sum(),
        };
        own + inside
    }
}
