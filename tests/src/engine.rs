//! Runs programs by the engine.

use crate::project::{Run, checked};
use arl_code::{Bundle, Code};
use arl_engine::Engine;
use arl_rt::{Controller, Message, Outcome, State};
use arl2rs::CheckOptions;
use arl2rs::lower::lower;
use std::cell::RefCell;
use std::path::Path;
use std::process::Command;
use std::rc::Rc;

/// The code of a program, whose main file is the first.
///
/// # Errors
/// The compile errors, a line each; the program is too large.
pub fn lowered(files: &[(String, String)], options: &CheckOptions) -> Result<Code, String> {
    lower(&checked(files, options)?).map_err(|problem| problem.to_string())
}

/// Runs a program in this process, for a minute of the controller's time at most.
pub fn run(code: Code) -> Run {
    let out = Rc::new(RefCell::new(Vec::new()));
    let kept = Rc::clone(&out);
    let output = move |message: &Message<'_>| {
        let mut out = kept.borrow_mut();
        out.extend_from_slice(message.text);
        if !message.text.ends_with(b"\n") {
            out.push(b'\n');
        }
    };
    let mut controller = Controller::builder().output(output).build(Engine::new(code)).expect("a controller");
    let state = controller.run_for(60.0);
    let end = match controller.outcome() {
        _ if state != State::Ended => "still running".into(),
        Some(Outcome::Alarm(alarm)) => {
            format!("alarm {} {} {}", alarm.fault.number(), alarm.file.name(), alarm.line)
        }
        Some(_) => "ended".into(),
        None => "no outcome".into(),
    };
    Run { out: out.take(), end }
}

/// Writes a program for `by_engine`, which runs it as its command line says.
pub fn write(code: Code, file: &Path) {
    let bundle = Bundle { folder: ".".into(), main: code, others: Vec::new() };
    std::fs::write(file, bundle.to_bytes()).expect("a file for a test");
}

/// The command that runs what was written: `by_engine`, a program of this package.
pub fn command(by_engine: &Path, file: &Path, folder: &Path) -> Command {
    let mut command = Command::new(by_engine);
    command.arg(file).current_dir(folder);
    command
}
