//! Determines which functions are compiled separately: LLVM inlines a function with a single caller, and in a large
//! program it takes long for the result.

use crate::emit::Sizes;
use crate::hir::{ExprKind, Program};
use crate::visit;

/// For each function, whether its calls go through a pointer.
pub(in crate::emit) fn apart(program: &Program, sizes: Sizes) -> Vec<bool> {
    let weights: Vec<usize> = program.funcs.iter().map(|func| weight(program, &func.body)).collect();
    let large = is_large(program, sizes);
    let waits = program.funcs.iter().map(|func| func.effects.waits);
    weights.into_iter().zip(waits).map(|(weight, waits)| large && waits && weight >= sizes.least_awaits).collect()
}

/// Whether a program has many `.await`s.
pub(in crate::emit) fn is_large(program: &Program, sizes: Sizes) -> bool {
    program.funcs.iter().map(|func| weight(program, &func.body)).sum::<usize>() > sizes.awaits_of_a_program
}

/// The approximate number of `.await`s in the statements.
fn weight(program: &Program, body: &[crate::hir::Stmt]) -> usize {
    let mut weight = 0;
    for stmt in body {
        visit::exprs_in_stmt(stmt, &mut |expr| {
            weight += usize::from(match &expr.kind {
                ExprKind::Builtin(builtin) => builtin.entry.effect.takes_time(),
                ExprKind::Call(id, _) => program.funcs.get(id.0 as usize).is_some_and(|func| func.effects.waits),
                _ => false,
            });
        });
    }
    weight
}
