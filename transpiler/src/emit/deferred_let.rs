//! Variables that are declared at their first assignment: `int i` followed by `i = 5` is `let i = 5`.
//!
//! Applies to late variables (whose first value is never read) whose first mention is an assignment in the same block
//! as their declaration.

use super::body::Body;
use super::mentions::{in_expression, in_statement};
use super::usage_graph::writes_only;
use crate::hir::{Expr, ExprKind, LocalId, Passed, Place, Root, Stmt, StmtKind};
use proc_macro2::TokenStream;
use quote::quote;

/// The number of statements that are searched for the first mention.
const REACH: usize = 64;

impl Body<'_, '_> {
    /// Records which of the variables that a block declares get their `let` at their first assignment.
    pub(super) fn find_deferred(&mut self, statements: &[&Stmt]) {
        for (at, stmt) in statements.iter().enumerate() {
            let StmtKind::Let(id, _) = stmt.kind else { continue };
            if !self.locals.usage.is_late(id) {
                continue;
            }
            let rest = statements.iter().skip(at + 1).take(REACH);
            if rest.into_iter().find(|stmt| in_statement(stmt, id)).is_some_and(|stmt| only_assigns(stmt, id)) {
                self.locals.deferred.insert(id);
            }
        }
    }

    /// `let`, if the assignment to this place is also the declaration; with the type if the value does not show it.
    pub(super) fn deferred_let(&mut self, place: &Place, value: Option<&Expr>) -> Option<TokenStream> {
        let id = self.plain_local(place.root)?;
        if !place.path.is_empty() || !self.locals.deferred.remove(&id) {
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
        // Its first statement is before the loop, in the block of the declaration.
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
