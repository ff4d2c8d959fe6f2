//! Expressions of ARL while the program is halted: variables and their parts, operators, and functions that change
//! nothing.
//!
//! Operators are those of the checker ([`operators`]). What is declared `const` is not known here: where an operator
//! takes two values only if one of them is a constant, names count as constants.

use super::literal::{Literal, Part};
use arl_lang::ast::{BinaryOp, Call, Expr, ExprKind, Radix, UnaryOp};
use arl_lang::catalog::{Base, Family, base_type, enum_constant, functions, system_element};
use arl_lang::symbol::Interner;
use arl_lang::written;
use arl2rs::hir;
use arl2rs::operators::{self, Operand};

/// A value with its type.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Value {
    Int(i32),
    Uint(u32),
    Byte(u8),
    Double(f64),
    Bool(bool),
    Text(String),
    /// A structure, an array, a constant of an enumeration.
    Other(String, Literal),
}

/// A variable as it is kept: type, sizes of an array of several dimensions, value.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Variable {
    pub(super) ty: String,
    pub(super) value: Literal,
}

/// What an expression can refer to.
pub(super) trait Source {
    /// A variable or constant by its name; `module` is the name before `::`.
    ///
    /// # Errors
    /// There is no such variable.
    fn variable(&mut self, module: Option<&str>, name: &str) -> Result<Variable>;

    /// A system variable by its name without `$`.
    ///
    /// # Errors
    /// There is no such variable.
    fn system(&mut self, name: &str) -> Result<Variable>;

    /// A signal: `di`, `do`, `ai`, `ao`.
    ///
    /// # Errors
    /// There is no such signal.
    fn signal(&mut self, kind: &str, number: i32) -> Result<Value>;

    /// The result of a function for these arguments.
    ///
    /// # Errors
    /// The function cannot be called while the program is halted, or does not take these arguments.
    fn call(&mut self, function: &str, arguments: &[String]) -> Result<Variable>;

    fn family(&self) -> Family;
}

/// What an expression names: a variable, and the path to a part of it.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct NamedPlace {
    pub(super) root: Root,
    pub(super) path: Vec<Part>,
}

/// A variable that an expression names.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Root {
    Variable(Option<String>, String),
    System(String),
}

/// An expression, or an assignment to a place.
pub(super) enum Input {
    Value(Value),
    Assignment(NamedPlace, Value),
}

type Result<T> = std::result::Result<T, String>;

/// Evaluates an expression.
pub(super) fn evaluate(text: &str, source: &mut dyn Source) -> Result<Input> {
    let mut names = Interner::default();
    let expr = parsed(text, &mut names)?;
    let mut evaluator = Evaluator { names: &names, source };
    match &expr.kind {
        ExprKind::Assign(op, sides) => {
            let place = evaluator.place(&sides.0)?;
            let given = match op {
                Some(op) => Given { value: evaluator.binary(*op, &sides.0, &sides.1)?, written: None, is_name: false },
                None => evaluator.given(&sides.1)?,
            };
            let value = evaluator.fitting(&place, given)?;
            Ok(Input::Assignment(place, value))
        }
        ExprKind::Step(step, inner) => {
            let place = evaluator.place(inner)?;
            let op = if step.up { BinaryOp::Add } else { BinaryOp::Subtract };
            let one = Given { value: Value::Int(1), written: Some(operators::Literal::None), is_name: false };
            let before = evaluator.given(inner)?;
            if !matches!(before.value, Value::Int(_) | Value::Uint(_) | Value::Byte(_)) {
                return Err(format!("a {} cannot be counted up or down", before.value.ty()));
            }
            let value = binary(op, &before, &one)?;
            Ok(Input::Assignment(place, value))
        }
        _ => evaluator.value(&expr).map(Input::Value),
    }
}

/// Why a text is not an expression.
pub(super) fn unreadable(text: &str) -> Option<String> {
    parsed(text, &mut Interner::default()).err()
}

fn parsed(text: &str, names: &mut Interner) -> Result<Expr> {
    let parsed = arl_lang::parse_expression(text.trim(), names, arl_lang::ParseOptions::default());
    match parsed.errors.first() {
        Some(error) => Err(error.kind.message()),
        None => Ok(parsed.expr),
    }
}

