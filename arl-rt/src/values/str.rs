//! The string of ARL: bytes, usually UTF-8.

use std::borrow::Cow;
use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, AddAssign};

/// The longest text that is kept without an allocation.
const INLINE: usize = 15;

/// A string value: any bytes, usually UTF-8. Length, order and comparison work on bytes.
#[derive(Clone)]
pub struct Str(Text);

/// The variant is stored in the vector's niche, so a string is three words wide.
#[derive(Clone)]
enum Text {
    Inline { length: u8, bytes: [u8; INLINE] },
    Static(&'static [u8]),
    Heap(Vec<u8>),
}

impl Str {
    /// The most bytes that a string of a program may have: 16 MiB.
    pub const MOST: usize = 16 << 20;

    /// The empty string.
    pub const fn new() -> Self {
        Self(Text::Static(&[]))
    }

    /// A literal of the program; nothing is copied.
    pub const fn literal(text: &'static str) -> Self {
        Self(Text::Static(text.as_bytes()))
    }

    /// An empty string with room for this many bytes.
    pub fn with_capacity(capacity: usize) -> Self {
        if capacity <= INLINE { Self::new() } else { Self(Text::Heap(Vec::with_capacity(capacity))) }
    }

    /// The bytes.
    #[inline]
    pub fn as_bytes(&self) -> &[u8] {
        match &self.0 {
            Text::Inline { length, bytes } => bytes.get(..usize::from(*length)).unwrap_or(bytes),
            Text::Static(bytes) => bytes,
            Text::Heap(bytes) => bytes,
        }
    }

    /// The number of bytes.
    #[inline]
    pub fn len(&self) -> usize {
        match &self.0 {
            Text::Inline { length, .. } => usize::from(*length),
            Text::Static(bytes) => bytes.len(),
            Text::Heap(bytes) => bytes.len(),
        }
    }

    /// Whether the string is empty.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The text, with U+FFFD in place of bytes that are not UTF-8.
    pub fn to_text(&self) -> Cow<'_, str> {
        String::from_utf8_lossy(self.as_bytes())
    }

    /// Appends bytes.
    #[inline]
    pub fn push_bytes(&mut self, more: &[u8]) {
        if let Text::Heap(bytes) = &mut self.0 {
            bytes.extend_from_slice(more);
        } else {
            self.push_small(more);
        }
    }

    fn push_small(&mut self, more: &[u8]) {
        let old = self.len();
        let all = old + more.len();
        if all > INLINE {
            let mut joined = Vec::with_capacity(all.max(2 * old));
            joined.extend_from_slice(self.as_bytes());
            joined.extend_from_slice(more);
            self.0 = Text::Heap(joined);
            return;
        }
        if let Text::Static(text) = self.0 {
            self.0 = Text::Inline { length: 0, bytes: small(text) };
        }
        if let Text::Inline { length, bytes } = &mut self.0 {
            put(bytes, old, more);
            *length = all as u8;
        }
    }

    /// Appends text.
    #[inline]
    pub fn push_str(&mut self, more: &str) {
        self.push_bytes(more.as_bytes());
    }

    /// Appends one byte.
    #[inline]
    pub fn push(&mut self, byte: u8) {
        self.push_bytes(&[byte]);
    }

    /// Empties the string and keeps its memory.
    pub fn clear(&mut self) {
        if let Text::Heap(bytes) = &mut self.0 {
            bytes.clear();
        } else {
            self.0 = Text::Static(&[]);
        }
    }

    /// Concatenates two texts. A result longer than half of the inline room is allocated at once: usually a third text
    /// follows, and the whole would not stay inline.
    fn sum(first: &[u8], second: &[u8]) -> Str {
        let length = first.len() + second.len();
        if length <= INLINE / 2 {
            let mut bytes = small(first);
            put(&mut bytes, first.len(), second);
            return Self(Text::Inline { length: length as u8, bytes });
        }
        let mut joined = Vec::with_capacity(length.max(2 * INLINE + 2));
        joined.extend_from_slice(first);
        joined.extend_from_slice(second);
        Self(Text::Heap(joined))
    }

