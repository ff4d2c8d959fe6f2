//! The values of ARL: strings, arrays, structures, enumerations, and the variables that hold them.

mod array;
mod cells;
mod convert;
mod enums;
mod literal;
mod scara;
mod shared;
mod str;
mod structs;
mod teach;
mod teach_error;
pub mod text;
mod watched;

pub use array::{Array, SmallArray, Store};
pub use cells::{Cells, SmallCells};
pub use enums::*;
pub use literal::{Literal, put_array, write_array};
pub use scara::AsScara;
pub use shared::Shared;
pub use str::Str;
pub use structs::*;
pub(crate) use teach::teach_text;
pub use teach::{Fixed, Onto, Teach, teach_variable};
pub use teach_error::{TeachError, TeachProblem};
pub use watched::Watched;

/// The value of a component that is not set: "keep the previous value".
pub const UNSET: f64 = 9e9;

/// Whether a component has been set.
#[inline]
pub fn is_set(component: f64) -> bool {
    component != UNSET
}