/// The first function that a condition calls and that is not built in.
pub(super) fn uncallable(condition: &str) -> Option<&str> {
    let mut names = Interner::default();
    let expr = parsed(condition, &mut names).ok()?;
    let name = foreign_call(&expr, &names)?.name.span;
    condition.trim().get(name.start as usize..name.end as usize)
}

/// The first call of a function that is not built in.
fn foreign_call<'a>(expr: &'a Expr, names: &Interner) -> Option<&'a Call> {
    let first = |one: &'a Expr, other: &'a Expr| foreign_call(one, names).or_else(|| foreign_call(other, names));
    match &expr.kind {
        ExprKind::Call(call) => {
            let is_built_in =
                call.module.is_none() && !functions(&names.name(call.name.symbol).to_lowercase()).is_empty();
            let inner = || call.args.iter().find_map(|arg| foreign_call(&arg.value, names));
            if is_built_in { inner() } else { Some(call) }
        }
        ExprKind::Index(both) | ExprKind::Binary(_, both) | ExprKind::Assign(_, both) => first(&both.0, &both.1),
        ExprKind::Field(inner, _) | ExprKind::Unary(_, inner) | ExprKind::Step(_, inner) => foreign_call(inner, names),
        ExprKind::Brace(items) => items.iter().find_map(|item| foreign_call(&item.value, names)),
        _ => None,
    }
}

/// The place that an expression names.
pub(super) fn place(text: &str, source: &mut dyn Source) -> Result<NamedPlace> {
    let mut names = Interner::default();
    let expr = parsed(text, &mut names)?;
    Evaluator { names: &names, source }.place(&expr)
}

impl Value {
    /// A variable or a part of one.
    pub(super) fn of(ty: &str, literal: &Literal) -> Self {
        let Literal::Plain(text) = literal else { return Self::Other(ty.to_owned(), literal.clone()) };
        let read = match ty {
            "int" => text.parse().ok().map(Self::Int),
            "uint" => text.parse().ok().map(Self::Uint),
            "byte" => text.parse().ok().map(Self::Byte),
            "double" => text.parse().ok().map(Self::Double),
            "bool" => text.parse().ok().map(Self::Bool),
            "string" => unquoted(text).map(Self::Text),
            _ => None,
        };
        read.unwrap_or_else(|| Self::Other(ty.to_owned(), literal.clone()))
    }

    /// The type's name.
    pub(super) fn ty(&self) -> &str {
        match self {
            Self::Int(_) => "int",
            Self::Uint(_) => "uint",
            Self::Byte(_) => "byte",
            Self::Double(_) => "double",
            Self::Bool(_) => "bool",
            Self::Text(_) => "string",
            Self::Other(ty, _) => ty,
        }
    }

    /// The value as a literal that can be assigned.
    pub(super) fn literal(&self) -> Literal {
        let mut written = String::new();
        match self {
            Self::Int(value) => written = value.to_string(),
            Self::Uint(value) => written = value.to_string(),
            Self::Byte(value) => written = value.to_string(),
            Self::Double(value) => written::double(*value, &mut written),
            Self::Bool(value) => written = value.to_string(),
            Self::Text(text) => written::string(text, &mut written),
            Self::Other(_, literal) => return literal.clone(),
        }
        Literal::Plain(written)
    }

    /// The value for operators; `None`: no operator takes it.
    fn scalar(&self) -> Option<hir::Value> {
        Some(match self {
            Self::Int(value) => hir::Value::Int(*value),
            Self::Uint(value) => hir::Value::Uint(*value),
            Self::Byte(value) => hir::Value::Byte(*value),
            Self::Double(value) => hir::Value::Double(*value),
            Self::Bool(value) => hir::Value::Bool(*value),
            Self::Text(text) => hir::Value::String(text.as_str().into()),
            Self::Other(ty, Literal::Plain(name)) => {
                let Some(Base::Enum(id)) = base_type(&ty.to_ascii_lowercase()) else { return None };
                let mut names = id.def().constants.iter().map(|constant| constant.name);
                let at = names.position(|constant| constant.eq_ignore_ascii_case(name))?;
                hir::Value::Enum(id, u16::try_from(at).ok()?)
            }
            Self::Other(..) => return None,
        })
    }

