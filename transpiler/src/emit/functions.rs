//! Functions: signature, attributes, body.

use super::body::Body;
use super::control_flow::Tail;
use super::mentions;
use super::tokens::mentions;
use super::types::{base_type, is_number, rust_type};
use super::unit::Unit;
use crate::effects::{flow, recursion};
use crate::hir::{Func, FuncId, LocalId, Stmt, StmtKind};
use arl_lang::catalog::Base;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// The maximum number of statements that are compiled into every call of a recursive function.
const MOST_SHALLOW: usize = 8;

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
    let guard = effects.recursive.then(|| body.entered(func));
    let statements = if func.has_goto {
        let machine = body.machine(func);
        quote!(#guard #machine)
    } else {
        // Only right before the function calls itself: most calls end without doing so.
        body.form.guard = guard;
        match body.shallow(func) {
            0 => body.until_end(&func.body),
            shallow => body.deeper(func, shallow, &result),
        }
    };
    let shared = body.shared_parameters(&func.params);
    let inlined = body.form.inlined.then(|| quote!(#[inline(always)]));
    let wastes = body.locals.usage.wastes.then(|| quote!(#[allow(unused_assignments)]));
    let unused = (unit.reached.get(id.0 as usize) != Some(&true)).then(|| quote!(#[allow(dead_code)]));
    let drops = body.locals.usage.drops.then(|| quote!(#[allow(unused_mut, unused_variables)]));
    quote! {
        #comment
        #drops
        #unused
        #wastes
        #inlined
        pub #waits fn #name(#cx #g #(#params),*) #result {
            #shared
            #statements
        }
    }
}

impl<'p> Body<'p, '_> {
    /// `let _entered = cx.enter(1, text.len() + 4000).at(FILE, 3)?;`, with the weight of the function and the size of
    /// the strings and arrays passed to it.
    fn entered(&mut self, func: &Func) -> TokenStream {
        let mut handed: Vec<TokenStream> = func.params.iter().filter_map(|id| self.handed_bytes(func, *id)).collect();
        if handed.is_empty() {
            handed.push(quote!(0));
        }
        let weight = Literal::u32_unsuffixed(recursion::weight(func, self.family()));
        let entered = self.reserve("_entered");
        let enter = self.checked(quote!(cx.enter(#weight, #(#handed)+*)));
        quote!(let #entered = #enter;)
    }

    /// How many bytes a string or an array takes in addition to its parameter.
    fn handed_bytes(&self, func: &Func, id: LocalId) -> Option<TokenStream> {
        let ty = func.locals.get(id.0 as usize)?.ty;
        let name = self.local(id);
        if ty.is_array() {
            let size = Literal::usize_unsuffixed(ty.bytes(self.family()));
            return Some(quote!(#size));
        }
        let text = ty.base == Base::String && self.locals.usage.is_read(id);
        text.then(|| if self.is_shared(id) { quote!(#name.with(|text| text.len())) } else { quote!(#name.len()) })
    }

    /// The statements up to the end of the function.
    fn until_end(&mut self, block: &'p [Stmt]) -> TokenStream {
        let statements = self.block(block, Tail::Function);
        if flow::block_diverges(block) {
            statements
        } else {
            let end = self.end_result();
            quote!(#statements #end)
        }
    }

    /// The number of statements at the start of a recursive function that decide whether it calls itself. Compiling
    /// them into the callers saves half of all calls.
    fn shallow(&self, func: &Func) -> usize {
        let numbers = func.params.iter().all(|param| {
            !self.locals.usage.is_mutable(*param)
                && !self.is_shared(*param)
                && func.locals.get(param.0 as usize).is_some_and(|local| is_number(local.ty))
        });
        if !func.effects.recursive || func.effects.waits || !numbers {
            return 0;
        }
        let decides = |stmt: &&Stmt| matches!(stmt.kind, StmtKind::If(..)) && !self.calls_itself(stmt);
        let shallow: Vec<&Stmt> = func.body.iter().take_while(decides).collect();
        let length: usize = shallow.iter().map(|stmt| length(stmt)).sum();
        if length > MOST_SHALLOW || shallow.len() == func.body.len() { 0 } else { shallow.len() }
    }

    /// The first statements, followed by the others in a function of their own.
    fn deeper(&mut self, func: &'p Func, shallow: usize, result: &TokenStream) -> TokenStream {
        let (first, rest) = func.body.split_at(shallow);
        let guard = self.form.guard.take();
        let first = self.block(first, Tail::Inner);
        self.form.guard = guard;
        let rest_code = self.until_end(rest);
        let name = self.fresh("deeper");
        let used = func.params.iter().filter(|param| rest.iter().any(|stmt| mentions::in_statement(stmt, **param)));
        let (mut params, mut args) = (TokenStream::new(), TokenStream::new());
        if mentions(&rest_code, "g") {
            params.extend(quote!(g: &Globals,));
            args.extend(quote!(g,));
        }
        for param in used {
            let (name, ty) = (self.local(*param), func.locals.get(param.0 as usize).map(|local| local.ty));
            let ty = ty.map(|ty| rust_type(ty, self.family()));
            params.extend(quote!(#name: #ty,));
            args.extend(quote!(#name,));
        }
        self.form.inlined = true;
        // Passing the result on as it is would hide from LLVM that the code compiled into the callers cannot fail.
        let end = if func.result == Base::Void {
            quote!(return #name(cx, #args);)
        } else {
            let value = self.fresh("value");
            quote!(let #value = #name(cx, #args)?; return Ok(#value);)
        };
        quote! {
            #first
            #end

            #[doc = " What is left when the function calls itself. The lines above are compiled into its callers."]
            fn #name(cx: &Cx, #params) #result {
                #rest_code
            }
        }
    }
}

/// The number of statements, including inner ones.
fn length(stmt: &Stmt) -> usize {
    1 + flow::blocks(stmt).flatten().map(length).sum::<usize>()
}
