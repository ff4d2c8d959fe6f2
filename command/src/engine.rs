//! Programs that this command runs itself, from their code.

use arl_code::{Bundle, BundledProgram, Code};
use arl_engine::Engine;
use arl_rt::emit::program_main;
use arl_rt::program::{Make, Other, Program};
use arl_terminal::exit::Exit;
use arl_terminal::failure::Failure;
use arl_terminal::interrupt;
use std::ffi::OsString;
use std::path::Path;
use std::sync::Arc;
use std::time::SystemTime;

/// Runs the code in a file, with the options of a compiled program.
pub(crate) fn run(file: &Path, words: Vec<OsString>) -> Result<Exit, Failure> {
    let bytes = std::fs::read(file).map_err(|error| Failure::io("read", file, &error))?;
    let bundle = Bundle::from_bytes(&bytes).map_err(|error| Failure::Other(format!("{}: {error}", file.display())))?;
    let made = file.metadata().and_then(|about| about.modified()).unwrap_or_else(|_| SystemTime::now());
    Ok(Exit(run_bundle(bundle, words, made, || false)))
}

/// Runs code that was just made, with the options of a compiled program; `made` is a moment before its sources were
/// read.
pub(crate) fn run_here(bundle: Bundle, words: Vec<OsString>, made: SystemTime) -> Exit {
    let _left = interrupt::leave_to_the_program();
    // A panic of the run says where it happened.
    drop(std::panic::take_hook());
    Exit(run_bundle(bundle, words, made, interrupt::was_pressed))
}

fn run_bundle(bundle: Bundle, words: Vec<OsString>, made: SystemTime, was_interrupted: fn() -> bool) -> u8 {
    let CodeProgram { make, others, folder } = CodeProgram::of(bundle);
    program_main::main_within(words, make, &others, &folder, made, was_interrupted)
}

/// A program from its code, with those that its cells may name.
pub struct CodeProgram {
    /// Makes the program.
    pub make: Box<dyn Fn() -> Box<dyn Program> + Send + Sync>,
    /// The other programs.
    pub others: Vec<Other>,
    /// The folder of its files.
    pub folder: String,
}

impl CodeProgram {
    /// The programs of a bundle. Their code stays as long as the process, as that of compiled programs does.
    pub(crate) fn of(bundle: Bundle) -> Self {
        program_main::drivers(arl_drivers::connect);
        let Bundle { folder, main, others } = bundle;
        Self { make: maker(main), others: others.into_iter().map(other).collect(), folder }
    }
}

fn maker(code: Code) -> Box<dyn Fn() -> Box<dyn Program> + Send + Sync> {
    let code = Arc::new(code);
    Box::new(move || Box::new(Engine::new(Arc::clone(&code))))
}

fn other(BundledProgram { file, folder, code }: BundledProgram) -> Other {
    let make: Make = Box::leak(maker(code));
    Other { file: file.leak(), folder: folder.leak(), make }
}
