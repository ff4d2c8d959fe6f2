//! What a function can reach: its frame, the global and the system variables, the constants.

use crate::engine::Engine;
use crate::frame::{Boxed, REGISTERS};
use crate::handles::{Handle, damaged};
use crate::system;
use crate::values::{Source, Target, Value};
use arl_code::{Extent, Place, Space};
use arl_lang::catalog::{Base, SystemVariable, Takes, system_variables};
use arl_rt::emit::{Cell, Cx, Fault, Rc, Str, in_range};
use std::borrow::Cow;
use std::sync::OnceLock;

/// What a function can reach while it runs.
pub(crate) struct Reach<'a> {
    pub(crate) engine: &'a Engine,
    pub(crate) cx: &'a Cx,
    pub(crate) registers: &'a mut [u64; REGISTERS],
    pub(crate) words: &'a mut [u64],
    pub(crate) texts: &'a mut [Str],
    pub(crate) handles: &'a mut [Option<Rc<Handle>>],
    pub(crate) boxes: &'a [Option<Rc<Boxed>>],
}

/// The element of an array that is part of a system variable, and the rest of a place in it.
struct InSystem {
    variable: u16,
    element: usize,
    rest: Extent,
}

impl Reach<'_> {
    /// The number of an element.
    fn element(&self, place: &Place) -> (usize, Extent) {
        match place.element {
            Some((register, one)) => (self.registers[usize::from(register)] as u32 as usize, one),
            None => (0, Extent::default()),
        }
    }

    fn word_at(&self, place: &Place) -> usize {
        let (element, one) = self.element(place);
        place.word as usize + element * one.words as usize
    }

    fn text_at(&self, place: &Place) -> usize {
        let (element, one) = self.element(place);
        place.text as usize + element * one.texts as usize
    }

    fn handle_at(&self, place: &Place) -> usize {
        let (element, one) = self.element(place);
        place.handle as usize + element * one.handles as usize
    }

    fn boxed(&self, number: u16) -> Result<&Rc<Boxed>, Fault> {
        self.boxes.get(usize::from(number)).and_then(Option::as_ref).ok_or_else(damaged)
    }

    /// Copies the words of a place.
    ///
    /// # Errors
    /// The place does not exist: the code is damaged.
    #[inline]
    pub(crate) fn read_words(&self, place: &Place, out: &mut [u64]) -> Result<(), Fault> {
        if let (Space::Register(register), [word]) = (place.space, &mut *out) {
            *word = self.registers[usize::from(register)];
            return Ok(());
        }
        let at = self.word_at(place);
        let range = at..at + out.len();
        match place.space {
            Space::Frame => out.copy_from_slice(self.words.get(range).ok_or_else(damaged)?),
            Space::Constant => out.copy_from_slice(self.engine.code.words.get(range).ok_or_else(damaged)?),
            Space::Global => read_cells(self.engine.words.get(range).ok_or_else(damaged)?, out),
            Space::Boxed(number) => read_cells(self.boxed(number)?.words.get(range).ok_or_else(damaged)?, out),
            Space::System(number) => self.read_system(number, place, out)?,
            Space::Register(_) | Space::Nowhere => return Err(damaged()),
        }
        Ok(())
    }

    /// Writes the words of a place.
    ///
    /// # Errors
    /// A system variable does not take the value, or the place does not exist.
    #[inline]
    pub(crate) fn write_words(&mut self, place: &Place, words: &[u64]) -> Result<(), Fault> {
        if let (Space::Register(register), [word]) = (place.space, words) {
            self.registers[usize::from(register)] = *word;
            return Ok(());
        }
        let at = self.word_at(place);
        let range = at..at + words.len();
        match place.space {
            Space::Frame => self.words.get_mut(range).ok_or_else(damaged)?.copy_from_slice(words),
            Space::Global => write_cells(self.engine.words.get(range).ok_or_else(damaged)?, words),
            Space::Boxed(number) => write_cells(self.boxed(number)?.words.get(range).ok_or_else(damaged)?, words),
            Space::System(number) => self.write_system(number, place, words)?,
            Space::Nowhere => {}
            Space::Register(_) | Space::Constant => return Err(damaged()),
        }
        Ok(())
    }

    /// The string of a place.
    ///
    /// # Errors
    /// The place does not exist: the code is damaged.
    pub(crate) fn text(&self, place: &Place) -> Result<Cow<'_, Str>, Fault> {
        let at = self.text_at(place);
        Ok(match place.space {
            Space::Frame => Cow::Borrowed(self.texts.get(at).ok_or_else(damaged)?),
            Space::Constant => Cow::Borrowed(self.engine.constants.get(at).ok_or_else(damaged)?),
            Space::Global => Cow::Owned(self.engine.texts.get(at).ok_or_else(damaged)?.borrow().clone()),
            Space::Boxed(number) => Cow::Owned(self.boxed(number)?.texts.get(at).ok_or_else(damaged)?.borrow().clone()),
            Space::System(number) => {
                let place = self.text_in_system(number, place);
                let mut value = self.system_value(&place)?;
                Cow::Owned(value.text.take().unwrap_or_default())
            }
            Space::Register(_) | Space::Nowhere => return Err(damaged()),
        })
    }

    /// Writes the string of a place.
    ///
    /// # Errors
    /// A system variable does not take the text, or the place does not exist.
    pub(crate) fn write_text(&mut self, place: &Place, text: Str) -> Result<(), Fault> {
        let at = self.text_at(place);
        match place.space {
            Space::Frame => *self.texts.get_mut(at).ok_or_else(damaged)? = text,
            Space::Global => drop(self.engine.texts.get(at).ok_or_else(damaged)?.replace(text)),
            Space::Boxed(number) => {
                drop(self.boxed(number)?.texts.get(at).ok_or_else(damaged)?.replace(text));
            }
            Space::System(number) => {
                let place = self.text_in_system(number, place);
                let value = self.system_value(&place)?;
                let family = self.engine.code.family;
                let mut from = Source { words: value.words(), texts: &[text], family };
                system::set(self.cx, place.variable, place.element, &mut from)?;
            }
            Space::Nowhere => {}
            Space::Register(_) | Space::Constant => return Err(damaged()),
        }
        Ok(())
    }

    /// The clock or connection of a place.
    ///
    /// # Errors
    /// There is none: the code is damaged.
    pub(crate) fn handle(&self, place: &Place) -> Result<Rc<Handle>, Fault> {
        let at = self.handle_at(place);
        match place.space {
            Space::Frame => self.handles.get(at).and_then(Clone::clone),
            Space::Global => self.engine.handles.get(at).cloned(),
            _ => None,
        }
        .ok_or_else(damaged)
    }

    /// Copies a value from place to place.
    ///
    /// # Errors
    /// A system variable does not take the value, or a place does not exist.
    pub(crate) fn transfer(
        &mut self,
        from: &Place,
        to: &Place,
        extent: Extent,
        passing: &mut Vec<u64>,
    ) -> Result<(), Fault> {
        if extent.words > 0 {
            passing.clear();
            passing.resize(extent.words as usize, 0);
            self.read_words(from, passing)?;
            self.write_words(to, passing)?;
        }
        for number in 0..extent.texts {
            let step = Extent { texts: number, ..Extent::default() };
            let text = self.text(&from.after(step))?.into_owned();
            self.write_text(&to.after(step), text)?;
        }
        for number in 0..extent.handles {
            let step = Extent { handles: number, ..Extent::default() };
            let handle = self.handle(&from.after(step))?;
            let at = self.handle_at(&to.after(step));
            *self.handles.get_mut(at).ok_or_else(damaged)? = Some(handle);
        }
        Ok(())
    }

    /// A value of a place.
    ///
    /// # Errors
    /// The place does not exist: the code is damaged.
    #[inline]
    pub(crate) fn value<T: Value>(&self, place: &Place) -> Result<T, Fault> {
        let family = self.engine.code.family;
        let extent = Extent::of(T::BASE, family);
        let mut words = [0; crate::values::MOST_WORDS];
        let words = words.get_mut(..extent.words as usize).ok_or_else(damaged)?;
        self.read_words(place, words)?;
        if extent.texts == 0 {
            return Ok(T::load(&mut Source { words, texts: &[], family }));
        }
        let text = [self.text(place)?.into_owned()];
        Ok(T::load(&mut Source { words, texts: &text, family }))
    }

    /// Writes a value to a place.
    ///
    /// # Errors
    /// A system variable does not take the value, or the place does not exist.
    #[inline]
    pub(crate) fn set_value<T: Value>(&mut self, place: &Place, value: &T) -> Result<(), Fault> {
        if place.space == Space::Nowhere {
            return Ok(());
        }
        let mut target = Target::new(self.engine.code.family);
        value.store(&mut target);
        if !target.words().is_empty() {
            self.write_words(place, target.words())?;
        }
        match target.text.take() {
            Some(text) => self.write_text(place, text),
            None => Ok(()),
        }
    }

    // System variables.

    /// The element of a system variable that has the words of a place.
    fn words_in_system(&self, variable: u16, place: &Place) -> InSystem {
        let one = self.extent_in_system(variable).words.max(1) as usize;
        let at = self.word_at(place);
        let rest = Extent { words: (at % one) as u32, ..Extent::default() };
        InSystem { variable, element: at / one, rest }
    }

    /// The element of a system variable that has the string of a place.
    fn text_in_system(&self, variable: u16, place: &Place) -> InSystem {
        let one = self.extent_in_system(variable).texts.max(1) as usize;
        InSystem { variable, element: self.text_at(place) / one, rest: Extent::default() }
    }

    fn extent_in_system(&self, variable: u16) -> Extent {
        let family = self.engine.code.family;
        definition(variable).map_or(Extent::default(), |variable| Extent::of(variable.ty, family))
    }

    fn system_value(&self, place: &InSystem) -> Result<Target, Fault> {
        let mut value = Target::new(self.engine.code.family);
        system::get(self.cx, place.variable, place.element, &mut value)?;
        Ok(value)
    }

    fn read_system(&self, number: u16, place: &Place, out: &mut [u64]) -> Result<(), Fault> {
        let mut place = self.words_in_system(number, place);
        let mut done = 0;
        while done < out.len() {
            let value = self.system_value(&place)?;
            let words = value.words().get(place.rest.words as usize..).ok_or_else(damaged)?;
            let count = words.len().min(out.len() - done);
            let (from, to) = (words.get(..count), out.get_mut(done..done + count));
            to.zip(from).into_iter().for_each(|(to, from)| to.copy_from_slice(from));
            if count == 0 {
                return Err(damaged());
            }
            done += count;
            (place.element, place.rest) = (place.element + 1, Extent::default());
        }
        Ok(())
    }

    fn write_system(&mut self, number: u16, place: &Place, words: &[u64]) -> Result<(), Fault> {
        let mut place = self.words_in_system(number, place);
        let family = self.engine.code.family;
        // All or none: the whole value is looked at before the first element is written.
        check_range(number, words)?;
        let mut done = 0;
        while done < words.len() {
            let value = self.system_value(&place)?;
            let text: Vec<Str> = value.text.iter().cloned().collect();
            let mut all = [0; crate::values::MOST_WORDS];
            let length = value.words().len();
            let all = all.get_mut(..length).ok_or_else(damaged)?;
            all.copy_from_slice(value.words());
            let changed = all.get_mut(place.rest.words as usize..).ok_or_else(damaged)?;
            let count = changed.len().min(words.len() - done);
            let (from, to) = (words.get(done..done + count), changed.get_mut(..count));
            to.zip(from).into_iter().for_each(|(to, from)| to.copy_from_slice(from));
            if count == 0 {
                return Err(damaged());
            }
            system::set(self.cx, place.variable, place.element, &mut Source { words: all, texts: &text, family })?;
            done += count;
            (place.element, place.rest) = (place.element + 1, Extent::default());
        }
        Ok(())
    }
}

