//! The trace: one row of CSV a cycle, from which tests and plots see what the robot did.

use std::io::{self, BufWriter, Write};

use crate::unit::Unit;
use arl_robot::robot::{Family, own_axes};

const HEADER: &str = "t,line,motion,j1,j2,j3,j4,j5,j6,ej1,ej2,ej3,ej4,ej5,ej6,x,y,z,a,b,c";

/// Writes one row a cycle.
pub(crate) struct Trace {
    out: BufWriter<Box<dyn Write>>,
    own_axes: usize,
    /// The first thing that went wrong; nothing is written after it.
    error: Option<io::Error>,
}

impl Trace {
    pub(crate) fn new(writer: Box<dyn Write>, family: Family) -> io::Result<Self> {
        let mut out = BufWriter::with_capacity(1 << 16, writer);
        writeln!(out, "{HEADER}")?;
        Ok(Self { out, own_axes: own_axes(family), error: None })
    }

    /// The row of a cycle that began at `time` seconds.
    pub(crate) fn row(&mut self, time: f64, unit: &Unit) {
        if self.error.is_none() {
            self.error = self.write(time, unit).err();
        }
    }

    fn write(&mut self, time: f64, unit: &Unit) -> io::Result<()> {
        let (line, motion) = unit.executing();
        let joints = unit.setpoint();
        write!(self.out, "{time:.6},{line},{motion}")?;
        for (at, axis) in joints.axes.iter().enumerate() {
            if at < self.own_axes {
                write!(self.out, ",{axis:.9}")?;
            } else {
                write!(self.out, ",")?;
            }
        }
        let external = unit.robot().external_axes().len();
        for (at, axis) in joints.external.iter().enumerate() {
            if at < external {
                write!(self.out, ",{axis:.9}")?;
            } else {
                write!(self.out, ",")?;
            }
        }
        for component in unit.commanded_tcp() {
            write!(self.out, ",{component:.9}")?;
        }
        writeln!(self.out)
    }

    /// Hands over what is still buffered.
    pub(crate) fn flush(&mut self) -> io::Result<()> {
        match self.error.take() {
            Some(error) => Err(error),
            None => self.out.flush(),
        }
    }
}
