//! Many global variables of one type: cells in a row, with which a program of many points compiles faster than with a
//! field for each.

use std::cell::Cell;
use std::fmt;
use std::ops::Deref;

use super::data::DataVar;
use crate::values::Teach;

/// N global variables of one type.
pub struct Slots<T, const N: usize>(Box<[Cell<T>; N]>);

impl<T: Default, const N: usize> Default for Slots<T, N> {
    /// All variables with their start values.
    fn default() -> Self {
        let cells: Box<[Cell<T>]> = (0..N).map(|_| Cell::default()).collect();
        match cells.try_into() {
            Ok(cells) => Self(cells),
            Err(_) => unreachable!("N cells were collected"),
        }
    }
}

impl<T, const N: usize> Deref for Slots<T, N> {
    type Target = [Cell<T>; N];

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<T, const N: usize> Slots<T, N>
where
    Cell<T>: Teach,
{
    /// The variables with their names, one for each, for values that are read again when a program is loaded.
    pub fn named<'a>(&'a self, names: &'a [&'static str; N]) -> impl Iterator<Item = DataVar<'a>> {
        names.iter().zip(self.iter()).map(|(name, slot)| DataVar { name, sizes: &[], slot })
    }
}

impl<T: Copy + fmt::Debug, const N: usize> fmt::Debug for Slots<T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter().map(Cell::get)).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_is_a_variable_with_a_name() {
        let slots = Slots::<i32, 3>::default();
        slots[1].set(5);
        let named: Vec<&str> = slots.named(&["a", "b", "c"]).map(|var| var.name).collect();
        assert_eq!(named, ["a", "b", "c"]);
        assert_eq!(format!("{slots:?}"), "[0, 5, 0]");
    }
}
