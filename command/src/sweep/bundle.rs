//! All that runs depend on: the program, as code or compiled, and the files that it reads, by paths that are the same
//! on every machine.

use super::cell_files::CellFiles;
use super::collision_watch::{self, CollisionWatch};
use super::folder::{Folder, Spread};
use super::result::RunResult;
use super::table::Settings;
use crate::parameters::Parameters;
use crate::variables;
use arl_lang::files::is_data;
use arl_project::cache::Kind;
use arl_project::cell_programs;
use arl_project::options::{EngineChoice, RunOptions};
use arl_project::program::{prepare, state_of_command};
use arl_robot::{Robot, regular_file};
use arl_terminal::failure::Failure;
use arl_terminal::port::Secret;
use arl_terminal::show;
use arl2rs::check::clean;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use twox_hash::XxHash3_128;

/// The most files of a program's folder that go along with its runs, and the most bytes.
const MOST_FILES: usize = 2000;
const MOST_BYTES: usize = 64 << 20;
/// The default limit of a run in the robot's time: s.
pub const MAX_TIME: f64 = 3600.0;
/// The folder of the program's files in a bundle.
pub(super) const SCRIPT: &str = "script";
/// Files that belong to a program without being named: programs and data files, and texts that it reads.
const ENDINGS: [&str; 2] = ["arl", "txt"];
/// The folder of robot files and scenarios.
const NAMED: &str = "named";
/// The compiled program in a bundle.
pub(super) const PROGRAM: &str = "program";
/// The code of the program in a bundle, which the engine of this command runs.
pub(super) const CODE: &str = "code";

/// All that runs depend on except their parameters.
#[derive(Clone, Debug)]
pub struct Bundle {
    /// The files, by their paths in the bundle, with slashes.
    pub files: Vec<(String, Vec<u8>)>,
    /// In mm, if runs look for collisions; 0: for contacts only.
    pub clearance: Option<f64>,
    /// The command-line words that all runs have.
    words: Vec<String>,
    /// Robot files and scenarios.
    named: Vec<NamedFile>,
}

/// A file that is named by settings or parameters.
#[derive(Clone, Debug)]
struct NamedFile {
    /// Its path here, from the root.
    here: PathBuf,
    /// The path that users here are shown.
    shown: String,
    /// Its place in the bundle.
    place: String,
}

