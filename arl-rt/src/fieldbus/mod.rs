//! Field buses: DeviceNet, the Modbus TCP server, and io islands behind Modbus TCP.
//!
//! Whatever talks to the outside does so on threads beside the cycle. What turns bytes into requests and back is pure
//! functions, which take any bytes without harm.

mod buses;
pub mod devicenet;
pub(crate) mod islands;
pub(crate) mod modbus;
mod modbus_tcp;
#[cfg(test)]
pub(crate) mod noise;

pub(crate) use arl_robot::cell::{BusSettings, ModbusTcpSettings};
pub(crate) use buses::Buses;
