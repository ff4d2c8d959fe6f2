//! Reads one number at the start of a text: decimal, binary (`1100b`), hexadecimal (`3eh`), double, with or without
//! a unit. Longest match, so `0bh` is 11 and `10b` is 2.

use crate::ast::{Radix, Unit};

/// A number with the unit directly after it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Number {
    /// The value.
    pub value: NumberValue,
    /// The unit and how many bytes it takes.
    pub unit: Option<(Unit, u8)>,
}

/// The value of a number.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum NumberValue {
    /// No point, no exponent.
    Int(u32, Radix),
    /// With a point or an exponent.
    Double(f64),
}

/// What can be wrong with a number.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum NumberError {
    /// An int that needs more than 32 bits.
    IntTooLarge,
    /// A double that is too large.
    DoubleTooLarge,
    /// `12b`: a binary number with digits other than 0 and 1.
    BinaryDigits,
    /// `12e`: an exponent without digits.
    Exponent,
    /// `0x3e`: hexadecimal as other languages write it; the value.
    OtherHexadecimal(u32),
    /// `1.2.3`
    SeveralPoints,
    /// `12abc`: letters that are not a unit.
    Letters,
}

/// The units that may directly follow a number, longest first where one begins the other.
const UNITS: [(&str, Unit); 5] = [
    ("mm/s", Unit::MillimetrePerSecond),
    ("mm", Unit::Millimetre),
    ("deg/s", Unit::DegreePerSecond),
    ("deg", Unit::Degree),
    ("s", Unit::Second),
];

/// Reads the number that `text` begins with (a digit, or a point and a digit); returns how many bytes it takes.
pub fn read_number(text: &str) -> (usize, Result<Number, NumberError>) {
    let bytes = text.as_bytes();
    let run = word_end(bytes, 0);
    if let Some(value) = read_radix(bytes.get(..run).unwrap_or_default()) {
        return (run, value.map(|value| Number { value, unit: None }));
    }
    let mut at = digits_end(bytes, 0);
    let mut double = false;
    if bytes.get(at) == Some(&b'.') && bytes.get(at + 1) != Some(&b'.') {
        double = true;
        at = digits_end(bytes, at + 1);
    }
    if let Some(end) = exponent_end(bytes, at) {
        double = true;
        at = end;
    }
    let digits = text.get(..at).unwrap_or_default();
    let value = match bytes.get(at) {
        None => read_decimal(digits, double),
        Some(b'.') => return (points_end(bytes, at), Err(NumberError::SeveralPoints)),
        Some(byte) if !is_word(*byte) => read_decimal(digits, double),
        Some(_) => {
            if let Some((unit, length)) = read_unit(bytes, at) {
                let number =
                    read_decimal(digits, double).map(|value| Number { value, unit: Some((unit, length as u8)) });
                return (at + length, number);
            }
            return (points_end(bytes, at), Err(what_is_wrong(bytes, at)));
        }
    };
    (at, value.map(|value| Number { value, unit: None }))
}

/// The unit at `at` and its length, if the word there is exactly a unit.
fn read_unit(bytes: &[u8], at: usize) -> Option<(Unit, usize)> {
    let rest = bytes.get(at..)?;
    let found = UNITS.iter().find(|(text, _)| {
        let length = text.len();
        let same = rest.get(..length).is_some_and(|start| start.eq_ignore_ascii_case(text.as_bytes()));
        same && !rest.get(length).is_some_and(|byte| is_word(*byte))
    })?;
    Some((found.1, found.0.len()))
}

/// A binary or hexadecimal number, if the whole word is one.
fn read_radix(word: &[u8]) -> Option<Result<NumberValue, NumberError>> {
    let (last, digits) = word.split_last()?;
    if digits.is_empty() {
        return None;
    }
    let (radix, shift) = match last {
        b'h' | b'H' if digits.iter().all(u8::is_ascii_hexdigit) => (Radix::Hexadecimal, 4),
        b'b' | b'B' if digits.iter().all(|digit| matches!(digit, b'0' | b'1')) => (Radix::Binary, 1),
        _ => return None,
    };
    let value = digits.iter().try_fold(0_u32, |value, digit| {
        let digit = char::from(*digit).to_digit(16).unwrap_or(0);
        (value >> (32 - shift) == 0).then_some((value << shift) | digit)
    });
    Some(value.map(|value| NumberValue::Int(value, radix)).ok_or(NumberError::IntTooLarge))
}

/// The value of digits, with a point or an exponent if `double` is set.
fn read_decimal(text: &str, double: bool) -> Result<NumberValue, NumberError> {
    if double {
        return match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(NumberValue::Double(value)),
            _ => Err(NumberError::DoubleTooLarge),
        };
    }
    text.parse().map(|value| NumberValue::Int(value, Radix::Decimal)).map_err(|_| NumberError::IntTooLarge)
}

