//! 5.6.5: Melsec. The controller is a client of the PLC (MC protocol, 3E frames).

use super::declare::{base, entries, folded, kind, param_type};
use super::facts::{Accepted, Space};

/// Bytes of a D register; with an odd number of bytes, only the low byte of the last register counts.
const BYTES: u32 = 2;
/// The bytes that one request carries.
const LENGTH: Accepted = Accepted::Range(0, 1920);

entries! { pub(super) MELSEC =
    /// Connects to a PLC; true when the connection is established.
    fn open(
        dev: melsec_dev "the connection",
        ip: string "the PLC's address",
        port: int [accepts(Accepted::Range(1, 65535))] "the PLC's port",
        slave_id: int [accepts(Accepted::RangeOr(0, 247, 255))] "station number, 0 to 247; 0 is all stations, 255 the default",
    ) -> bool
        { "5.6.5.1", melsec::open, waits, fails, connects; "melsec_dev mc\nwaituntil open(mc,\"10.20.220.92\",8080,255)" }
    /// Closes a connection; closing one that is not open does nothing.
    fn close(dev: melsec_dev "the connection")
        { "5.6.5.2", melsec::close, waits; "melsec_dev mc\nclose(mc)" }
    /// Reads D registers as a text; true when it has arrived.
    fn read(
        dev: melsec_dev "the connection",
        data: string [out] "gets the text",
        start: int [addresses(Space::MelsecRegister)] "number of the first D register",
        len: int [extent(BYTES), accepts(LENGTH)] "how many bytes; with an odd number, only the low byte of the last register",
    ) -> bool
        { "5.6.5.3", melsec::read_string, waits, fails;
          "melsec_dev mc\nstring data\nwaituntil open(mc,\"10.20.220.92\",8080,255)\nwaituntil read(mc,data,6000,10)" }
    /// Reads D registers as bytes; true when they have arrived.
    fn read(
        dev: melsec_dev "the connection",
        data: [byte] [out] "gets the bytes",
        start: int [addresses(Space::MelsecRegister)] "number of the first D register",
        len: int [counts(8), extent(BYTES), accepts(LENGTH)] "how many bytes; with an odd number, only the low byte of the last register",
    ) -> bool
        { "5.6.5.3", melsec::read_bytes, waits, fails;
          "melsec_dev mc\nbyte data[24]\nwaituntil open(mc,\"10.20.220.92\",8080,255)\nwaituntil read(mc,data,6000,24)" }
    /// Writes a text into D registers; true when the PLC has taken it.
    fn write(
        dev: melsec_dev "the connection",
        data: string "the text",
        start: int [addresses(Space::MelsecRegister)] "number of the first D register",
        len: int [optional, extent(BYTES), accepts(LENGTH)] "how many bytes; all of the text without it; an odd number writes 0 into the high byte left over",
    ) -> bool
        { "5.6.5.4", melsec::write_string, waits, fails;
          "melsec_dev mc\nwaituntil open(mc,\"10.20.220.92\",8080,255)\nwaituntil write(mc,\"abcd\",6000)" }
    /// Writes bytes into D registers; true when the PLC has taken them.
    fn write(
        dev: melsec_dev "the connection",
        data: [byte] "the bytes",
        start: int [addresses(Space::MelsecRegister)] "number of the first D register",
        len: int [counts(8), extent(BYTES), accepts(LENGTH)] "how many bytes; an odd number writes 0 into the high byte left over",
    ) -> bool
        { "5.6.5.4", melsec::write_bytes, waits, fails;
          "melsec_dev mc\nbyte data[4] = {1,2,3,4}\nwaituntil open(mc,\"10.20.220.92\",8080,255)\nwaituntil write(mc,data,6000,4)" }
}
