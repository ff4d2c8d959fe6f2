//! Drivers for robots that [`arl_rt`] moves.
//!
//! - [`udp::UdpArm`]: packets of set-points over UDP, for arms whose side one writes oneself, and for simulators
//! - [`rsi::RsiArm`]: XML over UDP, as KUKA's RobotSensorInterface sends it
//!
//! Their formats, and what the other side has to do, stand in `docs/udp-and-rsi.md`. [`connect`] makes them as a cell
//! file asks for:
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

/// The examples of the README run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
