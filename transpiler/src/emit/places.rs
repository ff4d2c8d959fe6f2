//! Reading and writing variables, their components and elements.
//!
//! Locals are plain Rust variables. Global and system variables are `Cell`s, or `Shared` if their value is not `Copy`;
//! handles are stored directly.

use super::body::Body;
use super::fragment::{Fragment, Precedence};
use super::sequence::OrderedOperand;
use super::types::{component, differs, is_cells, is_copy, is_handle, type_name};
use crate::effects::facts::{self, Facts};
use crate::hir::{Expr, GlobalId, LocalId, Place, Projection, Root, Type, Value};
use arl_lang::ast::BinaryOp;
use arl_lang::catalog::{Base, Struct, Takes};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, quote};

/// A place whose indices have been emitted.
#[derive(Clone, Debug)]
pub(super) struct Reached {
    root: Root,
    /// Whether it is a local variable that is also visible to events.
    shared: bool,
    /// The type of the whole variable.
    whole: Type,
    /// The type at the end of the path.
    pub(super) ty: Type,
    path: Vec<Reach>,
    /// The column of a table that selects the variable of an array.
    column: Option<Ident>,
}

/// A step of a path.
#[derive(Clone, Debug)]
enum Reach {
    Field(Struct, Ident),
    At(TokenStream),
}

/// How a variable is stored.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Storage {
    Local,
    Handle,
    Cell,
    /// An array of cells.
    Cells,
    Shared,
}

/// Where a value may be computed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Calm {
    /// Only in a statement of its own.
    No,
    /// Anywhere, as long as nothing that it reads is borrowed.
    Quiet,
    /// Anywhere: it depends on locals only.
    Local,
}

impl Calm {
    /// For a value with these facts.
    pub(super) fn of(facts: &Facts) -> Self {
        match facts.quiet() {
            true if !facts.world && !facts.context && !facts.globals => Calm::Local,
            true => Calm::Quiet,
            false => Calm::No,
        }
    }
}

/// What is written to a place.
pub(super) enum Written<'p> {
    /// `place = value`
    Value(Fragment),
    /// `place op= value`, if the operation cannot fail.
    Step {
        op: BinaryOp,
        value: Fragment,
        /// The value, if it is constant.
        known: Option<&'p Value>,
        /// Whether Rust has the operator in this form.
        native: bool,
    },
}

impl Reached {
    fn kept(&self) -> Storage {
        match self.root {
            Root::Local(_) if !self.shared => Storage::Local,
            _ if is_handle(self.whole) => Storage::Handle,
            _ if is_copy(self.whole) => Storage::Cell,
            Root::Global(_) if is_cells(self.whole) => Storage::Cells,
            _ => Storage::Shared,
        }
    }

    /// The index of the element with which the path begins.
    fn first_index(&self) -> TokenStream {
        match self.path.first() {
            Some(Reach::At(at)) => at.clone(),
            _ => quote!(0),
        }
    }

    /// `.x[3]`
    fn steps(&self) -> TokenStream {
        steps(&self.path)
    }
}

