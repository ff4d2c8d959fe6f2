//! Stopping and moving the robot beside its program: pause, servo, jogging.

use super::moving::Moving;
use super::range;
use super::robot_driver::{Drives, Feedback, Power, Setpoint};
use super::supervision::{Now, Supervision};
use super::{Mounts, Unit};
use crate::fault::{Fault, File};
use crate::motion::{Command, Joints, Settings, Speed, Start, Stop, Target, Zone};

/// The speed of jogging, in % of the axes' own speeds.
pub(super) const JOGGING: f64 = 10.0;
/// A robot whose axes are slower than this, in deg/s (mm/s), stands: measured speeds are never exactly zero.
const STILL: f64 = 5.0;
/// The farthest that an axis is moved by one request, in deg (mm): more is a mistake.
const FARTHEST: f64 = 1e6;
/// The level of motions beside the program: above all of its levels.
pub(super) const BESIDE: u32 = u32::MAX;

/// Whether the motors of a robot hold it.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[non_exhaustive]
pub enum Motors {
    /// They hold it, and set-points are the motion.
    #[default]
    On,
    /// They were switched on, and have not reported that they are on.
    ComingOn,
    /// They go off once the robot is at rest.
    GoingOff,
    /// They do not hold it. Set-points are the positions of the robot.
    Off,
}

/// The motors, and the supervision of the robot.
#[derive(Default, Debug)]
pub(super) struct Servo {
    pub(super) motors: Motors,
    pub(super) supervision: Supervision,
    /// The fault that the supervision has found, and in which motion, until it is taken.
    pub(super) found_fault: Option<(Fault, Option<(File, u32)>)>,
}

/// Checks that an axis can be moved by this much.
fn is_distance(by: f64) -> Result<(), String> {
    if by.abs() <= FARTHEST {
        Ok(())
    } else {
        Err(format!("an axis cannot move by {by:?}: expected -{FARTHEST} to {FARTHEST} deg (mm)"))
    }
}

impl Unit {
    /// The state of the motors.
    pub(crate) fn motors(&self) -> Motors {
        self.servo.motors
    }

    /// Whether the motors hold the robot, and are to go on doing so.
    pub(crate) fn has_servo(&self) -> bool {
        self.servo.motors == Motors::On
    }

    /// Comes to rest on the path, until [`Unit::go_on`].
    pub(crate) fn pause(&mut self) {
        self.queue.stop_on_path(Stop::General);
        self.jogging.halted = true;
    }

    /// Goes on after a pause; back to the path first, at manual speed, where the robot was moved. `place` is the place
    /// of the motion back where no motion was executed yet.
    pub(crate) fn go_on(&mut self, place: (File, u32)) {
        if !std::mem::take(&mut self.jogging.halted) {
            return;
        }
        if std::mem::take(&mut self.jogging.jogged) {
            let (file, line) = self.files.pointer.unwrap_or(place);
            self.start_again(Start { skip: 0, manual: true, line }, file);
        }
        self.queue.resume();
    }

    /// The motion that is executed, or comes next.
    pub(crate) fn next_motion(&self) -> Option<u64> {
        (!self.queue.idle()).then(|| self.queue.current().unwrap_or(self.planned))
    }

    /// Stops on the path; at rest the brakes close and the motors go off.
    pub(crate) fn servo_off(&mut self) {
        match self.servo.motors {
            Motors::On => {
                self.servo.motors = Motors::GoingOff;
                self.let_go();
                self.pause();
            }
            // The robot is at rest.
            Motors::ComingOn => self.switch_off(),
            Motors::GoingOff | Motors::Off => {}
        }
    }

    /// Switches the motors off at once: an emergency, in which the robot brakes by itself. Its motions stop where they
    /// are.
    pub(crate) fn cut_power(&mut self) {
        if self.servo.motors != Motors::Off {
            self.servo.motors = Motors::Off;
            self.let_go();
            self.pause();
        }
        // Also where they are off: the power of some robots is switched elsewhere, and they hold their position.
        self.link.switch(Power::Cut);
    }

    /// Switches off motors that are going off, once the robot is at rest.
    pub(super) fn switch_off_at_rest(&mut self) {
        let stands = self.queue.rests() && self.commanded.at == self.commanded.before;
        if self.servo.motors == Motors::GoingOff && stands && self.is_settled() {
            self.switch_off();
        }
    }

    fn switch_off(&mut self) {
        self.servo.motors = Motors::Off;
        self.link.switch(Power::Off);
    }

    /// Switches the motors on. The set-point is then the position that the robot reports; with a threshold, in deg
    /// (mm), it keeps its value where no axis is farther off than that. Returns whether it did, where a threshold was
    /// given.
    ///
    /// # Errors
    /// The robot moves, its position is not known, or it is outside the ranges of its axes.
    pub(crate) fn servo_on(&mut self, threshold: Option<f64>) -> Result<bool, String> {
        match self.servo.motors {
            Motors::On | Motors::ComingOn => return Ok(true),
            Motors::GoingOff if !self.servo.supervision.has_found() => {
                self.servo.motors = Motors::On;
                return Ok(true);
            }
            Motors::GoingOff => return Err("the robot has not stopped yet".into()),
            Motors::Off => {}
        }
        if self.silent > 0 {
            return Err("there is no position feedback from the robot".into());
        }
        if let Some(outside) = range::first_outside(&self.reported.at, &self.robot) {
            return Err(outside.to_string());
        }
        let moves = self.reported.rates.iter().chain(&self.reported.external_rates).any(|rate| rate.abs() > STILL);
        if !self.queue.rests() || moves {
            return Err("the robot has not stopped yet".into());
        }
        let here = self.reported.at;
        let near = threshold.is_some_and(|threshold| self.commanded.at.is_at(&here, threshold));
        if !near && here != self.commanded.at {
            if self.jogging.jogged {
                // The motions beside the path when the motors went off are over.
                self.queue.drop_added();
            }
            self.step_beside();
            if !self.go_where_it_is() {
                return Err("its motions are still under way".into());
            }
        }
        self.servo.supervision.begin();
        let is_on = self.link.switch(Power::On) == Drives::On;
        self.servo.motors = if is_on { Motors::On } else { Motors::ComingOn };
        Ok(near || threshold.is_none())
    }

