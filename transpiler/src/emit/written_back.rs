//! Variables that a call writes: local ones through `&mut`, others through a temporary that is written back.

use super::body::Body;
use super::calls::{EmittedArgument, path};
use super::fragment::{Fragment, Precedence};
use super::names::field;
use super::places::{Calm, Reached, Written};
use super::types::is_handle;
use crate::hir::{Builtin, LocalId, Passed, Place, Projection, Root, Value};
use arl_lang::catalog::{Effect, Entry, Presence};
use proc_macro2::{Ident, TokenStream, TokenTree};
use quote::quote;
use std::collections::{HashMap, HashSet};

/// A place that must be written after a call, and the temporary that holds its value until then.
pub(super) struct Back<'p> {
    place: &'p Place,
    reached: Reached,
    name: Ident,
    /// The statement that reads the place, if it has not been emitted yet.
    read: TokenStream,
}

impl Back<'_> {
    /// Reads the place before the call.
    pub(super) fn at_once(mut self, before: &mut TokenStream) -> Self {
        before.extend(std::mem::take(&mut self.read));
        self
    }

    /// Whether the place is read, passed to the call and written back before the next place is read.
    pub(super) fn is_in_turn(&self) -> bool {
        !self.read.is_empty()
    }
}

/// Identifies a variable of any kind.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum RootKey {
    Local(u32),
    Global(u32),
    System(&'static str),
}

impl RootKey {
    fn of(root: Root) -> Self {
        match root {
            Root::Local(id) => Self::Local(id.0),
            Root::Global(id) => Self::Global(id.0),
            Root::System(variable) => Self::System(variable.name),
        }
    }
}

