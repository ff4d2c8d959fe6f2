//! The first motion of a program has no start whose components an incomplete target could keep.

use crate::diagnostics::flow::FlowProblem;
use crate::diagnostics::{Diagnostic, Location, Problem};
use crate::hir::{Builtin, Expr, ExprKind, Func, ModuleId, Passed, Program, Root, Stmt, StmtKind};
use crate::visit;
use arl_lang::catalog::{Effect, Struct};
use arl_lang::span::Span;

/// Reports a first motion whose target is known to be incomplete. Targets that are not known are left to run time.
pub(crate) fn check(program: &Program, locate: &dyn Fn(ModuleId, Span) -> Location) -> Option<Diagnostic> {
    let main = program.funcs.get(program.main?.0 as usize)?;
    for stmt in &main.body {
        if let StmtKind::Eval(Expr { kind: ExprKind::Builtin(builtin), span, .. }) = &stmt.kind
            && builtin.entry.effect == Effect::Plans
        {
            let missing = missing(program, main, builtin)?;
            let instruction = builtin.entry.name.to_string();
            return Some(FlowProblem::FirstMotion { instruction, missing }.at(locate(main.module, *span)));
        }
        if may_move(stmt) {
            return None;
        }
    }
    None
}

/// Whether a statement may contain the first motion or jump to it.
fn may_move(stmt: &Stmt) -> bool {
    let mut found = false;
    super::flow::each_stmt(stmt, &mut |stmt| {
        found |= matches!(stmt.kind, StmtKind::Label(_) | StmtKind::Goto(_) | StmtKind::Return(_));
    });
    visit::exprs_in_stmt(stmt, &mut |expr| {
        found |= match &expr.kind {
            ExprKind::Call(..) => true,
            ExprKind::Builtin(builtin) => matches!(builtin.entry.effect, Effect::Plans | Effect::Ends),
            _ => false,
        };
    });
    found
}

/// The components of the target that are not set, if the target is known.
fn missing(program: &Program, main: &Func, motion: &Builtin) -> Option<String> {
    let target = motion.args.iter().find(|bound| bound.param == 0)?;
    let Passed::Value(target) = &target.value else { return None };
    let (id, values) = known_structure(program, main, GlobalPoints::Constant, target)?;
    let needed: &[&str] = match id {
        Struct::Joint => &["j1", "j2", "j3", "j4", "j5", "j6"],
        Struct::Pose => &["x", "y", "z", "a", "b", "c"],
        _ => return None,
    };
    let components = id.def(program.family).components.iter().enumerate();
    let open: Vec<&str> = components
        .filter(|(at, component)| needed.contains(&component.name) && !matches!(values.get(*at), Some(Some(_))))
        .map(|(_, component)| component.name)
        .collect();
    (!open.is_empty()).then(|| open.join(", "))
}

/// Which global variables count as known.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(
    not(feature = "tools"),
    expect(dead_code, reason = "only the command and editors know robots and their targets")
)]
pub(super) enum GlobalPoints {
    /// Constants whose value does not come from a data file.
    Constant,
    /// All variables that no statement writes, except those of data files: the program teaches them while it runs.
    Unwritten,
    /// All variables that no statement writes, with the values that data files have now.
    AsTaught,
}

/// The braces that give the target: written here, or assigned to a variable that is never changed.
pub(super) fn known_structure<'a>(
    program: &'a Program,
    func: &'a Func,
    globals: GlobalPoints,
    target: &'a Expr,
) -> Option<(Struct, &'a [Option<Expr>])> {
    match &known_value(program, func, globals, target)?.kind {
        ExprKind::Struct(id, values) => Some((*id, values)),
        _ => None,
    }
}

/// The expression written here, or assigned to a variable that is never changed.
pub(super) fn known_value<'a>(
    program: &'a Program,
    func: &'a Func,
    globals: GlobalPoints,
    value: &'a Expr,
) -> Option<&'a Expr> {
    let ExprKind::Place(place) = &value.kind else { return Some(value) };
    if !place.path.is_empty() {
        return None;
    }
    match place.root {
        Root::Local(id) if !func.locals.get(id.0 as usize)?.mutated => {
            func.body.iter().find_map(|stmt| match &stmt.kind {
                StmtKind::Let(local, init) if *local == id => init.as_ref(),
                _ => None,
            })
        }
        Root::Global(id) => {
            let global = program.globals.get(id.0 as usize)?;
            // A data file may set it on load.
            let data = program.modules.get(global.module.0 as usize)?.data;
            let known = match globals {
                GlobalPoints::Constant => global.constant && !data,
                GlobalPoints::Unwritten => !global.mutated && !data,
                GlobalPoints::AsTaught => !global.mutated,
            };
            global.init.as_ref().filter(|_| known)
        }
        _ => None,
    }
}
