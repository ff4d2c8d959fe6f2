//! `arl.toml`: settings of the robot and the cell of programs that are not given on the command line. It lies beside a
//! program, or in a folder above it; its paths are relative to its own folder. The command line takes precedence.

use crate::options::{Checking, EngineChoice, RunOptions};
use crate::program_path;
use crate::robots;
use arl_robot::settings::Source;
use arl_robot::{Robot, regular_file};
use arl_terminal::failure::Failure;
use arl_terminal::show;
use arl2rs::check::clean;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// The name of the file.
pub const NAME: &str = "arl.toml";

/// Whether this is not a file but means that there is no scenario, whatever the file says.
pub fn is_no_scenario(io: &Path) -> bool {
    io == Path::new("none")
}

/// The contents of the file.
#[derive(Clone, Default, PartialEq, Deserialize, Debug)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct ArlToml {
    /// A built-in robot or a robot file.
    pub robot: Option<String>,
    /// The cell file.
    pub cell: Option<PathBuf>,
    /// The scenario of a run.
    pub io: Option<PathBuf>,
    /// The folder that contains the program's files.
    pub script_dir: Option<PathBuf>,
    /// How programs are run.
    pub engine: Option<EngineChoice>,
    /// The path at which it was found.
    #[serde(skip)]
    pub path: PathBuf,
    /// The line numbers of its keys.
    #[serde(skip)]
    lines: Vec<(String, u32)>,
}

/// The file that applies to a program, if there is one.
///
/// # Errors
/// The file cannot be read, or has invalid contents.
pub fn of_program(program: &Path) -> Result<Option<ArlToml>, Failure> {
    match find(program) {
        Some(path) => read(&path).map(Some),
        None => Ok(None),
    }
}

/// The path of the file that applies to a program.
pub fn find(program: &Path) -> Option<PathBuf> {
    // `../other/p.arl` lies in the other folder only, not also in this one.
    let program = clean(&std::path::absolute(program).ok()?);
    program.ancestors().skip(1).map(|folder| folder.join(NAME)).find(|path| is_there(path))
}

/// Whether anything but a folder has this name: something that is not a regular file is refused, not skipped.
fn is_there(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|about| !about.is_dir())
}

/// Reads the file, which is given by its absolute path; the paths in it then become absolute, too.
///
/// # Errors
/// The file cannot be read, or a line is not valid: the error gives the line and what is allowed.
pub fn read(path: &Path) -> Result<ArlToml, Failure> {
    let text = regular_file::read_text(path).map_err(|error| Failure::io("read", path, &error))?;
    let source = Source { file: NAME, text: &text };
    let mut file: ArlToml = toml::from_str(&text).map_err(|error| {
        let line = source.line(error.span().map_or(0, |span| span.start));
        Failure::Usage(format!("{}:{line}: {}", show::path(path).display(), error.message().trim_end()))
    })?;
    // Absolute, because the program may be run in another folder.
    let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
    for place in [&mut file.cell, &mut file.io, &mut file.script_dir].into_iter().flatten() {
        *place = folder.join(&*place);
    }
    if let Some(robot) = &mut file.robot
        && Robot::text(robot).is_none()
    {
        let beside = folder.join(&*robot);
        if beside.is_file() || beside.extension().is_some() {
            *robot = beside.display().to_string();
        }
    }
    file.path = path.to_path_buf();
    let table = source.parse().map_err(|error| Failure::Usage(error.to_string()))?;
    file.lines = table.get_ref().keys().map(|key| (key.get_ref().to_string(), source.line(key.span().start))).collect();
    Ok(file)
}

/// A setting of the file: its name, and where it is stored in the command and in the file.
type Entry<'a> = (&'a str, Slot<'a>);

enum Slot<'a> {
    Robot(&'a mut Option<String>, &'a Option<String>),
    Path(&'a mut Option<PathBuf>, &'a Option<PathBuf>),
    Engine(&'a mut Option<EngineChoice>, &'a Option<EngineChoice>),
}

