//! Interrupts, timers and triggers: their conditions and actions become async closures that own what they need, since
//! they may run after the function that declares them has ended.

use super::body::Body;
use super::calls::{EmittedArgument, instruction_call};
use super::control_flow::Tail;
use super::fragment::Fragment;
use super::statements::{is_unit, without_detour};
use super::tokens::mentions;
use super::types::is_copy;
use crate::effects::captures;
use crate::hir::{Builtin, Expr, ExprKind, Passed, Type};
use crate::visit;
use arl_lang::catalog::{Base, Mode};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};
use std::collections::BTreeMap;

impl<'p> Body<'p, '_> {
    /// The declaration of an event.
    pub(super) fn event(&mut self, builtin: &'p Builtin) -> Fragment {
        let entry = builtin.entry;
        let moved = builtin.args.iter().any(|arg| !captures::is_later(entry, arg) && self.moves_pointer(arg));
        let (before, mut arguments) = self.arguments(builtin, moved);
        let line = moved.then(|| self.line_statement());
        for arg in builtin.args.iter().filter(|arg| captures::is_later(entry, arg)) {
            let Passed::Value(expr) = &arg.value else { continue };
            let mode = entry.params.get(arg.param).map(|param| param.mode);
            let closure = if mode == Some(Mode::Action) { self.action(expr) } else { self.watched(expr) };
            arguments.push(EmittedArgument { param: arg.param, value: Fragment::postfix(closure), back: None });
        }
        self.position.acts = true;
        let call = self.checked(instruction_call(entry, &arguments, quote!(run)));
        Fragment::postfix(call).after(quote!(#before #line))
    }

    /// `async |cx: &Cx| Ok(condition)`
    fn watched(&mut self, expr: &'p Expr) -> TokenStream {
        let value = self.apart(|body| body.value(expr));
        let before = &value.before;
        // A condition that changes something by being evaluated may never come to rest.
        let goes_on = self.changes_something(expr).then(|| quote!(cx.goes_on();));
        let result = without_detour(&value).unwrap_or_else(|| {
            let value = &value.tokens;
            quote!(Ok(#value))
        });
        self.closure(expr, quote!(#goes_on #before), result)
    }

    /// `async |cx: &Cx| action.await`
    fn action(&mut self, expr: &'p Expr) -> TokenStream {
        let (code, result) = self.apart(|body| {
            if !matches!(expr.kind, ExprKind::Call(..) | ExprKind::Builtin(_)) {
                return (body.effect(expr, Tail::Inner), None);
            }
            body.position.acts = false;
            let value = body.value(expr);
            let (before, pointer) = (value.before.clone(), body.pointer());
            match without_detour(&value).filter(|_| expr.ty.base == Base::Void) {
                Some(result) => (quote!(#pointer #before), Some(result)),
                None if value.settled && is_unit(&value.tokens) => (quote!(#pointer #before), None),
                None => {
                    let (keep, tokens) = ((expr.ty.base != Base::Void).then(|| quote!(let _ =)), &value.tokens);
                    (quote!(#pointer #before #keep #tokens;), None)
                }
            }
        });
        self.closure(expr, code, result.unwrap_or_else(|| quote!(Ok(()))))
    }

    /// Emits code that runs at another time than the code around it.
    fn apart<R>(&mut self, emit: impl FnOnce(&mut Self) -> R) -> R {
        let acts = self.position.acts;
        let result = self.with_own_temporaries(emit);
        self.position.acts = acts;
        result
    }

    fn closure(&self, expr: &Expr, code: TokenStream, result: TokenStream) -> TokenStream {
        let globals = (mentions(&code, "g") || mentions(&result, "g")).then(|| {
            let found = self.checked(quote!(cx.globals()));
            quote!(let g: &Globals = #found;)
        });
        let body = quote!(#globals #code);
        let cx = if mentions(&body, "cx") || mentions(&result, "cx") { quote!(cx) } else { quote!(_) };
        let body = if body.is_empty() { result } else { quote!({ #body #result }) };
        let taken = self.taken_along(expr);
        let moves = (!taken.is_empty() || self.position.columns.are_in(&body)).then(|| quote!(move));
        let closure = quote!(async #moves |#cx: &Cx| #body);
        let own: TokenStream = taken.into_values().flatten().collect();
        if own.is_empty() { closure } else { quote!({ #own #closure }) }
    }

    /// What a closure captures, each with the statement that makes an owned value of it, if needed.
    fn taken_along(&self, expr: &Expr) -> BTreeMap<String, Option<TokenStream>> {
        let cloned = |name: Ident, ty: Type, shared: bool| {
            let own = match shared {
                true => Some(quote!(let #name = Rc::clone(&#name);)),
                false => (!is_copy(ty)).then(|| quote!(let #name = #name.clone();)),
            };
            (name.to_string(), own)
        };
        let locals = captures::mentioned(expr).into_iter().filter_map(|id| {
            let local = self.func?.locals.get(id.0 as usize)?;
            Some(cloned(self.local(id), local.ty, local.shared))
        });
        let mut taken: BTreeMap<_, _> = locals.collect();
        visit::exprs(expr, &mut |expr| {
            if let ExprKind::Splice(number) = expr.kind {
                taken.extend([cloned(format_ident!("splice_{number}"), expr.ty, false)]);
            }
        });
        taken
    }
}
