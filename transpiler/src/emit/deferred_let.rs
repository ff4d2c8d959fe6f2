//! Variables that are declared at their first assignment: `int i` followed by `i = 5` is `let i = 5`.
//!
//! This is for late variables (whose first value nobody reads) whose first mention is an assignment in the very block
//! of their declaration.

use super::body::Body;
use super::mentions::{in_expression, in_statement};
use super::usage_graph::writes_only;
use crate::hir::{Expr, ExprKind, LocalId, Passed, Place, Root, Stmt, StmtKind};
use proc_macro2::TokenStream;
use quote::quote;

/// So far down the block the first mention is looked for.
const REACH: usize = 64;

impl Body<'_, '_> {
    /// Notes which of the variables that a block declares get their `let` at their first assignment.
    pub(super) fn find_deferred(&mut self, statements: &[&Stmt]) {
        for (at, stmt) in statements.iter().enumerate() {
            let StmtKind::Let(id, _) = stmt.kind else { continue };
            if !self.usage.is_late(id) {
                continue;
            }
            let rest = statements.iter().skip(at + 1).take(REACH);
            if rest.into_iter().find(|stmt| in_statement(stmt, id)).is_some_and(|stmt| only_assigns(stmt, id)) {
                self.deferred.insert(id);
            }
        }
    }

    /// `let`, where the assignment to this place is the declaration, too; with the type where the value does not show
    /// it.
    pub(super) fn deferred_let(&mut self, place: &Place, value: Option<&Expr>) -> Option<TokenStream> {
        let id = self.plain_local(place.root)?;
        if !place.path.is_empty() || !self.deferred.remove(&id) {
            return None;
        }
        let (mutable, name) = (self.mutable(id), self.local(id));
        let ty = self.annotation(place.ty, value);
        Some(quote!(let #mutable #name #ty))
    }
}

/// Whether a statement assigns to a local and does not mention it otherwise.
fn only_assigns(stmt: &Stmt, id: LocalId) -> bool {
    if let StmtKind::For(each) = &stmt.kind {
        // Its first statement stands before the loop, in the block of the declaration.
        return matches!(each.init.as_slice(), [init] if only_assigns(init, id));
    }
    let StmtKind::Eval(expr) = &stmt.kind else { return false };
    let is_it = |place: &Place| matches!(place.root, Root::Local(other) if other == id) && place.path.is_empty();
    match &expr.kind {
        ExprKind::Assign(sides) => is_it(&sides.0) && !in_expression(&sides.1, id),
        ExprKind::Builtin(builtin) if writes_only(builtin.entry) => builtin.args.iter().all(|arg| match &arg.value {
            Passed::Out(place) => is_it(place),
            Passed::Value(value) => !in_expression(value, id),
        }),
        _ => false,
    }
}
