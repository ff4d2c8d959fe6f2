//! The file of a sweep: a program, what is the same in all runs, and a table of parameters.

use crate::parameters::Parameters;
use arl_project::options::EngineChoice;
use arl_robot::regular_file;
use arl_robot::settings::Source;
use arl_terminal::failure::Failure;
use arl_terminal::show;
use serde::Deserialize;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The most runs of a sweep: more is a slip.
const MOST: usize = 10_000_000;

/// The longest time that makes sense: s.
const LONGEST: f64 = 1e9;

/// The settings that all runs share.
#[derive(Clone, Default, PartialEq, Deserialize, Debug)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Settings {
    /// The file that has `main`.
    pub program: PathBuf,
    /// A built-in robot or a robot file.
    pub robot: Option<String>,
    /// The cell file.
    pub cell: Option<PathBuf>,
    /// The scenario.
    pub io: Option<PathBuf>,
    /// The folder of the program's files; its own if absent.
    pub script_dir: Option<PathBuf>,
    /// Files that the program reads besides programs, data files and texts, relative to that folder.
    #[serde(default)]
    pub files: Vec<PathBuf>,
    /// How the program is run.
    pub engine: Option<EngineChoice>,
    /// The limit of a run, in seconds of the robot's time.
    pub max_time: Option<f64>,
    /// After how many seconds on the computer's clock a run is given up.
    pub timeout: Option<f64>,
    /// Whether to look for collisions.
    #[serde(default)]
    pub collisions: bool,
    /// In mm: what comes nearer to each other without touching is reported, too. It implies looking for collisions.
    pub clearance: Option<f64>,
}

impl Settings {
    /// The clearance if collisions are looked for, in mm; 0: contacts only.
    pub(super) fn clearance(&self) -> Option<f64> {
        self.clearance.or(self.collisions.then_some(0.0))
    }

    /// Checks that its times and lengths are valid.
    pub(super) fn check(&self) -> Result<(), String> {
        if let Some(clearance) = self.clearance.filter(|clearance| !clearance.is_finite() || *clearance < 0.0) {
            return Err(format!("clearance: expected a distance in mm, 0 or more, found {clearance}"));
        }
        for (name, seconds) in [("timeout", self.timeout), ("max-time", self.max_time)] {
            if seconds.is_some_and(|seconds| !(0.0..=LONGEST).contains(&seconds)) {
                return Err(format!("{name}: expected a time from 0 to {LONGEST} s"));
            }
        }
        Ok(())
    }
}

/// A sweep: what is run, and the parameters of each run.
#[derive(Clone, PartialEq, Debug)]
pub struct Sweep {
    /// The settings that all runs share.
    pub settings: Settings,
    /// The parameters, run by run.
    pub rows: Vec<Parameters>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct File {
    program: PathBuf,
    robot: Option<String>,
    cell: Option<PathBuf>,
    io: Option<PathBuf>,
    script_dir: Option<PathBuf>,
    #[serde(default)]
    files: Vec<PathBuf>,
    engine: Option<EngineChoice>,
    max_time: Option<f64>,
    timeout: Option<f64>,
    #[serde(default)]
    collisions: bool,
    clearance: Option<f64>,
    /// The parameters that are the same in all runs.
    #[serde(default)]
    set: Parameters,
    /// Each value is combined with each of the others.
    #[serde(default)]
    grid: Parameters,
    /// The parameters run by run.
    #[serde(default)]
    run: Vec<Parameters>,
}

impl Sweep {
    /// Reads the file. Its paths start from its own folder.
    ///
    /// # Errors
    /// It cannot be read, or is not a valid sweep: its line.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let text = regular_file::read_text(path).map_err(|error| Failure::io("read", path, &error))?;
        let name = show::path(path).display().to_string();
        let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
        Self::parse(&name, &text, &folder).map_err(Failure::Usage)
    }

    fn parse(name: &str, text: &str, folder: &Path) -> Result<Self, String> {
        let file: File = toml::from_str(text).map_err(|error| {
            let line = Source { file: name, text }.line(error.span().map_or(0, |span| span.start));
            format!("{name}:{line}: {}", error.message().trim_end())
        })?;
        let beside = |path: PathBuf| folder.join(path);
        // A robot may be built in.
        let robot = file.robot.map(|robot| robot_at(folder, robot));
        let settings = Settings {
            program: beside(file.program),
            robot,
            cell: file.cell.map(beside),
            io: file.io.map(beside),
            script_dir: file.script_dir.map(beside),
            files: file.files,
            engine: file.engine,
            max_time: file.max_time,
            timeout: file.timeout,
            collisions: file.collisions,
            clearance: file.clearance,
        };
        let mut rows = if file.run.is_empty() { vec![Parameters::default()] } else { file.run };
        for row in &mut rows {
            let own = std::mem::replace(row, file.set.clone());
            own.0.into_iter().for_each(|(place, value)| row.set(&place, value));
        }
        for (place, values) in &file.grid.0 {
            let values = values_of(place, values).map_err(|problem| format!("{name}: [grid] {place}: {problem}"))?;
            if rows.len().saturating_mul(values.len()) > MOST {
                return Err(format!("{name}: these are more than {MOST} runs"));
            }
            let with = |row: &Parameters| {
                let row = row.clone();
                values.clone().into_iter().map(move |value| {
                    let mut row = row.clone();
                    row.set(place, value);
                    row
                })
            };
            rows = rows.iter().flat_map(with).collect();
        }
        for row in &mut rows {
            for (place, value) in &mut row.0 {
                match (place.as_str(), &value) {
                    ("io", Value::String(path)) => *value = folder.join(path).display().to_string().into(),
                    ("robot", Value::String(robot)) => *value = robot_at(folder, robot.clone()).into(),
                    _ => {}
                }
            }
        }
        Ok(Self { settings, rows })
    }
}

