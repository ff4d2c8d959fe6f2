//! The global variables of a module: their structure, their initial values, and the slots for values that are read
//! again on load.

use super::body::Body;
use super::consts::typed_constant;
use super::fragment::Fragment;
use super::places::{Calm, Written};
use super::points;
use super::slots::{SlotArray, is_constant};
use super::slots_init;
use super::tokens::mentions;
use super::types::{is_handle, rust_type, start_value, variable_type};
use super::unit::Unit;
use crate::hir::{Expr, ExprKind, Global, GlobalId, ModuleId, Place, Root, Value};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use std::collections::HashMap;

/// The number of variables initialised in one function; beyond it, rustc's time grows faster than the length.
const MOST_IN_ONE: usize = 64;

/// What a call that initialises variables needs.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Init {
    waits: bool,
    fails: bool,
    context: bool,
}

/// The variables of a module that are variables in Rust, too: constants with a known value are written where they are
/// used.
pub(super) fn of_module<'p>(unit: &Unit<'p>, module: ModuleId) -> Vec<(GlobalId, &'p Global)> {
    let globals = unit.program.globals.iter().enumerate();
    globals
        .filter(|(_, global)| global.module == module && global.value.is_none())
        .map(|(at, global)| (GlobalId(at as u32), global))
        .collect()
}

