//! Functions of strings. Positions and lengths count bytes.

use crate::fault::Fault;
use crate::values::Str;

fn domain(function: &'static str, problem: String) -> Fault {
    Fault::Domain { function, problem: problem.into() }
}

/// The length of the string in bytes.
#[inline]
pub fn strlen(s: &Str) -> i32 {
    i32::try_from(s.len()).unwrap_or(i32::MAX)
}

/// The part of `len` bytes from `startpos` (from 0) on; it is cut at the end of the string, and without `len` it
/// extends to the end.
///
/// # Errors
/// [`Fault::Domain`] for a start outside the string or a negative length.
#[inline]
pub fn substr(s: &Str, startpos: i32, len: Option<i32>) -> Result<Str, Fault> {
    let bytes = s.as_bytes();
    let start = usize::try_from(startpos).ok().filter(|start| *start < bytes.len());
    let start = start.ok_or_else(|| {
        domain("substr", format!("start {startpos} is outside the string, whose length is {}", bytes.len()))
    })?;
    let rest = bytes.get(start..).unwrap_or_default();
    let length = match len {
        None => rest.len(),
        Some(len) => {
            usize::try_from(len).map_err(|_| domain("substr", format!("length is {len}, but must be 0 or more")))?
        }
    };
    Ok(Str::from(rest.get(..length).unwrap_or(rest)))
}

/// The code of a string of one character.
///
/// # Errors
/// [`Fault::Domain`] for any other string.
#[inline]
pub fn toascii(s: &Str) -> Result<i32, Fault> {
    match s.as_bytes() {
        [byte] => Ok(i32::from(*byte)),
        bytes => Err(domain("toascii", format!("\"{s}\" has {} bytes, but must be one character", bytes.len()))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manuals_examples() {
        assert_eq!(strlen(&Str::from("hello world!")), 12);
        assert_eq!(substr(&Str::from("hello world! "), 0, Some(5)), Ok(Str::from("hello")));
        assert_eq!(toascii(&Str::from("a")), Ok(97));
    }

    #[test]
    fn edges() {
        let text = Str::from("h\u{e9}llo");
        assert_eq!(strlen(&text), 6);
        assert_eq!(substr(&text, 3, None), Ok(Str::from("llo")));
        assert_eq!(substr(&text, 3, Some(99)), Ok(Str::from("llo")));
        assert_eq!(substr(&text, 5, Some(0)), Ok(Str::new()));
        assert_eq!(substr(&text, 1, Some(1)).unwrap().as_bytes(), b"\xc3");
        let fault = substr(&text, 6, None).unwrap_err();
        assert_eq!(fault.to_string(), "substr: start 6 is outside the string, whose length is 6");
        assert!(substr(&text, -1, None).is_err());
        assert!(substr(&Str::new(), 0, None).is_err());
        assert_eq!(substr(&text, 0, Some(-1)).unwrap_err().to_string(), "substr: length is -1, but must be 0 or more");
        assert!(toascii(&Str::new()).is_err());
        assert_eq!(
            toascii(&Str::from("ab")).unwrap_err().to_string(),
            "toascii: \"ab\" has 2 bytes, but must be one character"
        );
    }
}
