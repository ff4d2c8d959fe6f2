//! `--coverage`: which lines of the programs ran, and how often, as lcov.

use super::case::Case;
use arl_editor::dap::{FileKey, Key, Programs};
use arl_project::options::RunOptions;
use arl_terminal::failure::Failure;
use arl_terminal::show;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// What ran in a file.
#[derive(Default)]
struct File {
    /// How often each line with a statement ran.
    lines: BTreeMap<u32, u64>,
    /// The functions, by the line that they begin at, and how often they began.
    functions: BTreeMap<(u32, String), u64>,
}

/// What ran in all programs.
#[derive(Default)]
pub(super) struct Coverage {
    files: BTreeMap<PathBuf, File>,
}

/// The paths of the files of a case, by their names in its programs.
pub(super) struct Places(BTreeMap<(String, String, String), PathBuf>);

impl Coverage {
    /// Adds the lines of a case's programs: none of them has run yet.
    pub(super) fn add(&mut self, case: &Case) -> Result<Places, String> {
        let (robot, cell, script_dir) = (case.robot.clone(), case.cell.clone(), case.script_dir.clone());
        let options = RunOptions { robot, cell, script_dir, ..RunOptions::default() };
        let mut places = BTreeMap::new();
        for one in Programs::check(&case.source, &options, &|_| {})?.all_lines() {
            let file = self.files.entry(one.path.clone()).or_default();
            file.functions.entry((one.begin, one.function)).or_default();
            for line in &one.lines {
                file.lines.entry(*line).or_default();
            }
            let FileKey { program: Key { folder, main }, file } = one.file;
            places.insert((folder, main, file), one.path);
        }
        Ok(Places(places))
    }

    /// Adds what a run counted: lines of folder, main file, file, line (or the name of a function) and number.
    pub(super) fn count(&mut self, places: &Places, counted: &str) {
        for line in counted.lines() {
            let [folder, main, file, line, count] = line.split('\t').collect::<Vec<_>>()[..] else { continue };
            let key = (folder.to_owned(), main.to_owned(), file.to_owned());
            let (Some(path), Ok(count)) = (places.0.get(&key), count.parse::<u64>()) else { continue };
            let Some(file) = self.files.get_mut(path) else { continue };
            let known = match line.parse() {
                // The line of an event's action need not be one of a statement.
                Ok(line) => file.lines.get_mut(&line),
                Err(_) => file.functions.iter_mut().find(|((_, name), _)| name == line).map(|(_, count)| count),
            };
            known.into_iter().for_each(|known| *known += count);
        }
    }

    /// Writes all of it.
    pub(super) fn write(&self, path: &Path) -> Result<(), Failure> {
        std::fs::write(path, self.lcov()).map_err(|error| Failure::io("write", path, &error))
    }

    fn lcov(&self) -> String {
        let mut text = String::new();
        for (path, file) in &self.files {
            let _ = writeln!(text, "TN:\nSF:{}", show::path(path).display());
            for (begin, name) in file.functions.keys() {
                let _ = writeln!(text, "FN:{begin},{name}");
            }
            for ((_, name), count) in &file.functions {
                let _ = writeln!(text, "FNDA:{count},{name}");
            }
            let hit = file.functions.values().filter(|count| **count > 0).count();
            let _ = writeln!(text, "FNF:{}\nFNH:{hit}", file.functions.len());
            for (line, count) in &file.lines {
                let _ = writeln!(text, "DA:{line},{count}");
            }
            let hit = file.lines.values().filter(|count| **count > 0).count();
            let _ = writeln!(text, "LF:{}\nLH:{hit}\nend_of_record", file.lines.len());
        }
        text
    }
}