impl Bundle {
    /// Compiles the program if needed, and gathers what it reads. `rows` may name robots and scenarios of their own.
    ///
    /// # Errors
    /// There is nothing to compile or to read, or no row has known parameters, which is a slip in a name.
    pub fn new<'p>(settings: &Settings, rows: impl Iterator<Item = &'p Parameters> + Clone) -> Result<Self, Failure> {
        settings.check().map_err(Failure::Usage)?;
        let clearance = settings.clearance();
        let Settings { program, robot, cell, io, script_dir, files, engine, .. } = settings.clone();
        let mut options =
            RunOptions { robot, cell, io, script_dir, engine, ..RunOptions::default() }.of_program(&program)?;
        // Not a compiled program that happens to be there: other computers may lack what it was compiled for.
        options.engine.get_or_insert(EngineChoice::Engine);
        let checking = options.checking();
        variables::refuse_unknown(rows.clone(), &program, options.cell.as_deref(), &checking)?;
        let ready = prepare(Kind::Named, &program, &options)?;
        let runs = match &ready.code {
            Some(code) => (CODE.to_owned(), read(code)?),
            None => (PROGRAM.to_owned(), read(&ready.program)?),
        };
        let sources = ready.sources;
        drop(ready.lock);
        let main = full(&program)?;
        let own = || main.parent().map(Path::to_path_buf).unwrap_or_default();
        let folder = options.script_dir.as_deref().map_or_else(|| Ok(own()), full)?;
        // What a running program reads again has to be there.
        let data = sources.iter().filter(|path| is_data(path)).map(|path| clean(path));
        let others = cell_programs::named(options.cell.as_deref(), options.robot.as_deref())?;
        let others = others.iter().map(|other| full(&other.path)).collect::<Result<Vec<_>, _>>()?;
        if let Some(outside) = data.chain(others).find(|path| !path.starts_with(&folder)) {
            let (outside, folder) = (outside.display(), folder.display());
            let text =
                format!("{outside} lies outside of {folder}: a sweep takes programs and data files from one folder");
            return Err(Failure::Usage(text));
        }
        let mut bundle = Self { files: vec![runs], clearance, words: Vec::new(), named: Vec::new() };
        bundle.add_folder(&folder)?;
        for file in files {
            if !file.components().all(|part| matches!(part, Component::Normal(_))) {
                let text = format!("files: {}: expected a path in {}", file.display(), folder.display());
                return Err(Failure::Usage(text));
            }
            bundle.add_once(format!("{SCRIPT}/{}", with_slashes(&file)), || read(&folder.join(&file)))?;
        }
        bundle.words.extend(["--report", "--script-dir", SCRIPT].map(String::from));
        let cell = options.cell.as_deref().map(full).transpose()?;
        let looks = clearance.is_some();
        let cell = cell.as_ref().map(|cell| CellFiles { cell, script: &folder, looks });
        if let Some(files) = cell {
            let place = files.place(files.cell)?;
            bundle.add_once(place.clone(), || read(files.cell))?;
            bundle.words.extend(["--cell".into(), place]);
        }
        bundle.words.extend(["--max-time".into(), settings.max_time.unwrap_or(MAX_TIME).to_string()]);
        let first =
            [("robot", options.robot.map(Value::from)), ("io", options.io.map(|io| io.display().to_string().into()))];
        let first = Parameters(first.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?))).collect());
        first.files().try_for_each(|file| bundle.add(file))?;
        rows.clone().flat_map(Parameters::files).try_for_each(|file| bundle.add(file))?;
        bundle.words.extend(bundle.file_words(&first));
        let mut words = rows.clone().map(|row| bundle.words(row));
        match words.next() {
            Some(Err(problem)) if words.all(|words| words.is_err()) => return Err(Failure::Usage(problem)),
            _ => drop(words),
        }
        if let Some(files) = cell {
            let words = rows.filter_map(|row| bundle.words(row).ok());
            let words: BTreeSet<Vec<String>> = words.map(|words| collision_watch::naming(&words)).collect();
            bundle.add_cell_files(files, &words)?;
        }
        Ok(bundle)
    }

    /// The words of a run with these parameters; later words take precedence.
    ///
    /// # Errors
    /// A parameter is unknown, or its value is not valid.
    pub fn words(&self, row: &Parameters) -> Result<Vec<String>, String> {
        if row.option("start-time").is_some_and(|time| time == "now") {
            return Err("start-time: a run of a sweep is the same every time, so `now` is not possible".into());
        }
        let mut words = self.words.clone();
        words.extend(self.file_words(row));
        words.extend(row.words()?);
        Ok(words)
    }

    /// The result of a run, with the files by their names here.
    pub fn in_own_names(&self, mut result: RunResult) -> RunResult {
        let alarms = result.alarms.iter_mut().map(|alarm| &mut alarm.text);
        for text in result.problem.iter_mut().chain(alarms) {
            for NamedFile { shown, place, .. } in &self.named {
                if text.contains(place) {
                    *text = text.replace(place, shown);
                }
            }
        }
        result
    }

    /// A number that changes with everything that the runs depend on except their parameters.
    pub fn key(&self) -> String {
        let mut hasher = XxHash3_128::new();
        hasher.write(env!("CARGO_PKG_VERSION").as_bytes());
        if let Some(clearance) = self.clearance {
            hasher.write(b"collisions");
            hasher.write(&clearance.to_le_bytes());
        }
        // A compiled program has its runtime; code is run by this command.
        if self.files.iter().any(|(path, _)| path == CODE) {
            hasher.write(&state_of_command().to_le_bytes());
        }
        // Named files are in the words of a run, under their hash.
        for (path, bytes) in self.files.iter().filter(|(path, _)| !path.starts_with(NAMED)) {
            hasher.write(&(path.len() as u64).to_le_bytes());
            hasher.write(path.as_bytes());
            hasher.write(&(bytes.len() as u64).to_le_bytes());
            hasher.write(bytes);
        }
        format!("{:032x}", hasher.finish_128())
    }

    fn file_words(&self, row: &Parameters) -> Vec<String> {
        let named = ["robot", "io"].into_iter().filter_map(|name| Some((name, row.option(name)?.as_str()?)));
        let words = named.flat_map(|(name, file)| {
            let here = full(Path::new(file)).unwrap_or_default();
            let known = self.named.iter().find(|known| known.here == here);
            [format!("--{name}"), known.map_or_else(|| file.to_owned(), |known| known.place.clone())]
        });
        words.collect()
    }

    /// Adds a robot file or a scenario.
    fn add(&mut self, file: &str) -> Result<(), Failure> {
        let here = full(Path::new(file))?;
        if self.named.iter().any(|known| known.here == here) {
            return Ok(());
        }
        let name = here.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let content = read(&here)?;
        let place = format!("{NAMED}/{:032x}/{name}", XxHash3_128::oneshot(&content));
        if !self.files.iter().any(|(known, _)| *known == place) {
            self.files.push((place.clone(), content));
        }
        let shown = show::path(&here).display().to_string();
        self.named.push(NamedFile { here, shown, place });
        Ok(())
    }

    /// Adds the files that a cell names, by the words that decide which these are, and ensures that they are found
    /// where the runs are made.
    fn add_cell_files(&mut self, files: CellFiles<'_>, all_words: &BTreeSet<Vec<String>>) -> Result<(), Failure> {
        let (mut counts, mut problem) = (Vec::new(), None);
        for words in all_words {
            match files.read(words) {
                Ok(found) => {
                    counts.push((words, found.len()));
                    for (file, content) in found {
                        self.add_once(files.place(&file)?, || Ok(content))?;
                    }
                }
                // If some runs can be made, the others report what is wrong.
                Err(failure) => problem = problem.or(Some(failure)),
            }
        }
        if let Some(problem) = problem.filter(|_| counts.is_empty()) {
            return Err(problem);
        }
        if !files.looks && counts.iter().all(|(_, count)| *count == 0) {
            return Ok(());
        }
        let spread = Spread::new(self).map_err(not_written)?;
        let folder = Folder::new(&spread).map_err(not_written)?;
        let mut watch = CollisionWatch::new(0.0, folder.path(), Secret::new()?);
        for (words, count) in counts {
            files.check(&watch.cell(words)?, folder.path(), count)?;
            match files.looks.then(|| watch.scene(words)) {
                Some(Err(problem)) if all_words.len() == 1 => return Err(Failure::Usage(problem)),
                _ => {}
            }
        }
        Ok(())
    }

    fn add_once(&mut self, place: String, content: impl FnOnce() -> Result<Vec<u8>, Failure>) -> Result<(), Failure> {
        if !self.files.iter().any(|(known, _)| *known == place) {
            self.files.push((place, content()?));
        }
        Ok(())
    }

    /// Adds the files of a folder that belong to a program.
    fn add_folder(&mut self, folder: &Path) -> Result<(), Failure> {
        let mut all = Vec::new();
        gather(folder, &mut all)?;
        all.sort();
        let mut bytes = 0;
        for path in all {
            let content = read(&path)?;
            bytes += content.len();
            if bytes > MOST_BYTES {
                return Err(too_much(folder));
            }
            let below = path.strip_prefix(folder).unwrap_or(&path);
            self.files.push((format!("{SCRIPT}/{}", with_slashes(below)), content));
        }
        Ok(())
    }
}

