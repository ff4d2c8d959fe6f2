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
use std::mem::ManuallyDrop;
use std::path::PathBuf;
use std::process::Command;
use std::sync::mpsc::{Receiver, channel};
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
/// How long a program may take to stop its robot and end once its screen is gone.
const LONGEST_STOP: Duration = Duration::from_secs(10);

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
    let unusable = |error| Failure::Other(format!("the terminal cannot be used: {error}"));
    let interrupts = interrupt::leave_to_the_screen();
    // Without a screen nothing begins. What it reports when it is dropped would fail where nobody is left to read it.
    let mut terminal = ManuallyDrop::new(ratatui::try_init().map_err(unusable)?);
    let started = ProgramLink::start(command).inspect_err(|_| leave_screen(&mut terminal));
    let mut link = started.map_err(|error| Failure::io("start", &program, &error))?;
    link.gets(&interrupts);
    let mut model = PendantModel::new(Sources::read(files));
    drop(lock);
    show::keep_warnings();
    let shown = show(&mut terminal, &mut link, &mut model, &mut subscribers);
    if shown.is_err() {
        end_unseen(&mut link, &mut model, &mut subscribers);
    }
    leave_screen(&mut terminal);
    // A program that was left at once ends now.
    drop(link);
    // Prints what disappeared with the screen.
    model.lasting.iter().for_each(|text| show::say(&format!("{text}\n")));
    show::say_warnings();
    listen::end(subscribers, !model.hello.channels.is_empty());
    shown.map(Exit::from).map_err(unusable)
}

/// Leaves the screen. Its terminal may be gone, which does not matter any more.
fn leave_screen(terminal: &mut ratatui::DefaultTerminal) {
    let _ = terminal.show_cursor();
    let _ = ratatui::try_restore();
}

/// Shows the program until it has ended.
fn show(
    terminal: &mut ratatui::DefaultTerminal,
    link: &mut ProgramLink,
    model: &mut PendantModel,
    subscribers: &mut Vec<Box<dyn Subscriber>>,
) -> std::io::Result<u8> {
    let events = events();
    loop {
        match interrupt::count() {
            0 => {}
            1 if model.leaving => {}
            1 => leave(link, model),
            _ => return Ok(Exit::INTERRUPTED.0),
        }
        let ended = take_lines(link, model, subscribers);
        show::take_warnings().iter().for_each(|text| model.warn(text));
        if let Some(code) = ended {
            return Ok(code);
        }
        terminal.draw(|frame| screen::draw(frame, model))?;
        let mut wait = WAIT;
        while let Ok(event) = events.recv_timeout(wait) {
            // All keys that have come are taken before the screen is drawn again.
            wait = Duration::ZERO;
            let Event::Key(key) = event? else { continue };
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

/// What comes from the terminal. A thread of its own waits for it: it would never be back once the terminal has closed,
/// which drawing finds out.
fn events() -> Receiver<std::io::Result<Event>> {
    let (sender, events) = channel();
    std::thread::spawn(move || {
        loop {
            let event = event::read();
            let is_last = event.is_err();
            if sender.send(event).is_err() || is_last {
                return;
            }
        }
    });
    events
}

/// Takes the lines that have come; returns the program's exit code, if it has ended.
fn take_lines(
    link: &mut ProgramLink,
    model: &mut PendantModel,
    subscribers: &mut Vec<Box<dyn Subscriber>>,
) -> Option<u8> {
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
    ended
}

/// Lets the program stop the robot and end where nothing can be drawn, as on a terminal that has closed.
fn end_unseen(link: &mut ProgramLink, model: &mut PendantModel, subscribers: &mut Vec<Box<dyn Subscriber>>) {
    leave(link, model);
    let last = Instant::now() + LONGEST_STOP;
    while take_lines(link, model, subscribers).is_none() && Instant::now() < last && interrupt::count() < 2 {
        std::thread::sleep(WAIT);
    }
}

/// Lets the program stop the robot and end.
fn leave(link: &mut ProgramLink, model: &mut PendantModel) {
    model.leaving = true;
    link.leave();
}
