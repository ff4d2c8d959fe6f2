//! Everything that ARL has built in, declared once: names, types, parameters, effects, texts and examples.
//!
//! One file per family holds its table, in the notation of `declare`. [`functions`] and its relatives find things by
//! name, [`mod@reference`] writes the pages of the book.

mod auxiliary;
mod bits;
mod calibration;
mod clock;
mod constants;
mod control;
mod convert;
mod declare;
mod devicenet;
mod entry;
mod enums;
mod facts;
mod handles;
mod interrupt;
mod io;
mod lookup;
mod math;
mod melsec;
mod modbus_rtu;
mod modbus_tcp;
mod motion;
mod other;
mod points;
mod pose;
pub mod reference;
mod serial;
mod socket;
mod strings;
mod structs;
mod system;
#[cfg(test)]
mod tests;
mod trigger;
mod types;

pub use entry::*;
pub use facts::*;
pub use lookup::*;
pub use types::*;
