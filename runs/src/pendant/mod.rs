//! `arl2rs run --pendant`: a live screen of a program that runs.
//!
//! The program is a process of its own, driven by lines (`link.rs`): a screen that hangs does not hold up a robot, and
//! when the screen ends, the robot stops on its path.

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
use crate::listen::{self, Subscriber};
use arl_terminal::failure::Failure;
use arl_terminal::interrupt;
use arl_terminal::show;
use keys::Wish;
use model::PendantModel;
use sources::Sources;

/// How long the screen waits for a key before it looks for new lines of the program.
const WAIT: Duration = Duration::from_millis(50);

/// Runs a program made from these files with a screen; returns its exit code. `subscribers` get its lines, too. Once
/// the program runs, `lock`, which kept it unchanged, is released.
///
/// # Errors
/// The program cannot be started, or there is no terminal to draw on.
pub fn run<L>(
    mut command: Command,
    files: &[PathBuf],
    lock: L,
    mut subscribers: Vec<Box<dyn Subscriber>>,
) -> Result<Exit, Failure> {
    command.arg("--live").args(listen::wishes(&subscribers));
    if !subscribers.is_empty() {
        command.args(["--state-interval", listen::STATE_INTERVAL]);
    }
    let program = PathBuf::from(command.get_program());
    let mut link = ProgramLink::start(command).map_err(|error| Failure::io("start", &program, &error))?;
    let mut model = PendantModel::new(Sources::read(files));
    drop(lock);
    let shown = ratatui::try_init().and_then(|mut terminal| {
        show::keep_warnings();
        let shown = show(&mut terminal, &mut link, &mut model, &mut subscribers);
        ratatui::try_restore()?;
        shown
    });
    // A program that was left at once ends now.
    drop(link);
    // Prints what disappeared with the screen.
    model.lasting.iter().for_each(|text| show::say(&format!("{text}\n")));
    show::say_warnings();
    listen::end(subscribers, !model.hello.channels.is_empty());
    let code = shown.map_err(|error| Failure::Other(format!("the terminal cannot be used: {error}")))?;
    Ok(Exit::from(code))
}

/// Shows the program until it has ended.
fn show(
    terminal: &mut ratatui::DefaultTerminal,
    link: &mut ProgramLink,
    model: &mut PendantModel,
    subscribers: &mut Vec<Box<dyn Subscriber>>,
) -> std::io::Result<u8> {
    interrupt::leave_to_the_program();
    loop {
        match interrupt::count() {
            0 => {}
            1 if model.leaving => {}
            1 => leave(link, model),
            _ => return Ok(Exit::INTERRUPTED.0),
        }
        // Lines that the program sent before it ended come before the end.
        let ended = link.ended();
        // A slow subscriber does not keep the user from leaving.
        let until = Instant::now() + WAIT;
        let next = || match ended {
            Some(_) => link.last_lines().next(),
            None => link.line_before(until),
        };
        while let Some(line) = next() {
            if !subscribers.is_empty() {
                listen::pass_on(line.clone(), subscribers);
            }
            model.receive(line);
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
                // When asked twice, it does not wait for the robot to stop.
                Some(Wish::Leave) if model.leaving => return Ok(Exit::INTERRUPTED.0),
                Some(Wish::Leave) => leave(link, model),
                None => {}
            }
        }
    }
}

/// Lets the program stop the robot and end.
fn leave(link: &mut ProgramLink, model: &mut PendantModel) {
    model.leaving = true;
    link.leave();
}
