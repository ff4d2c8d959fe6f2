//! 5.2: bits.

use super::declare::{base, entries, folded, kind, param_type};

entries! { pub(super) BITS =
    /// Clears a bit of a byte. A position outside the width: alarm.
    fn bitclear(data: {byte} [out] "the variable", pos: int "the bit, 0 to 7")
        { "5.2.1", bits::bitclear_byte, pure, fails; "byte data = 00001111b\nbitclear(data,2)\nprint data" }
    /// Clears a bit of an int. A position outside the width: alarm.
    fn bitclear(data: {int} [out] "the variable", pos: int "the bit, 0 to 31")
        { "5.2.1", bits::bitclear_int, pure, fails; "int data = 15\nbitclear(data,2)\nprint data" }
    /// Sets a bit of a byte. A position outside the width: alarm.
    fn bitset(data: {byte} [out] "the variable", pos: int "the bit, 0 to 7")
        { "5.2.2", bits::bitset_byte, pure, fails; "byte data = 00001000b\nbitset(data,2)\nprint data" }
    /// Sets a bit of an int. A position outside the width: alarm.
    fn bitset(data: {int} [out] "the variable", pos: int "the bit, 0 to 31")
        { "5.2.2", bits::bitset_int, pure, fails; "int data = 8\nbitset(data,2)\nprint data" }
    /// Whether a bit of a byte is set. A position outside the width: alarm.
    fn bitcheck(data: {byte} "the value", pos: int "the bit, 0 to 7") -> bool
        { "5.2.3", bits::bitcheck_byte, pure, fails; "byte data = 00001000b\nprint bitcheck(data,2)" }
    /// Whether a bit of an int is set. A position outside the width: alarm.
    fn bitcheck(data: int "the value", pos: int "the bit, 0 to 31") -> bool
        { "5.2.3", bits::bitcheck_int, pure, fails; "print bitcheck(8,3)" }
    /// Rotates a byte to the left: bits that fall out at the top come back at the bottom. A negative count: alarm.
    fn bitlcs(data: {byte} "the value", n: int [otherwise("1")] "how many places, 0 or more; 1 without it") -> byte
        { "5.2.4", bits::bitlcs_byte, pure, fails; "byte data = 11000000b\nprint bitlcs(data,2),\" \",bitlcs(data)" }
    /// Rotates an int to the left. A negative count: alarm.
    fn bitlcs(data: int "the value", n: int [otherwise("1")] "how many places, 0 or more; 1 without it") -> int
        { "5.2.4", bits::bitlcs_int, pure, fails; "print bitlcs(3,4)" }
    /// Rotates a byte to the right: bits that fall out at the bottom come back at the top. A negative count: alarm.
    fn bitrcs(data: {byte} "the value", n: int [otherwise("1")] "how many places, 0 or more; 1 without it") -> byte
        { "5.2.5", bits::bitrcs_byte, pure, fails; "byte data = 00000011b\nprint bitrcs(data,2),\" \",bitrcs(data)" }
    /// Rotates an int to the right. A negative count: alarm.
    fn bitrcs(data: int "the value", n: int [otherwise("1")] "how many places, 0 or more; 1 without it") -> int
        { "5.2.5", bits::bitrcs_int, pure, fails; "print bitrcs(48,4)" }
}
