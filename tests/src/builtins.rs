//! The built-in functions that random programs call.

use crate::machine::Alarm;
use crate::value::{Base, PLAIN, Style, Value, general, print};

/// What a parameter takes.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Param {
    /// Anything that converts to the type.
    Like(Base),
    /// The type itself.
    Exactly(Base),
    /// A variable that is written.
    Out(Base),
    /// Anything that can be printed.
    Any,
    /// A small whole number from the first to the last, as a rule.
    Near(i32, i32),
    /// The word as it stands.
    Word(&'static str),
}

/// Something built in.
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Builtin {
    pub name: &'static str,
    pub params: &'static [Param],
    pub result: Base,
    /// Computes the result; what is written into an `Out` parameter is left there.
    pub run: fn(&mut [Value]) -> Result<Value, Alarm>,
}

use Base::{Bool, Byte, Double, Int, Str, Void};
use Param::{Any, Exactly, Like, Near, Out, Word};

macro_rules! builtins {
    ($($name:literal ($($param:expr),*) $result:ident = $run:expr;)*) => {
        /// All of them.
        pub const BUILTINS: &[Builtin] =
            &[$(Builtin { name: $name, params: &[$($param),*], result: $result, run: $run }),*];
    };
}

builtins! {
    "abs"(Exactly(Int)) Int = |a| Ok(Value::Int(int(a, 0).wrapping_abs()));
    "abs"(Exactly(Byte)) Int = |a| Ok(Value::Int(int(a, 0)));
    "abs"(Exactly(Double)) Double = |a| number(double(a, 0).abs());
    "sin"(Like(Double)) Double = |a| number(libm::sin(double(a, 0)));
    "cos"(Like(Double)) Double = |a| number(libm::cos(double(a, 0)));
    "tan"(Like(Double)) Double = |a| number(libm::tan(double(a, 0)));
    "atan"(Like(Double)) Double = |a| number(libm::atan(double(a, 0)));
    "tanh"(Like(Double)) Double = |a| number(libm::tanh(double(a, 0)));
    "exp"(Like(Double)) Double = |a| number(libm::exp(double(a, 0)));
    "floor"(Like(Double)) Double = |a| number(double(a, 0).floor());
    "ceil"(Like(Double)) Double = |a| number(double(a, 0).ceil());
    "atan2"(Like(Double), Like(Double)) Double = |a| number(libm::atan2(double(a, 0), double(a, 1)));
    "pow"(Like(Double), Like(Double)) Double = |a| number(libm::pow(double(a, 0), double(a, 1)));
    "hypot"(Like(Double), Like(Double)) Double = |a| number(libm::hypot(double(a, 0), double(a, 1)));
    "sqrt"(Like(Double)) Double = |a| within(double(a, 0) >= 0.0 || double(a, 0).is_nan(), double(a, 0).sqrt());
    "log"(Like(Double)) Double = |a| within(double(a, 0) > 0.0 || double(a, 0).is_nan(), libm::log(double(a, 0)));
    "log10"(Like(Double)) Double = |a| within(double(a, 0) > 0.0 || double(a, 0).is_nan(), libm::log10(double(a, 0)));
    "asin"(Like(Double)) Double = |a| within(double(a, 0).abs() <= 1.0 || double(a, 0).is_nan(), libm::asin(double(a, 0)));
    "fmod"(Like(Double), Like(Double)) Double = |a| within(double(a, 1) != 0.0, double(a, 0) % double(a, 1));
    "ldexp"(Like(Double), Near(-9, 20)) Double = |a| number(double(a, 0) * 2f64.powi(int(a, 1)));
    "frexp"(Like(Double), Out(Int)) Double = |a| {
        let (fraction, exponent) = frexp(double(a, 0));
        a[1] = Value::Int(exponent);
        number(fraction)
    };
    "frexp"(Like(Double), Out(Double)) Double = |a| {
        let (fraction, exponent) = frexp(double(a, 0));
        a[1] = Value::Double(exponent.into());
        number(fraction)
    };
    "modf"(Like(Double), Out(Int)) Double = |a| {
        let x = double(a, 0);
        if !(x.trunc() >= f64::from(i32::MIN) && x.trunc() <= f64::from(i32::MAX)) {
            return Err(Alarm::DOMAIN);
        }
        a[1] = Value::Int(x.trunc() as i32);
        number(x - x.trunc())
    };
    "modf"(Like(Double), Out(Double)) Double = |a| {
        let x = double(a, 0);
        a[1] = Value::Double(x.trunc());
        number(if x.is_infinite() { 0.0 } else { x - x.trunc() })
    };
    "bitcheck"(Exactly(Byte), Near(0, 7)) Bool = |a| bit(a, 8).map(|bit| Value::Bool(int(a, 0) as u32 & bit != 0));
    "bitcheck"(Exactly(Int), Near(0, 31)) Bool = |a| bit(a, 32).map(|bit| Value::Bool(int(a, 0) as u32 & bit != 0));
    "bitlcs"(Exactly(Byte), Near(0, 40)) Byte = |a| turns(a).map(|n| Value::Byte(byte(a, 0).rotate_left(n % 8)));
    "bitlcs"(Exactly(Byte)) Byte = |a| Ok(Value::Byte(byte(a, 0).rotate_left(1)));
    "bitlcs"(Exactly(Int), Near(0, 40)) Int = |a| turns(a).map(|n| Value::Int(int(a, 0).rotate_left(n % 32)));
    "bitrcs"(Exactly(Byte), Near(0, 40)) Byte = |a| turns(a).map(|n| Value::Byte(byte(a, 0).rotate_right(n % 8)));
    "bitrcs"(Exactly(Int), Near(0, 40)) Int = |a| turns(a).map(|n| Value::Int(int(a, 0).rotate_right(n % 32)));
    "bitrcs"(Exactly(Int)) Int = |a| Ok(Value::Int(int(a, 0).rotate_right(1)));
    "bitset"(Out(Int), Near(0, 31)) Void = |a| {
        a[0] = Value::Int((int(a, 0) as u32 | bit(a, 32)?) as i32);
        Ok(Value::Void)
    };
    "bitclear"(Out(Int), Near(0, 31)) Void = |a| {
        a[0] = Value::Int((int(a, 0) as u32 & !bit(a, 32)?) as i32);
        Ok(Value::Void)
    };
    "bitset"(Out(Byte), Near(0, 7)) Void = |a| {
        a[0] = Value::Byte((int(a, 0) as u32 | bit(a, 8)?) as u8);
        Ok(Value::Void)
    };
    "bitclear"(Out(Byte), Near(0, 7)) Void = |a| {
        a[0] = Value::Byte((int(a, 0) as u32 & !bit(a, 8)?) as u8);
        Ok(Value::Void)
    };
    "strlen"(Like(Str)) Int = |a| Ok(Value::Int(text(a, 0).len() as i32));
    "substr"(Like(Str), Near(0, 3)) Str = |a| substr(text(a, 0), int(a, 1), i32::MAX);
    "substr"(Like(Str), Near(0, 3), Near(0, 5)) Str = |a| substr(text(a, 0), int(a, 1), int(a, 2));
    "toascii"(Like(Str)) Int = |a| match text(a, 0) {
        [one] => Ok(Value::Int((*one).into())),
        _ => Err(Alarm::DOMAIN),
    };
    "toint"(Exactly(Double)) Int = |a| {
        let x = double(a, 0).trunc();
        within(x >= f64::from(i32::MIN) && x <= f64::from(i32::MAX), x).map(|_| Value::Int(x as i32))
    };
    "tostr"(Any) Str = |a| Ok(printed(&a[0], PLAIN));
    "tostr"(Exactly(Double), Near(1, 12)) Str = |a| {
        // As in `print`, 0 counts as 1.
        let digits = usize::try_from(int(a, 1)).map_err(|_| Alarm::DOMAIN)?;
        Ok(Value::Str(general(double(a, 0), digits.max(1)).into_bytes()))
    };
    "tostr"(Exactly(Int), Word("hex")) Str = |a| Ok(printed(&a[0], Style { hex: Some(true), ..PLAIN }));
    "tostr"(Exactly(Int), Word("dec")) Str = |a| Ok(printed(&a[0], PLAIN));
    "typeof"(Any) Str = |a| Ok(a[0].clone());
}

