//! Values of ARL: from a literal to JSON.

use arl_lang::ast::{BraceItem, Expr, ExprKind, UnaryOp};
use arl_lang::catalog::{self, Base, Family};
use arl_lang::symbol::Interner;
use arl_lang::{ParseOptions, parse_expression};
use pyo3::prelude::*;
use serde_json::{Map, Number, Value};

use crate::problem::Refused;

/// The key of a value that JSON does not have: the literal as it is.
const AS_IT_STANDS: &str = "arl";

/// A step into a value: `.x`, `[2]`.
#[derive(Clone, PartialEq, Debug)]
enum Step {
    Component(String),
    Element(usize),
}

/// The place of a number in a global variable: `place[2].x`.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Place {
    /// The variable.
    pub(crate) variable: String,
    steps: Vec<Step>,
}

impl Place {
    /// Reads a place: `place[2].x`.
    pub(crate) fn parse(text: &str) -> PyResult<Self> {
        let wrong = || Refused::new_err(format!("`{text}` is not a global variable or a part of one, like place[2].x"));
        let end = text.find(['.', '[']).unwrap_or(text.len());
        let (variable, mut rest) = text.split_at(end);
        let mut steps = Vec::new();
        while !rest.is_empty() {
            if let Some(inside) = rest.strip_prefix('[') {
                let (index, behind) = inside.split_once(']').ok_or_else(wrong)?;
                steps.push(Step::Element(index.parse().map_err(|_| wrong())?));
                rest = behind;
            } else {
                let behind = rest.strip_prefix('.').ok_or_else(wrong)?;
                let end = behind.find(['.', '[']).unwrap_or(behind.len());
                let (name, behind) = behind.split_at(end);
                steps.push(Step::Component(name.to_ascii_lowercase()));
                rest = behind;
            }
        }
        Ok(Self { variable: variable.to_owned(), steps })
    }

    /// Whether it is a whole variable.
    pub(crate) fn is_whole(&self) -> bool {
        self.steps.is_empty()
    }

    /// The number at this place; truth values are 0 and 1, and a value that is not set is not a number.
    pub(crate) fn number(&self, value: &Value) -> f64 {
        let found = self.steps.iter().try_fold(value, |value, step| match step {
            Step::Component(name) => value.get(name),
            Step::Element(index) => value.get(index),
        });
        match found {
            Some(Value::Bool(level)) => f64::from(u8::from(*level)),
            Some(value) => value.as_f64().unwrap_or(f64::NAN),
            None => f64::NAN,
        }
    }
}

/// A literal of a type as JSON: structures are objects whose names are in small letters, arrays are lists, and numbers
/// of type double have a point. A value that JSON does not have, like a constant of an enumeration, is `{"arl": ".."}`.
pub(crate) fn of_literal(literal: &str, ty: &str) -> PyResult<Value> {
    let mut names = Interner::default();
    let parsed = parse_expression(literal, &mut names, ParseOptions::default());
    if let Some(error) = parsed.errors.first() {
        return Err(Refused::new_err(format!("{literal}: {}", error.kind.message())));
    }
    let reader = Reader { literal, names: &names };
    Ok(reader.value(&parsed.expr, catalog::base_type(&ty.to_ascii_lowercase())))
}

struct Reader<'a> {
    literal: &'a str,
    names: &'a Interner,
}

impl Reader<'_> {
    fn value(&self, expr: &Expr, ty: Option<Base>) -> Value {
        match &expr.kind {
            ExprKind::Int(number, _) => of_number(f64::from(*number), ty),
            ExprKind::Double(number) => of_number(*number, ty.or(Some(Base::Double))),
            ExprKind::String(text) => Value::from(&**text),
            ExprKind::Bool(level) => Value::from(*level),
            ExprKind::Unary(UnaryOp::Negate, inner) => match (&inner.kind, ty) {
                (ExprKind::Int(number, _), ty) => of_number(-f64::from(*number), ty),
                (ExprKind::Double(number), ty) => of_number(-number, ty.or(Some(Base::Double))),
                _ => self.as_it_stands(expr),
            },
            ExprKind::Brace(items) => self.brace(items, ty),
            _ => self.as_it_stands(expr),
        }
    }

    fn brace(&self, items: &[BraceItem], ty: Option<Base>) -> Value {
        let components = match ty {
            // Literals of the runtime name their components: those of SCARA robots are among these, of the same types.
            Some(Base::Struct(id)) => id.def(Family::SixAxis).components,
            _ => &[],
        };
        let is_nameless = items.iter().all(|item| item.name.is_none());
        if is_array(items) || (is_nameless && components.is_empty()) {
            return items.iter().map(|item| self.value(&item.value, ty)).collect();
        }
        let mut object = Map::new();
        for (at, item) in items.iter().enumerate() {
            let name = item.name.as_ref().map(|name| self.names.name(name.symbol));
            let component = match name {
                Some(name) => components.iter().find(|it| it.name.eq_ignore_ascii_case(name)),
                None => components.get(at),
            };
            let Some(name) = name.or(component.map(|it| it.name)) else { continue };
            object.insert(name.to_ascii_lowercase(), self.value(&item.value, component.map(|it| it.ty)));
        }
        Value::Object(object)
    }

    fn as_it_stands(&self, expr: &Expr) -> Value {
        Value::Object(Map::from_iter([(AS_IT_STANDS.to_owned(), expr.span.text(self.literal).into())]))
    }
}

/// Whether these are elements of an array of structures: the components of one structure have names, or are not all
/// structures.
fn is_array(items: &[BraceItem]) -> bool {
    let is_element = |item: &BraceItem| item.name.is_none() && matches!(item.value.kind, ExprKind::Brace(_));
    !items.is_empty() && items.iter().all(is_element)
}

fn of_number(number: f64, ty: Option<Base>) -> Value {
    match ty {
        Some(Base::Double) => Number::from_f64(number).map_or(Value::Null, Value::Number),
        _ => Value::from(number as i64),
    }
}

/// A literal of a type as JSON.
#[pyfunction]
pub(crate) fn value(literal: &str, ty: &str) -> PyResult<String> {
    Ok(of_literal(literal, ty)?.to_string())
}
