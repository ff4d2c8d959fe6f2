//! Calls of the program's functions and of built-ins.

use super::body::Body;
use super::fragment::{Fragment, Precedence};
use super::names::{field, ident};
use super::sequence::{Mode, OrderedOperand};
use super::types::{differs, is_copy, type_name};
use super::written_back::Back;
use crate::effects::facts::Facts;
use crate::effects::pointer;
use crate::hir::{Bound, Builtin, Expr, FuncId, Passed, Root, Type};
use arl_lang::catalog::{Base, Effect, Entry, Kind, Mode as ParamMode, ParamType, Presence};
use proc_macro2::TokenStream;
use quote::quote;

/// An argument for the runtime.
pub(super) struct EmittedArgument<'p> {
    pub(super) param: usize,
    pub(super) value: Fragment,
    /// A place that must be written after the call.
    pub(super) back: Option<Back<'p>>,
}

impl<'p> Body<'p, '_> {
    /// A call of one of the program's functions.
    pub(super) fn call(&mut self, id: FuncId, args: &'p [Expr]) -> Fragment {
        let operands: Vec<_> = args.iter().map(|arg| OrderedOperand::Expr(arg, Mode::Value)).collect();
        let (before, args) = self.sequence(&operands, |_| false);
        let args = args.iter().map(|arg| &arg.tokens);
        let Some(func) = self.program().funcs.get(id.0 as usize) else {
            return Fragment::postfix(quote!(compile_error!("a call of an unknown function")));
        };
        let name = self.unit.names.func(id.0);
        let path = if func.module == self.module {
            quote!(#name)
        } else {
            let module = self.unit.names.module(func.module);
            quote!(super::#module::#name)
        };
        let effects = func.effects;
        let cx = effects.context.then(|| quote!(cx,));
        let g = effects.globals.then(|| quote!(g,));
        let mut call = quote!(#path(#cx #g #(#args),*));
        if effects.waits {
            let boxed = effects.recursive && self.func.is_some_and(|own| own.effects.recursive);
            let apart = self.unit.apart.get(id.0 as usize) == Some(&true);
            call = match (boxed, apart) {
                (true, _) => quote!(Box::pin(#call).await),
                (false, true) => quote!(part(pin!(#call)).await),
                (false, false) => quote!(#call.await),
            };
        }
        if effects.fails {
            let line = self.line_number();
            call = quote!(#call.called(FILE, #line)?);
        }
        Fragment::postfix(call).after(before)
    }

    /// A use of a built-in.
    pub(super) fn builtin(&mut self, builtin: &'p Builtin) -> Fragment {
        let entry = builtin.entry;
        if let Some(special) = self.special(builtin) {
            return special;
        }
        let acts = entry.effect != Effect::Pure;
        let moved = acts && builtin.args.iter().any(|arg| self.moves_pointer(arg));
        let (mut before, arguments) = self.arguments(builtin, moved);
        if moved {
            before.extend(self.line_statement());
        } else {
            self.position.acts |= acts;
        }
        let in_turn = arguments.iter().filter_map(|argument| argument.back.as_ref()).any(Back::is_in_turn);
        let mut call = match entry.kind {
            Kind::Instruction if in_turn => self.call_in_turn(entry, &arguments, &mut before),
            Kind::Function => self.function_call(entry, &arguments),
            Kind::Instruction => instruction_call(entry, &arguments, quote!(run)),
        };
        if entry.effect.takes_time() {
            call = quote!(#call.await);
        }
        if entry.fails {
            call = self.checked(call);
        }
        if differs(entry.result, self.family()) {
            let name = type_name(entry.result, self.family());
            call = quote!(#name::from(#call));
        }
        let backs: Vec<_> = arguments.into_iter().filter_map(|argument| argument.back).collect();
        if backs.is_empty() || in_turn {
            return Fragment::postfix(call).after(before);
        }
        // Variables visible elsewhere are written after the call, so the call is a statement of its own.
        let result = if entry.result == Base::Void {
            before.extend(quote!(#call;));
            Fragment::settled(quote!(()))
        } else {
            let name = self.fresh("result");
            before.extend(quote!(let #name = #call;));
            Fragment::settled(quote!(#name))
        };
        for back in &backs {
            before.extend(self.write_back(back));
        }
        result.after(before)
    }

    /// Whether evaluating an argument moves the program pointer away from this line.
    pub(super) fn moves_pointer(&self, arg: &'p Bound) -> bool {
        pointer::moves(self.scope(), &self.unit.movers, arg)
    }

    /// The arguments, evaluated in the order of the program; with `ahead`, everything whose order matters is evaluated
    /// in statements of its own.
    pub(super) fn arguments(&mut self, builtin: &'p Builtin, ahead: bool) -> (TokenStream, Vec<EmittedArgument<'p>>) {
        let entry = builtin.entry;
        let mut before = TokenStream::new();
        let mut out = Vec::new();
        // Values come first, as one sequence; of a written variable only the indices are evaluated. Conditions and
        // actions are evaluated later, when the runtime looks at them.
        let later = |arg: &Bound| {
            let mode = entry.params.get(arg.param).map(|param| param.mode);
            matches!(mode, Some(ParamMode::Condition | ParamMode::Action))
        };
        let args = || builtin.args.iter().filter(|arg| !later(arg));
        let operands: Vec<OrderedOperand<'p>> = args().flat_map(|arg| self.argument_operands(entry, arg)).collect();
        let facts: Vec<Facts> = operands.iter().map(|operand| self.operand_facts(operand)).collect();
        let touched = self.touched(builtin);
        // Where arguments change their places, or a variable is read into a temporary before the call, whatever makes a
        // difference goes first.
        let matters = |at: usize| {
            let (own, later) = (facts.get(at), facts.iter().skip(at + 1));
            own.is_some_and(|own| later.into_iter().any(|later| own.disturbed_by(later)))
        };
        let moved = reordered(entry, &builtin.args) && (0..facts.len()).any(matters);
        let apart = ahead || moved || self.writes_by_temporaries(builtin, &touched);
        let is_loud = |at: usize| facts.get(at).is_some_and(|facts| !facts.quiet());
        let (first, fragments) = self.sequence(&operands, |at| apart && is_loud(at));
        before.extend(first);
        let mut fragments = fragments.into_iter();
        let in_turn = self.takes_turns(builtin, &touched);
        for arg in args() {
            let (value, back) = match &arg.value {
                Passed::Value(_) => {
                    let value = fragments.next().unwrap_or_else(|| Fragment::settled(quote!(())));
                    (self.for_the_runtime(entry, arg.param, value), None)
                }
                Passed::Out(place) => {
                    let indices: Vec<Fragment> = fragments.by_ref().take(Self::index_operands(place).len()).collect();
                    let shared = match place.root {
                        Root::Local(id) => touched.contains(&id),
                        _ => true,
                    };
                    let (value, back) = self.out_argument(place, indices, shared, &mut before);
                    (value, back.map(|back| if in_turn { back } else { back.at_once(&mut before) }))
                }
            };
            out.push(EmittedArgument { param: arg.param, value, back });
        }
        (before, out)
    }

    /// The runtime's functions take structures of six-axis robots, its instructions those of either family.
    fn for_the_runtime(&self, entry: &Entry, param: usize, value: Fragment) -> Fragment {
        match entry.params.get(param).map(|param| param.ty) {
            Some(ParamType::One(base)) if entry.kind == Kind::Function && differs(base, self.family()) => {
                value.map(Precedence::Postfix, |value| {
                    let receiver = value.receiver();
                    quote!(#receiver.into())
                })
            }
            _ => value,
        }
    }

    fn argument_operands(&self, entry: &Entry, arg: &'p Bound) -> Vec<OrderedOperand<'p>> {
        match &arg.value {
            Passed::Value(expr) => vec![OrderedOperand::Expr(expr, passing(entry, arg.param, expr.ty))],
            Passed::Out(place) => Self::index_operands(place),
        }
    }

    /// `math::atan2(y, x)`: all parameters in the order of the catalog.
    fn function_call(&self, entry: &Entry, arguments: &[EmittedArgument<'p>]) -> TokenStream {
        let path = path(entry.path);
        let given = |param: usize| {
            arguments
                .iter()
                .filter(move |argument| argument.param == param)
                .map(|argument| argument.value.tokens.clone())
        };
        let mut values: Vec<TokenStream> = Vec::new();
        if entry.effect != Effect::Pure {
            values.push(quote!(cx));
        }
        for (at, param) in entry.params.iter().enumerate() {
            match param.presence {
                Presence::Optional => values.push(match given(at).next() {
                    Some(value) => quote!(Some(#value)),
                    None => quote!(None),
                }),
                Presence::Repeat { .. } => {
                    let all = given(at);
                    values.push(quote!(&[#(#all),*]));
                }
                Presence::Required | Presence::Default(_) => values.extend(given(at)),
            }
        }
        quote!(#path(#(#values),*))
    }
}

/// `motion::movej(target).vp(20.0).run(cx)`
pub(super) fn instruction_call(entry: &Entry, arguments: &[EmittedArgument<'_>], how: TokenStream) -> TokenStream {
    let path = path(entry.path);
    let is_required = |param: usize| entry.params.get(param).is_some_and(|param| param.presence == Presence::Required);
    let mut required: Vec<&EmittedArgument<'_>> =
        arguments.iter().filter(|argument| is_required(argument.param)).collect();
    required.sort_by_key(|argument| argument.param);
    let required = required.iter().map(|argument| &argument.value.tokens);
    let rest = arguments.iter().filter(|argument| !is_required(argument.param)).map(|argument| {
        let label = field(entry.params.get(argument.param).map_or("unknown", |param| param.rust));
        let value = &argument.value.tokens;
        quote!(.#label(#value))
    });
    let cx = (entry.effect != Effect::Pure).then(|| quote!(cx));
    quote!(#path(#(#required),*)#(#rest)*.#how(#cx))
}

/// Whether the arguments are passed in another order than in the program.
fn reordered(entry: &Entry, args: &[Bound]) -> bool {
    let key = |bound: &Bound| match (entry.kind, entry.params.get(bound.param).map(|param| param.presence)) {
        (Kind::Function, _) | (_, Some(Presence::Required)) => bound.param,
        _ => entry.params.len(),
    };
    !args.is_sorted_by_key(key)
}

/// How the runtime takes a parameter.
fn passing(entry: &Entry, param: usize, ty: Type) -> Mode {
    let Some(param) = entry.params.get(param) else { return Mode::Value };
    match param.ty {
        _ if param.mode != ParamMode::In => Mode::Value,
        ParamType::Any => Mode::Printed,
        _ if is_copy(ty) => Mode::Value,
        _ => Mode::Reference,
    }
}

/// `math::sqrt`
pub(super) fn path(text: &str) -> TokenStream {
    let mut parts = text.split("::").map(ident);
    let first = parts.next();
    quote!(#first #(::#parts)*)
}
