//! What the command says on standard error.

use crate::compile::Compiled;
use crate::diagnostics::{Diagnostic, Files, Severity};
use crate::render::human;
use anstream::{ColorChoice, eprint, eprintln};

/// An error of the command itself.
pub(super) fn error(text: &str) {
    eprintln!("\u{1b}[1m\u{1b}[91merror\u{1b}[0m\u{1b}[1m: {text}\u{1b}[0m");
}

/// A warning of the command itself.
pub(super) fn warning(text: &str) {
    eprintln!("\u{1b}[1m\u{1b}[93mwarning\u{1b}[0m\u{1b}[1m: {text}\u{1b}[0m");
}

/// Errors and warnings of a program, then how many there were.
pub(super) fn diagnostics(compiled: &Compiled) {
    eprint!("{}", rendered(compiled));
}

/// The same as text, with terminal colours.
pub(super) fn rendered(compiled: &Compiled) -> String {
    let all = &compiled.checked.diagnostics;
    if all.is_empty() {
        return String::new();
    }
    let files = compiled.shown_files();
    let mut text: String = all.iter().map(|diagnostic| human(diagnostic, &files, true) + "\n").collect();
    text += &summary(all, &files);
    text
}

/// `error: pick.arl: 2 errors, 1 warning`
fn summary(all: &[Diagnostic], files: &Files) -> String {
    let count = |severity| all.iter().filter(|diagnostic| diagnostic.severity == severity).count();
    let (errors, warnings) = (count(Severity::Error), count(Severity::Warning));
    let main = files.iter().next().map_or("", |(_, file)| file.name.as_str());
    let (word, style) = if errors > 0 { ("error", "91") } else { ("warning", "33") };
    let mut parts = Vec::new();
    if errors > 0 {
        parts.push(plural(errors, "error"));
    }
    if warnings > 0 {
        parts.push(plural(warnings, "warning"));
    }
    format!("\u{1b}[1m\u{1b}[{style}m{word}\u{1b}[0m\u{1b}[1m: {main}: {}\u{1b}[0m\n", parts.join(", "))
}

fn plural(count: usize, word: &str) -> String {
    if count == 1 { format!("1 {word}") } else { format!("{count} {word}s") }
}

/// Shows text that was rendered before, without colours where they are not wanted.
pub(super) fn again(rendered: &str) {
    eprint!("{rendered}");
}

/// Whether standard error is a terminal that somebody looks at.
pub(super) fn is_watched() -> bool {
    use std::io::IsTerminal;
    std::io::stderr().is_terminal() && anstream::AutoStream::choice(&std::io::stderr()) != ColorChoice::Never
}
