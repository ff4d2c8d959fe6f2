//! Breakpoints: the lines at which the program halts, and the conditions that the adapter checks then.

use super::evaluate::{uncallable, unreadable};
use super::program::{FileKey, Programs};
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A breakpoint as the editor requests it.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
#[serde(rename_all = "camelCase", default)]
struct Wanted {
    line: u32,
    name: String,
    condition: Option<String>,
    hit_condition: Option<String>,
    log_message: Option<String>,
}

/// A breakpoint.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Breakpoint {
    pub(super) id: i64,
    /// `None` before its place is known.
    file: Option<FileKey>,
    line: u32,
    pub(super) condition: Option<String>,
    hit_condition: Option<HitCondition>,
    pub(super) message: Option<String>,
    /// The statements at which it was hit, by their numbers.
    hits: Vec<u64>,
}

/// Which hits count.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum HitCondition {
    From(u64),
    Beyond(u64),
    Exactly(u64),
    Every(u64),
}

/// A rule by its number.
type Rule = fn(u64) -> HitCondition;

/// How a hit count is written: the sign before the number. The first sign that fits counts.
const HIT_CONDITIONS: [(&str, Rule); 5] = [
    (">=", HitCondition::From),
    ("==", HitCondition::Exactly),
    (">", HitCondition::Beyond),
    ("%", HitCondition::Every),
    ("", HitCondition::From),
];

impl HitCondition {
    fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        let (sign, rule) = HIT_CONDITIONS.iter().find(|(sign, _)| text.starts_with(sign))?;
        let number = text.strip_prefix(*sign)?.trim().parse().ok().filter(|number| *number > 0)?;
        Some(rule(number))
    }

    fn holds(self, hits: u64) -> bool {
        match self {
            Self::From(number) => hits >= number,
            Self::Beyond(number) => hits > number,
            Self::Exactly(number) => hits == number,
            Self::Every(number) => hits.is_multiple_of(number),
        }
    }
}

/// All breakpoints.
#[derive(Default, Debug)]
pub(super) struct Breakpoints {
    /// What the editor requests for each file; it may come before the program is known.
    wanted: BTreeMap<String, Vec<Value>>,
    wanted_functions: Vec<Value>,
    of_lines: Vec<(String, Breakpoint)>,
    of_functions: Vec<Breakpoint>,
    made: i64,
}

impl Breakpoints {
    /// Sets the breakpoints of a file, and no others. Returns what the editor is told of each.
    pub(super) fn set_lines(&mut self, path: &str, wanted: &[Value], programs: Option<&Programs>) -> Vec<Value> {
        self.wanted.insert(path.to_owned(), wanted.to_vec());
        self.of_lines.retain(|(known, _)| known != path);
        let Some(programs) = programs else {
            return wanted.iter().map(|_| unknown("the program is not known yet")).collect();
        };
        let (files, functions) = (programs.files(Path::new(path)), programs.functions(Path::new(path)));
        let mut answers = Vec::new();
        for value in wanted {
            let wanted: Wanted = serde_json::from_value(value.clone()).unwrap_or_default();
            let line = functions.iter().filter_map(|lines| lines.range(wanted.line..).next()).min().copied();
            answers.push(match (line, self.made(&wanted)) {
                _ if files.is_empty() => unknown("this file does not belong to the program"),
                (None, _) => unknown("there is no statement here or below"),
                (_, Err(why)) => unknown(&why),
                (Some(line), Ok(made)) => {
                    let id = made.id;
                    let here = files.iter().map(|file| Breakpoint { file: Some(file.clone()), line, ..made.clone() });
                    self.of_lines.extend(here.map(|breakpoint| (path.to_owned(), breakpoint)));
                    json!({"id": id, "verified": true, "line": line})
                }
            });
        }
        answers
    }

    /// Sets the breakpoints of functions, and no others. Returns what the editor is told of each.
    pub(super) fn set_functions(&mut self, wanted: &[Value], programs: Option<&Programs>) -> Vec<Value> {
        self.wanted_functions = wanted.to_vec();
        self.of_functions.clear();
        let mut answers = Vec::new();
        for value in wanted {
            let wanted: Wanted = serde_json::from_value(value.clone()).unwrap_or_default();
            let entries = programs.map(|programs| programs.entries(&wanted.name));
            answers.push(match (entries, self.made(&wanted)) {
                (None, _) => unknown("the program is not known yet"),
                (Some(entries), _) if entries.is_empty() => {
                    unknown("there is no function of this name that has a statement")
                }
                (_, Err(why)) => unknown(&why),
                (Some(entries), Ok(made)) => {
                    let id = made.id;
                    let here =
                        entries.into_iter().map(|(file, line)| Breakpoint { file: Some(file), line, ..made.clone() });
                    self.of_functions.extend(here);
                    json!({"id": id, "verified": true})
                }
            });
        }
        answers
    }

