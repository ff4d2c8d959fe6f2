//! Functions that expressions may call while the program is halted: they change nothing and do not wait.

use crate::builtins::{bits, convert, math, pose, strings};
use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::values::text::Print;
use crate::values::{Joint, Literal, NumBase, Pos, Pose, Str, Tool, Wobj};
use arl_lang::catalog;
use arl_lang::symbol::Interner;

/// The result of a call: the type and the value, both as text. `None` where the arguments are not of the parameters'
/// types.
type Called = Option<Result<(String, String), Fault>>;

/// A function whose arguments are literals.
type Function = fn(&Cx, &[String]) -> Called;

/// Calls a function with arguments that are literals.
///
/// # Errors
/// There is no such function here, it does not take these arguments, or they are outside its domain.
pub(super) fn call(cx: &Cx, name: &str, arguments: &[String]) -> Result<(String, String), String> {
    let named = || FUNCTIONS.iter().filter(|(known, _)| known.eq_ignore_ascii_case(name));
    if named().next().is_none() {
        return Err(match catalog::functions(name) {
            [] => format!("only built-in functions can be called while the program is halted, and {name} is not one"),
            _ => format!("{name} cannot be called while the program is halted"),
        });
    }
    let called = named().find_map(|(_, function)| function(cx, arguments));
    let wrong = || format!("{name} does not take these arguments here: see `arl2rs doc {name}`");
    called.ok_or_else(wrong)?.map_err(|fault| fault.to_string())
}

/// A value that always exists, or a fault.
trait Outcome {
    fn outcome(self) -> Result<(String, String), Fault>;
}

impl<T: Outcome> Outcome for Result<T, Fault> {
    fn outcome(self) -> Result<(String, String), Fault> {
        self?.outcome()
    }
}

macro_rules! outcomes {
    ($($ty:ty)*) => { $(
        impl Outcome for $ty {
            fn outcome(self) -> Result<(String, String), Fault> {
                let mut text = String::new();
                self.write(&mut text);
                Ok((self.type_name(), text))
            }
        }
    )* };
}

outcomes! { i32 u8 f64 bool Str Pose Joint }

/// Reads an argument, which is preceded by its type and a colon; `None` where it is of another type. Numbers are
/// widened.
fn read<T: Literal + Default>(argument: &str) -> Option<T> {
    let (ty, literal) = argument.split_once(':')?;
    let wanted = T::default().type_name();
    let widens = match wanted.as_str() {
        "double" => matches!(ty, "int" | "uint" | "byte"),
        "int" => ty == "byte",
        _ => false,
    };
    // Braces take the type of the parameter.
    if !(ty.is_empty() || ty == wanted || widens) {
        return None;
    }
    let mut names = Interner::default();
    let parsed = arl_lang::parse_expression(literal, &mut names, arl_lang::ParseOptions::default());
    let mut value = T::default();
    (parsed.errors.is_empty() && value.put(&parsed.expr, &names).is_ok()).then_some(value)
}

macro_rules! functions {
    ($($name:literal($($parameter:ident: $ty:ty),*) $(in $cx:ident)? = $call:expr;)*) => {
        &[$(($name, |_cx, arguments| {
            let [$($parameter),*] = arguments else { return None };
            $(let $parameter: $ty = read($parameter)?;)*
            $(let $cx = _cx;)?
            Some($call.outcome())
        })),*]
    };
}

/// The functions by their names. Of several forms of one name the first that takes the arguments is called.
static FUNCTIONS: &[(&str, Function)] = functions! {
    "abs"(x: i32) = math::abs_int(x);
    "abs"(x: f64) = math::abs_double(x);
    "sin"(x: f64) = math::sin(x);
    "cos"(x: f64) = math::cos(x);
    "tan"(x: f64) = math::tan(x);
    "asin"(x: f64) = math::asin(x);
    "acos"(x: f64) = math::acos(x);
    "atan"(x: f64) = math::atan(x);
    "atan2"(y: f64, x: f64) = math::atan2(y, x);
    "sinh"(x: f64) = math::sinh(x);
    "cosh"(x: f64) = math::cosh(x);
    "tanh"(x: f64) = math::tanh(x);
    "exp"(x: f64) = math::exp(x);
    "pow"(x: f64, y: f64) = math::pow(x, y);
    "pow10"(x: f64) = math::pow10(x);
    "log"(x: f64) = math::log(x);
    "log10"(x: f64) = math::log10(x);
    "sqrt"(x: f64) = math::sqrt(x);
    "floor"(x: f64) = math::floor(x);
    "ceil"(x: f64) = math::ceil(x);
    "ldexp"(x: f64, exponent: i32) = math::ldexp(x, exponent);
    "fmod"(x: f64, y: f64) = math::fmod(x, y);
    "hypot"(x: f64, y: f64) = math::hypot(x, y);
    "norm"(p: Pos) = math::norm(p);
    "trunc"(x: f64, digits: i32, round: bool) = math::trunc(x, digits, round);
    "bitcheck"(data: u8, at: i32) = bits::bitcheck_byte(data, at);
    "bitcheck"(data: i32, at: i32) = bits::bitcheck_int(data, at);
    "strlen"(s: Str) = strings::strlen(&s);
    "substr"(s: Str, from: i32) = strings::substr(&s, from, None);
    "substr"(s: Str, from: i32, length: i32) = strings::substr(&s, from, Some(length));
    "toascii"(s: Str) = strings::toascii(&s);
    "toint"(x: f64) = convert::toint_double(x);
    "toint"(s: Str, base: NumBase) = convert::toint_string(&s, base);
    "tostr"(x: i32, base: NumBase) = convert::tostr_base(x, base);
    "tostr"(x: f64, digits: i32) = convert::tostr_precision(x, digits);
    "tostr"(x: i32) = convert::tostr(&x);
    "tostr"(x: f64) = convert::tostr(&x);
    "tostr"(x: bool) = convert::tostr(&x);
    "tostr"(x: u8) = convert::tostr(&x);
    "tostr"(s: Str) = convert::tostr(&s);
    "tostr"(j: Joint) = convert::tostr(&j);
    "tostr"(p: Pose) = convert::tostr(&p);
    "tostr"(p: Pos) = convert::tostr(&p);
    "cjoint"() in cx = pose::cjoint(cx);
    "cpose"() in cx = pose::cpose_default(cx);
    "cpose"(t: Tool, w: Wobj) in cx = pose::cpose(cx, t, &w);
    "getpose"(j: Joint, t: Tool, w: Wobj) in cx = pose::getpose(cx, j, t, &w);
    "getjoint"(p: Pose, t: Tool, w: Wobj) in cx = pose::getjoint(cx, p, t, &w);
    "poseinv"(p: Pose) = pose::poseinv(p);
    "offset"(p: Pose, x: f64, y: f64, z: f64, rz: f64, ry: f64, rx: f64) = pose::offset(p, x, y, z, rz, ry, rx);
    "reltool"(p: Pose, x: f64, y: f64, z: f64, rz: f64, ry: f64, rx: f64) = pose::reltool(p, x, y, z, rz, ry, rx);
};

#[cfg(test)]
mod tests {
    use super::*;
    use arl_lang::catalog::Effect;

    #[test]
    fn functions_are_those_of_the_catalog_and_change_nothing() {
        for (name, _) in FUNCTIONS {
            let all = catalog::functions(name);
            assert!(!all.is_empty(), "{name}");
            assert!(all.iter().all(|entry| entry.effect == Effect::Pure || entry.looks), "{name}");
        }
    }
}