fn steps(path: &[Reach]) -> TokenStream {
    path.iter()
        .map(|step| match step {
            Reach::Field(_, field) => quote!(.#field),
            Reach::At(at) => quote!([#at]),
        })
        .collect()
}

impl<'p> Body<'p, '_> {
    /// The indices of a place as operands.
    pub(super) fn index_operands(place: &'p Place) -> Vec<OrderedOperand<'p>> {
        place
            .path
            .iter()
            .filter_map(|step| match step {
                Projection::Index(indices, ty) => Some(OrderedOperand::Index(indices, *ty)),
                Projection::Field(..) => None,
            })
            .collect()
    }

    /// A place with its emitted indices.
    pub(super) fn reached(&self, place: &Place, indices: impl IntoIterator<Item = Fragment>) -> Reached {
        let mut indices = indices.into_iter();
        let path = place
            .path
            .iter()
            .map(|step| match step {
                Projection::Field(id, index) => Reach::Field(*id, component(*id, *index, self.family())),
                Projection::Index(..) => Reach::At(indices.next().map_or_else(|| quote!(0), |index| index.tokens)),
            })
            .collect();
        let shared = matches!(place.root, Root::Local(_)) && self.plain_local(place.root).is_none();
        let whole = self.variable_type(place.root);
        Reached { root: place.root, shared, whole, ty: place.ty, path, column: self.position.columns.slot(place) }
    }

    /// A local variable that is a plain one in Rust, too, because events do not see it.
    pub(super) fn plain_local(&self, root: Root) -> Option<LocalId> {
        let Root::Local(id) = root else { return None };
        (!self.is_shared(id)).then_some(id)
    }

    /// Whether events see a local variable.
    pub(super) fn is_shared(&self, id: LocalId) -> bool {
        self.func.and_then(|func| func.locals.get(id.0 as usize)).is_some_and(|local| local.shared)
    }

    fn variable_type(&self, root: Root) -> Type {
        let ty = match root {
            Root::Local(id) => self.func.and_then(|func| func.locals.get(id.0 as usize)).map(|local| local.ty),
            Root::Global(id) => self.program().globals.get(id.0 as usize).map(|global| global.ty),
            Root::System(variable) => Type::array(variable.ty, variable.dims),
        };
        ty.unwrap_or(Type::scalar(Base::Void))
    }

    /// A variable as a whole.
    pub(super) fn whole_variable(&self, root: Root) -> TokenStream {
        let whole = self.variable_type(root);
        self.variable(&Reached { root, shared: false, whole, ty: whole, path: Vec::new(), column: None })
    }

    /// The variable itself: `count`, `g.pick.count`, `cx.system().dfspeed`.
    fn variable(&self, place: &Reached) -> TokenStream {
        match place.root {
            Root::Local(id) => {
                let name = self.local(id);
                quote!(#name)
            }
            Root::Global(id) => {
                if let Some(elements) = self.elements_of(id).filter(|_| !place.path.is_empty()) {
                    return quote!(#elements);
                }
                let owner = self.program().globals.get(id.0 as usize).map_or(self.module, |global| global.module);
                let (module, name) = (self.unit.names.module(owner), self.unit.names.global(id.0));
                match self.unit.slots.of(id) {
                    Some((array, _)) => {
                        let field = &array.field;
                        let at = place.column.as_ref().map(ToTokens::to_token_stream);
                        let at = at.unwrap_or_else(|| self.place_in_array(id));
                        quote!(g.#module.#field[#at])
                    }
                    None => quote!(g.#module.#name),
                }
            }
            Root::System(variable) => {
                let name = super::names::field(variable.field);
                if differs(variable.ty, self.family()) {
                    quote!(cx.system().scara().#name)
                } else {
                    quote!(cx.system().#name)
                }
            }
        }
    }

    /// `at::p17`: the position of a variable in its array.
    pub(super) fn place_in_array(&self, id: GlobalId) -> TokenStream {
        let owner = self.program().globals.get(id.0 as usize).map_or(self.module, |global| global.module);
        let (module, name) = (self.unit.names.module(owner), self.unit.names.global(id.0));
        let path = (owner != self.module).then(|| quote!(super::#module::));
        quote!(#path at::#name)
    }

    /// The value of a place, as an owned value.
    pub(super) fn read(&mut self, place: &'p Place) -> Fragment {
        let (before, indices) = self.sequence(&Self::index_operands(place), |_| false);
        let reached = self.reached(place, indices);
        self.read_reached(&reached).after(before)
    }

    /// The value of a place, only to be read: the value of a local variable is not copied.
    pub(super) fn look_at(&mut self, place: &'p Place) -> Fragment {
        let (before, indices) = self.sequence(&Self::index_operands(place), |_| false);
        let reached = self.reached(place, indices);
        self.look_at_reached(&reached).after(before)
    }

    /// The value of a place whose indices are known, as an owned value.
    pub(super) fn read_reached(&mut self, place: &Reached) -> Fragment {
        match place.kept() {
            Storage::Local => Self::owned(self.look_at_reached(place), place.ty),
            _ => self.look_at_reached(place),
        }
    }

    fn look_at_reached(&mut self, place: &Reached) -> Fragment {
        let variable = self.variable(place);
        let steps = place.steps();
        let tokens = match (place.kept(), place.path.split_first()) {
            (Storage::Local | Storage::Handle, _) => quote!(#variable #steps),
            (Storage::Cell, _) => quote!(#variable.get()#steps),
            (Storage::Shared | Storage::Cells, Some((Reach::At(at), rest))) => {
                let rest = self::steps(rest);
                quote!(#variable.item(#at)#rest)
            }
            (Storage::Shared, Some(_)) => {
                let it = self.fresh("it");
                let copy = if is_copy(place.ty) { TokenStream::new() } else { quote!(.clone()) };
                quote!(#variable.with(|#it| #it #steps #copy))
            }
            (Storage::Shared | Storage::Cells, _) => quote!(#variable.get()),
        };
        Fragment::postfix(tokens)
    }

    /// The place itself, for a local variable.
    pub(super) fn target(&self, place: &Reached) -> TokenStream {
        let (variable, steps) = (self.variable(place), place.steps());
        quote!(#variable #steps)
    }

    /// The handle in a place: `&timer`, `&g.pick.timers[2]`.
    pub(super) fn handle(&mut self, place: &'p Place) -> Fragment {
        self.look_at(place).map(Precedence::Unary, |place| {
            let place = &place.tokens;
            quote!(&#place)
        })
    }

    /// The statement that writes a place whose indices are known. `calm` determines where the value may be computed.
    pub(super) fn write(&mut self, place: &Reached, written: Written<'p>, calm: Calm) -> TokenStream {
        let variable = self.variable(place);
        let item = matches!(place.path.as_slice(), [Reach::At(_)]);
        match (place.kept(), written) {
            (Storage::Local, written) => {
                let target = self.target(place);
                let (before, change) = self.changed(place.ty, &target, written);
                quote!(#before #change;)
            }
            // The checker accepts no assignment to handles.
            (Storage::Handle, _) => TokenStream::new(),
            (_, Written::Value(value)) if place.path.is_empty() => {
                let (before, value) = (&value.before, &value.tokens);
                quote!(#before #variable.set(#value);)
            }
            (Storage::Cells | Storage::Shared, Written::Value(value)) if item => {
                let (before, value, at) = (&value.before, &value.tokens, place.first_index());
                quote!(#before #variable.set_item(#at, #value);)
            }
            (_, written) => self.update(place, &variable, written, calm),
        }
    }

    /// The statement that appends a string to a variable: `append(&mut text, &more).at(FILE, 3)?;`
    pub(super) fn append_to(&mut self, place: &Reached, more: Fragment, calm: Calm) -> TokenStream {
        let variable = self.variable(place);
        if place.kept() == Storage::Local {
            let (before, more) = (&more.before, &more.tokens);
            let appended = self.checked(quote!(append(&mut #variable, #more)));
            return quote!(#before #appended;);
        }
        let more = if calm == Calm::Local { more } else { self.settle(more, "value") };
        let it = self.fresh("it");
        let (before, more) = (&more.before, &more.tokens);
        let appended = self.checked(quote!(#variable.update(|#it| append(#it, #more))));
        quote!(#before #appended;)
    }

    /// `target = value`, `target += value`, with the preceding statements.
    fn changed(&self, ty: Type, target: &TokenStream, written: Written<'p>) -> (TokenStream, TokenStream) {
        match written {
            Written::Value(value) => {
                let new = &value.tokens;
                (value.before.clone(), quote!(#target = #new))
            }
            Written::Step { op, value, native: true, .. } => {
                let (sign, by) = (compound_sign(op), &value.tokens);
                (value.before.clone(), quote!(#target #sign #by))
            }
            Written::Step { op, value, known, .. } => {
                let new = self.operation(op, ty, Fragment::postfix(target.clone()), &value, known).tokens;
                (value.before, quote!(#target = #new))
            }
        }
    }

    /// `variable.update(|it| ..)`; the value is computed before it, unless it may be computed inside.
    fn update(&mut self, place: &Reached, variable: &TokenStream, written: Written<'p>, calm: Calm) -> TokenStream {
        let kept = place.kept();
        let inside = if kept == Storage::Shared { calm == Calm::Local } else { calm != Calm::No };
        let settle = |body: &mut Self, value: Fragment| {
            let mut value = if inside { value } else { body.settle(value, "value") };
            (std::mem::take(&mut value.before), value)
        };
        let (before, written) = match written {
            Written::Value(value) => {
                let (before, value) = settle(self, value);
                (before, Written::Value(value))
            }
            Written::Step { op, value, known, native } => {
                let (before, value) = settle(self, value);
                (before, Written::Step { op, value, known, native })
            }
        };
        let it = self.fresh("it");
        if kept == Storage::Shared {
            let steps = place.steps();
            let target = if place.path.is_empty() { quote!(*#it) } else { quote!(#it #steps) };
            let (_, change) = self.changed(place.ty, &target, written);
            return quote!(#before #variable.update(|#it| #change););
        }
        let (element, path) = match place.path.split_first() {
            Some((Reach::At(at), rest)) => (Some(at), rest),
            _ => (None, place.path.as_slice()),
        };
        let value = match written {
            Written::Value(value) => value.tokens,
            Written::Step { op, value, known, .. } => {
                let steps = steps(path);
                self.operation(op, place.ty, Fragment::postfix(quote!(#it #steps)), &value, known).tokens
            }
        };
        let value = self.rebuilt(&quote!(#it), path, value);
        match element {
            Some(at) => quote!(#before #variable.update_item(#at, |#it| #value);),
            None => quote!(#before #variable.update(|#it| #value);),
        }
    }

    /// `Pose { x: value, ..it }`, nested for inner components.
    fn rebuilt(&self, it: &TokenStream, path: &[Reach], value: TokenStream) -> TokenStream {
        let Some((Reach::Field(id, field), rest)) = path.split_first() else { return value };
        let inner = self.rebuilt(&quote!(#it.#field), rest, value);
        let name = type_name(Base::Struct(*id), self.family());
        if *field == inner.to_string() {
            return quote!(#name { #field, ..#it });
        }
        quote!(#name { #field: #inner, ..#it })
    }

    /// A value for a system variable that does not accept all values of its type.
    pub(super) fn limited(&self, place: &Place, value: Fragment, expr: Option<&Expr>) -> Fragment {
        let tokens = &value.tokens;
        let call = match facts::limit(place, expr) {
            None | Some(Takes::All) => return value,
            Some(Takes::Range(low, high)) => {
                let (low, high) = (Literal::f64_unsuffixed(low), Literal::f64_unsuffixed(high));
                quote!(in_range(#tokens, #low, #high))
            }
            Some(Takes::Words(words)) => quote!(one_of(#tokens, &[#(#words),*])),
        };
        let tokens = self.checked(call);
        Fragment { tokens, precedence: Precedence::Postfix, settled: false, ..value }
    }
}

fn compound_sign(op: BinaryOp) -> TokenStream {
    match op {
        BinaryOp::Add => quote!(+=),
        BinaryOp::Subtract => quote!(-=),
        BinaryOp::Multiply => quote!(*=),
        BinaryOp::Divide => quote!(/=),
        BinaryOp::Remainder => quote!(%=),
        BinaryOp::ShiftLeft => quote!(<<=),
        BinaryOp::ShiftRight => quote!(>>=),
        BinaryOp::BitAnd => quote!(&=),
        BinaryOp::BitXor => quote!(^=),
        _ => quote!(|=),
    }
}