    /// Concatenates all parts.
    pub fn concat(parts: &[&Str]) -> Str {
        let mut all = Str::with_capacity(parts.iter().map(|part| part.len()).sum());
        for part in parts {
            all.push_bytes(part.as_bytes());
        }
        all
    }

    /// The bytes as a vector.
    pub fn into_bytes(self) -> Vec<u8> {
        match self.0 {
            Text::Heap(bytes) => bytes,
            _ => self.as_bytes().to_vec(),
        }
    }
}

/// The bytes of a short text.
#[inline]
fn small(text: &[u8]) -> [u8; INLINE] {
    let mut bytes = [0; INLINE];
    put(&mut bytes, 0, text);
    bytes
}

/// Writes a short text at an offset if there is room for it. Two moves that may overlap cover any length: for so few
/// bytes a call of `memcpy` would cost more.
#[inline]
fn put(bytes: &mut [u8; INLINE], at: usize, text: &[u8]) {
    let Some(to) = bytes.get_mut(at..at + text.len()) else { return };
    if !(both_ends::<8>(to, text) || both_ends::<4>(to, text) || both_ends::<2>(to, text)) {
        both_ends::<1>(to, text);
    }
}

/// Writes the first and the last N bytes if there are at least N: this copies up to twice N bytes.
#[inline]
fn both_ends<const N: usize>(to: &mut [u8], from: &[u8]) -> bool {
    let (Some(first), Some(last)) = (from.first_chunk::<N>(), from.last_chunk::<N>()) else { return false };
    if let Some(to) = to.first_chunk_mut() {
        *to = *first;
    }
    if let Some(to) = to.last_chunk_mut() {
        *to = *last;
    }
    true
}

impl Default for Str {
    fn default() -> Self {
        Self::new()
    }
}

impl From<&[u8]> for Str {
    #[inline]
    fn from(bytes: &[u8]) -> Self {
        if bytes.len() <= INLINE {
            Self(Text::Inline { length: bytes.len() as u8, bytes: small(bytes) })
        } else {
            Self(Text::Heap(bytes.to_vec()))
        }
    }
}

impl From<&str> for Str {
    fn from(text: &str) -> Self {
        Self::from(text.as_bytes())
    }
}

impl From<String> for Str {
    fn from(text: String) -> Self {
        Self(Text::Heap(text.into_bytes()))
    }
}

impl From<&String> for Str {
    fn from(text: &String) -> Self {
        Self::from(text.as_bytes())
    }
}

impl From<Vec<u8>> for Str {
    fn from(bytes: Vec<u8>) -> Self {
        Self(Text::Heap(bytes))
    }
}

impl AsRef<[u8]> for Str {
    fn as_ref(&self) -> &[u8] {
        self.as_bytes()
    }
}

impl PartialEq for Str {
    #[inline]
    fn eq(&self, other: &Str) -> bool {
        self.as_bytes() == other.as_bytes()
    }
}

impl Eq for Str {}

impl PartialOrd for Str {
    #[inline]
    fn partial_cmp(&self, other: &Str) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Str {
    #[inline]
    fn cmp(&self, other: &Str) -> Ordering {
        self.as_bytes().cmp(other.as_bytes())
    }
}

impl std::hash::Hash for Str {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.as_bytes().hash(state);
    }
}

macro_rules! compares_with_text {
    ($($text:ty),*) => { $(
        impl PartialEq<$text> for Str {
            #[inline]
            fn eq(&self, other: &$text) -> bool {
                self.as_bytes() == other.as_bytes()
            }
        }

        impl PartialEq<Str> for $text {
            #[inline]
            fn eq(&self, other: &Str) -> bool {
                self.as_bytes() == other.as_bytes()
            }
        }

        impl PartialOrd<$text> for Str {
            #[inline]
            fn partial_cmp(&self, other: &$text) -> Option<Ordering> {
                Some(self.as_bytes().cmp(other.as_bytes()))
            }
        }

        impl PartialOrd<Str> for $text {
            #[inline]
            fn partial_cmp(&self, other: &Str) -> Option<Ordering> {
                Some(self.as_bytes().cmp(other.as_bytes()))
            }
        }
    )* };
}

