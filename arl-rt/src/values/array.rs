//! Arrays: flat, of a fixed number of elements, copied like every value.

use std::fmt;
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut};

/// Where the elements of an array live.
pub trait Store<T, const N: usize>: Clone {
    /// N elements, each made from its index.
    fn build(make: impl FnMut(usize) -> T) -> Self;
    /// The elements.
    fn elements(&self) -> &[T; N];
    /// The elements, for writing.
    fn elements_mut(&mut self) -> &mut [T; N];
}

impl<T: Clone, const N: usize> Store<T, N> for [T; N] {
    #[inline]
    fn build(make: impl FnMut(usize) -> T) -> Self {
        std::array::from_fn(make)
    }

    #[inline]
    fn elements(&self) -> &[T; N] {
        self
    }

    #[inline]
    fn elements_mut(&mut self) -> &mut [T; N] {
        self
    }
}

impl<T: Clone, const N: usize> Store<T, N> for Box<[T; N]> {
    fn build(make: impl FnMut(usize) -> T) -> Self {
        let elements: Box<[T]> = (0..N).map(make).collect();
        match elements.try_into() {
            Ok(elements) => elements,
            Err(_) => unreachable!("N elements were collected"),
        }
    }

    #[inline]
    fn elements(&self) -> &[T; N] {
        self
    }

    #[inline]
    fn elements_mut(&mut self) -> &mut [T; N] {
        self
    }
}

/// An array of N elements, whatever the number of its dimensions. The elements live on the heap, so that large arrays
/// fill neither the stack nor the state of a waiting function; see [`SmallArray`] for small ones.
#[derive(Clone)]
pub struct Array<T, const N: usize, S = Box<[T; N]>> {
    elements: S,
    of: PhantomData<T>,
}

/// An array that lives where it is declared: suitable up to about 1 KiB.
pub type SmallArray<T, const N: usize> = Array<T, N, [T; N]>;

impl<T: Clone + Default, const N: usize, S: Store<T, N>> Array<T, N, S> {
    /// An array whose elements have their start value.
    pub fn start() -> Self {
        Self::build(|_| T::default())
    }

    /// An array whose elements are each made from their index.
    pub(super) fn build(make: impl FnMut(usize) -> T) -> Self {
        Self { elements: S::build(make), of: PhantomData }
    }

    /// An array whose first elements have these values, the others their start value; values beyond N are ignored.
    pub fn from_values(values: &[T]) -> Self {
        Self { elements: S::build(|at| values.get(at).cloned().unwrap_or_default()), of: PhantomData }
    }

    /// A copy of the element with this index; the start value beyond the last.
    #[inline]
    pub fn at(&self, index: usize) -> T {
        self.get(index).cloned().unwrap_or_default()
    }
}

impl<T, const N: usize, S: Store<T, N>> Array<T, N, S> {
    /// Direct access to the elements, for a loop that reads many of them.
    #[inline]
    pub fn elements(&self) -> &[T; N] {
        self.elements.elements()
    }

    /// Direct write access to the elements, for a loop.
    #[inline]
    pub fn elements_mut(&mut self) -> &mut [T; N] {
        self.elements.elements_mut()
    }
}

impl<T: Clone + Default, const N: usize, S: Store<T, N>> Default for Array<T, N, S> {
    fn default() -> Self {
        Self::start()
    }
}

impl<T, const N: usize, S: Store<T, N>> Deref for Array<T, N, S> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        self.elements.elements()
    }
}

impl<T, const N: usize, S: Store<T, N>> DerefMut for Array<T, N, S> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T] {
        self.elements.elements_mut()
    }
}

impl<T: PartialEq, const N: usize, S: Store<T, N>> PartialEq for Array<T, N, S> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<T: Clone, const N: usize> From<[T; N]> for Array<T, N> {
    fn from(elements: [T; N]) -> Self {
        Self { elements: Box::new(elements), of: PhantomData }
    }
}

impl<T: Clone, const N: usize> From<[T; N]> for SmallArray<T, N> {
    fn from(elements: [T; N]) -> Self {
        Self { elements, of: PhantomData }
    }
}

impl<T: fmt::Debug, const N: usize, S: Store<T, N>> fmt::Debug for Array<T, N, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&**self, f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fill<S: Store<i32, 5>>() {
        let mut array = Array::<i32, 5, S>::from_values(&[1, 2, 3]);
        assert_eq!(*array, [1, 2, 3, 0, 0]);
        let copy = array.clone();
        array[4] = 7;
        assert_eq!((array.at(4), copy.at(4), copy.at(5)), (7, 0, 0));
        assert_ne!(array, copy);
        assert_eq!(Array::<i32, 5, S>::from_values(&[1; 9]).len(), 5);
        assert_eq!(*Array::<i32, 5, S>::start(), [0; 5]);
    }

    #[test]
    fn holds_values_in_either_place() {
        fill::<[i32; 5]>();
        fill::<Box<[i32; 5]>>();
        assert_eq!(size_of::<Array<f64, 10_000>>(), size_of::<usize>());
        assert_eq!(size_of::<SmallArray<f64, 16>>(), 128);
    }

    #[test]
    fn is_passed_as_a_slice() {
        fn sum(values: &[i32]) -> i32 {
            values.iter().sum()
        }
        let array: Array<i32, 3> = [1, 2, 3].into();
        assert_eq!(sum(&array), 6);
    }
}
