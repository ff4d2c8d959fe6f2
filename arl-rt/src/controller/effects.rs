//! The effects of a scenario beside its inputs: buttons of the pendant, hands and forces at robots.

use super::channel::Channel;
use super::channels::Channels;
use super::pendant;
use crate::io::{AxisName, Effect, RobotEffect};
use crate::motion::Override;

/// The index of an axis of a channel's robot, from 0. The axis was checked to exist.
fn place(channel: &Channel, axis: AxisName) -> Option<usize> {
    channel.channel_state().robot().and_then(|unit| axis.place(unit.robot()))
}

/// Carries out an effect of a scenario, except on inputs. The pendant's buttons act on all channels.
pub(super) fn act(channels: &mut Channels, effect: Effect) {
    let (number, robot_effect) = match effect {
        Effect::Pendant(button) => return pendant::press(channels, button),
        Effect::Robot(number, robot_effect) => (number, robot_effect),
    };
    // The channel was checked to exist.
    let Some(channel) = channels.numbered(number) else { return };
    match robot_effect {
        RobotEffect::Jog(axis, by) => {
            if let Some(place) = place(channel, axis) {
                pendant::jog(channel, place + 1, by);
            }
        }
        RobotEffect::Hand(axis, by) => {
            if let Some(place) = place(channel, axis) {
                pendant::move_by_hand(channel, place + 1, by);
            }
        }
        RobotEffect::Force(force) => {
            if let Some(mut unit) = channel.channel_state().robot_mut() {
                unit.outside_mut().force = force;
            }
        }
        RobotEffect::Torque(axis, torque) => {
            if let Some(mut unit) = channel.channel_state().robot_mut()
                && let Some(place) = unit.outside_mut().torques.get_mut(axis)
            {
                *place = torque;
            }
        }
    }
}

/// Sets the speed override of all robots.
pub(super) fn set_override(channels: &Channels, speed: Override) {
    channels
        .iter()
        .filter_map(|channel| channel.channel_state().robot_mut())
        .for_each(|mut unit| unit.set_override(speed));
}
