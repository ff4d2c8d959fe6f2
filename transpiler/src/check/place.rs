//! Variables, components and elements, which can be read and written.

use super::context::{CheckedBody, Checker};
use super::convert::Typed;
use crate::diagnostics::constants::ConstantProblem;
use crate::diagnostics::names::NameProblem;
use crate::diagnostics::types::TypeProblem;
use crate::hir::{Expr, ExprKind, ModuleId, Place, Projection, Root, Type, Value};
use crate::index::{Meaning, Wanted};
use arl_lang::ast;
use arl_lang::catalog::{self, Access, Base, Struct, SystemVariable};
use arl_lang::span::Span;

const INT: Type = Type::scalar(Base::Int);

/// The result of checking an expression that may be a place.
pub(crate) enum PlaceOrValue {
    Place(Place),
    Value(Typed),
}

impl Checker<'_> {
    /// A variable with its components and elements, or a value with components.
    pub(crate) fn place_or_value(&mut self, body: &mut CheckedBody, expr: &ast::Expr) -> Option<PlaceOrValue> {
        match &expr.kind {
            ast::ExprKind::Field(inner, name) => self.field(body, inner, *name, expr.span),
            ast::ExprKind::Index(_) => self.element(body, expr),
            ast::ExprKind::Name(symbol) => self.name(body, *symbol, expr.span, None),
            ast::ExprKind::Path { scope, system, name } => self.path(body, *scope, *system, *name, expr.span),
            ast::ExprKind::System(symbol) => self.system(body, *symbol, expr.span),
            _ => self.expr(body, expr, None).map(PlaceOrValue::Value),
        }
    }

    /// The value of a place.
    pub(crate) fn read(&mut self, body: &mut CheckedBody, place: Place) -> Typed {
        if let Root::Local(local) = place.root
            && let Some(local) = body.local(local)
        {
            local.read = true;
        }
        let (ty, span) = (place.ty, place.span);
        Typed::plain(Expr { ty, kind: ExprKind::Place(Box::new(place)), span })
    }

    /// `$NAME`
    fn system(&mut self, body: &CheckedBody, symbol: arl_lang::symbol::Symbol, span: Span) -> Option<PlaceOrValue> {
        let name = self.names.name(symbol);
        if let Some((variable, number)) = catalog::system_element(name) {
            return self.system_element(body, variable, number, span);
        }
        let Some(variable) = catalog::system_variable(name) else {
            self.expect(body, symbol, span, Wanted::System);
            if let Some(now) = catalog::renamed(&format!("${name}")) {
                let name = self.text(body.module, span).to_string();
                return self.report(body, span, NameProblem::Renamed { name, now: now.into() });
            }
            let candidates = catalog::system_variables().map(|variable| variable.name);
            let near = crate::near::nearest(name, candidates).map(Into::into);
            let elements = elements_called(name);
            let name = self.text(body.module, span).trim_start_matches('$').to_string();
            return self.report(body, span, NameProblem::UnknownSystem { name, near, elements });
        };
        self.strict_case(body, Span::new(span.start + 1, span.end), variable.name);
        self.mention(body, span, Meaning::System(variable));
        let ty = Type::array(variable.ty, variable.dims)?;
        Some(PlaceOrValue::Place(Place { root: Root::System(variable), path: Vec::new(), ty, span }))
    }

    /// `$tool3`: the element `$TOOLS[3]` by its default name.
    fn system_element(
        &mut self,
        body: &CheckedBody,
        variable: &'static SystemVariable,
        number: u32,
        span: Span,
    ) -> Option<PlaceOrValue> {
        if let Some(name) = variable.element_names().nth(number as usize) {
            self.strict_case(body, Span::new(span.start + 1, span.end), &name);
        }
        self.mention(body, span, Meaning::System(variable));
        let array = Type::array(variable.ty, variable.dims)?;
        let index = Expr { ty: INT, kind: ExprKind::Const(Value::Int(i32::try_from(number).ok()?)), span };
        let path = vec![Projection::Index(vec![index], array)];
        Some(PlaceOrValue::Place(Place { root: Root::System(variable), path, ty: array.element(), span }))
    }

    fn field(
        &mut self,
        body: &mut CheckedBody,
        inner: &ast::Expr,
        name: ast::Ident,
        span: Span,
    ) -> Option<PlaceOrValue> {
        let inner = self.place_or_value(body, inner)?;
        let (ty, inner_span) = match &inner {
            PlaceOrValue::Place(place) => (place.ty, place.span),
            PlaceOrValue::Value(typed) => (typed.expr.ty, typed.expr.span),
        };
        let Base::Struct(id) = ty.base else {
            if let (Base::Void, PlaceOrValue::Value(typed)) = (ty.base, &inner) {
                return self.report_no_value(body, &typed.expr);
            }
            let ty = self.type_name(ty);
            return self.report(body, inner_span, TypeProblem::NotAStructure { ty });
        };
        if ty.is_array() {
            let ty = self.type_name(ty);
            return self.report(body, inner_span, TypeProblem::NotAStructure { ty });
        }
        let index = self.component(body, id, name)?;
        let component = id.def(self.family()).components.get(index)?;
        let ty = Type::scalar(component.ty);
        Some(match inner {
            PlaceOrValue::Place(mut place) => {
                place.path.push(Projection::Field(id, index));
                PlaceOrValue::Place(Place { ty, span, ..place })
            }
            PlaceOrValue::Value(typed) => {
                let kind = ExprKind::FieldOf(Box::new(typed.expr), id, index);
                PlaceOrValue::Value(Typed::plain(Expr { ty, kind, span }))
            }
        })
    }

    /// The index of a component by its name.
    pub(crate) fn component(&mut self, body: &CheckedBody, id: Struct, name: ast::Ident) -> Option<usize> {
        let def = id.def(self.family());
        if let Some(index) = self.find_component(id, name.symbol) {
            self.mention(body, name.span, Meaning::Component(id, index));
            if let Some(component) = def.components.get(index) {
                self.strict_case(body, name.span, component.name);
            }
            return Some(index);
        }
        self.expect(body, name.symbol, name.span, Wanted::Component(id));
        let names = || def.components.iter().map(|component| component.name);
        let problem = NameProblem::UnknownComponent {
            name: self.text(body.module, name.span).into(),
            ty: def.name.into(),
            near: crate::near::nearest(self.names.name(name.symbol), names()).map(Into::into),
            components: names().collect::<Vec<_>>().join(", "),
        };
        self.report(body, name.span, problem)
    }

    /// The index of a component; reports nothing if there is none.
    pub(crate) fn find_component(&self, id: Struct, name: arl_lang::symbol::Symbol) -> Option<usize> {
        let name = self.names.name(name);
        id.def(self.family()).components.iter().position(|component| {
            component.name.eq_ignore_ascii_case(name)
                || component.aliases.iter().any(|alias| alias.eq_ignore_ascii_case(name))
        })
    }

    fn element(&mut self, body: &mut CheckedBody, expr: &ast::Expr) -> Option<PlaceOrValue> {
        let mut indices = Vec::new();
        let mut base = expr;
        while let ast::ExprKind::Index(both) = &base.kind {
            indices.push(&both.1);
            base = &both.0;
        }
        indices.reverse();
        let found = self.place_or_value(body, base);
        let place = match found {
            Some(PlaceOrValue::Place(place)) => Some(place),
            Some(PlaceOrValue::Value(typed)) => {
                let ty = self.type_name(typed.expr.ty);
                self.report(body, base.span, TypeProblem::NotAnArray { ty })
            }
            None => None,
        };
        let dims: Vec<u32> =
            place.as_ref().map(|place| place.ty.dims().iter().map(|dim| u32::from(*dim)).collect()).unwrap_or_default();
        let mut checked = Vec::new();
        for (at, index) in indices.iter().enumerate() {
            checked.push(self.index(body, index, dims.get(at).copied()));
        }
        let mut place = place?;
        if !place.ty.is_array() {
            let ty = self.type_name(place.ty);
            return self.report(body, base.span, TypeProblem::NotAnArray { ty });
        }
        if dims.len() != indices.len() {
            let problem = TypeProblem::IndexCount { found: indices.len(), wanted: dims.len() };
            return self.report(body, expr.span, problem);
        }
        let array = place.ty;
        place.path.push(Projection::Index(checked.into_iter().collect::<Option<Vec<_>>>()?, array));
        Some(PlaceOrValue::Place(Place { ty: array.element(), span: expr.span, ..place }))
    }

    /// Checks an index; a constant one must be below `size`.
    fn index(&mut self, body: &mut CheckedBody, index: &ast::Expr, size: Option<u32>) -> Option<Expr> {
        let typed = self.expr(body, index, Some(INT))?;
        if self.cost(&typed, INT).is_none() && typed.expr.ty.base != Base::Void {
            let found = self.type_name(typed.expr.ty);
            return self.report(body, index.span, TypeProblem::IndexType { found });
        }
        let index = self.coerce(body, typed, INT, "an index")?;
        if let (ExprKind::Const(Value::Int(value)), Some(size)) = (&index.kind, size) {
            let value = i64::from(*value);
            if !(0..i64::from(size)).contains(&value) {
                return self.report(body, index.span, ConstantProblem::Index { index: value, size });
            }
        }
        Some(index)
    }

    /// A place that is written: not const, not read-only. `reads`: the old value matters, too.
    pub(crate) fn written_place(&mut self, body: &mut CheckedBody, expr: &ast::Expr, reads: bool) -> Option<Place> {
        // A const with a known value is read as that value; for writing, its name is needed.
        if let Some((module, declared)) = self.const_declaration(body, expr) {
            let name = self.text(module, declared).to_string();
            let labels = [(module, declared, "declared const here")];
            return self.report_in(body.module, expr.span, TypeProblem::AssignConst { name }, &labels);
        }
        let place = match self.place_or_value(body, expr)? {
            PlaceOrValue::Place(place) => place,
            PlaceOrValue::Value(_) => {
                let text = self.excerpt(body.module, expr.span);
                return self.report(body, expr.span, TypeProblem::NotAssignable { text });
            }
        };
        self.mention_written(body, expr.span.start);
        match place.root {
            Root::Local(id) => {
                if let Some(local) = body.local(id) {
                    local.mutated = true;
                    local.read |= reads;
                }
            }
            Root::System(variable) if variable.access == Access::ReadOnly => {
                return self.report(body, place.span, TypeProblem::ReadOnly { name: variable.name.into() });
            }
            Root::Global(id) => {
                if let Some(slot) = self.globals.get_mut(id.0 as usize) {
                    slot.mutated = true;
                }
            }
            Root::System(_) => {}
        }
        Some(place)
    }

    /// The declaration of the const variable that an expression would write to.
    fn const_declaration(&self, body: &CheckedBody, expr: &ast::Expr) -> Option<(ModuleId, Span)> {
        let global = match &expr.kind {
            ast::ExprKind::Field(inner, _) => return self.const_declaration(body, inner),
            ast::ExprKind::Index(both) => return self.const_declaration(body, &both.0),
            ast::ExprKind::Name(symbol) => match body.find(*symbol) {
                Some(local) => {
                    let local = body.locals.get(local.0 as usize)?;
                    return local.constant.then_some((body.module, local.span));
                }
                None => self.find_global(body, *symbol)?.0,
            },
            ast::ExprKind::Path { scope, name, .. } => {
                let module = self.find_module(body, *scope)?;
                self.scopes.get(module.0 as usize)?.globals.get(&name.symbol).copied()?
            }
            _ => return None,
        };
        let slot = self.globals.get(global.0 as usize)?;
        slot.decl.constant.map(|_| (slot.module, slot.var.name.span))
    }
}

/// The range of the elements named like `name`, if a variable has such elements.
fn elements_called(name: &str) -> Option<String> {
    let stem = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let variable = catalog::system_variables().find(|variable| variable.elements == Some(stem))?;
    let mut names = variable.element_names();
    let (first, last) = (names.next()?, names.last()?);
    Some(format!("`${first}` to `${last}`, the elements of `${}`", variable.name))
}
