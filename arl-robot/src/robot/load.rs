//! Built-in robots, and robots from files.

use std::borrow::Cow;
use std::io::ErrorKind;
use std::path::Path;

use super::{Robot, RobotError, builtin, read};
use crate::changes::{Changes, Part};
use crate::regular_file;

impl Robot {
    /// The names of the built-in robots; the first is the default.
    pub fn builtin_names() -> impl Iterator<Item = &'static str> {
        builtin::ROBOTS.iter().map(|(name, _)| *name)
    }

    /// The built-in robot of this name, whatever its case.
    ///
    /// # Errors
    /// There is no built-in robot of this name.
    pub fn builtin(name: &str) -> Result<Robot, RobotError> {
        let text = Robot::text(name).ok_or_else(|| builtin::unknown(name))?;
        Robot::parse(name, text)
    }

    /// The robot file of a built-in robot, whatever the case of its name.
    pub fn text(name: &str) -> Option<&'static str> {
        builtin::ROBOTS.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)).map(|(_, text)| *text)
    }

    /// The built-in robot of this name, or else the robot file at this path.
    ///
    /// # Errors
    /// No robot of this name is built in and the file cannot be read; or the file has an error, reported with line and
    /// column.
    pub fn load(name_or_path: &str) -> Result<Robot, RobotError> {
        Robot::load_with(name_or_path, &Changes::default())
    }

    /// Like `load`, with changed values at some places.
    ///
    /// # Errors
    /// As for [`load`](Self::load); or the file does not have one of the places.
    pub fn load_with(name_or_path: &str, changes: &Changes) -> Result<Robot, RobotError> {
        let text = changes.apply(Part::Robot, name_or_path, Robot::source(name_or_path)?.into_owned())?;
        Robot::parse(name_or_path, &text)
    }

    /// The text of the robot file of a built-in robot, or of the file at this path.
    ///
    /// # Errors
    /// No robot of this name is built in, and the file cannot be read.
    pub fn source(name_or_path: &str) -> Result<Cow<'static, str>, RobotError> {
        if let Some(text) = Robot::text(name_or_path) {
            return Ok(Cow::Borrowed(text));
        }
        let looks_like_path = name_or_path.ends_with(".toml") || name_or_path.contains(['/', '\\']);
        match regular_file::read_text(Path::new(name_or_path)) {
            Ok(text) => Ok(Cow::Owned(text)),
            Err(error) if error.kind() == ErrorKind::NotFound && !looks_like_path => {
                Err(builtin::unknown(name_or_path))
            }
            Err(error) => Err(RobotError::of_file(name_or_path, format!("cannot read the robot file: {error}"))),
        }
    }

    /// The robot that `text` describes; `file` names the text in errors.
    ///
    /// # Errors
    /// The text is not TOML, or not a robot: with line, column and what was expected.
    pub fn parse(file: &str, text: &str) -> Result<Robot, RobotError> {
        read::robot(file, text)
    }
}
