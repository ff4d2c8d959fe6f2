//! The inputs by which a PLC presses the buttons of the pendant.

use super::edge_detector::{EdgeDetector, InputSnapshot, InputState};
use crate::context::system::System;
use crate::io::Pendant;

/// How long a pulse must be to switch the servos, in s.
pub(in crate::controller) const SERVO_PULSE_S: f64 = 0.03;

/// What makes an input press its button.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Means {
    /// It goes on.
    Edge,
    /// It goes on, or it is still on when the programs pause.
    Level,
    /// It has been on for [`SERVO_PULSE_S`].
    Pulse,
}

/// An input that presses a button.
struct Button {
    channel: fn(&System) -> i32,
    means: Means,
    button: Pendant,
}

/// The buttons in the order in which they act within a cycle: those that stop come last, so that they win.
const BUTTONS: [Button; 6] = [
    Button { channel: |system| system.clear_alarm_di.get(), means: Means::Edge, button: Pendant::Clear },
    Button { channel: |system| system.reset_prog_di.get(), means: Means::Level, button: Pendant::Reset },
    Button { channel: |system| system.servo_on_di.get(), means: Means::Pulse, button: Pendant::ServoOn },
    Button { channel: |system| system.start_prog_di.get(), means: Means::Edge, button: Pendant::Start },
    Button { channel: |system| system.pause_prog_di.get(), means: Means::Edge, button: Pendant::Pause },
    Button { channel: |system| system.servo_off_di.get(), means: Means::Pulse, button: Pendant::ServoOff },
];

/// The buttons that are pressed in a cycle, in the order in which they act.
pub(in crate::controller) type Pressed = [Option<Pendant>; BUTTONS.len()];

/// The inputs that press buttons.
#[derive(Debug, Default)]
pub(super) struct Buttons([EdgeDetector; BUTTONS.len()]);

impl Buttons {
    /// The buttons that the inputs of this cycle press.
    pub(super) fn listen(&mut self, now: &InputSnapshot<'_>, active: bool) -> Pressed {
        let InputSnapshot { io, system, cycle, rate, paused } = *now;
        let pulse = rate.cycles(SERVO_PULSE_S);
        let mut pressed = Pressed::default();
        let mut resetting = false;
        for ((place, watch), Button { channel, means, button }) in pressed.iter_mut().zip(&mut self.0).zip(&BUTTONS) {
            let seen = watch.look(io, channel(system), cycle, active);
            resetting |= *button == Pendant::Reset && seen.on;
            // A program that is being reset cannot be started: the reset must go first.
            let held = resetting && *button == Pendant::Start;
            *place = (is_pressed(*means, seen, pulse, paused) && !held).then_some(*button);
        }
        pressed
    }
}

fn is_pressed(means: Means, seen: InputState, pulse: u64, paused: bool) -> bool {
    match means {
        Means::Edge => seen.rises,
        Means::Level => seen.rises || paused && seen.cycles > 0,
        Means::Pulse => seen.cycles == pulse,
    }
}
