//! How everything stands: what a screen shows.

use super::{Controller, Outcome, State};
use crate::fault::File;
use crate::motion::Joints;
use crate::values::Controlmode;

/// How a controller stands between two cycles.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct Status {
    /// Controller time in s.
    pub time: f64,
    /// The operating mode.
    pub mode: Controlmode,
    /// The speed override in %.
    pub speed_override: f64,
    /// How the channels stand.
    pub channels: Vec<ChannelStatus>,
    /// The levels of the digital inputs, from channel 1.
    pub di: Vec<bool>,
    /// The levels of the digital outputs, from channel 1.
    pub dout: Vec<bool>,
    /// The analog inputs in V or mA, from channel 1.
    pub ai: Vec<f64>,
    /// The analog outputs in V or mA, from channel 1.
    pub ao: Vec<f64>,
}

/// How a channel stands.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct ChannelStatus {
    /// What it does.
    pub state: State,
    /// How its program ended, when it has.
    pub outcome: Option<Outcome>,
    /// The file and line of the statement that runs.
    pub place: (File, u32),
    /// The file and line of the motion that is being executed, or was last.
    pub motion: Option<(File, u32)>,
    /// The axes as commanded, in deg (mm).
    pub joints: Joints,
    /// The TCP as commanded, in the world, with the tool of its motion: x, y, z in mm, a, b, c in deg.
    pub tcp: [f64; 6],
}

impl Controller {
    /// How everything stands.
    pub fn status(&self) -> Status {
        let (unit, io) = (self.world.unit.borrow(), self.world.io.borrow());
        let channel = ChannelStatus {
            state: self.state(),
            outcome: self.outcome().cloned(),
            place: self.place(),
            motion: unit.motion_pointer(),
            joints: *unit.setpoint(),
            tcp: unit.commanded_tcp(),
        };
        Status {
            time: self.time(),
            mode: self.world.system.ctl_mode.get(),
            speed_override: unit.speed_override(),
            channels: vec![channel],
            di: io.inputs().levels().to_vec(),
            dout: io.outputs().levels().to_vec(),
            ai: io.analogs(false).to_vec(),
            ao: io.analogs(true).to_vec(),
        }
    }
}
