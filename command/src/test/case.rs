//! The cases in a folder and what is expected of them.

use super::expect::{ExpectedAlarm, ExpectedError, parse_alarm, parse_errors};
use arl_project::arl_toml;
use arl_project::expectations::EXPECTATIONS;
use arl_project::options::EngineChoice;
use arl_robot::regular_file;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A program with its sidecars.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Case {
    /// The program.
    pub(super) source: PathBuf,
    /// Exact standard output.
    pub(super) out: Option<Vec<u8>>,
    /// The compile errors.
    pub(super) errors: Option<Vec<ExpectedError>>,
    /// The alarm that ends it.
    pub(super) alarm: Option<ExpectedAlarm>,
    /// What happens outside the program.
    pub(super) scenario: Option<PathBuf>,
    /// Whether it has no expected results yet.
    pub(super) is_new: bool,
    /// The robot that it is for: its own, or that of its project.
    pub(super) robot: Option<String>,
    /// The cell, likewise.
    pub(super) cell: Option<PathBuf>,
    /// The folder that `/home/ae/script/` in an import means, if its project sets it.
    pub(super) script_dir: Option<PathBuf>,
    /// How its project says that it is run: by the engine or compiled.
    pub(super) engine: Option<EngineChoice>,
    /// How it is run.
    pub(super) options: CaseOptions,
}

impl Case {
    /// Whether it is run, and not only checked.
    pub(super) fn runs(&self) -> bool {
        self.errors.is_none()
    }
}

/// NAME.toml
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
#[serde(deny_unknown_fields)]
pub(super) struct CaseOptions {
    /// A built-in robot, or a robot file beside the case.
    pub(super) robot: Option<String>,
    /// A cell file beside the case.
    pub(super) cell: Option<PathBuf>,
    pub(super) mode: Option<String>,
    /// The program is for a background channel; such a case is only checked.
    #[serde(default)]
    pub(super) background: bool,
    /// Whether it runs in the loop running mode.
    #[serde(default, rename = "loop")]
    pub(super) repeats: bool,
    /// Controller seconds. A case that sets it may end by it.
    pub(super) max_time: Option<f64>,
    /// Percent.
    #[serde(rename = "override")]
    pub(super) override_percent: Option<f64>,
}

/// A case, or the reason why it cannot be one.
pub(super) struct Found {
    pub(super) source: PathBuf,
    pub(super) case: Result<Case, String>,
}

/// The files of one name in one folder.
#[derive(Default)]
struct Group {
    program: bool,
    /// Endings of the sidecars.
    sidecars: Vec<&'static str>,
}

/// Endings of sidecars with settings.
const SETTINGS: [&str; 2] = [".io.toml", ".toml"];

/// Finds all cases below a folder, in the order of their paths; with `new` also those without expected results yet.
pub(super) fn find(folder: &Path, new: bool) -> std::io::Result<Vec<Found>> {
    let mut found = Vec::new();
    let mut groups: BTreeMap<String, Group> = BTreeMap::new();
    let mut folders = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.path().is_dir() {
            if !name.starts_with('.') {
                folders.push(entry.path());
            }
            continue;
        }
        if let Some(stem) = name.strip_suffix(".arl") {
            groups.entry(stem.into()).or_default().program = true;
        } else if let Some(ending) = EXPECTATIONS.iter().chain(&SETTINGS).find(|ending| name.ends_with(**ending)) {
            let stem = name.strip_suffix(ending).unwrap_or(&name);
            groups.entry(stem.into()).or_default().sidecars.push(ending);
        }
    }
    for (stem, group) in groups {
        let source = folder.join(format!("{stem}.arl"));
        let expects = group.sidecars.iter().find(|ending| EXPECTATIONS.contains(ending));
        if group.program && !group.sidecars.is_empty() {
            found.push(Found { case: read(&source, &stem, expects.is_some(), new), source });
        } else if let (false, Some(ending)) = (group.program, expects) {
            let problem = format!("there is a {stem}{ending}, but no {stem}.arl");
            found.push(Found { case: Err(problem), source });
        }
    }
    folders.sort();
    for folder in folders {
        found.extend(find(&folder, new)?);
    }
    Ok(found)
}

