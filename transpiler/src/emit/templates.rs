//! Calls that occur often in a large program and differ only in constants and local variables become one function each:
//! each call then adds a line to what rustc compiles, not the code around its wait.
//!
//! Invariants:
//! - a call of such a function does the same as the code that it replaces, in the same order and at the same line;
//! - it writes no local variable except the flag of a `waituntil`, which it returns;
//! - the values of the locals that it reads do not change while it waits, as none of them is visible to events.

use super::Sizes;
use super::body::Body;
use super::fragment::Fragment;
use super::names::{Names, field};
use super::places::{Calm, Written};
use super::rows::{Columns, Filling, Hole, Shape, column_type, of_call, same};
use super::slots::Slots;
use super::statements::without_detour;
use super::tokens::{mentions, uses_variable};
use super::types::{base_type, is_copy, rust_type};
use super::unit::Unit;
use crate::effects::parts::children;
use crate::effects::{captures, flow};
use crate::hir::{
    Builtin, Expr, ExprKind, Func, FuncId, LocalId, ModuleId, Passed, Place, Program, Projection, Root, Stmt, StmtKind,
};
use crate::visit;
use arl_lang::ast::{BinaryOp, UnaryOp};
use arl_lang::catalog::{Base, Effect, Family, Form};
use proc_macro2::{Ident, TokenStream};
use quote::quote;
use std::cell::OnceCell;
use std::collections::HashMap;

/// The number of parameters, in addition to those that are always there, above which clippy warns.
const MOST_PARAMETERS: usize = 4;

/// A call that may become a call of a template.
#[derive(Clone, Debug)]
struct Use<'p> {
    func: FuncId,
    expr: &'p Expr,
    builtin: &'p Builtin,
    holes: Vec<Hole<'p>>,
    locals: Vec<LocalId>,
}

/// Calls that differ only in constants and local variables.
#[derive(Debug)]
struct Template<'p> {
    module: ModuleId,
    name: Ident,
    /// The first call, from which the function is made.
    first: Use<'p>,
    /// The holes whose fillings differ.
    varying: Vec<usize>,
}

/// A call that becomes a call of a template.
#[derive(Debug)]
struct Call<'p> {
    template: usize,
    holes: Vec<Hole<'p>>,
    locals: Vec<LocalId>,
}

/// All templates of a program, and the calls that become calls of them.
#[derive(Default, Debug)]
pub(super) struct Templates<'p> {
    all: Vec<Template<'p>>,
    calls: HashMap<*const Expr, Call<'p>>,
    /// The code of each template, once it is called.
    codes: Vec<OnceCell<Code>>,
}

/// The function of a template.
#[derive(Debug)]
struct Code {
    item: TokenStream,
    /// What the function receives in addition to constants and locals.
    cx: bool,
    g: bool,
    line: bool,
    waits: bool,
}

impl<'p> Templates<'p> {
    /// Finds the templates of a program and gives them unused names.
    pub(super) fn new(program: &'p Program, names: &mut Names, slots: &Slots, sizes: Sizes) -> Self {
        let mut templates = Self::default();
        let mut order: Vec<Vec<Use<'p>>> = Vec::new();
        let mut known: HashMap<(ModuleId, Shape), usize> = HashMap::new();
        for (at, func) in program.funcs.iter().enumerate() {
            let func_id = FuncId(at as u32);
            each_call(&func.body, &mut |expr| {
                let ExprKind::Builtin(builtin) = &expr.kind else { return };
                if !may_be_one(builtin, func) {
                    return;
                }
                let (shape, holes, locals) = of_call(expr, func, program.family, slots);
                let number = *known.entry((func.module, shape)).or_insert_with(|| {
                    order.push(Vec::new());
                    order.len() - 1
                });
                if let Some(uses) = order.get_mut(number) {
                    uses.push(Use { func: func_id, expr, builtin, holes, locals });
                }
            });
        }
        for uses in order.into_iter().filter(|uses| uses.len() >= sizes.uses_of_a_template) {
            templates.add(uses, program, names);
        }
        templates
    }

