//! Several programs in one: the program on the command line and those that its cell file names.

use crate::options::Checking;
use crate::program_path::missing;
use crate::robots;
use arl_robot::Family;
use arl_robot::cell::{Cell, CellChannel};
use arl_terminal::failure::Failure;
use std::path::{Path, PathBuf};

/// A program in addition to the first one.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Other {
    /// Its name in the cell file.
    pub file: String,
    /// Its path.
    pub path: PathBuf,
    /// Its robot, if the cell file names one.
    pub robot: Option<String>,
    /// Whether it has no robot.
    pub background: bool,
}

impl Other {
    /// The options with which it is checked if the first program is checked with `first`.
    pub fn checking(&self, first: &Checking) -> Checking {
        Checking { robot: self.robot.clone(), background: self.background, ..first.clone() }
    }

    /// The folder of its files, relative to that of the main file if it is below it.
    ///
    /// # Errors
    /// The current folder cannot be determined.
    pub fn folder(&self, main: &Path) -> Result<String, Failure> {
        let (main, file) = (absolute(main)?, absolute(&self.path)?);
        let folder = file.parent().unwrap_or(Path::new(""));
        let below = main.parent().and_then(|main| folder.strip_prefix(main).ok());
        Ok(below.unwrap_or(folder).display().to_string())
    }
}

/// The programs that a cell file names; `robot` is the robot of the first program.
///
/// # Errors
/// The file cannot be read, or a channel is not valid: its robot or one of its programs does not exist.
pub fn named(cell: Option<&Path>, robot: Option<&str>) -> Result<Vec<Other>, Failure> {
    let Some(cell) = cell else { return Ok(Vec::new()) };
    let programs = Cell::load(cell).map_err(|error| Failure::Usage(error.to_string()))?.programs;
    let folder = cell.parent().unwrap_or(Path::new(""));
    let mut all = All { cell, folder, others: Vec::new() };
    for file in programs.load {
        all.add(file, Some(robot), None)?;
    }
    for CellChannel { line, program, robot, background, load, .. } in programs.channels {
        let refused = |what: String| Failure::Usage(format!("{}:{line}: {what}", cell.display()));
        if let Some(what) = [&program].into_iter().chain(&load).find_map(|file| missing(&folder.join(file))) {
            return Err(refused(what));
        }
        robots::family(robot.as_deref()).map_err(|error| refused(format!("robot: {error}")))?;
        all.add(program, (!background).then_some(robot.as_deref()), Some(line))?;
        for file in load {
            all.add(file, Some(robot.as_deref()), Some(line))?;
        }
    }
    Ok(all.others.into_iter().map(|(other, _)| other).collect())
}

/// The programs named so far, each with the robot family that it is for, if a channel with a robot runs it.
struct All<'a> {
    cell: &'a Path,
    folder: &'a Path,
    others: Vec<(Other, Option<Family>)>,
}

impl All<'_> {
    /// Adds a program that a channel runs or can load, with this robot (`Some(None)`: the default one) or in the
    /// background (`None`). `line` is the line of the channel.
    fn add(&mut self, file: String, robot: Option<Option<&str>>, line: Option<u32>) -> Result<(), Failure> {
        let family = robot.map(robots::family).transpose()?;
        let Some((known, before)) = self.others.iter_mut().find(|(it, _)| it.file == file) else {
            let path = self.folder.join(&file);
            let (robot, background) = (robot.flatten().map(String::from), robot.is_none());
            self.others.push((Other { file, path, robot, background }, family));
            return Ok(());
        };
        // A program that runs in the background anywhere may do only what is allowed there, wherever it runs.
        known.background |= robot.is_none();
        match (*before, family) {
            (Some(before), Some(family)) if before != family => {
                let place = line.map_or_else(String::new, |line| format!(":{line}"));
                let text = format!(
                    "{}{place}: {file} is for {} here, but for {} elsewhere in this file, but a program is checked for one build of \
                     robot: give each of them its own program",
                    self.cell.display(),
                    kind(family),
                    kind(before),
                );
                return Err(Failure::Usage(text));
            }
            (None, Some(family)) => {
                known.robot = robot.flatten().map(String::from);
                *before = Some(family);
            }
            _ => {}
        }
        Ok(())
    }
}

fn kind(family: Family) -> &'static str {
    match family {
        Family::SixAxis => "a six-axis robot",
        Family::Scara => "a SCARA robot",
    }
}

