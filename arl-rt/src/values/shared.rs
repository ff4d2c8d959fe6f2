//! A cell for values that are not `Copy`, shared by all parts that access the global variables.

use super::{Array, Store};
use std::cell::RefCell;

/// A variable that several parts of a program access: strings, arrays, workpieces.
///
/// Each access ends when its call returns. The closures of [`Shared::with`] and [`Shared::update`] use their argument
/// only and never access the same variable again.
#[derive(Default, Debug)]
pub struct Shared<T>(RefCell<T>);

impl<T> Shared<T> {
    /// A variable with this value.
    pub const fn new(value: T) -> Self {
        Self(RefCell::new(value))
    }

    /// A copy of the value.
    #[inline]
    #[track_caller]
    pub fn get(&self) -> T
    where
        T: Clone,
    {
        self.0.borrow().clone()
    }

    /// Sets the value.
    #[inline]
    #[track_caller]
    pub fn set(&self, value: T) {
        drop(self.0.replace(value));
    }

    /// Returns the result of the function for the value.
    #[inline]
    #[track_caller]
    pub fn with<R>(&self, look: impl FnOnce(&T) -> R) -> R {
        look(&self.0.borrow())
    }

    /// Changes the value with the function and returns its result.
    #[inline]
    #[track_caller]
    pub fn update<R>(&self, change: impl FnOnce(&mut T) -> R) -> R {
        change(&mut self.0.borrow_mut())
    }
}

impl<T: Clone + Default, const N: usize, S: Store<T, N>> Shared<Array<T, N, S>> {
    /// A copy of the element with this index; the start value beyond the last.
    #[inline]
    #[track_caller]
    pub fn item(&self, index: usize) -> T {
        self.0.borrow().at(index)
    }

    /// Sets the element with this index; does nothing beyond the last.
    #[inline]
    #[track_caller]
    pub fn set_item(&self, index: usize, value: T) {
        if let Some(element) = self.0.borrow_mut().get_mut(index) {
            *element = value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::values::{SmallArray, Str};

    #[test]
    fn elements_are_reached_one_by_one() {
        let table = Shared::new(SmallArray::<i32, 3>::from_values(&[1, 2, 3]));
        table.set_item(1, 20);
        table.set_item(3, 30);
        assert_eq!((table.item(0), table.item(1), table.item(3)), (1, 20, 0));
        assert_eq!(*table.get(), [1, 20, 3]);
    }

    #[test]
    fn is_read_and_written() {
        let text = Shared::new(Str::from("a"));
        text.update(|text| text.push(b'b'));
        assert_eq!(text.get(), "ab");
        text.set(text.get() + "c");
        assert_eq!(text.with(Str::len), 3);
    }
}
