//! The channels of a cell file: which of the given programs run where.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::builder::{Builder, SetupError};
use super::foreground::Foreground;
use crate::context::program::{Elsewhere, Other, Program};
use crate::values;
use arl_robot::cell::{Cell, CellChannel};
use arl_robot::robot::Robot;

impl Builder {
    /// Sets the cell, together with the channels that it names; `programs` are the programs that it may name.
    ///
    /// # Errors
    /// The cell names a program that is not among them, or a robot that does not exist.
    pub fn cell_with(mut self, cell: Cell, programs: &[Other]) -> Result<Self, SetupError> {
        for channel in &cell.programs.channels {
            let CellChannel { program, robot, background, load, homes, collisions, stands, driver, line: _ } = channel;
            let program = find(programs, program)?.make();
            self = if *background {
                self.background(program)
            } else {
                let mut channel = Foreground::new(program).homes(homes.clone()).collisions(collisions.clone());
                if let Some(robot) = robot {
                    channel = channel.robot(Robot::load(robot)?);
                }
                if let Some(base) = stands.base {
                    channel = channel.base(values::Frame::of_components(base));
                }
                if let Some(driver) = driver {
                    channel = channel.driver_settings(driver.clone());
                }
                self.foreground(channel)
            };
            self = loadable(self, load, programs)?;
        }
        self = loadable(self, &cell.programs.load, programs)?;
        Ok(self.cell(cell))
    }

    /// The writer for the trace of the robot of a foreground channel, as CSV. For a channel that does not exist nothing
    /// is written.
    pub fn trace_of(mut self, number: u8, writer: impl Write + 'static) -> Self {
        if number == 1 {
            return self.trace(writer);
        }
        if let Some(channel) = self.others_mut().get_mut(usize::from(number).wrapping_sub(2)) {
            channel.body.trace = Some(Box::new(writer));
        }
        self
    }
}

fn loadable(mut builder: Builder, files: &[String], programs: &[Other]) -> Result<Builder, SetupError> {
    for file in files {
        let program = find(programs, file)?;
        let name = Path::new(file).file_name().map(|name| name.to_string_lossy().into_owned());
        builder = builder.loadable(name.unwrap_or_else(|| file.clone()), move || program.make());
    }
    Ok(builder)
}

fn find(programs: &[Other], file: &str) -> Result<Other, SetupError> {
    programs.iter().find(|other| other.file == file).copied().ok_or_else(|| {
        let text = format!("the cell names the program {file}, which was not compiled together with this one");
        SetupError::Channels(text)
    })
}

impl Other {
    /// Makes a new program, with its data files in its own folder.
    fn make(&self) -> Box<dyn Program> {
        let program = (self.make)();
        if self.folder.is_empty() {
            return program;
        }
        Box::new(Elsewhere { program, folder: PathBuf::from(self.folder) })
    }
}
