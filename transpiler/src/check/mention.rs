//! Records what names mean, for editors: called wherever the checker has resolved a name. Does nothing without
//! [`CheckOptions::index`](crate::CheckOptions).

use super::arguments::CheckedCallee;
use super::context::{CheckedBody, Checker};
use crate::diagnostics::Files;
use crate::hir::{FuncId, ModuleId, Type};
use crate::index::{
    self, Argument, ArgumentList, Expectation, FunctionInfo, GlobalInfo, HERE, Index, LocalInfo, MARKER, Meaning,
    Mention, ModuleInfo, Role, Wanted,
};
use arl_lang::ast;
use arl_lang::catalog::{Entry, Struct};
use arl_lang::lexer::Lexeme;
use arl_lang::span::Span;
use arl_lang::symbol::Symbol;

/// What is recorded while a program is checked.
///
/// What may stand at the word `HERE` is recorded in two steps. First, the code that reads the arguments or braces
/// containing the word records them ([`Checker::expect_argument`], [`Checker::expect_in_braces`]); an inner call or
/// inner braces record theirs later and replace the earlier ones. Then the code that looks the word up without finding
/// it records what was looked for ([`Checker::expect`]), together with the earlier record. Code that is checked twice
/// is recorded twice; the second time a type is wanted, so the last record stays, with the arguments of the first.
#[derive(Default)]
pub(crate) struct Recorder {
    index: Index,
    /// Whether any file contains the marker word, which stands for text that is not typed yet.
    is_marked: bool,
    /// The arguments being bound, if the marker word is one of them.
    arguments: Option<ArgumentList>,
    /// The braces being read, if they contain the marker word.
    braces: Option<(Struct, Vec<bool>)>,
}

impl Recorder {
    /// A recorder for a program with these files.
    pub(crate) fn new(files: &Files) -> Self {
        let is_marked = files.iter().any(|(_, file)| file.text.contains(HERE));
        Self { is_marked, ..Self::default() }
    }
}

