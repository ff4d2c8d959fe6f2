//! `[[channel]]` and `load` of the cell file: the programs that run beside the first one, and those that can be loaded.

use std::path::{Path, PathBuf};

use toml::de::DeValue;

use super::{HOMES, POSITIONS, numbers};
use crate::settings::{Section, SettingsError, Source, Value, table};

const CHANNEL: &[&str] = &["program", "robot", "background", "load", "home2", "home3", "home4", "home5"];

/// A channel beside the first one.
#[derive(Clone, PartialEq, Debug)]
pub struct CellChannel {
    /// The program's file, as the cell file names it.
    pub program: String,
    /// The robot's name or file; none: the default one.
    pub robot: Option<String>,
    /// Whether it has no robot.
    pub background: bool,
    /// The programs that `switcharl` can load here, as the cell file names them.
    pub load: Vec<String>,
    /// Home points 2 to 5 of its robot: axis positions in deg (mm where linear).
    pub homes: [Option<Vec<f64>>; 4],
}

impl CellChannel {
    /// All channels of a cell file.
    pub(super) fn read_all(source: Source<'_>, top: &Section<'_>, folder: &Path) -> Result<Vec<Self>, SettingsError> {
        let Some(found) = top.find("channel") else { return Ok(Vec::new()) };
        let what = "tables that begin with [[channel]]";
        let tables = found.get_ref().as_array().ok_or_else(|| top.wrong("channel", found, what))?;
        tables.iter().map(|table| Self::read(source, table, folder)).collect()
    }

    fn read(source: Source<'_>, value: &Value<'_>, folder: &Path) -> Result<Self, SettingsError> {
        let section = table(source, value, "[[channel]]", CHANNEL)?;
        let program = section.text("program", "the file of a program")?;
        let program =
            program.ok_or_else(|| source.error(value.span(), "[[channel]] lacks `program`: the file to run"))?;
        let background = match section.find("background") {
            None => false,
            Some(found) => match found.get_ref() {
                DeValue::Boolean(background) => *background,
                _ => return Err(section.wrong("background", found, "true or false")),
            },
        };
        let robot = section.text("robot", "the name or the file of a robot")?;
        if background && robot.is_some() {
            return Err(
                source.error(value.span(), "[[channel]] has both `background` and `robot`: expected one of them")
            );
        }
        let mut homes = [const { None }; 4];
        for (place, key) in homes.iter_mut().zip(HOMES) {
            *place = numbers(&section, key, POSITIONS)?;
        }
        Ok(Self {
            program: program.to_owned(),
            robot: robot.map(|robot| beside(folder, robot)),
            background,
            load: load(&section)?,
            homes,
        })
    }
}

/// `load`: programs that `switcharl` can load.
pub(super) fn load(section: &Section<'_>) -> Result<Vec<String>, SettingsError> {
    const WHAT: &str = "a list of programs, like [\"recipe1.arl\", \"recipe2.arl\"]";
    let Some(value) = section.find("load") else { return Ok(Vec::new()) };
    let array = value.get_ref().as_array().ok_or_else(|| section.wrong("load", value, WHAT))?;
    let files = array.iter().map(|item| match item.get_ref() {
        DeValue::String(file) => Ok(file.to_string()),
        _ => Err(section.wrong("load", item, WHAT)),
    });
    files.collect()
}

/// A robot file beside the cell file, or the name of a built-in robot.
fn beside(folder: &Path, robot: &str) -> String {
    let file: PathBuf = folder.join(robot);
    if file.is_file() { file.display().to_string() } else { robot.to_owned() }
}
