//! The state of the checker while it goes through a program.

use super::load::LoadedModule;
use super::mention::Recorder;
use crate::CheckOptions;
use crate::diagnostics::constants::ConstantProblem;
use crate::diagnostics::support::SupportProblem;
use crate::diagnostics::{Diagnostic, FileId, Files, Label, Location, Problem, Severity};
use crate::hir::{self, FuncId, GlobalId, LabelId, LocalId, ModuleId, Type, Value};
use arl_lang::ast;
use arl_lang::catalog::{self, Base, Entry, Family};
use arl_lang::span::Span;
use arl_lang::symbol::{Interner, Symbol};
use std::collections::{HashMap, HashSet};

/// The whole check: takes modules, produces a checked program and diagnostics.
pub(crate) struct Checker<'a> {
    pub(crate) names: &'a Interner,
    pub(crate) modules: &'a [LoadedModule],
    pub(crate) files: &'a Files,
    pub(crate) options: &'a CheckOptions,
    pub(crate) scopes: Vec<ModuleScope>,
    pub(crate) globals: Vec<GlobalSlot<'a>>,
    pub(crate) funcs: Vec<FuncSlot<'a>>,
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// The number of errors among the diagnostics.
    pub(crate) errors: usize,
    /// (module, module that it uses)
    pub(crate) used_modules: HashSet<(ModuleId, ModuleId)>,
    /// The ARL types of spliced Rust values, where known.
    pub(crate) splices: Vec<Option<Type>>,
    /// Catalog functions by name, looked up once per name.
    pub(crate) functions: HashMap<Symbol, &'static [Entry]>,
    /// Finds the names that were probably meant.
    pub(crate) hints: crate::near::Hints,
    /// Whether any argument is a condition, so that conditions have to be checked.
    pub(crate) has_conditions: bool,
    /// What names mean, if that is to be recorded.
    pub(crate) recorder: Option<Box<Recorder>>,
}

/// The names that one module declares.
#[derive(Default)]
pub(crate) struct ModuleScope {
    pub(crate) globals: HashMap<Symbol, GlobalId>,
    pub(crate) funcs: HashMap<Symbol, FuncId>,
}

/// How far a declaration has been checked.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum CheckState {
    Pending,
    Busy,
    Done,
}

/// A global variable and its declaration.
pub(crate) struct GlobalSlot<'a> {
    pub(crate) module: ModuleId,
    pub(crate) decl: &'a ast::Decl,
    pub(crate) var: &'a ast::Var,
    /// The number of the item in its file.
    pub(crate) item: u32,
    /// The variable of this module that already has the name.
    pub(crate) earlier: Option<GlobalId>,
    pub(crate) state: CheckState,
    /// `None` until checked, or if the declaration is wrong.
    pub(crate) ty: Option<Type>,
    pub(crate) value: Option<Value>,
    pub(crate) init: Option<hir::Expr>,
    /// Whether any statement writes it.
    pub(crate) mutated: bool,
}

/// A function, its declaration and its signature.
pub(crate) struct FuncSlot<'a> {
    pub(crate) module: ModuleId,
    pub(crate) ast: &'a ast::Func,
    pub(crate) item: u32,
    pub(crate) state: CheckState,
    pub(crate) params: Vec<Option<Type>>,
    pub(crate) result: Option<Base>,
    pub(crate) checked: Option<hir::Func>,
}

/// The state inside one function (or one initialiser).
pub(crate) struct CheckedBody {
    pub(crate) module: ModuleId,
    /// The number of the item in its file: declarations above it are visible.
    pub(crate) item: u32,
    pub(crate) func: Option<FuncId>,
    /// `None` if the declaration is wrong.
    pub(crate) result: Option<Base>,
    pub(crate) locals: Vec<hir::Local>,
    /// The types of the locals; `None` if a declaration is wrong.
    pub(crate) types: Vec<Option<Type>>,
    pub(crate) labels: Vec<hir::GotoLabel>,
    pub(crate) label_names: HashMap<Symbol, LabelId>,
    pub(crate) loops: u32,
    pub(crate) switches: u32,
    pub(crate) has_goto: bool,
    scope: HashMap<Symbol, LocalId>,
    undo: Vec<(Symbol, Option<LocalId>)>,
    /// Where the innermost scope begins in `undo`; also identifies the scope.
    begin: usize,
    /// For each local, `begin` of the scope in which it was revealed.
    homes: Vec<usize>,
}

