//! Drivers for robots that are moved by [`arl_rt`].
//!
//! - [`udp::UdpArm`]: packets of set-points over UDP, for arms with a self-written receiver, and for simulators
//! - [`rsi::RsiArm`]: XML over UDP, as KUKA's RobotSensorInterface sends it
//!
//! `docs/udp-and-rsi.md` describes their formats, and what the other side has to do. [`connect`] creates them according
//! to a cell file:
//!
//! ```no_run
//! # fn drive(program: Box<dyn arl_rt::Program>) -> Result<(), Box<dyn std::error::Error>> {
//! let cell = arl_rt::Cell::load("cell.toml".as_ref())?;
//! let mut controller = arl_rt::Controller::builder().cell(cell).drivers(arl_drivers::connect).build(program)?;
//! println!("{}", controller.run());
//! # Ok(())
//! # }
//! ```

mod connect;
mod patience;
mod position;
mod readable;
pub mod rsi;
pub mod udp;

pub use connect::connect;

/// Runs the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
