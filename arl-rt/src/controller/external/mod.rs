//! External auto control (chapter 9): a PLC controls the controller through inputs and outputs.
//!
//! System variables assign functions to channels. Inputs are evaluated after they have been read, outputs are set
//! before they are written; the cycle lies in between.

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
    /// Whether the cell enables external control.
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

    /// Evaluates the inputs of this cycle: takes over the program number that the PLC gives, and returns the buttons
    /// that it presses, in the order in which they act.
    ///
    /// # Errors
    /// The PLC signals a program number, but gives no valid one.
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

    /// Updates the outputs that report the controller's state to the PLC.
    pub(super) fn show(&mut self, io: &mut Image, system: &System, state: State, servo_on: bool) {
        if self.enabled {
            self.status_outputs.show(io, system, state, servo_on, self.number.taken());
        }
    }
}

/// Whether the PLC may control the controller: in automatic mode, while its activation input is on, or where no such
/// input is wired.
fn is_activated(io: &Image, system: &System) -> bool {
    let asked = match system.ext_ctl_act_di.get() {
        0 => true,
        channel => io.input(channel) == Some(true),
    };
    asked && system.ctl_mode.get() == Controlmode::Auto
}
