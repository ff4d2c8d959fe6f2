//! The line of the program that an alarm is about, where its text is at hand.

use std::path::Path;

/// Files that are longer are not looked into.
const LARGEST_FILE: u64 = 16 << 20;

/// The line of a file, as it is shown below an alarm: its number and its text. Nothing where the file is not there any
/// more, or was changed after the program was compiled.
pub(crate) fn source_line(file: &Path, line: u32) -> Option<String> {
    let about = file.metadata().ok().filter(|about| about.is_file() && about.len() <= LARGEST_FILE)?;
    let compiled = std::env::current_exe().ok()?.metadata().ok()?.modified().ok()?;
    if about.modified().ok()? > compiled {
        return None;
    }
    let bytes = std::fs::read(file).ok()?;
    let text = arl_lang::text::decode(&bytes).ok()?;
    let found = text.lines().nth((line as usize).checked_sub(1)?)?.trim();
    (!found.is_empty()).then(|| format!("  {line} | {found}"))
}
