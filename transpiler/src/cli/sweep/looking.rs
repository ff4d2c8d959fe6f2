//! Looks for collisions in the runs of a worker: each of them connects to a listener of its own, and says in each cycle where the robots are.

use crate::cli::args::RunOptions;
use crate::cli::collide::Scene;
use crate::cli::failure::Failure;
use crate::cli::listen::hear;
use crate::cli::said::Contact;
use crate::cli::scenery::Scenery;
use crate::cli::{robot, run};
use arl_robot::Robot;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The words before those that decide what stands in a cell.
const DECIDING: [&str; 3] = ["--robot", "--cell", "--set"];
/// Where the places of `--set` begin that do.
const PLACES: [&str; 2] = ["robot.", "cell."];
/// How often it is looked whether a run has connected.
const LOOK_INTERVAL: Duration = Duration::from_millis(1);

/// Who looks for collisions.
#[derive(Debug)]
pub(super) struct Looking {
    /// mm; 0: contacts only.
    clearance: f64,
    /// The folder of the worker, which files are named from.
    folder: PathBuf,
    /// What stood in the cell of the last run, and the words that decided it: mostly it is the same again.
    last: Option<(Vec<String>, Scene)>,
}

impl Looking {
    pub(super) fn new(clearance: f64, folder: &Path) -> Self {
        Self { clearance, folder: folder.to_owned(), last: None }
    }

    /// Has `make` make the run of these words and of those that it is given besides; gives what touched, or came too near, with what it gives.
    ///
    /// # Errors
    /// What stands in the cell cannot be read, or this computer has no connection to itself; then nothing ran.
    pub(super) fn look<T>(
        &mut self,
        words: &[String],
        make: impl FnOnce(Vec<String>) -> T,
    ) -> Result<(T, Vec<Contact>), String> {
        let scene = self.scene(words).map_err(|failure| failure.to_string())?;
        // The next run must not find the connection of one that was lost.
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).and_then(|listener| {
            listener.set_nonblocking(true)?;
            Ok((listener.local_addr()?, listener))
        });
        let (address, listener) =
            listener.map_err(|error| format!("this computer has no connection to itself: {error}"))?;
        let asked = ["--listener".into(), address.to_string(), "--each-cycle".into()];
        let (is_over, clearance) = (AtomicBool::new(false), self.clearance);
        Ok(std::thread::scope(|scope| {
            let heard = scope.spawn(|| {
                let (watchers, found) = scene.watch(clearance, false);
                if let Some(stream) = accept(&listener, &is_over) {
                    hear(stream, watchers);
                }
                std::mem::take(&mut found.borrow_mut().contacts)
            });
            let made = make(words.iter().cloned().chain(asked).collect());
            is_over.store(true, Ordering::Release);
            (made, heard.join().unwrap_or_default())
        }))
    }

    fn scene(&mut self, words: &[String]) -> Result<Scene, Failure> {
        let deciding = deciding(words);
        if let Some((_, scene)) = self.last.as_ref().filter(|(last, _)| *last == deciding) {
            return Ok(scene.clone());
        }
        let options = self.options(&deciding);
        let robot = robot::load_with(options.robot.as_deref(), &options.changed()?)?;
        // What cannot be read of a robot was told when the sweep began.
        let scene = Scene::of(&Scenery::with(&run::cell(&options)?, robot, &|_| {})?, &|_| {})?;
        Ok(self.last.insert((deciding, scene)).1.clone())
    }

    /// What comes later goes before.
    fn options(&self, deciding: &[String]) -> RunOptions {
        let mut options = RunOptions::default();
        for pair in deciding.chunks_exact(2) {
            match pair {
                [word, robot] if word == "--robot" => {
                    let is_file = Robot::text(robot).is_none();
                    let file = || self.folder.join(robot).display().to_string();
                    options.robot = Some(if is_file { file() } else { robot.clone() });
                }
                [word, cell] if word == "--cell" => options.cell = Some(self.folder.join(cell)),
                [_, change] => options.changes.push(change.clone()),
                _ => {}
            }
        }
        options
    }
}

/// The words of a run that decide what stands in its cell, in pairs.
fn deciding(words: &[String]) -> Vec<String> {
    let mut all = Vec::new();
    for (word, value) in words.iter().zip(words.iter().skip(1)) {
        let decides = DECIDING.contains(&word.as_str())
            && (word != "--set" || PLACES.iter().any(|place| value.starts_with(place)));
        if decides {
            all.extend([word.clone(), value.clone()]);
        }
    }
    all
}

/// The connection of a run, unless it is over without one.
fn accept(listener: &TcpListener, is_over: &AtomicBool) -> Option<TcpStream> {
    loop {
        // Asked first: a connection that was made before the end is there to be accepted then.
        let was_over = is_over.load(Ordering::Acquire);
        match listener.accept() {
            Ok((stream, _)) => return stream.set_nonblocking(false).ok().map(|()| stream),
            Err(error) if error.kind() == std::io::ErrorKind::WouldBlock && !was_over => {
                std::thread::sleep(LOOK_INTERVAL);
            }
            Err(_) => return None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_decides_about_a_cell_is_what_names_and_changes_it() {
        let words = ["--report", "--script-dir", "script", "--cell", "cell/c.toml", "--robot", "six-10"];
        let changes = ["--set", "global.a=1", "--set", "cell.body.1.at=[1, 2, 3]", "--robot", "named/1/r.toml"];
        let words: Vec<String> = words.into_iter().chain(changes).map(str::to_owned).collect();
        let deciding = deciding(&words);
        assert_eq!(
            deciding,
            [
                "--cell",
                "cell/c.toml",
                "--robot",
                "six-10",
                "--set",
                "cell.body.1.at=[1, 2, 3]",
                "--robot",
                "named/1/r.toml"
            ]
        );
        let options = Looking::new(0.0, Path::new("/w")).options(&deciding);
        assert_eq!(options.robot.as_deref(), Some("/w/named/1/r.toml"));
        assert_eq!(options.cell.as_deref(), Some(Path::new("/w/cell/c.toml")));
        assert_eq!(options.changes, ["cell.body.1.at=[1, 2, 3]"]);
    }
}
