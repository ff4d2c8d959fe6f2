//! Global arrays of values that are copied: every element is a cell of its own, so that access to one costs no more
//! than in an array.

use super::{Array, Store};
use std::cell::Cell;
use std::fmt;
use std::marker::PhantomData;

/// A global array of numbers, structures or enumerations. `S` is where a copy of the whole array keeps its elements.
pub struct Cells<T, const N: usize, S = Box<[T; N]>> {
    elements: Box<[Cell<T>; N]>,
    of: PhantomData<S>,
}

/// A global array that is copied as a [`super::SmallArray`].
pub type SmallCells<T, const N: usize> = Cells<T, N, [T; N]>;

impl<T: Copy + Default, const N: usize, S: Store<T, N>> Cells<T, N, S> {
    /// A copy of the whole array.
    pub fn get(&self) -> Array<T, N, S> {
        Array::build(|at| self.item(at))
    }

    /// Sets the whole array.
    pub fn set(&self, values: Array<T, N, S>) {
        for (cell, value) in self.elements.iter().zip(&*values) {
            cell.set(*value);
        }
    }

    /// Direct access to the elements, for a loop that uses many of them.
    #[inline]
    pub fn elements(&self) -> Elements<'_, T, N> {
        Elements(&self.elements)
    }

    /// The element with this index; the start value beyond the last.
    #[inline]
    pub fn item(&self, index: usize) -> T {
        self.elements().item(index)
    }

    /// Sets the element with this index; does nothing beyond the last.
    #[inline]
    pub fn set_item(&self, index: usize, value: T) {
        self.elements().set_item(index, value);
    }

    /// Changes the element with this index.
    #[inline]
    pub fn update_item(&self, index: usize, change: impl FnOnce(T) -> T) {
        self.elements().update_item(index, change);
    }
}

/// The elements of [`Cells`].
#[derive(Clone, Copy)]
pub struct Elements<'a, T, const N: usize>(&'a [Cell<T>; N]);

impl<T: Copy + Default, const N: usize> Elements<'_, T, N> {
    /// The element with this index; the start value beyond the last.
    #[inline]
    pub fn item(self, index: usize) -> T {
        // After this test of the index rustc knows that indexing cannot fail. With `get`, the test of its result would
        // remain.
        if index < N { self.0[index].get() } else { T::default() }
    }

    /// Sets the element with this index; does nothing beyond the last.
    #[inline]
    pub fn set_item(self, index: usize, value: T) {
        if index < N {
            self.0[index].set(value);
        }
    }

    /// Changes the element with this index.
    #[inline]
    pub fn update_item(self, index: usize, change: impl FnOnce(T) -> T) {
        if index < N {
            let cell = &self.0[index];
            cell.set(change(cell.get()));
        }
    }
}

impl<T: Copy + Default, const N: usize, S: Store<T, N>> Default for Cells<T, N, S> {
    fn default() -> Self {
        let elements: Box<[Cell<T>]> = (0..N).map(|_| Cell::default()).collect();
        match elements.try_into() {
            Ok(elements) => Self { elements, of: PhantomData },
            Err(_) => unreachable!("N elements were collected"),
        }
    }
}

impl<T: Copy + fmt::Debug, const N: usize> fmt::Debug for Elements<'_, T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.0.iter().map(Cell::get)).finish()
    }
}

impl<T: Copy + Default + fmt::Debug, const N: usize, S: Store<T, N>> fmt::Debug for Cells<T, N, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.elements().fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::values::{Pose, SmallArray};

    #[test]
    fn elements_are_reached_one_by_one() {
        let cells = SmallCells::<i32, 3>::default();
        cells.set_item(1, 5);
        cells.set_item(3, 7);
        cells.update_item(2, |it| it - 1);
        cells.update_item(3, |it| it - 1);
        assert_eq!(*cells.get(), [0, 5, -1]);
        assert_eq!((cells.item(1), cells.item(3)), (5, 0));
    }

    #[test]
    fn the_whole_is_copied() {
        let cells = Cells::<Pose, 200>::default();
        let mut values = cells.get();
        values[199].x = 3.5;
        cells.set(values.clone());
        values[199].x = 4.0;
        assert_eq!(cells.item(199).x, 3.5);
        let small = SmallCells::<u8, 2>::default();
        small.set(SmallArray::from_values(&[1, 2]));
        assert_eq!(format!("{small:?}"), "[1, 2]");
    }
}
