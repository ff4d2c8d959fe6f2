//! `--bless`: the actual results become the expected ones.

use super::case::Case;
use super::execute::Outcome;
use super::expect::{FoundError, find_alarm};
use arl_terminal::show;
use std::path::Path;

/// Writes the results of a case that runs into its `.out` and `.alarm`. Fails if they cannot be expected results.
pub(super) fn run(case: &Case, came: &Outcome) -> Result<(), String> {
    let alarm = find_alarm(&came.stderr);
    let ended = match came.code {
        Some(0) => true,
        Some(4) => case.options.max_time.is_some(),
        Some(3) => alarm.is_some(),
        _ => false,
    };
    if came.late || !ended {
        return Err("so nothing was blessed".into());
    }
    let alarm = alarm.filter(|_| came.code == Some(3));
    if case.out.is_some() || case.is_new || alarm.is_none() {
        write(&case.source, "out", Some(&came.out))?;
    }
    // A case that expects any number continues to do so.
    let any = case.alarm.is_some_and(|alarm| alarm.number.is_none());
    let text = alarm.map(|(number, line)| {
        let number = if any { "*".to_owned() } else { number.to_string() };
        format!("{number} {line}\n").into_bytes()
    });
    write(&case.source, "alarm", text.as_deref())
}

/// Writes the errors that were found into `.err`.
pub(super) fn errors(case: &Case, came: &[FoundError]) -> Result<(), String> {
    if came.is_empty() {
        return Err("it no longer has errors: remove its .err".into());
    }
    let line = |error: &FoundError| {
        // An expected error that was found stays as it was written.
        let mut expected = case.errors.iter().flatten();
        if let Some(known) = expected.find(|known| known.fits(error)) {
            return format!("{} {}", known.line, known.fragment).trim_end().to_owned() + "\n";
        }
        let message = error.text.split("; ").next().unwrap_or_default().replace('\n', " ");
        format!("{} {message}\n", error.line)
    };
    write(&case.source, "err", Some(came.iter().map(line).collect::<String>().as_bytes()))
}

/// Writes a sidecar, or removes it.
fn write(source: &Path, ending: &str, bytes: Option<&[u8]>) -> Result<(), String> {
    let path = source.with_extension(ending);
    let existed = path.exists();
    let outcome = match bytes {
        Some(bytes) => std::fs::write(&path, bytes),
        None if existed => std::fs::remove_file(&path),
        None => Ok(()),
    };
    if outcome.is_ok() && (bytes.is_some() || existed) {
        let done = if bytes.is_some() { "wrote" } else { "removed" };
        show::say(&format!("{done} {}\n", path.display()));
    }
    outcome.map_err(|error| format!("cannot write {}: {error}", path.display()))
}
