//! Values changed for a run by `--set`: of its robot, its cell, its scenario and its global variables.

use crate::change;
use crate::settings::SettingsError;

/// The target of a change.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Part {
    /// The robot file.
    Robot,
    /// The cell file.
    Cell,
    /// The scenario.
    Io,
    /// The global variables of programs.
    Global,
}

impl Part {
    /// All parts, by the first key of a place.
    const NAMED: [(&'static str, Part); 4] =
        [("robot", Part::Robot), ("cell", Part::Cell), ("io", Part::Io), ("global", Part::Global)];
}

/// Changes in the order of their options: a later one takes precedence over an earlier one.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub struct Changes(Vec<Change>);

#[derive(Clone, PartialEq, Eq, Debug)]
struct Change {
    part: Part,
    path: String,
    value: String,
}

impl Changes {
    /// Parses changes from words of a command line.
    ///
    /// # Errors
    /// As for [`add`](Self::add).
    pub fn of(words: &[impl AsRef<str>]) -> Result<Self, String> {
        let mut changes = Self::default();
        words.iter().try_for_each(|word| changes.add(word.as_ref()))?;
        Ok(changes)
    }

    /// Parses a word of a command line: `robot.axis.1.vel=90`.
    ///
    /// # Errors
    /// The word is not a change; the message shows valid ones.
    pub fn add(&mut self, word: &str) -> Result<(), String> {
        let split = || {
            let (place, value) = word.split_once('=')?;
            let (first, path) = place.trim().split_once('.')?;
            let (_, part) = Part::NAMED.iter().find(|(name, _)| *name == first)?;
            Some(Change { part: *part, path: path.to_owned(), value: value.trim().to_owned() })
        };
        let change = split().ok_or_else(|| {
            format!(
                "--set {word}: expected a place and a value, like global.pitch=80, robot.axis.1.vel=90, \
                 io.event.2.at=1.5, cell.controller.cycle=2"
            )
        })?;
        self.0.push(change);
        Ok(())
    }

    /// The places of a part, and their values.
    pub fn of_part(&self, part: Part) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().filter(move |change| change.part == part).map(|change| (&*change.path, &*change.value))
    }

    /// The text of a file with all changes of a part.
    ///
    /// # Errors
    /// The file does not have the place, or is not TOML.
    pub fn apply(&self, part: Part, file: &str, text: String) -> Result<String, SettingsError> {
        self.of_part(part).try_fold(text, |text, (path, value)| change::set(file, &text, path, value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_for_their_part() {
        let changes = Changes::of(&["io.at = 2", "global.a=x=1", "robot.name=b", "io.at=3"]).unwrap();
        assert_eq!(changes.apply(Part::Io, "s.toml", "at = 1\n".into()).unwrap(), "at = 3\n");
        assert_eq!(changes.apply(Part::Cell, "c.toml", "no toml".into()).unwrap(), "no toml");
        assert_eq!(changes.of_part(Part::Global).collect::<Vec<_>>(), [("a", "x=1")]);
        for word in ["pitch=1", "global.a", "speed.a=1", "global=1", ""] {
            assert!(Changes::of(&[word]).unwrap_err().contains("expected a place and a value"), "{word}");
        }
    }
}
