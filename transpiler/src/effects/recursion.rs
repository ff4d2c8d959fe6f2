//! Where functions that may call themselves look whether there is room for another call.

use super::facts::{self, FactScope};
use super::flow;
use crate::hir::Stmt;

/// Whether a statement calls a function that may lead back to the one that it is in.
pub(crate) fn leads_back(scope: FactScope<'_>, stmt: &Stmt) -> bool {
    let recursive =
        |id: &crate::hir::FuncId| scope.program.funcs.get(id.0 as usize).is_some_and(|func| func.effects.recursive);
    flow::expressions(stmt).any(|expr| facts::of_expr(scope, expr).calls.iter().any(recursive))
        || flow::blocks(stmt).any(|block| block.iter().any(|stmt| leads_back(scope, stmt)))
}
