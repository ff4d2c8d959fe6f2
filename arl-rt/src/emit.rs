//! The prelude of emitted code: everything that a compiled program names.

pub use std::cell::Cell;
pub use std::rc::Rc;

pub use crate::clock::Clock;
pub use crate::communication::melsec::{self, MelsecDev};
pub use crate::communication::modbus_rtu::{self, ModbusDev};
pub use crate::communication::serial::{self, Iodev};
pub use crate::communication::socket::{self, Socket};
pub use crate::cx::Cx;
pub use crate::fault::{At, Done, Fault, File, Stop};
pub use crate::fieldbus::{devicenet, modbus_tcp};
pub use crate::ops::*;
pub use crate::program::{Beside, BoxFuture, DataFile, DataVar, Program};
pub use crate::robot::Family;
pub use crate::values::*;
pub use crate::{
    bits, calibration, channel, clock, convert, event, files, flow, frames, io, math, motion, points, pose, strings,
    system, text, time,
};
