//! What is known about a function with `goto` while it becomes a machine: its states, and which of them its variables
//! belong to.

use super::tokens::{each_word, mentions};
use crate::effects::visibility::Visibility;
use crate::hir::{LabelId, LocalId};
use proc_macro2::{Ident, TokenStream};
use std::collections::{HashMap, HashSet};

/// What is known about the machine while its states are emitted.
pub(super) struct Machine {
    pub(super) variable: Ident,
    pub(super) label: syn::Lifetime,
    pub(super) states: Vec<MachineState>,
    /// The names of the states.
    pub(super) named: HashSet<String>,
    pub(super) of_label: HashMap<LabelId, usize>,
    /// The locals that are visible at labels and jumps.
    pub(super) visibility: Visibility,
    pub(super) hoisted: HashSet<LocalId>,
    /// The states that contain the declarations of locals.
    pub(super) declared_in: HashMap<LocalId, usize>,
    /// Whether this run only determines which states mention which variables.
    pub(super) trial: bool,
    /// The state to which code is being added.
    pub(super) current: usize,
    /// Whether control can reach its end.
    pub(super) open: bool,
}

#[derive(Debug)]
/// A state of the machine.
pub(super) struct MachineState {
    pub(super) name: Ident,
    pub(super) code: TokenStream,
}

impl Machine {
    /// Whether a variable is mentioned in a state other than that of its declaration.
    pub(super) fn is_shared(&self, id: LocalId, name: &Ident) -> bool {
        let (name, home) = (name.to_string(), self.declared_in.get(&id));
        self.states.iter().enumerate().any(|(at, state)| Some(&at) != home && mentions(&state.code, &name))
    }

    /// The states that can be reached from the first one.
    pub(super) fn reached(&self) -> Vec<bool> {
        let names: HashMap<String, usize> =
            self.states.iter().enumerate().map(|(at, state)| (state.name.to_string(), at)).collect();
        let mut reached = vec![false; self.states.len()];
        let mut open = vec![0];
        while let Some(at) = open.pop() {
            let (Some(seen), Some(state)) = (reached.get_mut(at), self.states.get(at)) else { continue };
            if !std::mem::replace(seen, true) {
                each_word(&state.code, &mut |word| open.extend(names.get(&word.to_string())));
            }
        }
        reached
    }
}
