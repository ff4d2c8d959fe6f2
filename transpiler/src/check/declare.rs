//! Declarations: globals, signatures, locals.

use super::call::family_name;
use super::context::{CheckState, CheckedBody, Checker, FuncSlot, GlobalSlot, ModuleScope};
use super::statements::near_instruction;
use crate::diagnostics::flow::FlowProblem;
use crate::diagnostics::modules::ModuleProblem;
use crate::diagnostics::names::NameProblem;
use crate::diagnostics::types::TypeProblem;
use crate::hir::{self, Expr, ExprKind, FuncId, GlobalId, LocalId, MAX_DIMS, ModuleId, Stmt, StmtKind, Type, Value};
use crate::index::{LocalInfo, Meaning, Wanted};
use arl_lang::ast;
use arl_lang::catalog::{self, Base};
use arl_lang::elsewhere;
use arl_lang::span::Span;
use arl_lang::symbol::Symbol;

/// The maximum number of elements of an array.
const MAX_ELEMENTS: u64 = 10_000;

impl<'a> Checker<'a> {
    /// Creates slots for all globals and functions, in the given order of modules.
    pub(crate) fn collect(&mut self, order: &[ModuleId]) {
        self.scopes = self.modules.iter().map(|_| ModuleScope::default()).collect();
        for module in order {
            let Some(loaded) = self.module(*module) else { continue };
            for (item, node) in loaded.ast.items.iter().enumerate() {
                match node {
                    ast::Item::Import(_) => {}
                    ast::Item::Global(decl) => {
                        decl.vars.iter().for_each(|var| self.collect_global(*module, item as u32, decl, var));
                    }
                    ast::Item::Func(func) => self.collect_func(*module, item as u32, func),
                }
            }
        }
    }

    fn collect_global(&mut self, module: ModuleId, item: u32, decl: &'a ast::Decl, var: &'a ast::Var) {
        let id = GlobalId(self.globals.len() as u32);
        let Some(scope) = self.scopes.get_mut(module.0 as usize) else { return };
        let earlier = scope.globals.get(&var.name.symbol).copied();
        if earlier.is_none() {
            scope.globals.insert(var.name.symbol, id);
        }
        self.globals.push(GlobalSlot {
            module,
            decl,
            var,
            item,
            earlier,
            state: CheckState::Pending,
            ty: None,
            value: None,
            init: None,
            mutated: false,
        });
    }

    fn collect_func(&mut self, module: ModuleId, item: u32, func: &'a ast::Func) {
        if self.module(module).is_some_and(|loaded| loaded.data) {
            self.report_in::<()>(module, func.name.span, ModuleProblem::FunctionInData, &[]);
        }
        let id = FuncId(self.funcs.len() as u32);
        let Some(scope) = self.scopes.get_mut(module.0 as usize) else { return };
        if let Some(earlier) = scope.funcs.get(&func.name.symbol).copied() {
            let first = self.funcs.get(earlier.0 as usize).map_or(func.name.span, |slot| slot.ast.name.span);
            let name = self.text(module, func.name.span).to_string();
            let labels = [(module, first, "first defined here")];
            self.report_in::<()>(module, func.name.span, FlowProblem::FunctionTwice { name }, &labels);
        } else {
            scope.funcs.insert(func.name.symbol, id);
        }
        self.funcs.push(FuncSlot {
            module,
            ast: func,
            item,
            state: CheckState::Pending,
            params: Vec::new(),
            result: None,
            checked: None,
        });
    }

