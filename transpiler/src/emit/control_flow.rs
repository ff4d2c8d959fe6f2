//! Control flow: the loops, parts and states around the statements being emitted.

use super::machine::Machine;
use super::parts::{Frame, Weights};
use proc_macro2::{Ident, TokenStream};

/// A loop around the statements being emitted.
#[derive(Clone, Debug)]
pub(super) struct Loop {
    /// How `break` is written.
    pub(super) on_break: Exit,
    /// How `continue` is written.
    pub(super) on_continue: Exit,
}

/// An exit from a loop body.
#[derive(Clone, Debug)]
pub(super) enum Exit {
    /// `break` or `continue` without a label.
    Plain,
    /// `continue 'label`, `break 'label`.
    Labelled(TokenStream),
    /// A jump to a state of the function's machine.
    State(usize),
}

/// Whether a block ends the function, so that its last statement gives the result.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Tail {
    /// The code after the block runs afterwards.
    Inner,
    /// No code follows the block.
    Function,
}

/// The surroundings of the statements being emitted.
#[derive(Default)]
pub(super) struct ControlFlow {
    /// The loops, the innermost last.
    pub(super) loops: Vec<Loop>,
    /// The counter for the rounds of the innermost loop, if they are not counted in the context.
    pub(super) counter: Option<Ident>,
    /// The states of a function with `goto`.
    pub(super) machine: Option<Machine>,
    /// The parts, the innermost last.
    pub(super) parts: Vec<Frame>,
    /// The number of `.await`s in the statements.
    pub(super) weights: Weights,
    labels: usize,
}

impl ControlFlow {
    /// A number for labels that no other loop of the function uses.
    pub(super) fn label_number(&mut self) -> usize {
        self.labels += 1;
        self.labels
    }
}

/// `'round`, `'round2`
pub(super) fn label(name: &str, number: usize) -> syn::Lifetime {
    let text = if number == 1 { format!("'{name}") } else { format!("'{name}{number}") };
    syn::Lifetime::new(&text, proc_macro2::Span::call_site())
}
