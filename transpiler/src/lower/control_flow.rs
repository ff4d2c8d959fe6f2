//! The loops and labels around the statements being lowered.

use crate::effects::visibility::Visibility;
use crate::hir::{LabelId, LocalId};
use arl_code::Address;
use std::collections::HashMap;

/// A loop around the statements being lowered.
#[derive(Default, Debug)]
pub(super) struct OpenLoop {
    /// The jumps that leave it.
    pub(super) breaks: Vec<Address>,
    /// The jumps to its next round.
    pub(super) continues: Vec<Address>,
}

/// The surroundings of the statements being lowered.
#[derive(Default, Debug)]
pub(super) struct Surroundings {
    /// The loops, the innermost last.
    pub(super) loops: Vec<OpenLoop>,
    /// Whether the innermost loop that counts rounds counts alone.
    pub(super) counts_alone: bool,
    /// Where the labels are.
    pub(super) labels: HashMap<LabelId, Address>,
    /// The jumps to labels that come later.
    pub(super) gotos: Vec<(LabelId, Address)>,
    /// The local variables that are visible at labels and jumps.
    pub(super) visibility: Visibility,
    /// The local variables that are visible here: a debugger sees each until its block ends.
    pub(super) visible: Vec<LocalId>,
}
