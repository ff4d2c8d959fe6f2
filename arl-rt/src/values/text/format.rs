//! How values look when they are printed.

use super::number::{push_double, push_hex, push_int};
use crate::values::{Array, NumBase, Store, Str};

/// The number format that a `print` has chosen so far.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Style {
    /// The significant digits of doubles.
    pub precision: u32,
    /// The base of integers; `None` is decimal for `int` and `uint`, hexadecimal for `byte`.
    pub base: Option<NumBase>,
}

impl Style {
    /// Six digits, no base chosen.
    pub const START: Style = Style { precision: 6, base: None };
}

impl Default for Style {
    fn default() -> Self {
        Self::START
    }
}

/// A type with a name: all but arrays.
pub trait Typed {
    /// The name in the manual's spelling, as `typeof` gives it.
    const NAME: &'static str;
}

/// Values that can be printed: everything that `print`, `tostr` and `typeof` take.
pub trait Print {
    /// Appends the value as text.
    fn print(&self, out: &mut Str, style: &Style);

    /// The type's name in the manual's spelling; arrays with their sizes: `int[3]`.
    fn type_name(&self) -> String;

    /// The value as a new text.
    fn printed(&self, style: &Style) -> Str {
        let mut out = Str::new();
        self.print(&mut out, style);
        out
    }
}

macro_rules! prints {
    ($($ty:ty, $name:literal: |$value:ident, $out:ident, $style:ident| $how:expr;)*) => { $(
        impl Typed for $ty {
            const NAME: &'static str = $name;
        }

        impl Print for $ty {
            fn print(&self, $out: &mut Str, $style: &Style) {
                let $value = self;
                $how
            }

            fn type_name(&self) -> String {
                $name.to_owned()
            }
        }
    )* };
}

prints! {
    i32, "int": |value, out, style| match style.base {
        Some(NumBase::Hex) => push_hex(out, *value as u32, 1),
        _ => push_int(out, i64::from(*value)),
    };
    u32, "uint": |value, out, style| match style.base {
        Some(NumBase::Hex) => push_hex(out, *value, 1),
        _ => push_int(out, i64::from(*value)),
    };
    u8, "byte": |value, out, style| match style.base {
        Some(NumBase::Dec) => push_int(out, i64::from(*value)),
        _ => {
            push_hex(out, u32::from(*value), 2);
            out.push(b'h');
        }
    };
    f64, "double": |value, out, style| push_double(out, *value, style.precision);
    bool, "bool": |value, out, _style| out.push_str(if *value { "true" } else { "false" });
    Str, "string": |value, out, _style| out.push_bytes(value.as_bytes());
    str, "string": |value, out, _style| out.push_str(value);
}

impl<P: Print + ?Sized> Print for &P {
    fn print(&self, out: &mut Str, style: &Style) {
        (**self).print(out, style);
    }

    fn type_name(&self) -> String {
        (**self).type_name()
    }
}

impl<T: Print + Typed> Print for [T] {
    fn print(&self, out: &mut Str, style: &Style) {
        print_between_braces(self.iter(), out, style);
    }

    fn type_name(&self) -> String {
        format!("{}[{}]", T::NAME, self.len())
    }
}

impl<T: Print + Typed, const N: usize> Print for [T; N] {
    fn print(&self, out: &mut Str, style: &Style) {
        self.as_slice().print(out, style);
    }

    fn type_name(&self) -> String {
        self.as_slice().type_name()
    }
}

impl<T: Print + Typed, const N: usize, S: Store<T, N>> Print for Array<T, N, S> {
    fn print(&self, out: &mut Str, style: &Style) {
        (**self).print(out, style);
    }

    fn type_name(&self) -> String {
        (**self).type_name()
    }
}

/// An array of several dimensions, for printing: braces around each row.
#[derive(Clone, Copy, Debug)]
pub struct Nested<'a, T> {
    elements: &'a [T],
    sizes: &'a [usize],
}

