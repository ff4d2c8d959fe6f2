//! 5.1: mathematics.

use super::declare::{base, entries, folded, kind, param_type};

entries! { pub(super) MATH =
    /// Absolute value of a whole number.
    fn abs(x: int "the number") -> int
        { "5.1.1", math::abs_int, pure; "print abs(-10)" }
    /// Absolute value of a number.
    fn abs(x: {double} "the number") -> double
        { "5.1.1", math::abs_double, pure; "print abs(-11.11)" }
    /// Sine of an angle.
    fn sin(x: double "the angle, rad") -> double
        { "5.1.2", math::sin, pure; "print sin(PI/6)" }
    /// Cosine of an angle.
    fn cos(x: double "the angle, rad") -> double
        { "5.1.3", math::cos, pure; "print cos(PI/3)" }
    /// Tangent of an angle.
    fn tan(x: double "the angle, rad") -> double
        { "5.1.4", math::tan, pure; "print tan(PI/4)" }
    /// Angle with this sine, -PI/2 to PI/2 rad. Beyond -1 to 1: alarm.
    fn asin(x: double "the sine, -1 to 1") -> double
        { "5.1.5", math::asin, pure, fails; "print asin(0.5)" }
    /// Angle with this cosine, 0 to PI rad. Beyond -1 to 1: alarm.
    fn acos(x: double "the cosine, -1 to 1") -> double
        { "5.1.6", math::acos, pure, fails; "print acos(0.5)" }
    /// Angle with this tangent, -PI/2 to PI/2 rad.
    fn atan(x: double "the tangent") -> double
        { "5.1.7", math::atan, pure; "print atan(1)" }
    /// Angle of the point (x, y) seen from the origin, -PI to PI rad.
    fn atan2(y: double "the y coordinate, first", x: double "the x coordinate") -> double
        { "5.1.8", math::atan2, pure; "print atan2(1,1)" }
    /// Hyperbolic sine.
    fn sinh(x: double "the number") -> double
        { "5.1.9", math::sinh, pure; "print sinh(1)" }
    /// Hyperbolic cosine.
    fn cosh(x: double "the number") -> double
        { "5.1.10", math::cosh, pure; "print cosh(1)" }
    /// Hyperbolic tangent, between -1 and 1.
    fn tanh(x: double "the number") -> double
        { "5.1.11", math::tanh, pure; "print tanh(1)" }
    /// e to the power of x.
    fn exp(x: double "the exponent") -> double
        { "5.1.12", math::exp, pure; "print exp(1)" }
    /// x to the power of y.
    fn pow(x: double "the base", y: double "the exponent") -> double
        { "5.1.13", math::pow, pure; "print pow(2,3)" }
    /// 10 to the power of x.
    fn pow10(x: double "the exponent") -> double
        { "5.1.14", math::pow10, pure; "print pow10(-1)" }
    /// Natural logarithm. Of 0 or less: alarm.
    fn log(x: double "the number, above 0") -> double
        { "5.1.15", math::log, pure, fails; "print log(2)" }
    /// Logarithm to base 10. Of 0 or less: alarm.
    fn log10(x: double "the number, above 0") -> double
        { "5.1.16", math::log10, pure, fails; "print log10(100)" }
    /// Square root. Of a negative number: alarm.
    fn sqrt(x: double "the number, 0 or more") -> double
        { "5.1.17", math::sqrt, pure, fails; "print sqrt(2)" }
    /// Greatest whole number that is not above x.
    fn floor(x: double "the number") -> double
        { "5.1.18", math::floor, pure; "print floor(2.36)" }
    /// Least whole number that is not below x.
    fn ceil(x: double "the number") -> double
        { "5.1.19", math::ceil, pure; "print ceil(2.36)" }
    /// Splits a number into a fraction and a power of two: the result lies in 0.5 to 1 (0 for 0), val is the result
    /// times 2 to the power of exp.
    fn frexp(val: double "the number", exp: {int} [out] "gets the exponent") -> double
        { "5.1.20", math::frexp_int, pure; "int e\nprint frexp(64,e),\" \",e" }
    /// Splits a number into a fraction and a power of two, with the exponent in a double.
    fn frexp(val: double "the number", exp: {double} [out] "gets the exponent") -> double
        { "5.1.20", math::frexp_double, pure; "double e\nprint frexp(64,e),\" \",e" }
    /// val times 2 to the power of exp.
    fn ldexp(val: double "the fraction", exp: int "the exponent") -> double
        { "5.1.21", math::ldexp, pure; "print ldexp(3,3)" }
    /// Remainder of x / y, with the sign of x. By 0: alarm.
    fn fmod(x: double "what is divided", y: double "the divisor, not 0") -> double
        { "5.1.22", math::fmod, pure, fails; "print fmod(12.58,2.6)" }
    /// Splits a number at the decimal point: the result is what follows it, with the sign of x. A whole part beyond the
    /// range of int: alarm.
    fn modf(x: double "the number", y: {int} [out] "gets the whole part") -> double
        { "5.1.23", math::modf_int, pure, fails; "int whole\nprint modf(123.5,whole),\" \",whole" }
    /// Splits a number at the decimal point, with the whole part in a double.
    fn modf(x: double "the number", y: {double} [out] "gets the whole part") -> double
        { "5.1.23", math::modf_double, pure; "double whole\nprint modf(123.5,whole),\" \",whole" }
    /// Length of the hypotenuse over two legs.
    fn hypot(x: double "one leg", y: double "the other leg") -> double
        { "5.1.24", math::hypot, pure; "print hypot(6,8)" }
    /// A random whole number, 0 to 2147483647. On the virtual clock the numbers follow from the seed.
    fn rand() -> int
        { "5.1.25", math::rand, acts, looks; "int x = rand()\nprint x >= 0" }
    /// Distance of a point from the origin.
    fn norm(p: pos "the point") -> double
        { "5.1.26", math::norm, pure; "pos p = {300,400,500}\nprint norm(p)" }
    /// Cuts a number to n digits after the decimal point. A negative n: alarm.
    fn trunc(
        num: double "the number",
        n: int "how many digits remain, 0 or more",
        round: bool "true rounds (half away from zero), false cuts off",
    ) -> double
        { "5.1.27", math::trunc, pure, fails; "print trunc(3.1415926,4,true),\" \",trunc(3.1415926,4,false)" }
}