fn read(source: &Path, stem: &str, expects: bool, new: bool) -> Result<Case, String> {
    if !expects && !new {
        let files = format!("{stem}.out, {stem}.err or {stem}.alarm");
        return Err(format!("it has no expected results: add {files}, or let --bless write them"));
    }
    let path = |ending: &str| source.with_file_name(format!("{stem}{ending}"));
    let bytes = |ending: &str| match regular_file::read(&path(ending)) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(format!("cannot read {stem}{ending}: {error}")),
    };
    let text = |ending: &str| match bytes(ending)?.map(String::from_utf8) {
        Some(Ok(text)) => Ok(Some(text)),
        Some(Err(_)) => Err(format!("{stem}{ending} is not UTF-8")),
        None => Ok(None),
    };
    let problem_in = |ending: &str| {
        let name = format!("{stem}{ending}");
        move |problem: String| format!("{name}:{problem}")
    };
    let options = match text(".toml")? {
        Some(text) => options(&text).map_err(problem_in(".toml"))?,
        None => CaseOptions::default(),
    };
    let scenario = path(".io.toml");
    let damaged_alarm = text(".alarm")?.is_some_and(|text| parse_alarm(&text).is_err());
    let project = arl_toml::of_program(source).map_err(|failure| failure.to_string())?.unwrap_or_default();
    let robot = options.robot.as_ref().map(|robot| {
        let file = source.with_file_name(robot);
        if file.is_file() { file.to_string_lossy().into_owned() } else { robot.clone() }
    });
    let case = Case {
        out: bytes(".out")?,
        // What is to be written again may be damaged, or still empty.
        errors: match text(".err")?.map(|text| parse_errors(&text)).transpose() {
            Err(_) if new => Some(Vec::new()),
            errors => errors.map_err(problem_in(".err"))?,
        },
        alarm: match text(".alarm")?.map(|text| parse_alarm(&text)).transpose() {
            Err(_) if new => None,
            alarm => alarm.map_err(problem_in(".alarm"))?,
        },
        scenario: scenario.exists().then_some(scenario),
        is_new: !expects || (new && damaged_alarm),
        robot: robot.or(project.robot),
        cell: options.cell.as_ref().map(|cell| source.with_file_name(cell)).or(project.cell),
        script_dir: project.script_dir,
        engine: project.engine,
        options,
        source: source.to_path_buf(),
    };
    if case.options.background && case.errors.is_none() {
        return Err(format!("a background program does not run alone: add {stem}.err with its expected errors"));
    }
    if case.errors.is_some() && (case.out.is_some() || case.alarm.is_some()) {
        return Err(format!(
            "a program with errors does not run: keep either {stem}.err or {stem}.out and {stem}.alarm"
        ));
    }
    Ok(case)
}

fn options(text: &str) -> Result<CaseOptions, String> {
    toml::from_str(text).map_err(|error| {
        let start = error.span().map_or(0, |span| span.start);
        let line = text.get(..start).unwrap_or("").bytes().filter(|byte| *byte == b'\n').count() + 1;
        format!("{line}: {}", error.message().trim_end())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str, files: &[(&str, &str)]) -> Self {
            let path = std::env::temp_dir().join(format!("arl2rs-case-{name}-{}", std::process::id()));
            for (file, text) in files {
                let file = path.join(file);
                std::fs::create_dir_all(file.parent().expect("a folder")).expect("made");
                std::fs::write(file, text).expect("written");
            }
            Self(path)
        }

        fn found(&self) -> Vec<(String, Result<Case, String>)> {
            let name = |path: &Path| path.strip_prefix(&self.0).expect("below").to_string_lossy().into_owned();
            find(&self.0, false).expect("a folder").into_iter().map(|found| (name(&found.source), found.case)).collect()
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn programs_with_sidecars_are_cases_and_others_are_not() {
        let folder = Folder::new(
            "which",
            &[
                ("b/run.arl", ""),
                ("b/run.out", "1\n"),
                ("b/run.io.toml", ""),
                ("b/run.toml", "robot = \"six-10\"\nmax_time = 3\noverride = 50.5"),
                ("b/module.arl", ""),
                ("b/run_data.arl", ""),
                ("a/bad.arl", ""),
                ("a/bad.err", "3 name\n"),
            ],
        );
        let found = folder.found();
        let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["a/bad.arl", "b/run.arl"]);
        let bad = found[0].1.as_ref().expect("a case");
        assert!(!bad.runs());
        let run = found[1].1.as_ref().expect("a case");
        assert_eq!(run.out.as_deref(), Some(&b"1\n"[..]));
        assert_eq!(run.scenario, Some(folder.0.join("b/run.io.toml")));
        assert_eq!(run.options.robot.as_deref(), Some("six-10"));
        assert_eq!((run.options.max_time, run.options.override_percent), (Some(3.0), Some(50.5)));
    }

    #[test]
    fn what_cannot_be_a_case_says_why() {
        let folder = Folder::new(
            "why",
            &[
                ("alone.out", ""),
                ("both.arl", ""),
                ("both.err", "1 x"),
                ("both.out", ""),
                ("key.arl", ""),
                ("key.out", ""),
                ("key.toml", "mode = \"auto\"\nspeed = 3\n"),
                ("nothing.arl", ""),
                ("nothing.toml", ""),
                ("shared.toml", ""),
            ],
        );
        let problems: Vec<String> =
            folder.found().into_iter().map(|(name, case)| format!("{name}: {}", case.expect_err("no case"))).collect();
        assert_eq!(problems.len(), 4, "{problems:?}");
        assert!(problems[0].contains("no alone.arl"));
        assert!(problems[1].contains("either both.err or"));
        assert!(problems[2].contains("key.toml:2: unknown field `speed`"), "{}", problems[2]);
        assert!(problems[3].contains("add nothing.out"));
    }
}