/// The error for a bundle that cannot be written to the disk.
pub(super) fn not_written(error: std::io::Error) -> Failure {
    Failure::Other(format!("the program of the sweep cannot be written: {error}"))
}

impl Parameters {
    /// The files that the parameters name.
    fn files(&self) -> impl Iterator<Item = &str> {
        let named = ["robot", "io"].into_iter().filter_map(|name| Some((name, self.option(name)?.as_str()?)));
        // What is not a file, and does not look like one, is reported by the run.
        let is_file = |file: &str| Path::new(file).is_file() || file.ends_with(".toml") || file.contains(['/', '\\']);
        let is_robot_file = move |file: &str| Robot::text(file).is_none() && is_file(file);
        named.filter(move |(name, file)| *name == "io" || is_robot_file(file)).map(|(_, file)| file)
    }
}

fn gather(folder: &Path, all: &mut Vec<PathBuf>) -> Result<(), Failure> {
    let entries = std::fs::read_dir(folder).map_err(|error| Failure::io("read", folder, &error))?;
    for entry in entries.filter_map(Result::ok) {
        let (path, name) = (entry.path(), entry.file_name());
        let name = name.to_string_lossy();
        if name.starts_with('.') {
            continue;
        }
        if path.is_dir() {
            if !path.join("CACHEDIR.TAG").is_file() {
                gather(&path, all)?;
            }
        } else if path.is_file()
            && path.extension().is_some_and(|it| ENDINGS.iter().any(|ending| it.eq_ignore_ascii_case(ending)))
        {
            all.push(path);
        }
        if all.len() > MOST_FILES {
            return Err(too_much(folder));
        }
    }
    Ok(())
}

fn too_much(folder: &Path) -> Failure {
    Failure::Usage(format!(
        "{} has more than {MOST_FILES} programs and texts, or more than {} MB of them: they are copied for the runs, so give the program its own folder",
        folder.display(),
        MOST_BYTES >> 20
    ))
}

pub(super) fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    regular_file::read(path).map_err(|error| Failure::io("read", path, &error))
}

/// A path from the root, without `..`.
pub(super) fn full(path: &Path) -> Result<PathBuf, Failure> {
    Ok(clean(&cell_programs::absolute(path)?))
}

pub(super) fn with_slashes(path: &Path) -> String {
    let parts: Vec<_> = path.components().map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
    parts.join("/")
}
