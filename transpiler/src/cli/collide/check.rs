//! `arl2rs check --collisions`: runs a program on the virtual clock to find what its robots run into.

use std::path::Path;
use std::process::{Command, Stdio};

use arl_robot::cell::Cell;
use serde_json::json;

use super::super::answer;
use super::super::args::{Checking, Format, RunOptions};
use super::super::failure::Failure;
use super::super::listen::Listener;
use super::super::program::{Ready, prepare};
use super::super::said::Contact;
use super::super::show;
use super::Collisions;

/// A run ends after so many controller seconds.
const MOST_SECONDS: f64 = 3600.0;
/// The code of what is found, where diagnostics have theirs.
const CODE: &str = "collision";

/// What to look for.
#[derive(Clone, Copy, Debug)]
pub(in crate::cli) struct Look {
    pub(in crate::cli) format: Format,
    /// mm; 0: contacts only.
    pub(in crate::cli) clearance: f64,
}

/// Runs a program, and tells what comes too near to each other; whether something does. The scenario is that of its `arl.toml`.
pub(in crate::cli) fn check(file: &Path, checking: &Checking, look: Look) -> Result<bool, Failure> {
    let asked = RunOptions {
        robot: checking.robot.clone(),
        cell: checking.cell.clone(),
        script_dir: checking.script_dir.clone(),
        max_time: Some(MOST_SECONDS),
        ..RunOptions::default()
    };
    let state = std::env::temp_dir().join(format!("arl2rs-state-{}", std::process::id()));
    let options = RunOptions { state_dir: Some(state.clone()), ..asked.of_program(file)? };
    let cell = options.cell.as_deref().map(Cell::load).transpose();
    let cell = cell.map_err(|error| Failure::Usage(error.to_string()))?.unwrap_or_default();
    let (collisions, found) = Collisions::new(&cell, look.clearance, false)?;
    let ready = prepare(file, options.cell.as_deref(), &options.checking())?;
    let ended = run(ready, &options, Listener::of(vec![Box::new(collisions)])?);
    // What it kept goes with it.
    let _ = std::fs::remove_dir_all(&state);
    if let Some(early) = ended? {
        show::warning(&format!("{}: {early}, so what would come behind that is not known", file.display()));
    }
    let found = found.borrow();
    found.iter().try_for_each(|contact| tell(file, contact, look.format))?;
    Ok(!found.is_empty())
}

/// Runs the program to its end; what kept it from there, in the words of the program.
fn run(ready: Ready, options: &RunOptions, listener: Option<Listener>) -> Result<Option<String>, Failure> {
    let mut command = Command::new(&ready.program);
    command.args(options.arguments()).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    let fail = |error: std::io::Error| Failure::io("start", &ready.program, &error);
    listener.iter().try_for_each(|listener| listener.ask(&mut command)).map_err(fail)?;
    let mut child = command.spawn().map_err(fail)?;
    drop(ready.lock);
    let errors = child.stderr.take();
    let reader = std::thread::spawn(move || errors.and_then(|errors| std::io::read_to_string(errors).ok()));
    let status = match listener {
        Some(listener) => listener.hear(&mut child),
        None => child.wait(),
    };
    let said = reader.join().ok().flatten().unwrap_or_default();
    if status.map_err(fail)?.success() {
        return Ok(None);
    }
    let words = |line: &&str| !line.starts_with("warning") && !line.trim().is_empty();
    let why = said.lines().find(words).unwrap_or("it ended early");
    Ok(Some(format!("its run ended with `{}`", why.trim())))
}

fn tell(file: &Path, contact: &Contact, format: Format) -> Result<(), Failure> {
    match format {
        Format::Human => show::error(&contact.to_string()),
        Format::Json => {
            let Contact { time, line, one, other, distance, .. } = contact;
            let line = (*line).max(1);
            let of = if contact.file.is_empty() { file.display().to_string() } else { contact.file.clone() };
            let object = json!({
                "code": CODE, "severity": "error", "message": contact.to_string(), "file": of,
                "line": line, "column": 1, "end_line": line, "end_column": 1, "help": null,
                "time": time, "bodies": [one, other], "distance": distance,
            });
            answer::write(&format!("{object}\n"))?;
        }
    }
    Ok(())
}
