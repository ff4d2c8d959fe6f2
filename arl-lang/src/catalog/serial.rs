//! 5.6.2: serial lines. Each call tries once and returns whether it is done; `waituntil` repeats it.

use super::declare::{base, entries, folded, kind, param_type};
use super::facts::{Accepted, Space};

entries! { pub(super) SERIAL =
    /// Opens a serial line; true if it worked.
    fn open(
        dev: iodev "the line",
        devname: string [addresses(Space::SerialLine)] "name of the device: \"/dev/ttyS0\" is com1, \"/dev/ttyS1\" com2",
        baud_rate: int [accepts(Accepted::OneOf(&[300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600, 115_200]))] "speed, bit/s: 300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600 or 115200",
        character_size: int [accepts(Accepted::Range(5, 8))] "bits per character, 5 to 8",
        stop_bits: {stopbits} "stop bits",
        prt: {parity} "parity",
    ) -> bool
        { "5.6.2.1", serial::open, waits, fails, connects; "iodev s\nprint open(s,\"/dev/ttyS0\",9600,8,one,none)" }
    /// Closes a serial line; closing one that is not open does nothing.
    fn close(dev: iodev "the line")
        { "5.6.2.2", serial::close, waits; "iodev s\nclose(s)" }
    /// Sends a text; true when all of it has been sent.
    fn write(dev: iodev "the line", data: string "the text") -> bool
        { "5.6.2.3", serial::write_string, waits, fails;
          "iodev s\nopen(s,\"/dev/ttyS0\",9600,8,one,none)\nwaituntil write(s,\"hello\")" }
    /// Sends bytes; true when all of them have been sent.
    fn write(dev: iodev "the line", data: [byte] "the bytes", len: int [counts(8)] "how many of them") -> bool
        { "5.6.2.3", serial::write_bytes, waits, fails;
          "iodev s\nbyte data[4] = {1,2,3,4}\nopen(s,\"/dev/ttyS0\",9600,8,one,none)\nwaituntil write(s,data,4)" }
    /// Takes exactly len bytes as a text when that many have arrived; the rest stays for the next call.
    fn read(dev: iodev "the line", data: string [out] "gets the text", len: int "how many bytes") -> bool
        { "5.6.2.3", serial::read_string, waits, fails;
          "iodev s\nstring data\nopen(s,\"/dev/ttyS0\",9600,8,one,none)\nwaituntil read(s,data,4)" }
    /// Takes exactly len bytes when that many have arrived; the rest stays for the next call.
    fn read(dev: iodev "the line", data: [byte] [out] "gets the bytes", len: int [counts(8)] "how many bytes") -> bool
        { "5.6.2.3", serial::read_bytes, waits, fails;
          "iodev s\nbyte data[4]\nopen(s,\"/dev/ttyS0\",9600,8,one,none)\nwaituntil read(s,data,4)" }
    /// Takes the text before a mark when the mark has arrived; both leave the buffer.
    fn readuntil(dev: iodev "the line", data: string [out] "gets the text", cut: string "the mark") -> bool
        { "5.6.2.3", serial::readuntil, waits, fails;
          "iodev s\nstring line\nopen(s,\"/dev/ttyS0\",9600,8,one,none)\nwaituntil readuntil(s,line,\"o\")" }
    /// Discards what has arrived but has not been read; true if it worked.
    fn clearbuff(dev: iodev "the line") -> bool
        { "5.6.2.4", serial::clearbuff, waits, fails; "iodev s\nprint clearbuff(s)" }
}
