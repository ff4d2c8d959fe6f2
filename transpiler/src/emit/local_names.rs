//! The names in a function's code: those of its variables and of temporaries.

use super::names::{Names, ident, is_taken_value};
use super::temporaries::Temporaries;
use crate::hir::{LocalId, ModuleId};
use proc_macro2::Ident;
use std::collections::HashSet;

/// The names inside one function.
#[derive(Default)]
pub(super) struct LocalNames {
    /// The names of its variables.
    locals: Vec<Ident>,
    /// The names that temporaries must not take.
    taken: HashSet<String>,
    /// The names of the temporaries of the current statement.
    temporaries: Temporaries,
}

impl LocalNames {
    /// The names of a function with these variables.
    pub(super) fn new(locals: Vec<Ident>) -> Self {
        let taken = locals.iter().map(Ident::to_string).collect();
        Self { locals, taken, temporaries: Temporaries::default() }
    }

    /// The name of a variable.
    pub(super) fn local(&self, id: LocalId) -> Ident {
        self.locals.get(id.0 as usize).cloned().unwrap_or_else(|| ident("unknown"))
    }

    /// A name for a temporary that is not used for anything else in reach.
    pub(super) fn fresh(&mut self, wanted: &str, names: &Names, module: ModuleId) -> Ident {
        let wanted = if is_taken_value(wanted) { "value" } else { wanted };
        let taken = &self.taken;
        let is_taken = |name: &str| taken.contains(name) || names.has_function(module, name);
        ident(&self.temporaries.give(wanted, is_taken))
    }

    /// A name that stays reserved for the whole function.
    pub(super) fn reserve(&mut self, wanted: &str, names: &Names, module: ModuleId) -> Ident {
        let name = self.fresh(wanted, names, module);
        self.temporaries.truncate(self.temporaries.len() - 1);
        self.taken.insert(name.to_string());
        name
    }

    /// Releases a name taken by [`Self::reserve`].
    pub(super) fn release(&mut self, name: &Ident) {
        self.taken.remove(&name.to_string());
    }

    /// The number of temporaries of the current statement.
    pub(super) fn temporaries(&self) -> usize {
        self.temporaries.len()
    }

    /// Releases all temporaries but the first `count`.
    pub(super) fn keep_temporaries(&mut self, count: usize) {
        self.temporaries.truncate(count);
    }

    /// Begins an inner statement, whose temporaries may have the same names as those of the outer one; returns the
    /// latter.
    pub(super) fn inner_statement(&mut self) -> Temporaries {
        std::mem::take(&mut self.temporaries)
    }

    /// Continues with the outer statement.
    pub(super) fn outer_statement(&mut self, temporaries: Temporaries) {
        self.temporaries = temporaries;
    }
}
