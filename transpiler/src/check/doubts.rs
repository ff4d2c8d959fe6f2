//! Warnings about code that is allowed but most often not meant.

use super::context::{CheckedBody, Checker};
use super::convert::number;
use super::first_motion::{GlobalPoints, known_structure};
use crate::diagnostics::doubts::Doubt;
use crate::diagnostics::{Diagnostic, Label, Location, Problem};
use crate::effects::flow::blocks;
use crate::hir::{Builtin, Expr, ExprKind, Func, FuncId, ModuleId, Passed, Program, Stmt, StmtKind};
use crate::visit;
use arl_lang::ast::{self, BinaryOp, UnaryOp};
use arl_lang::catalog::{Base, Effect, Entry, Family, Form, Mode, Struct};
use arl_lang::span::Span;
use arl_lang::symbol::Symbol;
use std::collections::HashSet;

impl Checker<'_> {
    /// Warns about an assignment used as a condition.
    pub(crate) fn doubt_condition(&mut self, body: &CheckedBody, condition: &ast::Expr) {
        match &condition.kind {
            ast::ExprKind::Assign(None, _) => {
                self.report::<()>(body, condition.span, Doubt::AssignedCondition);
            }
            ast::ExprKind::Unary(UnaryOp::Not, inner) => self.doubt_condition(body, inner),
            ast::ExprKind::Binary(BinaryOp::And | BinaryOp::Or, both) => {
                self.doubt_condition(body, &both.0);
                self.doubt_condition(body, &both.1);
            }
            _ => {}
        }
    }
}

impl Checker<'_> {
    /// Warns about a local variable that hides another one whose name differs only in case: the author probably took
    /// them for two different names.
    pub(crate) fn doubt_hidden(&mut self, body: &CheckedBody, name: ast::Ident) {
        let (module, outside, what) = match body.find(name.symbol).and_then(|local| body.locals.get(local.0 as usize)) {
            Some(local) => (body.module, local.span, if local.constant { "constant" } else { "variable" }),
            None => {
                let Some((id, _)) = self.find_global(body, name.symbol) else { return };
                let Some(slot) = self.globals.get(id.0 as usize) else { return };
                let what = if slot.decl.constant.is_some() { "constant" } else { "variable" };
                (slot.module, slot.var.name.span, what)
            }
        };
        let (own, hidden) = (self.text(body.module, name.span).to_string(), self.text(module, outside).to_string());
        if own != hidden && own.eq_ignore_ascii_case(&hidden) {
            let labels = [(module, outside, "this one is hidden")];
            let problem = Doubt::HiddenByCase { name: own, hidden, what };
            self.report_in::<()>(body.module, name.span, problem, &labels);
        }
    }

    /// Whether a name is spelled like the declaration of a global variable that a local one hides. The global was then
    /// meant.
    pub(crate) fn means_hidden(&self, body: &CheckedBody, symbol: Symbol, span: Span) -> bool {
        let global = self.find_global(body, symbol).and_then(|(id, _)| self.globals.get(id.0 as usize));
        global.is_some_and(|slot| self.text(slot.module, slot.var.name.span) == self.text(body.module, span))
    }

    /// Warns about a bare number that is much too small in the unit of a parameter and probably meant in another unit.
    pub(crate) fn doubt_scale(&mut self, body: &CheckedBody, parameter: &str, units: &[ast::Unit], value: &Expr) {
        let Some(scale) = SCALES.iter().find(|scale| units.contains(&scale.unit)) else { return };
        let Some(number) = number(value) else { return };
        if let Some(doubt) = scale.doubt(parameter, number) {
            self.report::<()>(body, value.span, doubt);
        }
    }
}

/// A unit in which small fractions are most often numbers in another unit.
struct Scale {
    unit: ast::Unit,
    /// Fractions below this number cause a warning.
    most: f64,
    found: &'static str,
    wanted: &'static str,
    /// The factor that converts such a number to ARL's unit.
    factor: f64,
    written: &'static str,
}

