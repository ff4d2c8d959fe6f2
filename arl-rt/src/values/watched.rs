//! A shared variable that records whether it was written.

use std::cell::Cell;

use super::{Array, Shared, Store};

/// A variable like [`Shared`] that records that it may have changed.
#[derive(Default, Debug)]
pub struct Watched<T> {
    value: Shared<T>,
    changed: Cell<bool>,
}

impl<T> Watched<T> {
    /// A variable with this value.
    pub const fn new(value: T) -> Self {
        Self { value: Shared::new(value), changed: Cell::new(false) }
    }

    /// A copy of the value.
    #[track_caller]
    pub fn get(&self) -> T
    where
        T: Clone,
    {
        self.value.get()
    }

    /// Sets the value.
    #[track_caller]
    pub fn set(&self, value: T) {
        self.changed.set(true);
        self.value.set(value);
    }

    /// Returns the result of the function for the value.
    #[track_caller]
    pub fn with<R>(&self, look: impl FnOnce(&T) -> R) -> R {
        self.value.with(look)
    }

    /// Changes the value with the function and returns its result.
    #[track_caller]
    pub fn update<R>(&self, change: impl FnOnce(&mut T) -> R) -> R {
        self.changed.set(true);
        self.value.update(change)
    }

    /// Whether the variable was written since the last `take_changed`.
    #[inline]
    pub(crate) fn is_changed(&self) -> bool {
        self.changed.get()
    }

    /// Whether the variable was written since the last call of this function.
    pub(crate) fn take_changed(&self) -> bool {
        self.changed.take()
    }
}

impl<T: Clone + Default, const N: usize, S: Store<T, N>> Watched<Array<T, N, S>> {
    /// A copy of the element with this index; the start value beyond the last.
    #[track_caller]
    pub fn item(&self, index: usize) -> T {
        self.value.item(index)
    }

    /// Sets the element with this index; does nothing beyond the last.
    #[track_caller]
    pub fn set_item(&self, index: usize, value: T) {
        self.changed.set(true);
        self.value.set_item(index, value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::values::SmallArray;

    #[test]
    fn writing_is_noticed_and_reading_is_not() {
        let table = Watched::new(SmallArray::<i32, 3>::from_values(&[1, 2, 3]));
        assert_eq!((table.item(0), table.get().len(), table.with(|table| table.len())), (1, 3, 3));
        assert!(!table.is_changed());
        let writes: [&dyn Fn(); 3] = [&|| table.set_item(1, 20), &|| table.update(|table| table[2] = 30), &|| {
            table.set(SmallArray::from_values(&[4, 5, 6]))
        }];
        for write in writes {
            write();
            assert!(table.is_changed() && table.take_changed() && !table.take_changed());
        }
        assert_eq!(*table.get(), [4, 5, 6]);
    }
}