impl CheckedBody {
    pub(crate) fn new(module: ModuleId, item: u32) -> Self {
        CheckedBody {
            module,
            item,
            func: None,
            result: Some(Base::Void),
            locals: Vec::new(),
            types: Vec::new(),
            labels: Vec::new(),
            label_names: HashMap::new(),
            loops: 0,
            switches: 0,
            has_goto: false,
            scope: HashMap::new(),
            undo: Vec::new(),
            begin: 0,
            homes: Vec::new(),
        }
    }

    /// Opens a scope; pass the result to [`CheckedBody::leave`].
    pub(crate) fn enter(&mut self) -> usize {
        std::mem::replace(&mut self.begin, self.undo.len())
    }

    /// Closes the innermost scope.
    pub(crate) fn leave(&mut self, outer: usize) {
        while self.undo.len() > self.begin {
            match self.undo.pop() {
                Some((symbol, Some(local))) => {
                    self.scope.insert(symbol, local);
                }
                Some((symbol, None)) => {
                    self.scope.remove(&symbol);
                }
                None => {}
            }
        }
        self.begin = outer;
    }

    /// The variable that the name means at this point.
    pub(crate) fn find(&self, symbol: Symbol) -> Option<LocalId> {
        self.scope.get(&symbol).copied()
    }

    /// The names of all locals visible at this point.
    pub(crate) fn visible(&self) -> impl ExactSizeIterator<Item = Symbol> {
        self.scope.keys().copied()
    }

    /// All locals visible at this point, with their names.
    pub(crate) fn visible_locals(&self) -> impl Iterator<Item = (Symbol, LocalId)> {
        self.scope.iter().map(|(symbol, local)| (*symbol, *local))
    }

    /// The variable of this name in the innermost scope.
    pub(crate) fn find_innermost(&self, symbol: Symbol) -> Option<LocalId> {
        self.find(symbol).filter(|local| self.homes.get(local.0 as usize) == Some(&self.begin))
    }

    /// Adds a variable; it becomes visible with [`CheckedBody::reveal`].
    pub(crate) fn add_local(&mut self, local: hir::Local, ty: Option<Type>) -> LocalId {
        self.locals.push(local);
        self.types.push(ty);
        self.homes.push(usize::MAX);
        LocalId(self.locals.len() as u32 - 1)
    }

    /// Makes a variable visible under its name.
    pub(crate) fn reveal(&mut self, symbol: Symbol, local: LocalId) {
        let hidden = self.scope.insert(symbol, local);
        self.undo.push((symbol, hidden));
        if let Some(home) = self.homes.get_mut(local.0 as usize) {
            *home = self.begin;
        }
    }

    pub(crate) fn local(&mut self, id: LocalId) -> Option<&mut hir::Local> {
        self.locals.get_mut(id.0 as usize)
    }

    pub(crate) fn local_type(&self, id: LocalId) -> Option<Type> {
        self.types.get(id.0 as usize).copied().flatten()
    }
}

impl<'a> Checker<'a> {
    pub(crate) fn family(&self) -> Family {
        self.options.family
    }

