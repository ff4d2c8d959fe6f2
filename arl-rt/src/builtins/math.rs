//! Functions of numbers. Angles are in rad.

use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::values::Pos;

fn domain(function: &'static str, problem: String) -> Fault {
    Fault::Domain { function, problem: problem.into() }
}

/// The absolute value of an int; the least int stays as it is.
pub fn abs_int(x: i32) -> i32 {
    x.wrapping_abs()
}

/// The absolute value of a number.
pub fn abs_double(x: f64) -> f64 {
    x.abs()
}

/// Functions that are defined everywhere.
macro_rules! everywhere {
    ($($(#[$doc:meta])* $name:ident($first:ident $(, $second:ident)?) = $how:expr;)*) => { $(
        $(#[$doc])*
        pub fn $name($first: f64 $(, $second: f64)?) -> f64 {
            $how
        }
    )* };
}

everywhere! {
    /// The sine of an angle in rad.
    sin(x) = libm::sin(x);
    /// The cosine of an angle in rad.
    cos(x) = libm::cos(x);
    /// The tangent of an angle in rad.
    tan(x) = libm::tan(x);
    /// The angle with this tangent, -PI/2 to PI/2 rad.
    atan(x) = libm::atan(x);
    /// The angle of the point (x, y), -PI to PI rad.
    atan2(y, x) = libm::atan2(y, x);
    /// The hyperbolic sine.
    sinh(x) = libm::sinh(x);
    /// The hyperbolic cosine.
    cosh(x) = libm::cosh(x);
    /// The hyperbolic tangent.
    tanh(x) = libm::tanh(x);
    /// e to the power of x.
    exp(x) = libm::exp(x);
    /// x to the power of y.
    pow(x, y) = libm::pow(x, y);
    /// 10 to the power of x.
    pow10(x) = libm::exp10(x);
    /// The largest whole number that is not above x.
    floor(x) = x.floor();
    /// The smallest whole number that is not below x.
    ceil(x) = x.ceil();
    /// The hypotenuse of two legs.
    hypot(x, y) = libm::hypot(x, y);
}

/// The angle with this sine, -PI/2 to PI/2 rad.
///
/// # Errors
/// [`Fault::Domain`] outside -1 to 1.
pub fn asin(x: f64) -> Result<f64, Fault> {
    unit("asin", x).map(libm::asin)
}

/// The angle with this cosine, 0 to PI rad.
///
/// # Errors
/// [`Fault::Domain`] outside -1 to 1.
pub fn acos(x: f64) -> Result<f64, Fault> {
    unit("acos", x).map(libm::acos)
}

fn unit(function: &'static str, x: f64) -> Result<f64, Fault> {
    if x.abs() > 1.0 { Err(domain(function, format!("{x} is outside -1 to 1"))) } else { Ok(x) }
}

/// The natural logarithm.
///
/// # Errors
/// [`Fault::Domain`] for 0 and less.
pub fn log(x: f64) -> Result<f64, Fault> {
    positive("log", x).map(libm::log)
}

/// The logarithm to base 10.
///
/// # Errors
/// [`Fault::Domain`] for 0 and less.
pub fn log10(x: f64) -> Result<f64, Fault> {
    positive("log10", x).map(libm::log10)
}

fn positive(function: &'static str, x: f64) -> Result<f64, Fault> {
    if x <= 0.0 { Err(domain(function, format!("{x} is not above 0"))) } else { Ok(x) }
}

/// The square root.
///
/// # Errors
/// [`Fault::Domain`] below 0.
pub fn sqrt(x: f64) -> Result<f64, Fault> {
    if x < 0.0 { Err(domain("sqrt", format!("{x} is below 0"))) } else { Ok(x.sqrt()) }
}

/// Splits a number into a fraction of 0.5 to 1 (with the number's sign) and a power of two.
pub fn frexp_int(val: f64, exp: &mut i32) -> f64 {
    let (fraction, power) = split(val);
    *exp = power;
    fraction
}

/// Like [`frexp_int`], with the exponent in a double.
pub fn frexp_double(val: f64, exp: &mut f64) -> f64 {
    let (fraction, power) = split(val);
    *exp = f64::from(power);
    fraction
}

fn split(val: f64) -> (f64, i32) {
    const EXPONENT: u64 = 0x7ff << 52;
    const HALF: u64 = 0x3fe << 52;
    const TWO_TO_64: f64 = 18_446_744_073_709_551_616.0;
    if val == 0.0 || !val.is_finite() {
        return (val, 0);
    }
    if val.is_subnormal() {
        let (fraction, power) = split(val * TWO_TO_64);
        return (fraction, power - 64);
    }
    let bits = val.to_bits();
    (f64::from_bits(bits & !EXPONENT | HALF), ((bits & EXPONENT) >> 52) as i32 - 1022)
}

/// `val` times 2 to the power of `exp`, rounded once.
pub fn ldexp(val: f64, exp: i32) -> f64 {
    libm::ldexp(val, exp)
}

/// The remainder of the quotient truncated towards zero, with the sign of `x`.
///
/// # Errors
/// [`Fault::Domain`] for a zero `y`.
pub fn fmod(x: f64, y: f64) -> Result<f64, Fault> {
    if y == 0.0 { Err(domain("fmod", "the divisor is 0".to_owned())) } else { Ok(x % y) }
}

/// Splits a number into its whole part and the fraction, both with its sign.
///
/// # Errors
/// [`Fault::Domain`] if the whole part is outside the range of int.
pub fn modf_int(x: f64, y: &mut i32) -> Result<f64, Fault> {
    let whole = x.trunc();
    if !(-2_147_483_648.0..=2_147_483_647.0).contains(&whole) {
        return Err(domain("modf", format!("the whole part of {x} is outside the range of int")));
    }
    *y = whole as i32;
    Ok((x - whole).copysign(x))
}

/// Like [`modf_int`], with the whole part in a double.
pub fn modf_double(x: f64, y: &mut f64) -> f64 {
    *y = x.trunc();
    if x.is_infinite() { 0f64.copysign(x) } else { (x - *y).copysign(x) }
}

/// The distance of a point from the origin, mm.
pub fn norm(p: Pos) -> f64 {
    libm::hypot(libm::hypot(p.x, p.y), p.z)
}

/// Keeps `n` digits after the decimal point; the rest is cut off or, with `round`, rounded half away from zero.
///
/// The digits are those of the shortest decimal number that represents the double, so that 2.3 cut to one digit is 2.3.
///
/// # Errors
/// [`Fault::Domain`] for a negative `n`.
pub fn trunc(num: f64, n: i32, round: bool) -> Result<f64, Fault> {
    let Ok(places) = usize::try_from(n) else {
        return Err(domain("trunc", format!("the number of digits is {n}, but must be 0 or more")));
    };
    // Beyond 2^53 a double has no fraction.
    if !num.is_finite() || num.abs() >= 9_007_199_254_740_992.0 {
        return Ok(num);
    }
    let text = num.abs().to_string();
    let (whole, fraction) = text.split_once('.').unwrap_or((&text, ""));
    let Some(kept) = fraction.get(..places) else {
        return Ok(num);
    };
    let up = round && fraction.as_bytes().get(places).is_some_and(|digit| *digit >= b'5');
    let mut digits: Vec<u8> = whole.bytes().chain(kept.bytes()).collect();
    if up {
        let nines = digits.iter().rev().take_while(|digit| **digit == b'9').count();
        let below = digits.len() - nines;
        digits.iter_mut().skip(below).for_each(|digit| *digit = b'0');
        match below.checked_sub(1).and_then(|at| digits.get_mut(at)) {
            Some(digit) => *digit += 1,
            None => digits.insert(0, b'1'),
        }
    }
    let number = format!("{}e-{}", String::from_utf8_lossy(&digits), kept.len());
    Ok(number.parse().map_or(num, |size: f64| size.copysign(num)))
}

/// `rand`: a number from 0 to 2147483647. The sequence is determined by the controller's seed.
pub fn rand(cx: &Cx) -> i32 {
    cx.goes_on();
    cx.shared().random.next()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::values::text::{Print, Style};
    use std::f64::consts::PI;

    fn shown(value: f64) -> String {
        value.printed(&Style::START).to_string()
    }

    #[test]
    fn the_manuals_examples() {
        for (value, text) in [
            (abs_double(-11.11), "11.11"),
            (sin(PI / 6.0), "0.5"),
            (cos(PI / 3.0), "0.5"),
            (tan(PI / 4.0), "1"),
            (asin(0.5).unwrap(), "0.523599"),
            (acos(0.5).unwrap(), "1.0472"),
            (atan(1.0), "0.785398"),
            (atan2(1.0, 1.0), "0.785398"),
            (sinh(1.0), "1.1752"),
            (cosh(1.0), "1.54308"),
            (tanh(1.0), "0.761594"),
            (exp(1.0), "2.71828"),
            (pow(2.0, 3.0), "8"),
            (pow10(-1.0), "0.1"),
            (log(2.0).unwrap(), "0.693147"),
            (log10(100.0).unwrap(), "2"),
            (sqrt(2.0).unwrap(), "1.41421"),
            (floor(2.36), "2"),
            (ceil(2.36), "3"),
            (ldexp(3.0, 3), "24"),
            (fmod(12.58, 2.6).unwrap(), "2.18"),
            (hypot(6.0, 8.0), "10"),
            (norm(Pos { x: 300.0, y: 400.0, z: 500.0 }), "707.107"),
            (trunc(PI, 4, true).unwrap(), "3.1416"),
            (trunc(PI, 4, false).unwrap(), "3.1415"),
        ] {
            assert_eq!(shown(value), text);
        }
        assert_eq!(abs_int(-10), 10);
        let mut power = 0;
        assert_eq!((frexp_int(64.0, &mut power), power), (0.5, 7));
        let mut whole = 0.0;
        assert_eq!(shown(modf_double(123.456, &mut whole)), "0.456");
        assert_eq!(whole, 123.0);
    }

    #[test]
    fn signs_and_quadrants() {
        assert_eq!(atan2(1.0, -1.0), 0.75 * PI);
        assert_eq!(atan2(-1.0, 0.0), -PI / 2.0);
        assert_eq!((floor(-2.5), ceil(-2.5)), (-3.0, -2.0));
        assert_eq!(fmod(-7.5, 2.0), Ok(-1.5));
        assert_eq!(fmod(7.5, -2.0), Ok(1.5));
        assert_eq!(abs_int(i32::MIN), i32::MIN);
    }

    #[test]
    fn domains() {
        let faults = [
            (sqrt(-1.0), "sqrt: -1 is below 0"),
            (log(0.0), "log: 0 is not above 0"),
            (log10(-2.5), "log10: -2.5 is not above 0"),
            (asin(1.5), "asin: 1.5 is outside -1 to 1"),
            (acos(-1.5), "acos: -1.5 is outside -1 to 1"),
            (fmod(1.0, 0.0), "fmod: the divisor is 0"),
            (trunc(1.0, -1, true), "trunc: the number of digits is -1, but must be 0 or more"),
            (modf_int(3e9, &mut 0), "modf: the whole part of 3000000000 is outside the range of int"),
        ];
        for (result, text) in faults {
            let fault = result.unwrap_err();
            assert_eq!(fault.to_string(), text);
            assert_eq!(fault.number(), 20004);
        }
        assert_eq!(sqrt(0.0), Ok(0.0));
        assert_eq!(asin(1.0), Ok(PI / 2.0));
        assert!(modf_int(f64::NAN, &mut 0).is_err());
        assert_eq!(modf_int(-2_147_483_648.5, &mut 0), Ok(-0.5));
    }

    #[test]
    fn fractions_and_powers() {
        let tiny = f64::from_bits(1);
        for value in [1.0, -3.5, 1e300, -1e-300, f64::MAX, f64::MIN_POSITIVE, tiny, tiny * 12345.0, 0.1] {
            let mut power = 0.0;
            let fraction = frexp_double(value, &mut power);
            assert!((0.5..1.0).contains(&fraction.abs()), "{value}");
            assert_eq!(ldexp(fraction, power as i32), value);
        }
        let mut power = 7;
        assert_eq!((frexp_int(0.0, &mut power), power), (0.0, 0));
        assert_eq!(ldexp(1.0, -1074), tiny);
        assert_eq!(ldexp(1.0, -1075), 0.0);
        assert_eq!(ldexp(1.5, -1075), tiny);
        assert_eq!(ldexp(tiny, 2097), ldexp(1.0, 1023));
        assert_eq!(ldexp(1.0, 1024), f64::INFINITY);
        assert_eq!(ldexp(f64::MAX, i32::MIN), 0.0);
        assert_eq!(ldexp(tiny, i32::MAX), f64::INFINITY);
        // Rounding twice would give 2^-1074 * 2 here.
        let value = f64::from_bits(1.0f64.to_bits() + 1) * 1.5;
        assert_eq!(ldexp(value, -1074), 2.0 * tiny);
        assert_eq!(ldexp(1.25 - f64::EPSILON, -1073), 2.0 * tiny);
    }

    #[test]
    fn whole_parts() {
        for (x, whole, fraction) in [(-1.25, -1, -0.25), (0.75, 0, 0.75), (2.0, 2, 0.0)] {
            let mut y = 0;
            assert_eq!(modf_int(x, &mut y), Ok(fraction));
            assert_eq!(y, whole);
        }
        let mut y = 0.0;
        assert_eq!(modf_double(f64::NEG_INFINITY, &mut y), 0.0);
        assert_eq!(y, f64::NEG_INFINITY);
    }

    #[test]
    fn cutting_and_rounding() {
        for (num, n, cut, rounded) in [
            (2.3, 1, 2.3, 2.3),
            (0.29, 2, 0.29, 0.29),
            (1.005, 2, 1.0, 1.01),
            (2.5, 0, 2.0, 3.0),
            (-2.5, 0, -2.0, -3.0),
            (-0.05, 1, 0.0, -0.1),
            (9.995, 2, 9.99, 10.0),
            (999.96, 1, 999.9, 1000.0),
            (0.000_123, 5, 0.000_12, 0.000_12),
            (1e-9, 3, 0.0, 0.0),
            (1e300, 2, 1e300, 1e300),
            (7.0, 400, 7.0, 7.0),
            (0.1 + 0.2, 1, 0.3, 0.3),
        ] {
            assert_eq!(trunc(num, n, false), Ok(cut), "{num} cut to {n}");
            assert_eq!(trunc(num, n, true), Ok(rounded), "{num} rounded to {n}");
        }
        assert!(trunc(f64::NAN, 1, true).unwrap().is_nan());
    }
}