/// The absolute path, with a message that names the path if there is none.
///
/// # Errors
/// The path is empty, or the current folder cannot be determined.
pub fn absolute(path: &Path) -> Result<PathBuf, Failure> {
    std::path::absolute(path).map_err(|error| Failure::io("use", path, &error))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a cell file names that stands in a folder with some programs.
    fn named_by(name: &str, text: &str, robot: Option<&str>) -> Result<Vec<Other>, Failure> {
        let folder = std::env::temp_dir().join(format!("arl2rs-cell-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        for file in ["a.arl", "b.arl", "r.arl", "s.arl", "w.arl"] {
            std::fs::write(folder.join(file), "func void main()\nendfunc\n").expect("written");
        }
        let path = folder.join("cell.toml");
        std::fs::write(&path, text).expect("written");
        let found = named(Some(&path), robot);
        std::fs::remove_dir_all(&folder).expect("removed");
        found
    }

    #[test]
    fn a_cell_names_programs_once() {
        let text = "load = [\"r.arl\"]\n[io]\ndi = 3\n[[channel]]\nprogram = \"a.arl\"\nrobot = \"hsr065\"\nload = [\"s.arl\"]\n\
                    [[channel]]\nprogram = \"w.arl\"\nbackground = true\n[[channel]]\nprogram = \"a.arl\"\nrobot = \"cobra600\"\n";
        let found = named_by("several", text, Some("six-10")).expect("a cell");
        let short: Vec<_> = found.iter().map(|it| (it.file.as_str(), it.robot.as_deref(), it.background)).collect();
        let expected = [
            ("r.arl", Some("six-10"), false),
            ("a.arl", Some("hsr065"), false),
            ("s.arl", Some("hsr065"), false),
            ("w.arl", None, true),
        ];
        assert_eq!(short, expected);
        assert_eq!(named(None, None).expect("none"), []);
        assert!(matches!(named(Some(Path::new("nowhere.toml")), None), Err(Failure::Usage(_))));
    }

    #[test]
    fn a_program_is_for_one_build_of_robot() {
        let channel = |file: &str, more: &str| format!("[[channel]]\nprogram = \"{file}\"\n{more}\n");
        let (scara, background) = ("robot = \"hsr065\"", "background = true");
        let named = |name: &str, text: &str| named_by(name, text, None);
        for (name, text, line) in [
            ("channels", channel("a.arl", scara) + &channel("a.arl", "robot = \"six-10\""), ":4: "),
            ("default", channel("a.arl", "") + &channel("a.arl", scara), ":4: "),
            ("load", channel("a.arl", "load = [\"b.arl\"]") + &channel("b.arl", scara), ":4: "),
            ("first", format!("load = [\"a.arl\"]\n{}", channel("a.arl", scara)), ":2: "),
        ] {
            let Err(Failure::Usage(text)) = named(name, &text) else { panic!("{name} passes") };
            assert!(text.contains(line) && text.contains("arl is for a"), "{name}: {text}");
        }
        // The background has no robot, so its program is checked for the robot of the other channel.
        let found = named("background", &(channel("a.arl", background) + &channel("a.arl", scara))).expect("a cell");
        let short: Vec<_> = found.iter().map(|it| (it.robot.as_deref(), it.background)).collect();
        assert_eq!(short, [(Some("hsr065"), true)]);
        let same =
            channel("a.arl", "robot = \"six-10\"") + &channel("a.arl", "") + &channel("a.arl", "robot = \"kr6-r700\"");
        assert_eq!(named("same", &same).expect("a cell").len(), 1);
    }

    #[test]
    fn what_does_not_exist_is_named_with_its_line() {
        let refused = |name: &str, text: &str| match named_by(name, text, None) {
            Err(Failure::Usage(text)) => text,
            other => format!("{other:?}"),
        };
        let text = refused("file", "\n[[channel]]\nprogram = \"aa.arl\"\n");
        assert!(
            text.contains("cell.toml:2: there is no file ") && text.ends_with("aa.arl; did you mean `a.arl`?"),
            "{text}"
        );
        let text = refused("robot", "[[channel]]\nprogram = \"a.arl\"\nrobot = \"six10\"\n");
        assert!(text.contains("cell.toml:1: robot: six10: no robot of this name is built in"), "{text}");
    }
}
