//! Which values fit where: constants by their value, everything else by Table 2-1 and its extensions.

use super::context::{CheckedBody, Checker};
use super::name::constants;
use crate::diagnostics::constants::ConstantProblem;
use crate::diagnostics::types::TypeProblem;
use crate::hir::{Expr, ExprKind, Type, Value};
use crate::operators::{Conversion, Literal, Operand, conversion, fit, integer, range};
use arl_lang::catalog::{Base, Struct};
use std::fmt::Display;

/// An expression, together with how it was written if it is an integer constant.
pub(crate) struct Typed {
    pub(crate) expr: Expr,
    pub(crate) literal: Literal,
}

impl Typed {
    pub(crate) fn plain(expr: Expr) -> Self {
        Typed { expr, literal: Literal::None }
    }

    /// The value, if the expression is constant.
    pub(crate) fn value(&self) -> Option<&Value> {
        match &self.expr.kind {
            ExprKind::Const(value) => Some(value),
            _ => None,
        }
    }

    /// The expression as an operand of an operator.
    pub(crate) fn operand(&self) -> Operand<'_> {
        Operand { base: self.expr.ty.base, constant: self.value(), literal: self.literal }
    }
}

/// The value of a constant number of any type.
pub(crate) fn number(value: &Expr) -> Option<f64> {
    match &value.kind {
        ExprKind::Const(Value::Double(value)) => Some(*value),
        ExprKind::Const(Value::Int(value)) => Some(f64::from(*value)),
        ExprKind::Const(Value::Uint(value)) => Some(f64::from(*value)),
        ExprKind::Const(Value::Byte(value)) => Some(f64::from(*value)),
        ExprKind::Convert(inner) => number(inner),
        _ => None,
    }
}

/// What to write instead of a string where a number is wanted.
fn unquoted(expr: &Expr, to: Base) -> Option<String> {
    let ExprKind::Const(Value::String(text)) = &expr.kind else { return None };
    let is_number = matches!(to, Base::Int | Base::Uint | Base::Byte | Base::Double);
    let number = text.trim().parse::<f64>().is_ok().then(|| text.trim());
    let reads = if to == Base::Int { "; `toint(text, dec)` reads one from a text" } else { "" };
    is_number.then(|| format!("a number is written without quotes: `{}`{reads}", number.unwrap_or("250")))
}

/// What to use where no implicit conversion exists: a function or another construct.
pub(crate) fn instead(from: Base, to: Base) -> Option<String> {
    let words = match (from, to) {
        (Base::Double, Base::Int | Base::Uint | Base::Byte) => {
            "`toint(...)` cuts off the fraction; `toint(trunc(..., 0, true))` rounds"
        }
        (Base::String, Base::Int) => "`toint(text, dec)` reads a number from a text",
        (Base::String, Base::Double) => "`scan` reads numbers from a text",
        (Base::Void | Base::Handle(_), _) => return None,
        (_, Base::Enum(id)) => return Some(format!("its constants are {}", constants(id))),
        (Base::Bool, Base::Int | Base::Uint | Base::Byte | Base::Double) => {
            "a bool is not a number: choose one with `if`"
        }
        (_, Base::String) => "`tostr(...)` makes a text of any value",
        (Base::Int, Base::Byte) => "only constants of 0 to 255 fit a byte; `tobytes(...)` takes an int apart",
        (Base::Int, Base::Uint) => "only constants of 0 or more fit a uint",
        (Base::Uint, Base::Int) => "a uint may be too large for an int: keep it in a uint or a double",
        (Base::Struct(Struct::Tool | Struct::Wobj), Base::Struct(Struct::Tool | Struct::Wobj)) => {
            "`t:` takes the tool (a `tool`), `w:` the workpiece frame (a `wobj`): are the two swapped?"
        }
        (Base::Struct(Struct::Pose | Struct::Joint), Base::Struct(Struct::Pose | Struct::Joint)) => {
            "`getpose` and `getjoint` convert between joints and poses"
        }
        _ => return None,
    };
    Some(words.into())
}

