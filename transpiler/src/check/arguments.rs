//! The binder: assigns the arguments of instructions, built-in functions and the user's functions to parameters.
//!
//! Labelled arguments go to the parameter of that name. In a call, bare arguments go to the parameters in order; in an
//! instruction, to the first free parameter of the format line that accepts their type. A Rust value whose type is not
//! given goes to the first free parameter and takes its type.

mod passing;

use super::call::family_name;
use super::context::{CheckedBody, Checker};
use super::convert::Typed;
use super::name::constant;
use crate::diagnostics::arguments::ArgumentProblem;
use crate::diagnostics::listed;
use crate::diagnostics::support::SupportProblem;
use crate::diagnostics::types::TypeProblem;
use crate::hir::{Bound, Expr, FuncId, ModuleId, Passed, Type, Value};
use crate::index;
use arl_lang::ast::{self, Arg, Unit};
use arl_lang::catalog::{self, Base, Effect, Entry, Family, Kind, Mode, Motion, ParamType, Presence, Range, Struct};
use arl_lang::elsewhere;
use arl_lang::span::Span;
use std::collections::HashMap;

/// The callee that receives the arguments.
pub(crate) enum CheckedCallee {
    /// A function of the program.
    User(FuncId),
    /// A built-in.
    Builtin(&'static Entry),
}

/// A parameter of either kind of callee.
#[derive(Clone)]
struct Parameter<'a> {
    name: &'a str,
    aliases: &'static [&'static str],
    /// `None` if the declaration is wrong; that has been reported.
    ty: Option<Wanted>,
    mode: Mode,
    presence: Presence,
    bare: bool,
    units: &'static [Unit],
    range: Option<Range>,
    doubted: bool,
    set: bool,
    keeps: bool,
    /// The only family whose robots have the parameter, if the program is for another one. It then accepts nothing.
    foreign: Option<Family>,
}

#[derive(Clone, Copy)]
enum Wanted {
    User(Type),
    Builtin(ParamType),
}

/// An argument on its way to a parameter.
struct Pair<'e> {
    param: usize,
    arg: &'e Arg,
    /// The argument if it has been checked already, to find its parameter by type.
    typed: Option<Typed>,
}

