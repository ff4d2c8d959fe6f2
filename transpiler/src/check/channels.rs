//! Channels of io that a certain cell does not have, as far as they are constant.

use crate::diagnostics::channels::ChannelProblem;
use crate::diagnostics::{Diagnostic, Location, Problem};
use crate::hir::{Builtin, Expr, ExprKind, ModuleId, Passed, Program, Value};
use crate::visit;
use arl_lang::span::Span;
use arl_robot::channels::Channels;

/// The most channels that one call may name.
const MOST_AT_ONCE: i64 = 32;

/// Which channels a built-in means, and how many a cell has.
type Kind = (&'static str, fn(&Channels) -> usize);

const DI: Kind = ("DI", |cell| cell.di as usize);
const DO: Kind = ("DO", |cell| cell.dout as usize);
const AI: Kind = ("AI", |cell| cell.ai.len());
const AO: Kind = ("AO", |cell| cell.ao.len());
const INTERNAL: Kind = ("internal signal", |cell| cell.internal as usize);

/// The built-ins that name channels in their first parameter, or in their first two.
const NAMES: [(&str, Kind); 13] = [
    ("setdo", DO),
    ("setdoimv", DO),
    ("syncdo", DO),
    ("pulsedo", DO),
    ("getdo", DO),
    ("getdi", DI),
    ("getnostopdi", DI),
    ("getai", AI),
    ("setao", AO),
    ("syncao", AO),
    ("getao", AO),
    ("getintdi", INTERNAL),
    ("getintdo", INTERNAL),
];

/// Reports constant channels that the cell does not have, and constant values that its analog outputs do not carry.
pub(crate) fn check(
    program: &Program,
    cell: &Channels,
    locate: &dyn Fn(ModuleId, Span) -> Location,
) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let mut look = |module: ModuleId, expr: &Expr| {
        if let ExprKind::Builtin(builtin) = &expr.kind
            && let Some((span, problem)) = problem(builtin, cell)
        {
            found.push(problem.at(locate(module, span)));
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

/// What is wrong with the channels of a call, and where.
fn problem(builtin: &Builtin, cell: &Channels) -> Option<(Span, ChannelProblem)> {
    let (_, (kind, count)) = NAMES.iter().find(|(name, _)| *name == builtin.entry.name)?;
    let (kind, count) = (*kind, count(cell) as u32);
    let named = |at: usize| builtin.entry.params.get(at).is_some_and(|param| param.name.contains("chan"));
    let channels: Vec<(i32, Span)> =
        [0, 1].into_iter().filter(|at| named(*at)).filter_map(|at| constant_int(argument(builtin, at)?)).collect();
    let missing = channels.iter().find(|(channel, _)| !(1..=i64::from(count)).contains(&i64::from(*channel)));
    if let Some((channel, span)) = missing {
        return Some((*span, ChannelProblem::Missing { kind, channel: *channel, count }));
    }
    if let [(from, _), (to, span)] = *channels.as_slice() {
        return match i64::from(to) - i64::from(from) {
            ..0 => Some((span, ChannelProblem::Reversed { kind, from, to })),
            MOST_AT_ONCE.. => Some((span, ChannelProblem::TooMany { kind, from, to })),
            _ => None,
        };
    }
    let (channel, _) = *channels.first().filter(|_| matches!(builtin.entry.name, "setao" | "syncao"))?;
    let ty = *cell.ao.get(usize::try_from(channel).ok()?.checked_sub(1)?)?;
    let (value, span) = constant(argument(builtin, 1)?)?;
    let (low, high) = ty.range();
    (!(low..=high).contains(&value)).then_some((span, ChannelProblem::Value { channel, value, ty }))
}

fn argument(builtin: &Builtin, param: usize) -> Option<&Expr> {
    let bound = builtin.args.iter().find(|bound| bound.param == param)?;
    match &bound.value {
        Passed::Value(value) => Some(value),
        Passed::Out(_) => None,
    }
}

fn constant_int(expr: &Expr) -> Option<(i32, Span)> {
    let (value, span) = constant(expr)?;
    (value.fract() == 0.0).then_some((value as i32, span))
}

/// A constant number and its place.
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