    /// Whether it counts as true in a condition.
    pub(super) fn truth(&self) -> Result<bool> {
        let fitting = self.scalar().and_then(|value| operators::fit(&value, operators::Literal::None, Base::Bool));
        match fitting {
            Some(hir::Value::Bool(truth)) => Ok(truth),
            _ => Err(format!("{} is not a condition", self.ty())),
        }
    }
}

impl From<hir::Value> for Value {
    fn from(value: hir::Value) -> Self {
        match value {
            hir::Value::Int(value) => Self::Int(value),
            hir::Value::Uint(value) => Self::Uint(value),
            hir::Value::Byte(value) => Self::Byte(value),
            hir::Value::Double(value) => Self::Double(value),
            hir::Value::Bool(value) => Self::Bool(value),
            hir::Value::String(text) => Self::Text(text.to_string()),
            hir::Value::Enum(id, at) => {
                let name = id.def().constants.get(usize::from(at)).map_or("", |constant| constant.name);
                Self::Other(id.def().name.to_owned(), Literal::Plain(name.to_owned()))
            }
        }
    }
}

/// The value of an operand.
struct Given {
    value: Value,
    /// How it was written, if it is a constant.
    written: Option<operators::Literal>,
    /// Whether it is the name of a variable, which may be declared as a constant.
    is_name: bool,
}

/// The text of a string literal.
fn unquoted(literal: &str) -> Option<String> {
    let parsed = arl_lang::parse_expression(literal, &mut Interner::default(), arl_lang::ParseOptions::default());
    match parsed.expr.kind {
        ExprKind::String(text) if parsed.errors.is_empty() => Some(text.into()),
        _ => None,
    }
}

struct Evaluator<'a> {
    names: &'a Interner,
    source: &'a mut dyn Source,
}

