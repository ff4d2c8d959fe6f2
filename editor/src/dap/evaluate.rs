//! Expressions of ARL while the program stands: variables and their parts, operators, and functions that change nothing.
//!
//! Numbers are computed as the program does: whole numbers wrap, `int / int` is whole.

use super::literal::{Literal, Part};
use arl_lang::ast::{BinaryOp, Expr, ExprKind, UnaryOp};
use arl_lang::catalog::{Base, Family, base_type, enum_constant, system_element};
use arl_lang::symbol::Interner;
use arl_lang::written;

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

/// What an expression may ask for.
pub(super) trait Source {
    /// A variable or constant by its name; `module` is what stands in front of `::`.
    ///
    /// # Errors
    /// There is none.
    fn variable(&mut self, module: Option<&str>, name: &str) -> Result<Variable>;

    /// A system variable by its name without `$`.
    ///
    /// # Errors
    /// There is none.
    fn system(&mut self, name: &str) -> Result<Variable>;

    /// A signal: `di`, `do`, `ai`, `ao`.
    ///
    /// # Errors
    /// There is none.
    fn signal(&mut self, kind: &str, number: i32) -> Result<Value>;

    /// What a function gives for these arguments.
    ///
    /// # Errors
    /// It is not called while the program stands, or does not take them.
    fn call(&mut self, function: &str, arguments: &[String]) -> Result<Variable>;

    fn family(&self) -> Family;
}

/// What is named by an expression: a variable, and the way to a part of it.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Place {
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
    Assignment(Place, Value),
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
            let value = match op {
                Some(op) => {
                    let (left, right) = (evaluator.value(&sides.0)?, evaluator.value(&sides.1)?);
                    binary(*op, left, right)?
                }
                None => evaluator.assigned(&sides.1)?,
            };
            Ok(Input::Assignment(place, value))
        }
        ExprKind::Step(step, inner) => {
            let place = evaluator.place(inner)?;
            let op = if step.up { BinaryOp::Add } else { BinaryOp::Subtract };
            let value = binary(op, evaluator.value(inner)?, Value::Int(1))?;
            Ok(Input::Assignment(place, value))
        }
        _ => evaluator.value(&expr).map(Input::Value),
    }
}

/// Why a text is no expression.
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

