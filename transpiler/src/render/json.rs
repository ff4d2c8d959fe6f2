//! Diagnostics as JSON, one object per line.

use super::{Position, severity_word};
use crate::diagnostics::{Diagnostic, Files};
use std::fmt::Write;

/// One line without its line end: an object with code, severity, message, file, line, column, end_line, end_column and
/// help (a string or null). Lines and columns count from 1, columns in characters; the end is after the last character.
pub fn json(diagnostic: &Diagnostic, files: &Files) -> String {
    let at = Position::of(diagnostic.primary.at, files);
    let file = files.get(diagnostic.primary.at.file).map_or("", |file| file.name.as_str());
    let mut text = String::with_capacity(256);
    text.push('{');
    text_member(&mut text, "code", Some(&diagnostic.code.to_string()));
    text_member(&mut text, "severity", Some(severity_word(diagnostic.severity)));
    text_member(&mut text, "message", Some(&diagnostic.message));
    text_member(&mut text, "file", Some(file));
    for (name, number) in
        [("line", at.line), ("column", at.column), ("end_line", at.end_line), ("end_column", at.end_column)]
    {
        // Writing to a string cannot fail.
        let _ = write!(text, ",\"{name}\":{number}");
    }
    text_member(&mut text, "help", diagnostic.help.as_deref());
    text.push('}');
    text
}

fn text_member(out: &mut String, name: &str, value: Option<&str>) {
    if !out.ends_with('{') {
        out.push(',');
    }
    out.push('"');
    *out += name;
    *out += "\":";
    match value {
        Some(value) => quote(out, value),
        None => *out += "null",
    }
}

fn quote(out: &mut String, value: &str) {
    out.push('"');
    let mut rest = value;
    while let Some(at) = rest.bytes().position(|byte| byte < 0x20 || matches!(byte, b'"' | b'\\' | 0x7f)) {
        let (plain, special) = rest.split_at(at);
        *out += plain;
        match special.as_bytes().first() {
            Some(b'"') => *out += "\\\"",
            Some(b'\\') => *out += "\\\\",
            Some(b'\n') => *out += "\\n",
            Some(b'\r') => *out += "\\r",
            Some(b'\t') => *out += "\\t",
            other => {
                // Writing to a string cannot fail.
                let _ = write!(out, "\\u{:04x}", other.copied().unwrap_or_default());
            }
        }
        rest = special.get(1..).unwrap_or_default();
    }
    *out += rest;
    out.push('"');
}
