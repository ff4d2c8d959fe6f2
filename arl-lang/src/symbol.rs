//! Names, interned: ARL matches all names without regard to case, so a symbol stands for the folded name.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// An interned, case-folded name. Two names that differ in case only are the same symbol.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Symbol(u32);

impl Symbol {
    /// Its number: symbols count from 0 in the order in which they were interned.
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// All names of one compilation.
#[derive(Default, Debug)]
pub struct Interner {
    names: Vec<Box<str>>,
    symbols: HashMap<Box<str>, Symbol, BuildHasherDefault<NameHasher>>,
}

impl Interner {
    /// An empty set of names.
    pub fn new() -> Self {
        Self::default()
    }

    /// The symbol of `name`, whatever its case.
    pub fn intern(&mut self, name: &str) -> Symbol {
        if !name.bytes().any(|byte| byte.is_ascii_uppercase()) {
            return self.intern_folded(name);
        }
        let mut short = [0; 32];
        if let Some(place) = short.get_mut(..name.len()) {
            place.copy_from_slice(name.as_bytes());
            place.make_ascii_lowercase();
            if let Ok(folded) = std::str::from_utf8(place) {
                return self.intern_folded(folded);
            }
        }
        self.intern_folded(&name.to_ascii_lowercase())
    }

    fn intern_folded(&mut self, name: &str) -> Symbol {
        if let Some(symbol) = self.symbols.get(name) {
            return *symbol;
        }
        let symbol = Symbol(self.names.len() as u32);
        self.names.push(name.into());
        self.symbols.insert(name.into(), symbol);
        symbol
    }

    /// The symbol of `name` if it was interned before.
    pub fn find(&self, name: &str) -> Option<Symbol> {
        self.symbols.get(name.to_ascii_lowercase().as_str()).copied()
    }

    /// The folded (lower-case) name.
    pub fn name(&self, symbol: Symbol) -> &str {
        self.names.get(symbol.0 as usize).map_or("", |name| name)
    }

    /// All names with their symbols, in the order in which they were interned.
    pub fn iter(&self) -> impl Iterator<Item = (Symbol, &str)> {
        self.names.iter().enumerate().map(|(at, name)| (Symbol(at as u32), name.as_ref()))
    }
}

/// FNV-1a: names are short, and no outsider chooses them to collide.
#[derive(Debug)]
pub struct NameHasher(u64);

impl Default for NameHasher {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Hasher for NameHasher {
    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn finish(&self) -> u64 {
        self.0
    }
}