impl Checker<'_> {
    /// Records what the name at `span` means.
    pub(crate) fn mention(&mut self, body: &CheckedBody, span: Span, meaning: Meaning) {
        self.mention_in(body.module, span, meaning, Role::Uses);
    }

    /// Records what the name at `span` in a module's file means.
    pub(crate) fn mention_in(&mut self, module: ModuleId, span: Span, meaning: Meaning, role: Role) {
        if self.recorder.is_none() || span.start == span.end {
            return;
        }
        let at = self.location(module, span);
        if let Some(recorder) = &mut self.recorder {
            recorder.index.mentions.push(Mention { at, meaning, role });
        }
    }

    /// Records what the name `symbol` means. Under `span` it may be in parentheses or after `module::`.
    pub(crate) fn mention_within(&mut self, body: &CheckedBody, span: Span, symbol: Symbol, meaning: Meaning) {
        if self.recorder.is_some() {
            let span = self.name_within(body, span, symbol);
            self.mention(body, span, meaning);
        }
    }

    /// The position of the name itself in a span that may also contain parentheses, comments and `module::`.
    fn name_within(&self, body: &CheckedBody, span: Span, symbol: Symbol) -> Span {
        let name = self.names.name(symbol);
        let text = self.text(body.module, span);
        if text.len() == name.len() {
            return span;
        }
        let words = arl_lang::lexer::lexemes(text)
            .filter(|(lexeme, at)| *lexeme == Ok(Lexeme::Word) && at.text(text).eq_ignore_ascii_case(name));
        match words.last() {
            Some((_, at)) => Span::new(span.start + at.start, span.start + at.end),
            None => span,
        }
    }

    /// Records that the place beginning at `start` is written.
    pub(crate) fn mention_written(&mut self, body: &CheckedBody, start: u32) {
        let file = self.file(body.module);
        let Some(recorder) = &mut self.recorder else { return };
        let is_root = |mention: &&mut Mention| {
            let variable = matches!(mention.meaning, Meaning::Local(_) | Meaning::Global(_) | Meaning::System(_));
            variable && mention.at.file == file && mention.at.span.start >= start
        };
        // The root has just been recorded; indices after it, which may also mention variables, begin further right.
        let recent = recorder.index.mentions.iter_mut().rev().take_while(|mention| mention.at.span.start >= start);
        if let Some(mention) = recent.filter(is_root).last() {
            mention.role = Role::Writes;
        }
    }

    /// Records a local variable at its declaration.
    pub(crate) fn mention_local(&mut self, body: &CheckedBody, name: ast::Ident, info: LocalInfo) {
        let at = self.location(body.module, name.span);
        if let Some(recorder) = &mut self.recorder {
            recorder.index.locals.insert(at, info);
        }
        self.mention_in(body.module, name.span, Meaning::Local(at), Role::Declares);
    }

    /// Records which parameter an argument goes to.
    pub(crate) fn mention_argument(
        &mut self,
        body: &CheckedBody,
        callee: &CheckedCallee,
        name: Span,
        arg: &ast::Arg,
        param: usize,
    ) {
        if self.recorder.is_none() {
            return;
        }
        let argument = Argument {
            at: self.location(body.module, arg.value.span),
            of: self.location(body.module, name),
            callee: callee.indexed(),
            parameter: param,
            labelled: arg.label.is_some(),
            unit: arg.unit.is_some(),
        };
        if let Some(recorder) = &mut self.recorder {
            recorder.index.arguments.push(argument);
        }
    }

    /// Whether the name is or contains the marker word, which stands for text that is not typed yet.
    fn is_marker(&self, symbol: Symbol) -> bool {
        self.is_marked() && self.names.name(symbol).contains(MARKER)
    }

    /// Whether the marker word occurs anywhere in the program.
    fn is_marked(&self) -> bool {
        self.recorder.as_ref().is_some_and(|recorder| recorder.is_marked)
    }

    /// Whether an expression contains the marker word outside the arguments of calls.
    fn contains_marker(&self, expr: &ast::Expr) -> bool {
        match &expr.kind {
            ast::ExprKind::Name(symbol) | ast::ExprKind::System(symbol) => self.is_marker(*symbol),
            ast::ExprKind::Path { name, .. } => self.is_marker(name.symbol),
            ast::ExprKind::Field(inner, name) => self.is_marker(name.symbol) || self.contains_marker(inner),
            ast::ExprKind::Unary(_, inner) | ast::ExprKind::Step(_, inner) => self.contains_marker(inner),
            ast::ExprKind::Index(both) | ast::ExprKind::Binary(_, both) | ast::ExprKind::Assign(_, both) => {
                self.contains_marker(&both.0) || self.contains_marker(&both.1)
            }
            ast::ExprKind::Brace(items) => items.iter().any(|item| {
                item.name.is_some_and(|name| self.is_marker(name.symbol)) || self.contains_marker(&item.value)
            }),
            _ => false,
        }
    }

    /// Records what was looked for at the marker word.
    pub(crate) fn expect(&mut self, body: &CheckedBody, symbol: Symbol, span: Span, wanted: Wanted) {
        if !self.is_marker(symbol) {
            return;
        }
        let at = self.location(body.module, span);
        let locals = body.visible_locals().map(|(symbol, id)| {
            let declared = body.locals.get(id.0 as usize).map(|local| local.span).unwrap_or_default();
            let name = self.text(body.module, declared).to_string();
            let name = if name.is_empty() { self.names.name(symbol).to_string() } else { name };
            (name, body.local_type(id), self.location(body.module, declared))
        });
        let mut locals: Vec<_> = locals.collect();
        locals.sort_by_key(|(_, _, at)| *at);
        let (module, item) = (body.module, body.item);
        let Some(recorder) = &mut self.recorder else { return };
        let (arguments, braces) = (recorder.arguments.take(), recorder.braces.take());
        // A second check, with a wanted type, is more precise than the first one without.
        let known = recorder.index.expectation.take();
        if let Some(known) = known.as_ref().filter(|known| known.wanted == Wanted::Action && known.at == at) {
            recorder.index.expectation = Some(known.clone());
            return;
        }
        let arguments = arguments.or(known.and_then(|known| known.arguments));
        recorder.index.expectation = Some(Expectation { at, wanted, module, item, locals, arguments, braces });
    }

    /// Records the arguments around the marker word, if it is one of them.
    pub(crate) fn expect_argument(
        &mut self,
        body: &CheckedBody,
        callee: &CheckedCallee,
        name: Span,
        arg: &ast::Arg,
        taken: &[usize],
        parameter: Option<usize>,
    ) {
        let label = arg.label.is_some_and(|label| self.is_marker(label.symbol));
        if !self.is_marked() || !label && !self.contains_marker(&arg.value) {
            return;
        }
        let is_name = matches!(arg.value.kind, ast::ExprKind::Name(_));
        let mut taken = taken.to_vec();
        // A labelled argument has been counted already.
        if let (true, Some(count)) = (arg.label.is_some(), parameter.and_then(|at| taken.get_mut(at))) {
            *count = count.saturating_sub(1);
        }
        let of = self.location(body.module, name);
        let may_be_label = arg.label.is_none() && is_name;
        let list = ArgumentList { callee: callee.indexed(), of, taken, parameter, may_be_label };
        if let Some(recorder) = &mut self.recorder {
            recorder.arguments = Some(list);
        }
    }

    /// Records the arguments around the marker word, if no parameter is left for it.
    pub(crate) fn expect_nothing(
        &mut self,
        body: &CheckedBody,
        callee: &CheckedCallee,
        name: Span,
        arg: &ast::Arg,
        taken: &[usize],
    ) {
        self.expect_argument(body, callee, name, arg, taken, None);
        if let ast::ExprKind::Name(symbol) = arg.value.kind {
            self.expect(body, symbol, arg.value.span, Wanted::Nothing);
        }
    }

    /// Like `expect_argument`, for a function whose overload is not chosen yet: the first overload stands for all.
    pub(crate) fn expect_of_overloads(
        &mut self,
        body: &CheckedBody,
        overloads: &[&'static Entry],
        call: &ast::Call,
        at: usize,
    ) {
        if let (true, Some(first), Some(arg)) = (self.is_marked(), overloads.first(), call.args.get(at)) {
            self.expect_argument(body, &CheckedCallee::Builtin(first), call.name.span, arg, &vec![1; at], Some(at));
        }
    }

    /// Records that a component name is looked for, if the marker word is an unnamed value among named ones.
    pub(crate) fn expect_component(
        &mut self,
        body: &CheckedBody,
        id: Struct,
        value: &ast::Expr,
        taken: impl Iterator<Item = bool>,
    ) {
        if let ast::ExprKind::Name(symbol) = value.kind {
            self.expect_in_braces(id, value, taken);
            self.expect(body, symbol, value.span, Wanted::ComponentName(id));
        }
    }

    /// Records that the action of an event is looked for, if the action is the marker word.
    pub(crate) fn expect_action(&mut self, body: &CheckedBody, expr: &ast::Expr) {
        if let ast::ExprKind::Name(symbol) = expr.kind {
            self.expect(body, symbol, expr.span, Wanted::Action);
        }
    }

    /// Records the braces around the marker word, if it is one of their values.
    pub(crate) fn expect_in_braces(&mut self, id: Struct, value: &ast::Expr, taken: impl Iterator<Item = bool>) {
        if self.is_marked()
            && self.contains_marker(value)
            && let Some(recorder) = &mut self.recorder
        {
            recorder.braces = Some((id, taken.collect()));
        }
    }

    /// The index of everything that was recorded.
    pub(crate) fn take_index(&mut self) -> Option<Index> {
        let mut index = self.recorder.take()?.index;
        index.globals = self
            .globals
            .iter()
            .map(|slot| GlobalInfo {
                name: self.text(slot.module, slot.var.name.span).to_string(),
                module: slot.module,
                item: slot.item,
                ty: slot.ty,
                constant: slot.decl.constant.is_some(),
                value: slot.value.clone(),
                at: self.location(slot.module, slot.var.name.span),
                declaration: slot.decl.span,
            })
            .collect();
        index.functions = (0..self.funcs.len()).filter_map(|at| self.function_info(FuncId(at as u32))).collect();
        for (_, _, declared) in index.functions.iter().flat_map(|function| &function.params) {
            if let Some(info) = index.locals.get_mut(declared) {
                info.parameter = true;
            }
        }
        index.modules = (self.modules.iter())
            .map(|module| {
                let imports = module.imports.iter();
                let mut imports: Vec<(String, ModuleId)> =
                    imports.map(|(name, id)| (self.names.name(*name).to_string(), *id)).collect();
                imports.sort();
                let name = self.names.name(module.name).to_string();
                ModuleInfo { name, file: module.file, imports, data: module.data_module }
            })
            .collect();
        index.finish();
        Some(index)
    }

    fn function_info(&self, id: FuncId) -> Option<FunctionInfo> {
        let slot = self.funcs.get(id.0 as usize)?;
        let types = slot.params.iter().copied().chain(std::iter::repeat(None));
        let param = |(param, ty): (&ast::FuncParam, Option<Type>)| {
            let name = self.text(slot.module, param.name.span).to_string();
            (name, ty, self.location(slot.module, param.name.span))
        };
        Some(FunctionInfo {
            name: self.text(slot.module, slot.ast.name.span).to_string(),
            module: slot.module,
            item: slot.item,
            params: slot.ast.params.iter().zip(types).map(param).collect(),
            result: slot.result,
            at: self.location(slot.module, slot.ast.name.span),
            header: slot.ast.span,
            end: slot.ast.end,
        })
    }

    /// Records the declarations of globals and functions, and the modules that imports name.
    pub(crate) fn mention_declarations(&mut self) {
        if self.recorder.is_none() {
            return;
        }
        let globals: Vec<_> = self.globals.iter().map(|slot| (slot.module, slot.var.name.span)).collect();
        for (at, (module, span)) in globals.into_iter().enumerate() {
            self.mention_in(module, span, Meaning::Global(crate::hir::GlobalId(at as u32)), Role::Declares);
        }
        let funcs: Vec<_> = self.funcs.iter().map(|slot| (slot.module, slot.ast.name.span)).collect();
        for (at, (module, span)) in funcs.into_iter().enumerate() {
            self.mention_in(module, span, Meaning::Function(FuncId(at as u32)), Role::Declares);
        }
        let modules = self.modules;
        for (at, module) in modules.iter().enumerate() {
            let imports = module.ast.items.iter().filter_map(|item| match item {
                ast::Item::Import(import) => Some(import),
                _ => None,
            });
            for import in imports {
                let loaded = module.import_lines.iter().find(|(line, _)| *line == import.span);
                if let Some((_, id)) = loaded {
                    self.mention_in(ModuleId(at as u32), import.path_span, Meaning::Module(*id), Role::Uses);
                }
            }
        }
    }

    /// The meaning of the parameter of a call.
    pub(crate) fn parameter_meaning(&self, callee: &CheckedCallee, at: usize) -> Option<Meaning> {
        match callee {
            CheckedCallee::Builtin(entry) => Some(Meaning::Parameter(entry, at)),
            CheckedCallee::User(func) => {
                let slot = self.funcs.get(func.0 as usize)?;
                let declared = slot.ast.params.get(at)?.name.span;
                Some(Meaning::Local(self.location(slot.module, declared)))
            }
        }
    }
}

impl CheckedCallee {
    fn indexed(&self) -> index::Callee {
        match self {
            CheckedCallee::Builtin(entry) => index::Callee::Builtin(entry),
            CheckedCallee::User(func) => index::Callee::Function(*func),
        }
    }
}
