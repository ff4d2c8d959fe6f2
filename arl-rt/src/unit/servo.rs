//! Stopping and moving the robot beside its program: pause, servo, jogging.

use super::Unit;
use super::moving::Moving;
use crate::fault::File;
use crate::motion::{Command, Joints, Settings, Speed, Start, Stop, Target, Zone};
use arl_robot::frames::Rig;

/// The speed of jogging, in % of the axes' own.
pub(super) const JOGGING: f64 = 10.0;
/// The level of those who move the robot beside the program: above all of it.
pub(super) const BESIDE: u32 = u32::MAX;

impl Unit {
    /// Whether the motors hold the robot.
    pub(crate) fn has_servo(&self) -> bool {
        self.servo
    }

    /// Comes to rest on the path, until [`Unit::go_on`].
    pub(crate) fn pause(&mut self) {
        self.queue.stop_on_path(Stop::General);
        self.halted = true;
    }

    /// Goes on after a pause; back to the path first, at manual speed, where the robot was moved. `place` stands for the way
    /// back where no motion is under way.
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
        if std::mem::replace(&mut self.servo, false) {
            self.let_go();
            self.pause();
            self.driver.switch(false);
        }
    }

    /// Switches the motors on. The set-point is where the robot reports to be; with a threshold, in deg (mm), it stays what it
    /// was where no axis is farther off than that. Returns whether that was so, where it was asked for.
    pub(crate) fn servo_on(&mut self, threshold: Option<f64>) -> bool {
        if std::mem::replace(&mut self.servo, true) {
            return true;
        }
        self.driver.switch(true);
        let here = self.reported.at;
        let near = threshold.is_some_and(|threshold| self.commanded.at.is_at(&here, threshold));
        if !near && here != self.commanded.at {
            self.step_beside();
            if self.queue.place(here) {
                (self.commanded, self.reported) = (Moving::resting(here), Moving::resting(here));
            }
        }
        near || threshold.is_none()
    }

    /// Sets the motions aside, so that the robot can be moved beside its path.
    fn step_beside(&mut self) {
        if !std::mem::replace(&mut self.jogged, true) {
            self.set_aside(Stop::General, BESIDE);
        }
    }

    /// Whether the robot can be moved beside its program now.
    pub(super) fn may_be_jogged(&self) -> Result<(), String> {
        if !self.servo {
            return Err("the servo is off".into());
        }
        if !self.queue.rests() {
            return Err("the robot has not come to rest yet".into());
        }
        Ok(())
    }

    /// Moves an axis, from 1, at manual speed. While it was paused, the robot goes back to its path before it goes on.
    pub(crate) fn jog(&mut self, axis: usize, by: f64) -> Result<(), String> {
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

    /// What the robot carries as it stands.
    pub(super) fn rig_now(&self) -> Rig {
        Rig { base: self.base, ..*self.queue.rig() }
    }

    /// Goes somewhere beside the program, at manual speed, with what the robot carries.
    pub(super) fn go_beside(&mut self, target: Target, speed: Speed) -> Result<(), String> {
        let rig = self.rig_now();
        if self.halted {
            self.step_beside();
        }
        let command = Command { target, rig, speed, duration: None, zone: Zone::NONE, line: 0 };
        self.queue.resume();
        let settings = Settings { manual: true, ..Settings::default() };
        let file = self.file;
        self.plan(&command, &settings, file).map_err(|alarm| alarm.fault.to_string())
    }

    /// Moves an axis, from 1, while the servo is off.
    pub(crate) fn move_by_hand(&mut self, axis: usize, by: f64) -> Result<(), String> {
        if self.servo {
            return Err("its servo is on, the motors hold it".into());
        }
        if !self.queue.rests() {
            return Err("the robot has not come to rest yet".into());
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
