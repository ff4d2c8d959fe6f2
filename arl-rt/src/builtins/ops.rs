//! Operators that ARL and Rust do not share.

use crate::fault::Fault;
use crate::values::{Array, Joint, JointScara, Store, Str, UNSET};
use std::ops::{Add, Neg, Sub};

/// Appends to a string.
///
/// # Errors
/// [`Fault::TooLong`] if the string would become longer than [`Str::MOST`]; then nothing is appended.
#[inline]
pub fn append(text: &mut Str, more: impl AsRef<[u8]>) -> Result<(), Fault> {
    let more = more.as_ref();
    within(text.len() + more.len())?;
    text.push_bytes(more);
    Ok(())
}

/// Returns the string unchanged.
///
/// # Errors
/// [`Fault::TooLong`] if the string is longer than [`Str::MOST`].
#[inline]
pub fn fits(text: Str) -> Result<Str, Fault> {
    within(text.len()).map(|()| text)
}

/// About how many steps make up a distance: at least the real number, at most twice as many. A division would take
/// longer than the short loops whose iterations are counted with it.
#[inline]
pub fn steps(distance: i32, step: i32) -> i32 {
    distance >> (31 - (step | 1).leading_zeros())
}

#[inline]
fn within(length: usize) -> Result<(), Fault> {
    if length > Str::MOST { Err(Fault::TooLong { length, most: Str::MOST }) } else { Ok(()) }
}

/// The integers of ARL.
pub trait Integer: Copy {
    /// The width in bits.
    const WIDTH: u8;
    /// The quotient, truncated towards zero; `None` for a zero divisor. The least int by -1 wraps.
    fn quotient(self, by: Self) -> Option<Self>;
    /// The remainder, with the sign of the dividend; `None` for a zero divisor.
    fn remainder(self, by: Self) -> Option<Self>;
    /// All bits shifted up; `None` if the count is not below the width.
    fn up(self, count: u32) -> Option<Self>;
    /// All bits shifted down, the sign kept; `None` if the count is not below the width.
    fn down(self, count: u32) -> Option<Self>;
}

macro_rules! integers {
    ($($ty:ty)*) => { $(
        impl Integer for $ty {
            const WIDTH: u8 = <$ty>::BITS as u8;

            #[inline]
            fn quotient(self, by: Self) -> Option<Self> {
                if by == 0 { None } else { Some(self.wrapping_div(by)) }
            }

            #[inline]
            fn remainder(self, by: Self) -> Option<Self> {
                if by == 0 { None } else { Some(self.wrapping_rem(by)) }
            }

            #[inline]
            fn up(self, count: u32) -> Option<Self> {
                self.checked_shl(count)
            }

            #[inline]
            fn down(self, count: u32) -> Option<Self> {
                self.checked_shr(count)
            }
        }
    )* };
}

integers!(i32 u32 u8);

/// `a / b`
///
/// # Errors
/// [`Fault::DivideByZero`]
#[inline]
pub fn div<T: Integer>(a: T, b: T) -> Result<T, Fault> {
    a.quotient(b).ok_or_else(by_zero)
}

/// `a % b`
///
/// # Errors
/// [`Fault::DivideByZero`]
#[inline]
pub fn rem<T: Integer>(a: T, b: T) -> Result<T, Fault> {
    a.remainder(b).ok_or_else(by_zero)
}

/// `a % b` of doubles: the remainder of the quotient truncated towards zero, with the sign of `a`.
///
/// # Errors
/// [`Fault::DivideByZero`]
#[inline]
pub fn rem_double(a: f64, b: f64) -> Result<f64, Fault> {
    if b == 0.0 { Err(by_zero()) } else { Ok(a % b) }
}

/// The type of a shift count: int or uint.
pub trait Count: Copy {
    /// The places to shift by; a negative count becomes a large one.
    fn places(self) -> u32;
    /// The number itself.
    fn number(self) -> i64;
}

impl Count for i32 {
    #[inline]
    fn places(self) -> u32 {
        self as u32
    }

    fn number(self) -> i64 {
        self.into()
    }
}

impl Count for u32 {
    #[inline]
    fn places(self) -> u32 {
        self
    }

    fn number(self) -> i64 {
        self.into()
    }
}

/// `value << count`
///
/// # Errors
/// [`Fault::ShiftCount`] for a count outside 0 to 31, for a byte 0 to 7.
#[inline]
pub fn shl<T: Integer>(value: T, count: impl Count) -> Result<T, Fault> {
    value.up(count.places()).ok_or_else(|| too_far(count, T::WIDTH))
}

