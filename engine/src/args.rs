//! The arguments of a built-in.

use crate::handles::{Handle, damaged};
use crate::reach::Reach;
use crate::types::with_type;
use crate::values::{Source, Target, Value};
use arl_code::{Arg, Extent, Place, Site, ValueType};
use arl_lang::catalog::Base;
use arl_rt::emit::text::{Nested, Print, Style, Typed, nested};
use arl_rt::emit::{Fault, Rc, Str};
use std::borrow::Cow;

/// A `jump` that waits above its target.
pub(crate) type Above = arl_rt::emit::motion::Above;

/// The arguments of a use of a built-in, by their number in the program.
pub(crate) struct Args<'a> {
    pub(crate) reach: Reach<'a>,
    pub(crate) site: &'a Site,
}

impl<'a> Args<'a> {
    fn arg(&self, number: usize) -> Result<&'a Arg, Fault> {
        self.site.args.get(number).ok_or_else(damaged)
    }

    fn place(&self, number: usize) -> Result<&'a Place, Fault> {
        Ok(&self.arg(number)?.place)
    }

    fn ty(&self, number: usize) -> Result<&'a ValueType, Fault> {
        let number = usize::from(self.arg(number)?.ty);
        self.reach.engine.code.types.get(number).ok_or_else(damaged)
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.site.args.len()
    }

    /// The parameter of an argument.
    pub(crate) fn param(&self, number: usize) -> u8 {
        self.site.args.get(number).map_or(u8::MAX, |arg| arg.param)
    }

    /// The type of an argument, without its sizes.
    pub(crate) fn base(&self, number: usize) -> Result<Base, Fault> {
        Ok(self.ty(number)?.base)
    }

    /// The argument for a parameter.
    #[inline]
    pub(crate) fn find(&self, param: u8) -> Option<usize> {
        let at = usize::from(param);
        match self.site.args.get(at) {
            Some(arg) if arg.param == param => Some(at),
            _ => self.site.args.iter().position(|arg| arg.param == param),
        }
    }

    /// The argument for a parameter that is always given.
    ///
    /// # Errors
    /// There is none: the code is damaged.
    #[inline]
    pub(crate) fn at(&self, param: u8) -> Result<usize, Fault> {
        self.find(param).ok_or_else(damaged)
    }

    /// A value.
    ///
    /// # Errors
    /// The place does not exist: the code is damaged.
    #[inline]
    pub(crate) fn get<T: Value>(&self, number: usize) -> Result<T, Fault> {
        self.reach.value(self.place(number)?)
    }

    /// The elements of an array.
    ///
    /// # Errors
    /// The place does not exist: the code is damaged.
    pub(crate) fn array<T: Value>(&self, number: usize) -> Result<Vec<T>, Fault> {
        let (place, ty) = (self.place(number)?, self.ty(number)?);
        elements(&self.reach, place, ty)
    }

    /// A string.
    ///
    /// # Errors
    /// The place does not exist: the code is damaged.
    pub(crate) fn text(&self, number: usize) -> Result<Cow<'_, Str>, Fault> {
        self.reach.text(self.place(number)?)
    }

    /// A clock or a connection.
    ///
    /// # Errors
    /// There is none: the code is damaged.
    pub(crate) fn handle(&self, number: usize) -> Result<Rc<Handle>, Fault> {
        self.reach.handle(self.place(number)?)
    }

    /// A value of any type, to be printed.
    pub(crate) fn printed(&self, number: usize) -> Printed<'_, 'a> {
        Printed { args: self, number }
    }

    /// Writes the variable that an argument is.
    ///
    /// # Errors
    /// A system variable does not take the value.
    pub(crate) fn put<T: Value>(&mut self, number: usize, value: &T) -> Result<(), Fault> {
        let place = self.place(number)?;
        self.reach.set_value(place, value)
    }

    /// Writes the array that an argument is.
    ///
    /// # Errors
    /// A system variable does not take the value.
    pub(crate) fn put_array<T: Value>(&mut self, number: usize, values: &[T]) -> Result<(), Fault> {
        let place = self.place(number)?;
        let family = self.reach.engine.code.family;
        let one = Extent::of(T::BASE, family);
        if one.texts > 0 {
            let mut all = (0..).zip(values);
            return all.try_for_each(|(at, value)| self.reach.set_value(&place.after(one.times(at)), value));
        }
        let mut words = Vec::with_capacity(values.len() * one.words as usize);
        for value in values {
            let mut target = Target::new(family);
            value.store(&mut target);
            words.extend_from_slice(target.words());
        }
        self.reach.write_words(place, &words)
    }

    /// Gives the result.
    ///
    /// # Errors
    /// The place does not exist: the code is damaged.
    #[inline]
    pub(crate) fn result<T: Value>(&mut self, value: &T) -> Result<(), Fault> {
        let place = &self.site.result;
        self.reach.set_value(place, value)
    }
}

/// The elements of an array at a place.
fn elements<T: Value>(reach: &Reach<'_>, place: &Place, ty: &ValueType) -> Result<Vec<T>, Fault> {
    let family = reach.engine.code.family;
    let one = Extent::of(T::BASE, family);
    if one.texts > 0 {
        return (0..ty.count() as u32).map(|at| reach.value(&place.after(one.times(at)))).collect();
    }
    let mut words = vec![0; one.words as usize * ty.count()];
    reach.read_words(place, &mut words)?;
    let values = words.chunks(one.words.max(1) as usize);
    Ok(values.map(|words| T::load(&mut Source { words, texts: &[], family })).collect())
}

/// An argument of any type, to be printed.
pub(crate) struct Printed<'r, 'a> {
    args: &'r Args<'a>,
    number: usize,
}

impl Printed<'_, '_> {
    /// Shows the value to a function that prints any.
    fn show(&self, look: &mut dyn FnMut(&dyn Print)) -> Result<(), Fault> {
        let (place, ty) = (self.args.place(self.number)?, self.args.ty(self.number)?);
        let reach = &self.args.reach;
        with_type!(ty.base, reach.engine.code.family, T => show_as::<T>(reach, place, ty, look), otherwise Err(damaged()))
    }
}

fn show_as<T: Value + Print + Typed>(
    reach: &Reach<'_>,
    place: &Place,
    ty: &ValueType,
    look: &mut dyn FnMut(&dyn Print),
) -> Result<(), Fault> {
    if !ty.is_array() {
        look(&reach.value::<T>(place)?);
        return Ok(());
    }
    let elements: Vec<T> = elements(reach, place, ty)?;
    let whole: Nested<'_, T> = nested(&elements, &ty.sizes);
    look(&whole);
    Ok(())
}

impl Print for Printed<'_, '_> {
    fn print(&self, out: &mut Str, style: &Style) {
        // Damaged code is found before it runs.
        let _ = self.show(&mut |value| value.print(out, style));
    }

    fn type_name(&self) -> String {
        let mut name = String::new();
        let _ = self.show(&mut |value| name = value.type_name());
        name
    }
}
