//! A cycle of a robot: one step of its motion, and the exchange with its driver.

use super::robot_driver::{Setpoint, settled};
use super::supervision::{is_all_finite, is_finite};
use super::{Motors, Moving, REST, RobotCycle, Unit, own_axes_of};
use crate::motion::Joints;

impl Unit {
    /// One interpolation step, and the exchange with the driver.
    pub(crate) fn step(&mut self, robot_cycle: RobotCycle) {
        let period = robot_cycle.cycle.period();
        self.queue.follow_real_time(robot_cycle.real);
        let step = self.queue.step(robot_cycle.cycle, self.speed_override);
        if let Some(recorder) = &mut self.recorder {
            recorder.step(&mut self.queue, &step);
        }
        self.executing = (step.line, step.motion);
        self.finished = step.finished;
        self.note_rest();
        self.note_start();
        // The queue counts the first half of a blend as the motion before it; to programs a blend belongs to the next
        // motion.
        let (motion, line) = match self.queue.progress() {
            Some(next) if step.motion != 0 && next.motion > step.motion => (next.motion, next.line),
            _ => (step.motion, step.line),
        };
        self.files.point_at(motion, line, self.queue.oldest());
        if step.motion != 0 {
            self.set_base(self.queue.rig().base);
        }
        self.tcp = if self.queue.rig().base == self.base { step.tcp } else { self.tcp_where(&step.joints) };
        self.change_due();
        self.commanded.go_to(step.joints, period);
        self.exchange(robot_cycle);
        let near = self.queue.rests() && settled(&self.commanded.at, &self.reported.at, self.robot.drives.settled);
        self.settled = if near { self.settled.saturating_add(1) } else { 0 };
        self.switch_off_at_rest();
    }

    /// Sends the set-point to the driver, and takes in its feedback.
    fn exchange(&mut self, robot_cycle: RobotCycle) {
        let setpoint = self.setpoint_of(robot_cycle);
        let feedback = self.link.exchange(&setpoint);
        let position = feedback.position.filter(|position| is_finite(position, &self.robot));
        self.silent = self.silent.saturating_add(1);
        if let Some(position) = position {
            // It may be the first position after some cycles.
            let since = f64::from(self.silent) * robot_cycle.cycle.period();
            self.reported.go_to(own_axes_of(&self.robot, position, &self.commanded.at), since);
            if let Some(velocity) = feedback.velocity.filter(|velocity| is_finite(velocity, &self.robot)) {
                self.reported.measured(&own_axes_of(&self.robot, velocity, &REST));
            }
            self.silent = 0;
            self.effort.measured(feedback.torque.filter(is_all_finite));
        }
        self.supervise(&feedback, &setpoint);
    }

    fn setpoint_of(&self, robot_cycle: RobotCycle) -> Setpoint {
        let (period, deadline) = (robot_cycle.cycle.period(), robot_cycle.due);
        if matches!(self.servo.motors, Motors::Off | Motors::ComingOn) {
            // Motors that are not on are only asked to stay where they are.
            return Setpoint { deadline, ..Setpoint::resting(self.reported.at, period) };
        }
        let Moving { at: position, rates, external_rates, accelerations: acceleration, .. } = self.commanded;
        let velocity = Joints { axes: rates, external: external_rates };
        let torque = if self.link.wants_torque() { self.effort.asked(&self.commanded) } else { None };
        Setpoint { position, velocity, acceleration, torque, period, deadline }
    }
}
