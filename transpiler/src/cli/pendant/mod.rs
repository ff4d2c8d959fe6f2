//! `arl2rs run --pendant`: a live screen of a program that runs.
//!
//! The program is a process of its own, driven by lines ([`Link`]): a screen that hangs does not hold up a robot, and when
//! the screen goes, the robot stops on its path.

mod inside;
mod keys;
mod model;
mod screen;
mod sources;

use std::process::{Command, ExitCode};
use std::time::Duration;

use ratatui::crossterm::event::{self, Event};

use super::failure::{Failure, INTERRUPTED};
use super::link::Link;
use super::program::Ready;
use super::show;
use keys::Wish;
use model::{Model, Weight};
use sources::Sources;

/// How long the screen waits for a key before it looks for news.
const WAIT: Duration = Duration::from_millis(50);

/// Runs the program behind a screen; its exit code.
pub(super) fn run(mut command: Command, ready: Ready) -> Result<ExitCode, Failure> {
    command.arg("--live");
    let mut link = Link::start(command).map_err(|error| Failure::io("start", &ready.program, &error))?;
    let mut model = Model::new(Sources::read(&ready.sources));
    drop(ready.lock);
    let shown = ratatui::try_init().and_then(|mut terminal| {
        let shown = show(&mut terminal, &mut link, &mut model);
        ratatui::try_restore()?;
        shown
    });
    let code = shown.map_err(|error| Failure::Other(format!("the terminal cannot be used: {error}")))?;
    // What the screen took with it, and somebody may want to copy.
    for (_, text) in model.log.iter().filter(|(weight, _)| *weight == Weight::Alarm) {
        show::say(&format!("{text}\n"));
    }
    Ok(ExitCode::from(code))
}

/// Shows the program until it has ended.
fn show(terminal: &mut ratatui::DefaultTerminal, link: &mut Link, model: &mut Model) -> std::io::Result<u8> {
    loop {
        // What it said before it ended comes before the end.
        let ended = link.ended();
        while let Some(line) = link.line() {
            model.hear(line);
        }
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
                Some(Wish::Leave) if model.leaving => return Ok(INTERRUPTED),
                Some(Wish::Leave) => {
                    model.leaving = true;
                    link.leave();
                }
                None => {}
            }
        }
    }
}
