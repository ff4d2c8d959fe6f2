//! Functions: signature, attributes, body.

use super::body::{Body, Unit};
use super::statements::Tail;
use super::types::{base_type, rust_type};
use crate::effects::flow;
use crate::hir::{Func, FuncId};
use arl_lang::catalog::Base;
use proc_macro2::TokenStream;
use quote::quote;

/// One function of the program.
pub(super) fn function(unit: &Unit<'_>, id: FuncId, func: &Func) -> TokenStream {
    let mut body = Body::of_function(unit, func);
    let family = unit.family();
    let comment = body.comment(func.span);
    let effects = func.effects;
    let name = unit.names.func(id.0);
    let waits = effects.waits.then(|| quote!(async));
    let cx = effects.context.then(|| quote!(cx: &Cx,));
    let g = effects.globals.then(|| quote!(g: &Globals,));
    let params: Vec<TokenStream> = func
        .params
        .iter()
        .map(|param| {
            let (mutable, name) = (body.mutable(*param), body.local(*param));
            let ty = func.locals.get(param.0 as usize).map(|local| rust_type(local.ty, family));
            quote!(#mutable #name: #ty)
        })
        .collect();
    let value = (func.result != Base::Void).then(|| base_type(func.result, family));
    let result = match (effects.fails, value) {
        (true, Some(value)) => quote!(-> Done<#value>),
        (true, None) => quote!(-> Done<()>),
        (false, Some(value)) => quote!(-> #value),
        (false, None) => TokenStream::new(),
    };
    body.stand_at(func.span);
    let depth = effects.recursive.then(|| {
        let enter = body.checked(quote!(cx.enter()));
        quote!(let _depth = #enter;)
    });
    let statements = if func.has_goto {
        body.machine(func)
    } else {
        let statements = body.block(&func.body, Tail::Function);
        if flow::block_diverges(&func.body) {
            statements
        } else {
            let end = body.end_result();
            quote!(#statements #end)
        }
    };
    let wastes = body.usage.wastes.then(|| quote!(#[allow(unused_assignments)]));
    let unused = (unit.reached.get(id.0 as usize) != Some(&true)).then(|| quote!(#[allow(dead_code)]));
    let drops = body.usage.drops.then(|| quote!(#[allow(unused_mut, unused_variables)]));
    quote! {
        #comment
        #drops
        #unused
        #wastes
        pub #waits fn #name(#cx #g #(#params),*) #result {
            #depth
            #statements
        }
    }
}
