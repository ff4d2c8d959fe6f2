//! Where functions that may call themselves look whether there is room for another call, and what it weighs.

use super::facts::{self, FactScope};
use super::flow;
use crate::hir::{Func, Stmt};
use crate::visit;
use arl_lang::catalog::Family;

/// Whether a statement calls a function that may lead back to the one that it is in.
pub(crate) fn leads_back(scope: FactScope<'_>, stmt: &Stmt) -> bool {
    let recursive =
        |id: &crate::hir::FuncId| scope.program.funcs.get(id.0 as usize).is_some_and(|func| func.effects.recursive);
    flow::expressions(stmt).any(|expr| facts::of_expr(scope, expr).calls.iter().any(recursive))
        || flow::blocks(stmt).any(|block| block.iter().any(|stmt| leads_back(scope, stmt)))
}

/// The largest array that is kept where it is declared, in bytes.
const LARGEST_IN_PLACE: usize = 1024;

/// How many bytes of variables weigh as much as a call.
const BYTES_OF_A_CALL: usize = 128;

/// How many expressions weigh as much as a call: without optimisation each keeps its value in a place of its own.
const EXPRESSIONS_OF_A_CALL: usize = 16;

/// So many expressions add nothing to what a call weighs.
const FREE_EXPRESSIONS: usize = 32;

/// The most that a call weighs, however large its function is: a hundred may be nested.
const HEAVIEST_CALL: usize = 200;

/// What a call of a function weighs, by what native code keeps on the stack for it.
pub(crate) fn weight(func: &Func, family: Family) -> u32 {
    let bytes = func.locals.iter().map(|local| match local.ty.bytes(family) {
        bytes if local.ty.is_array() && bytes > LARGEST_IN_PLACE => size_of::<usize>(),
        bytes => bytes,
    });
    let mut expressions = 0_usize;
    func.body.iter().for_each(|stmt| visit::exprs_in_stmt(stmt, &mut |_| expressions += 1));
    let expressions = expressions.saturating_sub(FREE_EXPRESSIONS) / EXPRESSIONS_OF_A_CALL;
    let weight = 1 + bytes.sum::<usize>() / BYTES_OF_A_CALL + expressions;
    weight.min(HEAVIEST_CALL) as u32
}