/// `value >> count`; an int keeps its sign.
///
/// # Errors
/// [`Fault::ShiftCount`] for a count outside 0 to 31, for a byte 0 to 7.
#[inline]
pub fn shr<T: Integer>(value: T, count: impl Count) -> Result<T, Fault> {
    value.down(count.places()).ok_or_else(|| too_far(count, T::WIDTH))
}

/// The position of an element in an array of one dimension.
///
/// # Errors
/// [`Fault::Index`] if the index is negative or not below the size.
#[inline]
pub fn index(index: i32, size: usize) -> Result<usize, Fault> {
    // A negative index becomes a large one.
    let at = index as u32 as usize;
    if at < size { Ok(at) } else { Err(outside(index, size)) }
}

/// The position of an element in an array of several dimensions with these sizes, outermost first.
///
/// # Errors
/// [`Fault::Index`] if an index is negative or not below its size.
#[inline]
pub fn index2<const D: usize>(indices: [i32; D], sizes: [usize; D]) -> Result<usize, Fault> {
    let mut place = 0;
    for (at, size) in indices.into_iter().zip(sizes) {
        place = place * size + index(at, size)?;
    }
    Ok(place)
}

// Faults are created in separate functions, so that the compiler can keep them out of the code that does not fail.

#[cold]
fn by_zero() -> Fault {
    Fault::DivideByZero
}

#[cold]
fn too_far(count: impl Count, width: u8) -> Fault {
    Fault::ShiftCount { count: count.number(), width }
}

#[cold]
fn outside(index: i32, size: usize) -> Fault {
    Fault::Index { index, size: u32::try_from(size).unwrap_or(u32::MAX) }
}

/// A value for a system variable with a range: a number, or an array of numbers.
pub trait Ranged {
    /// The first number that is not within `low` to `high`.
    fn beyond(&self, low: f64, high: f64) -> Option<f64>;
}

macro_rules! ranged {
    ($($ty:ty)*) => { $(
        impl Ranged for $ty {
            #[inline]
            fn beyond(&self, low: f64, high: f64) -> Option<f64> {
                let number = f64::from(*self);
                (!(low..=high).contains(&number)).then_some(number)
            }
        }
    )* };
}

ranged!(i32 u32 u8 f64);

impl<T: Ranged, const N: usize, S: Store<T, N>> Ranged for Array<T, N, S> {
    fn beyond(&self, low: f64, high: f64) -> Option<f64> {
        self.iter().find_map(|element| element.beyond(low, high))
    }
}

/// Checks a value for a system variable that takes `low` to `high`; in an array, each element.
///
/// # Errors
/// [`Fault::Range`]
#[inline]
pub fn in_range<T: Ranged>(value: T, low: f64, high: f64) -> Result<T, Fault> {
    match value.beyond(low, high) {
        None => Ok(value),
        Some(value) => Err(Fault::Range { value, low, high }),
    }
}

/// A value for a system variable that takes only certain texts: a text, or an array of texts.
pub trait Worded {
    /// The first text that is not one of these.
    fn other_than(&self, words: &[&str]) -> Option<&Str>;
}

impl Worded for Str {
    fn other_than(&self, words: &[&str]) -> Option<&Str> {
        (!words.iter().any(|word| self == *word)).then_some(self)
    }
}

impl<T: Worded, const N: usize, S: Store<T, N>> Worded for Array<T, N, S> {
    fn other_than(&self, words: &[&str]) -> Option<&Str> {
        self.iter().find_map(|element| element.other_than(words))
    }
}

/// Checks a value for a system variable that takes only these texts; in an array, each element.
///
/// # Errors
/// [`Fault::Word`]
pub fn one_of<T: Worded>(value: T, words: &'static [&'static str]) -> Result<T, Fault> {
    match value.other_than(words) {
        None => Ok(value),
        Some(text) => Err(Fault::Word { text: text.to_text().into(), taken: words }),
    }
}

/// Sums, differences and negation by component; an unset component stays unset.
macro_rules! joints {
    ($($ty:ident: $count:literal)*) => { $(
        impl Add for $ty {
            type Output = $ty;

            fn add(self, other: $ty) -> $ty {
                let (a, b): ([f64; $count], [f64; $count]) = (self.into(), other.into());
                std::array::from_fn(|at| both(a[at], b[at], a[at] + b[at])).into()
            }
        }

        impl Sub for $ty {
            type Output = $ty;

            fn sub(self, other: $ty) -> $ty {
                let (a, b): ([f64; $count], [f64; $count]) = (self.into(), other.into());
                std::array::from_fn(|at| both(a[at], b[at], a[at] - b[at])).into()
            }
        }

        impl Neg for $ty {
            type Output = $ty;

            fn neg(self) -> $ty {
                <[f64; $count]>::from(self).map(|axis| both(axis, axis, -axis)).into()
            }
        }
    )* };
}

