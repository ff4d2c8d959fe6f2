//! How many words, strings and handles a value takes.

use arl_lang::catalog::{Base, Family, Start, Struct, UNSET};
use serde::{Deserialize, Serialize};

/// The space that a value takes in a frame or among the global variables.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug, Serialize, Deserialize)]
pub struct Extent {
    /// Words of 8 bytes.
    pub words: u32,
    /// Strings.
    pub texts: u32,
    /// Clocks and connections.
    pub handles: u32,
}

impl Extent {
    /// The extent of a value of this type.
    ///
    /// ```
    /// use arl_code::Extent;
    /// use arl_lang::catalog::{Base, Family, Struct};
    ///
    /// let wobj = Extent::of(Base::Struct(Struct::Wobj), Family::SixAxis);
    /// assert_eq!((wobj.words, wobj.texts), (7, 1));
    /// ```
    pub fn of(base: Base, family: Family) -> Self {
        match base {
            Base::Void => Self::default(),
            Base::String => Self { texts: 1, ..Self::default() },
            Base::Handle(_) => Self { handles: 1, ..Self::default() },
            Base::Struct(id) => {
                let components = id.def(family).components.iter();
                components.fold(Self::default(), |all, component| all.plus(Self::of(component.ty, family)))
            }
            _ => Self { words: 1, ..Self::default() },
        }
    }

    /// The extent of the components before the one with this index: the offset of that component.
    pub fn before(id: Struct, index: usize, family: Family) -> Self {
        let components = id.def(family).components.iter().take(index);
        components.fold(Self::default(), |all, component| all.plus(Self::of(component.ty, family)))
    }

    /// Both together.
    pub fn plus(self, other: Self) -> Self {
        Self { words: self.words + other.words, texts: self.texts + other.texts, handles: self.handles + other.handles }
    }

    /// As many of them.
    pub fn times(self, count: u32) -> Self {
        Self { words: self.words * count, texts: self.texts * count, handles: self.handles * count }
    }

    /// The larger of each.
    pub fn max(self, other: Self) -> Self {
        Self {
            words: self.words.max(other.words),
            texts: self.texts.max(other.texts),
            handles: self.handles.max(other.handles),
        }
    }
}

/// Appends the words of a type's start value; strings start empty.
pub fn start_words(base: Base, family: Family, out: &mut Vec<u64>) {
    match base {
        Base::Struct(id) => {
            for component in id.def(family).components {
                match component.start {
                    Start::Unset => out.push(UNSET.to_bits()),
                    Start::Int(number) => out.push(u64::from(number as u32)),
                    Start::Zero => start_words(component.ty, family, out),
                }
            }
        }
        Base::Void | Base::String | Base::Handle(_) => {}
        _ => out.push(0),
    }
}
