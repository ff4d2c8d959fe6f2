//! External auto control (chapter 9): a PLC that works the controller through inputs and outputs.
//!
//! System variables say which channels mean what. Inputs are looked at when they have been read, outputs follow before
//! they are written; in between lies the cycle.

mod buttons;
mod edge_detector;
mod number;
mod program_number;
mod status_outputs;

use crate::context::system::System;
use crate::controller::State;
use crate::fault::Fault;
use crate::io::Image;
use crate::values::Controlmode;
pub(super) use buttons::SERVO_PULSE_S;
use buttons::{Buttons, Pressed};
pub(super) use edge_detector::InputSnapshot;
use program_number::ProgramNumber;
use status_outputs::StatusOutputs;

/// The side of the controller that a PLC sees.
#[derive(Debug)]
pub(super) struct External {
    /// Whether the cell has it at all.
    enabled: bool,
    buttons: Buttons,
    number: ProgramNumber,
    status_outputs: StatusOutputs,
}

impl External {
    pub(super) fn new(enabled: bool) -> Self {
        let (buttons, number, status_outputs) =
            (Buttons::default(), ProgramNumber::default(), StatusOutputs::default());
        Self { enabled, buttons, number, status_outputs }
    }

    /// Looks at the inputs of this cycle: takes over the program number that the PLC gives; returns the buttons that it
    /// presses, in the order in which they act.
    ///
    /// # Errors
    /// It gives no program number, though it says so.
    pub(super) fn listen(&mut self, now: &InputSnapshot<'_>) -> Result<Pressed, Fault> {
        let InputSnapshot { io, system, cycle, .. } = *now;
        let active = self.enabled && is_activated(io, system);
        system.ext_ctl_act.set(active);
        if !self.enabled {
            return Ok(Pressed::default());
        }
        let pressed = self.buttons.listen(now, active);
        self.number.listen(io, system, cycle, active)?;
        Ok(pressed)
    }

    /// Whether a PLC is wired.
    pub(super) fn is_wired(&self) -> bool {
        self.enabled
    }

    /// Whether a PLC is wired that may start programs.
    pub(super) fn starts(&self, system: &System) -> bool {
        self.enabled && system.start_prog_di.get() > 0 && system.ctl_mode.get() == Controlmode::Auto
    }

    /// Brings the outputs up to date that tell the PLC what the controller does.
    pub(super) fn show(&mut self, io: &mut Image, system: &System, state: State, servo_on: bool) {
        if self.enabled {
            self.status_outputs.show(io, system, state, servo_on, self.number.taken());
        }
    }
}

/// Whether the PLC may work the controller: in automatic mode, while its activation input is on, or where none is
/// wired.
fn is_activated(io: &Image, system: &System) -> bool {
    let asked = match system.ext_ctl_act_di.get() {
        0 => true,
        channel => io.input(channel) == Some(true),
    };
    asked && system.ctl_mode.get() == Controlmode::Auto
}
