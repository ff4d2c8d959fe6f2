//! Values as literals that the lexer reads back.

use std::fmt::Write;

/// Appends the shortest literal for this number, with a point or an exponent where it is beyond the 32 bits of an
/// integer.
///
/// ```
/// let mut text = String::new();
/// arl_lang::written::double(0.1, &mut text);
/// arl_lang::written::double(9e9, &mut text);
/// assert_eq!(text, "0.19e9");
/// ```
pub fn double(value: f64, out: &mut String) {
    let plain = value == 0.0 || (1e-5..2e9).contains(&value.abs());
    // Writing to a string does not fail.
    let _ = if plain { write!(out, "{value}") } else { write!(out, "{value:e}") };
}

/// Appends a text in quotes, with the escapes of ARL.
///
/// ```
/// let mut text = String::new();
/// arl_lang::written::string("a \"b\"\n", &mut text);
/// assert_eq!(text, r#""a \"b\"\n""#);
/// ```
pub fn string(value: &str, out: &mut String) {
    out.push('"');
    for c in value.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            '\r' => out.push_str("\\r"),
            c => out.push(c),
        }
    }
    out.push('"');
}
