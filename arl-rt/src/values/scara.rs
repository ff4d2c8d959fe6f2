//! System variables as the programs of SCARA robots see them: the controller keeps them with the additional components
//! of six-axis robots.

use std::cell::Cell;

use super::{Array, Shared, Store};

/// A variable seen with a SCARA robot's components. Components that these lack are unset after a write.
#[derive(Debug)]
pub struct AsScara<'a, V>(&'a V);

impl<'a, V> AsScara<'a, V> {
    /// A view of this variable.
    pub(crate) fn new(variable: &'a V) -> Self {
        Self(variable)
    }
}

macro_rules! views {
    ($($wide:ident as $scara:ident)*) => { $(
        impl AsScara<'_, Cell<super::$wide>> {
            /// A copy of the value.
            pub fn get(&self) -> super::$scara {
                self.0.get().into()
            }

            /// Sets the value.
            pub fn set(&self, value: super::$scara) {
                self.0.set(value.into());
            }

            /// Changes the value.
            pub fn update(&self, change: impl FnOnce(super::$scara) -> super::$scara) {
                self.0.set(change(self.0.get().into()).into());
            }
        }

        impl<const N: usize, S: Store<super::$wide, N>> AsScara<'_, Shared<Array<super::$wide, N, S>>> {
            /// A copy of the whole array.
            pub fn get(&self) -> Array<super::$scara, N> {
                self.0.with(|array| Array::build(|at| array.at(at).into()))
            }

            /// Sets the whole array.
            pub fn set(&self, values: Array<super::$scara, N>) {
                self.0.set(Array::build(|at| values.at(at).into()));
            }

            /// A copy of the element with this index; the start value beyond the last.
            pub fn item(&self, index: usize) -> super::$scara {
                self.0.item(index).into()
            }

            /// Sets the element with this index; does nothing beyond the last.
            pub fn set_item(&self, index: usize, value: super::$scara) {
                self.0.set_item(index, value.into());
            }

            /// Returns the result of the function for the value.
            pub fn with<R>(&self, look: impl FnOnce(&Array<super::$scara, N>) -> R) -> R {
                look(&self.get())
            }

            /// Changes the value with the function and returns its result.
            pub fn update<R>(&self, change: impl FnOnce(&mut Array<super::$scara, N>) -> R) -> R {
                let mut values = self.get();
                let result = change(&mut values);
                self.set(values);
                result
            }
        }
    )* };
}

views! {
    Joint as JointScara
    Slip as SlipScara
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::values::{Joint, JointScara, Slip, SlipScara, UNSET};

    #[test]
    fn a_view_reads_and_writes_the_variable_behind_it() {
        let slip = Cell::new(Slip { pdis: 3.0, jdis: 7.0, ..Slip::default() });
        assert_eq!(AsScara::new(&slip).get(), SlipScara { pdis: 3.0, ..SlipScara::default() });
        AsScara::new(&slip).update(|slip| SlipScara { odis: 1.0, ..slip });
        assert_eq!(slip.get(), Slip { pdis: 3.0, odis: 1.0, ..Slip::default() });

        let joints = Shared::new(Array::<Joint, 5>::start());
        let view = AsScara::new(&joints);
        view.set_item(2, JointScara { j4: 4.0, ..JointScara::default() });
        view.update(|joints| joints[2].ej1 = 8.0);
        assert_eq!(joints.item(2), Joint { j4: 4.0, ej1: 8.0, j6: UNSET, ..Joint::default() });
        assert_eq!((view.item(2).j4, view.get()[2].ej1), (4.0, 8.0));
    }
}
