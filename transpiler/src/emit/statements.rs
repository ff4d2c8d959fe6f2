//! Statements and blocks.

use super::body::Body;
use super::control_flow::{Exit, Tail};
use super::fragment::{Fragment, Precedence};
use super::parts::Leave;
use super::sequence::Mode;
use super::switch;
use super::types::{rust_type, shared_type, shared_value, start_value};
use super::waiting::ending;
use crate::effects::{flow, recursion};
use crate::hir::{Expr, ExprKind, LocalId, Stmt, StmtKind, Type, Value};
use arl_lang::catalog::Base;
use proc_macro2::{TokenStream, TokenTree};
use quote::quote;

impl<'p> Body<'p, '_> {
    /// The statements of a block, as a scope.
    pub(super) fn block(&mut self, block: &'p [Stmt], tail: Tail) -> TokenStream {
        let visible = self.locals.visible.len();
        let statements = flow::reachable(block);
        self.find_deferred(&statements);
        let groups = self.groups(statements);
        let out = self.grouped(groups, tail);
        self.locals.visible.truncate(visible);
        out
    }

    /// Whether a statement calls a function that may lead back to the current one.
    pub(super) fn calls_itself(&self, stmt: &Stmt) -> bool {
        recursion::leads_back(self.scope(), stmt)
    }

    /// An expression; afterwards the caller can ask whether it needs the program pointer.
    pub(super) fn value_alone(&mut self, expr: &'p Expr) -> Fragment {
        self.position.acts = false;
        self.value(expr)
    }

    /// One statement with its comment.
    pub(super) fn statement(&mut self, stmt: &'p Stmt, tail: Tail) -> TokenStream {
        self.with_own_temporaries(|body| {
            body.stand_at(stmt.span);
            body.position.acts = false;
            let comment = body.comment(stmt.span);
            let line = body.position.line;
            let code = body.bare_statement(stmt, tail);
            body.position.line = line;
            quote!(#comment #code)
        })
    }

    fn bare_statement(&mut self, stmt: &'p Stmt, tail: Tail) -> TokenStream {
        match &stmt.kind {
            StmtKind::Let(id, value) => self.declaration(*id, value.as_ref()),
            StmtKind::Eval(expr) => self.effect(expr, tail),
            StmtKind::If(arms, otherwise) => self.branches(arms, otherwise.as_deref(), tail_of(stmt, tail)),
            StmtKind::While(condition, body, info) => self.while_loop(condition, body, *info),
            StmtKind::Repeat(body, until, info) => self.repeat_loop(body, until, *info),
            StmtKind::Loop(body, info) => self.endless_loop(body, *info),
            StmtKind::For(each) => self.for_loop(each),
            StmtKind::Switch(subject, arms) => self.switch(subject, arms, tail_of(stmt, tail)),
            StmtKind::Break => self.leave(true),
            StmtKind::Continue => self.leave(false),
            StmtKind::Goto(label) => self.goto(*label, stmt.span),
            // Labels that a `goto` names are states of the machine; others have been dropped.
            StmtKind::Label(_) => TokenStream::new(),
            StmtKind::Return(value) => self.return_statement(value.as_ref(), tail),
        }
    }

    /// `let x = value;`
    fn declaration(&mut self, id: LocalId, value: Option<&'p Expr>) -> TokenStream {
        let Some(local) = self.func.and_then(|func| func.locals.get(id.0 as usize)) else { return TokenStream::new() };
        if local.constant && local.value.is_some() && !self.locals.usage.is_read(id) {
            return TokenStream::new();
        }
        let (name, family) = (self.local(id), self.family());
        if local.shared {
            return self.shared_declaration(id, local.ty, value);
        }
        let given = value.map(|value| self.expression(value, Mode::Placed));
        let before = given.as_ref().map(|value| value.before.clone());
        let start = start_value(local.ty, family);
        let tokens = given.as_ref().map_or(&start, |value| &value.tokens);
        self.locals.visible.push(id);
        self.note_declaration(id);
        let code = if self.is_hoisted(id) {
            quote!(#name = #tokens;)
        } else if self.locals.deferred.contains(&id) {
            TokenStream::new()
        } else if self.locals.usage.is_late(id) {
            let (mutable, ty) = (self.mutable(id), rust_type(local.ty, family));
            quote!(let #mutable #name: #ty;)
        } else {
            let (mutable, ty) = (self.mutable(id), self.annotation(local.ty, value));
            quote!(let #mutable #name #ty = #tokens;)
        };
        let pointer = self.pointer();
        quote!(#pointer #before #code)
    }

    /// `let x = Rc::new(Cell::new(value));`: a variable visible to events, a new one each time.
    fn shared_declaration(&mut self, id: LocalId, ty: Type, value: Option<&'p Expr>) -> TokenStream {
        let (name, family) = (self.local(id), self.family());
        let given = value.map(|value| self.expression(value, Mode::Placed));
        let before = given.as_ref().map(|value| value.before.clone());
        let start = shared_value(ty, start_value(ty, family));
        let cell = given.map(|value| shared_value(ty, value.tokens));
        self.locals.visible.push(id);
        self.note_declaration(id);
        let pointer = self.pointer();
        let of = needs_annotation(ty, value).then(|| shared_type(ty, family)).map(|ty| quote!(: #ty));
        let target = if self.is_hoisted(id) { quote!(#name) } else { quote!(let #name #of) };
        match cell {
            Some(cell) => quote!(#pointer #before #target = #cell;),
            None => quote!(#pointer #before #target = #start;),
        }
    }

    /// Makes parameters that events use visible to them.
    pub(super) fn shared_parameters(&self, params: &[LocalId]) -> TokenStream {
        let func = self.func;
        let shared = params.iter().filter(|id| self.is_shared(**id)).filter_map(|id| {
            let ty = func?.locals.get(id.0 as usize)?.ty;
            let name = self.local(*id);
            let cell = shared_value(ty, quote!(#name));
            Some(quote!(let #name = #cell;))
        });
        shared.collect()
    }

    /// `: i32`, if the value does not show the type.
    pub(super) fn annotation(&self, ty: Type, value: Option<&Expr>) -> TokenStream {
        if !needs_annotation(ty, value) {
            return TokenStream::new();
        }
        let ty = rust_type(ty, self.family());
        quote!(: #ty)
    }

    /// `mut` if the variable changes.
    pub(super) fn mutable(&self, id: LocalId) -> TokenStream {
        if self.locals.usage.is_mutable(id) { quote!(mut) } else { TokenStream::new() }
    }

    /// An expression that is used for its effect.
    pub(super) fn effect(&mut self, expr: &'p Expr, tail: Tail) -> TokenStream {
        self.position.acts = false;
        if let ExprKind::Builtin(builtin) = &expr.kind
            && flow::ends(expr)
        {
            let stop = ending(builtin);
            return if tail == Tail::Function { quote!(Err(#stop)) } else { quote!(return Err(#stop);) };
        }
        let code = match &expr.kind {
            ExprKind::Assign(_) | ExprKind::AssignOp(..) | ExprKind::Step(..) => self.assignment(expr),
            ExprKind::Call(..) | ExprKind::Builtin(_) => {
                let Fragment { before, tokens, settled, .. } = self.value(expr);
                // A settled value has been computed before; a result that is not used is dropped.
                match settled {
                    false => quote!(#before #tokens;),
                    true if is_unit(&tokens) => before,
                    true => quote!(#before let _ = #tokens;),
                }
            }
            ExprKind::Const(_) => TokenStream::new(),
            _ => {
                let Fragment { before, tokens, .. } = self.value(expr);
                quote!(#before let _ = #tokens;)
            }
        };
        let pointer = self.pointer_for(expr);
        quote!(#pointer #code)
    }

    /// `if`, `else if`, `else`
    fn branches(&mut self, arms: &'p [(Expr, Vec<Stmt>)], otherwise: Option<&'p [Stmt]>, tail: Tail) -> TokenStream {
        let mut out = TokenStream::new();
        for (at, (condition, block)) in arms.iter().enumerate() {
            let (condition_expr, condition_span) = (condition, condition.span);
            self.stand_at(condition_span);
            let value = self.value_alone(condition);
            let value = if at == 0 {
                let pointer = self.pointer_for(condition_expr);
                let before = &value.before;
                out = quote!(#pointer #before);
                Fragment { before: TokenStream::new(), ..value }
            } else {
                value.inline()
            };
            let condition = &value.tokens;
            let comment = if at > 0 { self.comment(condition_span) } else { TokenStream::new() };
            let block = self.block(block, tail);
            let otherwise = (at > 0).then(|| quote!(else));
            out.extend(quote!(#otherwise if #condition { #comment #block }));
        }
        if let Some(block) = otherwise {
            let block = self.block(block, tail);
            out.extend(quote!(else { #block }));
        }
        out
    }

    /// `break`, `continue`
    pub(super) fn leave(&mut self, breaks: bool) -> TokenStream {
        if let Some(leave) = self.leave_part(if breaks { Leave::Break } else { Leave::Continue }, None) {
            return leave;
        }
        let Some(innermost) = self.flow.loops.last() else { return TokenStream::new() };
        let exit = if breaks { &innermost.on_break } else { &innermost.on_continue };
        match exit.clone() {
            Exit::Plain if breaks => quote!(break;),
            Exit::Plain => quote!(continue;),
            Exit::Labelled(how) => quote!(#how;),
            Exit::State(state) => self.jump(state),
        }
    }

    /// `return`
    fn return_statement(&mut self, value: Option<&'p Expr>, tail: Tail) -> TokenStream {
        let moved = value.and_then(|value| self.moved_local(value));
        let value = match moved {
            Some(name) => Some(Fragment::postfix(name)),
            None => value.map(|value| self.value(value)),
        };
        let before = value.as_ref().map(|value| value.before.clone());
        let direct = value.as_ref().filter(|_| self.fails() && self.flow.parts.is_empty()).and_then(without_detour);
        let tokens = value.map(|value| value.tokens);
        let code = match (tail, direct) {
            (Tail::Function, direct) => {
                let result = direct.or_else(|| self.result(tokens));
                quote!(#before #result)
            }
            (Tail::Inner, Some(result)) => quote!(#before return #result;),
            (Tail::Inner, None) => self.return_of(quote!(#before), tokens),
        };
        let pointer = self.pointer();
        quote!(#pointer #code)
    }

    /// A returned local variable is moved out instead of copied.
    fn moved_local(&self, value: &Expr) -> Option<TokenStream> {
        let ExprKind::Place(place) = &value.kind else { return None };
        let id = self.plain_local(place.root)?;
        let name = self.local(id);
        place.path.is_empty().then(|| quote!(#name))
    }

    /// The expression that the function returns for this value: `value`, `Ok(value)`, `Ok(())`, or nothing.
    pub(super) fn result(&self, value: Option<TokenStream>) -> Option<TokenStream> {
        let fails = self.func.is_some_and(|func| func.effects.fails);
        match (fails, value) {
            (true, Some(value)) => Some(quote!(Ok(#value))),
            (true, None) => Some(quote!(Ok(()))),
            (false, value) => value,
        }
    }

    /// The expression that the function returns if its end is reached.
    pub(super) fn end_result(&self) -> Option<TokenStream> {
        let result = self.func.map_or(Base::Void, |func| func.result);
        let value = (result != Base::Void).then(|| start_value(Type::scalar(result), self.family()));
        self.result(value)
    }
}

/// `Ok(call?)` becomes `call`.
pub(super) fn without_detour(value: &Fragment) -> Option<TokenStream> {
    let mut tokens: Vec<TokenTree> = value.tokens.clone().into_iter().collect();
    let asks = matches!(tokens.last(), Some(TokenTree::Punct(sign)) if sign.as_char() == '?');
    tokens.pop();
    (asks && value.precedence == Precedence::Postfix).then(|| tokens.into_iter().collect())
}

pub(super) fn is_unit(tokens: &TokenStream) -> bool {
    tokens.to_string().replace(' ', "") == "()"
}

/// Statements that end in the same manner in all branches give the function's result as an expression.
fn tail_of(stmt: &Stmt, tail: Tail) -> Tail {
    if tail == Tail::Function && flow::diverges(stmt) && switch::is_plain(stmt) { Tail::Function } else { Tail::Inner }
}

/// Whether the value does not show the type: `let x: i32 = 0`.
fn needs_annotation(ty: Type, value: Option<&Expr>) -> bool {
    let number = matches!(ty.base, Base::Int | Base::Uint | Base::Byte) && !ty.is_array();
    number && value.is_none_or(is_plain_number)
}

/// Whether a value is emitted as a number without a type.
fn is_plain_number(value: &Expr) -> bool {
    match &value.kind {
        ExprKind::Const(value) => matches!(value, Value::Int(_) | Value::Uint(_) | Value::Byte(_)),
        ExprKind::Assign(sides) => is_plain_number(&sides.1),
        _ => false,
    }
}