    /// Checks the declaration of a global once. This happens on demand, because sizes and constants may use each other.
    pub(crate) fn check_global(&mut self, id: GlobalId) {
        let Some(slot) = self.globals.get_mut(id.0 as usize) else { return };
        let (module, decl, var, item) = (slot.module, slot.decl, slot.var, slot.item);
        match slot.state {
            CheckState::Done => return,
            CheckState::Busy => {
                let name = self.text(module, var.name.span).to_string();
                self.report_circular(module, var.name.span, &name);
                return;
            }
            CheckState::Pending => slot.state = CheckState::Busy,
        }
        let mut body = CheckedBody::new(module, item);
        let ty = self.declared_type(&mut body, &decl.ty, var.name, &var.dims);
        if let Some(slot) = self.globals.get_mut(id.0 as usize) {
            slot.ty = ty;
        }
        self.report_second(id);
        let init = self.initialiser(&mut body, decl, var, ty);
        let value = constant_value(decl, ty, init.as_ref());
        if ty.is_none() || init.is_none() != var.init.is_none() {
            self.must_be_reported(module, var.name.span);
        }
        if let Some(slot) = self.globals.get_mut(id.0 as usize) {
            slot.state = CheckState::Done;
            slot.init = init;
            slot.value = value;
        }
    }

    /// Reports a global variable whose name is already taken by an earlier one. A slot without a type has been reported
    /// and may not be a declaration at all.
    fn report_second(&mut self, id: GlobalId) {
        let Some(slot) = self.globals.get(id.0 as usize).filter(|slot| slot.ty.is_some()) else { return };
        let (module, at) = (slot.module, slot.var.name.span);
        let Some(earlier) = slot.earlier.and_then(|earlier| self.globals.get(earlier.0 as usize)) else { return };
        let first = earlier.var.name.span;
        let problem = NameProblem::Duplicate { name: self.text(module, at).to_string(), what: "variable" };
        self.report_in::<()>(module, at, problem, &[(module, first, "first declared here")]);
    }

    /// Checks the parameters and result of a function once.
    pub(crate) fn check_signature(&mut self, id: FuncId) {
        let Some(slot) = self.funcs.get_mut(id.0 as usize) else { return };
        if slot.state != CheckState::Pending {
            return;
        }
        slot.state = CheckState::Busy;
        let (module, func, item) = (slot.module, slot.ast, slot.item);
        let mut body = CheckedBody::new(module, item);
        let result = self.base_type(&body, &func.result);
        let result = match result {
            Some(base @ Base::Handle(_)) => {
                let ty = self.base_name(base).to_string();
                self.report(&body, func.result.span, TypeProblem::ResultType { ty })
            }
            other => other,
        };
        let mut params = Vec::new();
        for param in &func.params {
            let ty = self.declared_type(&mut body, &param.ty, param.name, &param.dims);
            let ty = match ty {
                Some(ty) if matches!(ty.base, Base::Handle(_)) => {
                    let ty = self.type_name(ty);
                    self.report(&body, param.span, TypeProblem::HandleCopy { ty })
                }
                other => other,
            };
            params.push(ty);
        }
        if let Some(slot) = self.funcs.get_mut(id.0 as usize) {
            slot.state = CheckState::Done;
            slot.params = params;
            slot.result = result;
        }
    }

    /// The base type of this name, `void` included.
    pub(crate) fn base_type(&mut self, body: &CheckedBody, name: &ast::TypeRef) -> Option<Base> {
        let folded = self.names.name(name.name);
        let Some(base) = catalog::base_type(folded).filter(|base| base.is_system() == name.system) else {
            self.expect(body, name.name, name.span, Wanted::Type);
            if let Some(now) = catalog::renamed(folded) {
                let name_text = self.text(body.module, name.span).to_string();
                return self.report(body, name.span, NameProblem::Renamed { name: name_text, now: now.into() });
            }
            // A name with a missing or superfluous `$` takes precedence over similar names.
            let near = catalog::base_type(folded).map(Base::name).or_else(|| near_type(folded)).map(Into::into);
            let text = self.text(body.module, name.span).to_string();
            return self.report(body, name.span, NameProblem::UnknownType { name: text, near });
        };
        if let Base::Struct(id) = base
            && let Some(only) = id.def(self.family()).family
            && only != self.family()
        {
            let name_text = self.base_name(base).to_string();
            let problem = TypeProblem::OtherFamily { name: name_text, family: family_name(only) };
            return self.report(body, name.span, problem);
        }
        let declared = self.base_name(base);
        self.strict_case(body, name.span, declared);
        self.mention(body, name.span, Meaning::Type(base));
        Some(base)
    }

