//! Completions from the language itself.

use super::Fits;
use super::item::{Items, Rank};
use crate::lsp::server::Server;
use crate::lsp::typing::Typing;
use arl_lang::catalog::{self, Base, ConstantValue, Entry, Enum, Family, Kind, ParamType, Struct, reference};
use arl_lang::control_words;
use arl_lang::span::Span;
use arl2rs::check::base_name;
use arl2rs::hir::Type;
use arl2rs::index::Callee;
use gen_lsp_types::CompletionItemKind;

/// The words that begin something outside functions.
const OUTSIDE: [&str; 3] = ["const", "func", "import"];

/// The control words that begin no statement.
const NO_STATEMENT: [&str; 5] = ["endl", "false", "func", "import", "true"];

/// The words that begin something outside functions.
pub(super) fn words_outside(items: &mut Items) {
    keywords(&OUTSIDE, items);
}

/// The words that begin, divide or end something inside functions.
pub(super) fn words_inside(items: &mut Items) {
    let words: Vec<&str> = control_words().filter(|word| !NO_STATEMENT.contains(word)).collect();
    keywords(&words, items);
}

fn keywords(words: &[&str], items: &mut Items) {
    words.iter().for_each(|word| items.add(word, CompletionItemKind::Keyword, Rank::Keyword, String::new()));
}

/// The types that a variable can have, and `void`.
pub(super) fn types(family: Family, items: &mut Items) {
    for (_, base) in catalog::type_names() {
        let of_family = match base {
            Base::Struct(id) => id.def(family).family.is_none_or(|only| only == family),
            _ => true,
        };
        if of_family {
            let kind = match base {
                Base::Struct(_) | Base::Handle(_) => CompletionItemKind::Struct,
                Base::Enum(_) => CompletionItemKind::Enum,
                _ => CompletionItemKind::Keyword,
            };
            items.add(base_name(base, family), kind, Rank::BuiltIn, "type".into());
        }
    }
}

fn is_of(entry: &Entry, family: Family) -> bool {
    entry.family.is_none_or(|only| only == family)
}

/// All instructions.
pub(super) fn instructions(family: Family, items: &mut Items) {
    let all = catalog::all_entries().iter();
    for entry in all.filter(|entry| entry.kind == Kind::Instruction && is_of(entry, family)) {
        let signature = reference::signature(entry, Some(family));
        items.documented(entry.name, CompletionItemKind::Method, Rank::BuiltIn, signature, &reference::entry(entry));
    }
}

/// The functions whose result fits.
pub(super) fn functions(fits: &Fits, family: Family, items: &mut Items) {
    let fitting = |entry: &&Entry| match fits {
        // A function that only computes has no effect as a statement.
        Fits::Statement | Fits::Call => entry.effect != catalog::Effect::Pure,
        _ => entry.result != Base::Void && fits.takes(Type::scalar(entry.result)),
    };
    let all = catalog::all_entries().iter();
    for entry in all.filter(|entry| entry.kind == Kind::Function && is_of(entry, family)).filter(fitting) {
        let detail = reference::signature(entry, Some(family));
        let doc = reference::entry(entry);
        items.function(entry.name, !entry.params.is_empty(), Rank::BuiltIn, detail, Some(doc));
    }
}

/// Constants with plain names, constants of the enumeration that is wanted, `true` and `false`.
pub(super) fn constants(fits: &Fits, items: &mut Items) {
    for constant in catalog::constants() {
        let base = match constant.value {
            ConstantValue::Double(_) => Base::Double,
            ConstantValue::String(_) => Base::String,
        };
        if fits.takes(Type::scalar(base)) {
            let kind = CompletionItemKind::Constant;
            items.documented(constant.name, kind, Rank::BuiltIn, String::new(), constant.doc);
        }
    }
    if fits.takes(Type::scalar(Base::Bool)) {
        keywords(&["true", "false"], items);
    }
    if let Fits::OneOf(types) = fits {
        for ty in types {
            let bases: &[Base] = match ty {
                ParamType::One(base) => std::slice::from_ref(base),
                ParamType::AnyOf(bases) => bases,
                _ => &[],
            };
            for base in bases {
                if let Base::Enum(id) = base {
                    enum_constants(*id, items);
                }
            }
        }
    }
}

/// The constants of an enumeration.
pub(super) fn enum_constants(id: Enum, items: &mut Items) {
    for constant in id.def().constants {
        let kind = CompletionItemKind::EnumMember;
        items.documented(constant.name, kind, Rank::Constant, id.def().name.into(), constant.doc);
    }
}

/// System variables, with their `$`.
pub(super) fn system_variables(fits: &Fits, items: &mut Items) {
    for variable in catalog::system_variables() {
        let Some(ty) = Type::array(variable.ty, variable.dims) else { continue };
        let rank = if fits.takes(ty) { Rank::Global } else { Rank::Part };
        let name = format!("${}", variable.name);
        let doc = reference::system_variable(variable);
        items.documented(&name, CompletionItemKind::Variable, rank, variable.ty.name().into(), &doc);
        let rank = if fits.takes(ty.element()) { Rank::Global } else { Rank::Part };
        for (at, element) in variable.element_names().enumerate() {
            let doc = format!("`{name}[{at}]` by its default name.");
            items.documented(
                &format!("${element}"),
                CompletionItemKind::Variable,
                rank,
                ty.element().base.name().into(),
                &doc,
            );
        }
    }
}

/// The components of a structure that are not given yet.
pub(super) fn components(id: Struct, family: Family, taken: &[bool], items: &mut Items) {
    for (at, component) in id.def(family).components.iter().enumerate() {
        if !taken.get(at).copied().unwrap_or(false) {
            let detail = component.ty.name().to_string();
            items.documented(component.name, CompletionItemKind::Field, Rank::Label, detail, component.doc);
        }
    }
}

/// The units that may follow the number at the cursor.
pub(super) fn units(server: &Server, typing: &Typing<'_>, start: u32, items: &mut Items) {
    let Some(file) = typing.without_word(server) else { return };
    let mut here = file.index().arguments(file.id).filter(|argument| argument.at.span.start == start);
    let Some(argument) = here.next() else { return };
    let Callee::Builtin(entry) = argument.callee else { return };
    let Some(param) = entry.params.get(argument.parameter) else { return };
    items.replace(typing.text.range(Span::new(typing.word.start, typing.offset)));
    for unit in param.units {
        items.add(unit.text(), CompletionItemKind::Unit, Rank::Label, String::new());
    }
}
