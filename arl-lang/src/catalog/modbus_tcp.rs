//! 5.6.4: Modbus TCP. The controller is the server; these functions work on its own tables.

use super::declare::{base, entries, folded, kind, param_type};
use super::facts::Space;

entries! { pub(super) MODBUS_TCP =
    /// Reads registers as a text, two bytes per register, high byte first; true if it worked.
    fn readregisters(
        data: string [out] "gets the text",
        start: int [addresses(Space::ModbusRegister)] "address of the first register, from 0",
        len: int [extent(1)] "how many registers",
    ) -> bool
        { "5.6.4.1", modbus_tcp::readregisters_string, waits, fails;
          "string s\nwaituntil readregisters(s,200,2)\nprint s" }
    /// Reads registers as bytes, two per register, high byte first; true if it worked.
    fn readregisters(
        data: [byte] [out] "gets the bytes",
        start: int [addresses(Space::ModbusRegister)] "address of the first register, from 0",
        len: int [counts(16), extent(1)] "how many registers",
    ) -> bool
        { "5.6.4.1", modbus_tcp::readregisters_bytes, waits, fails;
          "byte data[4]\nwaituntil readregisters(data,100,2)\nprint data" }
    /// Writes a text into registers, two bytes per register, high byte first; true if it worked.
    fn writeregisters(
        data: string "the text",
        start: int [addresses(Space::ModbusRegister)] "address of the first register, from 0",
        len: int [optional, extent(1)] "how many registers; as many as the text needs without it",
    ) -> bool
        { "5.6.4.2", modbus_tcp::writeregisters_string, waits, fails; "waituntil writeregisters(\"abcd\",200,2)" }
    /// Writes bytes into registers, two per register, high byte first; true if it worked.
    fn writeregisters(
        data: [byte] "the bytes",
        start: int [addresses(Space::ModbusRegister)] "address of the first register, from 0",
        len: int [counts(16), extent(1)] "how many registers",
    ) -> bool
        { "5.6.4.2", modbus_tcp::writeregisters_bytes, waits, fails;
          "byte data[4] = {1,2,3,4}\nwaituntil writeregisters(data,100,2)" }
    /// Reads coils, eight per byte, lowest bit first; true if it worked.
    fn readcoils(
        data: [byte] [out] "gets the coils",
        start: int [addresses(Space::ModbusCoil)] "address of the first coil, from 0",
        length: int [counts(1), extent(1)] "how many coils",
    ) -> bool
        { "5.6.4.3", modbus_tcp::readcoils, waits, fails;
          "byte data[2]\nwaituntil readcoils(data,100,16)\nprint data" }
    /// Writes coils, eight per byte, lowest bit first; true if it worked.
    fn writecoils(
        data: [byte] "the coils",
        start: int [addresses(Space::ModbusCoil)] "address of the first coil, from 0",
        length: int [counts(1), extent(1)] "how many coils",
    ) -> bool
        { "5.6.4.4", modbus_tcp::writecoils, waits, fails;
          "byte data[2] = {1,2}\nwaituntil writecoils(data,100,16)" }
}