/// Gives flat elements the sizes of their dimensions, outermost first.
pub fn nested<'a, T>(elements: &'a [T], sizes: &'a [usize]) -> Nested<'a, T> {
    Nested { elements, sizes }
}

impl<T: Print + Typed> Print for Nested<'_, T> {
    fn print(&self, out: &mut Str, style: &Style) {
        match self.sizes {
            [_, inner @ ..] if !inner.is_empty() => {
                let row = inner.iter().product::<usize>().max(1);
                let rows = self.elements.chunks(row).map(|elements| Nested { elements, sizes: inner });
                print_between_braces(rows, out, style);
            }
            _ => self.elements.print(out, style),
        }
    }

    fn type_name(&self) -> String {
        let sizes: String = self.sizes.iter().map(|size| format!("[{size}]")).collect();
        format!("{}{sizes}", T::NAME)
    }
}

fn print_between_braces<P: Print>(parts: impl Iterator<Item = P>, out: &mut Str, style: &Style) {
    out.push(b'{');
    for (at, part) in parts.enumerate() {
        if at > 0 {
            out.push(b',');
        }
        part.print(out, style);
    }
    out.push(b'}');
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(value: &dyn Print) -> String {
        value.printed(&Style::START).to_string()
    }

    fn shown_in(base: NumBase, value: &dyn Print) -> String {
        value.printed(&Style { base: Some(base), ..Style::START }).to_string()
    }

    #[test]
    fn scalars() {
        assert_eq!(shown(&-12), "-12");
        assert_eq!(shown(&4_000_000_000_u32), "4000000000");
        assert_eq!(shown(&11_u8), "0bh");
        assert_eq!(shown(&0xc0_u8), "c0h");
        assert_eq!(shown(&true), "true");
        assert_eq!(shown(&Str::from("a b")), "a b");
        assert_eq!(shown(&"lit"), "lit");
        assert_eq!(shown(&0.1), "0.1");
    }

    #[test]
    fn bases() {
        assert_eq!(shown_in(NumBase::Hex, &255), "ff");
        assert_eq!(shown_in(NumBase::Hex, &-2), "fffffffe");
        assert_eq!(shown_in(NumBase::Hex, &0x0403_0201), "4030201");
        assert_eq!(shown_in(NumBase::Hex, &0xfff_u32), "fff");
        assert_eq!(shown_in(NumBase::Hex, &[1_u8, 2, 3, 4]), "{01h,02h,03h,04h}");
        assert_eq!(shown_in(NumBase::Dec, &255), "255");
        assert_eq!(shown_in(NumBase::Dec, &[11_u8, 200]), "{11,200}");
        assert_eq!(shown_in(NumBase::Hex, &255.0), "255", "doubles have no base");
    }

    #[test]
    fn arrays() {
        let flat: Array<i32, 6> = [1, 2, 3, 4, 5, 6].into();
        assert_eq!(shown(&flat), "{1,2,3,4,5,6}");
        assert_eq!(shown(&nested(&flat, &[2, 3])), "{{1,2,3},{4,5,6}}");
        assert_eq!(shown(&nested(&flat, &[1, 3, 2])), "{{{1,2},{3,4},{5,6}}}");
        assert_eq!(shown(&nested(&flat, &[6])), "{1,2,3,4,5,6}");
        assert_eq!(shown(&[Str::from("a"), Str::from("b c")]), "{a,b c}");
        assert_eq!(shown(&flat.get(..2).unwrap()), "{1,2}");
    }

    #[test]
    fn names_of_types() {
        let flat: Array<i32, 6> = [1, 2, 3, 4, 5, 6].into();
        assert_eq!(Print::type_name(&flat), "int[6]");
        assert_eq!(nested(&flat, &[2, 3]).type_name(), "int[2][3]");
        assert_eq!([0_u8; 3].type_name(), "byte[3]");
        for (value, name) in
            [(&1 as &dyn Print, "int"), (&1_u32, "uint"), (&1.0, "double"), (&true, "bool"), (&"", "string")]
        {
            assert_eq!(value.type_name(), name);
        }
    }
}