joints!(Joint: 12 JointScara: 10);

/// The result if both operands are set; otherwise unset.
fn both(a: f64, b: f64, result: f64) -> f64 {
    if a == UNSET || b == UNSET { UNSET } else { result }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::values::SmallArray;

    #[test]
    fn division() {
        assert_eq!(div(7, -2), Ok(-3));
        assert_eq!(rem(7, -2), Ok(1));
        assert_eq!(rem(-7, 2), Ok(-1));
        assert_eq!(div(i32::MIN, -1), Ok(i32::MIN));
        assert_eq!(rem(i32::MIN, -1), Ok(0));
        assert_eq!(div(200_u8, 3), Ok(66));
        assert_eq!(rem(4_000_000_000_u32, 7), Ok(3));
        assert_eq!(div(1, 0), Err(Fault::DivideByZero));
        assert_eq!(rem(1_u8, 0), Err(Fault::DivideByZero));
        assert_eq!(div(1_u32, 0), Err(Fault::DivideByZero));
        assert_eq!(rem_double(-7.5, 2.0), Ok(-1.5));
        assert_eq!(rem_double(1.0, -0.0), Err(Fault::DivideByZero));
    }

    #[test]
    fn shifts() {
        assert_eq!(shl(1, 31), Ok(i32::MIN));
        assert_eq!(shr(-8, 1), Ok(-4));
        assert_eq!(shr(0x8000_0000_u32, 31), Ok(1));
        assert_eq!(shl(0x81_u8, 1), Ok(2));
        assert_eq!(shl(1, 32), Err(Fault::ShiftCount { count: 32, width: 32 }));
        assert_eq!(shr(1, -1), Err(Fault::ShiftCount { count: -1, width: 32 }));
        assert_eq!(shl(1, 3_u32), Ok(8));
        assert_eq!(shr(1, u32::MAX), Err(Fault::ShiftCount { count: 4_294_967_295, width: 32 }));
        assert_eq!(shl(1_u8, 8), Err(Fault::ShiftCount { count: 8, width: 8 }));
    }

    #[test]
    fn indices() {
        assert_eq!(index(2, 3), Ok(2));
        assert_eq!(index(3, 3), Err(Fault::Index { index: 3, size: 3 }));
        assert_eq!(index(-1, 3), Err(Fault::Index { index: -1, size: 3 }));
        assert_eq!(index2([1, 2], [2, 3]), Ok(5));
        assert_eq!(index2([1, 0, 3], [2, 3, 4]), Ok(15));
        assert_eq!(index2([1, 3], [2, 3]), Err(Fault::Index { index: 3, size: 3 }));
        assert_eq!(index2([2, 0], [2, 3]), Err(Fault::Index { index: 2, size: 2 }));
    }

    #[test]
    fn ranges() {
        assert_eq!(in_range(5, 0.0, 5.0), Ok(5));
        assert_eq!(in_range(5.5, 0.0, 5.0), Err(Fault::Range { value: 5.5, low: 0.0, high: 5.0 }));
        assert!(in_range(f64::NAN, 0.0, 5.0).is_err());
        let array: SmallArray<f64, 3> = [1.0, 5.0, 6.5].into();
        assert_eq!(in_range(array.clone(), 0.0, 5.0).map(drop), Err(Fault::Range { value: 6.5, low: 0.0, high: 5.0 }));
        assert!(in_range(array, 0.0, 6.5).is_ok());
    }

    #[test]
    fn joints_keep_unset_axes() {
        let a = Joint { j1: 1.0, j2: 2.0, ej1: 5.0, ..Joint::default() };
        let b = Joint { j1: 10.0, j3: 3.0, ej1: -5.0, ..Joint::default() };
        assert_eq!(a + b, Joint { j1: 11.0, ej1: 0.0, ..Joint::default() });
        assert_eq!(a - b, Joint { j1: -9.0, ej1: 10.0, ..Joint::default() });
        assert_eq!(-a, Joint { j1: -1.0, j2: -2.0, ej1: -5.0, ..Joint::default() });
        let scara = JointScara { j3: -10.0, ..JointScara::default() };
        assert_eq!(scara + scara, JointScara { j3: -20.0, ..JointScara::default() });
    }
}
