//! Inputs and outputs: the image that programs work on, the interface to real signals, and the scenario that simulates
//! the outside.
//!
//! It imports `cycle` and `fault`.

mod analog_row;
mod bits;
mod channel;
mod driver;
mod image;
mod scenario;

pub use arl_motion::Override;
pub use arl_robot::channels::{AnalogType, Channels};
pub use channel::OutputSignal;
pub use driver::{DriverError, IoDriver, SimulatedIo};
pub use image::{Image, Inputs, Outputs, Pwm};
pub use scenario::{Pendant, Scenario};

pub(crate) use image::Digital;
pub(crate) use scenario::{AxisName, Effect, Order, Playing, RobotEffect};
