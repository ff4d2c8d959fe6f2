//! What functions and loops do: wait, fail, need the context, see global variables, call themselves.

pub(crate) mod facts;
pub(crate) mod flow;
pub(crate) mod graph;
pub(crate) mod loops;

use crate::hir::{Effects, FuncId, Program};
use facts::Facts;
use graph::components;

/// Fills in the effects of all functions and the findings about their loops.
pub fn infer(program: &mut Program) {
    for func in &mut program.funcs {
        loops::judge(func);
    }
    let direct: Vec<Facts> = program.funcs.iter().map(|func| facts::of_function(program, func)).collect();
    let calls: Vec<Vec<usize>> =
        direct.iter().map(|facts| facts.calls.iter().map(|FuncId(callee)| *callee as usize).collect()).collect();
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
        }
        for callee in callees().filter_map(|callee| program.funcs.get(*callee)).map(|func| func.effects) {
            effects.waits |= callee.waits;
            effects.fails |= callee.fails;
            effects.context |= callee.context;
            effects.globals |= callee.globals;
        }
        for func in group {
            if let Some(func) = program.funcs.get_mut(func) {
                func.effects = effects;
            }
        }
    }
}
