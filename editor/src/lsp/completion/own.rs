//! What the program itself declares.

use super::Fits;
use super::item::{Items, Rank};
use crate::lsp::describe::describe;
use crate::lsp::programs::Program;
use crate::lsp::server::Server;
use crate::lsp::typing::Typing;
use arl_lang::catalog::{Base, Family};
use arl_lang::files::is_data;
use arl_lang::span::Span;
use arl2rs::check::{base_name, imported, type_name};
use arl2rs::hir::{FuncId, GlobalId, ModuleId, Type};
use arl2rs::index::{Expectation, HERE, Index, Meaning};
use gen_lsp_types::CompletionItemKind;
use std::path::Path;

/// The variables, functions and modules that are known at a place.
pub(super) fn names(program: &Program, expected: &Expectation, fits: &Fits, family: Family, items: &mut Items) {
    for (name, ty, at) in &expected.locals {
        variable(program, name, *ty, Meaning::Local(*at), Rank::Local, fits, family, items);
    }
    let index = program.index();
    let data = index.module(expected.module).and_then(|module| module.data);
    for (id, global) in (0..).map(GlobalId).zip(&index.globals) {
        let own = global.module == expected.module && global.item < expected.item;
        if own || Some(global.module) == data {
            variable(program, &global.name, global.ty, Meaning::Global(id), Rank::Global, fits, family, items);
        }
    }
    for (id, function) in (0..).map(FuncId).zip(&index.functions) {
        if function.module == expected.module && function.item <= expected.item {
            self::function(program, id, fits, family, items);
        }
    }
    let modules = index.module(expected.module).map(|module| module.imports.as_slice()).unwrap_or_default();
    for (name, id) in modules {
        if !name.contains(&HERE.to_ascii_lowercase()) && offers(program, *id, fits, family, items.is_begun()) {
            items.add(&format!("{name}::"), CompletionItemKind::Module, Rank::Function, "module".into());
        }
    }
}

/// Whether a module has anything that fits.
fn offers(program: &Program, module: ModuleId, fits: &Fits, family: Family, is_begun: bool) -> bool {
    let index = program.index();
    let variable = |ty: Option<Type>| ty.is_some_and(|ty| fits.takes_part_of(ty, family, is_begun));
    index.globals.iter().any(|global| global.module == module && variable(global.ty))
        || index.functions.iter().any(|function| function.module == module && returns(function.result, fits))
}

fn returns(result: Option<Base>, fits: &Fits) -> bool {
    match fits {
        Fits::Statement | Fits::Call => true,
        _ => result.is_some_and(|base| base != Base::Void && fits.takes(Type::scalar(base))),
    }
}

#[expect(clippy::too_many_arguments, reason = "what is known of a variable, and where it goes")]
fn variable(
    program: &Program,
    name: &str,
    ty: Option<Type>,
    meaning: Meaning,
    rank: Rank,
    fits: &Fits,
    family: Family,
    items: &mut Items,
) {
    let Some(ty) = ty else { return };
    let (is_whole, is_begun) = (fits.takes(ty), items.is_begun());
    if name.contains(HERE) || !is_whole && !fits.takes_part_of(ty, family, is_begun) {
        return;
    }
    let constant = match meaning {
        Meaning::Local(at) => program.index().local(at).is_some_and(|info| info.constant),
        Meaning::Global(id) => program.index().global(id).is_some_and(|global| global.constant),
        _ => false,
    };
    // A constant does not begin a statement.
    if constant && *fits == Fits::Statement {
        return;
    }
    let kind = if constant { CompletionItemKind::Constant } else { CompletionItemKind::Variable };
    let rank = if is_whole { rank } else { Rank::Part };
    let doc = describe(program, meaning, family).unwrap_or_default();
    items.documented(name, kind, rank, type_name(ty, family), &doc);
}

fn function(program: &Program, id: FuncId, fits: &Fits, family: Family, items: &mut Items) {
    let Some(function) = program.index().function(id) else { return };
    let is_main = function.name.eq_ignore_ascii_case("main");
    if is_main || function.name.contains(HERE) || !returns(function.result, fits) {
        return;
    }
    let result = function.result.map_or("?", |base| base_name(base, family));
    let takes = function.params.iter().map(|(_, ty, _)| ty.map_or_else(|| "?".into(), |ty| type_name(ty, family)));
    let detail = format!("{result} ({})", takes.collect::<Vec<_>>().join(", "));
    let doc = describe(program, Meaning::Function(id), family);
    items.function(&function.name, !function.params.is_empty(), Rank::Function, detail, doc);
}

/// The names after `module::`.
pub(super) fn members(program: &Program, module: ModuleId, fits: &Fits, family: Family, items: &mut Items) {
    let index: &Index = program.index();
    for (id, global) in (0..).map(GlobalId).zip(&index.globals).filter(|(_, global)| global.module == module) {
        variable(program, &global.name, global.ty, Meaning::Global(id), Rank::Global, fits, family, items);
    }
    for (id, _) in (0..).map(FuncId).zip(&index.functions).filter(|(_, function)| function.module == module) {
        function(program, id, fits, family, items);
    }
}

/// The labels of `goto`.
pub(super) fn labels(labels: &[String], items: &mut Items) {
    for label in labels {
        items.add(label, CompletionItemKind::Reference, Rank::Local, "label".into());
    }
}

/// The programs that an `import` can name, and the folders that lead to them.
pub(super) fn files(server: &Server, typing: &Typing<'_>, start: u32, items: &mut Items) {
    let typed = Span::new(start, typing.offset).text(typing.text.text);
    let Some(folder) = typing.path.parent() else { return };
    let (before, name_start) = match typed.rfind('/') {
        Some(at) => (typed.get(..=at).unwrap_or_default(), start + at as u32 + 1),
        None => ("", start),
    };
    items.replace(typing.text.range(Span::new(name_start, typing.offset)));
    let main = server.root(&typing.path);
    let root = main.parent().unwrap_or(folder);
    let looked_into = imported(before, folder, root, server.options_of(&main).script_dir.as_deref());
    let Ok(entries) = std::fs::read_dir(looked_into) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = entry.path();
        if path.is_dir() && !name.starts_with('.') {
            items.add(&format!("{name}/"), CompletionItemKind::Folder, Rank::Global, String::new());
        } else if is_module(&path) && path != typing.path {
            items.add(&name, CompletionItemKind::File, Rank::Local, String::new());
        }
    }
}

/// Whether a file is one that programs import: a data file is read without an import.
fn is_module(path: &Path) -> bool {
    crate::lsp::workspace::is_program(path) && !is_data(path)
}