const SCALES: [Scale; 3] = [
    Scale {
        unit: ast::Unit::MillimetrePerSecond,
        most: 2.0,
        found: "m/s",
        wanted: "mm/s",
        factor: 1000.0,
        written: "mm/s",
    },
    Scale { unit: ast::Unit::Percent, most: 1.0, found: "a fraction", wanted: "%", factor: 100.0, written: "%" },
    Scale { unit: ast::Unit::Millimetre, most: 0.1, found: "metres", wanted: "mm", factor: 1000.0, written: "mm" },
];

impl Scale {
    fn doubt(&self, name: &str, number: f64) -> Option<Doubt> {
        let looks = number > 0.0 && number < self.most && number.fract() != 0.0;
        let meant = (number * self.factor * 1000.0).round() / 1000.0;
        let (found, wanted, unit) = (self.found, self.wanted, self.written);
        let right =
            format!("`{meant}{unit}` if that is meant, else `{number}{unit}`: with its unit there is no warning");
        looks.then(|| Doubt::OtherScale { name: name.into(), value: number.to_string(), found, wanted, right })
    }
}

/// Whether an expression is a comparison.
pub(crate) fn is_comparison(expr: &ast::Expr) -> bool {
    use BinaryOp::{Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};
    let ast::ExprKind::Binary(op, _) = &expr.kind else { return false };
    matches!(op, Equal | NotEqual | Less | LessEqual | Greater | GreaterEqual)
}

/// The unit that a constant target is probably given in, if it is not ARL's.
fn other_unit(family: Family, id: Struct, values: &[Option<Expr>]) -> Option<Doubt> {
    let components = id.def(family).components.iter();
    let given = |names: &[&str]| -> Option<Vec<f64>> {
        let given = components.clone().zip(values).filter(|(component, _)| names.contains(&component.name));
        given.filter_map(|(_, value)| value.as_ref()).map(number).collect()
    };
    let structure = id.def(family).name;
    match id {
        // The third axis of a SCARA is linear.
        Struct::Joint if family == Family::SixAxis => {
            let axes = given(&["j1", "j2", "j3", "j4", "j5", "j6"])?;
            let (found, wanted) = ("radians", "degrees");
            let most = fractions_below(&axes, std::f64::consts::TAU, 1.0, 3)?;
            let example = format!("{most} rad are {:.1} deg", most.to_degrees());
            Some(Doubt::OtherUnit { structure, found, wanted, example })
        }
        Struct::Pose => {
            let place = given(&["x", "y", "z"])?;
            let (found, wanted) = ("metres", "mm");
            let most = fractions_below(&place, 3.0, 0.05, 2)?;
            let example = format!("{most} m are {} mm", (most * 1e6).round() / 1e3);
            Some(Doubt::OtherUnit { structure, found, wanted, example })
        }
        _ => None,
    }
}

/// Reports each motion target whose numbers are probably in another unit, at its first use.
fn other_units(program: &Program, tell: &mut dyn FnMut(&Func, Span, Doubt)) {
    let mut seen = HashSet::new();
    for func in &program.funcs {
        let mut look = |expr: &Expr| {
            let ExprKind::Builtin(motion) = &expr.kind else { return };
            if motion.entry.effect != Effect::Plans {
                return;
            }
            for bound in &motion.args {
                let Passed::Value(target) = &bound.value else { continue };
                if let Some((id, values)) = known_structure(program, func, GlobalPoints::AsTaught, target)
                    && seen.insert(values.as_ptr())
                    && let Some(doubt) = other_unit(program.family, id, values)
                {
                    tell(func, target.span, doubt);
                }
            }
        };
        func.body.iter().for_each(|stmt| visit::exprs_in_stmt(stmt, &mut look));
    }
}

/// The largest of the numbers, provided that all are fractions up to `most` (or 0), at least `count` are fractions, and
/// one of them is at least `least`.
fn fractions_below(numbers: &[f64], most: f64, least: f64, count: usize) -> Option<f64> {
    let fractions = numbers.iter().filter(|number| number.fract() != 0.0).count();
    let others = numbers.iter().any(|number| number.abs() > most || (number.fract() == 0.0 && *number != 0.0));
    let largest = numbers.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
    (fractions >= count && !others && largest.abs() >= least).then_some(largest)
}

