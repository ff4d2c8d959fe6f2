//! `arl2rs run --pendant`: a live screen of a program that runs.
//!
//! The program is a process of its own, driven by lines (`link.rs`): a screen that hangs does not hold up a robot, and
//! when the screen goes, the robot stops on its path.

mod inside;
mod keys;
mod model;
mod screen;
mod sources;

use arl_terminal::exit::Exit;
use std::path::PathBuf;
use std::process::Command;
use std::time::{Duration, Instant};

use ratatui::crossterm::event::{self, Event};

use crate::link::ProgramLink;
use crate::listen::{self, Hears};
use arl_terminal::failure::Failure;
use arl_terminal::show;
use keys::Wish;
use model::PendantModel;
use sources::Sources;

/// How long the screen waits for a key before it looks for news.
const WAIT: Duration = Duration::from_millis(50);

/// Runs a program of these files behind a screen; its exit code. Others may hear what it does. Once it runs, `lock`,
/// which kept it as it is, is let go.
///
/// # Errors
/// The program cannot be started, or there is no terminal to draw on.
pub fn run<L>(
    mut command: Command,
    (files, lock): (&[PathBuf], L),
    mut hearers: Vec<Box<dyn Hears>>,
) -> Result<Exit, Failure> {
    command.arg("--live").args(listen::wishes(&hearers));
    if !hearers.is_empty() {
        command.args(["--state-interval", listen::STATE_INTERVAL]);
    }
    let program = PathBuf::from(command.get_program());
    let mut link = ProgramLink::start(command).map_err(|error| Failure::io("start", &program, &error))?;
    let mut model = PendantModel::new(Sources::read(files));
    drop(lock);
    let shown = ratatui::try_init().and_then(|mut terminal| {
        show::keep_warnings();
        let shown = show(&mut terminal, &mut link, &mut model, &mut hearers);
        ratatui::try_restore()?;
        shown
    });
    // A program that was left at once ends now.
    drop(link);
    // What the screen took with it.
    model.lasting.iter().for_each(|text| show::say(&format!("{text}\n")));
    show::say_warnings();
    listen::end(hearers, !model.hello.channels.is_empty());
    let code = shown.map_err(|error| Failure::Other(format!("the terminal cannot be used: {error}")))?;
    Ok(Exit::from(code))
}

/// Shows the program until it has ended.
fn show(
    terminal: &mut ratatui::DefaultTerminal,
    link: &mut ProgramLink,
    model: &mut PendantModel,
    hearers: &mut Vec<Box<dyn Hears>>,
) -> std::io::Result<u8> {
    loop {
        // What it said before it ended comes before the end.
        let ended = link.ended();
        // Who hears slowly does not keep people from leaving.
        let until = Instant::now() + WAIT;
        let next = || match ended {
            Some(_) => link.last_lines().next(),
            None => link.line_before(until),
        };
        while let Some(line) = next() {
            if !hearers.is_empty() {
                listen::pass_on(line.clone(), hearers);
            }
            model.hear(line);
        }
        show::take_warnings().iter().for_each(|text| model.warn(text));
        if let Some(code) = ended {
            return Ok(code);
        }
        terminal.draw(|frame| screen::draw(frame, model))?;
        let mut wait = WAIT;
        while event::poll(wait)? {
            // All keys that have come are taken before the screen is drawn again.
            wait = Duration::ZERO;
            let Event::Key(key) = event::read()? else { continue };
            match keys::press(key, model) {
                Some(Wish::Order(order)) => link.order(&order),
                // Asked twice, it does not wait for the robot to stop.
                Some(Wish::Leave) if model.leaving => return Ok(Exit::INTERRUPTED.0),
                Some(Wish::Leave) => {
                    model.leaving = true;
                    link.leave();
                }
                None => {}
            }
        }
    }
}