    /// A type with its array sizes, as far as a variable may have it.
    fn declared_type(
        &mut self,
        body: &mut CheckedBody,
        ty: &ast::TypeRef,
        name: ast::Ident,
        dims: &[ast::Expr],
    ) -> Option<Type> {
        let base = self.base_type(body, ty);
        let sizes: Vec<Option<u32>> = dims.iter().map(|dim| self.array_size(body, dim)).collect();
        let base = base?;
        if base == Base::Void {
            return self.report(body, ty.span, TypeProblem::VoidVariable);
        }
        let sizes = sizes.into_iter().collect::<Option<Vec<u32>>>()?;
        let len = sizes.iter().try_fold(1u64, |len, size| len.checked_mul(u64::from(*size))).unwrap_or(u64::MAX);
        if len > MAX_ELEMENTS {
            return self.report(body, name.span, TypeProblem::ArrayTooLarge { len });
        }
        match Type::array(base, &sizes) {
            Some(ty) => Some(ty),
            None => self.report(body, name.span, TypeProblem::TooManyDimensions { most: MAX_DIMS }),
        }
    }

    fn array_size(&mut self, body: &mut CheckedBody, dim: &ast::Expr) -> Option<u32> {
        let typed = self.expr(body, dim, Some(Type::scalar(Base::Int)))?;
        let size = typed.value().and_then(crate::operators::integer).and_then(|size| u32::try_from(size).ok());
        match size {
            Some(size) if size > 0 => Some(size),
            _ => self.report(body, dim.span, TypeProblem::ArraySize),
        }
    }

    /// The checked initialiser of a variable.
    fn initialiser(
        &mut self,
        body: &mut CheckedBody,
        decl: &ast::Decl,
        var: &ast::Var,
        ty: Option<Type>,
    ) -> Option<Expr> {
        let Some(init) = &var.init else {
            if decl.constant.is_some() {
                let name = self.text(body.module, var.name.span).to_string();
                self.report::<()>(body, var.name.span, TypeProblem::ConstWithoutValue { name });
            }
            return None;
        };
        match ty {
            Some(ty) => {
                let what = format!("`{}`", self.text(body.module, var.name.span));
                self.expr_as(body, init, ty, &what)
            }
            None => {
                if !matches!(init.kind, ast::ExprKind::Brace(_)) {
                    self.expr(body, init, None);
                }
                None
            }
        }
    }

    /// Declares local variables, with one statement for each.
    pub(crate) fn local_decl(&mut self, body: &mut CheckedBody, decl: &ast::Decl, out: &mut Vec<Stmt>) {
        if self.is_instruction(body, decl) {
            self.report_unknown_instruction::<()>(body, decl.ty.name, decl.ty.span);
            return;
        }
        for var in &decl.vars {
            let ty = self.declared_type(body, &decl.ty, var.name, &var.dims);
            let init = self.initialiser(body, decl, var, ty);
            let value = constant_value(decl, ty, init.as_ref());
            // A const without a value would otherwise be reported wherever a constant is wanted.
            let ty = ty.filter(|_| decl.constant.is_none() || init.is_some());
            let local = self.declare_local(body, var.name, ty, decl.constant.is_some(), value);
            if ty.is_none() || init.is_none() != var.init.is_none() {
                self.must_be_reported(body.module, var.name.span);
            }
            if ty.is_some() {
                out.push(Stmt { kind: StmtKind::Let(local, init), span: decl.span });
            }
        }
    }

    /// Whether something that reads like a declaration is meant as an instruction: `movel p`, `waitutil ready`.
    fn is_instruction(&self, body: &CheckedBody, decl: &ast::Decl) -> bool {
        let name = self.names.name(decl.ty.name);
        let plain = decl.constant.is_none() && !decl.ty.system && decl.vars.iter().all(|var| var.init.is_none());
        if !plain || catalog::base_type(name).is_some() || looks_like_type(name) {
            return false;
        }
        let known =
            |var: &ast::Var| body.find(var.name.symbol).is_some() || self.find_global(body, var.name.symbol).is_some();
        near_instruction(name).is_some()
            || elsewhere::word(name).is_some()
            || self.names_function(body, decl.ty.name)
            || decl.vars.first().is_some_and(known)
    }

