//! The format of state files: values as words of text without loss.

use std::fmt::Write;

use crate::values::{Array, CentroidPos, Frame, InertiaTensor, Joint, Pose, Store, Str, Tool, ToolInertiaPara, Wobj};

/// Words between blanks.
pub(crate) type Words<'a> = std::str::SplitAsciiWhitespace<'a>;

/// A value that can be written as words and read back exactly.
pub(crate) trait StateFormat: Sized {
    /// Appends the words, each followed by a blank or a new line.
    fn write(&self, out: &mut String);

    /// Reads the words; `None` if they are not a value of this type.
    fn read(words: &mut Words<'_>) -> Option<Self>;
}

macro_rules! plain {
    ($($ty:ty),*) => { $(
        impl StateFormat for $ty {
            fn write(&self, out: &mut String) {
                // Writing to a string does not fail.
                let _ = write!(out, "{self:?} ");
            }

            fn read(words: &mut Words<'_>) -> Option<Self> {
                words.next()?.parse().ok()
            }
        }
    )* };
}

plain!(i32, f64, bool);

impl StateFormat for Str {
    /// In quotes, without blanks: other than plain characters, bytes are written as `%` and two hexadecimal digits.
    fn write(&self, out: &mut String) {
        out.push('"');
        for byte in self.as_bytes() {
            if byte.is_ascii_alphanumeric() || b"_-.,:;/+*()".contains(byte) {
                out.push(char::from(*byte));
            } else {
                let _ = write!(out, "%{byte:02x}");
            }
        }
        out.push_str("\" ");
    }

    fn read(words: &mut Words<'_>) -> Option<Self> {
        let mut text = Str::new();
        let mut bytes = words.next()?.strip_prefix('"')?.strip_suffix('"')?.bytes();
        while let Some(byte) = bytes.next() {
            if byte == b'%' {
                let digits = [char::from(bytes.next()?), char::from(bytes.next()?)];
                text.push((digits[0].to_digit(16)? * 16 + digits[1].to_digit(16)?) as u8);
            } else {
                text.push(byte);
            }
        }
        Some(text)
    }
}

impl<T: StateFormat + Clone + Default, const N: usize, S: Store<T, N>> StateFormat for Array<T, N, S> {
    fn write(&self, out: &mut String) {
        for element in self.iter() {
            element.write(out);
            out.pop();
            out.push('\n');
        }
    }

    fn read(words: &mut Words<'_>) -> Option<Self> {
        let mut array = Self::start();
        for element in array.iter_mut() {
            *element = T::read(words)?;
        }
        words.next().is_none().then_some(array)
    }
}

macro_rules! structures {
    ($($ty:ident { $($field:ident)* })*) => { $(
        impl StateFormat for $ty {
            fn write(&self, out: &mut String) {
                $( self.$field.write(out); )*
            }

            fn read(words: &mut Words<'_>) -> Option<Self> {
                Some(Self { $($field: StateFormat::read(words)?,)* })
            }
        }
    )* };
}

structures! {
    Frame { x y z a b c }
    Pose { x y z a b c cfg turn ej1 ej2 ej3 ej4 ej5 ej6 }
    Joint { j1 j2 j3 j4 j5 j6 ej1 ej2 ej3 ej4 ej5 ej6 }
    Tool { t_frame stationary }
    Wobj { w_frame robhold mu_name }
    CentroidPos { x y z }
    InertiaTensor { ixx ixy ixz iyy iyz izz }
    ToolInertiaPara { m centroidpos inertiatensor }
}
