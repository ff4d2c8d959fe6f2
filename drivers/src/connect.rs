//! Creation of the drivers that cell files select.

use arl_rt::cell::{DriverSettings, DriverTime, Protocol};
use arl_rt::robot_driver::{Driven, DrivenTime, DriverError};

use crate::rsi::RsiArm;
use crate::udp::UdpArm;

/// Creates the driver selected by `[driver]` of a cell file, for [`arl_rt::Builder::drivers`]. Nothing is opened yet.
///
/// # Errors
/// This crate does not have a driver for the protocol.
pub fn connect(settings: &DriverSettings) -> Result<Driven, DriverError> {
    let waits = settings.time == DriverTime::Robot;
    match &settings.protocol {
        Protocol::Udp { address } => {
            let arm = UdpArm::new(address);
            let (arm, time) = if waits { (arm.in_its_own_time(), DrivenTime::Robot) } else { (arm, DrivenTime::World) };
            Ok(Driven { driver: Box::new(arm), time })
        }
        Protocol::Rsi { listen, address } => {
            let arm = match address {
                Some(address) => RsiArm::of_robot(listen, address),
                None => RsiArm::new(listen),
            };
            let arm = if waits { arm.in_its_own_time() } else { arm };
            let clock = arm.clock();
            Ok(Driven { driver: Box::new(arm), time: DrivenTime::Clock(Box::new(clock)) })
        }
        other => Err(format!("this program has no driver for {other:?}").into()),
    }
}