    fn made(&mut self, wanted: &Wanted) -> Result<Breakpoint, String> {
        self.made += 1;
        let filled = |text: &Option<String>| text.clone().filter(|text| !text.trim().is_empty());
        let hit_condition = match filled(&wanted.hit_condition) {
            None => None,
            Some(text) => Some(HitCondition::parse(&text).ok_or_else(|| {
                format!("`{text}` is not a hit count: expected a number, or `>`, `>=`, `==` or `%` and a number")
            })?),
        };
        let condition = filled(&wanted.condition);
        if let Some(why) = condition.as_deref().and_then(unreadable) {
            return Err(format!("the condition cannot be read: {why}"));
        }
        if let Some(name) = condition.as_deref().and_then(uncallable) {
            return Err(format!(
                "only built-in functions can be called while the program is halted, and {name} is not one"
            ));
        }
        Ok(Breakpoint {
            id: self.made,
            file: None,
            line: 0,
            condition,
            hit_condition,
            message: filled(&wanted.log_message),
            hits: Vec::new(),
        })
    }

    /// Finds their places, now that the program is known; returns what the editor is told of each.
    pub(super) fn find_places(&mut self, programs: &Programs) -> Vec<Value> {
        let wanted: Vec<(String, Vec<Value>)> = self.wanted.clone().into_iter().collect();
        let mut answers = Vec::new();
        for (path, wanted) in wanted {
            answers.extend(self.set_lines(&path, &wanted, Some(programs)));
        }
        answers.extend(self.set_functions(&self.wanted_functions.clone(), Some(programs)));
        answers
    }

    /// The breakpoint lines of each file, also of files that no longer have any.
    pub(super) fn lines(&self, programs: &Programs) -> BTreeMap<FileKey, BTreeSet<u32>> {
        let files = self.wanted.keys().flat_map(|path| programs.files(Path::new(path)));
        let mut lines: BTreeMap<FileKey, BTreeSet<u32>> = files.map(|file| (file, BTreeSet::new())).collect();
        for breakpoint in self.of_lines.iter().map(|(_, breakpoint)| breakpoint).chain(&self.of_functions) {
            if let Some(file) = &breakpoint.file {
                lines.entry(file.clone()).or_default().insert(breakpoint.line);
            }
        }
        lines
    }

    fn all_mut(&mut self) -> impl Iterator<Item = &mut Breakpoint> {
        self.of_lines.iter_mut().map(|(_, breakpoint)| breakpoint).chain(&mut self.of_functions)
    }

    /// The breakpoints of a line.
    pub(super) fn at(&mut self, file: &FileKey, line: u32) -> Vec<&mut Breakpoint> {
        self.all_mut().filter(|breakpoint| breakpoint.file.as_ref() == Some(file) && breakpoint.line == line).collect()
    }

    /// Forgets the hits after a statement: the run has gone back to it. 0: another run begins.
    pub(super) fn go_back_to(&mut self, statement: u64) {
        self.all_mut().for_each(|breakpoint| breakpoint.hits.retain(|hit| *hit <= statement));
    }
}

impl Breakpoint {
    /// Notes a hit at the statement with this number; returns whether the hit counts.
    pub(super) fn hit(&mut self, statement: u64) -> bool {
        self.hits.push(statement);
        self.hit_condition.is_none_or(|condition| condition.holds(self.hits.len() as u64))
    }
}

fn unknown(why: &str) -> Value {
    json!({"verified": false, "message": why})
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_call_what_is_built_in() {
        assert_eq!(uncallable("getdi(1) && (i > 2) && Strlen(name) == (3)"), None);
        assert_eq!(uncallable("i == add(1, 2)"), Some("add"));
        assert_eq!(uncallable("name == \"add(1)\" && sqrt( twice (2)) > 1"), Some("twice"));
        assert_eq!(uncallable(r#"name == "say \" and (add(1)" && i > 1"#), None);
        assert_eq!(uncallable("part::strlen(name) > 1"), Some("strlen"));
        assert_eq!(uncallable("i =="), None);
    }

    #[test]
    fn hit_counts_are_read() {
        let hits_that_fit = |text: &str| {
            let condition = HitCondition::parse(text).unwrap();
            (1..=6).filter(|hits| condition.holds(*hits)).collect::<Vec<_>>()
        };
        assert_eq!(hits_that_fit("5"), [5, 6]);
        assert_eq!(hits_that_fit(" > 4 "), [5, 6]);
        assert_eq!(hits_that_fit(">=6"), [6]);
        assert_eq!(hits_that_fit("== 3"), [3]);
        assert_eq!(hits_that_fit("%2"), [2, 4, 6]);
        assert_eq!(HitCondition::parse("often"), None);
        assert_eq!(HitCondition::parse("0"), None);
    }
}
