//! Explicit conversions of programs. Bytes represent numbers with the lowest byte first.

use crate::fault::Fault;
use crate::values::text::scan;
use crate::values::text::{Print, Style};
use crate::values::{NumBase, Str};

fn domain(function: &'static str, problem: String) -> Fault {
    Fault::Domain { function, problem: problem.into() }
}

/// The whole part of a number.
///
/// # Errors
/// [`Fault::Domain`] outside the range of int.
pub fn toint_double(d: f64) -> Result<i32, Fault> {
    let whole = d.trunc();
    if (-2_147_483_648.0..=2_147_483_647.0).contains(&whole) {
        Ok(whole as i32)
    } else {
        Err(domain("toint", format!("{d} is outside the range of int")))
    }
}

/// The int in four bytes.
///
/// # Errors
/// [`Fault::Domain`] if the array does not have them.
pub fn toint_bytes(data: &[u8], start: i32) -> Result<i32, Fault> {
    Ok(i32::from_le_bytes(taken("toint", data, start)?))
}

/// The int that a text represents, in decimal or in hexadecimal (with or without a final `h`; up to eight digits are a
/// bit pattern). Blanks around it are ignored.
///
/// # Errors
/// [`Fault::Text`] if the text is not such a number.
pub fn toint_string(number_string: &Str, number_base: NumBase) -> Result<i32, Fault> {
    let text = number_string.as_bytes();
    let number = match number_base {
        NumBase::Dec => scan::decimal(text),
        NumBase::Hex => scan::hexadecimal(text),
    };
    number.ok_or_else(|| Fault::Text { text: number_string.to_text().into(), wanted: "int" })
}

/// The double in eight bytes.
///
/// # Errors
/// [`Fault::Domain`] if the array does not have them.
pub fn todouble(data: &[u8], start: i32) -> Result<f64, Fault> {
    Ok(f64::from_le_bytes(taken("todouble", data, start)?))
}

/// The number in four bytes of single precision.
///
/// # Errors
/// [`Fault::Domain`] if the array does not have them.
pub fn tofloat(data: &[u8], start: i32) -> Result<f64, Fault> {
    Ok(f64::from(f32::from_le_bytes(taken("tofloat", data, start)?)))
}

/// Writes the bytes of a text, without a terminator.
///
/// # Errors
/// [`Fault::Domain`] if they do not fit the array.
pub fn tobytes_string(src: &Str, dest: &mut [u8], start: i32) -> Result<(), Fault> {
    put("tobytes", src.as_bytes(), dest, start)
}

/// Writes the four bytes of an int.
///
/// # Errors
/// [`Fault::Domain`] if they do not fit the array.
pub fn tobytes_int(src: i32, dest: &mut [u8], start: i32) -> Result<(), Fault> {
    put("tobytes", &src.to_le_bytes(), dest, start)
}

/// Writes the eight bytes of a double.
///
/// # Errors
/// [`Fault::Domain`] if they do not fit the array.
pub fn tobytes_double(src: f64, dest: &mut [u8], start: i32) -> Result<(), Fault> {
    put("tobytes", &src.to_le_bytes(), dest, start)
}

/// Writes a number as four bytes of single precision.
///
/// # Errors
/// [`Fault::Domain`] if they do not fit the array.
pub fn ftobytes(src: f64, data: &mut [u8], start: i32) -> Result<(), Fault> {
    put("ftobytes", &(src as f32).to_le_bytes(), data, start)
}

/// A value as it prints.
pub fn tostr(v: &dyn Print) -> Str {
    v.printed(&Style::START)
}

/// An int as text in a base.
pub fn tostr_base(v: i32, number_base: NumBase) -> Str {
    v.printed(&Style { base: Some(number_base), ..Style::START })
}

/// A double as text with this many significant digits.
///
/// # Errors
/// [`Fault::Domain`] for a negative number of digits.
pub fn tostr_precision(v: f64, precision: i32) -> Result<Str, Fault> {
    match u32::try_from(precision) {
        Ok(precision) => Ok(v.printed(&Style { precision, ..Style::START })),
        Err(_) => Err(domain("tostr", format!("the number of digits is {precision}, but must be 0 or more"))),
    }
}

/// The name of a value's type in the manual's spelling.
pub fn type_name(v: &dyn Print) -> Str {
    v.type_name().into()
}

/// The bytes from `start` on.
fn taken<const N: usize>(function: &'static str, data: &[u8], start: i32) -> Result<[u8; N], Fault> {
    usize::try_from(start)
        .ok()
        .and_then(|start| data.get(start..)?.first_chunk::<N>())
        .copied()
        .ok_or_else(|| outside(function, N, start, data.len()))
}

