//! Programs that this command runs itself, from their code.

use arl_code::{Bundle, BundledProgram};
use arl_engine::Engine;
use arl_rt::emit::program_main;
use arl_rt::program::{Make, Other, Program};
use arl_terminal::exit::Exit;
use arl_terminal::failure::Failure;
use std::ffi::OsString;
use std::path::Path;
use std::sync::Arc;
use std::time::SystemTime;

/// Runs the code in a file, with the options of a compiled program.
pub(crate) fn run(file: &Path, words: Vec<OsString>) -> Result<Exit, Failure> {
    let bytes = std::fs::read(file).map_err(|error| Failure::io("read", file, &error))?;
    let bundle = Bundle::from_bytes(&bytes).map_err(|error| Failure::Other(format!("{}: {error}", file.display())))?;
    let made = file.metadata().and_then(|about| about.modified()).unwrap_or_else(|_| SystemTime::now());
    Ok(Exit(run_bundle(bundle, words, made)))
}

fn run_bundle(bundle: Bundle, words: Vec<OsString>, made: SystemTime) -> u8 {
    program_main::drivers(arl_drivers::connect);
    let Bundle { folder, main, others } = bundle;
    let others: Vec<Other> = others.into_iter().map(other).collect();
    let main = Arc::new(main);
    program_main::main_within(words, || Engine::new(Arc::clone(&main)), &others, &folder, made)
}

/// A program of the cell. It lives as long as the process, as that of a compiled program does.
fn other(BundledProgram { file, folder, code }: BundledProgram) -> Other {
    let code = Arc::new(code);
    let make: Make = Box::leak(Box::new(move || Box::new(Engine::new(Arc::clone(&code))) as Box<dyn Program>));
    Other { file: file.leak(), folder: folder.leak(), make }
}
