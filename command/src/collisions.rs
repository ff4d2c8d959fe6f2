//! `arl2rs check --collisions`: runs a program on the virtual clock to find what its robots run into.

use std::path::Path;
use std::process::Stdio;

use serde_json::json;

use crate::run;
use arl_project::cache::Kind;
use arl_project::options::{Checking, RunOptions};
use arl_project::program::{Ready, prepare_checked};
use arl_project::robots;
use arl_runs::collide::Scene;
use arl_runs::listen::{Listener, Received};
use arl_runs::scenery::Scenery;
use arl_terminal::answer::{self, Format};
use arl_terminal::exit::Exit;
use arl_terminal::failure::Failure;
use arl_terminal::interrupt;
use arl_terminal::private_folder::PrivateFolder;
use arl_terminal::show;
use arl_wire::Contact;

/// The limit of a run, in controller seconds.
const MOST_SECONDS: f64 = 600.0;
/// The code of a collision, in place of that of a diagnostic.
const CODE: &str = "collision";

/// What to look for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look {
    pub format: Format,
    /// mm; 0: contacts only.
    pub clearance: f64,
}

/// Runs a program with the scenario of its `arl.toml`, and reports what comes too near to each other; returns whether
/// anything does.
///
/// # Errors
/// The program does not begin, or its cell communicates with the outside, which a check must not.
pub(crate) fn check(file: &Path, checking: &Checking, look: Look) -> Result<bool, Failure> {
    let asked = RunOptions {
        robot: checking.robot.clone(),
        cell: checking.cell.clone(),
        script_dir: checking.script_dir.clone(),
        max_time: Some(MOST_SECONDS),
        ..RunOptions::default()
    };
    let state = PrivateFolder::new("arl2rs-state-");
    let state =
        state.map_err(|error| Failure::Other(format!("cannot make a temporary folder for the state: {error}")))?;
    let options = RunOptions { state_dir: Some(state.path().to_path_buf()), ..asked.of_program(file)? };
    let cell = run::cell(&options)?;
    if !cell.islands.is_empty() || cell.buses.modbus_tcp.is_some() {
        let text = "a check does not run a program whose cell has [[island]] or [modbus_tcp]; `arl2rs run` reports collisions, too";
        return Err(Failure::Usage(format!("{}: {text}", file.display())));
    }
    let robots = robots::of_cell(&cell, robots::load(options.robot.as_deref())?)?;
    let scenery = Scenery::of(&cell, &robots, &show::warning)?;
    let (watchers, found) = Scene::of(&scenery, &show::warning)?.watch(look.clearance, false);
    let ready = prepare_checked(Kind::Program, file, &options)?;
    let Ran { code, why, received } = run(ready, &options, Listener::of(watchers)?)?;
    let found = found.borrow();
    if found.begun && received != Received::All {
        let text = "part of its run was not observed: there may be more collisions";
        show::warning(&format!("{}: {text}", file.display()));
    }
    for robot in &found.unchecked {
        show::warning(&format!("{}: {robot}", file.display()));
    }
    match code {
        Some(Exit::SUCCESS) => {}
        Some(Exit::ALARM | Exit::OUT_OF_TIME) if found.begun => {
            let text =
                format!("{}: its run ended with `{why}`: what would come after that is not known", file.display());
            show::warning(&text);
        }
        _ => return Err(Failure::Usage(format!("{}: its run failed: {why}", file.display()))),
    }
    found.contacts.iter().try_for_each(|contact| tell(file, contact, look.format))?;
    Ok(!found.contacts.is_empty())
}

/// The outcome of a run.
struct Ran {
    code: Option<Exit>,
    /// The first line that it wrote that is not a warning.
    why: String,
    received: Received,
}

/// Runs the program.
fn run(ready: Ready, options: &RunOptions, listener: Option<Listener>) -> Result<Ran, Failure> {
    let left = interrupt::leave_to_the_program();
    let mut command = ready.command()?;
    command.args(options.arguments()).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    let fail = |error: std::io::Error| Failure::io("start", &ready.program, &error);
    listener.iter().for_each(|listener| listener.ask(&mut command));
    let mut child = command.spawn().map_err(fail)?;
    left.pass_on_to(&child);
    drop(ready.lock);
    let errors = child.stderr.take();
    let reader = std::thread::spawn(move || errors.and_then(|errors| std::io::read_to_string(errors).ok()));
    let ended = match listener {
        Some(listener) => listener.receive(&mut child),
        None => child.wait().map(|status| (status, Received::All)),
    };
    let printed = reader.join().ok().flatten().unwrap_or_default();
    let words = |line: &&str| !line.starts_with("warning") && !line.trim().is_empty();
    let why = printed.lines().find(words).unwrap_or("it printed no message").trim().to_owned();
    let (status, received) = ended.map_err(fail)?;
    Ok(Ran { code: status.code().and_then(|code| u8::try_from(code).ok()).map(Exit), why, received })
}

fn tell(file: &Path, contact: &Contact, format: Format) -> Result<(), Failure> {
    match format {
        Format::Human => show::error(&contact.to_string()),
        Format::Json => {
            let Contact { time, line, one, other, distance, .. } = contact;
            // Named as in diagnostics: from where the command runs.
            let beside = file.with_file_name(&contact.file);
            let of = if !contact.file.is_empty() && beside.is_file() { &beside } else { file }.display().to_string();
            // Where no motion led, such as to where the robot stands at first, there is no line.
            let line = (*line).max(1);
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
