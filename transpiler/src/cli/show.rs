//! What the command says on standard error.

use crate::compile::Compiled;
use crate::diagnostics::{Diagnostic, Files, Severity};
use crate::render::human;
use anstream::ColorChoice;
use std::io::Write;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// An error of the command itself.
pub(super) fn error(text: &str) {
    say(&format!("\u{1b}[1m\u{1b}[91merror\u{1b}[0m\u{1b}[1m: {text}\u{1b}[0m\n"));
}

/// Warnings that a screen shows, while one has the terminal.
static FOR_A_SCREEN: Mutex<Option<Vec<String>>> = Mutex::new(None);

/// From now on warnings are kept for a screen, which [takes](take_warnings) them.
pub(super) fn keep_warnings() {
    *FOR_A_SCREEN.lock().unwrap_or_else(PoisonError::into_inner) = Some(Vec::new());
}

/// The warnings that were kept since the last time.
pub(super) fn take_warnings() -> Vec<String> {
    FOR_A_SCREEN.lock().unwrap_or_else(PoisonError::into_inner).as_mut().map(std::mem::take).unwrap_or_default()
}

/// From now on warnings are said at once again, and now those that nobody has taken.
pub(super) fn say_warnings() {
    let kept = FOR_A_SCREEN.lock().unwrap_or_else(PoisonError::into_inner).take();
    kept.unwrap_or_default().iter().for_each(|text| warning(text));
}

/// A warning of the command itself.
pub(super) fn warning(text: &str) {
    if let Some(kept) = &mut *FOR_A_SCREEN.lock().unwrap_or_else(PoisonError::into_inner) {
        return kept.push(text.to_owned());
    }
    say(&format!("\u{1b}[1m\u{1b}[93mwarning\u{1b}[0m\u{1b}[1m: {text}\u{1b}[0m\n"));
}

/// A path as short as it can be said from where the command runs.
pub(super) fn path(path: &Path) -> &Path {
    let here = std::env::current_dir().unwrap_or_default();
    let shown = path.strip_prefix(&here).unwrap_or(path);
    if shown.as_os_str().is_empty() { Path::new(".") } else { shown }
}

/// How many diagnostics people are shown by default.
pub(super) const MOST_SHOWN: usize = 50;

/// How many diagnostics may still be shown; none for any number.
pub(super) struct Limit(Option<usize>);

impl Limit {
    /// At most so many; 0 for any number.
    pub(super) fn of(most: usize) -> Self {
        Self((most > 0).then_some(most))
    }

    /// Which of them are shown, in the order of the text: warnings only where all errors are.
    fn take<'a>(&mut self, all: &'a [Diagnostic]) -> Vec<&'a Diagnostic> {
        let Some(left) = &mut self.0 else { return all.iter().collect() };
        let is_error = |diagnostic: &Diagnostic| diagnostic.severity == Severity::Error;
        let mut errors = *left;
        let mut warnings = left.saturating_sub(all.iter().filter(|diagnostic| is_error(diagnostic)).count());
        let fits = |diagnostic: &&Diagnostic| {
            let room = if is_error(diagnostic) { &mut errors } else { &mut warnings };
            let fits = *room > 0;
            *room = room.saturating_sub(1);
            fits
        };
        let shown: Vec<&Diagnostic> = all.iter().filter(fits).collect();
        *left -= shown.len();
        shown
    }
}

impl Default for Limit {
    fn default() -> Self {
        Self::of(MOST_SHOWN)
    }
}

/// Errors and warnings of a program, then how many there were.
pub(super) fn diagnostics(compiled: &Compiled, limit: &mut Limit) {
    say(&rendered(compiled, limit));
}

/// The same as text, with terminal colours.
pub(super) fn rendered(compiled: &Compiled, limit: &mut Limit) -> String {
    let all = &compiled.checked.diagnostics;
    if all.is_empty() {
        return String::new();
    }
    let files = compiled.shown_files();
    let shown = limit.take(all);
    let mut text: String = shown.iter().map(|diagnostic| human(diagnostic, &files, true) + "\n").collect();
    text += &summary(all, shown.len(), &files);
    text
}

/// `error: pick.arl: 2 errors, 1 warning`
fn summary(all: &[Diagnostic], shown: usize, files: &Files) -> String {
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
    let rest = match all.len() - shown {
        0 => String::new(),
        rest => format!("; {rest} of them not shown: `arl2rs check --max-errors 0` shows all"),
    };
    format!("\u{1b}[1m\u{1b}[{style}m{word}\u{1b}[0m\u{1b}[1m: {main}: {}{rest}\u{1b}[0m\n", parts.join(", "))
}

fn plural(count: usize, word: &str) -> String {
    if count == 1 { format!("1 {word}") } else { format!("{count} {word}s") }
}

/// Says text that may have colours, without them where they are not wanted.
pub(super) fn say(rendered: &str) {
    // Where nobody can read it there is nobody to tell; the exit code says enough.
    let _ = anstream::stderr().lock().write_all(rendered.as_bytes());
}

/// Whether standard error is a terminal that somebody looks at.
pub(super) fn is_watched() -> bool {
    use std::io::IsTerminal;
    std::io::stderr().is_terminal() && anstream::AutoStream::choice(&std::io::stderr()) != ColorChoice::Never
}
