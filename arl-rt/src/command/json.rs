//! JSON is written by hand: strings, numbers and arrays.

use std::fmt::Write;

/// A text as JSON writes it.
pub(crate) fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04x}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// A number with six decimals; null where it is none.
pub(crate) fn number(value: f64) -> String {
    if value.is_finite() { format!("{value:.6}") } else { "null".into() }
}

/// Values in brackets.
pub(crate) fn array<T>(values: impl IntoIterator<Item = T>, write: impl Fn(T) -> String) -> String {
    let values: Vec<String> = values.into_iter().map(write).collect();
    format!("[{}]", values.join(","))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_json_cannot_hold_is_escaped() {
        assert_eq!(quoted("a\"b\\c\n"), "\"a\\\"b\\\\c\\u000a\"");
        assert_eq!(array([1.5, f64::NAN], number), "[1.500000,null]");
    }
}
