//! The `arl2rs` command.

mod args;
mod check;
mod clean;
mod collisions;
mod emit;
mod engine;
mod explain;
mod fmt;
pub mod host;
mod new;
mod parameters;
mod run;
mod sweep;
mod test;
mod variables;
mod view;

use args::{Cli, Command};
use arl_editor::{dap, lsp};
use arl_project::{listing, robots};
use arl_rt::emit::interrupts::{self, Interrupts};
use arl_runs::{report, urdf};
use arl_terminal::exit::Exit;
use arl_terminal::failure::Failure;
use arl_terminal::{answer, interrupt};
use arl2rs::compile::{guard, on_large_stack, remember_panics};
use clap::Parser;
use std::ffi::OsString;
use std::process::ExitCode;
use std::time::Instant;

/// Executes the command line of this process.
pub fn main() -> ExitCode {
    ExitCode::from(command(std::env::args_os()))
}

/// Executes these words, the first of which is the name of the command; returns the exit code: 0 done, 1 compile
/// errors, 2 usage, 3 alarm, 4 out of time, 130 interrupted. On Unix a program that is run may take the place of this
/// process.
pub fn command(words: impl IntoIterator<Item = OsString>) -> u8 {
    let cli = match Cli::try_parse_from(words) {
        Ok(cli) => cli,
        Err(error) => {
            // If the message cannot be printed, the exit code is enough.
            let _ = error.print();
            return u8::try_from(error.exit_code()).unwrap_or(Exit::USAGE.0);
        }
    };
    if let Command::Engine { bundle, words } = cli.command {
        return engine::run(&bundle, words).unwrap_or_else(|failure: Failure| failure.report()).0;
    }
    remember_panics();
    let mut interrupts = Interrupts::default();
    let take = move |is_hang_up| interrupts.take(is_hang_up, Instant::now());
    interrupt::end_the_command(interrupts::minds_hang_up(), take);
    let done = on_large_stack(|| guard(|| dispatch(cli.command)));
    let failed = |failure: Failure| failure.report();
    done.map_or_else(|bug| failed(Failure::Other(bug.to_string())), |done| done.unwrap_or_else(failed)).0
}

fn dispatch(command: Command) -> Result<Exit, Failure> {
    match command {
        Command::Check { files, format, max_errors, collisions, clearance, checking } => {
            let look = collisions.then(|| collisions::Look { format, clearance: clearance.unwrap_or_default() });
            check::check(&files, format, listing::Limit::of(max_errors), look, &checking)
        }
        Command::Emit { file, out, checking } => done(emit::emit(&file, out.as_deref(), &checking)),
        Command::Build { file, out, release, library, checking } => {
            done(emit::build(&file, out.as_deref(), release, library, &checking))
        }
        Command::Run { file, options } => run::run(&file, &options),
        Command::Plot { trace, plot, robot } => done(run::plot(&trace, &plot, robot.as_deref())),
        Command::Compare { one, other, format } => report::compare(&one, &other, format),
        Command::Sweep { file, options } => sweep::sweep(&file, &options),
        Command::Test { dirs, options } => test::test(&dirs, &options),
        Command::Clean { older } => done(clean::clean(older)),
        Command::Explain { code } => print(explain::explain(&code)),
        Command::Doc { name, search } => print(explain::doc(name.as_deref(), &search)),
        Command::New { folder } => done(new::new(&folder)),
        Command::Fmt { files, check } => fmt::fmt(&files, check),
        Command::View { files, options } => view::view(&files, &options),
        Command::Engine { bundle, words } => engine::run(&bundle, words),
        Command::Lsp => Ok(lsp::lsp()),
        Command::Dap => Ok(dap::dap()),
        Command::Robots { import: Some(file), .. } => print(urdf::import(&file)),
        Command::Robots { name, .. } => print(robots::robots(name.as_deref())),
    }
}

fn done(outcome: Result<(), Failure>) -> Result<Exit, Failure> {
    outcome.map(|()| Exit::SUCCESS)
}

/// Prints the answer of a command that only shows something.
fn print(text: Result<String, Failure>) -> Result<Exit, Failure> {
    let mut text = text?;
    if !text.ends_with('\n') {
        text.push('\n');
    }
    done(answer::write(&text))
}