    fn add(&mut self, uses: Vec<Use<'p>>, program: &Program, names: &mut Names) {
        let Some(first) = uses.first().cloned() else { return };
        let Some(module) = program.funcs.get(first.func.0 as usize).map(|func| func.module) else { return };
        let differs = |at: &usize| {
            let filling = |found: &Use<'p>| found.holes.get(*at).map(|hole| hole.filling);
            uses.iter().any(|other| match (filling(&first), filling(other)) {
                (Some(one), Some(other)) => !same(one, other),
                _ => true,
            })
        };
        let varying = (0..first.holes.len()).filter(differs).collect();
        let name = names.new_function(module, first.builtin.entry.name);
        for Use { expr, holes, locals, .. } in uses {
            self.calls.insert(std::ptr::from_ref(expr), Call { template: self.all.len(), holes, locals });
        }
        self.all.push(Template { module, name, first, varying });
        self.codes.push(OnceCell::new());
    }

    /// Whether there are any.
    pub(super) fn are_used(&self) -> bool {
        !self.all.is_empty()
    }

    /// Whether a call becomes a call of a template.
    pub(super) fn have(&self, expr: &Expr) -> bool {
        self.calls.contains_key(&std::ptr::from_ref(expr))
    }

    /// The functions of a module's templates that are called.
    pub(super) fn items(&self, module: ModuleId) -> impl Iterator<Item = &TokenStream> {
        let own = self.all.iter().zip(&self.codes).filter(move |(template, _)| template.module == module);
        own.filter_map(|(_, code)| code.get()).map(|code| &code.item)
    }
}

/// Calls `see` for expression statements and for the parts of conditions.
fn each_call<'p>(block: &'p [Stmt], see: &mut dyn FnMut(&'p Expr)) {
    for stmt in block {
        match &stmt.kind {
            StmtKind::Eval(expr) => see(expr),
            StmtKind::If(arms, _) => arms.iter().for_each(|(condition, _)| conditions(condition, see)),
            StmtKind::While(condition, ..) | StmtKind::Repeat(_, condition, _) => conditions(condition, see),
            _ => {}
        }
        flow::blocks(stmt).for_each(|block| each_call(block, see));
    }
}

fn conditions<'p>(condition: &'p Expr, see: &mut dyn FnMut(&'p Expr)) {
    match &condition.kind {
        ExprKind::Unary(UnaryOp::Not, inner) => conditions(inner, see),
        ExprKind::Binary(BinaryOp::And | BinaryOp::Or, sides) => {
            conditions(&sides.0, see);
            conditions(&sides.1, see);
        }
        _ => see(condition),
    }
}

/// Whether a call may become a call of a template.
fn may_be_one(builtin: &Builtin, func: &Func) -> bool {
    let entry = builtin.entry;
    let form = matches!(entry.form, Form::Call | Form::WaitUntil);
    let reads_flag = || {
        let Some(Place { root: Root::Local(flag), .. }) = flag(builtin) else { return false };
        let mut reads = false;
        builtin.args.iter().for_each(|arg| {
            if let Passed::Value(value) = &arg.value {
                visit::exprs(value, &mut |expr| {
                    reads |= matches!(&expr.kind, ExprKind::Place(place) if matches!(place.root, Root::Local(id) if id == *flag));
                });
            }
        });
        reads
    };
    // Pure computations compile fast and may be in a loop that does nothing else.
    form && entry.fails
        && entry.effect != Effect::Pure
        && !reads_flag()
        && builtin.args.iter().all(|arg| match &arg.value {
            Passed::Value(value) => {
                (entry.form == Form::WaitUntil || !captures::is_later(entry, arg)) && is_plain(value, func)
            }
            Passed::Out(place) => entry.form == Form::WaitUntil && is_own(place, func) && place.path.is_empty(),
        })
}

