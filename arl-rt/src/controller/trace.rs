//! The trace: one row of CSV per cycle, from which tests and plots see what the robot did.

use std::fmt;
use std::io::{self, BufWriter, Write};

use crate::fault::File;
use crate::unit::Unit;

/// How many columns a trace has.
pub(crate) const COLUMNS: usize = 21;

/// The names of the columns: the start of the cycle in s, the line and the number of the motion, the axes in deg (mm),
/// the TCP in mm and deg.
pub(crate) const HEADER: &str = "t,line,motion,j1,j2,j3,j4,j5,j6,ej1,ej2,ej3,ej4,ej5,ej6,x,y,z,a,b,c";

/// The optional column behind them, with the file that the line belongs to.
pub(crate) const FILE_COLUMN: &str = "file";

/// The columns of a trace behind those that every trace has.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(crate) struct More {
    /// [`FILE_COLUMN`].
    pub(crate) file: bool,
}

impl More {
    /// Reads the names of columns, separated by commas.
    ///
    /// # Errors
    /// There is no such column; the message names it.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let mut more = Self::default();
        for name in text.split(',').map(str::trim) {
            match name {
                FILE_COLUMN => more.file = true,
                _ => return Err(format!("`{name}` is not a column: expected {FILE_COLUMN}")),
            }
        }
        Ok(more)
    }
}

/// Writes one row per cycle.
pub(crate) struct Trace {
    more: More,
    out: BufWriter<Box<dyn Write>>,
    /// Whether its first line is written: what is written goes on to the file only when the buffer is full or flushed.
    is_begun: bool,
    /// The first error, until it is reported.
    error: Option<io::Error>,
    /// Whether an error occurred: nothing is written after it, even where it was reported and a program begins again.
    is_broken: bool,
}

impl Trace {
    pub(crate) fn new(writer: Box<dyn Write>, more: More) -> Self {
        let out = BufWriter::with_capacity(1 << 16, writer);
        Self { more, out, is_begun: false, error: None, is_broken: false }
    }

    /// Writes the row of a cycle that began at `time` in s.
    pub(crate) fn row(&mut self, time: f64, unit: &Unit) {
        if !self.is_broken {
            self.error = self.write(time, unit).err();
            self.is_broken = self.error.is_some();
        }
    }

    fn write(&mut self, time: f64, unit: &Unit) -> io::Result<()> {
        self.begin()?;
        let [time, line, motion, places @ ..] = columns(time, unit);
        write!(self.out, "{time:.6},{},{}", line as u64, motion as u64)?;
        for place in places {
            if place.is_nan() {
                write!(self.out, ",")?;
            } else {
                write!(self.out, ",{place:.9}")?;
            }
        }
        if self.more.file {
            write!(self.out, ",{}", Field(unit.executing_file().map_or("", File::name)))?;
        }
        writeln!(self.out)
    }

    /// Writes the first line if that was not done.
    fn begin(&mut self) -> io::Result<()> {
        if std::mem::replace(&mut self.is_begun, true) {
            return Ok(());
        }
        match self.more.file {
            true => writeln!(self.out, "{HEADER},{FILE_COLUMN}"),
            false => writeln!(self.out, "{HEADER}"),
        }
    }

    /// Writes out what is still buffered.
    pub(crate) fn flush(&mut self) -> io::Result<()> {
        match self.error.take() {
            Some(error) => Err(error),
            None if self.is_broken => Ok(()),
            None => self.begin().and_then(|()| self.out.flush()).inspect_err(|_| self.is_broken = true),
        }
    }
}

/// A text as a field of CSV: in quotes where necessary.
struct Field<'a>(&'a str);

impl fmt::Display for Field<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.0.contains([',', '"', '\n', '\r']) {
            return f.write_str(self.0);
        }
        f.write_str("\"")?;
        for part in self.0.split_inclusive('"') {
            f.write_str(part)?;
            if part.ends_with('"') {
                f.write_str("\"")?;
            }
        }
        f.write_str("\"")
    }
}

/// The row of a cycle that began at `time` in s; the values of axes that do not exist are NaN.
pub(crate) fn columns(time: f64, unit: &Unit) -> [f64; COLUMNS] {
    let (line, motion) = unit.executing();
    let (robot, joints) = (unit.robot(), unit.setpoint());
    let there = |axes: [f64; 6], count: usize| {
        let mut at = 0..count;
        axes.map(|axis| at.next().map_or(f64::NAN, |_| axis))
    };
    let [j1, j2, j3, j4, j5, j6] = there(joints.axes, robot.own_axes().len());
    let [ej1, ej2, ej3, ej4, ej5, ej6] = there(joints.external, robot.external_axes().len());
    let [x, y, z, a, b, c] = unit.commanded_tcp();
    let (line, motion) = (f64::from(line), motion as f64);
    [time, line, motion, j1, j2, j3, j4, j5, j6, ej1, ej2, ej3, ej4, ej5, ej6, x, y, z, a, b, c]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_are_fields() {
        let field = |name| Field(name).to_string();
        assert_eq!(["a.arl", "a,b.arl", "a\"b.arl"].map(field), ["a.arl", "\"a,b.arl\"", "\"a\"\"b.arl\""]);
    }
}
