//! Runs the code in a file by the engine, with the command line of a compiled program behind its path.

#![allow(clippy::expect_used, reason = "tests stop where something is wrong")]

use arl_code::Bundle;
use arl_engine::Engine;
use arl_rt::emit::program_main::main_within;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::SystemTime;

fn main() -> ExitCode {
    let mut words = std::env::args_os().skip(1);
    let bytes = std::fs::read(words.next().expect("a file")).expect("code");
    let bundle = Bundle::from_bytes(&bytes).expect("code");
    let code = Arc::new(bundle.main);
    let make = || Engine::new(Arc::clone(&code));
    ExitCode::from(main_within(words.collect(), make, &[], &bundle.folder, SystemTime::now(), || false))
}
