//! Stopping and moving the robot beside its program: pause, servo, jogging.

use super::moving::Moving;
use super::range;
use super::robot_driver::{Drives, Feedback, Power, Setpoint};
use super::supervision::Now;
use super::{Mounts, Unit};
use crate::fault::{Fault, File};
use crate::motion::{Command, Joints, Settings, Speed, Start, Stop, Target, Zone};

/// The speed of jogging, in % of the axes' own.
pub(super) const JOGGING: f64 = 10.0;
/// A robot whose axes are slower than that, in deg/s (mm/s), stands: what it measures of itself is never quite still.
const STILL: f64 = 5.0;
/// The farthest that an axis is moved at once, in deg (mm): more is a mistake.
const FARTHEST: f64 = 1e6;
/// The level of those who move the robot beside the program: above all of it.
pub(super) const BESIDE: u32 = u32::MAX;

/// Whether the motors of a robot hold it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Motors {
    /// They do, and set-points are the motion.
    On,
    /// They were told to, and have not said that they do.
    ComingOn,
    /// They go off once the robot rests.
    GoingOff,
    /// They do not. Set-points are where the robot is.
    Off,
}

/// Whether an axis can be moved so far.
fn is_distance(by: f64) -> Result<(), String> {
    if by.abs() <= FARTHEST {
        Ok(())
    } else {
        Err(format!("an axis cannot move by {by:?}: expected -{FARTHEST} to {FARTHEST} deg (mm)"))
    }
}

impl Unit {
    /// What the motors do.
    pub(crate) fn motors(&self) -> Motors {
        self.motors
    }

    /// Whether the motors hold the robot, and are to go on doing so.
    pub(crate) fn has_servo(&self) -> bool {
        self.motors == Motors::On
    }

    /// Comes to rest on the path, until [`Unit::go_on`].
    pub(crate) fn pause(&mut self) {
        self.queue.stop_on_path(Stop::General);
        self.halted = true;
    }

    /// Goes on after a pause; back to the path first, at manual speed, where the robot was moved. `place` stands for
    /// the way back where no motion is under way.
    pub(crate) fn go_on(&mut self, place: (File, u32)) {
        if !std::mem::take(&mut self.halted) {
            return;
        }
        if std::mem::take(&mut self.jogged) {
            let (file, line) = self.pointer.unwrap_or(place);
            self.start_again(Start { skip: 0, manual: true, line }, file);
        }
        self.queue.resume();
    }

    /// The motion that is executed, or comes next.
    pub(crate) fn next_motion(&self) -> Option<u64> {
        (!self.queue.idle()).then(|| self.queue.current().unwrap_or(self.planned))
    }

    /// Stops on the path; at rest the brakes close and the motors let go.
    pub(crate) fn servo_off(&mut self) {
        match self.motors {
            Motors::On => {
                self.motors = Motors::GoingOff;
                self.let_go();
                self.pause();
            }
            // The robot stands.
            Motors::ComingOn => self.switch_off(),
            Motors::GoingOff | Motors::Off => {}
        }
    }

    /// Switches the motors off at once: an emergency, in which the robot brakes by itself. Its motions stop where they
    /// are.
    pub(crate) fn cut_power(&mut self) {
        if self.motors != Motors::Off {
            self.motors = Motors::Off;
            self.let_go();
            self.pause();
        }
        // Also one that is off: there are robots whose power is somebody else's, and which hold where they stand.
        self.switch(Power::Cut);
    }

    /// Switches motors off that are to go off, where the robot rests.
    pub(super) fn switch_off_at_rest(&mut self) {
        let stands = self.queue.rests() && self.commanded.at == self.commanded.before;
        if self.motors == Motors::GoingOff && stands && self.is_settled() {
            self.switch_off();
        }
    }

    fn switch_off(&mut self) {
        self.motors = Motors::Off;
        self.switch(Power::Off);
    }