/// Whether a value is the same wherever it is evaluated, given its locals.
fn is_plain(value: &Expr, func: &Func) -> bool {
    let itself = match &value.kind {
        ExprKind::Call(..)
        | ExprKind::Assign(_)
        | ExprKind::AssignOp(..)
        | ExprKind::Step(..)
        | ExprKind::Splice(_)
        | ExprKind::Grown(_) => false,
        ExprKind::Builtin(builtin) => {
            matches!(builtin.entry.form, Form::Call)
                && builtin.args.iter().all(|arg| matches!(arg.value, Passed::Value(_)))
        }
        ExprKind::Place(place) => is_own(place, func) && place.path.iter().all(is_constant_step),
        _ => true,
    };
    itself && children(value).into_iter().all(|child| is_plain(child, func))
}

/// What is known about an index may differ between places.
fn is_constant_step(step: &Projection) -> bool {
    match step {
        Projection::Field(..) => true,
        Projection::Index(indices, _) => indices.iter().all(|index| matches!(index.kind, ExprKind::Const(_))),
    }
}

/// Whether a variable is not a local, or is a local whose value can be passed.
fn is_own(place: &Place, func: &Func) -> bool {
    let Root::Local(id) = place.root else { return true };
    let known = |local: &crate::hir::Local| local.constant && local.value.is_some();
    func.locals.get(id.0 as usize).is_some_and(|local| is_copy(local.ty) && !local.shared && !known(local))
}

/// The flag that a `waituntil` writes.
fn flag(builtin: &Builtin) -> Option<&Place> {
    builtin.args.iter().find_map(|arg| match &arg.value {
        Passed::Out(place) => Some(place),
        Passed::Value(_) => None,
    })
}