fn int(values: &[Value], at: usize) -> i32 {
    match values[at] {
        Value::Int(x) => x,
        Value::Byte(x) => x.into(),
        ref other => panic!("{other:?} is not an int"),
    }
}

fn byte(values: &[Value], at: usize) -> u8 {
    match values[at] {
        Value::Byte(x) => x,
        ref other => panic!("{other:?} is not a byte"),
    }
}

fn double(values: &[Value], at: usize) -> f64 {
    match values[at] {
        Value::Double(x) => x,
        ref other => panic!("{other:?} is not a double"),
    }
}

fn text(values: &[Value], at: usize) -> &[u8] {
    match &values[at] {
        Value::Str(x) => x,
        other => panic!("{other:?} is not a string"),
    }
}

fn number(value: f64) -> Result<Value, Alarm> {
    Ok(Value::Double(value))
}

fn within(good: bool, value: f64) -> Result<Value, Alarm> {
    if good { number(value) } else { Err(Alarm::DOMAIN) }
}

/// The bit at the position in the second argument.
fn bit(values: &[Value], width: i32) -> Result<u32, Alarm> {
    let at = int(values, 1);
    if (0..width).contains(&at) { Ok(1 << at) } else { Err(Alarm::DOMAIN) }
}

/// The places to turn, in the second argument.
fn turns(values: &[Value]) -> Result<u32, Alarm> {
    u32::try_from(int(values, 1)).map_err(|_| Alarm::DOMAIN)
}

fn substr(text: &[u8], from: i32, length: i32) -> Result<Value, Alarm> {
    if from < 0 || from as usize >= text.len() || length < 0 {
        return Err(Alarm::DOMAIN);
    }
    Ok(Value::Str(text[from as usize..].iter().take(length as usize).copied().collect()))
}

fn printed(value: &Value, style: Style) -> Value {
    let mut out = Vec::new();
    print(value, style, &mut out);
    Value::Str(out)
}

/// A fraction from 0.5 to 1 and an exponent of 2.
fn frexp(value: f64) -> (f64, i32) {
    if value == 0.0 || !value.is_finite() {
        return (value, 0);
    }
    let mut fraction = value;
    let mut exponent = 0;
    while fraction.abs() >= 1.0 {
        fraction /= 2.0;
        exponent += 1;
    }
    while fraction.abs() < 0.5 {
        fraction *= 2.0;
        exponent -= 1;
    }
    (fraction, exponent)
}
