//! The initial values of variables stored in an array.

use super::body::Body;
use super::rows::{Entry, Hole, Lead, Shape, of_value};
use super::types::start_value;
use super::unit::Unit;
use crate::hir::{Expr, GlobalId, ModuleId};
use proc_macro2::TokenStream;
use quote::quote;

/// A variable with its initial value.
struct First<'p> {
    /// Its number in the array.
    at: usize,
    init: Option<&'p Expr>,
    shape: Shape,
    holes: Vec<Hole<'p>>,
}

/// The code that initialises variables of one array: a table.
pub(super) fn first_values(unit: &Unit<'_>, module: ModuleId, members: &[GlobalId]) -> TokenStream {
    let Some((array, _)) = members.first().and_then(|id| unit.slots.of(*id)) else { return TokenStream::new() };
    let family = unit.family();
    let firsts: Vec<First<'_>> = members
        .iter()
        .filter_map(|id| {
            let init = unit.program.globals.get(id.0 as usize)?.init.as_ref();
            let (shape, holes) = init.map(|init| of_value(init, family)).unwrap_or_default();
            Some(First { at: unit.slots.of(*id)?.1, init, shape, holes })
        })
        .collect();
    let entries: Vec<Entry<'_, '_>> =
        firsts.iter().map(|first| Entry { lead: first.at, shape: &first.shape, holes: &first.holes }).collect();
    let mut body = Body::outside(unit, module);
    let span = members.first().and_then(|id| unit.program.globals.get(id.0 as usize)).map(|global| global.span);
    let comment = span.map(|span| body.comment(span));
    let (name, field) = (body.reserve("at"), &array.field);
    let module = unit.names.module(module);
    let code = body.tabulate(
        &entries,
        Lead { name: &name, ty: &quote!(usize) },
        &|_, _| "Value".to_owned(),
        &mut |body, number| {
            let init = firsts.get(number).and_then(|first| first.init);
            let value = match init {
                Some(init) => body.value(init).tokens,
                None => start_value(array.ty, family),
            };
            quote!(g.#module.#field[#name].set(#value);)
        },
    );
    quote!(#comment #code)
}
