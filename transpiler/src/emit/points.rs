//! Large tables: rustc's time grows faster than the length of an array literal of structures, so these are filled in
//! pieces.

use super::body::Body;
use super::fragment::Fragment;
use super::sequence::{Mode, OrderedOperand};
use super::types::start_value;
use crate::hir::{Expr, ExprKind, Type};
use arl_lang::catalog::Base;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// The number of structures or strings in one literal.
const PIECE: usize = 16;

/// Whether the initialiser of an array is filled in pieces.
pub(super) fn is_large(ty: Type, values: &[Expr]) -> bool {
    let plain = !matches!(ty.base, Base::Struct(_) | Base::String);
    let constants = values.iter().all(|value| matches!(value.kind, ExprKind::Const(_)));
    values.len() > if plain && constants { 4096 } else { PIECE }
}

/// The array, with the statements that fill it.
pub(super) fn table<'p>(body: &mut Body<'p, '_>, ty: Type, values: &'p [Expr]) -> Fragment {
    let start = start_value(ty, body.family());
    let name = body.fresh("table");
    let piece = if matches!(ty.base, Base::Struct(_) | Base::String) { PIECE } else { 512 };
    let mut code = TokenStream::new();
    for (at, values) in values.chunks(piece).enumerate() {
        let from = Literal::usize_unsuffixed(at * piece);
        let to = Literal::usize_unsuffixed(at * piece + values.len());
        let operands: Vec<_> = values.iter().map(|value| OrderedOperand::Expr(value, Mode::Value)).collect();
        let (before, fragments) = body.sequence(&operands, |_| false);
        let tokens = fragments.iter().map(|fragment| &fragment.tokens);
        code.extend(quote!(#before #name[#from..#to].clone_from_slice(&[#(#tokens),*]);));
    }
    Fragment { before: quote!(let mut #name = #start; #code), ..Fragment::settled(quote!(#name)) }
}