impl Evaluator<'_> {
    /// A value to be assigned: also braces, which have no type of their own.
    fn assigned(&mut self, expr: &Expr) -> Result<Value> {
        match &expr.kind {
            ExprKind::Brace(items) => {
                let mut parts = Vec::new();
                for item in items {
                    let name = item.name.map(|name| self.names.name(name.symbol).to_owned());
                    parts.push((name, self.assigned(&item.value)?.literal()));
                }
                let literal = if parts.iter().all(|(name, _)| name.is_some()) {
                    Literal::Named(parts.into_iter().filter_map(|(name, part)| Some((name?, part))).collect())
                } else {
                    Literal::Listed(parts.into_iter().map(|(_, part)| part).collect())
                };
                Ok(Value::Other(String::new(), literal))
            }
            _ => self.value(expr),
        }
    }

    fn value(&mut self, expr: &Expr) -> Result<Value> {
        match &expr.kind {
            ExprKind::Int(value, _) => Ok(i32::try_from(*value).map_or(Value::Uint(*value), Value::Int)),
            ExprKind::Double(value) => Ok(Value::Double(*value)),
            ExprKind::String(text) => Ok(Value::Text(text.to_string())),
            ExprKind::Bool(value) => Ok(Value::Bool(*value)),
            ExprKind::Name(symbol) => {
                let name = self.names.name(*symbol).to_owned();
                match self.source.variable(None, &name) {
                    Ok(variable) => Ok(Value::of(&variable.ty, &variable.value)),
                    Err(why) => word(&name).ok_or(why),
                }
            }
            ExprKind::Path { scope, name, .. } => {
                let (scope, name) = (self.names.name(scope.symbol).to_owned(), self.names.name(name.symbol).to_owned());
                match base_type(&scope) {
                    Some(Base::Enum(_)) => word(&name).ok_or_else(|| format!("{scope} has no constant {name}")),
                    _ => {
                        let variable = self.source.variable(Some(&scope), &name)?;
                        Ok(Value::of(&variable.ty, &variable.value))
                    }
                }
            }
            ExprKind::Field(inner, name) if matches!(inner.kind, ExprKind::Call(_)) => {
                let whole = self.value(inner)?;
                let part = Part::Named(self.names.name(name.symbol).to_owned());
                let ty = part_type(whole.ty(), &part, self.source.family())?;
                let unset = || Literal::Plain("9e9".into());
                Ok(Value::of(&ty, &whole.literal().part(&[part]).cloned().unwrap_or_else(unset)))
            }
            ExprKind::System(_) | ExprKind::Index(_) | ExprKind::Field(..) => {
                let place = self.place(expr)?;
                let (ty, literal) = self.found(&place)?;
                Ok(Value::of(&ty, &literal))
            }
            ExprKind::Call(call) => self.call(call),
            ExprKind::Unary(op, inner) => unary(*op, &self.given(inner)?),
            ExprKind::Binary(op @ (BinaryOp::And | BinaryOp::Or), sides) => {
                let left = self.value(&sides.0)?.truth()?;
                let decided = (*op == BinaryOp::Or) == left;
                Ok(Value::Bool(if decided { left } else { self.value(&sides.1)?.truth()? }))
            }
            ExprKind::Binary(op, sides) => self.binary(*op, &sides.0, &sides.1),
            ExprKind::Assign(..) | ExprKind::Step(..) => Err("only the whole input can be an assignment".into()),
            ExprKind::Brace(_) => self.assigned(expr),
            ExprKind::Splice(_) | ExprKind::Error => Err("this is not an expression".into()),
        }
    }

    fn given(&mut self, expr: &Expr) -> Result<Given> {
        let (mut value, written) = (self.value(expr)?, self.written(expr));
        // A pattern has 32 bits and no sign of its own: an int, until its place requires something else.
        if let (Value::Uint(bits), Some(operators::Literal::Pattern)) = (&value, written) {
            value = Value::Int(*bits as i32);
        }
        let is_name = written.is_none() && matches!(expr.kind, ExprKind::Name(_) | ExprKind::Path { .. });
        Ok(Given { value, written, is_name })
    }

    fn binary(&mut self, op: BinaryOp, left: &Expr, right: &Expr) -> Result<Value> {
        binary(op, &self.given(left)?, &self.given(right)?)
    }

    /// How a constant is written; `None`: the expression is not a constant.
    fn written(&mut self, expr: &Expr) -> Option<operators::Literal> {
        use operators::Literal as Written;
        match &expr.kind {
            ExprKind::Int(value, Radix::Decimal) if i32::try_from(*value).is_err() => Some(Written::Wide),
            ExprKind::Int(_, Radix::Binary | Radix::Hexadecimal) => Some(Written::Pattern),
            ExprKind::Int(..) | ExprKind::Double(_) | ExprKind::String(_) | ExprKind::Bool(_) => Some(Written::None),
            ExprKind::Name(symbol) => {
                let name = self.names.name(*symbol).to_owned();
                // A variable may have the name of a number.
                hexadecimal(&name).filter(|_| self.source.variable(None, &name).is_err()).map(|_| Written::Pattern)
            }
            ExprKind::Unary(UnaryOp::Complement, inner) => match self.written(inner)? {
                Written::Pattern => Some(Written::Complement),
                _ => Some(Written::None),
            },
            ExprKind::Unary(_, inner) => self.written(inner).map(|_| Written::None),
            ExprKind::Binary(_, sides) => self.written(&sides.0).and(self.written(&sides.1)).map(|_| Written::None),
            _ => None,
        }
    }

    /// The value in the form of its place; what is not a plain value is left to the program.
    fn fitting(&mut self, place: &NamedPlace, given: Given) -> Result<Value> {
        let (ty, _) = self.found(place)?;
        let wanted = base_type(&ty.to_ascii_lowercase());
        let Some((wanted, value)) = wanted.zip(given.value.scalar()) else { return Ok(given.value) };
        match brought(&value, &given, wanted) {
            Some(fitting) => Ok(fitting.into()),
            None => {
                let range = operators::range(wanted);
                let what = if range.is_empty() { format!("expected a value of type {ty}") } else { range.to_owned() };
                Err(format!("{} does not fit: {what}", given.value.literal().text()))
            }
        }
    }

    fn call(&mut self, call: &arl_lang::ast::Call) -> Result<Value> {
        let name = self.names.name(call.name.symbol).to_owned();
        let kind = match name.as_str() {
            "getdi" => "di",
            "getdo" => "do",
            "getai" => "ai",
            "getao" => "ao",
            _ => {
                let mut arguments = Vec::new();
                for argument in &call.args {
                    if argument.label.is_some() || argument.unit.is_some() {
                        return Err("arguments are given in order here, without labels and units".into());
                    }
                    let value = self.assigned(&argument.value)?;
                    arguments.push(format!("{}:{}", value.ty(), value.literal().text()));
                }
                let given = self.source.call(&name, &arguments)?;
                return Ok(Value::of(&given.ty, &given.value));
            }
        };
        let [argument] = call.args.as_slice() else { return Err(format!("{name} takes the number of one signal")) };
        match self.value(&argument.value)? {
            Value::Int(number) => self.source.signal(kind, number),
            other => Err(format!("{name} takes a number, not {}", other.ty())),
        }
    }

    /// The variable and the part of it that an expression names.
    fn place(&mut self, expr: &Expr) -> Result<NamedPlace> {
        let named = |name: &str| Root::Variable(None, name.to_owned());
        match &expr.kind {
            ExprKind::Name(symbol) => Ok(NamedPlace { root: named(self.names.name(*symbol)), path: Vec::new() }),
            ExprKind::System(symbol) => {
                let name = self.names.name(*symbol);
                let whole = || NamedPlace { root: Root::System(name.to_owned()), path: Vec::new() };
                Ok(system_element(name).map_or_else(whole, |(variable, number)| NamedPlace {
                    root: Root::System(variable.name.to_owned()),
                    path: vec![Part::At(number as usize)],
                }))
            }
            ExprKind::Path { scope, name, .. } => {
                let (scope, name) = (self.names.name(scope.symbol).to_owned(), self.names.name(name.symbol).to_owned());
                Ok(NamedPlace { root: Root::Variable(Some(scope), name), path: Vec::new() })
            }
            ExprKind::Field(inner, name) => {
                let mut place = self.place(inner)?;
                place.path.push(Part::Named(self.names.name(name.symbol).to_owned()));
                Ok(place)
            }
            ExprKind::Index(both) => {
                let mut place = self.place(&both.0)?;
                let index = self.value(&both.1)?;
                let at = match index {
                    Value::Int(at) => usize::try_from(at).map_err(|_| format!("index {at} is below 0"))?,
                    other => return Err(format!("an index is an int, not {}", other.ty())),
                };
                place.path.push(Part::At(at));
                Ok(place)
            }
            _ => Err("this does not name a variable".into()),
        }
    }

    /// The type and value of what is named.
    fn found(&mut self, place: &NamedPlace) -> Result<(String, Literal)> {
        let variable = match &place.root {
            Root::Variable(module, name) => self.source.variable(module.as_deref(), name)?,
            Root::System(name) => self.source.system(name)?,
        };
        let mut ty = variable.ty;
        for part in &place.path {
            ty = part_type(&ty, part, self.source.family())?;
        }
        match variable.value.part(&place.path) {
            Some(literal) => Ok((ty, literal.clone())),
            None if matches!(place.path.last(), Some(Part::Named(_))) => Ok((ty, Literal::Plain("9e9".into()))),
            None => Err("the index is outside the array".into()),
        }
    }
}

