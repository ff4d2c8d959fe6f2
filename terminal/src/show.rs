//! What the command says on standard error.

use anstream::ColorChoice;
use std::io::Write;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// An error of the command itself.
pub fn error(text: &str) {
    say(&format!("\u{1b}[1m\u{1b}[91merror\u{1b}[0m\u{1b}[1m: {text}\u{1b}[0m\n"));
}

/// Warnings that a screen shows, while one has the terminal.
static FOR_A_SCREEN: Mutex<Option<Vec<String>>> = Mutex::new(None);

/// From now on warnings are kept for a screen, which [takes](take_warnings) them.
pub fn keep_warnings() {
    *FOR_A_SCREEN.lock().unwrap_or_else(PoisonError::into_inner) = Some(Vec::new());
}

/// The warnings that were kept since the last time.
pub fn take_warnings() -> Vec<String> {
    FOR_A_SCREEN.lock().unwrap_or_else(PoisonError::into_inner).as_mut().map(std::mem::take).unwrap_or_default()
}

/// From now on warnings are said at once again, and now those that nobody has taken.
pub fn say_warnings() {
    let kept = FOR_A_SCREEN.lock().unwrap_or_else(PoisonError::into_inner).take();
    kept.unwrap_or_default().iter().for_each(|text| warning(text));
}

/// A warning of the command itself.
pub fn warning(text: &str) {
    if let Some(kept) = &mut *FOR_A_SCREEN.lock().unwrap_or_else(PoisonError::into_inner) {
        return kept.push(text.to_owned());
    }
    say(&format!("\u{1b}[1m\u{1b}[93mwarning\u{1b}[0m\u{1b}[1m: {text}\u{1b}[0m\n"));
}

/// A path as short as it can be said from where the command runs.
pub fn path(path: &Path) -> &Path {
    let here = std::env::current_dir().unwrap_or_default();
    let shown = path.strip_prefix(&here).unwrap_or(path);
    if shown.as_os_str().is_empty() { Path::new(".") } else { shown }
}

/// Says text that may have colours, without them where they are not wanted.
pub fn say(rendered: &str) {
    // Where nobody can read it there is nobody to tell; the exit code says enough.
    let _ = anstream::stderr().lock().write_all(rendered.as_bytes());
}

/// Whether standard error is a terminal that somebody looks at.
pub fn is_watched() -> bool {
    use std::io::IsTerminal;
    std::io::stderr().is_terminal() && anstream::AutoStream::choice(&std::io::stderr()) != ColorChoice::Never
}
