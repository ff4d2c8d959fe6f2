//! Diagnostics without any decoration, for build scripts and the macro.

use super::Position;
use crate::diagnostics::{Diagnostic, Files};

/// One line: `pick.arl:3:5: ARL0203: message; help`.
pub fn plain(diagnostic: &Diagnostic, files: &Files) -> String {
    let at = Position::of(diagnostic.primary.at, files);
    let name = files.get(diagnostic.primary.at.file).map_or("?", |file| file.name.as_str());
    let help = diagnostic.help.as_deref().map(|help| format!("; {help}")).unwrap_or_default();
    let text = format!("{name}:{}:{}: {}: {}{help}", at.line, at.column, diagnostic.code, diagnostic.message);
    text.replace(['\n', '\r'], " ")
}

/// Several lines, without the word for the severity: what is wrong, the source line with a mark under the position,
/// other positions, what would be correct.
pub fn plain_block(diagnostic: &Diagnostic, files: &Files) -> String {
    let at = Position::of(diagnostic.primary.at, files);
    let mut text = format!("{}: {}\n", diagnostic.code, diagnostic.message);
    let width = at.line.to_string().len();
    if let Some(file) = files.get(diagnostic.primary.at.file) {
        text += &format!("{:width$}--> {}:{}:{}\n", "", file.name, at.line, at.column);
        let line = file.lines.line_span(&file.text, at.line).map_or("", |span| span.text(&file.text));
        let line = line.trim_end_matches(['\n', '\r']);
        if !line.is_empty() && line.len() <= 300 {
            text += &mark(line, at, width, &diagnostic.primary.text);
        }
    }
    for label in &diagnostic.labels {
        let other = Position::of(label.at, files);
        let name = files.get(label.at.file).map_or("?", |file| file.name.as_str());
        text += &format!("{:width$} = note: {name}:{}:{}: {}\n", "", other.line, other.column, label.text);
    }
    if let Some(help) = &diagnostic.help {
        text += &format!("{:width$} = help: {help}\n", "");
    }
    text
}

/// The line with carets under the position. Tabs stay tabs in the line of carets, so that both lines align.
fn mark(line: &str, at: Position, width: usize, label: &str) -> String {
    let before = at.column.saturating_sub(1) as usize;
    let lead: String = line.chars().take(before).map(|c| if c == '\t' { '\t' } else { ' ' }).collect();
    let rest = line.chars().count().saturating_sub(before);
    let wanted = if at.end_line == at.line { at.end_column.saturating_sub(at.column) as usize } else { rest };
    let carets = "^".repeat(wanted.min(rest).max(1));
    let label = if label.is_empty() { String::new() } else { format!(" {label}") };
    format!("{:width$} |\n{} | {line}\n{:width$} | {lead}{carets}{label}\n", "", at.line, "")
}
