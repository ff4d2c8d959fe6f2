//! The file as a whole: a module for each ARL file, all variables, and what the controller runs.

use super::tokens::mentions;
use super::unit::Unit;
use super::variables::{self, Init};
use super::{functions, names};
use crate::hir::{Expr, ExprKind, FuncId, Module, ModuleId};
use crate::visit;
use arl_lang::catalog::Family;
use proc_macro2::TokenStream;
use quote::quote;

/// The contents of a module.
struct Parts {
    id: ModuleId,
    /// The initialisation, if there are variables.
    init: Option<Init>,
    /// Whether there is a `Variables` structure.
    variables: bool,
    /// Whether values are read again on load.
    data: bool,
}

/// All items of the file.
pub(super) fn items(unit: &Unit<'_>) -> TokenStream {
    let mut modules = TokenStream::new();
    let mut parts = Vec::new();
    for (at, module) in unit.program.modules.iter().enumerate() {
        let id = ModuleId(at as u32);
        let (tokens, part) = one_module(unit, id, module);
        modules.extend(tokens);
        parts.push(part);
    }
    let inits = init_calls(unit, &parts);
    let globals = globals(unit, &parts, &inits);
    let program = program(unit, &parts, &inits);
    quote!(#modules #globals #program)
}

pub(super) fn blank(unit: &Unit<'_>) -> TokenStream {
    unit.marks.comment(String::new())
}

fn one_module(unit: &Unit<'_>, id: ModuleId, module: &Module) -> (TokenStream, Parts) {
    let own = variables::of_module(unit, id);
    let teachable = unit.program.globals.iter().any(|global| global.module == id && global.teachable);
    let data = module.data && teachable;
    let mut content = TokenStream::new();
    let mut init = None;
    if !own.is_empty() || data {
        content.extend(blank(unit));
        content.extend(variables::structure(unit, id, &own));
    }
    if !own.is_empty() {
        let (code, needs) = variables::init(unit, id, &own);
        content.extend(blank(unit));
        content.extend(code);
        init = Some(needs);
    }
    if data {
        content.extend(blank(unit));
        content.extend(variables::data(unit, id));
    }
    if unit.named && (!own.is_empty() || data) {
        content.extend(blank(unit));
        content.extend(variables::all(unit, id));
    }
    for (at, func) in unit.program.funcs.iter().enumerate().filter(|(_, func)| func.module == id) {
        content.extend(blank(unit));
        content.extend(functions::function(unit, FuncId(at as u32), func));
    }
    for item in unit.templates.items(id) {
        content.extend(blank(unit));
        content.extend(item.clone());
    }
    let file = &module.file;
    let uses_globals = mentions(&content, "Globals").then(|| {
        quote!(
            use super::Globals;
        )
    });
    let uses_prelude = names::mentions_prelude(&content).then(|| {
        quote!(
            use arl_rt::emit::*;
        )
    });
    let names_file = mentions(&content, "FILE").then(|| {
        let blank = blank(unit);
        quote!(#blank const FILE: File = File::new(#file);)
    });
    let name = unit.names.module(id);
    let doc = format!(" `{file}`");
    let between = blank(unit);
    let parts = Parts { id, init, variables: !own.is_empty() || data, data };
    let tokens = quote! {
        #[doc = #doc]
        pub mod #name {
            #uses_globals
            #uses_prelude
            #names_file
            #content
        }
        #between
    };
    (tokens, parts)
}

/// `pub struct Globals { .. }`
fn globals(unit: &Unit<'_>, parts: &[Parts], inits: &TokenStream) -> TokenStream {
    let with: Vec<_> = parts.iter().filter(|part| part.variables).map(|part| unit.names.module(part.id)).collect();
    let init = initialised_by_rust(unit, inits);
    let blank = blank(unit);
    quote! {
        /// All global variables of the program.
        #[derive(Default)]
        pub struct Globals {
            #(pub #with: #with::Variables),*
        }
        #blank
        impl Globals {
            /// All variables with their start values.
            pub fn new() -> Self {
                Self::default()
            }
            #init
        }
    }
}

/// `Globals::init`, if there are variables but no `main`: no controller runs such a program and would initialise them.
fn initialised_by_rust(unit: &Unit<'_>, inits: &TokenStream) -> Option<TokenStream> {
    let blank = blank(unit);
    let cx = context(inits);
    (unit.program.main.is_none() && !inits.is_empty()).then(|| {
        quote! {
            #blank
            /// Gives all variables their first values.
            #[allow(dead_code)]
            pub async fn init(&self, #cx: &arl_rt::emit::Cx) -> arl_rt::emit::Done<()> {
                let g = self;
                #inits
                Ok(())
            }
        }
    })
}

/// `impl arl_rt::Program for Globals`
fn program(unit: &Unit<'_>, parts: &[Parts], inits: &TokenStream) -> TokenStream {
    let Some(main) = unit.program.main else { return TokenStream::new() };
    let Some(func) = unit.program.funcs.get(main.0 as usize) else { return TokenStream::new() };
    let file = unit.program.modules.get(func.module.0 as usize).map_or("", |module| module.file.as_str());
    let family = match unit.program.family {
        Family::SixAxis => quote!(SixAxis),
        Family::Scara => quote!(Scara),
    };
    let init = future(quote!(#inits Ok(())));
    let (module, name, effects) = (unit.names.module(func.module), unit.names.func(main.0), func.effects);
    let cx = effects.context.then(|| quote!(cx,));
    let g = effects.globals.then(|| quote!(g,));
    let wait = effects.waits.then(|| quote!(.await));
    let call = quote!(#module::#name(#cx #g)#wait);
    let main = future(if effects.fails { call } else { quote!(#call; Ok(())) });
    let tables = tables(unit, parts);
    let beside = beside(unit);
    let recurs = recurs(unit);
    let (init_cx, init_body) = init;
    let (main_cx, main_body) = main;
    let blank = blank(unit);
    quote! {
        #blank
        impl arl_rt::Program for Globals {
            fn file(&self) -> arl_rt::emit::File {
                arl_rt::emit::File::new(#file)
            }
            #blank
            fn family(&self) -> arl_rt::emit::Family {
                arl_rt::emit::Family::#family
            }
            #blank
            fn init<'a>(&'a self, #init_cx: &'a arl_rt::emit::Cx) -> arl_rt::emit::BoxFuture<'a> {
                #init_body
            }
            #blank
            fn main<'a>(&'a self, #main_cx: &'a arl_rt::emit::Cx) -> arl_rt::emit::BoxFuture<'a> {
                #main_body
            }
            #tables
            #beside
            #recurs
        }
    }
}

/// The functions that list the contents of the modules: variables of data files, all variables, handles.
fn tables(unit: &Unit<'_>, parts: &[Parts]) -> TokenStream {
    let modules = |ids: &[ModuleId]| ids.iter().map(|id| unit.names.module(*id)).collect::<Vec<_>>();
    let ids = |has: &dyn Fn(&Parts) -> bool| parts.iter().filter(|part| has(part)).map(|part| part.id).collect();
    let data: Vec<ModuleId> = ids(&|part| part.data);
    let data = (!data.is_empty()).then(|| {
        let (blank, modules) = (blank(unit), modules(&data));
        quote! {
            #blank
            fn data(&self) -> Vec<arl_rt::emit::DataFile<'_>> {
                vec![#(self.#modules.data()),*]
            }
        }
    });
    let named: Vec<ModuleId> = ids(&|part| unit.named && part.variables);
    let named = (!named.is_empty()).then(|| {
        let (blank, modules) = (blank(unit), modules(&named));
        quote! {
            #blank
            fn variables(&self) -> Vec<arl_rt::emit::DataFile<'_>> {
                vec![#(self.#modules.all()),*]
            }
        }
    });
    quote!(#data #named)
}

/// `fn beside(&self) -> Beside`, if the program uses something that runs in parallel to the cycle.
fn beside(unit: &Unit<'_>) -> Option<TokenStream> {
    let (mut connections, mut modbus_tcp) = (false, false);
    let mut look = |expr: &Expr| {
        if let ExprKind::Builtin(builtin) = &expr.kind {
            connections |= builtin.entry.connects;
            modbus_tcp |= builtin.is_served();
        }
    };
    let inits = unit.program.globals.iter().filter_map(|global| global.init.as_ref());
    inits.for_each(|init| visit::exprs(init, &mut look));
    let reached = unit.program.funcs.iter().zip(&unit.reached).filter(|(_, reached)| **reached);
    reached.flat_map(|(func, _)| &func.body).for_each(|stmt| visit::exprs_in_stmt(stmt, &mut look));
    let blank = blank(unit);
    (connections || modbus_tcp).then(|| {
        quote! {
            #blank
            fn beside(&self) -> arl_rt::emit::Beside {
                arl_rt::emit::Beside { connections: #connections, modbus_tcp: #modbus_tcp }
            }
        }
    })
}

/// `fn recurs(&self) -> bool`, if functions call themselves.
fn recurs(unit: &Unit<'_>) -> Option<TokenStream> {
    let mut reached = unit.program.funcs.iter().zip(&unit.reached).filter(|(_, reached)| **reached);
    let blank = blank(unit);
    reached.any(|(func, _)| func.effects.recursive).then(|| {
        quote! {
            #blank
            fn recurs(&self) -> bool {
                true
            }
        }
    })
}

/// The calls that initialise all variables, module by module.
fn init_calls(unit: &Unit<'_>, parts: &[Parts]) -> TokenStream {
    let call = |part: &Parts| {
        let module = unit.names.module(part.id);
        Some(variables::init_call(&quote!(#module::Variables), "init", part.init?))
    };
    order_of_init(unit, parts).into_iter().filter_map(call).collect()
}

/// The modules in the order in which their variables are initialised.
fn order_of_init<'a>(unit: &Unit<'_>, parts: &'a [Parts]) -> Vec<&'a Parts> {
    let mut order: Vec<&Parts> = Vec::new();
    for global in &unit.program.globals {
        if let Some(part) = parts.iter().find(|part| part.id == global.module)
            && !order.iter().any(|seen| seen.id == part.id)
        {
            order.push(part);
        }
    }
    order
}

/// The name of the context: `_cx` if it is not used.
fn context(code: &TokenStream) -> TokenStream {
    if mentions(code, "cx") { quote!(cx) } else { quote!(_cx) }
}

/// `Box::pin(async move { .. })`, and the name of the context.
fn future(code: TokenStream) -> (TokenStream, TokenStream) {
    let cx = context(&code);
    let g = mentions(&code, "g").then(|| quote!(let g = self;));
    (cx, quote!(Box::pin(async move { #g #code })))
}
