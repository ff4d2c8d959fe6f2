//! The `arl2rs` command.
#![expect(clippy::disallowed_methods, reason = "the command reads and writes files and starts processes")]

mod alarms;
mod answer;
mod args;
mod arl_toml;
mod cache;
mod cargo;
mod check;
mod clean;
mod collide;
mod dap;
mod emit;
mod exit;
mod explain;
mod failure;
mod fmt;
mod framing;
#[cfg(any(test, feature = "fuzzing"))]
pub mod fuzzing;
pub mod host;
mod link;
mod listen;
mod lsp;
mod new;
mod pendant;
mod plot;
mod port;
mod private_folder;
mod program;
mod program_path;
mod progress;
mod project;
mod record;
mod recorded;
mod reference;
mod report;
mod robot;
mod robots;
mod run;
mod runtime;
mod said;
mod scenery;
mod several;
mod show;
mod signals;
mod stamp;
mod sweep;
mod test;
mod texts;
mod trouble;
mod urdf;
mod variables;
mod view;

use crate::compile::{guard, on_large_stack, remember_panics};
use args::{Cli, Command};
use clap::Parser;
use exit::Exit;
use failure::{Failure, USAGE};
use std::ffi::OsString;
use std::process::ExitCode;

/// Does what the command line of this process says.
pub fn main() -> ExitCode {
    ExitCode::from(command(std::env::args_os()))
}

/// Does what these words say, the first of which is the name of the command; gives the exit code: 0 done, 1 compile errors, 2 usage, 3 alarm,
/// 4 out of time, 130 interrupted. On Unix a program that runs may take the place of this process.
pub fn command(words: impl IntoIterator<Item = OsString>) -> u8 {
    let cli = match Cli::try_parse_from(words) {
        Ok(cli) => cli,
        Err(said) => {
            // Where nobody can read it, the exit code says enough.
            let _ = said.print();
            return u8::try_from(said.exit_code()).unwrap_or(USAGE);
        }
    };
    remember_panics();
    cargo::end_on_interrupt();
    let done = on_large_stack(|| guard(|| dispatch(cli.command)));
    let failed = |failure: Failure| failure.report();
    done.map_or_else(|bug| failed(bug.into()), |done| done.unwrap_or_else(failed)).0
}

fn dispatch(command: Command) -> Result<Exit, Failure> {
    match command {
        Command::Check { files, format, max_errors, collisions, clearance, checking } => {
            let look = collisions.then(|| collide::Look { format, clearance: clearance.unwrap_or_default() });
            check::check(&files, (format, show::Limit::of(max_errors)), look, &checking)
        }
        Command::Emit { file, out, checking } => done(emit::emit(&file, out.as_deref(), &checking)),
        Command::Build { file, out, release, library, checking } => {
            done(emit::build(&file, out.as_deref(), (release, library), &checking))
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
        Command::Lsp => lsp::lsp(),
        Command::Dap => dap::dap(),
        Command::Robots { import: Some(file), .. } => print(urdf::import(&file)),
        Command::Robots { name, .. } => print(robots::robots(name.as_deref())),
    }
}

fn done(outcome: Result<(), Failure>) -> Result<Exit, Failure> {
    outcome.map(|()| Exit::SUCCESS)
}

/// The answer of a command that only tells something.
fn print(text: Result<String, Failure>) -> Result<Exit, Failure> {
    let mut text = text?;
    if !text.ends_with('\n') {
        text.push('\n');
    }
    done(answer::write(&text))
}
