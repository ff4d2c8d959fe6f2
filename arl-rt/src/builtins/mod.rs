//! The functions and instructions that programs in ARL call.
//!
//! Whatever takes a [`Cx`](crate::Cx) and is called by programs is here, and what is pure as well; state is in the
//! rooms below. It imports all rooms but `controller` and `command`.

pub mod bits;
pub mod calibration;
pub mod channel;
pub mod clock;
pub(crate) mod communication;
pub mod convert;
pub mod devicenet;
pub mod event;
pub mod files;
pub mod flow;
pub mod frames;
pub mod io;
pub mod math;
pub mod modbus_tcp;
pub mod motion;
pub(crate) mod ops;
pub(crate) mod part;
pub mod points;
pub mod pose;
mod storing;
pub mod strings;
pub mod system;
pub mod text;
pub mod time;
