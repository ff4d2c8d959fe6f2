//! Looks for collisions in the runs of a worker: each run connects to a listener of its own, and reports in each cycle
//! where the robots are.

use crate::run;
use arl_project::options::RunOptions;
use arl_project::robots;
use arl_robot::cell::Cell;
use arl_runs::collide::Scene;
use arl_runs::listen::{self, Received, receive};
use arl_runs::scenery::{self, Scenery};
use arl_terminal::failure::Failure;
use arl_terminal::port::{Port, Secret};
use arl_terminal::show;
use arl_wire::Contact;
use arl2rs::check::clean;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// The words before those that decide what is in a cell.
const DECIDING: [&str; 3] = ["--robot", "--cell", "--set"];
/// How the places of `--set` that decide it begin.
const PLACES: [&str; 2] = ["robot.", "cell."];
/// The keys of a cell file that name files.
const NAMING: [&str; 3] = ["mesh", "urdf", "robot"];

/// What touched in a run, or came too near, as far as that is known.
#[derive(PartialEq, Debug)]
pub(super) enum Contacts {
    /// They were not looked for.
    Unasked,
    /// All of them.
    All(Vec<Contact>),
    /// The run was in real time, and could not report all.
    Unknown,
    /// The run was not received from its beginning to its end.
    Broken,
}

/// Looks for collisions.
#[derive(Debug)]
pub(super) struct CollisionWatch {
    /// mm; 0: contacts only.
    clearance: f64,
    /// The secret that the worker's process knows.
    secret: Secret,
    /// The folder of the worker, from which files are named.
    folder: PathBuf,
    /// The scene of the last run, and the words that decided it: mostly it is the same again.
    last: Option<(Vec<String>, Scene)>,
}

impl CollisionWatch {
    /// A value that looks at the runs of a process that works in this folder and knows this secret.
    pub(super) fn new(clearance: f64, folder: &Path, secret: Secret) -> Self {
        Self { clearance, secret, folder: folder.to_owned(), last: None }
    }

    /// Lets `make` make the run of these words and of those that are added to them; returns what touched, with the
    /// result of `make`.
    ///
    /// # Errors
    /// The scene cannot be read, or this computer has no connection to itself; then nothing ran.
    pub(super) fn look<T>(
        &mut self,
        words: &[String],
        make: impl FnOnce(Vec<String>) -> T,
    ) -> Result<(T, Contacts), String> {
        let scene = self.scene(words)?;
        // The next run must not find the connection of a lost run: each run has a port of its own.
        let port = Port::open(self.secret.clone()).map_err(|failure| failure.to_string())?;
        let asked = [listen::OPTION.to_owned(), port.address(), "--each-cycle".to_owned()];
        let words: Vec<String> = words.iter().cloned().chain(asked).collect();
        let (is_over, clearance) = (AtomicBool::new(false), self.clearance);
        Ok(std::thread::scope(|scope| {
            let is_over = &is_over;
            let received = scope.spawn(move || {
                let (watchers, found) = scene.watch(clearance, false);
                let over = || Ok(is_over.load(Ordering::Acquire).then_some(()));
                match port.accept(over).map(|connected| connected.map(|stream| receive(stream, watchers))) {
                    Ok(Ok(Received::All)) => {
                        let found = std::mem::take(&mut *found.borrow_mut());
                        found.unchecked.iter().for_each(|robot| tell_once(&robot.in_any_run()));
                        Contacts::All(found.contacts)
                    }
                    Ok(Ok(Received::WithGaps)) => Contacts::Unknown,
                    _ => Contacts::Broken,
                }
            });
            let made = make(words);
            is_over.store(true, Ordering::Release);
            (made, received.join().unwrap_or(Contacts::Broken))
        }))
    }

    /// The scene of the run of these words. A robot whose shape cannot be read is reported, and has capsules.
    ///
    /// # Errors
    /// Something cannot be read; the message does not name the folder of the worker.
    pub(super) fn scene(&mut self, words: &[String]) -> Result<Scene, String> {
        let deciding = deciding(words);
        if let Some((_, scene)) = self.last.as_ref().filter(|(last, _)| *last == deciding) {
            return Ok(scene.clone());
        }
        let options = self.options(&deciding);
        let without_folder = |text: &str| text.replace(&format!("{}/", self.folder.display()), "");
        let tell = |text: &str| tell_once(&without_folder(text));
        let scene = || {
            // Files elsewhere do not go along with the runs.
            let cell = run::cell(&options)?;
            let outside = scenery::named(&cell).find(|file| !clean(file).starts_with(&self.folder) || !file.is_file());
            if let Some(file) = outside {
                let text = "is not among the files of the sweep: a cell must name shapes by relative paths, in its folder or below";
                return Err(Failure::Usage(format!("{} {text}", file.display())));
            }
            let robot = robots::load_with(options.robot.as_deref(), &options.changed()?)?;
            Scene::of(&Scenery::of(&cell, &robots::of_cell(&cell, robot)?, &tell)?, &tell)
        };
        let scene = scene().map_err(|failure: Failure| without_folder(&failure.to_string()))?;
        Ok(self.last.insert((deciding, scene)).1.clone())
    }

