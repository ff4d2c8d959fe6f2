//! Diagnostics as JSON, one object a line.

use super::{Position, severity_word};
use crate::diagnostics::{Diagnostic, Files};
use std::fmt::Write;

/// One line without its line end: an object with code, severity, message, file, line, column, end_line, end_column and
/// help (a string or null). Lines and columns count from 1, columns in characters; the end is behind the last one.
pub fn json(diagnostic: &Diagnostic, files: &Files) -> String {
    let at = Position::of(diagnostic.primary.at, files);
    let file = files.get(diagnostic.primary.at.file).map_or("", |file| file.name.as_str());
    let mut text = String::from("{");
    text_member(&mut text, "code", Some(&diagnostic.code.to_string()));
    text_member(&mut text, "severity", Some(severity_word(diagnostic.severity)));
    text_member(&mut text, "message", Some(&diagnostic.message));
    text_member(&mut text, "file", Some(file));
    for (name, number) in
        [("line", at.line), ("column", at.column), ("end_line", at.end_line), ("end_column", at.end_column)]
    {
        text += &format!(",\"{name}\":{number}");
    }
    text_member(&mut text, "help", diagnostic.help.as_deref());
    text.push('}');
    text
}

fn text_member(out: &mut String, name: &str, value: Option<&str>) {
    if !out.ends_with('{') {
        out.push(',');
    }
    *out += &format!("\"{name}\":");
    match value {
        Some(value) => quote(out, value),
        None => *out += "null",
    }
}

fn quote(out: &mut String, value: &str) {
    out.push('"');
    for c in value.chars() {
        match c {
            '"' => *out += "\\\"",
            '\\' => *out += "\\\\",
            '\n' => *out += "\\n",
            '\r' => *out += "\\r",
            '\t' => *out += "\\t",
            c if (c as u32) < 0x20 || c == '\u{7f}' => {
                // Writing to a string cannot fail.
                let _ = write!(out, "\\u{:04x}", c as u32);
            }
            c => out.push(c),
        }
    }
    out.push('"');
}