    /// Switches the motors on. The set-point is where the robot reports to be; with a threshold, in deg (mm), it stays
    /// what it was where no axis is farther off than that. Returns whether that was so, where it was asked for.
    ///
    /// # Errors
    /// The robot moves, it is not known where it is, or it is where its axes cannot be.
    pub(crate) fn servo_on(&mut self, threshold: Option<f64>) -> Result<bool, String> {
        match self.motors {
            Motors::On | Motors::ComingOn => return Ok(true),
            Motors::GoingOff if !self.supervision.has_found() => {
                self.motors = Motors::On;
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
            if self.jogged {
                // What moved it beside its path when its motors went off is over.
                self.queue.drop_added();
            }
            self.step_beside();
            if !self.go_where_it_is() {
                return Err("its motions are still under way".into());
            }
        }
        self.supervision.begin();
        let is_on = self.switch(Power::On) == Drives::On;
        self.motors = if is_on { Motors::On } else { Motors::ComingOn };
        Ok(near || threshold.is_none())
    }

    /// Puts the set-point where the robot is; whether that could be done.
    fn go_where_it_is(&mut self) -> bool {
        let here = self.reported.at;
        let placed = self.queue.place(here);
        if placed {
            (self.commanded, self.reported) = (Moving::resting(here), Moving::resting(here));
        }
        placed
    }

    /// Looks at what the robot has said. What is wrong with it stops it, by what is still possible.
    pub(super) fn supervise(&mut self, feedback: &Feedback, setpoint: &Setpoint) {
        if self.motors == Motors::Off {
            return;
        }
        if self.motors == Motors::ComingOn && feedback.drives == Some(Drives::On) {
            // It may have been moved since they were told to.
            if self.jogged {
                self.go_where_it_is();
            }
            self.motors = Motors::On;
        }
        let now = Now {
            robot: &self.robot,
            asked: &setpoint.position,
            period: setpoint.period,
            silent: self.silent,
            coming_on: self.motors == Motors::ComingOn,
            rests: self.queue.rests(),
            settled: self.is_settled(),
        };
        let is_first = !self.supervision.has_found();
        let Some(fault) = self.supervision.look(feedback, now) else { return };
        let place = self.pointer.filter(|_| self.executing.1 != 0);
        match fault {
            // Nobody follows set-points any more.
            Fault::Drives(_) => self.cut_power(),
            // Set-points lead to rest, and the motors go off there.
            _ => {
                self.motors = Motors::GoingOff;
                self.let_go();
            }
        }
        self.stop();
        if is_first {
            self.trouble = Some((fault, place));
        }
    }

    /// What is wrong with the robot, and in which motion, once.
    pub(crate) fn take_trouble(&mut self) -> Option<(Fault, Option<(File, u32)>)> {
        self.trouble.take()
    }

    /// Sets the motions aside, so that the robot can be moved beside its path.
    fn step_beside(&mut self) {
        if !std::mem::replace(&mut self.jogged, true) {
            self.set_aside(Stop::General, BESIDE);
        }
    }

    /// Whether the robot can be moved beside its program now.
    pub(super) fn may_be_jogged(&self) -> Result<(), String> {
        if !self.has_servo() {
            return Err("the servo is off".into());
        }
        if !self.queue.rests() {
            return Err("the robot has not stopped yet".into());
        }
        Ok(())
    }

    /// Moves an axis, from 1, at manual speed. While it was paused, the robot goes back to its path before it goes on.
    pub(crate) fn jog(&mut self, axis: usize, by: f64) -> Result<(), String> {
        is_distance(by)?;
        self.may_be_jogged()?;
        let mut target = *self.target();
        if self.halted && !self.jogged {
            target = *self.setpoint();
        }
        *self.axis_of(&mut target, axis)? += by;
        // External axes have speeds of their own in place of a share.
        let own = self.robot.axes.get(axis - 1).map_or(1.0, |axis| axis.vel * JOGGING / 100.0);
        let speed = Speed { percent: JOGGING, tcp: 1.0, ori: 1.0, exj: own, exl: own };
        self.go_beside(Target::Joints(target), speed)
    }

    /// Goes somewhere beside the program, at manual speed, with what the robot carries.
    pub(super) fn go_beside(&mut self, target: Target, speed: Speed) -> Result<(), String> {
        let rig = self.rig();
        if self.halted {
            self.step_beside();
        }
        let command = Command { target, rig, speed, duration: None, zone: Zone::NONE, line: 0 };
        self.queue.resume();
        let settings = Settings { manual: true, ..Settings::default() };
        let file = self.file;
        self.plan(&command, &settings, Mounts::default(), file).map_err(|alarm| alarm.fault.to_string())
    }

    /// Moves an axis, from 1, while the servo is off.
    pub(crate) fn move_by_hand(&mut self, axis: usize, by: f64) -> Result<(), String> {
        is_distance(by)?;
        if self.motors != Motors::Off {
            return Err("its servo is on: the motors hold it".into());
        }
        if !self.queue.rests() {
            return Err("the robot has not stopped yet".into());
        }
        let mut here = self.reported.at;
        *self.axis_of(&mut here, axis)? += by;
        self.driver.moved_by_hand(&here);
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
