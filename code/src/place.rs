//! Where values are.

use crate::layout::Extent;
use crate::op::Reg;
use arl_lang::catalog::Base;
use serde::{Deserialize, Serialize};

/// Where a value is, for what is not worth an operation of its own: arguments of built-ins, rare copies.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
pub struct Place {
    /// What it is part of.
    pub space: Space,
    /// The first word, counted from the start of the space.
    pub word: u32,
    /// The first string.
    pub text: u32,
    /// The first handle.
    pub handle: u32,
    /// The register with the number of an element, which has been checked, and the extent of one element.
    pub element: Option<(Reg, Extent)>,
}

/// A part of what a function can reach.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub enum Space {
    /// Nowhere: a result that is not used.
    Nowhere,
    /// This register.
    Register(Reg),
    /// The frame of the function.
    Frame,
    /// The global variables.
    Global,
    /// The constants of the code.
    Constant,
    /// A box of the frame.
    Boxed(u16),
    /// The system variable with this number, in the order of `arl_lang::catalog::system_variables`. Words and strings
    /// count from the start of the variable.
    System(u16),
}

impl Place {
    /// The start of a space.
    pub const fn start(space: Space) -> Self {
        Self { space, word: 0, text: 0, handle: 0, element: None }
    }

    /// A place for a result that is not used.
    pub const NOWHERE: Self = Self::start(Space::Nowhere);

    /// The same place, further on by an extent.
    pub fn after(self, extent: Extent) -> Self {
        Self {
            word: self.word + extent.words,
            text: self.text + extent.texts,
            handle: self.handle + extent.handles,
            ..self
        }
    }
}

/// The type of a variable or an argument: a base type, and the sizes of an array.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct ValueType {
    /// The type of the value or of the elements.
    #[serde(with = "crate::numbers::base")]
    pub base: Base,
    /// The sizes of an array, outermost first; empty for a single value.
    pub sizes: Box<[usize]>,
}

impl ValueType {
    /// How many elements it has; 1 for a single value.
    pub fn count(&self) -> usize {
        self.sizes.iter().product()
    }

    /// Whether it is an array.
    pub fn is_array(&self) -> bool {
        !self.sizes.is_empty()
    }
}
