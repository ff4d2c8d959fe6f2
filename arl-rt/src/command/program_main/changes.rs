//! `--set`: single values of the robot, the cell, the scenario and the program that are others in this run.

use std::path::Path;

use crate::controller::Builder;
use crate::io::Scenario;
use arl_robot::cell::{Cell, Names};
use arl_robot::change;
use arl_robot::regular_file;
use arl_robot::robot::Robot;

/// What changes, in the order of the command line: where, and to what.
#[derive(Clone, PartialEq, Default, Debug)]
pub(super) struct Changes {
    robot: Vec<(String, String)>,
    cell: Vec<(String, String)>,
    io: Vec<(String, String)>,
    globals: Vec<(String, String)>,
}

impl Changes {
    /// Takes a word of the command line: `robot.axis.1.vel=90`.
    ///
    /// # Errors
    /// It is no change, in words.
    pub(super) fn add(&mut self, word: &str) -> Result<(), String> {
        let wrong = || {
            format!(
                "--set {word}: expected a place and a value, like global.pitch=80, robot.axis.1.vel=90, \
                 io.event.2.at=1.5, cell.controller.cycle=2"
            )
        };
        let (place, value) = word.split_once('=').ok_or_else(wrong)?;
        let (of, path) = place.trim().split_once('.').ok_or_else(wrong)?;
        let list = match of {
            "robot" => &mut self.robot,
            "cell" => &mut self.cell,
            "io" => &mut self.io,
            "global" => &mut self.globals,
            _ => return Err(wrong()),
        };
        list.push((path.to_owned(), value.trim().to_owned()));
        Ok(())
    }

    /// Whether a file is changed that is not named; which, and by which option it is.
    pub(super) fn lacks(&self, robot: bool, cell: bool, io: bool) -> Option<(&'static str, &'static str)> {
        let all = [
            (!robot && !self.robot.is_empty(), ("robot", "--robot")),
            (!cell && !self.cell.is_empty(), ("cell", "--cell")),
            (!io && !self.io.is_empty(), ("io", "--io")),
        ];
        all.into_iter().find_map(|(lacks, which)| lacks.then_some(which))
    }

    /// The robot of this name or file, changed.
    ///
    /// # Errors
    /// There is none, it is wrong, or it has no such place, in words.
    pub(super) fn robot(&self, name: &str) -> Result<Robot, String> {
        if self.robot.is_empty() {
            return Robot::load(name).map_err(|error| error.to_string());
        }
        let text = Robot::source(name).map_err(|error| error.to_string())?;
        let text = changed(name, text.into_owned(), &self.robot)?;
        Robot::parse(name, &text).map_err(|error| error.to_string())
    }

    /// The cell of this file, changed.
    ///
    /// # Errors
    /// As for the robot.
    pub(super) fn cell(&self, path: &Path) -> Result<Cell, String> {
        if self.cell.is_empty() {
            return Cell::load(path).map_err(|error| error.to_string());
        }
        let (name, text) = read(path, "the cell file")?;
        Cell::parse(&name, &changed(&name, text, &self.cell)?).map_err(|error| error.to_string())
    }

    /// The scenario of this file, changed.
    ///
    /// # Errors
    /// As for the robot.
    pub(super) fn scenario(&self, path: &Path, names: &Names) -> Result<Scenario, String> {
        if self.io.is_empty() {
            return Scenario::load_with(path, names).map_err(|error| error.to_string());
        }
        let (name, text) = read(path, "the io scenario")?;
        Scenario::parse_with(&name, &changed(&name, text, &self.io)?, names).map_err(|error| error.to_string())
    }

    /// The global variables.
    pub(super) fn globals(&self, builder: Builder) -> Builder {
        self.globals.iter().fold(builder, |builder, (name, value)| builder.global(name, value))
    }
}

fn read(path: &Path, what: &str) -> Result<(String, String), String> {
    let name = path.display().to_string();
    let text = regular_file::read_text(path).map_err(|error| format!("{name}: cannot read {what}: {error}"))?;
    Ok((name, text))
}

fn changed(file: &str, text: String, changes: &[(String, String)]) -> Result<String, String> {
    changes
        .iter()
        .try_fold(text, |text, (path, value)| change::set(file, &text, path, value).map_err(|error| error.to_string()))
}
