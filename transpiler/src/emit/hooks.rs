//! Hooks for a debugger: a frame for each function, its variables, and a point to halt at before each statement.
//!
//! A debugger may also set the program pointer to another line of a function. The statements of the function are then
//! processed again from the first one, and none of them runs before that line.
//!
//! Invariants:
//! - Each statement asks its frame whether it runs. A statement with blocks asks whether the pointer was set to a line
//!   in it; if so, it leads there without evaluating its conditions.
//! - Declarations are always processed: a variable that exists already is kept, any other one gets its default value.
//! - Programs that are not emitted for a debugger contain no hooks.

use super::body::Body;
use super::fragment::{Fragment, Precedence};
use super::types::{base_type, is_handle};
use crate::effects::flow;
use crate::hir::{Arm, Expr, Func, LocalId, Stmt, StmtKind};
use arl_lang::catalog::Base;
use arl_lang::span::Span;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// The first and the last line at which something may halt.
pub(super) type Lines = (u32, u32);

impl<'p> Body<'p, '_> {
    /// `let frame = cx.frame("grip", FILE, 3);`, with the parameters of the function.
    pub(super) fn frame_opened(&mut self, func: &Func) -> TokenStream {
        if !self.unit.watched {
            return TokenStream::new();
        }
        let frame = self.reserve("frame");
        let (name, line) = (&func.name, self.line_number());
        self.form.frame = Some(frame.clone());
        let shown: TokenStream = func.params.iter().map(|id| self.shown(*id)).collect();
        quote!(let #frame = cx.frame(#name, FILE, #line); #shown)
    }

    /// `frame.run(async || -> Done<()> { .. }).await`: the statements of a function, which may begin again.
    pub(super) fn run_in_frame(&self, func: &Func, statements: TokenStream) -> TokenStream {
        let Some(frame) = &self.form.frame else { return statements };
        let value = base_type(func.result, self.family());
        let result = if func.result == Base::Void { quote!(()) } else { value };
        quote!(#frame.run(async || -> Done<#result> { #statements }).await)
    }

    /// `frame.variable(2, "late", &late);`, after its declaration.
    pub(super) fn shown(&self, id: LocalId) -> TokenStream {
        let local = self.func.and_then(|func| func.locals.get(id.0 as usize));
        let (Some(frame), Some(local)) = (&self.form.frame, local.filter(|local| local.shared)) else {
            return TokenStream::new();
        };
        let (name, variable, number) = (&local.name, self.local(id), number(id));
        let sizes = local.ty.dims();
        let shown = sizes.iter().map(|size| Literal::u16_unsuffixed(*size));
        match (is_handle(local.ty), sizes.len() > 1) {
            (true, false) => quote!(#frame.handle(#number, #name, &#variable);),
            (true, true) => quote!(#frame.handles(#number, #name, &[#(#shown),*], &#variable);),
            (false, false) => quote!(#frame.variable(#number, #name, &#variable);),
            (false, true) => quote!(#frame.table(#number, #name, &[#(#shown),*], &#variable);),
        }
    }

    /// The value of a variable whose declaration is skipped: its old value, or its default value.
    pub(super) fn kept(&self, id: LocalId, start: TokenStream) -> TokenStream {
        let shared = self.func.and_then(|func| func.locals.get(id.0 as usize)).is_some_and(|local| local.shared);
        match &self.form.frame {
            Some(frame) if shared => {
                let number = number(id);
                quote!(#frame.kept(#number, || #start))
            }
            _ => start,
        }
    }

    /// The value of a declaration, which is computed if the declaration runs.
    pub(super) fn declared(
        &self,
        id: LocalId,
        before: &TokenStream,
        value: TokenStream,
        start: TokenStream,
    ) -> TokenStream {
        let Some(frame) = &self.form.frame else { return value };
        let (line, kept) = (self.line_number(), self.kept(id, start));
        quote!(if #frame.runs(#line).await { #before #value } else { #kept })
    }

    /// The code of a statement, executed if the statement runs.
    pub(super) fn where_it_runs(&self, stmt: &Stmt, code: TokenStream) -> TokenStream {
        let Some(frame) = &self.form.frame else { return code };
        let line = self.line_number();
        match &stmt.kind {
            StmtKind::Label(_) | StmtKind::Let(_, None) => code,
            // Constants are declared in any case; the declaration of a variable asks by itself.
            StmtKind::Let(id, _) if self.is_shared(*id) => code,
            StmtKind::Let(..) => quote!(#frame.runs(#line).await; #code),
            _ if has_blocks(stmt) => {
                let lines = written(self.lines_with(stmt));
                quote!(if #frame.enters(#lines) { #code })
            }
            _ => quote!(if #frame.runs(#line).await { #code }),
        }
    }

    /// `frame.runs(12).await;`, for code that always runs when it is reached.
    pub(super) fn halt(&self) -> TokenStream {
        let line = self.line_number();
        self.form.frame.as_ref().map(|frame| quote!(#frame.runs(#line).await;)).unwrap_or_default()
    }

    /// A condition with a halt before it, unless the program pointer was set to a line that the condition leads to.
    pub(super) fn halt_or_pointer_leads(&self, block: &[Stmt], condition: Fragment) -> Fragment {
        let Some(frame) = &self.form.frame else { return condition };
        let line = self.line_number();
        let condition = condition.inline().at(Precedence::And);
        self.or_pointer_leads(block, Fragment::new(quote!(#frame.runs(#line).await && #condition), Precedence::And))
    }

    /// `frame.leads_to(13, 15) || condition`, if the block after the condition has lines of its own: the block of a
    /// compact `if` shares the line of the condition.
    pub(super) fn or_pointer_leads(&self, block: &[Stmt], condition: Fragment) -> Fragment {
        let lines = self.lines_of_block(block).map(|(first, last)| (first.max(self.position.line + 1), last));
        match (&self.form.frame, lines.filter(|(first, last)| first <= last)) {
            (Some(frame), Some(lines)) => {
                let (lines, condition) = (written(lines), condition.inline().at(Precedence::Or));
                Fragment::new(quote!(#frame.leads_to(#lines) || #condition), Precedence::Or)
            }
            _ => condition,
        }
    }

    /// Code that runs in a loop unless the program pointer was set to a line of its body.
    pub(super) fn unless_pointer_leads(&self, body: &[Stmt], code: TokenStream) -> TokenStream {
        match (&self.form.frame, self.lines_of_block(body)) {
            (Some(frame), Some(lines)) => {
                let lines = written(lines);
                quote!(if !#frame.leads_to(#lines) { #code })
            }
            _ => code,
        }
    }

    /// `switch(subject)`: the arm is chosen first, by the pointer or by the subject. `codes` is the code of the arms.
    pub(super) fn switch_with_pointer(
        &mut self,
        subject: &'p Expr,
        arms: &'p [Arm],
        codes: Vec<TokenStream>,
        otherwise: TokenStream,
    ) -> TokenStream {
        let Some(frame) = self.form.frame.clone() else { return TokenStream::new() };
        self.stand_at(subject.span);
        let arm = self.fresh("arm");
        let number = |at: usize| Literal::usize_unsuffixed(at);
        let numbered = arms.iter().enumerate().map(|(at, arm)| {
            let at = number(at);
            (arm.value.as_ref(), quote!(#at))
        });
        let none = number(arms.len());
        let halt = self.halt();
        self.position.acts = false;
        let chosen = self.chosen(subject, numbered.collect(), quote!(#none));
        let lines = arms.iter().map(|arm| {
            // The pointer cannot lead into an arm without statements.
            let lines = written(self.lines_of_block(&arm.body).unwrap_or((1, 0)));
            quote!((#lines))
        });
        let cases = codes.into_iter().enumerate().map(|(at, code)| {
            let at = number(at);
            quote!(#at => { #code })
        });
        quote! {
            let #arm = match #frame.way_to(&[#(#lines),*]) {
                Some(#arm) => #arm,
                None => { #halt #chosen }
            };
            match #arm { #(#cases)* _ => { #otherwise } }
        }
    }

    /// A halt before a `for` that has nothing else to halt at there.
    pub(super) fn halt_at_head(&self, init: &[Stmt]) -> TokenStream {
        let halts = init.iter().any(|stmt| !matches!(stmt.kind, StmtKind::Let(_, None)));
        if halts { TokenStream::new() } else { self.halt() }
    }

    /// The frame of an event's action, which halts before the action does anything.
    pub(super) fn action_opened(&self) -> TokenStream {
        let Some(frame) = &self.form.frame else { return TokenStream::new() };
        let line = Literal::u32_unsuffixed(self.position.line);
        quote!(let #frame = cx.action(FILE, #line); #frame.runs(#line).await;)
    }

    /// The lines of a statement and of those inside.
    pub(super) fn lines_with(&self, stmt: &Stmt) -> Lines {
        let line = |span: Span| self.unit.line(self.module, span);
        let first = line(stmt.span);
        let inner = flow::blocks(stmt).filter_map(|block| self.lines_of_block(block)).map(|(_, last)| last);
        let conditions: Vec<u32> = match &stmt.kind {
            StmtKind::If(arms, _) => arms.iter().map(|(condition, _)| line(condition.span)).collect(),
            StmtKind::Repeat(body, until, _) if flow::goes_round(body) => vec![line(until.span)],
            _ => Vec::new(),
        };
        (first, inner.chain(conditions).fold(first, u32::max))
    }

    /// The lines of the statements of a block; `None` for an empty one.
    pub(super) fn lines_of_block(&self, block: &[Stmt]) -> Option<Lines> {
        let (first, last) = (block.first()?, block.last()?);
        Some((self.unit.line(self.module, first.span), self.lines_with(last).1))
    }
}

/// `12, 20`
pub(super) fn written((first, last): Lines) -> TokenStream {
    let (first, last) = (Literal::u32_unsuffixed(first), Literal::u32_unsuffixed(last));
    quote!(#first, #last)
}

fn number(id: LocalId) -> Literal {
    Literal::usize_unsuffixed(id.0 as usize)
}

/// Whether a statement contains other statements.
fn has_blocks(stmt: &Stmt) -> bool {
    matches!(
        stmt.kind,
        StmtKind::If(..)
            | StmtKind::Switch(..)
            | StmtKind::While(..)
            | StmtKind::Loop(..)
            | StmtKind::Repeat(..)
            | StmtKind::For(..)
    )
}
