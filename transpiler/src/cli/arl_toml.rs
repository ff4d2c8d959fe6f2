//! `arl.toml`: what a command does not say of the robot and the cell that programs are for. It lies beside a program, or
//! in a folder above it; its paths count from its own folder. What the command says goes first.

use super::args::{Checking, RunOptions};
use super::failure::Failure;
use super::program_path;
use super::show;
use crate::check::clean;
use arl_robot::settings::Source;
use arl_robot::{Robot, regular_file};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// How the file is called.
pub(super) const NAME: &str = "arl.toml";

/// The file.
#[derive(Clone, Default, PartialEq, Deserialize, Debug)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(super) struct ArlToml {
    /// A built-in robot or a robot file.
    pub(super) robot: Option<String>,
    /// The cell file.
    pub(super) cell: Option<PathBuf>,
    /// The scenario of a run.
    pub(super) io: Option<PathBuf>,
    /// The folder that the program's files are in.
    pub(super) script_dir: Option<PathBuf>,
    /// Where it was found.
    #[serde(skip)]
    pub(super) path: PathBuf,
}

/// The file that holds for a program; none where there is none.
///
/// # Errors
/// It cannot be read, or says what it cannot say.
pub(super) fn of_program(program: &Path) -> Result<Option<ArlToml>, Failure> {
    match find(program) {
        Some(path) => read(&path).map(Some),
        None => Ok(None),
    }
}

/// Where the file is that holds for a program.
pub(super) fn find(program: &Path) -> Option<PathBuf> {
    // `../other/p.arl` lies in the other folder, and not in this one, too.
    let program = clean(&std::path::absolute(program).ok()?);
    program.ancestors().skip(1).map(|folder| folder.join(NAME)).find(|path| path.is_file())
}

/// Reads the file, which is given in full; so are then the paths in it.
pub(super) fn read(path: &Path) -> Result<ArlToml, Failure> {
    let text = regular_file::read_text(path).map_err(|error| Failure::io("read", path, &error))?;
    let mut file: ArlToml = toml::from_str(&text).map_err(|error| {
        let start = error.span().map_or(0, |span| span.start);
        let line = Source { file: NAME, text: &text }.line(start);
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
    Ok(file)
}

/// Where a command keeps one of the things that the file says: its name, and the place in the command and in the file.
type Entry<'a> = (&'a str, Slot<'a>);

enum Slot<'a> {
    Text(&'a mut Option<String>, Option<String>),
    Path(&'a mut Option<PathBuf>, Option<PathBuf>),
}

/// Takes from `file` what was not said; where that is wanted, it is told what came from where.
fn fill<'a>(file: &Path, tells: bool, entries: impl IntoIterator<Item = Entry<'a>>) {
    let mut said = String::new();
    for (name, slot) in entries {
        let (was_said, value) = match slot {
            Slot::Text(own, other) => (own.is_some(), take(own, other).map(PathBuf::from)),
            Slot::Path(own, other) => (own.is_some(), take(own, other)),
        };
        if let Some(value) = value {
            let from = if was_said { "the command line".into() } else { show::path(file).display().to_string() };
            said += &format!("{name}: {} ({from})\n", show::path(&value).display());
        }
    }
    if tells {
        show::say(&said);
    }
}

fn take<T: Clone>(own: &mut Option<T>, other: Option<T>) -> Option<T> {
    if own.is_none() {
        *own = other;
    }
    own.clone()
}

impl Checking {
    /// The same, with what the `arl.toml` of a program says besides. With `--verbose` it is told what came from where.
    pub(super) fn of_program(&self, program: &Path) -> Result<Self, Failure> {
        program_path::check(program)?;
        let file = of_program(program)?.unwrap_or_default();
        let mut all = self.clone();
        let entries = [
            ("robot", Slot::Text(&mut all.robot, file.robot)),
            ("cell", Slot::Path(&mut all.cell, file.cell)),
            ("script-dir", Slot::Path(&mut all.script_dir, file.script_dir)),
        ];
        fill(&file.path, self.verbose, entries);
        Ok(all)
    }
}

impl RunOptions {
    /// The same, with what the `arl.toml` of a program says besides. With `--verbose` it is told what came from where.
    pub(super) fn of_program(&self, program: &Path) -> Result<Self, Failure> {
        program_path::check(program)?;
        let file = of_program(program)?.unwrap_or_default();
        let mut all = self.clone();
        let entries = [
            ("robot", Slot::Text(&mut all.robot, file.robot)),
            ("cell", Slot::Path(&mut all.cell, file.cell)),
            ("io", Slot::Path(&mut all.io, file.io)),
            ("script-dir", Slot::Path(&mut all.script_dir, file.script_dir)),
        ];
        fill(&file.path, self.verbose, entries);
        Ok(all)
    }
}
