//! The trait of a DeviceNet bus, which exchanges a buffer of bytes, and a simulated bus.

use std::fmt;

use arl_robot::outline;

/// The interface between programs and a DeviceNet bus: the bytes that the bus exchanges with its devices. The calls
/// must return at once; the exchange runs independently of them.
pub trait DeviceNet {
    /// The number of bytes exchanged; programs can access the offsets below it.
    fn size(&self) -> usize;

    /// Accepts bytes for the bus, from `offset` on. They are within the size.
    ///
    /// # Errors
    /// The bus does not accept them. The code is passed to the program unchanged; it is 100 or more, so that it differs
    /// from the runtime's own codes.
    fn write(&mut self, offset: usize, data: &[u8]) -> Result<(), ErrorCode>;

    /// Fills `data` with bytes received from the bus, from `offset` on. They are within the size.
    ///
    /// # Errors
    /// The bus has no bytes. The code is as for [`DeviceNet::write`].
    fn read(&mut self, offset: usize, data: &mut [u8]) -> Result<(), ErrorCode>;
}

/// The result code of a program's call instead of 0.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ErrorCode(i32);

impl ErrorCode {
    /// An error code of a driver; codes below 100 become 100.
    pub const fn new(code: i32) -> Self {
        Self(if code < 100 { 100 } else { code })
    }

    /// The number.
    pub const fn number(self) -> i32 {
        self.0
    }
}

impl fmt::Display for ErrorCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "bus error code {}", self.0)
    }
}

impl std::error::Error for ErrorCode {}

/// A bus without devices: what is written can be read again. All bytes are 0 at first.
#[derive(Clone)]
pub struct SimulatedDeviceNet(Box<[u8]>);

impl SimulatedDeviceNet {
    /// A bus that exchanges `size` bytes.
    pub fn new(size: usize) -> Self {
        Self(vec![0; size].into())
    }
}

impl Default for SimulatedDeviceNet {
    /// A bus that exchanges 512 bytes.
    fn default() -> Self {
        Self::new(outline::DEVICENET as usize)
    }
}

impl fmt::Debug for SimulatedDeviceNet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SimulatedDeviceNet").finish_non_exhaustive()
    }
}

impl DeviceNet for SimulatedDeviceNet {
    fn size(&self) -> usize {
        self.0.len()
    }

    fn write(&mut self, offset: usize, data: &[u8]) -> Result<(), ErrorCode> {
        if let Some(place) = self.0.get_mut(offset..offset + data.len()) {
            place.copy_from_slice(data);
        }
        Ok(())
    }

    fn read(&mut self, offset: usize, data: &mut [u8]) -> Result<(), ErrorCode> {
        if let Some(place) = self.0.get(offset..offset + data.len()) {
            data.copy_from_slice(place);
        }
        Ok(())
    }
}
