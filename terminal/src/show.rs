//! The output of the command on standard error.

use anstream::ColorChoice;
use std::io::Write;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Shows an error of the command itself.
pub fn error(text: &str) {
    say(&format!("\u{1b}[1m\u{1b}[91merror\u{1b}[0m\u{1b}[1m: {text}\u{1b}[0m\n"));
}

/// Warnings kept for a screen, while one uses the terminal.
static FOR_A_SCREEN: Mutex<Option<Vec<String>>> = Mutex::new(None);

/// From now on warnings are kept for a screen, which [takes](take_warnings) them.
pub fn keep_warnings() {
    *FOR_A_SCREEN.lock().unwrap_or_else(PoisonError::into_inner) = Some(Vec::new());
}

/// The warnings kept since the last call.
pub fn take_warnings() -> Vec<String> {
    FOR_A_SCREEN.lock().unwrap_or_else(PoisonError::into_inner).as_mut().map(std::mem::take).unwrap_or_default()
}

/// From now on warnings are shown at once again; those that were kept and not taken are shown now.
pub fn say_warnings() {
    let kept = FOR_A_SCREEN.lock().unwrap_or_else(PoisonError::into_inner).take();
    kept.unwrap_or_default().iter().for_each(|text| warning(text));
}

/// Shows a warning of the command itself, or keeps it for a screen.
pub fn warning(text: &str) {
    if let Some(kept) = &mut *FOR_A_SCREEN.lock().unwrap_or_else(PoisonError::into_inner) {
        return kept.push(text.to_owned());
    }
    say(&format!("\u{1b}[1m\u{1b}[93mwarning\u{1b}[0m\u{1b}[1m: {text}\u{1b}[0m\n"));
}

/// A path in its shortest form relative to the current directory.
pub fn path(path: &Path) -> &Path {
    let here = std::env::current_dir().unwrap_or_default();
    let shown = path.strip_prefix(&here).unwrap_or(path);
    if shown.as_os_str().is_empty() { Path::new(".") } else { shown }
}

/// Writes text that may have colours, without them if they are not wanted.
pub fn say(rendered: &str) {
    // If it cannot be written, nobody could read it; the exit code is enough.
    let _ = anstream::stderr().lock().write_all(rendered.as_bytes());
}

/// Whether standard error is a terminal, with colours enabled.
pub fn is_watched() -> bool {
    use std::io::IsTerminal;
    std::io::stderr().is_terminal() && anstream::AutoStream::choice(&std::io::stderr()) != ColorChoice::Never
}
