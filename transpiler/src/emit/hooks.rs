//! Hooks for a debugger: a frame for each function, its variables, and a place to halt at before each statement.
//!
//! Nothing of it is in programs that are not emitted for a debugger.

use super::body::Body;
use super::types::is_handle;
use crate::hir::{Func, LocalId, Stmt, StmtKind};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

impl Body<'_, '_> {
    /// `let frame = cx.frame("grip", FILE, 3);`, with the parameters of the function.
    pub(super) fn frame_opened(&mut self, func: &Func) -> TokenStream {
        if !self.unit.watched {
            return TokenStream::new();
        }
        let frame = self.reserve("frame");
        let (name, line) = (&func.name, self.line_number());
        self.frame = Some(frame.clone());
        let shown: TokenStream = func.params.iter().map(|id| self.shown(*id)).collect();
        quote!(let #frame = cx.frame(#name, FILE, #line); #shown)
    }

    /// `frame.variable("late", &late);`, behind its declaration.
    pub(super) fn shown(&self, id: LocalId) -> TokenStream {
        let local = self.func.and_then(|func| func.locals.get(id.0 as usize));
        let (Some(frame), Some(local)) = (&self.frame, local.filter(|local| local.shared && !is_handle(local.ty)))
        else {
            return TokenStream::new();
        };
        let (name, variable) = (&local.name, self.local(id));
        match local.ty.dims() {
            sizes if sizes.len() > 1 => {
                let sizes = sizes.iter().map(|size| Literal::u16_unsuffixed(*size));
                quote!(#frame.table(#name, &[#(#sizes),*], &#variable);)
            }
            _ => quote!(#frame.variable(#name, &#variable);),
        }
    }

    /// What halts before a statement, where the statement does not halt by itself.
    pub(super) fn halt_before(&self, stmt: &Stmt) -> TokenStream {
        if halts_itself(stmt) { TokenStream::new() } else { self.halt() }
    }

    /// `frame.halt(12).await;`
    pub(super) fn halt(&self) -> TokenStream {
        let line = self.line_number();
        self.frame.as_ref().map(|frame| quote!(#frame.halt(#line).await;)).unwrap_or_default()
    }

    /// The frame of an event's action, which halts before it does anything.
    pub(super) fn action_opened(&self) -> TokenStream {
        let Some(frame) = &self.frame else { return TokenStream::new() };
        let line = Literal::u32_unsuffixed(self.line);
        quote!(let #frame = cx.action(FILE, #line); #frame.halt(#line).await;)
    }
}

/// Loops halt in each round: in front of their condition, or of what begins the round. Nothing happens at a label, and at
/// a declaration without value.
fn halts_itself(stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Label(_) | StmtKind::Let(_, None) | StmtKind::While(..) | StmtKind::Loop(..) => true,
        StmtKind::For(each) => each.init.iter().any(|stmt| !halts_itself(stmt)),
        _ => false,
    }
}
