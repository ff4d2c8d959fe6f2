//! 5.7 and 5.12.1: conversions between types.

use super::declare::{base, entries, folded, kind, param_type};
use super::facts::Form;

entries! { pub(super) CONVERT =
    /// Whole part of a number, cut towards zero. Beyond the range of int: alarm.
    fn toint(d: double "the number") -> int
        { "5.7.1", convert::toint_double, pure, fails; "print toint(3.1415)" }
    /// Reads an int from four bytes, lowest byte first. Fewer than four bytes from start on: alarm.
    fn toint(data: [byte] "the bytes", start: int "index of the first byte, from 0") -> int
        { "5.7.1", convert::toint_bytes, pure, fails; "byte data[4] = {01h,02h,03h,04h}\nprint hex,toint(data,0)" }
    /// Reads an int from a text. Text that is not a whole number: alarm.
    fn toint(number_string: string "the text", number_base: {num_base} "the base the text is written in") -> int
        { "5.7.1", convert::toint_string, pure, fails; "print toint(\"ff\",hex)" }
    /// Reads a double from eight bytes, lowest byte first. Fewer than eight bytes from start on: alarm.
    fn todouble(data: [byte] "the bytes", start: int "index of the first byte, from 0") -> double
        { "5.7.2", convert::todouble, pure, fails;
          "byte data[8] = {00h,00h,00h,00h,00h,00h,08h,40h}\nprint todouble(data,0)" }
    /// Writes the bytes of a text into an array. No room from start on: alarm.
    fn tobytes(
        src: string "the text",
        dest: [byte] [out] "the array that is written",
        start: int "index of the first byte that is written, from 0",
    )
        { "5.7.3", convert::tobytes_string, pure, fails; "byte raw[4]\ntobytes(\"ABCD\",raw,0)\nprint raw" }
    /// Writes an int as four bytes into an array, lowest byte first. No room from start on: alarm.
    fn tobytes(
        src: int "the number",
        dest: [byte] [out] "the array that is written",
        start: int "index of the first byte that is written, from 0",
    )
        { "5.7.3", convert::tobytes_int, pure, fails; "byte raw[4]\ntobytes(4030201h,raw,0)\nprint raw" }
    /// Writes a double as eight bytes into an array, lowest byte first. No room from start on: alarm.
    fn tobytes(
        src: {double} "the number",
        dest: [byte] [out] "the array that is written",
        start: int "index of the first byte that is written, from 0",
    )
        { "5.7.3", convert::tobytes_double, pure, fails; "byte raw[8]\ntobytes(3.0,raw,0)\nprint raw" }
    /// Text of a value, as print would write it.
    fn tostr(v: any "the value") -> string
        { "5.7.4", convert::tostr, pure; "string s = tostr(3.1415)\nprint s" }
    /// Text of an int in base 10 or 16.
    fn tostr(v: int "the number", number_base: {num_base} "the base") -> string
        { "5.7.4", convert::tostr_base, pure; "print tostr(255,hex)" }
    /// Text of a number with the given number of significant digits, where 0 counts as 1, as in print. A negative
    /// precision: alarm.
    fn tostr(v: double "the number", precision: {int} "how many significant digits") -> string
        { "5.7.4", convert::tostr_precision, pure, fails; "print tostr(3.1415926,3)" }
    /// Writes a number as a float of four bytes into an array, lowest byte first; digits beyond the seventh are lost.
    /// No room from start on: alarm.
    fn ftobytes(
        src: double "the number",
        data: [byte] [out] "the array that is written",
        start: int "index of the first byte that is written, from 0",
    )
        { "5.7.5", convert::ftobytes, pure, fails; "byte raw[4]\nftobytes(1.5,raw,0)\nprint raw" }
    /// Reads a float of four bytes, lowest byte first. Fewer than four bytes from start on: alarm.
    fn tofloat(data: [byte] "the bytes", start: int "index of the first byte, from 0") -> double
        { "5.7.6", convert::tofloat, pure, fails;
          "byte raw[4]\nftobytes(1.23,raw,0)\nprint tofloat(raw,0)" }
    /// Name of a value's type; for an array with its sizes, for an enumeration's constant its enumeration.
    fn typeof(v: any "the value") -> string
        { "5.12.1", convert::type_name, pure, form(Form::TypeOf); "double value = 3.1415\nprint typeof(value)" }
}
