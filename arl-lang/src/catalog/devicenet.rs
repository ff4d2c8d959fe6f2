//! 5.6.3: DeviceNet, a buffer of bytes that is exchanged with the bus.

use super::declare::{base, entries, folded, kind, param_type};
use super::facts::Space;

entries! { pub(super) DEVICENET =
    /// Writes bytes into the bus's buffer: 0, or an error code (offset or length outside the buffer).
    fn dnwrite(
        offset: int [addresses(Space::DeviceNetByte)] "offset of the first byte in the buffer",
        len: int [counts(8), extent(1)] "how many bytes",
        data: [byte] "the bytes",
    ) -> int
        { "5.6.3.1", devicenet::dnwrite, waits, fails; "byte data[3] = {1,2,3}\nprint dnwrite(0,3,data)" }
    /// Reads bytes from the bus's buffer: 0, or an error code (offset or length outside the buffer).
    fn dnread(
        offset: int [addresses(Space::DeviceNetByte)] "offset of the first byte in the buffer",
        len: int [counts(8), extent(1)] "how many bytes",
        data: [byte] [out] "gets the bytes",
    ) -> int
        { "5.6.3.2", devicenet::dnread, waits, fails, alias(&["dhread"]); "byte data[3]\nprint dnread(0,3,data)" }
}