compares_with_text!(str, &str);

macro_rules! appends {
    ($($more:ty),*) => { $(
        impl AddAssign<$more> for Str {
            #[inline]
            fn add_assign(&mut self, more: $more) {
                self.push_bytes(more.as_bytes());
            }
        }

        impl Add<$more> for Str {
            type Output = Str;

            #[inline]
            fn add(mut self, more: $more) -> Str {
                self.push_bytes(more.as_bytes());
                self
            }
        }

        impl Add<$more> for &Str {
            type Output = Str;

            #[inline]
            fn add(self, more: $more) -> Str {
                Str::sum(self.as_bytes(), more.as_bytes())
            }
        }
    )* };
}

appends!(&Str, &str, Str);

impl fmt::Display for Str {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.to_text())
    }
}

impl fmt::Debug for Str {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.to_text(), f)
    }
}

impl fmt::Write for Str {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.push_str(text);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_three_words_wide() {
        assert_eq!(size_of::<Str>(), 3 * size_of::<usize>());
    }

    #[test]
    fn grows_through_all_its_forms() {
        let mut text = Str::literal("");
        let mut plain = Vec::new();
        for round in 0..200_u8 {
            text.push(round);
            plain.push(round);
            assert_eq!(text.as_bytes(), plain);
            assert_eq!(text.len(), plain.len());
        }
        text.clear();
        assert!(text.is_empty());
        assert_eq!(Str::from(plain.clone()).into_bytes(), plain);
    }

    #[test]
    fn appends_any_length_to_any_length() {
        let all: Vec<u8> = (b'a'..=b'z').chain(b'A'..=b'Z').collect();
        for first in 0..=20 {
            for more in 0..=20 {
                let mut text = Str::from(&all[..first]);
                text.push_bytes(&all[first..first + more]);
                assert_eq!(text.as_bytes(), &all[..first + more], "{first} and {more} bytes");
            }
        }
        let mut text = Str::literal("ab");
        text.push_str("cde");
        assert_eq!(text, "abcde");
    }

    #[test]
    fn joins() {
        let (a, b) = (Str::from("ab"), Str::literal("cdefghijklmnopqrstuvwxyz"));
        assert_eq!(&a + &b, "abcdefghijklmnopqrstuvwxyz");
        assert_eq!(a.clone() + "!", "ab!");
        assert_eq!(a.clone() + b.clone(), Str::concat(&[&a, &b]));
        let mut c = b.clone();
        c += &a;
        c += "12";
        assert_eq!(c, "cdefghijklmnopqrstuvwxyzab12");
        assert_eq!(b, "cdefghijklmnopqrstuvwxyz", "a literal is not changed by its copy");
    }

    #[test]
    fn compares_by_bytes_whatever_the_form() {
        assert_eq!(Str::literal("same"), Str::from("same"));
        assert_eq!(Str::from(String::from("same")), Str::from("same"));
        let [upper, lower, short, accented] = ["Z", "a", "ab", "\u{e9}"].map(Str::from);
        assert!(upper < lower && lower < short);
        assert!(short < "abc" && short > "aa");
        assert!("b" > short);
        assert!(accented > upper, "UTF-8 bytes of \u{e9} begin with c3");
        assert_ne!(Str::from("a"), "A");
    }

    #[test]
    fn shows_bytes_that_are_no_text() {
        assert_eq!(Str::from(&b"a\xff"[..]).to_string(), "a\u{fffd}");
        assert_eq!(format!("{:>4}|{:?}", Str::from("ab"), Str::from("q\"")), "  ab|\"q\\\"\"");
    }
}
