//! Values read back from text.

use crate::fault::Fault;
use crate::values::Str;

/// A type that `scan` reads.
pub trait Scanned: Sized {
    /// The type's name.
    const WANTED: &'static str;

    /// The value of a field; `None` if the text is not of this type.
    fn scan(field: &[u8]) -> Option<Self>;
}

/// Reads the fields of a text one by one.
#[must_use = "a scan reports its fault in `run`"]
#[derive(Debug)]
pub struct Scan<'a> {
    /// The text not yet read; `None` after the last field.
    rest: Option<&'a [u8]>,
    delimiter: &'a [u8],
    fault: Option<Fault>,
}

/// Reads the fields of `from`, separated by `delimiter`. An empty delimiter separates nothing.
pub fn scan<'a>(from: &'a Str, delimiter: &'a Str) -> Scan<'a> {
    let rest = if from.is_empty() { None } else { Some(from.as_bytes()) };
    Scan { rest, delimiter: delimiter.as_bytes(), fault: None }
}

impl Scan<'_> {
    /// Reads the next field into a variable; the variable keeps its value if no field is left, and after a fault.
    pub fn argtosave<T: Scanned>(mut self, place: &mut T) -> Self {
        if self.fault.is_none()
            && let Some(field) = self.next_field()
        {
            match T::scan(field) {
                Some(value) => *place = value,
                None => {
                    self.fault = Some(Fault::Text { text: String::from_utf8_lossy(field).into(), wanted: T::WANTED });
                }
            }
        }
        self
    }

    /// Ends the scan; fields that are left over do not matter.
    ///
    /// # Errors
    /// [`Fault::Text`] for the first field whose text was not of its variable's type.
    pub fn run(self) -> Result<(), Fault> {
        self.fault.map_or(Ok(()), Err)
    }

    fn next_field(&mut self) -> Option<&[u8]> {
        let rest = self.rest?;
        let end = match self.delimiter {
            [] => None,
            delimiter => rest.windows(delimiter.len()).position(|window| window == delimiter),
        };
        let Some(end) = end else {
            self.rest = None;
            return Some(rest);
        };
        self.rest = rest.get(end + self.delimiter.len()..);
        rest.get(..end)
    }
}

macro_rules! scans {
    ($($ty:ty, $name:literal: |$field:ident| $how:expr;)*) => { $(
        impl Scanned for $ty {
            const WANTED: &'static str = $name;

            fn scan($field: &[u8]) -> Option<Self> {
                $how
            }
        }
    )* };
}

scans! {
    i32, "int": |field| integer(field).and_then(|(value, pattern)| {
        i32::try_from(value).ok().or_else(|| if pattern { u32::try_from(value).ok().map(|bits| bits as i32) } else { None })
    });
    u32, "uint": |field| integer(field).and_then(|(value, _)| u32::try_from(value).ok());
    u8, "byte": |field| integer(field).and_then(|(value, _)| u8::try_from(value).ok());
    f64, "double": |field| double(field);
    bool, "bool": |field| {
        let field = field.trim_ascii();
        if field.eq_ignore_ascii_case(b"true") {
            Some(true)
        } else if field.eq_ignore_ascii_case(b"false") {
            Some(false)
        } else {
            None
        }
    };
    Str, "string": |field| Some(Str::from(field));
}

/// An integer as written in ARL: decimal, binary with a final `b` or hexadecimal with a final `h`; the latter two are
/// bit patterns. A hexadecimal number begins with a digit, so that no word is a number.
fn integer(field: &[u8]) -> Option<(i64, bool)> {
    let (negative, digits) = signed(field.trim_ascii());
    if !digits.first()?.is_ascii_digit() {
        return None;
    }
    let (digits, radix) = match digits {
        [digits @ .., b'h' | b'H'] => (digits, 16),
        [digits @ .., b'b' | b'B'] => (digits, 2),
        digits => (digits, 10),
    };
    let size = magnitude(digits, radix)?;
    Some((if negative { -size } else { size }, radix != 10 && !negative))
}

/// A decimal int with blanks around it.
pub(crate) fn decimal(text: &[u8]) -> Option<i32> {
    let (negative, digits) = signed(text.trim_ascii());
    let size = magnitude(digits, 10)?;
    i32::try_from(if negative { -size } else { size }).ok()
}

/// A hexadecimal int with blanks around it, with or without a final `h`; without a sign it is a bit pattern.
pub(crate) fn hexadecimal(text: &[u8]) -> Option<i32> {
    let (negative, digits) = signed(text.trim_ascii());
    let digits = digits.strip_suffix(b"h").or_else(|| digits.strip_suffix(b"H")).unwrap_or(digits);
    let size = magnitude(digits, 16)?;
    if negative { i32::try_from(-size).ok() } else { u32::try_from(size).ok().map(|bits| bits as i32) }
}