impl Slot<'_> {
    /// The problem with a value taken from the file: it does not exist.
    fn problem(&self) -> Option<String> {
        match self {
            Slot::Robot(None, Some(robot)) => Some(robots::text(Some(robot)).err()?.to_string()),
            Slot::Path(None, Some(path)) if !path.exists() => {
                Some(format!("there is no {}", show::path(path).display()))
            }
            _ => None,
        }
    }
}

/// Takes from `file` what the command line does not give; if `tells` is set, shows the source of each value.
///
/// # Errors
/// Something that the file names does not exist: the error names it and the line.
fn fill<'a>(file: &ArlToml, tells: bool, entries: impl IntoIterator<Item = Entry<'a>>) -> Result<(), Failure> {
    let mut origins = String::new();
    for (name, slot) in entries {
        if let Some(problem) = slot.problem() {
            let line = file.lines.iter().find(|(key, _)| key == name).map_or(1, |(_, line)| *line);
            return Err(Failure::Usage(format!("{}:{line}: {name}: {problem}", show::path(&file.path).display())));
        }
        let (was_given, value) = match slot {
            Slot::Robot(own, other) => (own.is_some(), take(own, other).map(PathBuf::from)),
            Slot::Path(own, other) => (own.is_some(), take(own, other)),
            Slot::Engine(own, other) => (own.is_some(), take(own, other).map(|choice| choice.name().into())),
        };
        if let Some(value) = value {
            let from = if was_given { "the command line".into() } else { show::path(&file.path).display().to_string() };
            origins += &format!("{name}: {} ({from})\n", show::path(&value).display());
        }
    }
    if tells {
        show::say(&origins);
    }
    Ok(())
}

fn take<T: Clone>(own: &mut Option<T>, other: &Option<T>) -> Option<T> {
    if own.is_none() {
        own.clone_from(other);
    }
    own.clone()
}

impl Checking {
    /// These options, supplemented by the `arl.toml` of a program. With `--verbose` the source of each value is shown.
    ///
    /// # Errors
    /// The program does not exist or is not an ARL file; a file beside or above it cannot be read, or names something
    /// that does not exist.
    pub fn of_program(&self, program: &Path) -> Result<Self, Failure> {
        program_path::check(program)?;
        self.with(&of_program(program)?.unwrap_or_default())
    }

    /// These options, supplemented by a file.
    ///
    /// # Errors
    /// Something that the file names does not exist.
    pub fn with(&self, file: &ArlToml) -> Result<Self, Failure> {
        let mut all = self.clone();
        let entries = [
            ("robot", Slot::Robot(&mut all.robot, &file.robot)),
            ("cell", Slot::Path(&mut all.cell, &file.cell)),
            ("script-dir", Slot::Path(&mut all.script_dir, &file.script_dir)),
        ];
        fill(file, self.verbose, entries)?;
        Ok(all)
    }
}

impl RunOptions {
    /// These options, supplemented by the `arl.toml` of a program. With `--verbose` the source of each value is shown.
    ///
    /// # Errors
    /// As for [`Checking::of_program`].
    pub fn of_program(&self, program: &Path) -> Result<Self, Failure> {
        program_path::check(program)?;
        let file = of_program(program)?.unwrap_or_default();
        let mut all = self.clone();
        let entries = [
            ("robot", Slot::Robot(&mut all.robot, &file.robot)),
            ("cell", Slot::Path(&mut all.cell, &file.cell)),
            ("io", Slot::Path(&mut all.io, &file.io)),
            ("script-dir", Slot::Path(&mut all.script_dir, &file.script_dir)),
            ("engine", Slot::Engine(&mut all.engine, &file.engine)),
        ];
        fill(&file, self.verbose, entries)?;
        all.io = all.io.filter(|io| !is_no_scenario(io));
        Ok(all)
    }
}