/// The type of a part of a value of a type.
pub(super) fn part_type(ty: &str, part: &Part, family: Family) -> Result<String> {
    match part {
        Part::At(_) => {
            let (base, sizes) = ty.split_once('[').ok_or_else(|| format!("{ty} is not an array"))?;
            let rest = sizes.split_once(']').map_or("", |(_, rest)| rest);
            Ok(format!("{base}{rest}"))
        }
        Part::Named(name) => {
            let Some(Base::Struct(id)) = base_type(&ty.to_ascii_lowercase()) else {
                return Err(format!("{ty} has no components"));
            };
            let components = id.def(family).components;
            let found = components.iter().find(|component| component.name.eq_ignore_ascii_case(name));
            found.map(|component| component.ty.name().to_owned()).ok_or_else(|| format!("{ty} has no component {name}"))
        }
    }
}

/// A word that is a constant by itself, a hexadecimal number, or the name of an enumeration's constant.
fn word(name: &str) -> Option<Value> {
    match name {
        "pi" => return Some(Value::Double(std::f64::consts::PI)),
        "endl" => return Some(Value::Text("\n".into())),
        _ => {}
    }
    if let Some(bits) = hexadecimal(name) {
        return Some(i32::try_from(bits).map_or(Value::Uint(bits), Value::Int));
    }
    enum_constant(name).map(|(id, at)| hir::Value::Enum(id, at).into())
}

