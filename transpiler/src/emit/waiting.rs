//! Built-ins that are no plain call: `waituntil`, whose condition is evaluated again and again, and those that end the
//! program.

use super::body::Body;
use super::fragment::{Fragment, Precedence};
use super::places::Written;
use super::sequence::Mode;
use crate::hir::{Builtin, Expr, Passed, Place};
use arl_lang::catalog::{Effect, Mode as ParamMode};
use proc_macro2::TokenStream;
use quote::quote;

impl<'p> Body<'p, '_> {
    /// The code for a special form; `None` where the general rule holds.
    pub(super) fn special(&mut self, builtin: &'p Builtin) -> Option<Fragment> {
        let entry = builtin.entry;
        if entry.effect == Effect::Ends {
            let stop = ending(builtin);
            return Some(Fragment::settled(quote!(())).after(quote!(return Err(#stop);)));
        }
        let repeated = entry.params.iter().any(|param| matches!(param.mode, ParamMode::Condition | ParamMode::Action));
        if !repeated {
            return None;
        }
        if entry.name == "waituntil" {
            return Some(Fragment::settled(quote!(())).after(self.waituntil(builtin)));
        }
        let text = format!("{} cannot be emitted yet", entry.name);
        Some(Fragment::postfix(quote!(compile_error!(#text))))
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
        let start = self.checked(quote!(flow::waituntil(cx)#maxtime.start().await));
        let late = limit.is_some().then(|| self.fresh("wait"));
        let start = match &late {
            Some(wait) => quote!(#limit_before let #wait = #start;),
            None => quote!(#start;),
        };
        let condition = match condition {
            Some(condition) => self.value(condition),
            None => Fragment::settled(quote!(true)),
        };
        let (before, met) = (&condition.before, &condition.tokens);
        let next = quote!(cx.next_cycle().await;);
        let Some(flag) = flag else {
            if !before.is_empty() {
                let late = late.map(|wait| quote!(if #wait.late() { break; }));
                return quote!(#start loop { #before if #met { break; } #late #next });
            }
            let unmet = condition.at(Precedence::Unary);
            let late = late.map(|wait| quote!(&& !#wait.late()));
            return quote!(#start while !#unmet #late { #next });
        };
        let late = late.map(|wait| quote!(if #wait.late() { break true; }));
        let timed_out = self.fresh("timed_out");
        let indices = Self::index_operands(flag);
        let (flag_before, indices) = self.sequence(&indices, |_| true);
        let reached = self.reached(flag, indices);
        let write = self.write(&reached, Written::Value(Fragment::settled(quote!(#timed_out))), true);
        quote! {
            #start
            let #timed_out = loop { #before if #met { break false; } #late #next };
            #flag_before
            #write
        }
    }
}

/// Why the program ends.
pub(super) fn ending(builtin: &Builtin) -> TokenStream {
    if builtin.entry.name.eq_ignore_ascii_case("restart") { quote!(Stop::Restart) } else { quote!(Stop::Exit) }
}