/// The system variable with this number.
fn definition(number: u16) -> Option<&'static SystemVariable> {
    static ALL: OnceLock<Vec<&'static SystemVariable>> = OnceLock::new();
    ALL.get_or_init(|| system_variables().collect()).get(usize::from(number)).copied()
}

/// Whether a system variable takes these numbers.
fn check_range(number: u16, words: &[u64]) -> Result<(), Fault> {
    let Some(variable) = definition(number) else { return Err(damaged()) };
    let Takes::Range(low, high) = variable.takes else { return Ok(()) };
    words.iter().try_for_each(|word| match variable.ty {
        Base::Int => in_range(*word as u32 as i32, low, high).map(drop),
        Base::Uint => in_range(*word as u32, low, high).map(drop),
        Base::Byte => in_range(*word as u8, low, high).map(drop),
        Base::Double => in_range(f64::from_bits(*word), low, high).map(drop),
        _ => Ok(()),
    })
}

fn read_cells(cells: &[Cell<u64>], out: &mut [u64]) {
    for (word, cell) in out.iter_mut().zip(cells) {
        *word = cell.get();
    }
}

fn write_cells(cells: &[Cell<u64>], words: &[u64]) {
    for (cell, word) in cells.iter().zip(words) {
        cell.set(*word);
    }
}