/// Why the letters at `at`, after digits, are not a number.
fn what_is_wrong(bytes: &[u8], at: usize) -> NumberError {
    let end = word_end(bytes, at);
    let letters = bytes.get(at..end).unwrap_or_default();
    let digits = bytes.get(..at).unwrap_or_default();
    match letters {
        [b'b' | b'B'] if digits.iter().all(u8::is_ascii_digit) => NumberError::BinaryDigits,
        [b'e' | b'E'] => NumberError::Exponent,
        [b'x' | b'X', hex @ ..] if digits == b"0" && !hex.is_empty() => {
            let text = std::str::from_utf8(hex).unwrap_or_default();
            u32::from_str_radix(text, 16).map_or(NumberError::Letters, NumberError::OtherHexadecimal)
        }
        _ => NumberError::Letters,
    }
}

/// The end of an exponent that begins at `at`.
fn exponent_end(bytes: &[u8], at: usize) -> Option<usize> {
    if !matches!(bytes.get(at), Some(b'e' | b'E')) {
        return None;
    }
    let digits = if matches!(bytes.get(at + 1), Some(b'+' | b'-')) { at + 2 } else { at + 1 };
    let end = digits_end(bytes, digits);
    (end > digits).then_some(end)
}

fn is_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

fn end_of(bytes: &[u8], from: usize, wanted: impl Fn(u8) -> bool) -> usize {
    bytes.iter().skip(from).position(|byte| !wanted(*byte)).map_or(bytes.len().max(from), |count| from + count)
}

fn digits_end(bytes: &[u8], from: usize) -> usize {
    end_of(bytes, from, |byte| byte.is_ascii_digit())
}

fn word_end(bytes: &[u8], from: usize) -> usize {
    end_of(bytes, from, is_word)
}

/// The end of letters, digits and points: all that was meant as one number.
fn points_end(bytes: &[u8], from: usize) -> usize {
    end_of(bytes, from, |byte| is_word(byte) || byte == b'.')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> NumberValue {
        let (length, number) = read_number(text);
        assert_eq!(length, text.len(), "{text}");
        number.unwrap().value
    }

    #[test]
    fn integers() {
        assert_eq!(value("12"), NumberValue::Int(12, Radix::Decimal));
        assert_eq!(value("007"), NumberValue::Int(7, Radix::Decimal));
        assert_eq!(value("4294967295"), NumberValue::Int(u32::MAX, Radix::Decimal));
        assert_eq!(value("1100b"), NumberValue::Int(12, Radix::Binary));
        assert_eq!(value("10B"), NumberValue::Int(2, Radix::Binary));
        assert_eq!(value("3eh"), NumberValue::Int(62, Radix::Hexadecimal));
        assert_eq!(value("0bh"), NumberValue::Int(11, Radix::Hexadecimal));
        assert_eq!(value("0FFH"), NumberValue::Int(255, Radix::Hexadecimal));
        assert_eq!(value("1e5h"), NumberValue::Int(0x1e5, Radix::Hexadecimal));
        assert_eq!(value("0ffffffffh"), NumberValue::Int(u32::MAX, Radix::Hexadecimal));
        assert_eq!(value("000000b"), NumberValue::Int(0, Radix::Binary));
    }

    #[test]
    fn doubles() {
        for (text, wanted) in [
            ("3.2", 3.2),
            ("0.15e2", 15.0),
            ("9e+09", 9e9),
            ("9.000e+09", 9e9),
            (".5", 0.5),
            ("5.", 5.0),
            ("5.e3", 5000.0),
            ("1E-3", 0.001),
        ] {
            assert_eq!(value(text), NumberValue::Double(wanted), "{text}");
        }
    }

    #[test]
    fn units() {
        for (text, unit, length) in [
            ("5mm", Unit::Millimetre, 3),
            ("100mm/s", Unit::MillimetrePerSecond, 7),
            ("100MM/S,", Unit::MillimetrePerSecond, 7),
            ("2s", Unit::Second, 2),
            ("30deg", Unit::Degree, 5),
            ("30deg/s", Unit::DegreePerSecond, 7),
            ("1.5mm/speed", Unit::Millimetre, 5),
        ] {
            let (taken, number) = read_number(text);
            assert_eq!(taken, length, "{text}");
            assert_eq!(number.unwrap().unit.map(|unit| unit.0), Some(unit), "{text}");
        }
    }

    #[test]
    fn stops_where_the_number_ends() {
        for (text, length) in [("12+3", 2), ("9e+x", 2), ("1.5,", 3), ("5%", 1), ("0eh+5", 3), ("7)", 1)] {
            assert_eq!(read_number(text).0, length, "{text}");
        }
    }

    #[test]
    fn mistakes() {
        for (text, error, length) in [
            ("12b", NumberError::BinaryDigits, 3),
            ("12e", NumberError::Exponent, 3),
            ("4294967296", NumberError::IntTooLarge, 10),
            ("1ffffffffh", NumberError::IntTooLarge, 10),
            ("100000000000000000000000000000000b", NumberError::IntTooLarge, 34),
            ("1e999", NumberError::DoubleTooLarge, 5),
            ("0x3e", NumberError::OtherHexadecimal(62), 4),
            ("1.2.3", NumberError::SeveralPoints, 5),
            ("12abc", NumberError::Letters, 5),
            ("12mm2", NumberError::Letters, 5),
        ] {
            assert_eq!(read_number(text), (length, Err(error)), "{text}");
        }
    }
}
