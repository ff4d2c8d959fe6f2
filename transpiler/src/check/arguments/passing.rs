//! One argument: its value, converted to the type of its parameter, in its unit and within its range.

use super::{Parameter, Wanted};
use crate::check::context::{CheckedBody, Checker};
use crate::check::convert::{Typed, number};
use crate::diagnostics::arguments::ArgumentProblem;
use crate::diagnostics::types::TypeProblem;
use crate::hir::{Bound, Expr, ExprKind, Passed, Type, Value};
use crate::operators::integer;
use arl_lang::ast::{self, Arg};
use arl_lang::catalog::{self, Access, Base, Entry, Mode, ParamType, Restore, SystemVariable, UNSET};
use std::fmt;

impl Checker<'_> {
    /// Checks one argument against its parameter.
    pub(super) fn pass(
        &mut self,
        body: &mut CheckedBody,
        callee: &str,
        param: &Parameter<'_>,
        arg: &Arg,
        typed: Option<Typed>,
    ) -> Option<Passed> {
        let unit = self.check_unit(body, param, arg);
        let what = format_args!("`{}` of `{callee}`", param.name);
        if param.mode == Mode::Condition {
            self.has_conditions = true;
            self.doubt_condition(body, &arg.value);
        }
        if param.mode == Mode::Out {
            return self.pass_out(body, callee, param, arg);
        }
        let want = match param.ty {
            Some(Wanted::User(ty)) => Some(ty),
            Some(Wanted::Builtin(ParamType::One(base))) => Some(Type::scalar(base)),
            _ => None,
        };
        // A parameter that accepts one type without conversion still determines what a name can mean.
        let hint = match param.ty {
            Some(Wanted::Builtin(ParamType::AnyOf([only]))) => Some(Type::scalar(*only)),
            _ => want,
        };
        if param.mode == Mode::Action {
            return self.action(body, &arg.value, typed).map(Passed::Value);
        }
        let typed = match typed {
            Some(typed) => typed,
            None => self.expr(body, &arg.value, hint)?,
        };
        let value = match (param.ty?, want) {
            (Wanted::Builtin(ParamType::One(Base::Handle(_))), Some(want)) if typed.expr.ty == want => typed.expr,
            (_, Some(want)) => self.coerce(body, typed, want, what)?,
            (Wanted::Builtin(ty), None) => self.unconverted(body, what, &ty, param.mode, typed)?,
            (Wanted::User(_), None) => return None,
        };
        self.check_range(body, param, &value)?;
        self.check_kept(body, param, &value)?;
        if param.doubted && arg.unit.is_none() {
            self.doubt_scale(body, param.name, param.units, &value);
        }
        unit?;
        Some(Passed::Value(value))
    }

    /// A value for a parameter that takes several types as they are.
    fn unconverted(
        &mut self,
        body: &CheckedBody,
        what: fmt::Arguments<'_>,
        ty: &ParamType,
        mode: Mode,
        typed: Typed,
    ) -> Option<Expr> {
        self.refuse_wide(body, &typed)?;
        if typed.expr.ty.base == Base::Void {
            return self.report_no_value(body, &typed.expr);
        }
        if self.param_cost(ty, mode, &typed).is_some() {
            return Some(typed.expr);
        }
        let wanted = match ty {
            ParamType::Any => return self.report_no_text(body, &typed.expr),
            ParamType::Array(base) => format!("{}[]", self.base_name(*base)),
            ParamType::AnyOf(bases) => bases.iter().map(|base| self.base_name(*base)).collect::<Vec<_>>().join(" or "),
            ParamType::One(base) => self.base_name(*base).into(),
        };
        let found = self.type_name(typed.expr.ty);
        let problem = TypeProblem::Mismatch { found, wanted, what: what.to_string(), use_instead: None };
        self.report(body, typed.expr.span, problem)
    }

    /// What is wrong with a value that assigns to a label as if it were a variable, if there is no variable of this
    /// name.
    pub(super) fn assigned_label(
        &self,
        body: &CheckedBody,
        params: &[Parameter<'_>],
        value: &ast::Expr,
    ) -> Option<ArgumentProblem> {
        let ast::ExprKind::Assign(None, sides) = &value.kind else { return None };
        let ast::ExprKind::Name(symbol) = sides.0.kind else { return None };
        let name = self.names.name(symbol);
        let label = params.iter().find(|param| param.name.eq_ignore_ascii_case(name))?;
        let is_variable = body.find(symbol).is_some() || self.find_global(body, symbol).is_some();
        let (label, value) = (label.name.to_owned(), self.text(body.module, sides.1.span).to_owned());
        (!is_variable).then_some(ArgumentProblem::EqualsBehindLabel { label, value })
    }

    /// Reports a handle where any value may stand.
    pub(super) fn report_no_text<T>(&mut self, body: &CheckedBody, expr: &Expr) -> Option<T> {
        let what = format!("a {}", self.type_name(expr.ty));
        self.report(body, expr.span, TypeProblem::NoValue { what })
    }

    fn pass_out(&mut self, body: &mut CheckedBody, callee: &str, param: &Parameter<'_>, arg: &Arg) -> Option<Passed> {
        let is_place = matches!(
            arg.value.kind,
            ast::ExprKind::Name(_)
                | ast::ExprKind::Path { .. }
                | ast::ExprKind::System(_)
                | ast::ExprKind::Index(_)
                | ast::ExprKind::Field(..)
        );
        if !is_place {
            let problem = ArgumentProblem::NotAVariable { callee: callee.into(), parameter: param.name.into() };
            return self.report(body, arg.value.span, problem);
        }
        let place = self.written_place(body, &arg.value, true)?;
        let Some(Wanted::Builtin(ty)) = param.ty else { return None };
        let fits = match ty {
            ParamType::One(base) => place.ty == Type::scalar(base),
            ParamType::Array(base) => place.ty.dims().len() == 1 && place.ty.base == base,
            ParamType::AnyOf(bases) => !place.ty.is_array() && bases.contains(&place.ty.base),
            ParamType::Any => true,
        };
        if fits {
            return Some(Passed::Out(place));
        }
        let wanted = match ty {
            ParamType::One(base) => self.base_name(base).to_string(),
            ParamType::Array(base) => format!("{}[]", self.base_name(base)),
            ParamType::AnyOf(bases) => bases.iter().map(|base| self.base_name(*base)).collect::<Vec<_>>().join(" or "),
            ParamType::Any => "any".into(),
        };
        let found = self.type_name(place.ty);
        let what = format!("`{}` of `{callee}`", param.name);
        let problem = TypeProblem::Mismatch { found, wanted, what, use_instead: None };
        self.report(body, arg.value.span, problem)
    }

    fn check_unit(&mut self, body: &CheckedBody, param: &Parameter<'_>, arg: &Arg) -> Option<()> {
        let Some((unit, span)) = arg.unit else { return Some(()) };
        let number = match &arg.value.kind {
            ast::ExprKind::Unary(ast::UnaryOp::Negate, operand) => &operand.kind,
            kind => kind,
        };
        if !matches!(number, ast::ExprKind::Int(..) | ast::ExprKind::Double(_)) {
            return self.report(body, span, ArgumentProblem::UnitOfNoNumber);
        }
        if param.units.contains(&unit) {
            return Some(());
        }
        let units: Vec<&str> = param.units.iter().map(|unit| unit.text()).collect();
        let problem =
            ArgumentProblem::WrongUnit { parameter: param.name.into(), unit: unit.text(), units: units.join(" or ") };
        self.report(body, span, problem)
    }

    /// Whether the given array is long enough for a constant length.
    pub(super) fn check_length(&mut self, body: &CheckedBody, entry: &Entry, bound: &[Bound]) -> Option<()> {
        let mut pairs = bound.iter().filter_map(|bound| Some((bound, entry.params.get(bound.param)?)));
        let counting = pairs.find_map(|(bound, param)| Some((&bound.value, param.name, param.counts?)));
        let Some((Passed::Value(length), parameter, bits)) = counting else { return Some(()) };
        let ExprKind::Const(constant) = &length.kind else { return Some(()) };
        let mut types = bound.iter().map(|bound| match &bound.value {
            Passed::Value(value) => value.ty,
            Passed::Out(place) => place.ty,
        });
        let (Some(value), Some(array)) = (integer(constant), types.find(Type::is_array)) else {
            return Some(());
        };
        let most = (array.len() * 8) as i64 / i64::from(bits);
        if (0..=most).contains(&value) {
            return Some(());
        }
        let problem = ArgumentProblem::Length { parameter: parameter.into(), value, bytes: array.len(), most };
        self.report(body, length.span, problem)
    }

    /// Whether a constant name is the name of a system variable that can be saved.
    fn check_kept(&mut self, body: &CheckedBody, param: &Parameter<'_>, value: &Expr) -> Option<()> {
        let ExprKind::Const(Value::String(text)) = &value.kind else { return Some(()) };
        let is_kept = |variable: &SystemVariable| match variable.restore {
            Restore::Saved => true,
            Restore::Permanent => variable.access == Access::ReadWrite,
            Restore::Reset | Restore::Startup => false,
        };
        let name = text.strip_prefix('$').unwrap_or(text);
        if !param.keeps || catalog::system_variable(name).is_some_and(is_kept) {
            return Some(());
        }
        let kept = catalog::system_variables().filter(|variable| is_kept(variable)).map(|variable| variable.name);
        let near = crate::near::nearest(name, kept).map(Into::into);
        self.report(body, value.span, ArgumentProblem::NotKept { name: name.into(), near })
    }

    fn check_range(&mut self, body: &CheckedBody, param: &Parameter<'_>, value: &Expr) -> Option<()> {
        let Some(number) = number(value) else { return Some(()) };
        let parameter = String::from(param.name);
        if param.set && number == UNSET {
            return self.report(body, value.span, ArgumentProblem::NotSet { parameter });
        }
        match param.range.filter(|range| !range.holds(number)) {
            None => Some(()),
            Some(range) => {
                let problem = ArgumentProblem::Range { parameter, value: self.excerpt(body.module, value.span), range };
                self.report(body, value.span, problem)
            }
        }
    }
}
