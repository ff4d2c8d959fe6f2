//! `arl2rs run`

use super::args::RunOptions;
use super::failure::Failure;
use super::program::{Ready, prepare};
use std::path::Path;
use std::process::{Command, ExitCode};

/// Compiles where needed, then lets the program take over.
pub(super) fn run(file: &Path, options: &RunOptions) -> Result<ExitCode, Failure> {
    let ready = prepare(file, &options.checking())?;
    let mut command = Command::new(&ready.program);
    command.args(options.arguments());
    start(command, ready)
}

/// The program takes the place of this process: signals, streams and exit code are its own.
#[cfg(unix)]
fn start(mut command: Command, ready: Ready) -> Result<ExitCode, Failure> {
    use std::os::unix::process::CommandExt;
    let Ready { program, lock } = ready;
    let error = command.exec();
    drop(lock);
    Err(Failure::io("start", &program, &error))
}

/// The program runs while this process waits. Ctrl-C reaches both; only the program acts on it.
#[cfg(not(unix))]
fn start(mut command: Command, ready: Ready) -> Result<ExitCode, Failure> {
    super::cargo::leave_interrupts_to_the_program();
    let fail = |error: std::io::Error| Failure::io("start", &ready.program, &error);
    let mut child = command.spawn().map_err(fail)?;
    drop(ready.lock);
    let status = child.wait().map_err(fail)?;
    Ok(ExitCode::from(u8::try_from(status.code().unwrap_or(1)).unwrap_or(1)))
}
