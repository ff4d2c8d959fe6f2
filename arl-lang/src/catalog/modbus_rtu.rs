//! 5.6.6: Modbus RTU. The controller is the slave; these functions work on its own holding registers.

use super::declare::{base, entries, folded, kind, param_type};
use super::facts::{Accepted, Space};

const SPEEDS: Accepted = Accepted::OneOf(&[4800, 9600, 19200, 38400, 57600, 115_200]);

entries! { pub(super) MODBUS_RTU =
    /// Opens a serial line as a Modbus slave; true if it worked.
    fn open(
        dev: modbus_dev "the slave",
        devname: string [addresses(Space::SerialLine)] "name of the device, such as \"rtserMB0\"",
        slave_id: int [accepts(Accepted::Range(1, 247))] "the slave's station number, 1 to 247",
        baud_rate: int [accepts(SPEEDS)] "speed, bit/s: 4800, 9600, 19200, 38400, 57600 or 115200",
        parity: {parity} "parity",
        databits: int [accepts(Accepted::Range(5, 8))] "bits per character, 5 to 8",
        stop_bits: {stopbits} "stop bits",
    ) -> bool
        { "5.6.6.1", modbus_rtu::open, waits, fails, connects;
          "modbus_dev m\nprint open(m,\"rtserMB0\",1,115200,none,8,one)" }
    /// Opens a serial line as a Modbus slave, with the stop bits before the data bits and the parity at the end.
    fn open(
        dev: modbus_dev "the slave",
        devname: string [addresses(Space::SerialLine)] "name of the device, such as \"rtserMB0\"",
        slave_id: int [accepts(Accepted::Range(1, 247))] "the slave's station number, 1 to 247",
        baud_rate: int [accepts(SPEEDS)] "speed, bit/s: 4800, 9600, 19200, 38400, 57600 or 115200",
        stop_bits: {stopbits} "stop bits",
        databits: int [accepts(Accepted::Range(5, 8))] "bits per character, 5 to 8",
        parity: {parity} "parity",
    ) -> bool
        { "5.6.6.1", modbus_rtu::open_stopbits_first, waits, fails, connects;
          "modbus_dev m\nprint open(m,\"rtserMB0\",1,115200,one,8,none)" }
    /// Closes the line; closing one that is not open does nothing.
    fn close(dev: modbus_dev "the slave")
        { "5.6.6.2", modbus_rtu::close, waits; "modbus_dev m\nclose(m)" }
    /// Reads holding registers as a text; true if it worked.
    fn read(
        dev: modbus_dev "the slave",
        data: string [out] "gets the text",
        start: int [addresses(Space::SlaveByte)] "offset of the first byte",
        len: int [extent(1)] "how many bytes",
    ) -> bool
        { "5.6.6.3", modbus_rtu::read_string, waits, fails;
          "modbus_dev m\nstring data\nopen(m,\"rtserMB0\",1,115200,none,8,one)\nread(m,data,0,4)" }
    /// Reads holding registers as bytes; true if it worked.
    fn read(
        dev: modbus_dev "the slave",
        data: [byte] [out] "gets the bytes",
        start: int [addresses(Space::SlaveByte)] "offset of the first byte",
        len: int [counts(8), extent(1)] "how many bytes",
    ) -> bool
        { "5.6.6.3", modbus_rtu::read_bytes, waits, fails;
          "modbus_dev m\nbyte data[4]\nopen(m,\"rtserMB0\",1,115200,none,8,one)\nread(m,data,0,4)" }
    /// Writes a text into holding registers; true if it worked.
    fn write(dev: modbus_dev "the slave", data: string "the text", start: int [addresses(Space::SlaveByte)] "offset of the first byte") -> bool
        { "5.6.6.4", modbus_rtu::write_string, waits, fails;
          "modbus_dev m\nopen(m,\"rtserMB0\",1,115200,none,8,one)\nwrite(m,\"abcd\",0)" }
    /// Writes bytes into holding registers; true if it worked.
    fn write(
        dev: modbus_dev "the slave",
        data: [byte] "the bytes",
        start: int [addresses(Space::SlaveByte)] "offset of the first byte",
        len: int [counts(8), extent(1)] "how many bytes",
    ) -> bool
        { "5.6.6.4", modbus_rtu::write_bytes, waits, fails;
          "modbus_dev m\nbyte data[4] = {31h,32h,33h,34h}\nopen(m,\"rtserMB0\",1,115200,none,8,one)\nwrite(m,data,0,4)" }
    /// Discards what has arrived but has not been read; true if it worked.
    fn clearbuff(dev: modbus_dev "the slave") -> bool
        { "5.6.6.5", modbus_rtu::clearbuff, waits, fails; "modbus_dev m\nprint clearbuff(m)" }
    /// Sets how often data is exchanged between registers and line. Below 500000: alarm.
    fn setcycle(dev: modbus_dev "the slave", cycle: int [accepts(Accepted::Range(500_000, i32::MAX))] "the period, us, 500000 or more")
        { "5.6.6.6", modbus_rtu::setcycle, waits, fails;
          "modbus_dev m\nopen(m,\"rtserMB0\",1,115200,none,8,one)\nsetcycle(m,1000000)" }
}