/// `pub struct Variables { .. }`
pub(super) fn structure(unit: &Unit<'_>, module: ModuleId, globals: &[(GlobalId, &Global)]) -> TokenStream {
    let family = unit.family();
    let file = unit.program.modules.get(module.0 as usize).map_or("", |module| module.file.as_str());
    let doc = format!(" The global variables of `{file}`.");
    let alone = globals.iter().filter(|(id, _)| unit.slots.of(*id).is_none());
    let fields = alone.map(|(id, global)| {
        let (name, ty) = (unit.names.global(id.0), variable_type(global.ty, family));
        quote!(pub #name: #ty)
    });
    let arrays = unit.slots.of_module(module).map(|array| {
        let (name, ty) = (&array.field, rust_type(array.ty, family));
        let count = Literal::usize_unsuffixed(array.members.len());
        quote!(pub #name: Slots<#ty, #count>)
    });
    let places = places(unit, module);
    quote! {
        #[doc = #doc]
        #[derive(Default)]
        pub struct Variables {
            #(#fields,)*
            #(#arrays,)*
        }
        #places
    }
}

/// `pub mod at { .. }`: the positions of the variables in their arrays.
fn places(unit: &Unit<'_>, module: ModuleId) -> Option<TokenStream> {
    let places: Vec<TokenStream> = unit
        .slots
        .of_module(module)
        .flat_map(|array| array.members.iter().enumerate())
        .map(|(at, id)| {
            let (name, at) = (unit.names.global(id.0), Literal::usize_unsuffixed(at));
            quote!(pub const #name: usize = #at;)
        })
        .collect();
    let blank = unit.marks.comment(String::new());
    (!places.is_empty()).then(|| {
        quote! {
            #blank
            /// Where variables are in their arrays.
            #[allow(non_upper_case_globals, dead_code)]
            pub mod at {
                #(#places)*
            }
        }
    })
}

/// The functions that give the variables their first values.
pub(super) fn init(unit: &Unit<'_>, module: ModuleId, globals: &[(GlobalId, &Global)]) -> (TokenStream, Init) {
    let mut all = Init::default();
    let mut parts = Vec::new();
    for chunk in steps(unit, globals).chunks(MOST_IN_ONE) {
        let mut code = TokenStream::new();
        let mut part = Init::default();
        for step in chunk {
            let (id, global) = match step {
                Step::Alone(id, global) => (id, global),
                Step::Array(members) => {
                    code.extend(slots_init::first_values(unit, module, members));
                    continue;
                }
            };
            code.extend(first_value(unit, module, *id, global));
            if let Some(init) = &global.init {
                let facts = Body::outside(unit, module).facts(init);
                part.waits |= facts.waits;
                part.fails |= facts.fails;
                part.context |= facts.context;
            }
        }
        all.waits |= part.waits;
        all.fails |= part.fails;
        all.context |= part.context;
        parts.push((part, code));
    }
    if let [(part, code)] = parts.as_slice() {
        let function = init_function(quote!(pub), "init", *part, code, "Gives all variables their first values.");
        return (quote!(impl Variables { #function }), all);
    }
    let mut functions = TokenStream::new();
    let mut calls = TokenStream::new();
    for (at, (part, code)) in parts.iter().enumerate() {
        let name = format!("init_{}", at + 1);
        // Otherwise they would be merged into one function, whose compilation takes more than twice as long for twice
        // as many variables.
        if !part.waits {
            functions.extend(quote!(#[inline(never)]));
        }
        functions.extend(init_function(TokenStream::new(), &name, *part, code, ""));
        calls.extend(init_call(&quote!(Self), &name, *part));
    }
    let whole = init_function(quote!(pub), "init", all, &calls, "Gives all variables their first values.");
    (quote!(impl Variables { #whole #functions }), all)
}

/// The variables that are initialised in one step.
enum Step<'p> {
    Alone(GlobalId, &'p Global),
    /// Variables of one array.
    Array(Vec<GlobalId>),
}

/// The steps in which the variables are initialised. Those of arrays are deferred until other code may read them.
fn steps<'p>(unit: &Unit<'p>, globals: &[(GlobalId, &'p Global)]) -> Vec<Step<'p>> {
    let mut steps = Vec::new();
    let mut waiting: Vec<Vec<GlobalId>> = Vec::new();
    let mut fields: HashMap<String, usize> = HashMap::new();
    for (id, global) in globals {
        let Some((array, _)) = unit.slots.of(*id) else {
            if !global.init.as_ref().is_none_or(is_constant) {
                steps.extend(waiting.drain(..).map(Step::Array));
                fields.clear();
            }
            steps.push(Step::Alone(*id, global));
            continue;
        };
        let next = waiting.len();
        let at = *fields.entry(array.field.to_string()).or_insert(next);
        if at == next {
            waiting.push(Vec::new());
        }
        waiting.get_mut(at).into_iter().for_each(|members| members.push(*id));
    }
    steps.extend(waiting.into_iter().map(Step::Array));
    steps
}

fn init_function(vis: TokenStream, name: &str, init: Init, code: &TokenStream, doc: &str) -> TokenStream {
    let name = format_ident!("{name}");
    let waits = init.waits.then(|| quote!(async));
    let cx = init.context.then(|| quote!(cx: &Cx,));
    let g = if mentions(code, "g") { quote!(g) } else { quote!(_g) };
    let (result, end) = if init.fails { (quote!(-> Done<()>), quote!(Ok(()))) } else { Default::default() };
    let doc = (!doc.is_empty()).then(|| {
        let doc = format!(" {doc}");
        quote!(#[doc = #doc])
    });
    quote! {
        #doc
        #vis #waits fn #name(#cx #g: &Globals) #result {
            #code
            #end
        }
    }
}

/// The call of an `init` function inside a function that takes `cx` and `g`.
pub(super) fn init_call(owner: &TokenStream, name: &str, init: Init) -> TokenStream {
    let name = format_ident!("{name}");
    let cx = init.context.then(|| quote!(cx,));
    let wait = init.waits.then(|| quote!(.await));
    let ask = init.fails.then(|| quote!(?));
    quote!(#owner::#name(#cx g)#wait #ask;)
}

/// The statement that initialises a variable.
fn first_value(unit: &Unit<'_>, module: ModuleId, id: GlobalId, global: &Global) -> TokenStream {
    if is_handle(global.ty) {
        return TokenStream::new();
    }
    let mut body = Body::outside(unit, module);
    body.stand_at(global.span);
    let comment = body.comment(global.span);
    let place = Place { root: Root::Global(id), path: Vec::new(), ty: global.ty, span: global.span };
    let reached = body.reached(&place, []);
    let value = match &global.init {
        Some(Expr { kind: ExprKind::Array(values), .. }) if points::is_large(global.ty, values) => {
            let code = points::table(&mut body, global.ty, values);
            let pointer = body.pointer();
            Fragment { before: TokenStream::new(), ..code.clone() }.after({
                let before = &code.before;
                quote!(#pointer #before)
            })
        }
        Some(init) => {
            let value = body.value(init);
            let pointer = body.pointer();
            value.after(pointer)
        }
        None => Fragment::postfix(start_value(global.ty, unit.family())),
    };
    let write = body.write(&reached, Written::Value(value), Calm::Local);
    quote!(#comment #write)
}

/// `fn data(&self) -> DataFile<'_>`: the variables of a data file that are read again on load.
pub(super) fn data(unit: &Unit<'_>, module: ModuleId) -> TokenStream {
    let values = listed(unit, module, &|global| global.teachable, &|array| array.teachable);
    quote! {
        impl Variables {
            /// The variables whose values are read again at load.
            pub fn data(&self) -> DataFile<'_> {
                #values
            }
        }
    }
}

/// `fn all(&self) -> DataFile<'_>`: all variables, for code that knows them by name.
pub(super) fn all(unit: &Unit<'_>, module: ModuleId) -> TokenStream {
    let shows = |global: &Global| !is_handle(global.ty);
    let values = listed(unit, module, &shows, &|_| true);
    quote! {
        impl Variables {
            /// All variables.
            pub fn all(&self) -> DataFile<'_> {
                #values
            }
        }
    }
}

/// The sizes of a multidimensional array; empty for other arrays.
fn sizes_of_table(global: &Global) -> Vec<Literal> {
    match global.ty.dims() {
        dims if dims.len() > 1 => dims.iter().map(|size| Literal::u16_unsuffixed(*size)).collect(),
        _ => Vec::new(),
    }
}

/// A list of the wanted variables of a module.
fn listed(
    unit: &Unit<'_>,
    module: ModuleId,
    wanted: &dyn Fn(&Global) -> bool,
    wanted_array: &dyn Fn(&SlotArray) -> bool,
) -> TokenStream {
    let file = unit.program.modules.get(module.0 as usize).map_or("", |module| module.file.as_str());
    let globals = unit.program.globals.iter().enumerate();
    let alone = globals.filter(|(at, global)| {
        global.module == module && wanted(global) && unit.slots.of(GlobalId(*at as u32)).is_none()
    });
    let vars = alone.map(|(at, global)| {
        let name = &global.name;
        let sizes = sizes_of_table(global);
        let slot = match &global.value {
            Some(value) => fixed(value),
            None => {
                let field = unit.names.global(at as u32);
                quote!(&self.#field)
            }
        };
        quote!(DataVar { name: #name, sizes: &[#(#sizes),*], slot: #slot })
    });
    let vars = quote!(Vec::from([#(#vars),*]));
    let arrays: Vec<TokenStream> = unit
        .slots
        .of_module(module)
        .filter(|array| wanted_array(array))
        .map(|array| {
            let name =
                |id: &GlobalId| unit.program.globals.get(id.0 as usize).map_or("", |global| global.name.as_str());
            let rows = array.members.iter().map(|id| format!("{},\n", Literal::string(name(id)))).collect();
            let (rows, field) = (unit.marks.rows(rows), &array.field);
            let count = Literal::usize_unsuffixed(array.members.len());
            quote! {
                {
                    static NAMES: [&str; #count] = #rows;
                    vars.extend(self.#field.named(&NAMES));
                }
            }
        })
        .collect();
    if arrays.is_empty() {
        quote!(DataFile { file: #file, vars: #vars })
    } else {
        quote!(let mut vars = #vars; #(#arrays)* DataFile { file: #file, vars })
    }
}

/// A constant in a data file: its value is part of the compiled program, so a different value there is refused.
fn fixed(value: &Value) -> TokenStream {
    let value = match value {
        Value::String(text) => quote!(#text),
        value => typed_constant(value).tokens,
    };
    quote!(&Fixed(#value))
}
