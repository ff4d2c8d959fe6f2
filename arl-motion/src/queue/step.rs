//! What one cycle did: the commanded state of the robot.

use super::Queue;
use crate::command::Joints;
use arl_robot::kinematics::Frame;

/// What one cycle did. All values hold at the end of the cycle.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub struct Step {
    /// The commanded positions, in deg (mm of linear axes).
    pub joints: Joints,
    /// Velocities of the axes, in deg/s (mm/s). All 0 while the robot is at rest, and where [`Queue::tell_rates`] has
    /// turned them off.
    pub velocity: Joints,
    /// Accelerations of the axes, in deg/s2 (mm/s2); 0 where the velocity is.
    pub acceleration: Joints,
    /// The TCP in the world, with the tool and the base of the motion that is or was last executed, translation in mm.
    pub tcp: Frame,
    /// Speed of the TCP relative to the workpiece, in mm/s; 0 where the velocity is.
    pub tcp_speed: f64,
    /// Running number, from 1, of the motion executed in this cycle; 0 where there is none.
    pub motion: u64,
    /// Its program line; 0 where there is none.
    pub line: u32,
    /// Running number of the last motion that has ended; motions end in order. It decreases where suspended motions
    /// continue: [`Queue::has_ended`] tells for each motion whether it has ended.
    pub finished: u64,
    /// Whether the robot is at rest at the end of the cycle.
    pub rests: bool,
}

impl Step {
    /// The step of a robot at rest that has not moved.
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
    /// The state of the robot between two cycles.
    pub(super) fn now(&self) -> Step {
        let rates = self.layer.path.rates(&self.robot.kinematics, &self.commanded.joints);
        let [velocity, acceleration] = rates.unwrap_or([self.commanded.velocity, Joints::ZERO]);
        let tcp = self.tcp();
        Step {
            velocity,
            acceleration,
            tcp_speed: self.tcp_speed(&velocity, &tcp),
            finished: self.layer.finished,
            rests: self.rests(),
            ..Step::resting(self.commanded.joints, tcp)
        }
    }

    /// The speed of the TCP relative to the workpiece, in mm/s, at these velocities of the axes.
    fn tcp_speed(&self, velocity: &Joints, tcp: &Frame) -> f64 {
        if *velocity == Joints::ZERO {
            return 0.0;
        }
        let point = (self.rig().base.inverse() * tcp).translation.vector;
        self.robot.kinematics.point_velocity(&self.commanded.joints.axes, &velocity.axes, &point).norm()
    }

    /// The step of a cycle of `dt` s that began at `before` and executed `motion` of the program line `line`.
    pub(super) fn made_step(&mut self, motion: u64, line: u32, before: &Joints, dt: f64) -> Step {
        let step = Step { motion, line, ..Step::resting(self.commanded.joints, self.tcp()) };
        if !self.commanded.tells_rates {
            return step;
        }
        let was = self.commanded.velocity;
        let [velocity, acceleration] =
            self.layer.path.rates(&self.robot.kinematics, &self.commanded.joints).unwrap_or_else(|| {
                // At a singular point, derivatives consist of rounding errors: differences show what the robot does.
                let velocity = difference(&self.commanded.joints, before, dt);
                [velocity, difference(&velocity, &was, dt)]
            });
        self.commanded.velocity = velocity;
        Step { velocity, acceleration, tcp_speed: self.tcp_speed(&velocity, &step.tcp), ..step }
    }
}

/// The mean rates of change from `before` to `now` within `time` s.
fn difference(now: &Joints, before: &Joints, time: f64) -> Joints {
    let mut rates = Joints::ZERO;
    let values = now.axes.iter().zip(&before.axes).chain(now.external.iter().zip(&before.external));
    for (rate, (now, before)) in rates.axes.iter_mut().chain(&mut rates.external).zip(values) {
        *rate = (now - before) / time;
    }
    rates
}
