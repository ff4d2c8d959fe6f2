//! Variables by name: they take literals of data files, of the command line and of debuggers.

use crate::types::with_type;
use crate::values::{MOST_WORDS, Source, Target, Value};
use arl_code::{ConstantValue, Extent, Place, ValueType};
use arl_lang::ast::Expr;
use arl_lang::catalog::Family;
use arl_lang::symbol::Interner;
use arl_rt::emit::text::{Print, Typed, nested};
use arl_rt::emit::{Cell, Fixed, Literal, Onto, Rc, Str, Teach, TeachError, put_array, write_array};
use std::cell::RefCell;

/// A variable that takes literals: a global one, or a local one that a debugger sees.
pub(crate) struct Variable {
    pub(crate) words: Rc<[Cell<u64>]>,
    pub(crate) texts: Rc<[RefCell<Str>]>,
    pub(crate) place: Place,
    pub(crate) ty: ValueType,
    pub(crate) family: Family,
}

impl Variable {
    fn element<T: Value>(&self, number: usize) -> T {
        let one = Extent::of(T::BASE, self.family);
        let place = self.place.after(one.times(number as u32));
        let mut words = [0; MOST_WORDS];
        let cells = self.words.iter().skip(place.word as usize).take(one.words as usize);
        words.iter_mut().zip(cells).for_each(|(word, cell)| *word = cell.get());
        let texts = self.texts.iter().skip(place.text as usize).take(one.texts as usize);
        let texts: Vec<Str> = texts.map(|text| text.borrow().clone()).collect();
        let words = words.get(..one.words as usize).unwrap_or_default();
        T::load(&mut Source { words, texts: &texts, family: self.family })
    }

    fn set_element<T: Value>(&self, number: usize, value: &T) {
        let one = Extent::of(T::BASE, self.family);
        let place = self.place.after(one.times(number as u32));
        let mut target = Target::new(self.family);
        value.store(&mut target);
        let cells = self.words.iter().skip(place.word as usize);
        cells.zip(target.words()).for_each(|(cell, word)| cell.set(*word));
        if let (Some(text), Some(variable)) = (target.text.take(), self.texts.get(place.text as usize)) {
            variable.replace(text);
        }
    }

    fn elements<T: Value>(&self) -> Vec<T> {
        (0..self.ty.count()).map(|number| self.element(number)).collect()
    }

    fn put<T: Value + Literal + Typed + Default + Clone>(
        &self,
        onto: Onto,
        value: &Expr,
        sizes: &[usize],
        names: &Interner,
    ) -> Result<(), TeachError> {
        let mut elements = match onto {
            Onto::Start => vec![T::default(); self.ty.count()],
            Onto::Value => self.elements::<T>(),
        };
        if self.ty.is_array() {
            put_array(&mut elements, sizes, value, names)?;
        } else if let [element] = elements.as_mut_slice() {
            element.put_nested(value, sizes, names)?;
        }
        elements.iter().enumerate().for_each(|(number, element)| self.set_element(number, element));
        Ok(())
    }

    fn start<T: Value + Default>(&self) {
        (0..self.ty.count()).for_each(|number| self.set_element(number, &T::default()));
    }

    fn write<T: Value + Literal>(&self, out: &mut String) {
        match self.ty.is_array() {
            true => write_array(&self.elements::<T>(), out),
            false => self.element::<T>(0).write(out),
        }
    }

    fn name_of<T: Value + Print + Typed + Default + Clone>(&self) -> String {
        match self.ty.is_array() {
            // As it is for arrays of compiled programs, which are flat.
            true => nested(&vec![T::default(); self.ty.count()], &[self.ty.count()]).type_name(),
            false => T::default().type_name(),
        }
    }
}

impl Teach for Variable {
    fn teach_onto(&self, onto: Onto, value: &Expr, sizes: &[usize], names: &Interner) -> Result<(), TeachError> {
        with_type!(self.ty.base, self.family, T => self.put::<T>(onto, value, sizes, names), otherwise Ok(()))
    }

    fn restart(&self) -> Result<(), TeachError> {
        with_type!(self.ty.base, self.family, T => self.start::<T>(), otherwise ());
        Ok(())
    }

    fn type_name(&self) -> String {
        with_type!(self.ty.base, self.family, T => self.name_of::<T>(), otherwise String::new())
    }

    fn written(&self) -> String {
        let mut out = String::new();
        with_type!(self.ty.base, self.family, T => self.write::<T>(&mut out), otherwise ());
        out
    }
}

/// A constant, which keeps the value that the program was lowered with.
pub(crate) fn constant(value: &ConstantValue, ty: &ValueType, family: Family) -> Box<dyn Teach> {
    fn fixed<T: Value + Literal + Default + PartialEq + 'static>(
        word: u64,
        texts: &[Str],
        family: Family,
    ) -> Box<dyn Teach> {
        Box::new(Fixed(T::load(&mut Source { words: &[word], texts, family })))
    }
    let (word, text) = match value {
        ConstantValue::Word(word) => (*word, Str::new()),
        ConstantValue::Text(text) => (0, Str::from(text.as_bytes())),
    };
    with_type!(ty.base, family, T => fixed::<T>(word, &[text], family), otherwise Box::new(Fixed(0)))
}