    /// The cell of the run of these words.
    ///
    /// # Errors
    /// It cannot be read, or cannot be changed like that.
    pub(super) fn cell(&self, words: &[String]) -> Result<Cell, Failure> {
        run::cell(&self.options(&deciding(words)))
    }

    /// The options of these words; later words take precedence.
    fn options(&self, deciding: &[String]) -> RunOptions {
        let mut options = RunOptions::default();
        for pair in deciding.chunks_exact(2) {
            match pair {
                [word, robot] if word == "--robot" => {
                    let file = self.folder.join(robot);
                    options.robot = Some(if file.is_file() { file.display().to_string() } else { robot.clone() });
                }
                [word, cell] if word == "--cell" => options.cell = Some(self.folder.join(cell)),
                [_, change] => options.changes.push(change.clone()),
                _ => {}
            }
        }
        options
    }
}

/// The words of a run that decide what is in its cell, in pairs.
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

/// Reports what was not reported before in this process: the runs of a sweep have much in common, and so have sweeps.
fn tell_once(text: &str) {
    static REPORTED: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    if REPORTED.lock().unwrap_or_else(PoisonError::into_inner).insert(text.to_owned()) {
        show::warning(text);
    }
}

/// The words of a run that decide which files its cell names.
pub(super) fn naming(words: &[String]) -> Vec<String> {
    let all = deciding(words);
    let names = |pair: &[String]| {
        let [word, value] = pair else { return false };
        let key = value.split_once('=').map_or("", |(place, _)| place.rsplit('.').next().unwrap_or_default());
        word != "--set" || NAMING.contains(&key.trim())
    };
    all.chunks_exact(2).filter(|pair| names(pair)).flatten().cloned().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

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
        let options = CollisionWatch::new(0.0, Path::new("/w"), Secret::new().unwrap()).options(&deciding);
        assert_eq!(options.robot.as_deref(), Some("named/1/r.toml"), "it is not there");
        assert_eq!(options.cell.as_deref(), Some(Path::new("/w/cell/c.toml")));
        assert_eq!(options.changes, ["cell.body.1.at=[1, 2, 3]"]);
    }

    /// What is found in a run that sends these lines, looked for in a folder without a cell.
    fn found(lines: &str) -> Contacts {
        let mut watch = CollisionWatch::new(0.0, Path::new("/nowhere"), Secret::new().unwrap());
        let secret = watch.secret.clone();
        let run = |words: Vec<String>| {
            assert_eq!((&*words[0], &*words[2]), ("--listener", "--each-cycle"));
            let mut stream = secret.connect(&words[1]).unwrap();
            stream.write_all(lines.as_bytes()).unwrap();
        };
        watch.look(&[], run).unwrap().1
    }

    #[test]
    fn only_who_heard_all_of_a_run_knows_that_nothing_touched() {
        let hello = "{\"hello\":{\"channels\":[],\"names\":{}}}\n";
        let all = format!("{hello}{{\"ended\":0}}\n");
        assert_eq!(found(&all), Contacts::All(Vec::new()));
        assert_eq!(found(&format!("{hello}{{\"ended\":3}}\n")), Contacts::Unknown);
        assert_eq!(found(hello), Contacts::Broken, "its process was lost");
        assert_eq!(found("{\"ended\":0}\n"), Contacts::Broken);
        assert_eq!(found(&format!("{hello}what?\n{{\"ended\":0}}\n")), Contacts::Broken);
        let mut watch = CollisionWatch::new(0.0, Path::new("/nowhere"), Secret::new().unwrap());
        assert_eq!(watch.look(&[], |_| ()), Ok(((), Contacts::Broken)), "it did not connect");
        // The next run is received by itself.
        assert_eq!(found(&all), Contacts::All(Vec::new()));
    }
}
