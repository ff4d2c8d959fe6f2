//! Lists the errors and warnings of programs, and their numbers, on standard error.

use arl_terminal::show;
use arl2rs::compile::Compiled;
use arl2rs::diagnostics::{Diagnostic, Files, Severity};
use arl2rs::render::human;

/// The default maximum number of diagnostics shown to people.
pub const MOST_SHOWN: usize = 50;

/// How many more diagnostics may be shown; `None` for no limit.
pub struct Limit(Option<usize>);

impl Limit {
    /// A limit of `most` diagnostics; 0 for no limit.
    pub fn of(most: usize) -> Self {
        Self((most > 0).then_some(most))
    }

    /// The diagnostics that are shown, in the order of the text. Warnings are shown only if all errors are.
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

/// Shows the errors and warnings of a program and their numbers.
pub fn show(compiled: &Compiled, limit: &mut Limit) {
    show::say(&rendered(compiled, limit));
}

/// The same output as text, with terminal colours.
pub fn rendered(compiled: &Compiled, limit: &mut Limit) -> String {
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
