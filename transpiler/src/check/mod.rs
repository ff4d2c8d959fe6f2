//! The checker: files in, a checked program and diagnostics out.
//!
//! One file per concern: `load` reads the files, `declare` handles globals and signatures, `statements` and `expr`
//! (with `name`, `place`, `operators`, `brace`, `call`, `arguments`, `convert`) check function bodies; `flow`,
//! `conditions`, `first_motion` and `targets` look at the finished functions.

mod arguments;
mod brace;
mod call;
#[cfg(feature = "tools")]
mod cell;
mod conditions;
mod context;
mod convert;
mod declare;
mod doubts;
mod expr;
mod first_motion;
mod flow;
mod load;
mod mention;
mod name;
mod operators;
mod place;
mod statements;
#[cfg(feature = "tools")]
mod targets;
mod uses;

use crate::diagnostics::flow::FlowProblem;
use crate::diagnostics::{Diagnostic, FileId, Files, Location, Severity};
use crate::hir::{self, FuncId, GlobalId, ModuleId, Program};
use crate::{CheckOptions, Checked, Sources};
use arl_lang::catalog::Base;
use arl_lang::span::Span;
use context::Checker;
pub use context::{base_name, type_name};
use load::{Loaded, LoadedModule, Start};
pub use load::{clean, imported};
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// Checks the program whose main file is `main`.
pub fn check(main: &Path, sources: &dyn Sources, options: &CheckOptions) -> Checked {
    check_loaded(load::load(main, Start::File, sources, options), options).0
}

/// Checks a program whose main file has this text; `main` is the path that it would have.
pub fn check_text(main: &Path, text: &str, sources: &dyn Sources, options: &CheckOptions) -> Checked {
    check_loaded(load::load(main, Start::Text(text), sources, options), options).0
}

/// Checks statements, as they may stand in an ARL function, with Rust values spliced in. The resulting program contains
/// them as the body of its only function, `fragment`.
pub fn check_statements(
    place: &Path,
    text: &str,
    sources: &dyn Sources,
    options: &CheckOptions,
) -> (Checked, Vec<SplicedValue>) {
    let options = CheckOptions { library: true, ..options.clone() };
    check_loaded(load::load(place, Start::Statements(text), sources, &options), &options)
}

/// A Rust value in ARL statements: `#name`, `#(expression)`, `#(expression as double)`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct SplicedValue {
    /// The Rust expression in the text, without `#`, parentheses and the ARL type.
    pub rust: Span,
    /// The ARL type after `as`.
    pub ty: Option<Base>,
}

/// The Rust expression of a splice, and its ARL type if it ends in ` as type`. A Rust cast such as `as f64` stays.
fn spliced_value(text: &str, splice: &arl_lang::Splice) -> SplicedValue {
    let inside = splice.span.text(text);
    let typed = inside.rfind(" as ").and_then(|at| {
        let name = inside.get(at + 4..)?.trim();
        let base = arl_lang::catalog::base_type(name).filter(|base| *base != Base::Void)?;
        Some((at, base))
    });
    match typed.filter(|_| splice.parenthesised) {
        Some((at, base)) => {
            SplicedValue { rust: Span::new(splice.span.start, splice.span.start + at as u32), ty: Some(base) }
        }
        None => SplicedValue { rust: splice.span, ty: None },
    }
}