/// What an expression names.
pub(super) fn place(text: &str, source: &mut dyn Source) -> Result<Place> {
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

    /// As a literal that can be assigned.
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

    fn number(&self) -> Option<f64> {
        match self {
            Self::Int(value) => Some(f64::from(*value)),
            Self::Uint(value) => Some(f64::from(*value)),
            Self::Byte(value) => Some(f64::from(*value)),
            Self::Double(value) => Some(*value),
            Self::Bool(_) | Self::Text(_) | Self::Other(..) => None,
        }
    }

    /// Whether it counts as true in a condition.
    pub(super) fn truth(&self) -> Result<bool> {
        match self {
            Self::Bool(value) => Ok(*value),
            other => {
                other.number().map(|number| number != 0.0).ok_or_else(|| format!("{} is no condition", other.ty()))
            }
        }
    }
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
    /// A value that is assigned: also braces, which have no type of their own.
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
            ExprKind::Unary(op, inner) => unary(*op, self.value(inner)?),
            ExprKind::Binary(op @ (BinaryOp::And | BinaryOp::Or), sides) => {
                let left = self.value(&sides.0)?.truth()?;
                let decided = (*op == BinaryOp::Or) == left;
                Ok(Value::Bool(if decided { left } else { self.value(&sides.1)?.truth()? }))
            }
            ExprKind::Binary(op, sides) => {
                let (left, right) = (self.value(&sides.0)?, self.value(&sides.1)?);
                binary(*op, left, right)
            }
            ExprKind::Assign(..) | ExprKind::Step(..) => Err("only the whole input can be an assignment".into()),
            ExprKind::Brace(_) => self.assigned(expr),
            ExprKind::Splice(_) | ExprKind::Error => Err("this is no expression".into()),
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
                        return Err("arguments stand in their order here, without labels and units".into());
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
    fn place(&mut self, expr: &Expr) -> Result<Place> {
        let named = |name: &str| Root::Variable(None, name.to_owned());
        match &expr.kind {
            ExprKind::Name(symbol) => Ok(Place { root: named(self.names.name(*symbol)), path: Vec::new() }),
            ExprKind::System(symbol) => {
                let name = self.names.name(*symbol);
                let whole = || Place { root: Root::System(name.to_owned()), path: Vec::new() };
                Ok(system_element(name).map_or_else(whole, |(variable, number)| Place {
                    root: Root::System(variable.name.to_owned()),
                    path: vec![Part::At(number as usize)],
                }))
            }
            ExprKind::Path { scope, name, .. } => {
                let (scope, name) = (self.names.name(scope.symbol).to_owned(), self.names.name(name.symbol).to_owned());
                Ok(Place { root: Root::Variable(Some(scope), name), path: Vec::new() })
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
            _ => Err("this names no variable".into()),
        }
    }

    /// The type and value of what is named.
    fn found(&mut self, place: &Place) -> Result<(String, Literal)> {
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
            let (base, sizes) = ty.split_once('[').ok_or_else(|| format!("{ty} is no array"))?;
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
    if let Some(bits) = name.strip_suffix('h').and_then(|digits| u32::from_str_radix(digits, 16).ok()) {
        return Some(Value::Int(bits as i32));
    }
    enum_constant(name).map(|(id, at)| {
        let constant = id.def().constants.get(usize::from(at)).map_or(name, |constant| constant.name);
        Value::Other(id.def().name.to_owned(), Literal::Plain(constant.to_owned()))
    })
}

fn unary(op: UnaryOp, value: Value) -> Result<Value> {
    match (op, value) {
        (UnaryOp::Not, value) => Ok(Value::Bool(!value.truth()?)),
        (UnaryOp::Negate, Value::Int(value)) => Ok(Value::Int(value.wrapping_neg())),
        (UnaryOp::Negate, Value::Uint(0x8000_0000)) => Ok(Value::Int(i32::MIN)),
        (UnaryOp::Negate, Value::Double(value)) => Ok(Value::Double(-value)),
        (UnaryOp::Negate, Value::Byte(value)) => Ok(Value::Int(-i32::from(value))),
        (UnaryOp::Complement, Value::Int(value)) => Ok(Value::Int(!value)),
        (UnaryOp::Complement, Value::Uint(value)) => Ok(Value::Uint(!value)),
        (UnaryOp::Complement, Value::Byte(value)) => Ok(Value::Byte(!value)),
        (_, value) => Err(format!("there is no such operation on {}", value.ty())),
    }
}

fn binary(op: BinaryOp, left: Value, right: Value) -> Result<Value> {
    use BinaryOp::{Add, Equal, NotEqual};
    let wrong =
        |left: &Value, right: &Value| Err(format!("{} {} {} is not possible", left.ty(), op.text(), right.ty()));
    match (&left, &right) {
        (Value::Text(one), Value::Text(other)) => match op {
            Add => Ok(Value::Text(format!("{one}{other}"))),
            Equal => Ok(Value::Bool(one == other)),
            NotEqual => Ok(Value::Bool(one != other)),
            _ => wrong(&left, &right),
        },
        (Value::Bool(one), Value::Bool(other)) => match op {
            Equal => Ok(Value::Bool(one == other)),
            NotEqual => Ok(Value::Bool(one != other)),
            _ => wrong(&left, &right),
        },
        (Value::Other(_, Literal::Plain(one)), Value::Other(_, Literal::Plain(other))) => match op {
            Equal => Ok(Value::Bool(one.eq_ignore_ascii_case(other))),
            NotEqual => Ok(Value::Bool(!one.eq_ignore_ascii_case(other))),
            _ => wrong(&left, &right),
        },
        (Value::Int(one), Value::Int(other)) => {
            whole(op, i64::from(*one), i64::from(*other), |it| Value::Int(it as i32))
        }
        (Value::Uint(one), Value::Uint(other)) => {
            whole(op, i64::from(*one), i64::from(*other), |it| Value::Uint(it as u32))
        }
        (Value::Byte(one), Value::Byte(other)) => {
            whole(op, i64::from(*one), i64::from(*other), |it| Value::Byte(it as u8))
        }
        _ => match (left.number(), right.number()) {
            (Some(one), Some(other)) if is_double(&left) || is_double(&right) => {
                decimal(op, one, other).map_or_else(|| wrong(&left, &right), Ok)
            }
            // Of whole numbers the wider type counts.
            (Some(one), Some(other)) if matches!((&left, &right), (Value::Uint(_), _) | (_, Value::Uint(_))) => {
                whole(op, one as i64, other as i64, |it| Value::Uint(it as u32))
            }
            (Some(one), Some(other)) => whole(op, one as i64, other as i64, |it| Value::Int(it as i32)),
            _ => wrong(&left, &right),
        },
    }
}

fn is_double(value: &Value) -> bool {
    matches!(value, Value::Double(_))
}

fn whole(op: BinaryOp, one: i64, other: i64, made: fn(i64) -> Value) -> Result<Value> {
    let counted = || u32::try_from(other).ok().filter(|count| *count < 32).ok_or(format!("a shift by {other}"));
    Ok(match op {
        BinaryOp::Add => made(one.wrapping_add(other)),
        BinaryOp::Subtract => made(one.wrapping_sub(other)),
        BinaryOp::Multiply => made(one.wrapping_mul(other)),
        BinaryOp::Divide => made(one.checked_div(other).ok_or("division by zero")?),
        BinaryOp::Remainder => made(one.checked_rem(other).ok_or("division by zero")?),
        BinaryOp::ShiftLeft => made(one << counted()?),
        BinaryOp::ShiftRight => made(one >> counted()?),
        BinaryOp::BitAnd => made(one & other),
        BinaryOp::BitOr => made(one | other),
        BinaryOp::BitXor => made(one ^ other),
        _ => Value::Bool(compared(op, one.cmp(&other))),
    })
}

fn decimal(op: BinaryOp, one: f64, other: f64) -> Option<Value> {
    Some(match op {
        BinaryOp::Add => Value::Double(one + other),
        BinaryOp::Subtract => Value::Double(one - other),
        BinaryOp::Multiply => Value::Double(one * other),
        BinaryOp::Divide => Value::Double(one / other),
        BinaryOp::Remainder => Value::Double(one % other),
        op if op.compares() => match one.partial_cmp(&other) {
            Some(order) => Value::Bool(compared(op, order)),
            None => Value::Bool(op == BinaryOp::NotEqual),
        },
        _ => return None,
    })
}

fn compared(op: BinaryOp, order: std::cmp::Ordering) -> bool {
    match op {
        BinaryOp::Less => order.is_lt(),
        BinaryOp::LessEqual => order.is_le(),
        BinaryOp::Greater => order.is_gt(),
        BinaryOp::GreaterEqual => order.is_ge(),
        BinaryOp::Equal => order.is_eq(),
        _ => order.is_ne(),
    }
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
            ("twice(count + 1) + \"!\"", "string \"88!\""),
            ("count += 1", "[] = 8"),
            ("count--", "[] = 6"),
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
            ("count / 0", "division by zero"),
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
