//! Facts about a program as a whole: which system variables it writes, and what its functions may change.

use super::super::first_motion::GlobalPoints;
use super::constants::{ConstantScope, argument};
use super::state::{Change, Changes, MotionState};
use crate::hir::{Builtin, Expr, ExprKind, FuncId, Passed, Place, Program, Root, Stmt};
use crate::visit;
use arl_lang::catalog::{Effect, Role};

/// Facts about a program.
pub(super) struct ProgramFacts {
    /// Whether only tool and workpiece lie between poses and the flange.
    pub(super) plain_frames: bool,
    /// Whether `ptp` goes to the configuration given in its target.
    pub(super) as_taught: bool,
    /// Whether lines end in the configuration in which they start and cannot pass singular points.
    pub(super) lines_keep_cfg: bool,
    /// Whether the tool turns to the orientation of the target on arcs.
    pub(super) arcs_turn_to_targets: bool,
    /// Whether any function calls `main`.
    pub(super) main_is_called: bool,
    /// Whether lines end exactly at their targets.
    pub(super) lines_are_exact: bool,
    /// Whether the program writes points of data files while it runs.
    pub(super) teaches: bool,
    /// What each function may change, including all functions that it calls.
    pub(super) functions: Vec<Changes>,
    /// What all functions together may change.
    pub(super) everywhere: Changes,
    /// What may change at any time, because an event may change it.
    pub(super) anytime: Changes,
}

impl ProgramFacts {
    pub(super) fn of(program: &Program) -> Self {
        let mut facts = ProgramFacts {
            plain_frames: true,
            as_taught: true,
            lines_keep_cfg: true,
            arcs_turn_to_targets: true,
            main_is_called: false,
            lines_are_exact: true,
            teaches: false,
            functions: Vec::with_capacity(program.funcs.len()),
            everywhere: Changes::default(),
            anytime: Changes::default(),
        };
        let mut callers: Vec<Vec<usize>> = vec![Vec::new(); program.funcs.len()];
        let mut in_arguments: Vec<FuncId> = Vec::new();
        for (at, func) in program.funcs.iter().enumerate() {
            let scope = ConstantScope { program, func, globals: GlobalPoints::Constant };
            let mut changes = Changes::default();
            each_expr(&func.body, &mut |expr| {
                facts.see(expr);
                changes.and(&direct(scope, expr));
                match &expr.kind {
                    ExprKind::Call(id, _) => {
                        callers.get_mut(id.0 as usize).into_iter().for_each(|callers| callers.push(at));
                    }
                    ExprKind::Builtin(builtin) => in_values(builtin, &mut |inner| {
                        facts.anytime.and(&direct(scope, inner));
                        if let ExprKind::Call(id, _) = inner.kind {
                            in_arguments.push(id);
                        }
                    }),
                    _ => {}
                }
            });
            facts.everywhere.and(&changes);
            facts.functions.push(changes);
        }
        let main = program.main.and_then(|main| callers.get(main.0 as usize));
        facts.main_is_called = main.is_some_and(|callers| !callers.is_empty());
        facts.spread(&callers);
        for id in in_arguments {
            let changes = facts.of_function(id);
            facts.anytime.and(&changes);
        }
        facts
    }

    /// What a call may change.
    pub(super) fn of_function(&self, id: FuncId) -> Changes {
        self.functions.get(id.0 as usize).copied().unwrap_or_default()
    }

    /// What an expression may change, including calls.
    pub(super) fn of_expr(&self, scope: ConstantScope<'_>, expr: &Expr) -> Changes {
        let mut changes = Changes::default();
        visit::exprs(expr, &mut |expr| changes.and(&self.of_one(scope, expr)));
        changes
    }

    /// What statements may change, including calls.
    pub(super) fn of_block(&self, scope: ConstantScope<'_>, block: &[Stmt]) -> Changes {
        let mut changes = Changes::default();
        each_expr(block, &mut |expr| changes.and(&self.of_one(scope, expr)));
        changes
    }