fn signed(text: &[u8]) -> (bool, &[u8]) {
    match text {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    }
}

fn magnitude(digits: &[u8], radix: u32) -> Option<i64> {
    let mut size = if digits.is_empty() { None } else { Some(0) };
    for digit in digits {
        let value = char::from(*digit).to_digit(radix)?;
        size = Some(size? * i64::from(radix) + i64::from(value)).filter(|size| *size <= i64::from(u32::MAX));
    }
    size
}

/// A decimal number with or without a decimal point and an exponent.
fn double(field: &[u8]) -> Option<f64> {
    let text = str::from_utf8(field.trim_ascii()).ok()?;
    // Words like `inf` are numbers for Rust, but not for ARL.
    let numeric = text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte));
    if numeric { text.parse().ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(text: &str) -> Str {
        Str::from(text)
    }

    #[test]
    fn the_manuals_example() {
        let (mut x, mut y, mut z, mut b) = (0.0, 0.0, 0.0, false);
        scan(&text("1.1,1.2,1.3,true "), &text(","))
            .argtosave(&mut x)
            .argtosave(&mut y)
            .argtosave(&mut z)
            .argtosave(&mut b)
            .run()
            .unwrap();
        assert_eq!((x, y, z, b), (1.1, 1.2, 1.3, true));
    }

    #[test]
    fn fields_of_all_types() {
        let (mut int, mut uint, mut byte, mut words) = (0, 0_u32, 0_u8, Str::new());
        scan(&text(" -7 <>4000000000<> 0bh<> two words "), &text("<>"))
            .argtosave(&mut int)
            .argtosave(&mut uint)
            .argtosave(&mut byte)
            .argtosave(&mut words)
            .run()
            .unwrap();
        assert_eq!((int, uint, byte, words), (-7, 4_000_000_000, 11, text(" two words ")));
    }

    #[test]
    fn missing_and_surplus_fields() {
        let (mut a, mut b, mut c) = (1, 2, 3);
        scan(&text("10,20"), &text(",")).argtosave(&mut a).argtosave(&mut b).argtosave(&mut c).run().unwrap();
        assert_eq!((a, b, c), (10, 20, 3));
        scan(&text("5,x,y"), &text(",")).argtosave(&mut a).run().unwrap();
        assert_eq!(a, 5);
        scan(&Str::new(), &text(",")).argtosave(&mut a).run().unwrap();
        assert_eq!(a, 5);
        let mut all = Str::new();
        scan(&text("a,b"), &Str::new()).argtosave(&mut all).run().unwrap();
        assert_eq!(all, "a,b");
        let (mut first, mut second) = (text("x"), text("y"));
        scan(&text(",,"), &text(",")).argtosave(&mut first).argtosave(&mut second).run().unwrap();
        assert_eq!((first, second), (Str::new(), Str::new()));
    }

    #[test]
    fn text_of_another_type_is_a_fault() {
        let (mut a, mut b) = (1, 2);
        let result = scan(&text("x1,5"), &text(",")).argtosave(&mut a).argtosave(&mut b).run();
        assert_eq!(result, Err(Fault::Text { text: "x1".into(), wanted: "int" }));
        assert_eq!((a, b), (1, 2));
        for field in ["1.5", "each", "2147483648", "", "1 2", "12b"] {
            assert_eq!(i32::scan(field.as_bytes()), None, "{field}");
        }
        for field in ["inf", "nan", "1e", "e5", ".", "", "1,5", "0x10"] {
            assert_eq!(f64::scan(field.as_bytes()), None, "{field}");
        }
        assert_eq!(bool::scan(b"1"), None);
        assert_eq!(u8::scan(b"256"), None);
        assert_eq!(u32::scan(b"-1"), None);
        assert_eq!(f64::scan(b"\xff"), None);
    }

    #[test]
    fn numbers_in_all_their_forms() {
        for (field, value) in [("+5", 5), ("1010b", 10), ("0ffh", 255), ("0FFFFFFFFh", -1), ("-2147483648", i32::MIN)] {
            assert_eq!(i32::scan(field.as_bytes()), Some(value));
        }
        for (field, value) in [("9.000e+09", 9e9), (" -.5", -0.5), ("5.", 5.0), ("12", 12.0)] {
            assert_eq!(f64::scan(field.as_bytes()), Some(value));
        }
        assert_eq!(bool::scan(b" TRUE "), Some(true));
    }
}
