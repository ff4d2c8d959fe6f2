//! Numbers as text: printing and reading.

use crate::values::Str;
use std::fmt::Write;

/// More significant digits than this have no effect: no double has them.
const MOST_DIGITS: u32 = 800;

/// Appends a double with `precision` significant digits, without trailing zeros: fixed-point if the decimal exponent is
/// from -4 to `precision - 1`, otherwise with an exponent of at least two digits. Ties of the exact binary value go to
/// the even digit; minus zero is `0`.
pub(crate) fn push_double(out: &mut Str, value: f64, precision: u32) {
    let precision = precision.clamp(1, MOST_DIGITS);
    if value.abs() < 10_u64.pow(precision.min(15)) as f64 {
        let whole = value as i64;
        if whole as f64 == value {
            return push_int(out, whole);
        }
    }
    if value.is_nan() {
        return out.push_str("nan");
    }
    if value.is_sign_negative() {
        out.push(b'-');
    }
    if value.is_infinite() {
        return out.push_str("inf");
    }
    let mut text = Scratch { bytes: [0; 32], length: 0 };
    if write!(text, "{:.*e}", precision as usize - 1, value.abs()).is_ok() {
        push_rounded(out, text.filled(), precision);
    } else {
        push_rounded(out, format!("{:.*e}", precision as usize - 1, value.abs()).as_bytes(), precision);
    }
}

/// Appends a number that was already rounded and has the form `d.ddde-x`.
fn push_rounded(out: &mut Str, text: &[u8], precision: u32) {
    let mut halves = text.split(|byte| *byte == b'e');
    let mantissa = halves.next().unwrap_or_default();
    let exponent = read_exponent(halves.next().unwrap_or_default());
    let significant = mantissa.iter().rposition(|byte| (b'1'..=b'9').contains(byte)).map_or(1, |last| last + 1);
    let mantissa = mantissa.get(..significant).unwrap_or(mantissa);
    let (first, rest) = (mantissa.get(..1).unwrap_or_default(), mantissa.get(2..).unwrap_or_default());
    if exponent < -4 || exponent >= precision as i32 {
        out.push_bytes(mantissa);
        out.push_str(if exponent < 0 { "e-" } else { "e+" });
        if exponent.abs() < 10 {
            out.push(b'0');
        }
        push_int(out, i64::from(exponent.abs()));
    } else if exponent < 0 {
        out.push_str("0.");
        (1..-exponent).for_each(|_| out.push(b'0'));
        out.push_bytes(first);
        out.push_bytes(rest);
    } else {
        let whole = exponent as usize;
        out.push_bytes(first);
        match rest.get(..whole) {
            Some(before) => {
                out.push_bytes(before);
                if rest.len() > whole {
                    out.push(b'.');
                    out.push_bytes(rest.get(whole..).unwrap_or_default());
                }
            }
            None => {
                out.push_bytes(rest);
                (rest.len()..whole).for_each(|_| out.push(b'0'));
            }
        }
    }
}

fn read_exponent(digits: &[u8]) -> i32 {
    let (negative, digits) = match digits {
        [b'-', digits @ ..] => (true, digits),
        digits => (false, digits),
    };
    let size = digits.iter().fold(0, |sum, digit| sum * 10 + i32::from(digit.wrapping_sub(b'0')));
    if negative { -size } else { size }
}

/// Appends an integer in decimal.
pub(crate) fn push_int(out: &mut Str, value: i64) {
    let mut digits = [0; 20];
    let mut rest = value.unsigned_abs();
    let mut used = 0;
    for place in digits.iter_mut().rev() {
        *place = b'0' + (rest % 10) as u8;
        used += 1;
        rest /= 10;
        if rest == 0 {
            break;
        }
    }
    if value < 0 {
        out.push(b'-');
    }
    out.push_bytes(digits.get(digits.len() - used..).unwrap_or_default());
}

/// Appends an integer in lower-case hexadecimal without suffix, with at least this many digits.
pub(crate) fn push_hex(out: &mut Str, value: u32, least: u32) {
    let needed = (32 - value.leading_zeros()).div_ceil(4).max(least).max(1);
    for at in (0..needed).rev() {
        let digit = (value.checked_shr(4 * at).unwrap_or(0) & 15) as u8;
        out.push(if digit < 10 { b'0' + digit } else { b'a' + digit - 10 });
    }
}

/// Room for the digits of most doubles, without an allocation.
struct Scratch {
    bytes: [u8; 32],
    length: usize,
}

impl Scratch {
    fn filled(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or(&self.bytes)
    }
}

impl Write for Scratch {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        let end = self.length + text.len();
        let place = self.bytes.get_mut(self.length..end).ok_or(std::fmt::Error)?;
        place.copy_from_slice(text.as_bytes());
        self.length = end;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn double(value: f64, precision: u32) -> String {
        let mut out = Str::new();
        push_double(&mut out, value, precision);
        out.to_string()
    }

    #[test]
    fn doubles() {
        for (value, text) in [
            (9e9, "9e+09"),
            (0.523_598_775_598_298_8, "0.523599"),
            (1.047_197_551_196_597_6, "1.0472"),
            (0.761_594_155_955_764_9, "0.761594"),
            (-0.0, "0"),
            (0.0, "0"),
            (-2.0, "-2"),
            (100_000.0, "100000"),
            (999_999.0, "999999"),
            (1_000_000.0, "1e+06"),
            (999_999.5, "1e+06"),
            (-123_456.7, "-123457"),
            (0.0001, "0.0001"),
            (0.000_099_999_96, "0.0001"),
            (0.000_012_345_678, "1.23457e-05"),
            (1e100, "1e+100"),
            (-1.5e-7, "-1.5e-07"),
            (5e-324, "4.94066e-324"),
            (f64::MAX, "1.79769e+308"),
            (0.5, "0.5"),
            (2.5, "2.5"),
            (1422.841, "1422.84"),
            (f64::NAN, "nan"),
            (-f64::NAN, "nan"),
            (f64::INFINITY, "inf"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(double(value, 6), text);
        }
    }

    #[test]
    fn precisions() {
        let pi = std::f64::consts::PI;
        assert_eq!(double(pi, 3), "3.14");
        assert_eq!(double(pi, 0), "3");
        assert_eq!(double(pi, 1), "3");
        assert_eq!(double(pi, 17), "3.1415926535897931");
        assert_eq!(double(12.0, 1), "1e+01");
        assert_eq!(double(2.5, 1), "2");
        assert_eq!(double(0.1, 60), "0.1000000000000000055511151231257827021181583404541015625");
        assert_eq!(double(0.1, u32::MAX), "0.1000000000000000055511151231257827021181583404541015625");
        assert_eq!(double(5e-324, u32::MAX).len(), 757);
        assert_eq!(double(1e22, 20), "1e+22");
        assert_eq!(double(1e22, 23), "10000000000000000000000");
    }

    #[test]
    fn integers() {
        for (value, text) in [(0, "0"), (-1, "-1"), (i64::MIN, "-9223372036854775808"), (10, "10")] {
            let mut out = Str::new();
            push_int(&mut out, value);
            assert_eq!(out, text);
        }
        for (value, least, text) in [(0, 1, "0"), (255, 1, "ff"), (11, 2, "0b"), (u32::MAX, 1, "ffffffff")] {
            let mut out = Str::new();
            push_hex(&mut out, value, least);
            assert_eq!(out, text);
        }
    }
}
