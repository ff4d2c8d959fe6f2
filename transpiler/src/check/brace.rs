//! Values in braces: structures by position or by name, arrays flat or nested.

use super::context::{CheckState, CheckedBody, Checker};
use super::convert::number;
use crate::diagnostics::components::ComponentRange;
use crate::diagnostics::doubts::Doubt;
use crate::diagnostics::types::TypeProblem;
use crate::hir::{Expr, ExprKind, GlobalId, Type, Value};
use arl_lang::ast::{self, BinaryOp, BraceItem, UnaryOp};
use arl_lang::catalog::{self, Base, Start, Struct, UNSET};
use arl_lang::span::Span;

/// How many values braces give for an array or for a part of it.
struct Few<'a> {
    given: usize,
    size: usize,
    /// What is counted: elements or rows.
    of: &'static str,
    /// The sizes of the part.
    dims: &'a [u16],
}

impl Checker<'_> {
    /// `{..}` as a value of type `want`.
    pub(crate) fn brace(
        &mut self,
        body: &mut CheckedBody,
        items: &[BraceItem],
        want: Type,
        span: Span,
    ) -> Option<Expr> {
        if want.is_array() {
            let dims: Vec<u16> = want.dims().to_vec();
            let mut elements = Vec::new();
            self.array(body, items, want, &dims, &mut elements, span)?;
            return Some(Expr { ty: want, kind: ExprKind::Array(elements), span });
        }
        match want.base {
            Base::Struct(id) => self.structure(body, items, id, span),
            _ => {
                let wanted = self.type_name(want);
                self.report(body, span, TypeProblem::BraceForValue { wanted })
            }
        }
    }

    fn structure(&mut self, body: &mut CheckedBody, items: &[BraceItem], id: Struct, span: Span) -> Option<Expr> {
        if let Some(problem) = self.flat_structure(body, items, id) {
            return self.report(body, span, problem);
        }
        let components = id.def(self.family()).components;
        let mut values: Vec<Option<Expr>> = components.iter().map(|_| None).collect();
        let mut by_position = components.iter().enumerate().filter(|(_, component)| component.by_position);
        let is_named = |item: &BraceItem| match item.name {
            Some(_) => self.difference_item(item, id).is_none(),
            None => self.parenthesised_item(body, item, id, false).is_some(),
        };
        let any_named = items.iter().any(is_named);
        let mut named: Option<bool> = None;
        let mut good = true;
        for item in items {
            let difference = self.difference_item(item, id);
            let parenthesised = self.parenthesised_item(body, item, id, any_named);
            let (name, value) = match (&difference, &parenthesised) {
                (Some(difference), _) => (None, difference),
                (None, Some((name, value))) => (Some(*name), value),
                (None, None) => (item.name, &item.value),
            };
            if named.is_some_and(|named| named != name.is_some()) {
                self.expect_component(body, id, value, values.iter().map(Option::is_some));
                self.report::<()>(body, value.span, TypeProblem::MixedBraces);
                good = false;
                break;
            }
            named = Some(name.is_some());
            let index = match name {
                Some(name) => self.component(body, id, name),
                None => match by_position.next() {
                    Some((index, _)) => Some(index),
                    None => {
                        let ty = format!("`{}`", id.def(self.family()).name);
                        let wanted = components.iter().filter(|component| component.by_position).count();
                        self.report(body, value.span, TypeProblem::TooManyValues { wanted, ty })
                    }
                },
            };
            let Some((index, component)) = index.and_then(|index| Some((index, components.get(index)?))) else {
                good = false;
                continue;
            };
            if values.get(index).is_some_and(Option::is_some) {
                let name = component.name.to_string();
                let span = item.name.map_or(item.value.span, |name| name.span);
                self.report::<()>(body, span, TypeProblem::ComponentTwice { name });
                good = false;
                continue;
            }
            self.expect_in_braces(id, value, values.iter().map(Option::is_some));
            let what = format_args!("`{}`", component.name);
            match self.expr_as(body, value, Type::scalar(component.ty), what) {
                Some(checked) => {
                    self.check_component(body, id, index, &checked);
                    if let Some(slot) = values.get_mut(index) {
                        *slot = Some(checked);
                    }
                }
                None => good = false,
            }
        }
        good.then(|| Expr { ty: Type::scalar(Base::Struct(id)), kind: ExprKind::Struct(id, values), span })
    }

    /// The problem with the values of a structure that contains structures, if these have no braces of their own:
    /// `wobj w = {500,-650,100,0,0,0}`.
    fn flat_structure(&self, body: &CheckedBody, items: &[BraceItem], id: Struct) -> Option<TypeProblem> {
        let def = id.def(self.family());
        let mut rest = items.iter().peekable();
        let mut written = Vec::new();
        let mut inner_name = None;
        for component in def.components {
            let Base::Struct(inner) = component.ty else {
                written.extend(rest.next().map(|item| self.item_text(body, item)));
                continue;
            };
            let fields = inner.def(self.family()).components;
            let mut values = Vec::new();
            while values.len() < fields.len()
                && let Some(item) = rest.next_if(|item| self.is_number_of(item, inner))
            {
                values.push(item);
            }
            if values.is_empty() {
                written.extend(rest.next().map(|item| self.item_text(body, item)));
                continue;
            }
            let named = values.iter().any(|item| item.name.is_some());
            let values: Vec<String> = values.into_iter().map(|item| self.item_text(body, item)).collect();
            let label = if named { format!("{} ", component.name) } else { String::new() };
            written.push(format!("{label}{{{}}}", values.join(",")));
            inner_name.get_or_insert((component.name, inner.def(self.family()).name));
        }
        written.extend(rest.map(|item| self.item_text(body, item)));
        let (component, inner) = inner_name?;
        let (ty, right) = (def.name.into(), format!("{{{}}}", written.join(",")));
        Some(TypeProblem::FlatStructure { ty, component: component.into(), inner: inner.into(), right })
    }

    /// Whether an item is a literal number, either without a name or with the name of a component of the structure.
    fn is_number_of(&self, item: &BraceItem, id: Struct) -> bool {
        let value = match &item.value.kind {
            ast::ExprKind::Unary(UnaryOp::Negate, inner) => &inner.kind,
            kind => kind,
        };
        let is_its = item.name.is_none_or(|name| self.find_component(id, name.symbol).is_some());
        is_its && matches!(value, ast::ExprKind::Int(..) | ast::ExprKind::Double(_))
    }

    fn item_text(&self, body: &CheckedBody, item: &BraceItem) -> String {
        let span = item.name.map_or(item.value.span, |name| name.span.to(item.value.span));
        self.text(body.module, span).to_string()
    }

    /// Warns about a constant that makes no sense in a component.
    pub(crate) fn check_component(&mut self, body: &CheckedBody, id: Struct, index: usize, value: &Expr) {
        let def = id.def(self.family());
        let Some(component) = def.components.get(index) else { return };
        let number = match value.kind {
            ExprKind::Const(Value::Bool(value)) => Some(f64::from(value)),
            _ => number(value),
        };
        let (Some(range), Some(number)) = (component.range, number) else { return };
        if range.holds(number) || component.start == Start::Unset && number == UNSET {
            return;
        }
        let value_text = self.excerpt(body.module, value.span);
        let problem = ComponentRange { structure: def.name, component, value: value_text };
        let _: Option<()> = self.report(body, value.span, problem);
    }

    /// A name before a value names a component if the structure has it; otherwise `{n -1}` is a difference.
    fn difference_item(&self, item: &BraceItem, id: Struct) -> Option<ast::Expr> {
        let is_component = item.name.is_some_and(|name| self.find_component(id, name.symbol).is_some());
        if is_component { None } else { brace_difference(item) }
    }

    /// `{x (a)}` reads like a call. It is a component and its value if the structure has the component, and either
    /// other components are named or the program has no such function.
    fn parenthesised_item(
        &self,
        body: &CheckedBody,
        item: &BraceItem,
        id: Struct,
        any_named: bool,
    ) -> Option<(ast::Ident, ast::Expr)> {
        if item.name.is_some() {
            return None;
        }
        let (name, value) = without_call(&item.value)?;
        let is_function = self.scopes.get(body.module.0 as usize)?.funcs.contains_key(&name.symbol);
        (self.find_component(id, name.symbol).is_some() && (any_named || !is_function)).then_some((name, value))
    }

    /// Fills `out` with the elements of an array of the given (remaining) dimensions.
    fn array(
        &mut self,
        body: &mut CheckedBody,
        items: &[BraceItem],
        want: Type,
        dims: &[u16],
        out: &mut Vec<Expr>,
        span: Span,
    ) -> Option<()> {
        let total: usize = dims.iter().map(|dim| *dim as usize).product();
        let begin = out.len();
        if dims.len() > 1 && self.is_nested(body, items, want.base) {
            let rows = dims.first().map_or(0, |rows| *rows as usize);
            let inner = dims.get(1..).unwrap_or(&[]);
            let row_len: usize = inner.iter().map(|dim| *dim as usize).product();
            for (row, item) in items.iter().enumerate() {
                let ast::ExprKind::Brace(row_items) = &item.value.kind else {
                    return self.report(body, item.value.span, TypeProblem::NotARow { row: row_len });
                };
                if row >= rows {
                    return self.report(body, item.value.span, TypeProblem::TooManyRows { rows });
                }
                self.array(body, row_items, want, inner, out, item.value.span)?;
                while out.len() < begin + (row + 1) * row_len {
                    out.push(start_value(want.base, span));
                }
            }
            let few = Few { given: items.len(), size: rows, of: "rows", dims };
            self.doubt_few(body, want, &few, span);
            return Some(());
        }
        let mut good = true;
        for item in items {
            if out.len() - begin == total {
                let is_row = dims.len() < want.dims().len();
                let ty = if is_row { "each row".into() } else { format!("`{}`", self.type_name(want)) };
                return self.report(body, item.value.span, TypeProblem::TooManyValues { wanted: total, ty });
            }
            let joined = brace_difference(item);
            let value = joined.as_ref().unwrap_or(&item.value);
            if let (Some(name), None) = (item.name, &joined) {
                let ty = self.type_name(want);
                self.report::<()>(body, name.span, TypeProblem::NotAStructure { ty });
                good = false;
                continue;
            }
            match self.expr_as(body, value, want.element(), "an element") {
                Some(element) => out.push(element),
                None => good = false,
            }
        }
        if good {
            let few = Few { given: out.len() - begin, size: total, of: "elements", dims };
            self.doubt_few(body, want, &few, span);
        }
        good.then_some(())
    }

    /// Warns about braces that give values for only some of the elements or rows of an array.
    fn doubt_few(&mut self, body: &CheckedBody, want: Type, few: &Few<'_>, span: Span) {
        let Few { given, size, of, dims } = *few;
        if (2..size).contains(&given) {
            let is_whole = dims.len() == want.dims().len();
            let help = match dims {
                // The intended sizes are unknown.
                [_, _, ..] if of == "elements" => "give all values, or each row braces of its own".into(),
                _ if is_whole => format!("give all values, or declare the array with {given} {of}"),
                _ => format!("give values for all {size}"),
            };
            let rest = start_words(want.base);
            self.report::<()>(body, span, Doubt::TooFewValues { given, size, of, rest, help });
        }
    }

    /// Whether the braces of a multidimensional array contain rows in braces rather than a flat list of elements.
    fn is_nested(&mut self, body: &CheckedBody, items: &[BraceItem], base: Base) -> bool {
        let first_brace = |items: &[BraceItem]| match items.first().map(|item| &item.value.kind) {
            Some(ast::ExprKind::Brace(inner)) => Some(inner.len()),
            _ => None,
        };
        let Some(ast::ExprKind::Brace(inner)) = items.first().map(|item| &item.value.kind) else { return false };
        // If the elements are structures, they have braces themselves: rows are then braces of braces, or of values of
        // that type.
        !matches!(base, Base::Struct(_))
            || first_brace(inner).is_some() && !self.opens_structure(inner, base)
            || inner.first().is_some_and(|item| item.name.is_none() && self.plainly_is(body, &item.value, base))
    }

    /// Whether a variable, an element of one, or a call has a value of this type, as far as its name shows.
    fn plainly_is(&mut self, body: &CheckedBody, expr: &ast::Expr, base: Base) -> bool {
        let ty = match &expr.kind {
            ast::ExprKind::Name(symbol) => match body.find(*symbol) {
                Some(local) => body.local_type(local),
                None => self.find_global(body, *symbol).and_then(|(id, _)| self.global_type(id)),
            },
            ast::ExprKind::Path { scope, system: false, name } => {
                let found = self.find_module(body, *scope).and_then(|module| self.scopes.get(module.0 as usize));
                let id = found.and_then(|scope| scope.globals.get(&name.symbol)).copied();
                id.and_then(|id| self.global_type(id))
            }
            ast::ExprKind::System(symbol) => {
                let name = self.names.name(*symbol);
                let element = || catalog::system_element(name).map(|(variable, _)| variable);
                catalog::system_variable(name).or_else(element).map(|variable| Type::scalar(variable.ty))
            }
            ast::ExprKind::Index(both) => return self.plainly_is(body, &both.0, base),
            ast::ExprKind::Call(call) => self.call_type(body, call),
            _ => None,
        };
        ty.is_some_and(|ty| ty.base == base)
    }

    /// The type of a global variable; `None` while the variable is being checked, because its own value is being looked
    /// at then.
    pub(crate) fn global_type(&mut self, id: GlobalId) -> Option<Type> {
        if self.globals.get(id.0 as usize)?.state != CheckState::Busy {
            self.check_global(id);
        }
        self.globals.get(id.0 as usize).filter(|slot| slot.state == CheckState::Done)?.ty
    }

    /// The result type of a call, if it does not depend on the arguments.
    fn call_type(&self, body: &CheckedBody, call: &ast::Call) -> Option<Type> {
        let module = match call.module {
            Some(module) => self.find_module(body, module)?,
            None => body.module,
        };
        let result = match self.scopes.get(module.0 as usize)?.funcs.get(&call.name.symbol) {
            Some(own) => self.funcs.get(own.0 as usize)?.result?,
            None => catalog::functions(self.names.name(call.name.symbol)).first()?.result,
        };
        Some(Type::scalar(result))
    }

    /// Whether the items belong to one structure whose first component is itself a structure (`tool`, `wobj`).
    fn opens_structure(&self, items: &[BraceItem], base: Base) -> bool {
        let Base::Struct(id) = base else { return false };
        let nested = id.def(self.family()).components.first().is_some_and(|first| matches!(first.ty, Base::Struct(_)));
        let inner_is_brace = matches!(items.first().map(|item| &item.value.kind),
            Some(ast::ExprKind::Brace(inner)) if matches!(inner.first().map(|item| &item.value.kind), Some(ast::ExprKind::Brace(_))));
        nested && !inner_is_brace
    }
}

