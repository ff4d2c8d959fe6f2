//! Writes JSON by hand: strings, numbers and arrays.

use std::fmt::Write;

pub(crate) use arl_robot::settings::quoted;

/// The numbers below this, in millionths, fit into whole numbers.
const LARGEST_OF_MILLIONTHS: f64 = 9e9;

/// A number with six decimals; null where it is not finite.
pub(crate) fn number(value: f64) -> String {
    let mut out = String::new();
    push_number(&mut out, value);
    out
}

/// Adds a number with six decimals; null where it is not finite.
pub(crate) fn push_number(out: &mut String, value: f64) {
    let size = value.abs();
    let _ = if size < LARGEST_OF_MILLIONTHS {
        // Several times as fast as the formatter, which matters in each cycle.
        let millionths = (size * 1e6).round() as u64;
        if value.is_sign_negative() {
            out.push('-');
        }
        write!(out, "{}.{:06}", millionths / 1_000_000, millionths % 1_000_000)
    } else if value.is_finite() {
        write!(out, "{value:.6}")
    } else {
        out.push_str("null");
        Ok(())
    };
}

/// Adds values in brackets.
pub(crate) fn push_array<T>(
    out: &mut String,
    values: impl IntoIterator<Item = T>,
    mut push: impl FnMut(&mut String, T),
) {
    out.push('[');
    for (at, value) in values.into_iter().enumerate() {
        if at > 0 {
            out.push(',');
        }
        push(out, value);
    }
    out.push(']');
}

/// Values in brackets.
pub(crate) fn array<T>(values: impl IntoIterator<Item = T>, write: impl Fn(T) -> String) -> String {
    let mut out = String::new();
    push_array(&mut out, values, |out, value| out.push_str(&write(value)));
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_json_cannot_hold_is_escaped() {
        assert_eq!(quoted("a\"b\\c\n"), "\"a\\\"b\\\\c\\u000a\"");
        assert_eq!(array([1.5, f64::NAN], number), "[1.500000,null]");
    }

    #[test]
    fn numbers_have_six_decimals_whatever_their_size() {
        for value in
            [0.0, -0.0, 1.0, -1.0, 0.000_000_4, -0.000_000_4, 0.1, -179.999_999_6, 123_456.789, 8.9e9, -9.1e9, 1e300]
        {
            assert_eq!(number(value), format!("{value:.6}"));
        }
    }
}