/// Reports problems visible only in finished functions: zones that never take effect, loops that only poll, handlers
/// that may wait for ever.
pub(crate) fn check(program: &Program, locate: &dyn Fn(ModuleId, Span) -> Location) -> Vec<Diagnostic> {
    let mut out = Vec::new();
    for (at, func) in program.funcs.iter().enumerate() {
        let is_main = program.main == Some(FuncId(at as u32));
        idle_zones(&func.body, is_main, &mut |zone, culprit, waits| {
            let mut found = Doubt::IdleZone { culprit }.at(locate(func.module, zone));
            found.labels.push(Label { at: locate(func.module, waits), text: "it waits here".into() });
            out.push(found);
        });
    }
    for func in &program.funcs {
        breaks_of_cases(&func.body, &mut |span| out.push(Doubt::BreakOfCase.at(locate(func.module, span))));
    }
    other_units(program, &mut |func, span, doubt| out.push(doubt.at(locate(func.module, span))));
    for func in &program.funcs {
        let source = program.modules.get(func.module.0 as usize).map_or("", |module| module.source.as_str());
        polls(source, &func.body, &mut |span, condition| {
            out.push(Doubt::Polls { condition }.at(locate(func.module, span)));
        });
    }
    endless_handlers(program, &mut |func, span, handler| {
        out.push(Doubt::EndlessHandler { handler }.at(locate(func.module, span)));
    });
    nothing_ends(program, &mut |func, span, doubt| out.push(doubt.at(locate(func.module, span))));
    out
}

/// Reports each beginning of a change of motions that nothing in the program ends. A file without `main` is a part of
/// a program that is not known here.
fn nothing_ends(program: &Program, tell: &mut dyn FnMut(&Func, Span, Doubt)) {
    if program.main.is_none() {
        return;
    }
    let mut begun = Vec::new();
    let mut called = HashSet::new();
    for func in &program.funcs {
        let mut look = |expr: &Expr| {
            let ExprKind::Builtin(builtin) = &expr.kind else { return };
            let entry = builtin.entry;
            called.insert(entry.name);
            begun.extend(entry.ended_by.map(|ends| (func, expr.span, entry.name, ends)));
        };
        func.body.iter().for_each(|stmt| visit::exprs_in_stmt(stmt, &mut look));
    }
    for (func, span, begins, ends) in begun {
        if !called.contains(ends) {
            tell(func, span, Doubt::NothingEnds { begins, ends });
        }
    }
}

