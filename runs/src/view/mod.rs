//! A page in the browser that shows a run, of a recording or of a running program.
//!
//! The page is in `runs/page/`. It requests what it shows from this server, and sends orders where a program takes
//! them.

mod answer;
mod api;
mod http;
mod live;
mod page;
mod serve;
mod teach;
#[cfg(test)]
mod tests;

use arl_terminal::exit::Exit;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

use arl_robot::Robot;

use crate::listen::Subscriber;
use crate::playback::{self, Store};
use crate::report::{Differences, Summary};
use crate::scenery::Scenery;
use crate::texts;
use answer::{About, Known};
use arl_terminal::failure::Failure;
use arl_terminal::{interrupt, show};
use live::Live;
use serve::{Answer, PageRequest, ToPage};
use teach::Teacher;

/// The most rows that are sent at once.
const MOST_ROWS: usize = 400_000;

/// What is shown: one run, or two side by side.
struct Shown {
    runs: Vec<(String, Arc<Mutex<Store>>)>,
    /// The program of the first run, if it is running.
    live: Option<Live>,
    /// Writes its points, if that is wanted.
    teacher: Option<Teacher>,
}

/// Where the page is served.
#[derive(Clone, Copy, Debug)]
pub struct Page {
    /// The port on this computer; 0: a free one.
    pub port: u16,
    /// Whether to open it in a browser.
    pub opens: bool,
}

/// A program to run, and its subscribers.
pub struct Program<'a> {
    /// Its name on the page.
    pub name: String,
    /// The command that starts it.
    pub command: Command,
    /// Its files.
    pub sources: &'a [PathBuf],
    /// What is in its cell.
    pub scenery: &'a Scenery,
    /// The subscribers that get its lines before the page does.
    pub subscribers: Vec<Box<dyn Subscriber>>,
    /// The robots of its channels, if the page may write its points.
    pub teaches: Option<Vec<Robot>>,
}

/// Shows one or two recordings, until the command is interrupted.
///
/// # Errors
/// A recording cannot be read, or the port is taken.
pub fn recordings(files: &[PathBuf], page: Page) -> Result<Exit, Failure> {
    let name = |file: &Path| file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let runs = files.iter().map(|file| Ok((name(file), Arc::new(Mutex::new(playback::read(file)?)))));
    let shown = Shown { runs: runs.collect::<Result<_, Failure>>()?, live: None, teacher: None };
    let server = serve(&Arc::new(shown), page)?;
    // The server runs forever.
    server.join().map_err(|_| Failure::Other("the server ended".to_owned()))?;
    Ok(Exit::SUCCESS)
}

/// Shows a program until it ends; returns its exit code. Once it runs, `lock`, which kept it unchanged, is released.
///
/// # Errors
/// The program does not start, or the port is taken.
pub fn program<L>(program: Program<'_>, lock: L, page: Page) -> Result<Exit, Failure> {
    let Program { name, command, sources, scenery, subscribers, teaches } = program;
    let teacher = teaches.map(|robots| Teacher::new(robots, sources));
    let store = Store { goes_on: true, sources: texts::read(sources), ..Store::default() };
    let file = PathBuf::from(command.get_program());
    let live = Live::start(command, &subscribers).map_err(|error| Failure::io("start", &file, &error))?;
    drop(lock);
    // The program stops its robot, and this command ends with it.
    let _left = interrupt::leave_to_the_program();
    let store = Arc::new(Mutex::new(store));
    let shown = Arc::new(Shown { runs: vec![(name, Arc::clone(&store))], live: Some(live), teacher });
    let _server = serve(&shown, page)?;
    let code = shown.live.as_ref().map_or(0, |live| live.receive(subscribers, scenery, &store));
    Ok(Exit::from(code))
}

