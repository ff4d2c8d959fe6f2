//! Built-ins that are not plain calls: `waituntil`, whose condition is evaluated repeatedly, and those that end the
//! program.

use super::body::Body;
use super::calls::instruction_call;
use super::fragment::{Fragment, Precedence};
use super::places::{Calm, Written};
use super::sequence::Mode;
use crate::effects::pointer;
use crate::hir::{Builtin, Expr, Passed, Place};
use arl_lang::catalog::{Form, Mode as ParamMode};
use proc_macro2::TokenStream;
use quote::quote;

impl<'p> Body<'p, '_> {
    /// The code for a special form; `None` if the general rule applies.
    pub(super) fn special(&mut self, builtin: &'p Builtin) -> Option<Fragment> {
        let nothing = || Fragment::settled(quote!(()));
        match builtin.entry.form {
            Form::Call | Form::TypeOf => None,
            Form::Exit | Form::Restart => {
                let stop = ending(builtin);
                Some(nothing().after(quote!(return Err(#stop);)))
            }
            Form::WaitUntil => Some(nothing().after(self.waituntil(builtin))),
            Form::Jump => self.jump_with_sig(builtin),
            Form::Event => Some(self.event(builtin)),
        }
    }

    /// A `jump` that checks its `sig` above the target; `None` if `sig` is always false.
    fn jump_with_sig(&mut self, builtin: &'p Builtin) -> Option<Fragment> {
        let entry = builtin.entry;
        let condition = pointer::condition(builtin)?;
        let moved = builtin.args.iter().any(|arg| self.moves_pointer(arg));
        let (before, arguments) = self.arguments(builtin, moved);
        let line = moved.then(|| self.line_statement());
        let call = instruction_call(entry, &arguments, quote!(above));
        let above = self.checked(quote!(#call.await));
        let name = self.fresh(entry.name);
        let unmet = self.negated(condition);
        self.position.acts = true;
        let (first, unmet) = (&unmet.before, &unmet.tokens);
        let sink = self.checked(quote!(#name.sink(cx).await));
        let all = quote!(#before #line let #name = #above; #first if #unmet { #line #sink; });
        Some(Fragment::settled(quote!(())).after(all))
    }

    fn waituntil(&mut self, builtin: &'p Builtin) -> TokenStream {
        let (mut condition, mut limit, mut flag): (Option<&'p Expr>, Option<&'p Expr>, Option<&'p Place>) =
            Default::default();
        for arg in &builtin.args {
            let mode = builtin.entry.params.get(arg.param).map(|param| param.mode);
            match &arg.value {
                Passed::Value(value) if mode == Some(ParamMode::Condition) => condition = Some(value),
                Passed::Value(value) => limit = Some(value),
                Passed::Out(place) => flag = Some(place),
            }
        }
        let limit = limit.map(|limit| self.expression(limit, Mode::Value));
        let limit_before = limit.as_ref().map(|limit| limit.before.clone());
        let maxtime = limit.as_ref().map(|limit| {
            let seconds = &limit.tokens;
            quote!(.maxtime(#seconds))
        });
        self.position.acts = true;
        let start = self.checked(quote!(flow::waituntil(cx)#maxtime.start().await));
        let late = limit.is_some().then(|| self.fresh("wait"));
        let start = match &late {
            Some(wait) => quote!(#limit_before let #wait = #start;),
            None => quote!(#start;),
        };
        let Some(condition) = condition else { return start };
        let next = self.next_look(condition, limit.is_some());
        let met = self.on_trial(|body| body.value(condition));
        let Some(flag) = flag else {
            if !met.before.is_empty() {
                let (before, met) = (&met.before, &met.tokens);
                let late = late.map(|wait| quote!(if #wait.late() { break; }));
                return quote!(#start loop { #before if #met { break; } #late #next });
            }
            let unmet = self.negated(condition).at(Precedence::And);
            let late = late.map(|wait| quote!(&& !#wait.late()));
            return quote!(#start while #unmet #late { #next });
        };
        let (before, met) = (&met.before, &met.tokens);
        let late = late.map(|wait| quote!(if #wait.late() { break true; }));
        let waiting = Fragment::postfix(quote!(loop { #before if #met { break false; } #late #next }));
        let (flag_before, indices) = self.sequence(&Self::index_operands(flag), |_| true);
        let reached = self.reached(flag, indices);
        let waiting = match self.plain_local(flag.root) {
            Some(_) => waiting,
            None => self.settle(waiting, "timed_out"),
        };
        if let Some(declared) = self.deferred_let(flag, None) {
            return quote!(#start #declared = #waiting;);
        }
        let write = self.write(&reached, Written::Value(waiting), Calm::Local);
        quote!(#start #flag_before #write)
    }

    /// Waits until the condition is to be evaluated again. If evaluating it changes something, or if a time limit ends
    /// the wait, the program does more than wait.
    fn next_look(&self, condition: &Expr, is_limited: bool) -> TokenStream {
        match is_limited || self.changes_something(condition) {
            true => quote!(cx.next_cycle().await;),
            false => quote!(cx.change().await;),
        }
    }

    /// Whether evaluating a condition changes something.
    pub(super) fn changes_something(&self, condition: &Expr) -> bool {
        let facts = self.facts(condition);
        facts.changes || !facts.writes.is_empty()
    }
}

/// The reason why the program ends.
pub(super) fn ending(builtin: &Builtin) -> TokenStream {
    if builtin.entry.form == Form::Restart { quote!(Stop::restart()) } else { quote!(Stop::exit()) }
}
