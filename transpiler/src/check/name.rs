//! What a name means where it is used.

use super::context::{CheckedBody, Checker};
use super::convert::Typed;
use super::place::PlaceOrValue;
use crate::diagnostics::names::NameProblem;
use crate::hir::{Expr, ExprKind, GlobalId, Local, ModuleId, Place, Root, Type, Value};
use crate::index::{Meaning, Wanted};
use crate::near::Hints;
use crate::operators::Literal;
use arl_lang::ast;
use arl_lang::catalog::{self, Base, ConstantValue, Enum, Struct};
use arl_lang::span::Span;
use arl_lang::symbol::{Interner, Symbol};

impl Checker<'_> {
    /// Resolves a name without `::`: a local, a global of this module or its data file, a constant, an enumeration
    /// constant or a hexadecimal number that begins with a letter.
    pub(crate) fn name(
        &mut self,
        body: &mut CheckedBody,
        symbol: Symbol,
        span: Span,
        want: Option<Type>,
    ) -> Option<PlaceOrValue> {
        if let Some(local) = body.find(symbol) {
            let found = body.locals.get(local.0 as usize);
            let value = found.and_then(|local| local.value.clone());
            if let Some(declared) = found.map(|local| local.span) {
                if self.options.strict && !self.means_hidden(body, symbol, span) {
                    self.strict_case(body, span, self.text(body.module, declared));
                }
                let declared = self.location(body.module, declared);
                self.mention_within(body, span, symbol, Meaning::Local(declared));
            }
            if let Some(value) = value {
                if let Some(local) = body.local(local) {
                    local.read = true;
                }
                return Some(PlaceOrValue::Value(constant(value, span)));
            }
            let ty = body.local_type(local)?;
            return Some(PlaceOrValue::Place(Place { root: Root::Local(local), path: Vec::new(), ty, span }));
        }
        if let Some((id, visible)) = self.find_global(body, symbol) {
            return self.own_global(body, id, visible, span);
        }
        let name = self.names.name(symbol);
        if let Some(found) = catalog::constant(name) {
            self.strict_case(body, span, found.name);
            self.mention_within(body, span, symbol, Meaning::Constant(found));
            let value = match found.value {
                ConstantValue::Double(number) => Value::Double(number),
                ConstantValue::String(text) => Value::String(text.into()),
            };
            return Some(PlaceOrValue::Value(constant(value, span)));
        }
        if name == "world" && want == Some(Type::scalar(Base::Struct(Struct::Wobj))) {
            let world = self.names.find("world")?;
            let variable = catalog::system_variable(self.names.name(world))?;
            self.mention_within(body, span, symbol, Meaning::System(variable));
            let ty = Type::scalar(variable.ty);
            return Some(PlaceOrValue::Place(Place { root: Root::System(variable), path: Vec::new(), ty, span }));
        }
        if let Some(found) = enum_constant(name, want) {
            let (id, index) = found;
            self.mention_within(body, span, symbol, Meaning::EnumConstant(id, index));
            if let Some(constant) = id.def().constants.get(index as usize) {
                self.strict_case(body, span, constant.name);
            }
            return Some(PlaceOrValue::Value(constant(Value::Enum(id, index), span)));
        }
        if let Some(number) = hexadecimal(name) {
            self.mention_within(body, span, symbol, Meaning::Number(number));
            let kind = ExprKind::Const(Value::Int(number as i32));
            let expr = Expr { ty: Type::scalar(Base::Int), kind, span };
            return Some(PlaceOrValue::Value(Typed { expr, literal: Literal::Pattern }));
        }
        self.unknown_variable(body, symbol, span, want)
    }

    fn unknown_variable<T>(&mut self, body: &CheckedBody, symbol: Symbol, span: Span, want: Option<Type>) -> Option<T> {
        self.expect(body, symbol, span, Wanted::Value(want));
        let name = self.names.name(symbol);
        if let Some(now) = catalog::renamed(name) {
            let name = self.text(body.module, span).to_string();
            return self.report(body, span, NameProblem::Renamed { name, now: now.into() });
        }
        let is_function =
            self.scopes.get(body.module.0 as usize).is_some_and(|scope| scope.funcs.contains_key(&symbol))
                || !catalog::functions(name).is_empty();
        if self.module(body.module).is_some_and(|module| module.imports.contains_key(&symbol)) {
            let name = self.text(body.module, span).to_string();
            return self.report(body, span, NameProblem::IsModule { name });
        }
        let mut near = self.member_named(body, symbol, false);
        if near.is_none() {
            near = body.nearest_local(&mut self.hints, self.names, name);
        }
        if near.is_none() && name.len() > 2 {
            let element = || catalog::system_element(name).map(|_| format!("${name}"));
            near = catalog::system_variable(name).map(|variable| format!("${}", variable.name)).or_else(element);
        }
        if near.is_none() {
            let data = self.module(body.module).and_then(|module| module.data_module);
            let modules = std::iter::once(body.module).chain(data);
            let scopes: Vec<_> = modules.filter_map(|module| self.scopes.get(module.0 as usize)).collect();
            let count = scopes.iter().map(|scope| scope.globals.len()).sum();
            let known = || scopes.iter().flat_map(|scope| scope.globals.keys()).map(|symbol| self.names.name(*symbol));
            near = self.hints.nearest(name, count, known).map(Into::into);
        }
        if let (None, Some(Base::Enum(id))) = (&near, want.map(|want| want.base)) {
            return self.unknown_constant(body, id, span);
        }
        let name = self.text(body.module, span).trim_matches(['(', ')', ' ']).to_string();
        if let Some((signal, channel)) = self.signal_named(&name) {
            return self.report(body, span, NameProblem::SignalName { name, signal, channel });
        }
        let quoted = self.unquoted(body, span, want).filter(|_| near.is_none());
        let ty = want.filter(|want| !want.is_array()).map_or("int".into(), |want| self.type_name(want));
        let is_it = |local: &&Local| near.is_none() && local.name.eq_ignore_ascii_case(&name);
        let ended = body.locals.iter().rev().find(is_it);
        let labels: Vec<_> =
            ended.map(|local| (body.module, local.span, "this one ends with its block")).into_iter().collect();
        let problem = NameProblem::UnknownVariable { name, near, is_function, quoted, ty };
        self.report_in(body.module, span, problem, &labels)
    }

    /// The signal to which the cell gives this name, as files write it, and its channel.
    #[cfg(feature = "tools")]
    pub(crate) fn signal_named(&self, name: &str) -> Option<(String, u32)> {
        self.options.cell.as_ref()?.names.signal(name).map(|signal| (signal.to_string(), signal.channel))
    }

    #[cfg(not(feature = "tools"))]
    pub(crate) fn signal_named(&self, _: &str) -> Option<(String, u32)> {
        None
    }

    /// `module::name`, if an imported module has a variable or function of this name.
    pub(crate) fn member_named(&self, body: &CheckedBody, symbol: Symbol, function: bool) -> Option<String> {
        let imports = &self.module(body.module)?.imports;
        let has = |module: &ModuleId| {
            let scope = self.scopes.get(module.0 as usize)?;
            if function { scope.funcs.get(&symbol).map(|_| ()) } else { scope.globals.get(&symbol).map(|_| ()) }
        };
        let found = imports.iter().filter(|(_, module)| has(module).is_some());
        let module = found.map(|(name, _)| self.names.name(*name)).min()?;
        Some(format!("{module}::{}", self.names.name(symbol)))
    }

    /// The string that an unknown name probably means: a file name, or any string if a string is wanted.
    fn unquoted(&self, body: &CheckedBody, span: Span, want: Option<Type>) -> Option<String> {
        const FILES: [&str; 3] = [".arl", ".txt", ".log"];
        let name = self.text(body.module, span);
        let behind = self.text(body.module, Span::new(span.end, span.end + FILES[0].len() as u32));
        if FILES.iter().any(|ending| behind.eq_ignore_ascii_case(ending)) {
            return Some(format!("{name}{behind}"));
        }
        (want == Some(Type::scalar(Base::String))).then(|| name.to_owned())
    }

    /// A global of this module or of its data file, and whether it is declared above.
    pub(crate) fn find_global(&self, body: &CheckedBody, symbol: Symbol) -> Option<(GlobalId, bool)> {
        if let Some(id) = self.scopes.get(body.module.0 as usize)?.globals.get(&symbol) {
            let slot = self.globals.get(id.0 as usize)?;
            // Inside its own declaration a variable is not visible yet, but those before it on the line are.
            let visible =
                slot.item < body.item || (slot.item == body.item && slot.state == super::context::CheckState::Done);
            return Some((*id, visible));
        }
        let data = self.module(body.module)?.data_module?;
        let id = self.scopes.get(data.0 as usize)?.globals.get(&symbol)?;
        Some((*id, true))
    }

    /// A global of this module, which must be declared above.
    fn own_global(&mut self, body: &CheckedBody, id: GlobalId, visible: bool, span: Span) -> Option<PlaceOrValue> {
        if !visible {
            self.mention_global(body, id, span);
            let name = self.text(body.module, span).to_string();
            let declared = self.globals.get(id.0 as usize).map_or(span, |slot| slot.var.name.span);
            let labels = [(body.module, declared, "declared here")];
            return self.report_in(body.module, span, NameProblem::VariableBelow { name }, &labels);
        }
        self.global(body, id, span)
    }

    fn global(&mut self, body: &CheckedBody, id: GlobalId, span: Span) -> Option<PlaceOrValue> {
        self.check_global(id);
        self.mention_global(body, id, span);
        let slot = self.globals.get(id.0 as usize)?;
        let declared = (slot.module, slot.var.name.span);
        let (ty, value) = (slot.ty, slot.value.clone());
        if slot.decl.constant.is_some() && slot.init.is_none() {
            // The declaration is wrong; that has been reported.
            return None;
        }
        if self.options.strict {
            let declared = self.text(declared.0, declared.1);
            let written = Span::new(span.end.saturating_sub(declared.len() as u32), span.end);
            self.strict_case(body, written, declared);
        }
        if let Some(value) = value {
            return Some(PlaceOrValue::Value(constant(value, span)));
        }
        Some(PlaceOrValue::Place(Place { root: Root::Global(id), path: Vec::new(), ty: ty?, span }))
    }

    fn mention_global(&mut self, body: &CheckedBody, id: GlobalId, span: Span) {
        if let Some(symbol) = self.globals.get(id.0 as usize).map(|slot| slot.var.name.symbol) {
            self.mention_within(body, span, symbol, Meaning::Global(id));
        }
    }

    /// `scope::name`: a variable of a module or a constant of an enumeration.
    pub(crate) fn path(
        &mut self,
        body: &mut CheckedBody,
        scope: ast::Ident,
        system: bool,
        name: ast::Ident,
        span: Span,
    ) -> Option<PlaceOrValue> {
        if !system && let Some(module) = self.find_module(body, scope) {
            self.used_modules.insert((body.module, module));
            self.mention(body, scope.span, Meaning::Module(module));
            if module == body.module
                && let Some((id, visible)) = self.find_global(body, name.symbol)
            {
                // Not looked up by its bare name: a local may hide it.
                return self.own_global(body, id, visible, span);
            }
            if let Some(id) = self.scopes.get(module.0 as usize)?.globals.get(&name.symbol).copied() {
                return self.global(body, id, span);
            }
            return self.not_in_module(body, module, name, "variable");
        }
        let scope_name = self.names.name(scope.symbol);
        if let Some(base @ Base::Enum(id)) = catalog::base_type(scope_name)
            && base.is_system() == system
        {
            let def = id.def();
            self.strict_case(body, scope.span, def.name);
            self.mention(body, scope.span, Meaning::Type(base));
            let wanted = self.names.name(name.symbol);
            if let Some(index) = constant_of(id, wanted) {
                self.mention(body, name.span, Meaning::EnumConstant(id, index));
                if let Some(constant) = def.constants.get(index as usize) {
                    self.strict_case(body, name.span, constant.name);
                }
                return Some(PlaceOrValue::Value(constant(Value::Enum(id, index), span)));
            }
            self.expect(body, name.symbol, name.span, Wanted::EnumConstant(id));
            return self.unknown_constant(body, id, name.span);
        }
        self.unknown_module(body, scope)
    }

    fn unknown_constant<T>(&mut self, body: &CheckedBody, id: Enum, span: Span) -> Option<T> {
        let def = id.def();
        let problem = NameProblem::UnknownConstant {
            name: self.text(body.module, span).into(),
            ty: def.name.into(),
            constants: constants(id),
        };
        self.report(body, span, problem)
    }

    pub(crate) fn unknown_module<T>(&mut self, body: &CheckedBody, scope: ast::Ident) -> Option<T> {
        if self.module(body.module).is_some_and(|module| module.missing.contains(&scope.symbol)) {
            return None;
        }
        let name = self.text(body.module, scope.span).to_string();
        let folder = self.module(body.module).and_then(|module| module.path.parent()).map(|path| path.to_path_buf());
        let looked = folder.unwrap_or_default().join(format!("{name}.arl")).display().to_string();
        self.report(body, scope.span, NameProblem::UnknownModule { name, looked: format!("\"{looked}\"") })
    }

    pub(crate) fn not_in_module<T>(
        &mut self,
        body: &CheckedBody,
        module: ModuleId,
        name: ast::Ident,
        what: &'static str,
    ) -> Option<T> {
        self.expect(body, name.symbol, name.span, Wanted::Member(module));
        let scope = self.scopes.get(module.0 as usize)?;
        let mut known: Vec<&str> = match what {
            "function" => scope.funcs.keys().map(|symbol| self.names.name(*symbol)).collect(),
            _ => scope.globals.keys().map(|symbol| self.names.name(*symbol)).collect(),
        };
        known.sort_unstable();
        let problem = NameProblem::NotInModule {
            name: self.text(body.module, name.span).into(),
            module: self.module(module).map(|module| self.names.name(module.name).to_string()).unwrap_or_default(),
            what,
            near: crate::near::nearest(self.names.name(name.symbol), known.into_iter()).map(Into::into),
        };
        self.report(body, name.span, problem)
    }

    /// The module that a name before `::` means.
    pub(crate) fn find_module(&self, body: &CheckedBody, scope: ast::Ident) -> Option<ModuleId> {
        let here = self.module(body.module)?;
        if here.name == scope.symbol {
            return Some(body.module);
        }
        if let Some(id) = here.imports.get(&scope.symbol) {
            return Some(*id);
        }
        here.data_module.filter(|data| self.module(*data).is_some_and(|data| data.name == scope.symbol))
    }
}