impl<'p> Body<'p, '_> {
    /// `&mut place` for a local variable; for others a temporary that is written back. `shared`: the call also uses the
    /// variable for something else.
    pub(super) fn out_argument(
        &mut self,
        place: &'p Place,
        indices: Vec<Fragment>,
        shared: bool,
        before: &mut TokenStream,
    ) -> (Fragment, Option<Back<'p>>) {
        if is_handle(place.ty) {
            return (self.handle(place), None);
        }
        if self.is_lent(place, shared) {
            let reached = self.reached(place, indices);
            let target = self.target(&reached);
            return (Fragment::new(quote!(&mut #target), Precedence::Unary), None);
        }
        let mut settled = Vec::new();
        for index in indices {
            let index = self.settle(index, "at");
            before.extend(index.before.clone());
            settled.push(Fragment { before: TokenStream::new(), ..index });
        }
        let reached = self.reached(place, settled);
        let old = self.read_reached(&reached);
        let name = self.fresh("out");
        let (first, old) = (&old.before, &old.tokens);
        let read = quote!(#first let mut #name = #old;);
        let value = Fragment::new(quote!(&mut #name), Precedence::Unary);
        (value, Some(Back { place, reached, name, read }))
    }

    /// Whether a call receives the place itself.
    fn is_lent(&self, place: &Place, shared: bool) -> bool {
        self.plain_local(place.root).is_some() && !shared
    }

    /// Whether a call writes a variable through a temporary, which is read before the call.
    pub(super) fn writes_by_temporaries(&self, builtin: &'p Builtin, touched: &HashSet<LocalId>) -> bool {
        builtin.args.iter().any(|arg| match &arg.value {
            Passed::Out(place) => {
                let shared = matches!(place.root, Root::Local(id) if touched.contains(&id));
                !is_handle(place.ty) && !self.is_lent(place, shared)
            }
            Passed::Value(_) => false,
        })
    }

    /// Whether two of the variables that a call writes through temporaries may be the same one, so that each must be
    /// written before the next one is read. `touched` contains the locals that the call also uses otherwise.
    pub(super) fn takes_turns(&self, builtin: &'p Builtin, touched: &HashSet<LocalId>) -> bool {
        let mut paths: HashMap<RootKey, Vec<Option<Vec<i64>>>> = HashMap::new();
        for arg in &builtin.args {
            let Passed::Out(place) = &arg.value else { continue };
            let shared = matches!(place.root, Root::Local(id) if touched.contains(&id));
            if !is_handle(place.ty) && !self.is_lent(place, shared) {
                paths.entry(RootKey::of(place.root)).or_default().push(self.constant_path(place));
            }
        }
        paths.into_values().any(|mut paths| {
            let count = paths.len();
            let known = paths.iter().all(Option::is_some);
            paths.sort_unstable();
            paths.dedup();
            count > 1 && !(known && paths.len() == count)
        })
    }

    /// The steps of a place as numbers, if all of them are known.
    fn constant_path(&self, place: &'p Place) -> Option<Vec<i64>> {
        let mut path = vec![0];
        for step in &place.path {
            match step {
                Projection::Field(_, at) => path.push(i64::try_from(*at).ok()?),
                Projection::Index(indices, _) => {
                    for index in indices {
                        match self.constant(index)? {
                            Value::Int(at) => path.push(i64::from(*at)),
                            _ => return None,
                        }
                    }
                }
            }
        }
        Some(path)
    }

    /// The statement that writes a place after the call.
    pub(super) fn write_back(&mut self, back: &Back<'p>) -> TokenStream {
        let name = &back.name;
        let value = self.limited(back.place, Fragment::settled(quote!(#name)), None);
        self.write(&back.reached, Written::Value(value), Calm::Local)
    }

    /// `let scan = scan.argtosave(&mut out);` for each argument; each variable is written before the next one is read.
    pub(super) fn call_in_turn(
        &mut self,
        entry: &Entry,
        arguments: &[EmittedArgument<'p>],
        before: &mut TokenStream,
    ) -> TokenStream {
        let is_required = |argument: &&EmittedArgument<'p>| {
            entry.params.get(argument.param).is_some_and(|param| param.presence == Presence::Required)
        };
        let mut required: Vec<&EmittedArgument<'p>> = arguments.iter().filter(is_required).collect();
        required.sort_by_key(|argument| argument.param);
        let mut values = Vec::new();
        for argument in required {
            let name = self.fresh(entry.params.get(argument.param).map_or("value", |param| param.rust));
            let value = &argument.value.tokens;
            // The call may write what it reads.
            if is_reference(value) {
                before.extend(quote!(let #name = Clone::clone(#value);));
                values.push(quote!(&#name));
            } else {
                before.extend(quote!(let #name = #value;));
                values.push(quote!(#name));
            }
        }
        let (path, name) = (path(entry.path), self.fresh(entry.name));
        before.extend(quote!(let #name = #path(#(#values),*);));
        for argument in arguments.iter().filter(|argument| !is_required(argument)) {
            let label = field(entry.params.get(argument.param).map_or("unknown", |param| param.rust));
            let value = &argument.value.tokens;
            let read = argument.back.as_ref().map(|back| &back.read);
            before.extend(quote!(#read let #name = #name.#label(#value);));
            if let Some(back) = &argument.back {
                before.extend(self.write_back(back));
            }
        }
        let cx = (entry.effect != Effect::Pure).then(|| quote!(cx));
        quote!(#name.run(#cx))
    }

    /// The local variables that the arguments of a call read or write, except those written only by the call itself,
    /// which it does one after another.
    pub(super) fn touched(&self, builtin: &'p Builtin) -> HashSet<LocalId> {
        let mut touched = HashSet::new();
        if !builtin.args.iter().any(|arg| matches!(arg.value, Passed::Out(_))) {
            return touched;
        }
        for arg in &builtin.args {
            let facts = match &arg.value {
                Passed::Value(expr) => vec![self.facts(expr)],
                Passed::Out(place) => {
                    let indices = Self::index_operands(place);
                    indices.iter().map(|index| self.operand_facts(index)).collect()
                }
            };
            touched.extend(facts.into_iter().flat_map(|facts| facts.reads.into_iter().chain(facts.writes)));
        }
        touched
    }
}

fn is_reference(value: &TokenStream) -> bool {
    matches!(value.clone().into_iter().next(), Some(TokenTree::Punct(first)) if first.as_char() == '&')
}