fn robot_at(folder: &Path, robot: String) -> String {
    let beside = folder.join(&robot);
    if arl_robot::Robot::text(&robot).is_none() && beside.is_file() { beside.display().to_string() } else { robot }
}

/// The values of a parameter in a grid: a list of them, or `{ from = 1, to = 2, count = 5 }`.
fn values_of(place: &str, values: &Value) -> Result<Vec<Value>, String> {
    const EXPECTED: &str = "expected a list of values, or { from = 1, to = 2, count = 5 }";
    match values {
        Value::Array(values) if values.is_empty() => Err("the list is empty: give at least one value".into()),
        Value::Array(values) => Ok(values.clone()),
        Value::Object(range) => {
            if !["from", "to", "count"].iter().any(|key| range.contains_key(*key)) {
                return Err(format!(
                    "{EXPECTED}; a place with dots in it must be in quotes: \"global.pitch\" = [80, 100]"
                ));
            }
            let number = |key: &str| range.get(key).and_then(Value::as_f64).filter(|number| number.is_finite());
            let count = range.get("count").and_then(Value::as_u64).filter(|count| (2..=MOST as u64).contains(count));
            let (Some(from), Some(to), Some(count), 3) = (number("from"), number("to"), count, range.len()) else {
                return Err(format!("{EXPECTED}, with a count from 2 to {MOST}"));
            };
            let is_whole = ["seed"].contains(&place)
                || [from, to, (to - from) / (count - 1) as f64].iter().all(|it| it.fract() == 0.0);
            let at = |step: u64| from + (to - from) * step as f64 / (count - 1) as f64;
            Ok((0..count)
                .map(|step| if is_whole { Value::from(at(step).round() as i64) } else { at(step).into() })
                .collect())
        }
        _ => Err(EXPECTED.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str) -> Result<Vec<String>, String> {
        let sweep = Sweep::parse("s.toml", text, Path::new("/f"))?;
        Ok(sweep.rows.iter().map(|row| serde_json::to_string(row).unwrap()).collect())
    }

    #[test]
    fn a_grid_has_each_value_with_each() {
        let text = "program = \"a.arl\"\n[set]\nseed = 3\n[grid]\n\"global.b\" = [1, 2.5]\noverride = { from = 50, to = 100, count = 2 }\n";
        assert_eq!(
            rows(text).unwrap(),
            [
                r#"{"seed":3,"global.b":1,"override":50}"#,
                r#"{"seed":3,"global.b":1,"override":100}"#,
                r#"{"seed":3,"global.b":2.5,"override":50}"#,
                r#"{"seed":3,"global.b":2.5,"override":100}"#,
            ]
        );
    }

    #[test]
    fn runs_stand_one_by_one_and_go_before_what_is_the_same() {
        let text = "program = \"a.arl\"\nio = \"s.toml\"\nset.seed = 3\n[[run]]\n[[run]]\nseed = 4\nio = \"t.toml\"\n";
        assert_eq!(rows(text).unwrap(), [r#"{"seed":3}"#, r#"{"seed":4,"io":"/f/t.toml"}"#]);
        let sweep = Sweep::parse("s.toml", text, Path::new("/f")).unwrap();
        assert_eq!(sweep.settings.program, Path::new("/f/a.arl"));
        assert_eq!(sweep.settings.io.as_deref(), Some(Path::new("/f/s.toml")));
        assert_eq!(rows("program = \"a.arl\"\n").unwrap(), ["{}"]);
    }

    #[test]
    fn ranges_of_whole_numbers_are_whole() {
        let values = |text: &str| values_of("x", &serde_json::from_str(text).unwrap());
        assert_eq!(values(r#"{"from":0,"to":1,"count":3}"#).unwrap(), [0.0, 0.5, 1.0]);
        assert_eq!(values(r#"{"from":0,"to":4,"count":3}"#).unwrap(), [0, 2, 4]);
    }

    #[test]
    fn mistakes_have_a_line_or_a_name() {
        for (text, words) in [
            ("io = \"a\"\n", "missing field `program`"),
            ("program = \"a\"\nspeed = 1\n", "s.toml:2: unknown field `speed`"),
            ("program = \"a\"\n[grid]\nseed = 3\n", "[grid] seed: expected a list"),
            ("program = \"a\"\n[grid]\nseed = { from = 1, to = 2 }\n", "with a count from 2 to 10000000"),
            ("program = \"a\"\n[grid]\nseed = []\n", "give at least one value"),
            ("program = \"a\"\n[grid]\nglobal.pitch = [1]\n", "must be in quotes"),
            (
                "program = \"a\"\n[grid]\na = { from = 1, to = 2, count = 9000 }\nb = { from = 1, to = 2, count = 9000 }\n",
                "more than",
            ),
        ] {
            let problem = rows(text).unwrap_err();
            assert!(problem.contains(words), "{problem}");
        }
    }
}