impl CheckedBody {
    /// The visible local with the most similar name.
    fn nearest_local(&self, hints: &mut Hints, names: &Interner, name: &str) -> Option<String> {
        hints.nearest(name, self.visible().len(), || self.visible().map(|symbol| names.name(symbol))).map(Into::into)
    }
}

/// A constant as an expression.
pub(crate) fn constant(value: Value, span: Span) -> Typed {
    Typed::plain(Expr { ty: Type::scalar(value.base()), kind: ExprKind::Const(value), span })
}

/// The constant of this name; the wanted enumeration takes precedence.
fn enum_constant(name: &str, want: Option<Type>) -> Option<(Enum, u16)> {
    if let Some(Base::Enum(id)) = want.map(|want| want.base)
        && let Some(index) = constant_of(id, name)
    {
        return Some((id, index));
    }
    catalog::enum_constant(name)
}

fn constant_of(id: Enum, name: &str) -> Option<u16> {
    let found = id.def().constants.iter().position(|constant| {
        constant.name.eq_ignore_ascii_case(name)
            || constant.aliases.iter().any(|alias| alias.eq_ignore_ascii_case(name))
    });
    found.map(|index| index as u16)
}

/// `ffh`: hexadecimal digits and an `h`, beginning with a letter.
fn hexadecimal(name: &str) -> Option<u32> {
    let digits = name.strip_suffix('h')?;
    let valid = !digits.is_empty() && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    if valid { u32::from_str_radix(digits, 16).ok() } else { None }
}

/// The names of an enumeration's constants.
pub(crate) fn constants(id: Enum) -> String {
    id.def().constants.iter().map(|constant| constant.name).collect::<Vec<_>>().join(", ")
}
