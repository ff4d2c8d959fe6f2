//! 5.4: strings. They count in bytes.

use super::declare::{base, entries, folded, kind, param_type};

entries! { pub(super) STRINGS =
    /// Length of a string in bytes.
    fn strlen(s: string "the string") -> int
        { "5.4.1", strings::strlen, pure; "print strlen(\"hello world!\")" }
    /// Part of a string. A start outside the string or a negative length: alarm; the part ends with the string at the
    /// latest.
    fn substr(
        s: string "the string",
        startpos: int "offset of the first byte, from 0",
        len: int [optional] "how many bytes; to the end of the string without it",
    ) -> string
        { "5.4.2", strings::substr, pure, fails; "print substr(\"hello world!\",0,5)" }
    /// Code of a character. A string that is not one byte long: alarm.
    fn toascii(s: string "the character") -> int
        { "5.4.3", strings::toascii, pure, fails; "print toascii(\"a\")" }
}
