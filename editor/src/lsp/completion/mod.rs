//! What may be typed at a place: what the checker expects there, and nothing else.

mod builtin;
mod item;
mod own;

use super::places::File;
use super::programs::Program;
use super::server::{Refusal, Server};
use super::typing::{Surroundings, Typing};
use arl_lang::catalog::{Base, Entry, Family, Kind, Mode, ParamType, Presence};
use arl2rs::hir::Type;
use arl2rs::index::{ArgumentList, Callee, Expectation, Index, Wanted};
use gen_lsp_types::*;
use item::Items;

pub(super) fn offered() -> CompletionOptions {
    let triggers = [".", ":", "$", "\"", "{"];
    CompletionOptions { trigger_characters: Some(triggers.map(String::from).to_vec()), ..CompletionOptions::default() }
}

pub(super) fn completion(server: &Server, params: CompletionParams) -> Result<Option<CompletionResponse>, Refusal> {
    let Some(typing) = Typing::at(server, &params.text_document_position_params) else { return Ok(None) };
    let mut items = Items::new(server, &typing);
    match typing.surroundings {
        Surroundings::Quiet => {}
        Surroundings::Number(start) => builtin::units(server, &typing, start, &mut items),
        Surroundings::Import(start) => own::files(server, &typing, start, &mut items),
        Surroundings::Type => builtin::types(server.family(&typing.path), &mut items),
        Surroundings::Statement | Surroundings::Code => at_name(server, &typing, &mut items),
    }
    // Once the first letter of a name is typed, more items fit.
    let is_incomplete = !items.is_begun();
    let list = CompletionList { is_incomplete, items: items.finish(), ..CompletionList::default() };
    Ok(Some(CompletionResponse::CompletionList(list)))
}

/// What is possible where a name may begin.
fn at_name(server: &Server, typing: &Typing<'_>, items: &mut Items) {
    let family = server.family(&typing.path);
    let is_statement = typing.surroundings == Surroundings::Statement;
    let Some((expected, program)) = typing.expectation(server) else {
        // A text that cannot be read gives no expectation; outside functions the checker has none.
        if is_statement && is_outside(server, typing) {
            builtin::words_outside(items);
            builtin::types(family, items);
        }
        return;
    };
    let index = program.index();
    let fits = Fits::of(&expected, family);
    match &expected.wanted {
        Wanted::System => builtin::system_variables(&fits, items),
        Wanted::Component(id) => builtin::components(*id, family, &[], items),
        Wanted::ComponentName(id) => {
            let taken = expected.braces.as_ref().map(|(_, taken)| taken.as_slice()).unwrap_or_default();
            builtin::components(*id, family, taken, items);
        }
        Wanted::EnumConstant(id) => builtin::enum_constants(*id, items),
        Wanted::Member(module) => own::members(&program, *module, &fits, family, items),
        Wanted::Label(labels) => own::labels(labels, items),
        Wanted::Type => builtin::types(family, items),
        Wanted::Nothing => {}
        Wanted::ArgumentLabel => argument_labels(&expected, index, family, items),
        Wanted::Instruction | Wanted::Function | Wanted::Value(_) if is_statement => {
            builtin::words_inside(items);
            builtin::instructions(family, items);
            builtin::types(family, items);
            own::names(&program, &expected, &Fits::Statement, family, items);
            builtin::functions(&Fits::Statement, family, items);
        }
        Wanted::Instruction => builtin::instructions(family, items),
        Wanted::Function | Wanted::Value(_) | Wanted::Action => {
            values(&program, &expected, &fits, family, items);
        }
    }
}

/// Whether the cursor is outside all functions.
fn is_outside(server: &Server, typing: &Typing<'_>) -> bool {
    let inside = |file: File| file.index().function_at(file.id, typing.offset).is_some();
    !server.file(&typing.path).is_some_and(inside)
}

fn values(program: &Program, expected: &Expectation, fits: &Fits, family: Family, items: &mut Items) {
    if expected.arguments.as_ref().is_some_and(|list| list.may_be_label) {
        argument_labels(expected, program.index(), family, items);
    }
    if let Some((id, taken)) = &expected.braces {
        builtin::components(*id, family, taken, items);
    }
    own::names(program, expected, fits, family, items);
    builtin::functions(fits, family, items);
    builtin::constants(fits, items);
}

/// The labels of the parameters that are free.
fn argument_labels(expected: &Expectation, index: &Index, family: Family, items: &mut Items) {
    let Some(list) = &expected.arguments else { return };
    match list.callee {
        Callee::Builtin(entry) => {
            let named = |name: &str| entry.params.iter().position(|param| param.name == name);
            let is_given = |name: &str| named(name).is_some_and(|at| count(list, at) > 0);
            for (at, param) in entry.params.iter().enumerate() {
                let rivals = entry.exclusive.iter().filter(|group| group.contains(&param.name));
                let excluded = rivals.flat_map(|group| group.iter()).any(|rival| is_given(rival));
                if is_free(list, entry, at, family) && !excluded {
                    items.argument_label(entry, param);
                }
            }
        }
        Callee::Function(id) => {
            let params = index.function(id).map(|function| function.params.as_slice()).unwrap_or_default();
            for (at, (name, ..)) in params.iter().enumerate() {
                if count(list, at) == 0 {
                    items.own_label(name);
                }
            }
        }
    }
}

