//! Several programs in one: the one of the command line, and those that its cell file names.

use super::args::Checking;
use super::failure::Failure;
use arl_robot::cell::Programs;
use std::path::{Path, PathBuf};

/// A program beside the first one.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(super) struct Other {
    /// As the cell file names it.
    pub(super) file: String,
    pub(super) path: PathBuf,
    pub(super) robot: Option<String>,
    pub(super) background: bool,
}

impl Other {
    /// How it is checked where the first program is checked like that.
    pub(super) fn checking(&self, first: &Checking) -> Checking {
        Checking { robot: self.robot.clone(), background: self.background, ..first.clone() }
    }
}

/// The programs that a cell file names; `robot` is that of the first program.
///
/// # Errors
/// The file cannot be read, or its channels are none.
pub(super) fn named(cell: Option<&Path>, robot: Option<&str>) -> Result<Vec<Other>, Failure> {
    let Some(cell) = cell else { return Ok(Vec::new()) };
    let text = std::fs::read_to_string(cell)
        .map_err(|error| Failure::Usage(format!("{}: cannot read the cell file: {error}", cell.display())))?;
    let programs = Programs::of_cell(cell, &text).map_err(|error| Failure::Usage(error.to_string()))?;
    let folder = cell.parent().unwrap_or(Path::new(""));
    let mut all: Vec<Other> = Vec::new();
    let mut add =
        |file: String, robot: Option<String>, background: bool| match all.iter_mut().find(|it| it.file == file) {
            // What runs in the background somewhere may do there only what it may do everywhere.
            Some(known) => known.background |= background,
            None => all.push(Other { path: folder.join(&file), file, robot, background }),
        };
    programs.load.into_iter().for_each(|file| add(file, robot.map(String::from), false));
    for channel in programs.channels {
        add(channel.program, channel.robot.clone(), channel.background);
        channel.load.into_iter().for_each(|file| add(file, channel.robot.clone(), false));
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_names_programs_once() {
        let path = std::env::temp_dir().join(format!("arl2rs-several-{}.toml", std::process::id()));
        let text = "load = [\"r.arl\"]\n[io]\ndi = 3\n[[channel]]\nprogram = \"a.arl\"\nrobot = \"hsr065\"\nload = [\"s.arl\"]\n\
                    [[channel]]\nprogram = \"w.arl\"\nbackground = true\n[[channel]]\nprogram = \"a.arl\"\n";
        std::fs::write(&path, text).expect("written");
        let found = named(Some(&path), Some("six-10")).expect("a cell");
        std::fs::remove_file(&path).expect("removed");
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
}
