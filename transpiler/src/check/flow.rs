//! Warnings about control flow in a function: unreachable code, missing results, unused names.

use super::context::Checker;
use crate::diagnostics::flow::FlowProblem;
use crate::hir::{Block, Expr, ExprKind, Func, Stmt, StmtKind, Value};
use arl_lang::catalog::{Base, Effect};
use std::collections::HashSet;

impl Checker<'_> {
    /// Warns about suspicious code in a checked function.
    pub(crate) fn check_flow(&mut self, func: &Func) {
        let mut flow = Flow { labels: targets(func), unreachable: Vec::new() };
        let falls_out = flow.block(&func.body);
        for stmt in flow.unreachable {
            self.report_in::<()>(func.module, stmt, FlowProblem::Unreachable, &[]);
        }
        if falls_out && func.result != Base::Void {
            let result = self.base_name(func.result).to_string();
            let problem = FlowProblem::MissingReturn { name: func.name.clone(), result };
            self.report_in::<()>(func.module, func.end, problem, &[]);
        }
        for local in func.locals.iter().skip(func.params.len()) {
            if !local.read && !local.name.starts_with('_') {
                let name = self.text(func.module, local.span).to_string();
                self.report_in::<()>(func.module, local.span, FlowProblem::UnusedVariable { name }, &[]);
            }
        }
        for label in &func.labels {
            if !label.used {
                let name = self.text(func.module, label.span).to_string();
                self.report_in::<()>(func.module, label.span, FlowProblem::UnusedLabel { name }, &[]);
            }
        }
    }
}

/// The labels that some goto names.
fn targets(func: &Func) -> HashSet<u32> {
    func.labels.iter().enumerate().filter(|(_, label)| label.used).map(|(at, _)| at as u32).collect()
}

struct Flow {
    labels: HashSet<u32>,
    unreachable: Vec<arl_lang::span::Span>,
}

impl Flow {
    /// Whether control can reach the end of the block.
    fn block(&mut self, block: &Block) -> bool {
        let mut reached = true;
        let mut reported = false;
        for stmt in block {
            if let StmtKind::Label(label) = &stmt.kind {
                reached |= self.labels.contains(&label.0);
                continue;
            }
            if !reached && !self.contains_target(stmt) {
                if !std::mem::replace(&mut reported, true) {
                    self.unreachable.push(stmt.span);
                }
                continue;
            }
            reported = false;
            reached = self.stmt(stmt);
        }
        reached
    }

    fn stmt(&mut self, stmt: &Stmt) -> bool {
        match &stmt.kind {
            StmtKind::Break | StmtKind::Continue | StmtKind::Goto(_) | StmtKind::Return(_) => false,
            StmtKind::Eval(expr) => !ends(expr),
            StmtKind::Let(..) | StmtKind::Label(_) => true,
            StmtKind::If(arms, otherwise) => {
                let mut falls = otherwise.is_none();
                for (_, block) in arms {
                    falls |= self.block(block);
                }
                if let Some(block) = otherwise {
                    falls |= self.block(block);
                }
                falls
            }
            StmtKind::While(condition, block, _) => {
                self.block(block);
                !is_true(condition) || breaks(block)
            }
            StmtKind::Loop(block, _) => {
                self.block(block);
                breaks(block)
            }
            StmtKind::Repeat(block, until, _) => {
                let comes_round = self.block(block) || continues(block);
                breaks(block) || (comes_round && !is_false(until))
            }
            StmtKind::For(each) => {
                self.block(&each.body);
                each.condition.as_ref().is_some_and(|condition| !is_true(condition)) || breaks(&each.body)
            }
            StmtKind::Switch(_, arms) => {
                let mut falls = arms.iter().all(|arm| arm.value.is_some());
                for arm in arms {
                    falls |= self.block(&arm.body);
                }
                falls
            }
        }
    }

    /// Whether a goto leads into the statement.
    fn contains_target(&self, stmt: &Stmt) -> bool {
        let mut found = false;
        each_stmt(stmt, &mut |stmt| {
            found |= matches!(&stmt.kind, StmtKind::Label(label) if self.labels.contains(&label.0));
        });
        found
    }
}

fn is_true(expr: &Expr) -> bool {
    matches!(expr.kind, ExprKind::Const(Value::Bool(true)))
}

fn is_false(expr: &Expr) -> bool {
    matches!(expr.kind, ExprKind::Const(Value::Bool(false)))
}

/// `exit` and `restart`.
fn ends(expr: &Expr) -> bool {
    matches!(&expr.kind, ExprKind::Builtin(builtin) if builtin.entry.effect == Effect::Ends)
}

/// Whether the body contains a `break` of this loop.
fn breaks(block: &Block) -> bool {
    leaves(block, &|stmt| matches!(stmt.kind, StmtKind::Break))
}

fn continues(block: &Block) -> bool {
    leaves(block, &|stmt| matches!(stmt.kind, StmtKind::Continue))
}

/// Whether this loop (not an inner one) contains a wanted statement; a goto may leave from anywhere.
fn leaves(block: &Block, wanted: &dyn Fn(&Stmt) -> bool) -> bool {
    block.iter().any(|stmt| {
        wanted(stmt)
            || match &stmt.kind {
                StmtKind::If(arms, otherwise) => {
                    arms.iter().any(|(_, block)| leaves(block, wanted))
                        || otherwise.as_ref().is_some_and(|block| leaves(block, wanted))
                }
                StmtKind::Switch(_, arms) => arms.iter().any(|arm| leaves(&arm.body, wanted)),
                _ => false,
            }
    })
}

/// Calls `visit` for the statement and for all statements in it.
pub(crate) fn each_stmt(stmt: &Stmt, visit: &mut dyn FnMut(&Stmt)) {
    visit(stmt);
    let mut each = |block: &Block| block.iter().for_each(|stmt| each_stmt(stmt, visit));
    match &stmt.kind {
        StmtKind::If(arms, otherwise) => {
            arms.iter().for_each(|(_, block)| each(block));
            otherwise.iter().for_each(each);
        }
        StmtKind::While(_, block, _) | StmtKind::Repeat(block, _, _) | StmtKind::Loop(block, _) => each(block),
        StmtKind::For(inner) => {
            each(&inner.init);
            each(&inner.body);
        }
        StmtKind::Switch(_, arms) => arms.iter().for_each(|arm| each(&arm.body)),
        _ => {}
    }
}
