//! Programs that this command runs itself, from their code.

use arl_code::{Bundle, BundledProgram};
use arl_engine::Engine;
use arl_project::program::bug;
use arl_rt::emit::program_main;
use arl_rt::program::{Make, Other, Program};
use arl_terminal::exit::Exit;
use arl_terminal::failure::Failure;
use arl2rs::CheckOptions;
use arl2rs::compile::{Compiled, check_program};
use arl2rs::lower::lower;
use arl2rs::sources::FileSystem;
use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;
use std::time::SystemTime;

/// Checks a program and makes its code, if it is correct.
///
/// # Errors
/// A bug of the compiler, or a program that is too large for the engine.
pub(crate) fn code(file: &Path, options: &CheckOptions) -> Result<(Compiled, Option<arl_code::Code>), Failure> {
    let compiled = check_program(file, &FileSystem, options).map_err(bug)?;
    let code = compiled.checked.program.as_ref().map(lower).transpose();
    let code = code.map_err(|problem| Failure::Other(problem.to_string()))?;
    Ok((compiled, code))
}

/// Runs the code in a file, with the options of a compiled program.
pub(crate) fn run(file: &Path, words: Vec<OsString>) -> Result<Exit, Failure> {
    let bytes = std::fs::read(file).map_err(|error| Failure::io("read", file, &error))?;
    let bundle = Bundle::from_bytes(&bytes).map_err(|error| Failure::Other(format!("{}: {error}", file.display())))?;
    let made = file.metadata().and_then(|about| about.modified()).unwrap_or_else(|_| SystemTime::now());
    Ok(Exit::from(exit_code(run_bundle(bundle, words, made))))
}

fn run_bundle(bundle: Bundle, words: Vec<OsString>, made: SystemTime) -> ExitCode {
    program_main::drivers(arl_drivers::connect);
    let Bundle { folder, main, others } = bundle;
    let others: Vec<Other> = others.into_iter().map(other).collect();
    program_main::main_within(words, || Engine::new(main.clone()), &others, &folder, made)
}

/// A program of the cell. It lives as long as the process, as that of a compiled program does.
fn other(BundledProgram { file, folder, code }: BundledProgram) -> Other {
    let make: Make = Box::leak(Box::new(move || Box::new(Engine::new(code.clone())) as Box<dyn Program>));
    Other { file: file.leak(), folder: folder.leak(), make }
}

/// The number of an exit code.
fn exit_code(code: ExitCode) -> u8 {
    (0..=u8::MAX).find(|number| ExitCode::from(*number) == code).unwrap_or(1)
}