fn hexadecimal(name: &str) -> Option<u32> {
    name.strip_suffix('h').and_then(|digits| u32::from_str_radix(digits, 16).ok())
}

fn unary(op: UnaryOp, given: &Given) -> Result<Value> {
    let wrong = || format!("{}{} is not possible", op.text(), given.value.ty());
    let value = given.value.scalar().ok_or_else(wrong)?;
    let [wanted, _] = operators::unary(op, operand(&value, given)).ok_or_else(wrong)?;
    let value = brought(&value, given, wanted).ok_or_else(wrong)?;
    operators::compute_unary(op, &value).map(|computed| computed.value.into()).ok_or_else(wrong)
}

fn binary(op: BinaryOp, left: &Given, right: &Given) -> Result<Value> {
    let wrong = || format!("{} {} {} is not possible", left.value.ty(), op.text(), right.value.ty());
    let (one, other) = left.value.scalar().zip(right.value.scalar()).ok_or_else(wrong)?;
    let operation = operators::binary(op, operand(&one, left), operand(&other, right));
    let if_declared = |may_be: bool, one, other| may_be.then(|| operators::binary(op, one, other)).flatten();
    let operation = operation
        .or_else(|| if_declared(right.is_name, operand(&one, left), constant(&other, right)))
        .or_else(|| if_declared(left.is_name, constant(&one, left), operand(&other, right)));
    let operation = operation.ok_or_else(wrong)?;
    let (one, other) = (brought(&one, left, operation.left), brought(&other, right, operation.right));
    let (one, other) = one.zip(other).ok_or_else(wrong)?;
    let computed = operators::compute(op, &one, &other).map_err(|alarm| alarm.to_string())?;
    computed.map(|computed| computed.value.into()).ok_or_else(wrong)
}

fn operand<'a>(value: &'a hir::Value, given: &Given) -> Operand<'a> {
    let literal = given.written.unwrap_or(operators::Literal::None);
    Operand { base: value.base(), constant: given.written.map(|_| value), literal }
}

/// The same operand, declared as a constant.
fn constant<'a>(value: &'a hir::Value, given: &Given) -> Operand<'a> {
    Operand { constant: Some(value), ..operand(value, given) }
}