/// Serves the page, prints its address and opens it.
fn serve(shown: &Arc<Shown>, page: Page) -> Result<JoinHandle<()>, Failure> {
    let shown = Arc::clone(shown);
    let to_page = |address| ToPage::new(address, move |asked: &PageRequest<'_>| shown.answer(asked));
    let (address, server) =
        http::serve(page.port, http::Limits::USUAL, to_page).map_err(|error| http::refusal(page.port, &error))?;
    let url = format!("http://{address}/");
    let mut out = std::io::stdout();
    // The standard output may be closed.
    let _ = writeln!(out, "{url}").and_then(|()| out.flush());
    if page.opens && open::that_detached(&url).is_err() {
        show::warning("cannot open a browser: open the address above");
    }
    Ok(server)
}

impl Shown {
    fn answer(&self, asked: &PageRequest<'_>) -> Answer {
        if let Some((kind, bytes)) = page::file(asked.path) {
            return Answer::Bytes(kind, bytes.to_vec());
        }
        match asked.path.strip_prefix("/api/").map(|path| path.split('/').collect::<Vec<_>>()).as_deref() {
            Some(["runs"]) => Answer::json(&self.runs.iter().map(|(name, _)| name).collect::<Vec<_>>()),
            Some(["differences"]) => match &self.runs[..] {
                [(_, one), (_, other)] => {
                    let [one, other] = [one, other].map(|store| Summary::of(&lock(store)));
                    Answer::json(&Differences::between(&one, &other))
                }
                _ => Answer::NotFound,
            },
            Some(["teach", rest @ ..]) => match &self.teacher {
                Some(teacher) => teacher.answer(rest, asked.order),
                None => Answer::Refused("points are only written if the command was started with --teach".to_owned()),
            },
            Some(["order"]) => match (&self.live, asked.order) {
                (Some(live), Some(order)) => live.order(order).map_or_else(Answer::Refused, |()| Answer::json(&())),
                (None, Some(_)) => {
                    Answer::Refused("this is a recording: there is no program that takes orders".to_owned())
                }
                (_, None) => Answer::NotFound,
            },
            Some(["run", number, rest @ ..]) => {
                let run = number.parse::<usize>().ok().and_then(|number| self.runs.get(number));
                let about = |name| About { name, teaches: self.teacher.is_some() };
                run.map_or(Answer::NotFound, |(name, store)| of_run(&lock(store), about(name), rest, asked))
            }
            _ => Answer::NotFound,
        }
    }
}

fn of_run(store: &Store, about: About<'_>, path: &[&str], asked: &PageRequest<'_>) -> Answer {
    match path {
        [] => Answer::json(&answer::run(store, about)),
        ["news"] => Answer::json(&answer::news(store, &known(asked))),
        ["model", number] => match number.parse().ok().and_then(|number: usize| store.meshes.get(number)) {
            Some(bytes) => Answer::Bytes("model/stl", bytes.clone()),
            None => Answer::NotFound,
        },
        ["samples"] => match store.tracks.get(asked.count("channel").wrapping_sub(1)) {
            Some(track) => {
                let span = [asked.number("from").unwrap_or(0.0), asked.number("to").unwrap_or(f64::MAX)];
                let most = asked.number("most").map_or(MOST_ROWS, |most| most as usize).min(MOST_ROWS);
                Answer::Bytes("application/octet-stream", answer::samples(track, span, most))
            }
            None => Answer::NotFound,
        },
        _ => Answer::NotFound,
    }
}

fn known(asked: &PageRequest<'_>) -> Known {
    Known {
        scene: asked.count("scene"),
        controller: asked.count("controller"),
        log: asked.count("log"),
        contacts: asked.count("contacts"),
        motions: asked.count("motions"),
        states: asked.count("states"),
        bases: asked.count("bases"),
        signals: asked.count("signals"),
    }
}

/// A store is valid even if a thread that had locked it panicked.
fn lock(store: &Mutex<Store>) -> MutexGuard<'_, Store> {
    store.lock().unwrap_or_else(PoisonError::into_inner)
}
