//! The drivers that cell files ask for.

use arl_rt::cell::{DriverSettings, DriverTime, Protocol};
use arl_rt::robot_driver::{Driven, DrivenTime, DriverError};

use crate::rsi::RsiArm;
use crate::udp::UdpArm;

/// Makes the driver that `[driver]` of a cell file asks for: what [`arl_rt::Builder::drivers`] wants. Nothing is opened
/// yet.
///
/// # Errors
/// The protocol is one that this crate does not know.
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
            let beat = arm.beat();
            Ok(Driven { driver: Box::new(arm), time: DrivenTime::Beat(Box::new(beat)) })
        }
        other => Err(format!("this program has no driver for {other:?}").into()),
    }
}
