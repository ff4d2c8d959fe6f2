//! The diagnostics of a file, in the form of the protocol.

use super::programs::Program;
use super::server::Server;
use arl2rs::check::NOT_NEEDED;
use arl2rs::compile::Bug;
use arl2rs::diagnostics::{Diagnostic as Found, Severity};
use gen_lsp_types::*;
use std::path::Path;

/// The most diagnostics that are sent for a file: nobody reads more, and thousands make editors slow.
pub(super) const MOST_SENT: usize = 1000;

/// The diagnostics of a file, errors first where there are too many.
pub(super) fn of(server: &Server, path: &Path) -> Vec<Diagnostic> {
    if let Err(bug) = server.check(path) {
        return vec![of_bug(&bug)];
    }
    let Some(file) = server.file(path) else { return Vec::new() };
    let here = |found: &&Found| found.primary.at.file == file.id;
    let mut found: Vec<&Found> = file.program.checked.diagnostics.iter().filter(here).collect();
    if found.len() > MOST_SENT {
        found.sort_by_key(|one| std::cmp::Reverse(one.severity));
        found.truncate(MOST_SENT);
    }
    found.into_iter().filter_map(|one| diagnostic(server, &file.program, one)).collect()
}

/// The diagnostic where the compiler itself failed: nothing else is known then.
pub(super) fn of_bug(bug: &Bug) -> Diagnostic {
    Diagnostic {
        severity: Some(DiagnosticSeverity::Error),
        source: Some("arl2rs".into()),
        message: Message::String(bug.to_string()),
        ..Diagnostic::default()
    }
}

/// One diagnostic: its message, the words at the place, and what would be right.
fn diagnostic(server: &Server, program: &Program, found: &Found) -> Option<Diagnostic> {
    let at = server.location(program, found.primary.at)?;
    let related = found.labels.iter().filter_map(|label| {
        let location = server.location(program, label.at)?;
        Some(DiagnosticRelatedInformation { location, message: label.text.clone() })
    });
    let related: Vec<_> = related.collect();
    let severity = match found.severity {
        Severity::Error => DiagnosticSeverity::Error,
        Severity::Warning => DiagnosticSeverity::Warning,
    };
    // Editors show it pale.
    let tags = NOT_NEEDED.contains(&found.code.0).then(|| vec![DiagnosticTag::Unnecessary]);
    Some(Diagnostic {
        range: at.range,
        severity: Some(severity),
        code: Some(Code::String(found.code.to_string())),
        source: Some("arl2rs".into()),
        message: Message::String(message(found)),
        tags,
        related_information: (!related.is_empty()).then_some(related),
        ..Diagnostic::default()
    })
}

fn message(found: &Found) -> String {
    let mut text = found.message.clone();
    if !found.primary.text.is_empty() {
        text.push_str(&format!("\n{}", found.primary.text));
    }
    if let Some(help) = &found.help {
        text.push_str(&format!("\nhelp: {help}"));
    }
    text
}
