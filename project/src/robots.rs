//! `arl2rs robots`, and the robot data that the compiler needs.

use arl_lang::catalog::Family;
use arl_robot::Robot;
use arl_robot::cell::Cell;
use arl_robot::changes::Changes;
use arl_robot::robot::RobotError;
use arl_terminal::failure::Failure;
use std::borrow::Cow;

/// The list of the built-in robots, or the text of the file of a given one.
///
/// # Errors
/// There is no built-in robot of this name.
pub fn robots(name: Option<&str>) -> Result<String, Failure> {
    let Some(name) = name else {
        let width = Robot::builtin_names().map(str::len).max().unwrap_or(0);
        let line = |(at, name): (usize, &str)| {
            let text = Robot::text(name).unwrap_or_default();
            let about = text.lines().next().unwrap_or("").trim_start_matches(['#', ' ']).trim_end_matches('.');
            let default = if at == 0 { " (default)" } else { "" };
            format!("{name:width$}  {about}{default}\n")
        };
        return Ok(Robot::builtin_names().enumerate().map(line).collect());
    };
    Robot::builtin(name).map_err(refused)?;
    Ok(Robot::text(name).unwrap_or_default().to_owned())
}

/// The family of the robot that `--robot` names. The rest of a robot file is read when the program starts.
///
/// # Errors
/// The robot does not exist, or its file does not give the family.
pub(crate) fn family(robot: Option<&str>) -> Result<Family, Failure> {
    if robot.is_none() {
        return Ok(Family::default());
    }
    let (file, text) = text(robot)?;
    family_in(&text, file)
}

/// The name and the text of the file of the robot that `--robot` names, or of the default one.
///
/// # Errors
/// The robot does not exist.
pub(crate) fn text(robot: Option<&str>) -> Result<(&str, Cow<'static, str>), Failure> {
    let robot = named(robot);
    Ok((robot, Robot::source(robot).map_err(refused)?))
}

/// The robot that `--robot` names, or the default one.
///
/// # Errors
/// The robot does not exist, or its file is wrong.
pub fn load(robot: Option<&str>) -> Result<Robot, Failure> {
    load_with(robot, &Changes::default())
}

/// Like `load`, with changed values.
///
/// # Errors
/// As for [`load`], or a changed value does not exist.
pub fn load_with(robot: Option<&str>, changes: &Changes) -> Result<Robot, Failure> {
    Robot::load_with(named(robot), changes).map_err(refused)
}

/// The robots of a cell's channels, in the order of the channels, skipping channels without one; `first` is the first
/// robot.
///
/// # Errors
/// One of the other robots cannot be loaded.
pub fn of_cell(cell: &Cell, first: Robot) -> Result<Vec<Robot>, Failure> {
    let beside = cell.programs.channels.iter().filter(|channel| !channel.background);
    let named = beside.map(|channel| load(channel.robot.as_deref()));
    std::iter::once(Ok(first)).chain(named).collect()
}

fn named(robot: Option<&str>) -> &str {
    robot.or_else(|| Robot::builtin_names().next()).unwrap_or_default()
}

fn refused(error: RobotError) -> Failure {
    Failure::Usage(error.to_string())
}

fn family_in(text: &str, file: &str) -> Result<Family, Failure> {
    let at = |span: Option<std::ops::Range<usize>>| {
        let start = span.map_or(0, |span| span.start);
        text.get(..start).unwrap_or("").bytes().filter(|byte| *byte == b'\n').count() + 1
    };
    let table: toml::Table = toml::from_str(text).map_err(|error| {
        Failure::Usage(format!("{file}:{}: this is not TOML: {}", at(error.span()), error.message().trim_end()))
    })?;
    let line = text.lines().position(|line| line.trim_start().starts_with("family")).map_or(1, |line| line + 1);
    match table.get("family").map(|family| family.as_str().unwrap_or("")) {
        Some("six-axis") => Ok(Family::SixAxis),
        Some("scara") => Ok(Family::Scara),
        Some(_) => Err(Failure::Usage(format!("{file}:{line}: `family` must be \"six-axis\" or \"scara\""))),
        None => Err(Failure::Usage(format!("{file}: `family` is missing; it must be \"six-axis\" or \"scara\""))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn usage(result: Result<Family, Failure>) -> String {
        match result {
            Err(Failure::Usage(text)) => text,
            other => format!("{other:?}"),
        }
    }

    #[test]
    fn families_of_built_in_robots() {
        assert_eq!(family(None).ok(), Some(Family::SixAxis));
        assert_eq!(family(Some("six-10")).ok(), Some(Family::SixAxis));
        assert_eq!(family(Some("Cobra600")).ok(), Some(Family::Scara));
    }

    #[test]
    fn mistakes_say_what_would_be_right() {
        assert!(usage(family(Some("six10"))).contains("did you mean `six-10`?"));
        assert!(usage(family_in("name = 1\nfamily = 3\n", "my.toml")).starts_with("my.toml:2: "));
        assert!(usage(family_in("name = 1\nfamily = \n", "my.toml")).starts_with("my.toml:2: this is not TOML"));
        assert!(usage(family_in("", "my.toml")).contains("`family` is missing"));
    }

    #[test]
    fn list_and_text() {
        let list = robots(None).expect("a list");
        assert_eq!(list.lines().count(), Robot::builtin_names().count());
        assert!(list.lines().next().expect("the default").ends_with("(default)"));
        assert!(robots(Some("six-10")).expect("a text").contains("family = \"six-axis\""));
    }
}
