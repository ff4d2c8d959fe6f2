//! The tables of constants and types, each entry once.

use super::Lowering;
use crate::hir::{Type, Value};
use arl_code::{Extent, Place, Space, ValueType, start_words};
use arl_lang::catalog::{Base, Entry, all_entries};
use std::collections::HashMap;

/// What is in the tables already.
#[derive(Default)]
pub(super) struct Tables {
    words: HashMap<u64, u32>,
    texts: HashMap<String, u32>,
    types: HashMap<Type, u16>,
    starts: HashMap<Base, u32>,
    entries: HashMap<usize, u16>,
}

impl Lowering<'_> {
    /// The position of a constant word.
    pub(super) fn word(&mut self, word: u64) -> u32 {
        *self.tables.words.entry(word).or_insert_with(|| {
            self.code.words.push(word);
            self.code.words.len() as u32 - 1
        })
    }

    /// The position of words that are constants together.
    pub(super) fn words(&mut self, words: &[u64]) -> u32 {
        self.code.words.extend_from_slice(words);
        (self.code.words.len() - words.len()) as u32
    }

    /// The position of a constant string.
    pub(super) fn text(&mut self, text: &str) -> u32 {
        if let Some(at) = self.tables.texts.get(text) {
            return *at;
        }
        let at = self.code.texts.len() as u32;
        self.code.texts.push(text.into());
        self.tables.texts.insert(text.to_owned(), at);
        at
    }

    /// The position of the words of a type's start value.
    pub(super) fn start_words(&mut self, base: Base) -> u32 {
        if let Some(at) = self.tables.starts.get(&base) {
            return *at;
        }
        let mut words = Vec::new();
        start_words(base, self.program.family, &mut words);
        let at = self.words(&words);
        self.tables.starts.insert(base, at);
        at
    }

    /// The number of a type.
    pub(super) fn type_number(&mut self, ty: Type) -> u16 {
        *self.tables.types.entry(ty).or_insert_with(|| {
            self.code.types.push(value_type(ty));
            u16::try_from(self.code.types.len() - 1).unwrap_or(u16::MAX)
        })
    }

    /// The number of an entry of the catalog.
    pub(super) fn entry_number(&mut self, entry: &'static Entry) -> u16 {
        if self.tables.entries.is_empty() {
            let all = all_entries().iter().enumerate();
            self.tables.entries = all.map(|(at, entry)| (std::ptr::from_ref(entry) as usize, at as u16)).collect();
        }
        let known = self.tables.entries.get(&(std::ptr::from_ref(entry) as usize)).copied();
        // Entries are constants, which may be at several addresses.
        let found = known.or_else(|| all_entries().iter().position(|other| other == entry).map(|at| at as u16));
        found.unwrap_or(u16::MAX)
    }
}

/// A constant as a word; a string is none.
pub(super) fn constant_word(value: &Value) -> Option<u64> {
    Some(match value {
        Value::Int(value) => u64::from(*value as u32),
        Value::Uint(value) => u64::from(*value),
        Value::Byte(value) => u64::from(*value),
        // As native code has it: of all numbers that are none, this one.
        Value::Double(value) if value.is_nan() => f64::NAN.to_bits(),
        Value::Double(value) => value.to_bits(),
        Value::Bool(value) => u64::from(*value),
        Value::Enum(_, at) => u64::from(*at),
        Value::String(_) => return None,
    })
}

pub(super) fn value_type(ty: Type) -> ValueType {
    ValueType { base: ty.base, sizes: ty.dims().iter().map(|size| usize::from(*size)).collect() }
}

/// A place among the constants.
pub(super) fn constant_place(word: u32, text: u32) -> Place {
    Place::start(Space::Constant).after(Extent { words: word, texts: text, handles: 0 })
}

/// The most numbers that an event takes along in registers.
pub(super) const MOST_CAPTURED: u8 = 64;