/// What a statement means for a zone before it.
enum Step {
    /// A motion, and its own zone if it has one.
    Motion(Option<Zone>),
    /// The robot stops for it.
    Waits(&'static str),
    /// The robot keeps moving.
    Passes,
    /// Depends on the circumstances.
    Unknown,
}

/// The zone given in a motion itself.
struct Zone {
    span: Span,
    /// Whether it is a constant above 0.
    acts: bool,
}

/// Goes through the statements of a block and of the blocks in them.
fn idle_zones(block: &[Stmt], is_main: bool, tell: &mut dyn FnMut(Span, &'static str, Span)) {
    for (at, stmt) in block.iter().enumerate() {
        if let Step::Motion(Some(zone @ Zone { acts: true, .. })) = step(stmt)
            && let Some((culprit, waits)) = stop_behind(block.get(at + 1..).unwrap_or_default(), is_main)
        {
            tell(zone.span, culprit, waits);
        }
        blocks(stmt).for_each(|inner| idle_zones(inner, false, tell));
    }
}

/// What stops the robot after a motion with a zone, if the zone does not apply to a later motion either.
fn stop_behind(rest: &[Stmt], is_main: bool) -> Option<(&'static str, Span)> {
    let mut stop = None;
    for stmt in rest {
        match (step(stmt), stop) {
            (Step::Waits(name), None) => stop = Some((name, stmt.span)),
            (Step::Motion(Some(_)), found) => return found,
            (Step::Motion(None), _) | (Step::Unknown, _) => return None,
            (Step::Waits(_), Some(_)) | (Step::Passes, _) => {}
        }
    }
    stop.filter(|_| is_main)
}

fn step(stmt: &Stmt) -> Step {
    if matches!(stmt.kind, StmtKind::Label(_)) || blocks(stmt).next().is_some() {
        return Step::Unknown;
    }
    if let StmtKind::Eval(Expr { kind: ExprKind::Builtin(builtin), .. }) = &stmt.kind
        && builtin.entry.effect == Effect::Plans
    {
        return Step::Motion(zone(builtin));
    }
    let mut step = match stmt.kind {
        StmtKind::Eval(_) | StmtKind::Let(..) => Step::Passes,
        _ => return Step::Unknown,
    };
    visit::exprs_in_stmt(stmt, &mut |expr| match &expr.kind {
        ExprKind::Call(..) => step = Step::Unknown,
        ExprKind::Builtin(builtin) if !matches!(step, Step::Unknown) => match builtin.entry.effect {
            Effect::Waits => step = Step::Waits(builtin.entry.name),
            Effect::Plans | Effect::Ends => step = Step::Unknown,
            Effect::Pure | Effect::Acts | Effect::Lasts => {}
        },
        _ => {}
    });
    step
}

/// The zone given in a motion itself.
fn zone(motion: &Builtin) -> Option<Zone> {
    motion.args.iter().find_map(|bound| {
        let name = motion.entry.params.get(bound.param)?.name;
        let Passed::Value(value) = &bound.value else { return None };
        let acts = name != "s" && number(value).is_some_and(|zone| zone > 0.0);
        matches!(name, "s" | "sl" | "sp").then_some(Zone { span: value.span, acts })
    })
}

/// Reports each `break` of a `switch` whose cases end with one, as in C: all cases, except perhaps the last.
fn breaks_of_cases(block: &[Stmt], tell: &mut dyn FnMut(Span)) {
    for stmt in block {
        if let StmtKind::Switch(_, arms) = &stmt.kind {
            let ends = |stmt: &&Stmt| matches!(stmt.kind, StmtKind::Break);
            let breaks: Vec<_> = arms.iter().filter_map(|arm| arm.body.last().filter(ends)).collect();
            let cases: Vec<_> = arms.iter().filter(|arm| arm.value.is_some()).collect();
            let others = cases.split_last().map_or(&[][..], |(_, others)| others);
            if breaks.len() > 1 && others.iter().all(|arm| arm.body.last().is_some_and(|last| ends(&last))) {
                breaks.iter().for_each(|found| tell(found.span));
            }
        }
        blocks(stmt).for_each(|inner| breaks_of_cases(inner, tell));
    }
}

/// Reports each loop that only polls inputs until they have the wanted state, and the condition that it waits for.
fn polls(source: &str, block: &[Stmt], tell: &mut dyn FnMut(Span, String)) {
    for stmt in block {
        let found = match &stmt.kind {
            StmtKind::While(condition, body, _) => Some((condition, body, false)),
            StmtKind::Repeat(body, condition, _) => Some((condition, body, true)),
            _ => None,
        };
        if let Some((condition, body, ends_it)) = found
            && reads_input(condition)
            && is_quiet(stmt)
            && only_looks(body)
        {
            let wanted = match &condition.kind {
                _ if ends_it => condition.span.text(source).to_string(),
                ExprKind::Unary(UnaryOp::Not, inner) => inner.span.text(source).to_string(),
                _ => format!("!({})", condition.span.text(source)),
            };
            tell(condition.span, wanted);
        }
        blocks(stmt).for_each(|inner| polls(source, inner, tell));
    }
}

/// Whether an expression looks at an input or another signal, for which the robot comes to rest.
fn reads_input(expr: &Expr) -> bool {
    let mut found = false;
    visit::exprs(expr, &mut |expr| {
        found |= matches!(&expr.kind, ExprKind::Builtin(builtin) if is_signal(builtin.entry));
    });
    found
}

/// Whether a built-in looks at a signal, for which the robot comes to rest.
fn is_signal(entry: &Entry) -> bool {
    entry.looks && entry.effect == Effect::Waits
}

/// Whether a statement only computes and looks. A built-in without a result is called for its effect.
fn is_quiet(stmt: &Stmt) -> bool {
    let mut quiet = true;
    visit::exprs_in_stmt(stmt, &mut |expr| {
        quiet &= match &expr.kind {
            ExprKind::Builtin(builtin) => {
                let entry = builtin.entry;
                let writes = builtin.args.iter().any(|bound| matches!(bound.value, Passed::Out(_)));
                (is_signal(entry) || entry.effect == Effect::Pure) && entry.result != Base::Void && !writes
            }
            ExprKind::Assign(_) | ExprKind::AssignOp(..) | ExprKind::Step(..) => false,
            ExprKind::Call(..) | ExprKind::Splice(_) => false,
            _ => true,
        };
    });
    quiet
}

/// Whether the statements of a round always lead to the next round.
fn only_looks(block: &[Stmt]) -> bool {
    block.iter().all(|stmt| match &stmt.kind {
        StmtKind::Eval(_) | StmtKind::Continue => true,
        StmtKind::If(..) => blocks(stmt).all(only_looks),
        _ => false,
    })
}

/// Reports each `waituntil` without a time limit in a function that handles an event or is called by such a handler.
fn endless_handlers(program: &Program, tell: &mut dyn FnMut(&Func, Span, String)) {
    let mut handles: Vec<Option<FuncId>> = vec![None; program.funcs.len()];
    let mut open = Vec::new();
    let mut calls: Vec<Vec<FuncId>> = vec![Vec::new(); program.funcs.len()];
    for (func, calls) in program.funcs.iter().zip(&mut calls) {
        func.body.iter().for_each(|stmt| {
            visit::exprs_in_stmt(stmt, &mut |expr| match &expr.kind {
                ExprKind::Call(callee, _) => calls.push(*callee),
                ExprKind::Builtin(builtin) => open.extend(actions(builtin).map(|action| (action, action))),
                _ => {}
            });
        });
    }
    while let Some((func, handler)) = open.pop() {
        let Some(slot @ None) = handles.get_mut(func.0 as usize) else { continue };
        *slot = Some(handler);
        open.extend(calls.get(func.0 as usize).into_iter().flatten().map(|callee| (*callee, handler)));
    }
    for (func, handler) in program.funcs.iter().zip(handles) {
        let Some(handler) = handler.and_then(|handler| program.funcs.get(handler.0 as usize)) else { continue };
        // A handler that stops the robot itself waits until the robot may continue, for ever if necessary.
        if stops_the_robot(func) {
            continue;
        }
        func.body.iter().for_each(|stmt| {
            visit::exprs_in_stmt(stmt, &mut |expr| {
                if let ExprKind::Builtin(builtin) = &expr.kind
                    && builtin.entry.form == Form::WaitUntil
                    && !has_limit(builtin)
                {
                    tell(func, expr.span, handler.name.clone());
                }
            });
        });
    }
}

fn stops_the_robot(func: &Func) -> bool {
    let mut found = false;
    func.body.iter().for_each(|stmt| {
        visit::exprs_in_stmt(stmt, &mut |expr| {
            found |= matches!(&expr.kind, ExprKind::Builtin(builtin) if builtin.entry.halts);
        });
    });
    found
}

/// The functions that a built-in calls when an event occurs.
fn actions(builtin: &Builtin) -> impl Iterator<Item = FuncId> {
    let is_action = |at: usize| builtin.entry.params.get(at).is_some_and(|param| param.mode == Mode::Action);
    builtin.args.iter().filter(move |bound| is_action(bound.param)).filter_map(|bound| match &bound.value {
        Passed::Value(Expr { kind: ExprKind::Call(func, _), .. }) => Some(*func),
        _ => None,
    })
}

fn has_limit(wait: &Builtin) -> bool {
    let is_limit = |at: usize| wait.entry.params.get(at).is_some_and(|param| param.limits);
    wait.args.iter().any(|bound| is_limit(bound.param))
}
