//! The channels of a cell file: which of the compiled programs run where.

use std::fs::File;
use std::path::{Path, PathBuf};

use super::{Other, SetupFailure};
use crate::cell::{Cell, CellChannel};
use crate::controller::{Builder, Foreground};
use crate::robot::Robot;

/// Adds the channels of the cell, and the programs that can be loaded. `trace` is where the first channel's trace goes.
pub(super) fn add(
    mut builder: Builder,
    cell: &Cell,
    others: &[Other],
    trace: Option<&Path>,
) -> Result<Builder, SetupFailure> {
    let mut number = 1;
    for channel in &cell.programs {
        let CellChannel { program, robot, background, load, homes } = channel;
        let make = find(others, program)?;
        if *background {
            builder = builder.background(make());
        } else {
            number += 1;
            let mut foreground = Foreground::new(make()).homes(homes.clone());
            if let Some(robot) = robot {
                foreground = foreground.robot(Robot::load(robot).map_err(SetupFailure::usage)?);
            }
            if let Some(path) = trace.map(|path| numbered(path, number)) {
                let file = File::create(&path);
                let file = file.map_err(|error| SetupFailure::usage(format!("{}: {error}", path.display())))?;
                foreground = foreground.trace(file);
            }
            builder = builder.foreground(foreground);
        }
        builder = loadable(builder, load, others)?;
    }
    loadable(builder, &cell.load, others)
}

fn loadable(mut builder: Builder, files: &[String], others: &[Other]) -> Result<Builder, SetupFailure> {
    for file in files {
        let make = find(others, file)?;
        let name = Path::new(file).file_name().map(|name| name.to_string_lossy().into_owned());
        builder = builder.loadable(name.unwrap_or_else(|| file.clone()), make);
    }
    Ok(builder)
}

fn find(others: &[Other], file: &str) -> Result<super::Make, SetupFailure> {
    let found = others.iter().find(|other| other.file == file).map(|other| other.make);
    found.ok_or_else(|| {
        SetupFailure::usage(format!("the cell names the program {file}, which was not compiled together with this one"))
    })
}

/// `trace.csv` for channel 2 is `trace.2.csv`.
fn numbered(path: &Path, number: u8) -> PathBuf {
    let extension = path.extension().map_or_else(String::new, |extension| format!(".{}", extension.to_string_lossy()));
    path.with_extension(format!("{number}{extension}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_channel_has_a_trace_of_its_own() {
        assert_eq!(numbered(Path::new("a/t.csv"), 2), Path::new("a/t.2.csv"));
        assert_eq!(numbered(Path::new("trace"), 3), Path::new("trace.3"));
    }
}
