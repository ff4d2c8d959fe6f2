//! `arl.toml`: what a command does not say of the robot and the cell that programs are for. It lies beside a program, or
//! in a folder above it; its paths count from its own folder. What the command says goes first.

use super::args::{Checking, RunOptions};
use super::failure::Failure;
use super::show;
use crate::check::clean;
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
        let line = text.get(..start).unwrap_or("").matches('\n').count() + 1;
        Failure::Usage(format!("{}:{line}: {}", shown(path).display(), error.message().trim_end()))
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

/// The path as short as it can be said from where the command runs.
fn shown(path: &Path) -> PathBuf {
    let here = std::env::current_dir().unwrap_or_default();
    path.strip_prefix(&here).unwrap_or(path).to_path_buf()
}

/// Takes from `file` what was not said, and tells which is from where.
struct Fill<'a> {
    file: &'a ArlToml,
    said: String,
}

impl<'a> Fill<'a> {
    fn new(file: &'a ArlToml) -> Self {
        Self { file, said: String::new() }
    }

    fn take<T: Clone>(&mut self, name: &str, own: &mut Option<T>, other: &Option<T>, text: impl Fn(&T) -> String) {
        let from = match (&own, other) {
            (Some(_), _) => "the command line".to_owned(),
            (None, Some(_)) => shown(&self.file.path).display().to_string(),
            (None, None) => return,
        };
        if own.is_none() {
            own.clone_from(other);
        }
        if let Some(value) = own {
            let value = text(value);
            self.said += &format!("{name}: {} ({from})\n", shown(Path::new(&value)).display());
        }
    }
}

fn path_text(path: &Path) -> String {
    path.display().to_string()
}

impl Checking {
    /// The same, with what the `arl.toml` of a program says besides. With `--verbose` it is told what came from where.
    pub(super) fn of_program(&self, program: &Path) -> Result<Self, Failure> {
        let file = of_program(program)?.unwrap_or_default();
        let mut all = self.clone();
        let mut fill = Fill::new(&file);
        fill.take("robot", &mut all.robot, &file.robot, String::clone);
        fill.take("cell", &mut all.cell, &file.cell, |path| path_text(path));
        fill.take("script-dir", &mut all.script_dir, &file.script_dir, |path| path_text(path));
        if self.verbose {
            show::say(&fill.said);
        }
        Ok(all)
    }
}

impl RunOptions {
    /// The same, with what the `arl.toml` of a program says besides. With `--verbose` it is told what came from where.
    pub(super) fn of_program(&self, program: &Path) -> Result<Self, Failure> {
        let file = of_program(program)?.unwrap_or_default();
        let mut all = self.clone();
        let mut fill = Fill::new(&file);
        fill.take("robot", &mut all.robot, &file.robot, String::clone);
        fill.take("cell", &mut all.cell, &file.cell, |path| path_text(path));
        fill.take("io", &mut all.io, &file.io, |path| path_text(path));
        fill.take("script-dir", &mut all.script_dir, &file.script_dir, |path| path_text(path));
        if self.verbose {
            show::say(&fill.said);
        }
        Ok(all)
    }
}
