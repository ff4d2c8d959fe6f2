//! The status of a controller between two cycles, for a screen: channels, robots, inputs and outputs.

use std::sync::Arc;

use super::channel::Channel;
use super::{Controller, Outcome, State};
use crate::cycle::channel_id::ChannelId;
use crate::fault::File;
use crate::io::Image;
use crate::motion::Joints;
use crate::unit::Motors;
use crate::values::Controlmode;
use arl_robot::robot::Robot;

/// The state of a controller between two cycles.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct Status {
    /// Controller time in s.
    pub time: f64,
    /// The operating mode.
    pub mode: Controlmode,
    /// The speed override in %.
    pub speed_override: f64,
    /// The states of the channels: the foreground ones by their numbers, then the background ones.
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

/// The state of a channel.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct ChannelStatus {
    /// The channel.
    pub channel: ChannelId,
    /// The file that has the program's `main`.
    pub program: File,
    /// What the program does.
    pub state: State,
    /// How its program ended; `None` while it runs.
    pub outcome: Option<Outcome>,
    /// The file and line of the statement that runs.
    pub place: (File, u32),
    /// The state of its robot; a background channel has none.
    pub robot: Option<RobotStatus>,
}

/// The state of a channel's robot.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct RobotStatus {
    /// The robot.
    pub robot: Arc<Robot>,
    /// The file and line of the motion that is being executed, or was executed last.
    pub motion: Option<(File, u32)>,
    /// The running number of the motion that was executed in the last cycle; 0 where there was none.
    pub motion_number: u64,
    /// Whether the motors hold the robot.
    pub motors: Motors,
    /// The commanded axis positions, in deg (mm).
    pub joints: Joints,
    /// The axis positions that the robot reports, in deg (mm).
    pub reported: Joints,
    /// The commanded TCP in the world, with the tool of its motion: x, y, z in mm, a, b, c in deg.
    pub tcp: [f64; 6],
    /// The robot's base in the world: x, y, z in mm, a, b, c in deg.
    pub base: [f64; 6],
    /// The workpiece frame of its motion in the world: x, y, z in mm, a, b, c in deg.
    pub workpiece: [f64; 6],
}

impl Controller {
    /// The status of the controller, its channels and its robots.
    pub fn status(&self) -> Status {
        let (unit, io) = (self.unit.borrow(), self.shared.io.borrow());
        Status {
            time: self.time(),
            mode: self.system().ctl_mode.get(),
            speed_override: unit.speed_override().percent(),
            channels: self.channel_status(),
            di: io.inputs().levels().to_vec(),
            dout: io.outputs().levels().to_vec(),
            ai: io.analogs(false).to_vec(),
            ao: io.analogs(true).to_vec(),
        }
    }

    /// Calls `each` with the robot of every channel: the place of its motion, where something has moved, the base (x,
    /// y, z in mm, a, b, c in deg) and its own and external axes; with nothing for a background channel.
    pub(crate) fn each_robot(&self, mut each: impl FnMut(Option<(File, u32)>, &[f64], &[f64], &[f64])) {
        for channel in self.channels.iter() {
            let Some(unit) = channel.channel_state().robot() else {
                each(None, &[], &[], &[]);
                continue;
            };
            let (robot, joints) = (unit.robot(), unit.setpoint());
            let own = joints.axes.get(..robot.own_axes().len()).unwrap_or_default();
            let external = joints.external.get(..robot.external_axes().len()).unwrap_or_default();
            each(unit.motion_pointer(), &unit.base_in_world(), own, external);
        }
    }

    /// Gives access to the inputs and outputs.
    pub(crate) fn with_signals<T>(&self, see: impl FnOnce(&Image) -> T) -> T {
        see(&self.shared.io.borrow())
    }

    /// The states of the channels.
    pub(crate) fn channel_status(&self) -> Vec<ChannelStatus> {
        self.channels.iter().map(of_channel).collect()
    }
}

fn of_channel(channel: &Channel) -> ChannelStatus {
    let channel_state = channel.channel_state();
    ChannelStatus {
        channel: channel_state.id,
        program: channel.cx().program(),
        state: channel.state(),
        outcome: channel.outcome().cloned(),
        place: channel.cx().place(),
        robot: channel_state.robot().map(|unit| RobotStatus {
            robot: unit.shared_robot(),
            motion: unit.motion_pointer(),
            motion_number: unit.executing().1,
            motors: unit.motors(),
            joints: *unit.setpoint(),
            reported: *unit.feedback(),
            tcp: unit.commanded_tcp(),
            base: unit.base_in_world(),
            workpiece: unit.workpiece_in_world(),
        }),
    }
}
