//! The trace: one row of CSV a cycle, from which tests and plots see what the robot did.

use std::io::{self, BufWriter, Write};

use crate::unit::Unit;

/// How many columns a trace has.
pub(crate) const COLUMNS: usize = 21;

/// Their names: the start of the cycle in s, the line and the number of the motion, the axes in deg (mm), the TCP in mm and deg.
pub(crate) const HEADER: &str = "t,line,motion,j1,j2,j3,j4,j5,j6,ej1,ej2,ej3,ej4,ej5,ej6,x,y,z,a,b,c";

/// Writes one row a cycle.
pub(crate) struct Trace {
    out: BufWriter<Box<dyn Write>>,
    /// The first thing that went wrong, until it is told.
    error: Option<io::Error>,
    /// Whether something went wrong: nothing is written after it, also where it was told and a program begins again.
    is_broken: bool,
}

impl Trace {
    pub(crate) fn new(writer: Box<dyn Write>) -> io::Result<Self> {
        let mut out = BufWriter::with_capacity(1 << 16, writer);
        writeln!(out, "{HEADER}")?;
        Ok(Self { out, error: None, is_broken: false })
    }

    /// The row of a cycle that began at `time` seconds.
    pub(crate) fn row(&mut self, time: f64, unit: &Unit) {
        if !self.is_broken {
            self.error = self.write(time, unit).err();
            self.is_broken = self.error.is_some();
        }
    }

    fn write(&mut self, time: f64, unit: &Unit) -> io::Result<()> {
        let [time, line, motion, places @ ..] = columns(time, unit);
        write!(self.out, "{time:.6},{},{}", line as u64, motion as u64)?;
        for place in places {
            if place.is_nan() {
                write!(self.out, ",")?;
            } else {
                write!(self.out, ",{place:.9}")?;
            }
        }
        writeln!(self.out)
    }

    /// Hands over what is still buffered.
    pub(crate) fn flush(&mut self) -> io::Result<()> {
        match self.error.take() {
            Some(error) => Err(error),
            None if self.is_broken => Ok(()),
            None => self.out.flush().inspect_err(|_| self.is_broken = true),
        }
    }
}

/// The row of a cycle that began at `time` seconds; axes that are not there are no numbers.
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