    /// Sets the set-point to the position of the robot; returns whether that was possible.
    fn go_where_it_is(&mut self) -> bool {
        let here = self.reported.at;
        let placed = self.queue.place(here);
        if placed {
            (self.commanded, self.reported) = (Moving::resting(here), Moving::resting(here));
        }
        placed
    }

    /// Checks the feedback of the robot. A fault stops it, by what is still possible.
    pub(super) fn supervise(&mut self, feedback: &Feedback, setpoint: &Setpoint) {
        if self.servo.motors == Motors::Off {
            return;
        }
        if self.servo.motors == Motors::ComingOn && feedback.drives == Some(Drives::On) {
            // It may have been moved since they were switched on.
            if self.jogging.jogged {
                self.go_where_it_is();
            }
            self.servo.motors = Motors::On;
        }
        let now = Now {
            robot: &self.robot,
            asked: &setpoint.position,
            period: setpoint.period,
            silent: self.silent,
            coming_on: self.servo.motors == Motors::ComingOn,
            rests: self.queue.rests(),
            settled: self.is_settled(),
        };
        let is_first = !self.servo.supervision.has_found();
        let Some(fault) = self.servo.supervision.look(feedback, now) else { return };
        let place = self.files.pointer.filter(|_| self.executing.1 != 0);
        match fault {
            // The drives do not follow set-points any more.
            Fault::Drives(_) => self.cut_power(),
            // Set-points lead to rest, where the motors go off.
            _ => {
                self.servo.motors = Motors::GoingOff;
                self.let_go();
            }
        }
        self.stop();
        if is_first {
            self.servo.found_fault = Some((fault, place));
        }
    }

    /// The fault of the robot, and in which motion it was, once.
    pub(crate) fn take_fault(&mut self) -> Option<(Fault, Option<(File, u32)>)> {
        self.servo.found_fault.take()
    }

    /// Sets the motions aside, so that the robot can be moved beside its path.
    fn step_beside(&mut self) {
        if !std::mem::replace(&mut self.jogging.jogged, true) {
            self.set_aside(Stop::General, BESIDE);
        }
    }

    /// Checks that the robot can be moved beside its program now.
    pub(super) fn may_be_jogged(&self) -> Result<(), String> {
        if !self.has_servo() {
            return Err("the servo is off".into());
        }
        if !self.queue.rests() {
            return Err("the robot has not stopped yet".into());
        }
        Ok(())
    }

    /// Moves an axis, from 1, at manual speed. Where the program is paused, the robot goes back to its path before it
    /// goes on.
    pub(crate) fn jog(&mut self, axis: usize, by: f64) -> Result<(), String> {
        is_distance(by)?;
        self.may_be_jogged()?;
        let mut target = *self.target();
        if self.jogging.halted && !self.jogging.jogged {
            target = *self.setpoint();
        }
        *self.axis_of(&mut target, axis)? += by;
        // External axes have absolute speeds in place of a percentage.
        let own = self.robot.axes.get(axis - 1).map_or(1.0, |axis| axis.vel * JOGGING / 100.0);
        let speed = Speed { percent: JOGGING, tcp: 1.0, ori: 1.0, exj: own, exl: own };
        self.go_beside(Target::Joints(target), speed)
    }

    /// Plans a motion beside the program, at manual speed, with what the robot carries.
    pub(super) fn go_beside(&mut self, target: Target, speed: Speed) -> Result<(), String> {
        let rig = self.rig();
        if self.jogging.halted {
            self.step_beside();
        }
        let command = Command { target, rig, speed, duration: None, zone: Zone::NONE, line: 0 };
        self.queue.resume();
        let settings = Settings { manual: true, ..Settings::default() };
        let file = self.files.last;
        self.plan(&command, &settings, Mounts::default(), file).map_err(|alarm| alarm.fault.to_string())
    }

    /// Moves an axis, from 1, while the servo is off.
    pub(crate) fn move_by_hand(&mut self, axis: usize, by: f64) -> Result<(), String> {
        is_distance(by)?;
        if self.servo.motors != Motors::Off {
            return Err("its servo is on: the motors hold it".into());
        }
        if !self.queue.rests() {
            return Err("the robot has not stopped yet".into());
        }
        let mut here = self.reported.at;
        *self.axis_of(&mut here, axis)? += by;
        self.link.moved_by_hand(&here);
        Ok(())
    }

    pub(super) fn axis_of<'a>(&self, joints: &'a mut Joints, axis: usize) -> Result<&'a mut f64, String> {
        let own = self.robot.own_axes().len();
        let all = self.robot.axes.len();
        let at = axis.checked_sub(1).filter(|at| *at < all);
        let place =
            at.and_then(|at| if at < own { joints.axes.get_mut(at) } else { joints.external.get_mut(at - own) });
        place.ok_or_else(|| format!("the robot has axes 1 to {all}, not {axis}"))
    }
}