    /// What an expression itself may change, without its parts.
    pub(super) fn of_one(&self, scope: ConstantScope<'_>, expr: &Expr) -> Changes {
        match expr.kind {
            ExprKind::Call(id, _) => self.of_function(id),
            _ => direct(scope, expr),
        }
    }

    /// Adds to each caller the changes made by the functions that it calls.
    fn spread(&mut self, callers: &[Vec<usize>]) {
        let mut open: Vec<usize> = (0..self.functions.len()).collect();
        while let Some(at) = open.pop() {
            let Some(changes) = self.functions.get(at).copied() else { continue };
            for caller in callers.get(at).into_iter().flatten() {
                let Some(known) = self.functions.get_mut(*caller) else { continue };
                let before = *known;
                known.and(&changes);
                if *known != before {
                    open.push(*caller);
                }
            }
        }
    }

    /// Records that a variable with this role is changed.
    fn changed(&mut self, role: Role) {
        match role {
            Role::Frame => self.plain_frames = false,
            Role::ConfigurationCheck => self.as_taught = false,
            Role::WristPassage => self.lines_keep_cfg = false,
            Role::ArcOrientation => self.arcs_turn_to_targets = false,
            Role::Compensation => self.lines_are_exact = false,
            // Their values are tracked along the statements.
            Role::DefaultTool | Role::DefaultWorkpiece => {}
            // They are read-only.
            Role::Flange | Role::World => {}
        }
    }

    fn see(&mut self, expr: &Expr) {
        let mut written = |place: &Place| {
            let Root::System(variable) = place.root else { return };
            variable.role.into_iter().for_each(|role| self.changed(role));
        };
        match &expr.kind {
            ExprKind::Assign(both) => written(&both.0),
            ExprKind::AssignOp(_, both) => written(&both.0),
            ExprKind::Step(_, place) => written(place),
            ExprKind::Builtin(builtin) => {
                outs(builtin).for_each(written);
                self.teaches |= builtin.entry.teaches;
                builtin.entry.changes.into_iter().for_each(|role| self.changed(role));
            }
            _ => {}
        }
    }
}

/// What one expression itself may change, without its parts and without the functions that it calls.
fn direct(scope: ConstantScope<'_>, expr: &Expr) -> Changes {
    let mut changes = Changes::default();
    // Records a write to a part of the variable, or to the whole variable with the given `value`.
    let mut write = |place: &Place, value: Option<&Expr>| {
        let Root::System(variable) = place.root else { return };
        let change = || Change::from(value.and_then(|value| scope.mount(value, &MotionState::UNKNOWN)));
        match variable.role {
            Some(Role::DefaultTool) => changes.tool.and(change()),
            Some(Role::DefaultWorkpiece) => changes.wobj.and(change()),
            _ => {}
        }
    };
    match &expr.kind {
        ExprKind::Assign(both) => write(&both.0, Some(&both.1).filter(|_| both.0.path.is_empty())),
        ExprKind::AssignOp(_, both) => write(&both.0, None),
        ExprKind::Step(_, place) => write(place, None),
        ExprKind::Builtin(builtin) => {
            outs(builtin).for_each(|place| write(place, None));
            if builtin.entry.effect == Effect::Plans {
                let given = |label| argument(builtin, label).map(|value| scope.mount(value, &MotionState::UNKNOWN));
                changes.moves = true;
                changes.tool.and(given("t").map_or(Change::Never, Change::from));
                changes.wobj.and(given("w").map_or(Change::Never, Change::from));
            }
        }
        _ => {}
    }
    changes
}

fn outs(builtin: &Builtin) -> impl Iterator<Item = &Place> {
    builtin.args.iter().filter_map(|bound| match &bound.value {
        Passed::Out(place) => Some(place),
        Passed::Value(_) => None,
    })
}

fn in_values<'a>(builtin: &'a Builtin, see: &mut impl FnMut(&'a Expr)) {
    for bound in &builtin.args {
        if let Passed::Value(value) = &bound.value {
            visit::exprs(value, see);
        }
    }
}

fn each_expr<'a>(block: &'a [Stmt], see: &mut impl FnMut(&'a Expr)) {
    block.iter().for_each(|stmt| visit::exprs_in_stmt(stmt, see));
}
