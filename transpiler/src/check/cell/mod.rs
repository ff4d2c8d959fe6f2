//! Constant values in a program that the given cell does not have or does not accept.

mod channels;
mod connections;

use crate::diagnostics::{Diagnostic, Location, Problem};
use crate::hir::{Builtin, Expr, ExprKind, ModuleId, Passed, Program, Value};
use crate::visit;
use arl_lang::catalog::{Param, Relation, Space};
use arl_lang::span::Span;
use arl_robot::outline::Outline;

/// Checks the calls of a program against a cell.
pub(crate) fn check(program: &Program, cell: &Outline, locate: &dyn Fn(ModuleId, Span) -> Location) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    // A problem that all calls share is reported at the first one.
    let mut unseen = !cell.modbus_tcp;
    let mut look = |module: ModuleId, expr: &Expr| {
        let ExprKind::Builtin(builtin) = &expr.kind else { return };
        let channel = channels::problem(builtin, &cell.channels);
        if let Some((span, problem)) = channel.or_else(|| channels::no_foreground(builtin, cell.foreground)) {
            found.push(problem.at(locate(module, span)));
        }
        if let Some((span, problem)) = connections::problem(builtin, cell) {
            found.push(problem.at(locate(module, span)));
        } else if unseen && let Some(problem) = connections::unseen(builtin) {
            unseen = false;
            found.push(problem.at(locate(module, expr.span)));
        }
    };
    for global in &program.globals {
        global.init.iter().for_each(|init| visit::exprs(init, &mut |expr| look(global.module, expr)));
    }
    for func in &program.funcs {
        func.body.iter().for_each(|stmt| visit::exprs_in_stmt(stmt, &mut |expr| look(func.module, expr)));
    }
    found
}

/// The passed values, each with its parameter, in the order of the parameters.
fn given(builtin: &Builtin) -> impl Iterator<Item = (&'static Param, &Expr)> {
    builtin.entry.params.iter().enumerate().filter_map(|(at, param)| {
        let bound = builtin.args.iter().find(|bound| bound.param == at)?;
        match &bound.value {
            Passed::Value(value) => Some((param, value)),
            Passed::Out(_) => None,
        }
    })
}

/// The values that are addresses, each with the space that it addresses.
fn addressed(builtin: &Builtin) -> impl Iterator<Item = (Space, &Expr)> {
    given(builtin).filter_map(|(param, value)| Some((param.addresses?, value)))
}

/// The value with the wanted relation to what is addressed.
fn related(builtin: &Builtin, wanted: impl Fn(Relation) -> bool) -> Option<(Relation, &Expr)> {
    given(builtin).find_map(|(param, value)| Some((param.relation.filter(|relation| wanted(*relation))?, value)))
}

/// A constant whole number and its position.
fn constant_int(expr: &Expr) -> Option<(i32, Span)> {
    let (value, span) = constant(expr)?;
    (value.fract() == 0.0).then_some((value as i32, span))
}

/// A constant number and its position.
fn constant(expr: &Expr) -> Option<(f64, Span)> {
    let value = match &expr.kind {
        ExprKind::Const(Value::Double(value)) => *value,
        ExprKind::Const(Value::Int(value)) => f64::from(*value),
        ExprKind::Const(Value::Uint(value)) => f64::from(*value),
        ExprKind::Const(Value::Byte(value)) => f64::from(*value),
        ExprKind::Convert(inner) => constant(inner)?.0,
        _ => return None,
    };
    Some((value, expr.span))
}
