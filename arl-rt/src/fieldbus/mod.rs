//! Field buses: DeviceNet, the Modbus TCP server, and I/O islands over Modbus TCP.
//!
//! All communication with the outside runs on threads outside the cycle. Pure functions convert bytes into requests and
//! back; they accept any bytes safely.

mod buses;
pub mod devicenet;
pub(crate) mod islands;
pub(crate) mod modbus;
mod modbus_tcp;
#[cfg(test)]
pub(crate) mod noise;

pub(crate) use arl_robot::cell::{BusSettings, ModbusTcpSettings};
pub(crate) use buses::Buses;
