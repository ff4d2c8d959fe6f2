//! `arl.toml`: what a command does not say of the robot and the cell that programs are for. It lies beside a program,
//! or in a folder above it; its paths count from its own folder. What the command says goes first.

use crate::options::{Checking, RunOptions};
use crate::program_path;
use crate::robots;
use arl_robot::settings::Source;
use arl_robot::{Robot, regular_file};
use arl_terminal::failure::Failure;
use arl_terminal::show;
use arl2rs::check::clean;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// How the file is called.
pub const NAME: &str = "arl.toml";

/// Whether this is no file, but says that there is no scenario, whatever the file says.
pub fn is_no_scenario(io: &Path) -> bool {
    io == Path::new("none")
}

/// The file.
#[derive(Clone, Default, PartialEq, Deserialize, Debug)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct ArlToml {
    /// A built-in robot or a robot file.
    pub robot: Option<String>,
    /// The cell file.
    pub cell: Option<PathBuf>,
    /// The scenario of a run.
    pub io: Option<PathBuf>,
    /// The folder that the program's files are in.
    pub script_dir: Option<PathBuf>,
    /// Where it was found.
    #[serde(skip)]
    pub path: PathBuf,
    /// The lines of its keys.
    #[serde(skip)]
    lines: Vec<(String, u32)>,
}

/// The file that holds for a program; none where there is none.
///
/// # Errors
/// It cannot be read, or says what it cannot say.
pub fn of_program(program: &Path) -> Result<Option<ArlToml>, Failure> {
    match find(program) {
        Some(path) => read(&path).map(Some),
        None => Ok(None),
    }
}

/// Where the file is that holds for a program.
pub fn find(program: &Path) -> Option<PathBuf> {
    // `../other/p.arl` lies in the other folder, and not in this one, too.
    let program = clean(&std::path::absolute(program).ok()?);
    program.ancestors().skip(1).map(|folder| folder.join(NAME)).find(|path| is_there(path))
}

/// Whether there is something of this name but a folder: what is not a regular file is refused, and not passed over.
fn is_there(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|about| !about.is_dir())
}

/// Reads the file, which is given in full; so are then the paths in it.
///
/// # Errors
/// It cannot be read, or a line is not as the file is written: the line, and what it may say.
pub fn read(path: &Path) -> Result<ArlToml, Failure> {
    let text = regular_file::read_text(path).map_err(|error| Failure::io("read", path, &error))?;
    let source = Source { file: NAME, text: &text };
    let mut file: ArlToml = toml::from_str(&text).map_err(|error| {
        let line = source.line(error.span().map_or(0, |span| span.start));
        Failure::Usage(format!("{}:{line}: {}", show::path(path).display(), error.message().trim_end()))
    })?;
    // In full: who runs the program may do it in another folder.
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

/// Where a command keeps one of the things that the file says: its name, and the place in the command and in the file.
type Entry<'a> = (&'a str, Slot<'a>);

enum Slot<'a> {
    Robot(&'a mut Option<String>, &'a Option<String>),
    Path(&'a mut Option<PathBuf>, &'a Option<PathBuf>),
}

impl Slot<'_> {
    /// What is wrong with what is taken from the file: it is not there.
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

/// Takes from `file` what was not said; where that is wanted, it is told what came from where.
///
/// # Errors
/// What the file says is not there: the error names it, and the line.
fn fill<'a>(file: &ArlToml, tells: bool, entries: impl IntoIterator<Item = Entry<'a>>) -> Result<(), Failure> {
    let mut said = String::new();
    for (name, slot) in entries {
        if let Some(problem) = slot.problem() {
            let line = file.lines.iter().find(|(key, _)| key == name).map_or(1, |(_, line)| *line);
            return Err(Failure::Usage(format!("{}:{line}: {name}: {problem}", show::path(&file.path).display())));
        }
        let (was_said, value) = match slot {
            Slot::Robot(own, other) => (own.is_some(), take(own, other).map(PathBuf::from)),
            Slot::Path(own, other) => (own.is_some(), take(own, other)),
        };
        if let Some(value) = value {
            let from = if was_said { "the command line".into() } else { show::path(&file.path).display().to_string() };
            said += &format!("{name}: {} ({from})\n", show::path(&value).display());
        }
    }
    if tells {
        show::say(&said);
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
    /// The same, with what the `arl.toml` of a program says besides. With `--verbose` it is told what came from where.
    ///
    /// # Errors
    /// The program is not there or no file of ARL; a file beside it or above cannot be read, or names what is not
    /// there.
    pub fn of_program(&self, program: &Path) -> Result<Self, Failure> {
        program_path::check(program)?;
        self.with(&of_program(program)?.unwrap_or_default())
    }

    /// The same, with what a file says besides.
    ///
    /// # Errors
    /// It is not there.
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
    /// The same, with what the `arl.toml` of a program says besides. With `--verbose` it is told what came from where.
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
        ];
        fill(&file, self.verbose, entries)?;
        all.io = all.io.filter(|io| !is_no_scenario(io));
        Ok(all)
    }
}