impl<'p> Template<'p> {
    /// The function of the template.
    fn code(&self, unit: &Unit<'p>) -> Code {
        let Self { name, first, .. } = self;
        let Some(func) = unit.program.funcs.get(first.func.0 as usize) else {
            return Code { item: TokenStream::new(), cx: false, g: false, line: false, waits: false };
        };
        let mut body = Body::of_function(unit, func);
        body.form.in_template = true;
        body.stand_at(first.expr.span);
        let comment = body.comment(first.expr.span);
        let holes: Vec<&Hole<'p>> = self.varying.iter().filter_map(|at| first.holes.get(*at)).collect();
        let line = body.reserve("line");
        let columns: Vec<Ident> = holes.iter().map(|hole| body.reserve(&field(hole.name).to_string())).collect();
        body.position.columns = Columns::new(line.clone(), holes.iter().copied().zip(&columns));
        body.position.acts = false;
        let value = body.builtin(first.builtin);
        let (pointer, before) = (body.pointer(), &value.before);
        let written = flag(first.builtin).and_then(|place| match place.root {
            Root::Local(id) => Some(id),
            _ => None,
        });
        let family = unit.family();
        let [declared, end, result] =
            result_of(first.expr.ty.base, &value, written.map(|flag| body.local(flag)), family);
        let code = quote!(#declared #pointer #before #end);
        let constants = holes.iter().zip(&columns).map(|(hole, name)| {
            let ty = match hole.filling {
                Filling::Constant(_, value) => column_type(value.base(), family, true),
                Filling::Variable(..) => quote!(usize),
            };
            quote!(#name: #ty)
        });
        let locals = first.locals.iter().filter(|id| written != Some(**id)).filter_map(|id| {
            let (name, ty) = (body.local(*id), func.locals.get(id.0 as usize)?.ty);
            let ty = rust_type(ty, family);
            Some(quote!(#name: #ty))
        });
        let [cx, g, uses_line] = ["cx", "g", &line.to_string()].map(|word| uses_variable(&code, word));
        let waits = mentions(&code, "await");
        let life = waits.then(|| quote!('a));
        let cx_param = cx.then(|| quote!(cx: &#life Cx,));
        let g_param = g.then(|| quote!(g: &#life Globals,));
        let line_param = uses_line.then(|| quote!(#line: u32,));
        let params = quote!(#cx_param #g_param #line_param #(#constants,)* #(#locals,)*);
        let has_many_params = self.varying.len() + first.locals.len() > MOST_PARAMETERS;
        let item = Head { comment, name, params, result, has_many_params, waits }.with(&code);
        Code { item, cx, g, line: uses_line, waits }
    }
}

/// The first declaration of a template, its end and its type: for the `flag` that it writes, or for its value.
fn result_of(ty: Base, value: &Fragment, flag: Option<Ident>, family: Family) -> [TokenStream; 3] {
    match flag {
        Some(flag) => [quote!(let #flag;), quote!(Ok(#flag)), quote!(bool)],
        None if ty == Base::Void => {
            let end = without_detour(value).unwrap_or_else(|| quote!(Ok(())));
            [TokenStream::new(), end, quote!(())]
        }
        None => {
            let tokens = &value.tokens;
            let end = without_detour(value).unwrap_or_else(|| quote!(Ok(#tokens)));
            [TokenStream::new(), end, base_type(ty, family)]
        }
    }
}

/// The header of a template's function.
struct Head<'a> {
    comment: TokenStream,
    name: &'a Ident,
    params: TokenStream,
    result: TokenStream,
    has_many_params: bool,
    waits: bool,
}

impl Head<'_> {
    fn with(self, code: &TokenStream) -> TokenStream {
        let Self { comment, name, params, result, has_many_params, waits } = self;
        let many = has_many_params.then(|| quote!(#[allow(clippy::too_many_arguments)]));
        // Behind a pointer, so that callers neither keep nor copy the data that it needs.
        match waits {
            true => quote! {
                #comment
                #many
                fn #name<'a>(#params) -> BoxFuture<'a, #result> {
                    Box::pin(async move { #code })
                }
            },
            false => quote! {
                #comment
                #many
                fn #name(#params) -> Done<#result> {
                    #code
                }
            },
        }
    }
}

impl<'p> Body<'p, '_> {
    /// The call of a template instead of a call; `None` if the call has no template.
    pub(super) fn template_call(&mut self, expr: &'p Expr, builtin: &'p Builtin) -> Option<Fragment> {
        if self.form.in_template || !self.position.columns.is_empty() {
            return None;
        }
        let templates = &self.unit.templates;
        let call = templates.calls.get(&std::ptr::from_ref(expr))?;
        let template = templates.all.get(call.template)?;
        let code = templates.codes.get(call.template)?.get_or_init(|| template.code(self.unit));
        let name = &template.name;
        let cx = code.cx.then(|| quote!(cx,));
        let g = code.g.then(|| quote!(g,));
        let line = code.line.then(|| {
            let line = self.line_number();
            quote!(#line,)
        });
        let fillings = template.varying.iter().filter_map(|at| call.holes.get(*at));
        let values = fillings.map(|hole| self.in_column(hole.filling).parse::<TokenStream>().unwrap_or_default());
        let written = flag(builtin).filter(|place| matches!(place.root, Root::Local(_)));
        let is_written =
            |id: &&LocalId| written.is_some_and(|place| matches!(place.root, Root::Local(flag) if flag == **id));
        let locals = call.locals.iter().filter(|id| !is_written(id)).map(|id| self.local(*id));
        let wait = code.waits.then(|| quote!(.await));
        let call = Fragment::postfix(quote!(#name(#cx #g #line #(#values,)* #(#locals,)*)#wait?));
        let Some(flag) = written else { return Some(call) };
        let nothing = Fragment::settled(quote!(()));
        if let Some(declared) = self.deferred_let(flag, None) {
            let call = &call.tokens;
            return Some(nothing.after(quote!(#declared = #call;)));
        }
        let reached = self.reached(flag, []);
        let write = self.write(&reached, Written::Value(call), Calm::Local);
        Some(nothing.after(write))
    }
}