fn count(list: &ArgumentList, parameter: usize) -> usize {
    list.taken.get(parameter).copied().unwrap_or(0)
}

/// Whether a parameter takes one more argument, for robots of a family.
fn is_free(list: &ArgumentList, entry: &Entry, at: usize, family: Family) -> bool {
    let param = entry.params.get(at).filter(|param| param.is_of(family));
    let most = match param.map(|param| param.presence) {
        Some(Presence::Repeat { max: u8::MAX, .. }) => usize::MAX,
        Some(Presence::Repeat { max, .. }) => usize::from(max),
        Some(_) => 1,
        None => 0,
    };
    count(list, at) < most
}

/// The requirement on a value.
#[derive(Clone, PartialEq, Debug)]
enum Fits {
    /// It begins a statement: anything that can be assigned or called.
    Statement,
    /// Any value.
    Any,
    /// A call: the action of an event.
    Call,
    /// A value that one of these takes.
    OneOf(Vec<ParamType>),
    /// An array of this type, sizes included.
    Array(Type),
}

impl Fits {
    /// What the checker expects: the wanted type, or those of the free parameters of an instruction.
    fn of(expected: &Expectation, family: Family) -> Self {
        let list = expected.arguments.as_ref();
        if let Some((entry, list)) = list.and_then(|list| match list.callee {
            Callee::Builtin(entry) => Some((entry, list)),
            Callee::Function(_) => None,
        }) {
            return Self::of_built_in(expected, entry, list, family);
        }
        match expected.wanted {
            Wanted::Action => Self::Call,
            Wanted::Value(Some(ty)) if ty.is_array() => Self::Array(ty),
            Wanted::Value(Some(ty)) => Self::OneOf(vec![ParamType::One(ty.base)]),
            _ => Self::Any,
        }
    }

    fn of_built_in(expected: &Expectation, entry: &Entry, list: &ArgumentList, family: Family) -> Self {
        if let Wanted::Value(Some(ty)) = expected.wanted {
            return if ty.is_array() { Self::Array(ty) } else { Self::OneOf(vec![ParamType::One(ty.base)]) };
        }
        if let Some(param) = list.parameter.and_then(|at| entry.params.get(at)) {
            return match param.mode {
                Mode::Action => Self::Call,
                Mode::Condition => Self::OneOf(vec![ParamType::One(Base::Bool)]),
                _ => Self::OneOf(vec![param.ty]),
            };
        }
        if !list.may_be_label || entry.kind == Kind::Function {
            return Self::Any;
        }
        let bare = (0..).zip(entry.params).filter(|(at, param)| param.bare && is_free(list, entry, *at, family));
        Self::OneOf(bare.map(|(_, param)| param.ty).collect())
    }

    /// Whether a value of this type fits.
    fn takes(&self, ty: Type) -> bool {
        match self {
            Self::Statement | Self::Any => true,
            Self::Call => false,
            Self::Array(wanted) => ty == *wanted,
            Self::OneOf(types) => types.iter().any(|wanted| takes(wanted, ty)),
        }
    }

    /// Whether a variable of this type fits: by itself, by an element, or, once its name is begun, by a component.
    /// Almost every point has a number somewhere: without a name those would be too many.
    fn takes_part_of(&self, ty: Type, family: Family, is_begun: bool) -> bool {
        let by_component = match (self, ty.base) {
            (Self::OneOf(_), Base::Struct(id)) if is_begun => {
                let components = id.def(family).components.iter();
                components.into_iter().any(|component| self.takes(Type::scalar(component.ty)))
            }
            _ => false,
        };
        self.takes(ty) || ty.is_array() && self.takes(ty.element()) || by_component || self.may_compare(ty)
    }

    /// Whether a condition may begin with a value of this type: it is compared with something.
    fn may_compare(&self, ty: Type) -> bool {
        let is_condition = matches!(self, Self::OneOf(types) if types.contains(&ParamType::One(Base::Bool)));
        is_condition && !ty.is_array() && (is_number(ty.base) || matches!(ty.base, Base::String | Base::Enum(_)))
    }
}

fn takes(wanted: &ParamType, ty: Type) -> bool {
    match wanted {
        ParamType::Any => !matches!(ty.base, Base::Void | Base::Handle(_)),
        ParamType::Array(base) => ty.dims().len() == 1 && ty.base == *base,
        ParamType::AnyOf(bases) => !ty.is_array() && bases.contains(&ty.base),
        ParamType::One(base) => !ty.is_array() && (ty.base == *base || is_number(ty.base) && is_number(*base)),
    }
}

fn is_number(base: Base) -> bool {
    matches!(base, Base::Int | Base::Uint | Base::Byte | Base::Double)
}