fn brought(value: &hir::Value, given: &Given, to: Base) -> Option<hir::Value> {
    let literal = given.written.unwrap_or(operators::Literal::None);
    // The constants of enumerations count as int.
    let number = matches!(value, hir::Value::Enum(..)).then(|| operators::fit(value, literal, Base::Int)).flatten();
    operators::fit(value, literal, to).or_else(|| operators::fit(&number?, literal, to))
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Fixed;

    impl Source for Fixed {
        fn variable(&mut self, module: Option<&str>, name: &str) -> Result<Variable> {
            let (ty, text) = match (module, name) {
                (None, "count") => ("int", "7"),
                (None, "late") => ("bool", "false"),
                (None, "mask") => ("byte", "129"),
                (None, "bits") => ("uint", "3"),
                (None, "title") => ("string", r#""a \"b\"""#),
                (None, "home") => ("pose", "{x 1.5,y 2,cfg 3}"),
                (None, "table") => ("int[2][3]", "{{1,2,3},{4,5,6}}"),
                (Some("points"), "pitch") => ("double", "12.5"),
                _ => return Err(format!("there is no variable {name}")),
            };
            Ok(Variable { ty: ty.into(), value: Literal::parse(text) })
        }

        fn system(&mut self, name: &str) -> Result<Variable> {
            match name {
                "i" => Ok(Variable { ty: "int[2]".into(), value: Literal::parse("{8,9}") }),
                _ => Err(format!("there is no variable ${name}")),
            }
        }

        fn signal(&mut self, kind: &str, number: i32) -> Result<Value> {
            Ok(Value::Bool(kind == "di" && number == 3))
        }

        fn call(&mut self, function: &str, arguments: &[String]) -> Result<Variable> {
            match function {
                "twice" => Ok(Variable {
                    ty: "string".into(),
                    value: Literal::parse(&format!("\"{0}{0}\"", arguments[0].trim_start_matches("int:"))),
                }),
                _ => Err(format!("{function} is not called")),
            }
        }

        fn family(&self) -> Family {
            Family::SixAxis
        }
    }

    fn shown(text: &str) -> String {
        match evaluate(text, &mut Fixed) {
            Ok(Input::Value(value)) => format!("{} {}", value.ty(), value.literal().text()),
            Ok(Input::Assignment(place, value)) => format!("{:?} = {}", place.path, value.literal().text()),
            Err(why) => why,
        }
    }

    #[test]
    fn expressions_are_computed_as_the_program_does() {
        for (text, value) in [
            ("count", "int 7"),
            ("count / 2", "int 3"),
            ("count / 2.0", "double 3.5"),
            ("2147483647 + 1", "int -2147483648"),
            ("count > 3 && !late", "bool true"),
            ("title + \"!\"", r#"string "a \"b\"!""#),
            ("home.x + home.cfg", "double 4.5"),
            ("home.ej1", "double 9e9"),
            ("table[1][2] << 1", "int 12"),
            ("table[count - 6]", "int[3] {4,5,6}"),
            ("points::pitch * 2", "double 25"),
            ("$I[1]", "int 9"),
            ("getdi(3) || getdi(4)", "bool true"),
            ("0ffh", "int 255"),
            ("mask << 1", "byte 2"),
            ("~mask", "byte 126"),
            ("mask + 1", "byte 130"),
            ("mask * count", "int 903"),
            ("bits + 4294967295", "uint 2"),
            ("bits == 3", "bool true"),
            ("-2147483648", "int -2147483648"),
            ("\"b\" > title", "bool true"),
            ("twice(count + 1) + \"!\"", "string \"88!\""),
            ("count += 1", "[] = 8"),
            ("count--", "[] = 6"),
            ("bits + count", "uint 10"),
            ("bits = 0ffffffffh", "[] = 4294967295"),
            ("count = 0ffffffffh", "[] = -1"),
            ("mask += 1", "[] = 130"),
            ("home.x = 3", r#"[Named("x")] = 3"#),
            ("home = {x 1, y -2}", "[] = {x 1,y -2}"),
        ] {
            assert_eq!(shown(text), value, "{text}");
        }
    }

    #[test]
    fn mistakes_say_what_is_wrong() {
        for (text, words) in [
            ("nothing", "there is no variable nothing"),
            ("count / 0", "alarm 20001: division by zero"),
            ("mask << 9", "alarm 20002: shift by 9: a value of 8 bits can be shifted by 0 to 7"),
            ("1.5 % 0.0", "alarm 20001: division by zero"),
            ("home.cfg + (bits + 0)", "int + uint is not possible"),
            ("home.x++", "a double cannot be counted up or down"),
            ("mask = 300", "300 does not fit: a byte holds 0 to 255"),
            ("late = \"a\"", "\"a\" does not fit: expected a value of type bool"),
            ("home + home", "pose + pose is not possible"),
            ("table[5]", "outside the array"),
            ("home.q", "pose has no component q"),
            ("title - 1", "string - int is not possible"),
            ("thrice(count)", "thrice is not called"),
        ] {
            assert!(shown(text).contains(words), "{text}: {}", shown(text));
        }
        assert!(evaluate("count +", &mut Fixed).is_err());
    }
}