/// What to write for a target of the other kind: axes where a pose is wanted or vice versa.
fn other_motion(params: &[Parameter<'_>], given: Base) -> Option<String> {
    let wants = |id| {
        let wanted = ParamType::One(Base::Struct(id));
        params.iter().any(|param| matches!(param.ty, Some(Wanted::Builtin(ty)) if ty == wanted))
    };
    let of_kind = |axes: bool| {
        let motion = catalog::all_entries().iter().filter(|entry| entry.effect == Effect::Plans);
        let kind = if axes { Motion::Joint } else { Motion::PointToPoint };
        motion.filter(move |entry| entry.motion == Some(kind)).map(|entry| entry.name).next()
    };
    match given {
        Base::Struct(Struct::Pose) if wants(Struct::Joint) => Some(format!(
            "the target here is a joint, the positions of the axes; to go to a pose, use `{}`",
            of_kind(false)?
        )),
        Base::Struct(Struct::Joint) if wants(Struct::Pose) => Some(format!(
            "the target here is a pose; to go to a joint, the positions of the axes, use `{}`",
            of_kind(true)?
        )),
        _ => None,
    }
}

/// From this number of parameters on, labels are looked up in a table.
const MANY_PARAMETERS: usize = 32;

/// The positions of parameters by their folded names; `None` if there are too few to need a table.
struct Labels(Option<HashMap<String, usize>>);

impl Labels {
    fn of(params: &[Parameter<'_>]) -> Self {
        Self((params.len() >= MANY_PARAMETERS).then(|| {
            let mut places = HashMap::with_capacity(params.len());
            for (at, param) in params.iter().enumerate() {
                for name in param.aliases.iter().copied().chain([param.name]) {
                    places.entry(name.to_ascii_lowercase()).or_insert(at);
                }
            }
            places
        }))
    }

    fn find(&self, params: &[Parameter<'_>], wanted: &str) -> Option<usize> {
        let is_it = |name: &&str| name.eq_ignore_ascii_case(wanted);
        match &self.0 {
            Some(places) => places.get(&wanted.to_ascii_lowercase()).copied(),
            None => params.iter().position(|param| is_it(&param.name) || param.aliases.iter().any(is_it)),
        }
    }
}

impl<'a> Checker<'a> {
    /// Binds arguments. Returns `None` if anything is wrong; all errors are reported.
    pub(crate) fn bind(
        &mut self,
        body: &mut CheckedBody,
        callee: &CheckedCallee,
        args: &[Arg],
        span: Span,
    ) -> Option<Vec<Bound>> {
        let name = self.callee_name(callee);
        let params = self.parameters(callee);
        let by_type = matches!(callee, CheckedCallee::Builtin(entry) if entry.kind == Kind::Instruction);
        let pairs = self.pair(body, callee, span, &params, args, by_type);
        // An argument without a parameter has been reported, here or at the declaration of its variable.
        let mut good = pairs.len() == args.len();
        let counts = counts(&params, &pairs);
        for (param, count) in params.iter().zip(&counts) {
            let least = match param.presence {
                Presence::Required => 1,
                Presence::Repeat { min, .. } => usize::from(min),
                Presence::Optional | Presence::Default(_) => 0,
            };
            if *count < least && good {
                self.report_missing(body, callee, param, &params, &pairs, span);
                good = false;
            }
        }
        if let CheckedCallee::Builtin(entry) = callee {
            good &= self.exclusions(body, entry, &pairs, args);
        }
        let mut bound = Vec::new();
        for pair in pairs {
            let Some(param) = params.get(pair.param) else { continue };
            match self.pass(body, name, param, pair.arg, pair.typed) {
                Some(value) => bound.push(Bound { param: pair.param, value }),
                None => good = false,
            }
        }
        for (at, (param, count)) in params.iter().zip(&counts).enumerate() {
            if let (Presence::Default(text), 0, Some(Wanted::Builtin(ParamType::One(base)))) =
                (param.presence, *count, param.ty)
            {
                let value = default_value(text, base, span)?;
                bound.push(Bound { param: at, value: Passed::Value(value) });
            }
        }
        if let CheckedCallee::Builtin(entry) = callee {
            good &= self.check_length(body, entry, &bound).is_some();
        }
        good.then_some(bound)
    }

    /// Reports a missing mandatory argument. Most often the argument is there but has another type than it seems.
    fn report_missing(
        &mut self,
        body: &CheckedBody,
        callee: &CheckedCallee,
        missing: &Parameter<'_>,
        params: &[Parameter<'_>],
        pairs: &[Pair<'_>],
        span: Span,
    ) {
        let wanted = match missing.ty {
            Some(Wanted::Builtin(ParamType::One(base @ Base::Struct(_)))) => Some(base),
            _ => None,
        };
        let strayed = pairs.iter().find_map(|pair| {
            let (typed, param) = (pair.typed.as_ref()?, params.get(pair.param)?);
            let symbol = match pair.arg.value.kind {
                ast::ExprKind::Name(symbol) => Some(symbol),
                _ => None,
            };
            Some((pair.arg.value.span, typed.expr.ty, param.name, symbol))
        });
        let mut labels = Vec::new();
        let mut instead = None;
        if let (Some(wanted), Some((at, ty, taker, symbol))) = (wanted, strayed) {
            let ty = self.type_name(ty);
            labels.push((body.module, at, format!("this has the type {ty} and was taken for `{taker}`")));
            let hidden = symbol.filter(|symbol| body.find(*symbol).is_some()).and_then(|symbol| {
                let (id, _) = self.find_global(body, symbol)?;
                let slot = self.globals.get(id.0 as usize)?;
                (slot.ty? == Type::scalar(wanted)).then_some((slot.module, slot.var.name.span))
            });
            let written = self.text(body.module, at).to_string();
            if let Some((module, declared)) = hidden {
                labels.push((module, declared, format!("the `{}` of this name", wanted.name())));
                instead =
                    Some(format!("a local variable hides the `{}` `{written}`: rename one of them", wanted.name()));
            } else {
                instead = Some(format!("`{}` is a `{}`", missing.name, wanted.name()));
            }
        }
        let problem = ArgumentProblem::Missing {
            callee: self.callee_name(callee).into(),
            parameter: missing.name.into(),
            signature: self.callee_signature(callee),
            instead,
        };
        let labels: Vec<(ModuleId, Span, &str)> =
            labels.iter().map(|(module, span, text)| (*module, *span, text.as_str())).collect();
        self.report_in::<()>(body.module, span, problem, &labels);
    }

    fn callee_name(&self, callee: &CheckedCallee) -> &'a str {
        match callee {
            CheckedCallee::Builtin(entry) => entry.name,
            CheckedCallee::User(func) => self
                .funcs
                .get(func.0 as usize)
                .map(|slot| self.text(slot.module, slot.ast.name.span))
                .unwrap_or_default(),
        }
    }

    fn callee_signature(&self, callee: &CheckedCallee) -> String {
        match callee {
            CheckedCallee::Builtin(entry) => self.signature(entry),
            CheckedCallee::User(func) => {
                let Some(slot) = self.funcs.get(func.0 as usize) else { return String::new() };
                let params = slot.ast.params.iter().map(|param| self.excerpt(slot.module, param.span));
                format!("{}({})", self.text(slot.module, slot.ast.name.span), listed(params))
            }
        }
    }

    fn parameters(&self, callee: &CheckedCallee) -> Vec<Parameter<'a>> {
        match callee {
            CheckedCallee::Builtin(entry) => entry
                .params
                .iter()
                .map(|param| Parameter {
                    name: param.name,
                    aliases: param.aliases,
                    ty: Some(Wanted::Builtin(param.ty)),
                    mode: param.mode,
                    presence: param.presence,
                    bare: param.bare || entry.kind == Kind::Function,
                    units: param.units,
                    range: param.range,
                    doubted: param.doubted,
                    set: param.set,
                    keeps: param.keeps,
                    foreign: param.family.filter(|_| !param.is_of(self.family())),
                })
                .collect(),
            CheckedCallee::User(func) => {
                let Some(slot) = self.funcs.get(func.0 as usize) else { return Vec::new() };
                let types = slot.params.iter();
                types
                    .zip(&slot.ast.params)
                    .map(|(ty, param)| Parameter {
                        name: self.text(slot.module, param.name.span),
                        aliases: &[],
                        ty: ty.map(Wanted::User),
                        mode: Mode::In,
                        presence: Presence::Required,
                        bare: true,
                        units: &[],
                        range: None,
                        doubted: false,
                        set: false,
                        keeps: false,
                        foreign: None,
                    })
                    .collect()
            }
        }
    }

    /// Finds the parameter of each argument.
    fn pair<'e>(
        &mut self,
        body: &mut CheckedBody,
        callee: &CheckedCallee,
        span: Span,
        params: &[Parameter<'_>],
        args: &'e [Arg],
        by_type: bool,
    ) -> Vec<Pair<'e>> {
        let name = self.callee_name(callee);
        let mut taken = vec![0usize; params.len()];
        let labels = Labels::of(params);
        let mut slots: Vec<Option<usize>> = Vec::with_capacity(args.len());
        for arg in args {
            let param = arg.label.and_then(|label| self.labelled(body, callee, params, &labels, label, &taken));
            if let Some(count) = param.and_then(|param| taken.get_mut(param)) {
                *count += 1;
            }
            slots.push(param);
        }
        let mut pairs = Vec::new();
        let mut position = 0;
        for (arg, slot) in args.iter().zip(slots) {
            if arg.label.is_some() {
                self.expect_argument(body, callee, span, arg, &taken, slot);
                if let Some(param) = slot {
                    self.mention_argument(body, callee, span, arg, param);
                    pairs.push(Pair { param, arg, typed: None });
                }
                continue;
            }
            if by_type {
                self.expect_argument(body, callee, span, arg, &taken, None);
            }
            let found = if by_type {
                self.by_type(body, name, params, arg, &taken)
            } else {
                self.by_position(body, callee, name, params, arg, &mut position, &taken)
            };
            let Some((param, typed)) = found else {
                if !by_type {
                    self.expect_nothing(body, callee, span, arg, &taken);
                }
                continue;
            };
            if !by_type {
                self.expect_argument(body, callee, span, arg, &taken, Some(param));
            }
            if let Some(count) = taken.get_mut(param) {
                *count += 1;
            }
            self.mention_argument(body, callee, span, arg, param);
            pairs.push(Pair { param, arg, typed });
        }
        pairs
    }

    fn labelled(
        &mut self,
        body: &CheckedBody,
        callee: &CheckedCallee,
        params: &[Parameter<'_>],
        places: &Labels,
        label: ast::Ident,
        taken: &[usize],
    ) -> Option<usize> {
        let wanted = self.names.name(label.symbol);
        let Some(at) = places.find(params, wanted) else {
            self.expect(body, label.symbol, label.span, index::Wanted::ArgumentLabel);
            let callee = self.callee_name(callee);
            let names = || params.iter().filter(|param| param.foreign.is_none()).map(|param| param.name);
            let meant = elsewhere::labels(wanted).iter().filter(|ours| names().any(|name| name == **ours));
            let meant: Vec<String> = meant.map(|ours| format!("`{ours}`")).collect();
            let problem = ArgumentProblem::UnknownLabel {
                callee: callee.into(),
                meant: meant.join(" or "),
                label: self.text(body.module, label.span).into(),
                near: self.hints.nearest(wanted, params.len(), names).map(Into::into),
                labels: listed(names().collect::<Vec<_>>().into_iter()),
            };
            return self.report(body, label.span, problem);
        };
        let param = params.get(at)?;
        if let Some(family) = param.foreign {
            let (callee, parameter) = (self.callee_name(callee).into(), param.name.into());
            let problem = SupportProblem::ParameterOfOtherFamily { callee, parameter, family: family_name(family) };
            return self.report(body, label.span, problem);
        }
        self.strict_case(body, label.span, param.name);
        if let Some(meaning) = self.parameter_meaning(callee, at) {
            self.mention(body, label.span, meaning);
        }
        if taken.get(at).is_some_and(|count| *count >= most(param)) {
            return self.report(body, label.span, ArgumentProblem::Twice { parameter: param.name.into() });
        }
        Some(at)
    }

    #[expect(clippy::too_many_arguments, reason = "the state of one walk over the arguments")]
    fn by_position(
        &mut self,
        body: &CheckedBody,
        callee: &CheckedCallee,
        name: &str,
        params: &[Parameter<'_>],
        arg: &Arg,
        position: &mut usize,
        taken: &[usize],
    ) -> Option<(usize, Option<Typed>)> {
        while let Some(param) = params.get(*position) {
            let at = *position;
            if taken.get(at).is_some_and(|count| *count < most(param)) {
                if !matches!(param.presence, Presence::Repeat { .. }) {
                    *position += 1;
                }
                return Some((at, None));
            }
            *position += 1;
        }
        let problem = ArgumentProblem::TooMany { callee: name.into(), most: params.len() };
        let _ = callee;
        self.report(body, arg.value.span, problem)
    }

    fn by_type(
        &mut self,
        body: &mut CheckedBody,
        callee: &str,
        params: &[Parameter<'_>],
        arg: &Arg,
        taken: &[usize],
    ) -> Option<(usize, Option<Typed>)> {
        let free = |at: usize, param: &Parameter<'_>| {
            param.foreign.is_none() && taken.get(at).is_some_and(|count| *count < most(param))
        };
        if let ast::ExprKind::Brace(_) = arg.value.kind {
            let takes_braces = |(at, param): &(usize, &Parameter<'_>)| {
                free(*at, param) && matches!(param.ty, Some(Wanted::Builtin(ParamType::One(Base::Struct(_)))))
            };
            let open = params.iter().enumerate().filter(takes_braces);
            let labels: Vec<String> = open.map(|(_, param)| format!("`{}:{{...}}`", param.name)).collect();
            if labels.is_empty() {
                return self.report(body, arg.value.span, TypeProblem::BraceWithoutType);
            }
            let problem = ArgumentProblem::BareBrace { callee: callee.into(), labels: labels.join(" or ") };
            return self.report(body, arg.value.span, problem);
        }
        if self.is_untyped_splice(&arg.value) {
            let open: Vec<_> = params.iter().enumerate().filter(|(at, param)| param.bare && free(*at, param)).collect();
            let any = open.iter().any(|(_, param)| matches!(param.ty, Some(Wanted::Builtin(ParamType::Any))));
            if let (Some((at, _)), false) = (open.first(), any) {
                return Some((*at, None));
            }
        }
        if let Some(problem) = self.assigned_label(body, params, &arg.value) {
            return self.report(body, arg.value.span, problem);
        }
        let typed = self.expr(body, &arg.value, self.hint_of_name(params, taken, &arg.value))?;
        let is_void = typed.expr.ty.base == Base::Void;
        let takes = |param: &Parameter<'_>| match &param.ty {
            _ if param.mode == Mode::Action => does_something(&arg.value),
            Some(Wanted::Builtin(ty)) => !is_void && self.param_cost(ty, param.mode, &typed).is_some(),
            _ => false,
        };
        let found = params.iter().enumerate().position(|(at, param)| param.bare && free(at, param) && takes(param));
        if let Some(at) = found {
            return Some((at, Some(typed)));
        }
        if is_void {
            return self.report_no_value(body, &typed.expr);
        }
        let takes_any = |param: &Parameter<'_>| matches!(param.ty, Some(Wanted::Builtin(ParamType::Any)));
        if matches!(typed.expr.ty.base, Base::Handle(_)) && params.iter().any(takes_any) {
            return self.report_no_text(body, &typed.expr);
        }
        let ty = self.type_name(typed.expr.ty);
        if params.is_empty() {
            return self.report(body, arg.value.span, ArgumentProblem::TooMany { callee: callee.into(), most: 0 });
        }
        let labels: Vec<&str> =
            params.iter().enumerate().filter(|(at, param)| free(*at, param)).map(|(_, param)| param.name).collect();
        let other = other_motion(params, typed.expr.ty.base);
        let labels = listed(labels.into_iter());
        let problem = ArgumentProblem::NoParameter { callee: callee.into(), ty, labels, other };
        self.report(body, arg.value.span, problem)
    }

    /// For a name: the structure that is wanted first, in case the name is unknown.
    fn hint_of_name(&self, params: &[Parameter<'_>], taken: &[usize], value: &ast::Expr) -> Option<Type> {
        if !matches!(value.kind, ast::ExprKind::Name(_)) {
            return None;
        }
        let first =
            params.iter().zip(taken).find(|(param, count)| param.presence == Presence::Required && **count == 0);
        match first?.0.ty {
            Some(Wanted::Builtin(ParamType::One(base @ Base::Struct(_)))) => Some(Type::scalar(base)),
            _ => None,
        }
    }

    fn exclusions(&mut self, body: &CheckedBody, entry: &'static Entry, pairs: &[Pair<'_>], args: &[Arg]) -> bool {
        let given =
            |name: &str| pairs.iter().find(|pair| entry.params.get(pair.param).is_some_and(|param| param.name == name));
        let mut good = true;
        for group in entry.exclusive {
            let mut present = group.iter().filter_map(|name| Some((*name, given(name)?.arg.span())));
            let (Some(first), Some(second)) = (present.next(), present.next()) else { continue };
            let later = if first.1.start > second.1.start { first.1 } else { second.1 };
            let problem = ArgumentProblem::Exclusive { first: first.0.into(), second: second.0.into() };
            self.report::<()>(body, later, problem);
            good = false;
        }
        let _ = args;
        good
    }
}

/// The maximum number of arguments of a parameter; the greatest number in the catalog means no limit.
fn most(param: &Parameter) -> usize {
    match param.presence {
        Presence::Repeat { max: u8::MAX, .. } => usize::MAX,
        Presence::Repeat { max, .. } => usize::from(max),
        _ => 1,
    }
}

fn counts(params: &[Parameter<'_>], pairs: &[Pair<'_>]) -> Vec<usize> {
    let mut counts = vec![0; params.len()];
    for pair in pairs {
        if let Some(count) = counts.get_mut(pair.param) {
            *count += 1;
        }
    }
    counts
}

/// A default from the catalog as a constant.
fn default_value(text: &str, base: Base, span: Span) -> Option<Expr> {
    let value = match base {
        Base::Int => Value::Int(text.parse().ok()?),
        Base::Uint => Value::Uint(text.parse().ok()?),
        Base::Byte => Value::Byte(text.parse().ok()?),
        Base::Double => Value::Double(text.parse().ok()?),
        Base::Bool => Value::Bool(text.parse().ok()?),
        Base::String => Value::String(text.trim_matches('"').into()),
        Base::Enum(id) => {
            let index = id.def().constants.iter().position(|constant| constant.name.eq_ignore_ascii_case(text))?;
            Value::Enum(id, index as u16)
        }
        Base::Void | Base::Struct(_) | Base::Handle(_) => return None,
    };
    Some(constant(value, span).expr)
}

/// Whether an expression may be used as a statement for its effect.
pub(super) fn does_something(expr: &ast::Expr) -> bool {
    use ast::ExprKind::{Assign, Call, Error, Step};
    matches!(expr.kind, Assign(..) | Step(..) | Call(_) | Error)
}