impl Checker<'_> {
    /// The expression as a value of type `to`. `what` names the place that needs it: "the condition", "`vp`".
    pub(crate) fn coerce(&mut self, body: &CheckedBody, typed: Typed, to: Type, what: impl Display) -> Option<Expr> {
        self.coerced(body, typed, to, &what)
    }

    fn coerced(&mut self, body: &CheckedBody, typed: Typed, to: Type, what: &dyn Display) -> Option<Expr> {
        let Typed { expr, literal } = typed;
        let from = expr.ty;
        if literal == Literal::Wide && to != Type::scalar(Base::Uint) {
            let text = self.text(body.module, expr.span).to_string();
            return self.report(body, expr.span, TypeProblem::WideLiteral { text });
        }
        if from == to {
            if let Base::Handle(_) = to.base {
                let ty = self.type_name(to);
                return self.report(body, expr.span, TypeProblem::HandleCopy { ty });
            }
            return Some(expr);
        }
        if from.base == Base::Void {
            return self.report_no_value(body, &expr);
        }
        if from.is_array() || to.is_array() {
            let (found, wanted) = (self.type_name(from), self.type_name(to));
            return self.report(body, expr.span, TypeProblem::Dimensions { found, wanted });
        }
        if let ExprKind::Const(value) = &expr.kind {
            if let Some(value) = fit(value, literal, to.base) {
                self.warn_extended(body, &expr, to);
                return Some(Expr { ty: to, kind: ExprKind::Const(value), span: expr.span });
            }
            if integer(value).is_some() && matches!(to.base, Base::Int | Base::Uint | Base::Byte) {
                let value = self.excerpt(body.module, expr.span);
                let problem =
                    TypeProblem::DoesNotFit { value, wanted: self.type_name(to), range: range(to.base).into() };
                return self.report(body, expr.span, problem);
            }
        }
        match conversion(from.base, to.base) {
            Some(_) => {
                self.warn_extended(body, &expr, to);
                let span = expr.span;
                Some(Expr { ty: to, kind: ExprKind::Convert(Box::new(expr)), span })
            }
            None => {
                let problem = TypeProblem::Mismatch {
                    found: self.type_name(from),
                    wanted: self.type_name(to),
                    what: what.to_string(),
                    use_instead: (self.without_quotes(body, &expr, to))
                        .or_else(|| unquoted(&expr, to.base))
                        .or_else(|| instead(from.base, to.base)),
                };
                self.report(body, expr.span, problem)
            }
        }
    }

    /// What to write instead of a string that is the name of a signal or of a variable of the wanted type.
    fn without_quotes(&mut self, body: &CheckedBody, expr: &Expr, to: Type) -> Option<String> {
        let ExprKind::Const(Value::String(text)) = &expr.kind else { return None };
        let symbol = self.names.find(&text.to_ascii_lowercase());
        let local = symbol.and_then(|symbol| body.find(symbol)).and_then(|local| body.local_type(local));
        let global = symbol.and_then(|symbol| self.find_global(body, symbol));
        let found = local.or_else(|| self.global_type(global?.0));
        if found.is_some_and(|found| !found.is_array() && conversion(found.base, to.base).is_some()) {
            return Some(format!("a name is written without quotes: `{text}`"));
        }
        let (signal, channel) = self.signal_named(text)?;
        Some(format!("that is the cell's name for {signal}; a program uses its number: `{channel}`"))
    }

    fn warn_extended(&mut self, body: &CheckedBody, expr: &Expr, to: Type) {
        let constant = matches!(&expr.kind, ExprKind::Const(value) if integer(value).is_some());
        let extended = match (expr.ty.base, to.base) {
            (_, Base::Enum(_)) => true,
            (from, to) => !constant && conversion(from, to) == Some(Conversion::Extended),
        };
        if extended && self.options.strict {
            let (from, to) = (self.type_name(expr.ty), self.type_name(to));
            self.report::<()>(body, expr.span, ConstantProblem::ExtendedConversion { from, to });
        }
    }

    /// Reports an expression without a value where a value is wanted.
    pub(crate) fn report_no_value<T>(&mut self, body: &CheckedBody, expr: &Expr) -> Option<T> {
        let what = format!("`{}`", self.excerpt(body.module, expr.span));
        self.report(body, expr.span, TypeProblem::NoValue { what })
    }

    /// How well a value converts to a type, without reporting anything. A lower number is a better fit; `None` if the
    /// value does not convert.
    pub(crate) fn cost(&self, typed: &Typed, to: Type) -> Option<u32> {
        let from = typed.expr.ty;
        if from == to {
            return Some(0);
        }
        if from.is_array() || to.is_array() {
            return None;
        }
        let to = to.base;
        if let Some(value) = typed.value() {
            let fits = fit(value, typed.literal, to).is_some() && !matches!(to, Base::Enum(_));
            if fits && integer(value).is_some() {
                return Some(if matches!(to, Base::Double | Base::Bool) { 3 } else { 2 });
            }
        }
        let distance = match to {
            Base::Int | Base::Uint => 2,
            Base::Double => 3,
            _ => 4,
        };
        conversion(from.base, to).map(|_| distance)
    }
}
