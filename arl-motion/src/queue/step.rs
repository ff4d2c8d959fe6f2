//! What one cycle did: where the robot is to be, and how it moves there.

use super::Queue;
use crate::command::Joints;
use arl_robot::kinematics::Frame;

/// What one cycle did. All of it holds at the end of the cycle.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub struct Step {
    /// The commanded positions, in deg (mm of linear axes).
    pub joints: Joints,
    /// How fast they change, in deg/s (mm/s). All 0 while the robot rests, and where [`Queue::tell_rates`] has said so.
    pub velocity: Joints,
    /// How fast that changes, in deg/s2 (mm/s2); 0 where the velocity is.
    pub acceleration: Joints,
    /// The TCP in the world, with the tool and the base of the motion that is or was last executed, translation in mm.
    pub tcp: Frame,
    /// The speed of the TCP against the workpiece, in mm/s; 0 where the velocity is.
    pub tcp_speed: f64,
    /// The running number, from 1, of the motion executed in this cycle; 0 where there is none.
    pub motion: u64,
    /// Its program line; 0 where there is none.
    pub line: u32,
    /// The running number of the last motion that has ended; motions end in order. It falls back where motions go on
    /// that were set aside: [`Queue::has_ended`] tells of each.
    pub finished: u64,
    /// Whether the robot stands still at the end of the cycle.
    pub rests: bool,
}

impl Step {
    /// A robot that rests, and has not moved.
    pub(crate) fn resting(joints: Joints, tcp: Frame) -> Self {
        Self {
            joints,
            velocity: Joints::ZERO,
            acceleration: Joints::ZERO,
            tcp,
            tcp_speed: 0.0,
            motion: 0,
            line: 0,
            finished: 0,
            rests: true,
        }
    }
}

impl Queue {
    /// Where the robot is between two cycles, and how it moves there.
    pub(super) fn now(&self) -> Step {
        let rates = self.layer.path.rates(&self.robot.kinematics, &self.joints);
        let [velocity, acceleration] = rates.unwrap_or([self.velocity, Joints::ZERO]);
        let tcp = self.tcp();
        Step {
            velocity,
            acceleration,
            tcp_speed: self.tcp_speed(&velocity, &tcp),
            finished: self.layer.finished,
            rests: self.rests(),
            ..Step::resting(self.joints, tcp)
        }
    }

    /// The speed of the TCP against the workpiece, in mm/s, where the axes move so fast.
    fn tcp_speed(&self, velocity: &Joints, tcp: &Frame) -> f64 {
        if *velocity == Joints::ZERO {
            return 0.0;
        }
        let point = (self.rig().base.inverse() * tcp).translation.vector;
        self.robot.kinematics.point_velocity(&self.joints.axes, &velocity.axes, &point).norm()
    }

    /// What a cycle of `dt` s did that executed this motion of this line, and began at `before`.
    pub(super) fn made_step(&mut self, (motion, line): (u64, u32), before: &Joints, dt: f64) -> Step {
        let step = Step { motion, line, ..Step::resting(self.joints, self.tcp()) };
        if !self.tells_rates {
            return step;
        }
        let was = self.velocity;
        let [velocity, acceleration] =
            self.layer.path.rates(&self.robot.kinematics, &self.joints).unwrap_or_else(|| {
                // At a singular point derivatives are made of rounding: differences are what the robot does.
                let velocity = difference(&self.joints, before, dt);
                [velocity, difference(&velocity, &was, dt)]
            });
        self.velocity = velocity;
        Step { velocity, acceleration, tcp_speed: self.tcp_speed(&velocity, &step.tcp), ..step }
    }
}

/// How fast values have gone from others to these, within `time` s.
fn difference(now: &Joints, before: &Joints, time: f64) -> Joints {
    let mut rates = Joints::ZERO;
    let values = now.axes.iter().zip(&before.axes).chain(now.external.iter().zip(&before.external));
    for (rate, (now, before)) in rates.axes.iter_mut().chain(&mut rates.external).zip(values) {
        *rate = (now - before) / time;
    }
    rates
}
