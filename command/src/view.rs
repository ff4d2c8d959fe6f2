//! `arl2rs view`: a page in the browser that shows a run, of a recording or of a running program.

use crate::args::ViewOptions;
use crate::run;
use arl_project::cache::Kind;
use arl_project::program::prepare;
use arl_project::robots;
use arl_runs::scenery::Scenery;
use arl_runs::view::{self, Page, Program};
use arl_terminal::exit::Exit;
use arl_terminal::failure::Failure;
use arl_terminal::show;
use std::path::{Path, PathBuf};

/// Serves the page: for a program until it ends, for recordings until the command is interrupted.
pub(crate) fn view(files: &[PathBuf], options: &ViewOptions) -> Result<Exit, Failure> {
    let is_program = |file: &Path| file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("arl"));
    let page = Page { port: options.port, opens: !options.no_open };
    match files {
        [program] if is_program(program) => live(program, options, page),
        files => {
            if let Some(program) = files.iter().find(|file| is_program(file)) {
                let text = format!("{} is a program: it can only be shown alone", program.display());
                return Err(Failure::Usage(text));
            }
            if options.is_of_program() {
                let text = "a recording contains its robot, its cell and its program: leave these options out";
                return Err(Failure::Usage(text.to_owned()));
            }
            view::recordings(files, page)
        }
    }
}

fn live(program: &Path, options: &ViewOptions, page: Page) -> Result<Exit, Failure> {
    let options_of_run = options.run().of_program(program)?;
    let cell = run::cell(&options_of_run)?;
    let first = options_of_run.robot.as_deref();
    let robots = robots::of_cell(&cell, robots::load_with(first, &options_of_run.changed()?)?)?;
    let scenery = Scenery::of(&cell, &robots, &show::warning)?;
    let ready = prepare(Kind::Program, program, &options_of_run)?;
    let mut command = ready.command()?;
    command.args(options_of_run.arguments());
    let program = Program {
        name: program.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
        command,
        sources: &ready.sources,
        scenery: &scenery,
        subscribers: run::watchers(&scenery, None)?,
        teaches: options.teach.then_some(robots),
    };
    view::program(program, ready.lock, page)
}