fn check_loaded(loaded: Loaded, options: &CheckOptions) -> (Checked, Vec<SplicedValue>) {
    let Loaded { modules, names, files, read, diagnostics, splices, .. } = loaded;
    let main_text = files.iter().next().map(|(_, file)| file.text.as_str()).unwrap_or_default();
    let spliced: Vec<SplicedValue> = splices.iter().map(|splice| spliced_value(main_text, splice)).collect();
    let errors = diagnostics.iter().filter(|diagnostic| diagnostic.severity == Severity::Error).count();
    let mut checker = Checker {
        names: &names,
        modules: &modules,
        files: &files,
        options,
        scopes: Vec::new(),
        globals: Vec::new(),
        funcs: Vec::new(),
        diagnostics,
        used_modules: HashSet::new(),
        splices: spliced.iter().map(|splice| splice.ty.map(hir::Type::scalar)).collect(),
        functions: HashMap::new(),
        errors,
        hints: crate::near::Hints::default(),
        has_conditions: false,
        recorder: options.index.then(|| Box::new(mention::Recorder::new(&files))),
    };
    checker.collect(&first_values_order(&modules));
    checker.mention_declarations();
    (0..checker.globals.len()).for_each(|at| checker.check_global(GlobalId(at as u32)));
    (0..checker.funcs.len()).for_each(|at| checker.check_func(FuncId(at as u32)));
    let main_func = checker.find_main();
    checker.unused_imports();
    let index = checker.take_index();
    let refused = checker.diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error);
    let (mut program, mut diagnostics) = (None, Vec::new());
    if refused {
        diagnostics = std::mem::take(&mut checker.diagnostics);
        drop_guesses(&mut diagnostics);
    } else {
        let has_conditions = checker.has_conditions;
        let built = checker.into_program(main_func, &mut diagnostics);
        let locate = |module: ModuleId, span: Span| Location {
            file: modules.get(module.0 as usize).map_or(FileId(0), |module| module.file),
            span,
        };
        let mut late = if has_conditions { conditions::check(&built, &locate) } else { Vec::new() };
        late.extend(first_motion::check(&built, &locate));
        diagnostics.extend(doubts::check(&built, &locate));
        #[cfg(feature = "tools")]
        if let Some(cell) = &options.cell {
            let (errors, warnings): (Vec<_>, Vec<_>) = cell::check(&built, cell, &locate)
                .into_iter()
                .partition(|diagnostic| diagnostic.severity == Severity::Error);
            late.extend(errors);
            diagnostics.extend(warnings);
        }
        #[cfg(feature = "tools")]
        if let Some(robot) = &options.robot {
            let alone = options.cell.as_ref().is_none_or(|cell| !cell.others);
            let in_origin = options.cell.as_ref().is_none_or(|cell| !cell.based);
            diagnostics.extend(targets::check(&built, robot, targets::Around { alone, in_origin }, &locate));
        }
        if late.is_empty() {
            program = Some(built);
        }
        diagnostics.extend(late);
    }
    // Without effects: an index is for looking up names, not for translating the program.
    if let Some(program) = program.as_mut().filter(|_| !options.index) {
        crate::effects::infer(program);
    }
    diagnostics.sort_by_key(|diagnostic| (diagnostic.primary.at, diagnostic.code));
    diagnostics.dedup();
    (Checked { program, diagnostics, files, index, _syntax: Syntax { _modules: modules }, read }, spliced)
}

/// The syntax trees of a program.
#[derive(Default)]
pub(crate) struct Syntax {
    _modules: Vec<LoadedModule>,
}

impl std::fmt::Debug for Syntax {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Syntax")
    }
}

/// The warnings about things that are unused or never reached.
pub const NOT_NEEDED: std::ops::RangeInclusive<u16> = 901..=906;

/// Removes warnings about unused and unreachable things from files with errors: the parts that could not be read or
/// understood may be the ones that use them.
fn drop_guesses(diagnostics: &mut Vec<Diagnostic>) {
    let errors = diagnostics.iter().filter(|diagnostic| diagnostic.severity == Severity::Error);
    let wrong: HashSet<FileId> = errors.map(|diagnostic| diagnostic.primary.at.file).collect();
    diagnostics.retain(|diagnostic| {
        let guess = NOT_NEEDED.contains(&diagnostic.code.0);
        !guess || !wrong.contains(&diagnostic.primary.at.file)
    });
}

/// The order in which modules are initialised: imported modules come before the modules that import them.
fn first_values_order(modules: &[LoadedModule]) -> Vec<ModuleId> {
    let mut order = Vec::new();
    let mut seen = vec![false; modules.len()];
    // An explicit stack: chains of imports may be long.
    let mut stack: Vec<(ModuleId, bool)> = (0..modules.len()).rev().map(|at| (ModuleId(at as u32), false)).collect();
    while let Some((id, done)) = stack.pop() {
        if done {
            order.push(id);
            continue;
        }
        let Some(module) = modules.get(id.0 as usize) else { continue };
        if seen.get_mut(id.0 as usize).is_none_or(|seen| std::mem::replace(seen, true)) {
            continue;
        }
        stack.push((id, true));
        let mut needed: Vec<ModuleId> = module.imports.values().copied().chain(module.data_module).collect();
        needed.sort_unstable();
        stack.extend(needed.into_iter().rev().map(|id| (id, false)));
    }
    order
}

