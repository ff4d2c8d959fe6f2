//! The functions and instructions that programs in ARL call.
//!
//! This module contains everything that programs call with a [`Cx`](crate::Cx), and pure functions; state is in the
//! modules below. It imports all modules except `controller` and `command`.

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
