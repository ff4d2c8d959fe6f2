//! What functions and loops do: wait, fail, need the context, use global variables, call themselves.

pub(crate) mod captures;
pub(crate) mod facts;
pub mod flow;
pub(crate) mod graph;
pub(crate) mod growth;
pub(crate) mod loops;
pub(crate) mod parts;
pub(crate) mod pointer;
pub(crate) mod ranges;
pub(crate) mod recursion;
pub(crate) mod visibility;
mod walks;
#[cfg(feature = "tools")]
pub(crate) mod watched;

use crate::hir::{Effects, FuncId, Program};
use facts::Facts;
use graph::components;

/// For each function, whether calling it moves the program pointer, because it uses a built-in that looks at the
/// pointer.
pub(crate) fn pointer_movers(program: &Program) -> Vec<bool> {
    let direct: Vec<Facts> = program.funcs.iter().map(|func| facts::of_function(program, func)).collect();
    let calls = calls(&direct);
    let mut moves: Vec<bool> = direct.iter().map(|facts| facts.points).collect();
    for group in components(&calls) {
        let all = |func: &usize| {
            let callees = calls.get(*func).into_iter().flatten();
            callees.chain([func]).any(|callee| moves.get(*callee) == Some(&true))
        };
        if group.iter().any(all) {
            group.iter().for_each(|func| moves.get_mut(*func).into_iter().for_each(|moves| *moves = true));
        }
    }
    moves
}

/// For each function, whether it is needed by `main`, by the initial value of a variable or by an event.
pub(crate) fn reached(program: &Program) -> Vec<bool> {
    let direct: Vec<Facts> = program.funcs.iter().map(|func| facts::of_function(program, func)).collect();
    let calls: Vec<Vec<usize>> = direct
        .iter()
        .map(|facts| facts.calls.iter().chain(&facts.later_calls).map(|FuncId(callee)| *callee as usize).collect())
        .collect();
    let ranges = ranges::Ranges::default();
    let scope = facts::FactScope { program, func: None, ranges: &ranges };
    let inits = program.globals.iter().filter_map(|global| global.init.as_ref());
    let mut open: Vec<usize> = inits
        .flat_map(|init| facts::of_expr(scope, init).calls)
        .chain(program.main)
        .map(|FuncId(func)| func as usize)
        .collect();
    let mut reached = vec![false; program.funcs.len()];
    while let Some(func) = open.pop() {
        if let Some(seen) = reached.get_mut(func)
            && !std::mem::replace(seen, true)
        {
            open.extend(calls.get(func).into_iter().flatten());
        }
    }
    reached
}

fn calls(direct: &[Facts]) -> Vec<Vec<usize>> {
    direct.iter().map(|facts| facts.calls.iter().map(|FuncId(callee)| *callee as usize).collect()).collect()
}

/// Fills in the effects of all functions and the information about their loops.
pub fn infer(program: &mut Program) {
    growth::mark(program);
    for func in &mut program.funcs {
        captures::mark(func);
        loops::judge(func);
    }
    let direct: Vec<Facts> = program.funcs.iter().map(|func| facts::of_function(program, func)).collect();
    let calls = calls(&direct);
    // Callees come before their callers, so one pass is enough.
    for group in components(&calls) {
        let callees = || group.iter().flat_map(|func| calls.get(*func).into_iter().flatten());
        let recursive = callees().any(|callee| group.contains(callee));
        let mut effects = Effects { recursive, fails: recursive, context: recursive, ..Effects::default() };
        for facts in group.iter().filter_map(|func| direct.get(*func)) {
            effects.waits |= facts.waits;
            effects.fails |= facts.fails;
            effects.context |= facts.context;
            effects.globals |= facts.globals;
            effects.changes |= facts.changes;
        }
        for callee in callees().filter_map(|callee| program.funcs.get(*callee)).map(|func| func.effects) {
            effects.waits |= callee.waits;
            effects.fails |= callee.fails;
            effects.context |= callee.context;
            effects.globals |= callee.globals;
            effects.changes |= callee.changes;
        }
        for func in group {
            if let Some(func) = program.funcs.get_mut(func) {
                func.effects = effects;
            }
        }
    }
}