/// Whether the word `main` occurs in a text, outside of its comments and strings.
pub fn names_main(text: &str) -> bool {
    arl_lang::lexer::lexemes(text).any(|(_, span)| span.text(text).eq_ignore_ascii_case("main"))
}

impl Checker<'_> {
    /// `main` of the main module.
    fn find_main(&mut self) -> Option<FuncId> {
        let main = ModuleId(0);
        let symbol = self.names.find("main");
        let found = symbol.and_then(|symbol| self.scopes.first()?.funcs.get(&symbol).copied());
        let Some(id) = found else {
            if !self.options.library && !self.modules.is_empty() && !self.has_unread_main() {
                self.report_in::<()>(main, self.file_start(), FlowProblem::NoMain, &[]);
            }
            return None;
        };
        let slot = self.funcs.get(id.0 as usize)?;
        let (func, result) = (slot.ast, slot.result);
        if let Some(param) = func.params.first() {
            self.report_in::<()>(main, param.span, FlowProblem::MainSignature { what: "parameters" }, &[]);
        }
        if result.is_some_and(|result| result != Base::Void) {
            self.report_in::<()>(main, func.result.span, FlowProblem::MainSignature { what: "a result" }, &[]);
        }
        Some(id)
    }

    /// Whether the main file has a `main` that could not be read; its errors are reported already.
    fn has_unread_main(&self) -> bool {
        let Some(main) = self.modules.first().map(|module| module.file) else { return false };
        let unread = |one: &Diagnostic| one.code.is_of_syntax() && one.primary.at.file == main;
        self.diagnostics.iter().any(unread) && self.files.get(main).is_some_and(|file| names_main(&file.text))
    }

    fn unused_imports(&mut self) {
        for (at, module) in self.modules.iter().enumerate() {
            let id = ModuleId(at as u32);
            for (span, imported) in &module.import_lines {
                if !self.used_modules.contains(&(id, *imported)) {
                    let name = self.module(*imported).map(|module| self.names.name(module.name).to_string());
                    let problem = FlowProblem::UnusedImport { module: name.unwrap_or_default() };
                    self.report_in::<()>(id, *span, problem, &[]);
                }
            }
        }
    }

    /// The finished program; the diagnostics (warnings only) go to `out`.
    fn into_program(mut self, main: Option<FuncId>, out: &mut Vec<Diagnostic>) -> Program {
        out.append(&mut self.diagnostics);
        let modules: Vec<hir::Module> =
            self.modules.iter().map(|module| finished_module(module, self.names, self.files)).collect();
        let mut globals = Vec::new();
        for slot in std::mem::take(&mut self.globals) {
            globals.push(hir::Global {
                name: self.names.name(slot.var.name.symbol).to_string(),
                module: slot.module,
                ty: slot.ty.unwrap_or(hir::Type::scalar(Base::Int)),
                constant: slot.decl.constant.is_some(),
                teachable: self.is_teachable(&slot),
                mutated: slot.mutated,
                value: slot.value,
                init: slot.init,
                span: slot.var.name.span,
            });
        }
        let funcs = std::mem::take(&mut self.funcs).into_iter().filter_map(|slot| slot.checked).collect();
        let name = modules.first().map(|module| module.name.clone()).unwrap_or_default();
        Program { name, family: self.options.family, modules, globals, funcs, main }
    }
}

fn finished_module(module: &LoadedModule, names: &arl_lang::symbol::Interner, files: &Files) -> hir::Module {
    let source = files.get(module.file);
    hir::Module {
        name: names.name(module.name).to_string(),
        file: source.map(|source| source.name.clone()).unwrap_or_default(),
        source: source.map(|source| source.text.clone()).unwrap_or_default(),
        data: module.data,
    }
}
