//! Calls: which function a name means, and the resulting expression.

use super::arguments::CheckedCallee;
use super::context::{CheckedBody, Checker};
use super::convert::Typed;
use crate::diagnostics::arguments::ArgumentProblem;
use crate::diagnostics::names::NameProblem;
use crate::diagnostics::support::SupportProblem;
use crate::hir::{Bound, Builtin, Expr, ExprKind, FuncId, Passed, Type, Value};
use crate::index::{Meaning, Wanted};
use arl_lang::ast;
use arl_lang::catalog::{self, Base, Entry, Family, Form, ParamType, Presence};
use arl_lang::elsewhere;
use arl_lang::other_motions::other_motion;
use arl_lang::span::Span;
use arl_lang::symbol::Symbol;

impl Checker<'_> {
    /// A call as an expression; its type may be void.
    pub(crate) fn call(&mut self, body: &mut CheckedBody, call: &ast::Call, span: Span) -> Option<Expr> {
        if let Some(scope) = call.module {
            let Some(module) = self.find_module(body, scope) else { return self.unknown_module(body, scope) };
            self.used_modules.insert((body.module, module));
            self.mention(body, scope.span, Meaning::Module(module));
            let func = self.scopes.get(module.0 as usize)?.funcs.get(&call.name.symbol).copied();
            return match func {
                Some(func) => self.call_user(body, func, call, span),
                None => self.not_in_module(body, module, call.name, "function"),
            };
        }
        if let Some(func) = self.scopes.get(body.module.0 as usize)?.funcs.get(&call.name.symbol).copied() {
            if self.funcs.get(func.0 as usize)?.item > body.item {
                self.mention(body, call.name.span, Meaning::Function(func));
                let slot = self.funcs.get(func.0 as usize)?;
                let name = self.text(body.module, call.name.span).to_string();
                let labels = [(body.module, slot.ast.name.span, "defined here")];
                let calls_back = self.calls_back(body, slot.ast);
                let problem = NameProblem::FunctionBelow { name, calls_back };
                return self.report_in(body.module, call.name.span, problem, &labels);
            }
            return self.call_user(body, func, call, span);
        }
        let overloads = self.catalog_functions(call.name.symbol);
        if overloads.is_empty() {
            return self.unknown_function(body, call);
        }
        self.call_builtin(body, overloads, call, span)
    }

    /// Whether a function further down in the file calls the one that is being checked: moving it up does not help
    /// then.
    fn calls_back(&self, body: &CheckedBody, below: &ast::Func) -> bool {
        let Some(caller) = body.func.and_then(|func| self.funcs.get(func.0 as usize)) else { return false };
        let name = self.text(body.module, caller.ast.name.span).to_lowercase();
        let text = self.text(body.module, Span { end: below.end.start, ..below.name.span }).to_lowercase();
        let is_call = |(at, _): (usize, &str)| {
            let (before, behind) =
                (text.get(..at).unwrap_or_default(), text.get(at + name.len()..).unwrap_or_default());
            behind.trim_start().starts_with('(') && !before.ends_with(|end: char| end.is_alphanumeric() || end == '_')
        };
        text.match_indices(&name).any(is_call)
    }

    fn catalog_functions(&mut self, symbol: Symbol) -> &'static [Entry] {
        if let Some(entries) = self.functions.get(&symbol) {
            return entries;
        }
        let entries = catalog::functions(self.names.name(symbol));
        self.functions.insert(symbol, entries);
        entries
    }

    fn unknown_function<T>(&mut self, body: &mut CheckedBody, call: &ast::Call) -> Option<T> {
        self.expect(body, call.name.symbol, call.name.span, Wanted::Function);
        let is_of_others = elsewhere::word(self.names.name(call.name.symbol)).is_some();
        for arg in &call.args {
            // The arguments of a function of another language are covered by the message about the function.
            if !is_of_others && !matches!(arg.value.kind, ast::ExprKind::Brace(_)) {
                self.expr(body, &arg.value, None);
            }
        }
        let name = self.names.name(call.name.symbol);
        let is_instruction = !catalog::instructions(name).is_empty();
        let scope = self.scopes.get(body.module.0 as usize)?;
        let builtin = catalog::all_entries();
        let known = || {
            let functions = builtin.iter().filter(|entry| entry.kind == catalog::Kind::Function);
            scope.funcs.keys().map(|symbol| self.names.name(*symbol)).chain(functions.map(|entry| entry.name))
        };
        let near = self.member_named(body, call.name.symbol, true);
        let near = near.or_else(|| self.hints.nearest(name, scope.funcs.len() + builtin.len(), known).map(Into::into));
        let name = self.text(body.module, call.name.span).to_string();
        let end = call.args.last().map_or(call.name.span.end, |last| last.value.span.end);
        let call_text = format!("{})", self.text(body.module, Span::new(call.name.span.start, end)));
        let motion = is_of_others.then(|| other_motion(&call_text)).flatten();
        self.report(body, call.name.span, NameProblem::UnknownFunction { name, near, is_instruction, motion })
    }

    fn call_user(&mut self, body: &mut CheckedBody, func: FuncId, call: &ast::Call, span: Span) -> Option<Expr> {
        self.check_signature(func);
        self.mention(body, call.name.span, Meaning::Function(func));
        let slot = self.funcs.get(func.0 as usize)?;
        let (module, name_span) = (slot.module, slot.ast.name.span);
        let declared = self.text(module, name_span);
        self.strict_case(body, call.name.span, declared);
        let args = self.bind(body, &CheckedCallee::User(func), &call.args, call.name.span);
        let slot = self.funcs.get(func.0 as usize)?;
        let result = slot.result;
        let count = slot.params.len();
        let mut values: Vec<Option<Expr>> = (0..count).map(|_| None).collect();
        for bound in args? {
            if let (Passed::Value(value), Some(slot)) = (bound.value, values.get_mut(bound.param)) {
                *slot = Some(value);
            }
        }
        let values = values.into_iter().collect::<Option<Vec<_>>>()?;
        Some(Expr { ty: Type::scalar(result?), kind: ExprKind::Call(func, values), span })
    }

    fn call_builtin(
        &mut self,
        body: &mut CheckedBody,
        all: &'static [Entry],
        call: &ast::Call,
        span: Span,
    ) -> Option<Expr> {
        let family = self.family();
        let of_family = |entry: &&Entry| entry.family.is_none_or(|only| only == family);
        let mut overloads: Vec<&'static Entry> = all.iter().filter(of_family).collect();
        let Some(first) = overloads.first().copied() else {
            return self.report_family(body, call.name.span, all.first()?);
        };
        self.strict_case(body, call.name.span, first.name);
        if first.form == Form::TypeOf {
            self.mention(body, call.name.span, Meaning::Builtin(first));
            return self.type_of(body, first, call, span);
        }
        let fitting: Vec<&'static Entry> =
            overloads.iter().copied().filter(|entry| takes_count(entry, call.args.len())).collect();
        if !fitting.is_empty() {
            overloads = fitting;
        }
        let entry = match overloads.as_slice() {
            [only] => *only,
            _ => {
                let chosen = self.choose_overload(body, &overloads, call);
                if chosen.is_none() {
                    self.mention(body, call.name.span, Meaning::Builtin(first));
                }
                chosen?
            }
        };
        self.mention(body, call.name.span, Meaning::Builtin(entry));
        let args = self.bind(body, &CheckedCallee::Builtin(entry), &call.args, call.name.span)?;
        self.builtin(body, entry, args, call.name.span, span)
    }

    /// The checked use of a built-in; reports one that a background channel cannot execute.
    pub(crate) fn builtin(
        &mut self,
        body: &CheckedBody,
        entry: &'static Entry,
        args: Vec<Bound>,
        name: Span,
        span: Span,
    ) -> Option<Expr> {
        if self.options.background && !entry.background {
            return self.report(body, name, SupportProblem::Background { name: entry.name.into() });
        }
        let ty = Type::scalar(entry.result);
        Some(Expr { ty, kind: ExprKind::Builtin(Box::new(Builtin { entry, args })), span })
    }

    /// `typeof(e)`: known at compile time, so `e` (which may be a handle) is not evaluated.
    fn type_of(&mut self, body: &mut CheckedBody, entry: &'static Entry, call: &ast::Call, span: Span) -> Option<Expr> {
        let [arg] = call.args.as_slice() else {
            self.bind(body, &CheckedCallee::Builtin(entry), &call.args, call.name.span);
            return None;
        };
        self.expect_argument(body, &CheckedCallee::Builtin(entry), call.name.span, arg, &[0], Some(0));
        let typed = self.expr(body, &arg.value, None)?;
        if typed.expr.ty.base == Base::Void {
            return self.report_no_value(body, &typed.expr);
        }
        let name = self.type_name(typed.expr.ty);
        let kind = ExprKind::Const(Value::String(name.into()));
        Some(Expr { ty: Type::scalar(Base::String), kind, span })
    }

    pub(crate) fn report_family<T>(&mut self, body: &CheckedBody, span: Span, entry: &Entry) -> Option<T> {
        let family = family_name(entry.family.unwrap_or_default());
        self.report(body, span, SupportProblem::OtherFamily { name: entry.name.into(), family })
    }

    /// The overload that the arguments fit best; the first one if several fit equally well.
    fn choose_overload(
        &mut self,
        body: &mut CheckedBody,
        overloads: &[&'static Entry],
        call: &ast::Call,
    ) -> Option<&'static Entry> {
        let mut types = Vec::new();
        for (at, arg) in call.args.iter().enumerate() {
            let want = common_type(overloads, at);
            self.expect_of_overloads(body, overloads, call, at);
            let shown = self.diagnostics.len();
            let typed = self.expr(body, &arg.value, want);
            if typed.is_none() && self.diagnostics.len() > shown {
                return None;
            }
            let typed = typed?;
            if typed.expr.ty.base == Base::Void {
                return self.report_no_value(body, &typed.expr);
            }
            types.push(typed);
        }
        let best = overloads
            .iter()
            .enumerate()
            .filter_map(|(at, entry)| Some((self.overload_cost(entry, call, &types)?, at, *entry)))
            .min_by_key(|(cost, at, _)| (*cost, *at));
        if let Some((_, _, entry)) = best {
            return Some(entry);
        }
        let problem = ArgumentProblem::NoOverload {
            callee: overloads.first().map(|entry| entry.name.to_string()).unwrap_or_default(),
            types: types.iter().map(|typed| self.type_name(typed.expr.ty)).collect::<Vec<_>>().join(", "),
            signatures: overloads.iter().map(|entry| self.signature(entry)).collect::<Vec<_>>().join(", "),
        };
        self.report(body, call.name.span, problem)
    }

    fn overload_cost(&self, entry: &Entry, call: &ast::Call, types: &[Typed]) -> Option<u32> {
        let mut sum = 0;
        for (at, (arg, typed)) in call.args.iter().zip(types).enumerate() {
            let param = match arg.label {
                Some(label) => {
                    let name = self.names.name(label.symbol);
                    entry.params.iter().find(|param| param.name.eq_ignore_ascii_case(name))?
                }
                None => entry.params.get(at)?,
            };
            sum += self.param_cost(&param.ty, param.mode, typed)?;
        }
        Some(sum)
    }

    /// How well a value fits a catalog parameter; `None` if it does not fit.
    pub(crate) fn param_cost(&self, ty: &ParamType, mode: catalog::Mode, typed: &Typed) -> Option<u32> {
        let found = typed.expr.ty;
        match (ty, mode) {
            (ParamType::Any, _) => (found.base != Base::Void && !matches!(found.base, Base::Handle(_))).then_some(5),
            (ParamType::Array(base), _) => (found.dims().len() == 1 && found.base == *base).then_some(0),
            (ParamType::One(base), catalog::Mode::Out) => (found == Type::scalar(*base)).then_some(0),
            (ParamType::One(base), _) => self.cost(typed, Type::scalar(*base)),
            (ParamType::AnyOf(bases), _) => (!found.is_array() && bases.contains(&found.base)).then_some(0),
        }
    }

    /// `sin(double x)`, for messages; optional parameters are in brackets.
    pub(crate) fn signature(&self, entry: &Entry) -> String {
        let params: Vec<String> = entry
            .params
            .iter()
            .filter(|param| param.is_of(self.family()))
            .map(|param| {
                let ty = self.param_type_name(&param.ty);
                let text = match entry.kind {
                    catalog::Kind::Function => format!("{ty} {}", param.name),
                    catalog::Kind::Instruction => format!("{}:{ty}", param.name),
                };
                match param.presence {
                    Presence::Required | Presence::Repeat { min: 1.., .. } => text,
                    _ => format!("[{text}]"),
                }
            })
            .collect();
        match entry.kind {
            catalog::Kind::Function => format!("{}({})", entry.name, params.join(", ")),
            catalog::Kind::Instruction => format!("{} {}", entry.name, params.join(", ")).trim_end().into(),
        }
    }

    fn param_type_name(&self, ty: &ParamType) -> String {
        match ty {
            ParamType::One(base) => self.base_name(*base).into(),
            ParamType::Array(base) => format!("{}[]", self.base_name(*base)),
            ParamType::AnyOf(bases) => bases.iter().map(|base| self.base_name(*base)).collect::<Vec<_>>().join("|"),
            ParamType::Any => "any".into(),
        }
    }
}

/// Whether a call with this number of arguments can mean the entry.
fn takes_count(entry: &Entry, count: usize) -> bool {
    let least = entry.params.iter().filter(|param| param.presence == Presence::Required).count();
    let most = match entry.params.iter().any(|param| matches!(param.presence, Presence::Repeat { .. })) {
        true => usize::MAX,
        false => entry.params.len(),
    };
    (least..=most).contains(&count)
}

/// The type that all overloads have at a position, so that braces and enumeration constants can be read.
fn common_type(overloads: &[&Entry], at: usize) -> Option<Type> {
    let mut bases = overloads.iter().map(|entry| match entry.params.get(at).map(|param| param.ty) {
        Some(ParamType::One(base)) => Some(base),
        _ => None,
    });
    let first = bases.next()??;
    bases.all(|base| base == Some(first)).then(|| Type::scalar(first))
}

/// A family in words.
pub(crate) fn family_name(family: Family) -> &'static str {
    match family {
        Family::SixAxis => "six-axis",
        Family::Scara => "SCARA",
    }
}