/// In the braces of an array `n -1` is a difference, not a component: returns the whole expression if the item is one.
fn brace_difference(item: &BraceItem) -> Option<ast::Expr> {
    let name = item.name?;
    let left = ast::Expr { kind: ast::ExprKind::Name(name.symbol), span: name.span };
    subtract(left, &item.value)
}

/// The name of the call that an expression begins with, and the expression with the call replaced by its only argument.
fn without_call(expr: &ast::Expr) -> Option<(ast::Ident, ast::Expr)> {
    let (name, kind) = match &expr.kind {
        ast::ExprKind::Call(call) => match call.args.as_slice() {
            [ast::Arg { label: None, value, unit: None }] if call.module.is_none() => {
                return Some((call.name, value.clone()));
            }
            _ => return None,
        },
        ast::ExprKind::Binary(op, both) => {
            let (name, left) = without_call(&both.0)?;
            (name, ast::ExprKind::Binary(*op, Box::new((left, both.1.clone()))))
        }
        ast::ExprKind::Field(inner, component) => {
            let (name, inner) = without_call(inner)?;
            (name, ast::ExprKind::Field(Box::new(inner), *component))
        }
        _ => return None,
    };
    Some((name, ast::Expr { kind, span: expr.span }))
}

/// `left` minus the operand of the leftmost unary minus of `expr`; `None` if `expr` does not begin with one.
fn subtract(left: ast::Expr, expr: &ast::Expr) -> Option<ast::Expr> {
    let span = left.span.to(expr.span);
    let kind = match &expr.kind {
        ast::ExprKind::Unary(UnaryOp::Negate, operand) => {
            ast::ExprKind::Binary(BinaryOp::Subtract, Box::new((left, (**operand).clone())))
        }
        ast::ExprKind::Binary(op @ (BinaryOp::Multiply | BinaryOp::Divide | BinaryOp::Remainder), both) => {
            let ast::ExprKind::Unary(UnaryOp::Negate, operand) = &both.0.kind else { return None };
            let product = ast::Expr {
                kind: ast::ExprKind::Binary(*op, Box::new(((**operand).clone(), both.1.clone()))),
                span: operand.span.to(both.1.span),
            };
            ast::ExprKind::Binary(BinaryOp::Subtract, Box::new((left, product)))
        }
        ast::ExprKind::Binary(op, both) => {
            let first = subtract(left, &both.0)?;
            ast::ExprKind::Binary(*op, Box::new((first, both.1.clone())))
        }
        _ => return None,
    };
    Some(ast::Expr { kind, span })
}

/// The default value of a type, in words.
fn start_words(base: Base) -> &'static str {
    match base {
        Base::Int | Base::Uint | Base::Byte | Base::Double => "0",
        Base::Bool => "false",
        Base::String => "empty",
        _ => "at the start value of the type",
    }
}

/// The default value of a type, as an expression.
fn start_value(base: Base, span: Span) -> Expr {
    let kind = match base {
        Base::Int => ExprKind::Const(Value::Int(0)),
        Base::Uint => ExprKind::Const(Value::Uint(0)),
        Base::Byte => ExprKind::Const(Value::Byte(0)),
        Base::Double => ExprKind::Const(Value::Double(0.0)),
        Base::Bool => ExprKind::Const(Value::Bool(false)),
        Base::String | Base::Void | Base::Handle(_) => ExprKind::Const(Value::String("".into())),
        Base::Enum(id) => ExprKind::Const(Value::Enum(id, 0)),
        Base::Struct(id) => ExprKind::Struct(id, Vec::new()),
    };
    Expr { ty: Type::scalar(base), kind, span }
}