fn put(function: &'static str, bytes: &[u8], dest: &mut [u8], start: i32) -> Result<(), Fault> {
    let size = dest.len();
    let place = usize::try_from(start).ok().and_then(|start| dest.get_mut(start..start.checked_add(bytes.len())?));
    place.ok_or_else(|| outside(function, bytes.len(), start, size))?.copy_from_slice(bytes);
    Ok(())
}

fn outside(function: &'static str, count: usize, start: i32, size: usize) -> Fault {
    domain(function, format!("{count} bytes from byte {start} do not fit in an array of {size} bytes"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::values::{Array, Pos};

    #[test]
    fn numbers_to_int() {
        assert_eq!(toint_double(3.1875), Ok(3));
        assert_eq!(toint_double(-3.99), Ok(-3));
        assert_eq!(toint_double(2_147_483_647.9), Ok(i32::MAX));
        assert_eq!(toint_double(-2_147_483_648.9), Ok(i32::MIN));
        let fault = toint_double(2_147_483_648.0).unwrap_err();
        assert_eq!(fault.to_string(), "toint: 2147483648 is outside the range of int");
        assert!(toint_double(f64::NAN).is_err());
    }

    #[test]
    fn texts_to_int() {
        let int = |text: &str, base| toint_string(&Str::from(text), base);
        assert_eq!(int(" -12 ", NumBase::Dec), Ok(-12));
        assert_eq!(int("ff", NumBase::Hex), Ok(255));
        assert_eq!(int("0bH", NumBase::Hex), Ok(11));
        assert_eq!(int("fffffffe", NumBase::Hex), Ok(-2));
        assert_eq!(int("-10", NumBase::Hex), Ok(-16));
        for (text, base) in [
            ("12a", NumBase::Dec),
            ("", NumBase::Dec),
            ("2147483648", NumBase::Dec),
            ("1.0", NumBase::Dec),
            ("100000000", NumBase::Hex),
            ("h", NumBase::Hex),
            ("xyz", NumBase::Hex),
        ] {
            assert_eq!(int(text, base), Err(Fault::Text { text: text.into(), wanted: "int" }));
        }
    }

    #[test]
    fn bytes_to_numbers() {
        let data = [1, 2, 3, 4, 0, 0, 8, 0x40, 0, 0, 0, 0, 0, 0, 8, 0xc0];
        assert_eq!(toint_bytes(&data, 0), Ok(0x0403_0201));
        assert_eq!(todouble(&data, 8), Ok(-3.0));
        assert_eq!(todouble(&[0, 0, 0, 0, 0, 0, 0, 0x40], 0), Ok(2.0));
        let fault = toint_bytes(&data, 13).unwrap_err();
        assert_eq!(fault.to_string(), "toint: 4 bytes from byte 13 do not fit in an array of 16 bytes");
        assert!(toint_bytes(&data, -1).is_err());
        assert!(todouble(&data, i32::MAX).is_err());
    }

    #[test]
    fn numbers_to_bytes() {
        let mut dest = [0; 9];
        tobytes_int(0x0403_0201, &mut dest, 1).unwrap();
        assert_eq!(dest, [0, 1, 2, 3, 4, 0, 0, 0, 0]);
        tobytes_double(3.0, &mut dest, 0).unwrap();
        assert_eq!(dest, [0, 0, 0, 0, 0, 0, 8, 0x40, 0]);
        tobytes_string(&Str::from("AB"), &mut dest, 7).unwrap();
        assert_eq!(dest, [0, 0, 0, 0, 0, 0, 8, b'A', b'B']);
        assert!(tobytes_string(&Str::from("AB"), &mut dest, 8).is_err());
        assert!(tobytes_double(1.0, &mut dest, 2).is_err());
        assert!(tobytes_int(1, &mut dest, -1).is_err());
        assert_eq!(tobytes_string(&Str::new(), &mut dest, 9), Ok(()));
        ftobytes(1.23, &mut dest, 5).unwrap();
        assert_eq!(tostr(&tofloat(&dest, 5).unwrap()), "1.23");
        assert_ne!(tofloat(&dest, 5), Ok(1.23), "single precision loses digits");
    }

    #[test]
    fn values_to_text() {
        assert_eq!(tostr(&3.1875), "3.1875");
        assert_eq!(tostr(&Pos::default()), "{9e+09,9e+09,9e+09}");
        assert_eq!(tostr(&0x0b_u8), "0bh");
        assert_eq!(tostr_base(255, NumBase::Hex), "ff");
        assert_eq!(tostr_base(255, NumBase::Dec), "255");
        assert_eq!(tostr_precision(std::f64::consts::PI, 3), Ok(Str::from("3.14")));
        assert!(tostr_precision(1.0, -1).is_err());
        let array: Array<Pos, 2> = Array::start();
        assert_eq!(type_name(&array), "pos[2]");
        assert_eq!(type_name(&3.1875), "double");
    }
}