    pub(crate) fn module(&self, id: ModuleId) -> Option<&'a LoadedModule> {
        self.modules.get(id.0 as usize)
    }

    pub(crate) fn file(&self, module: ModuleId) -> FileId {
        self.module(module).map_or(FileId(0), |module| module.file)
    }

    pub(crate) fn location(&self, module: ModuleId, span: Span) -> Location {
        Location { file: self.file(module), span }
    }

    /// The source text at a span, as the programmer wrote it.
    pub(crate) fn text(&self, module: ModuleId, span: Span) -> &'a str {
        let files: &'a Files = self.files;
        files.get(self.file(module)).map_or("", |file| span.text(&file.text))
    }

    /// The source text at a span, as a message can show it: on one line and shortened if it is long.
    pub(crate) fn excerpt(&self, module: ModuleId, span: Span) -> String {
        const MOST: usize = 40;
        let words = self.text(module, span).split_whitespace().filter(|word| *word != "\\");
        let line = words.collect::<Vec<_>>().join(" ");
        match line.char_indices().nth(MOST) {
            Some((cut, _)) => format!("{}...", line.get(..cut).unwrap_or_default()),
            None => line,
        }
    }

    /// Reports a problem. The result is always `None`, so that `return self.report(..)` gives up on an expression.
    pub(crate) fn report<T>(&mut self, body: &CheckedBody, span: Span, problem: impl Problem) -> Option<T> {
        self.report_in(body.module, span, problem, &[])
    }

    /// Reports a problem together with other positions that explain it.
    pub(crate) fn report_in<T>(
        &mut self,
        module: ModuleId,
        span: Span,
        problem: impl Problem,
        labels: &[(ModuleId, Span, &str)],
    ) -> Option<T> {
        let mut diagnostic = problem.at(self.location(module, span));
        diagnostic.labels = labels
            .iter()
            .map(|(module, span, text)| Label { at: self.location(*module, *span), text: (*text).into() })
            .collect();
        self.errors += usize::from(diagnostic.severity == Severity::Error);
        self.diagnostics.push(diagnostic);
        None
    }

    /// Must be called for everything that is left out of the program: the reason must have been reported. A program
    /// must never silently lose a statement, so if no error was reported, the program is refused.
    pub(crate) fn must_be_reported(&mut self, module: ModuleId, span: Span) {
        if self.errors == 0 {
            self.report_in::<()>(module, span, SupportProblem::Lost, &[]);
        }
    }

    /// With `--strict`, warns if the spelling of a name differs in case from its declaration, or comes from another
    /// edition of the language.
    pub(crate) fn strict_case(&mut self, body: &CheckedBody, span: Span, declared: &str) {
        if !self.options.strict {
            return;
        }
        let written = self.text(body.module, span);
        if written != declared && written.eq_ignore_ascii_case(declared) {
            let problem = ConstantProblem::OtherCase { declared: declared.to_string() };
            self.report::<()>(body, span, problem);
        } else if catalog::is_of_other_edition(written) && written != declared {
            let what = format!("`{written}`, which is `{declared}` there");
            self.strict_form(body, span, &what);
        }
    }

    /// With `--strict`, warns about a form that the manual does not describe.
    pub(crate) fn strict_form(&mut self, body: &CheckedBody, span: Span, what: &str) {
        if self.options.strict {
            self.report::<()>(body, span, ConstantProblem::Extended { what: what.into() });
        }
    }

    /// The name of a type in the manual's spelling: `int`, `int[3]`, `Centroid_Pos`.
    pub(crate) fn type_name(&self, ty: Type) -> String {
        type_name(ty, self.family())
    }

    /// The name of a base type.
    pub(crate) fn base_name(&self, base: Base) -> &'static str {
        base_name(base, self.family())
    }
}

/// The name of a type in the manual's spelling, with the sizes of an array.
pub fn type_name(ty: Type, family: Family) -> String {
    let sizes: String = ty.dims().iter().map(|size| format!("[{size}]")).collect();
    format!("{}{sizes}", base_name(ty.base, family))
}

/// The name of a base type in the manual's spelling.
pub fn base_name(base: Base, family: Family) -> &'static str {
    match base {
        Base::Void => "void",
        Base::Int => "int",
        Base::Uint => "uint",
        Base::Byte => "byte",
        Base::Double => "double",
        Base::Bool => "bool",
        Base::String => "string",
        Base::Struct(id) => id.def(family).name,
        Base::Enum(id) => id.def().name,
        Base::Handle(id) => id.def().name,
    }
}
