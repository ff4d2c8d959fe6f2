//! The inputs with which a PLC works the controller like somebody at the pendant.

use super::watch::Watch;
use crate::io::{Image, Pendant};
use crate::system::System;

/// The buttons that are pressed in a cycle, in the order in which they act.
pub(in crate::controller) type Pressed = [Option<Pendant>; 1];

/// The inputs that work buttons.
#[derive(Debug, Default)]
pub(super) struct Buttons {
    start: Watch,
}

impl Buttons {
    /// What the inputs of this cycle press.
    pub(super) fn listen(&mut self, io: &Image, system: &System, cycle: u64, active: bool) -> Pressed {
        let start = self.start.look(io, system.start_prog_di.get(), cycle, active);
        [start.rises.then_some(Pendant::Start)]
    }
}
