//! The prelude of emitted code: everything that a compiled program names.

pub use std::cell::Cell;
pub use std::pin::pin;
pub use std::rc::Rc;

pub use crate::builtins::clock::Clock;
pub use crate::builtins::communication::melsec::{self, MelsecDev};
pub use crate::builtins::communication::modbus_rtu::{self, ModbusDev};
pub use crate::builtins::communication::serial::{self, Iodev};
pub use crate::builtins::communication::socket::{self, Socket};
pub use crate::builtins::ops::*;
pub use crate::builtins::part::{Leave, part};
pub use crate::builtins::{
    bits, calibration, channel, clock, convert, devicenet, event, files, flow, frames, io, math, modbus_tcp, motion,
    points, pose, strings, system, text, time,
};
pub use crate::command::{in_process, interrupts, program_main};
pub use crate::context::cx::Cx;
pub use crate::context::function_frame::FunctionFrame;
pub use crate::context::nesting::{Entered, Nesting};
pub use crate::context::program::{Beside, BoxFuture, Program};
pub use crate::context::shown::{Shown, ShownHandle};
pub use crate::fault::{At, Called, Done, Fault, File, Stop};
pub use crate::storage::data::{DataFile, DataVar};
pub use crate::storage::slots::Slots;
pub use crate::values::*;
pub use arl_robot::robot::Family;