    /// Makes a local variable visible; reports another one of the same name in the same scope.
    pub(crate) fn declare_local(
        &mut self,
        body: &mut CheckedBody,
        name: ast::Ident,
        ty: Option<Type>,
        constant: bool,
        value: Option<Value>,
    ) -> LocalId {
        // A name without a type has been reported and may not be a declaration at all.
        if let Some(earlier) = body.find_innermost(name.symbol).filter(|_| ty.is_some()) {
            let first = body.locals.get(earlier.0 as usize).map_or(name.span, |local| local.span);
            let text = self.text(body.module, name.span).to_string();
            let labels = [(body.module, first, "first declared here")];
            let problem = NameProblem::Duplicate { name: text, what: "variable" };
            self.report_in::<()>(body.module, name.span, problem, &labels);
        } else {
            self.doubt_hidden(body, name);
        }
        let info = LocalInfo { ty, constant, value: value.clone(), func: body.func, parameter: false };
        self.mention_local(body, name, info);
        let local = hir::Local {
            name: self.names.name(name.symbol).to_string(),
            ty: ty.unwrap_or(Type::scalar(Base::Int)),
            constant,
            value,
            mutated: false,
            read: false,
            shared: false,
            span: name.span,
        };
        let id = body.add_local(local, ty);
        body.reveal(name.symbol, id);
        id
    }

    /// Whether the initialiser of a variable in a data file can be read again on load.
    pub(crate) fn is_teachable(&self, slot: &GlobalSlot<'_>) -> bool {
        let is_data = self.module(slot.module).is_some_and(|module| module.data);
        // The runtime knows enumeration constants, PI and numbers like `ffh`, but no other variables.
        let is_variable = |name: Symbol| {
            let here = self.scopes.get(slot.module.0 as usize);
            let imported = self.module(slot.module).is_some_and(|module| module.imports.contains_key(&name));
            imported || here.is_some_and(|scope| scope.globals.contains_key(&name))
        };
        is_data && slot.var.init.as_ref().is_none_or(|init| is_literal(init, &is_variable))
    }

    /// The position used for problems of a file as a whole.
    pub(crate) fn file_start(&self) -> Span {
        Span::default()
    }
}

/// Whether a name that is not a type resembles one.
fn looks_like_type(name: &str) -> bool {
    elsewhere::type_of(name).is_some() || catalog::renamed(name).is_some() || near_type(name).is_some()
}

/// The type with the most similar name.
fn near_type(name: &str) -> Option<&'static str> {
    crate::near::nearest(name, catalog::type_names().map(|(name, _)| name))
}

/// The value of a `const` scalar.
fn constant_value(decl: &ast::Decl, ty: Option<Type>, init: Option<&Expr>) -> Option<Value> {
    decl.constant?;
    match &init?.kind {
        ExprKind::Const(value) if !ty?.is_array() => Some(value.clone()),
        _ => None,
    }
}

/// Whether an expression consists only of literals and constants of the language, without operators other than a sign.
fn is_literal(expr: &ast::Expr, is_variable: &dyn Fn(Symbol) -> bool) -> bool {
    match &expr.kind {
        ast::ExprKind::Int(..) | ast::ExprKind::Double(_) | ast::ExprKind::String(_) | ast::ExprKind::Bool(_) => true,
        ast::ExprKind::Name(name) => !is_variable(*name),
        ast::ExprKind::Path { scope, .. } => !is_variable(scope.symbol),
        ast::ExprKind::Unary(ast::UnaryOp::Negate, operand) => is_literal(operand, is_variable),
        ast::ExprKind::Brace(items) => items.iter().all(|item| is_literal(&item.value, is_variable)),
        _ => false,
    }
}
