//! The look-ahead and the interpolator: motions wait in a queue, and each cycle moves along the first one.

use std::collections::VecDeque;
use std::sync::Arc;

use super::command::{Command, Settings};
use super::error::PlanError;
use super::joints::Joints;
use super::plan::{Motion, plan};
use super::profile::{Limits, Profile, State};
use crate::kinematics::Frame;
use crate::robot::Robot;

/// How many motions wait at most, the one being executed not counted.
pub const LOOK_AHEAD: usize = 64;

/// How to come to rest on the path.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Stop {
    /// With the limits of the motion.
    General,
    /// With five times the acceleration and jerk.
    Fast,
}

/// How much harder a fast stop is.
const FAST: f64 = 5.0;

/// What one cycle did.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Step {
    /// The commanded positions.
    pub joints: Joints,
    /// The TCP in the robot's base with the tool of the motion that is or was last executed, translation in mm.
    pub tcp: Frame,
    /// The running number, from 1, of the motion executed in this cycle; 0 where there is none.
    pub motion: u64,
    /// Its program line; 0 where there is none.
    pub line: u32,
    /// The running number of the last motion that has ended; motions end in order.
    pub finished: u64,
    /// Whether the robot stands still at the end of the cycle.
    pub rests: bool,
}

/// How far the motion being executed has come. Times are those at an override of 100 %.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Progress {
    /// The running number of the motion.
    pub motion: u64,
    /// Its program line.
    pub line: u32,
    /// s since its start.
    pub elapsed_time: f64,
    /// s to its end.
    pub left_time: f64,
    /// mm of the line that are done; 0 for axis motions.
    pub elapsed_distance: f64,
    /// mm of the line that are left; 0 for axis motions.
    pub left_distance: f64,
}

/// How fast to go along the path: what the current profile was made for.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Pace {
    /// Share of the motion's own speed; 0 comes to rest on the path.
    speed: f64,
    stop: Stop,
}

/// The motion being executed.
#[derive(Clone, PartialEq, Debug)]
struct Running {
    number: u64,
    motion: Motion,
    limits: Limits,
    pace: Pace,
    profile: Profile,
    /// s since the start of the profile.
    time: f64,
    state: State,
}

/// The motions of one robot, planned ahead and executed cycle by cycle.
#[derive(Clone, Debug)]
pub struct Queue {
    robot: Arc<Robot>,
    waiting: VecDeque<Motion>,
    running: Option<Running>,
    stop: Option<Stop>,
    dropping: bool,
    joints: Joints,
    tool: Frame,
    added: u64,
    finished: u64,
}

impl Queue {
    /// An empty queue of a robot that rests at `start`.
    pub fn new(robot: Arc<Robot>, start: Joints) -> Self {
        Self {
            robot,
            waiting: VecDeque::with_capacity(LOOK_AHEAD),
            running: None,
            stop: None,
            dropping: false,
            joints: start,
            tool: Frame::identity(),
            added: 0,
            finished: 0,
        }
    }

    /// The robot that moves.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Whether another motion can be added.
    pub fn has_room(&self) -> bool {
        self.waiting.len() < LOOK_AHEAD
    }

    /// Plans a motion from the end of the last one and appends it; returns its running number, from 1.
    ///
    /// # Errors
    /// The motion cannot be planned, or there is no room, or dropped motions have not come to rest yet. Nothing was added.
    pub fn add(&mut self, command: &Command, settings: &Settings) -> Result<u64, PlanError> {
        if self.dropping {
            return Err(PlanError::Stopping);
        }
        if !self.has_room() {
            return Err(PlanError::Full);
        }
        let motion = plan(&self.robot, self.end(), command, settings)?;
        self.waiting.push_back(motion);
        self.added += 1;
        Ok(self.added)
    }

    /// Where the last motion of the queue ends: where the next one starts.
    pub fn end(&self) -> &Joints {
        match (self.waiting.back(), &self.running) {
            (Some(last), _) => &last.end,
            (None, Some(running)) => &running.motion.end,
            (None, None) => &self.joints,
        }
    }

    /// The commanded positions now.
    pub fn joints(&self) -> &Joints {
        &self.joints
    }

    /// The TCP now in the robot's base, with the tool of the last motion, translation in mm.
    pub fn tcp(&self) -> Frame {
        self.robot.kinematics.forward(&self.joints.axes) * self.tool
    }

    /// Whether no motion is there, running or waiting.
    pub fn idle(&self) -> bool {
        self.running.is_none() && self.waiting.is_empty()
    }

    /// Whether the robot stands still, at the end of a motion or within one.
    pub fn rests(&self) -> bool {
        self.running.as_ref().is_none_or(|running| running.state.rests() && running.time >= running.profile.duration())
    }

    /// Whether it was told to stop, and neither to resume nor to drop its motions.
    pub fn stopped(&self) -> bool {
        self.stop.is_some()
    }

    /// Comes to rest on the path; motions stay in the queue until [`Queue::resume`]. A general stop does not soften a fast
    /// one.
    pub fn stop_on_path(&mut self, stop: Stop) {
        if self.stop != Some(Stop::Fast) {
            self.stop = Some(stop);
        }
    }

    /// Goes on along the path after a stop; after a fast one as soon as the robot rests.
    pub fn resume(&mut self) {
        self.stop = None;
    }

    /// Drops all motions that wait, and the one being executed: at once where the robot rests, else when it has come to
    /// rest. Without a stop it ends at its target first.
    pub fn clear(&mut self) {
        self.waiting.clear();
        self.dropping = true;
        self.drop_at_rest();
    }

    /// Puts the commanded positions elsewhere, as when a robot is switched on; returns whether it could: not while there
    /// are motions.
    pub fn place(&mut self, joints: Joints) -> bool {
        let idle = self.idle();
        if idle {
            self.joints = joints;
        }
        idle
    }

    /// How far the motion being executed has come; `None` where there is none.
    pub fn progress(&self) -> Option<Progress> {
        let running = self.running.as_ref()?;
        let profile = running.motion.profile();
        let elapsed_time = profile.time_at(running.state.at);
        let elapsed_distance = running.motion.length * running.state.at;
        Some(Progress {
            motion: running.number,
            line: running.motion.line,
            elapsed_time,
            left_time: profile.duration() - elapsed_time,
            elapsed_distance,
            left_distance: running.motion.length - elapsed_distance,
        })
    }

    /// Moves on by one cycle of `dt` s at an override of `override_percent`, 0 to 100. A motion ends exactly at its target,
    /// and the next one starts with the cycle after.
    pub fn step(&mut self, dt: f64, override_percent: f64) -> Step {
        let speed = if override_percent > 0.0 { override_percent.min(100.0) / 100.0 } else { 0.0 };
        if self.running.is_none() && self.stop.is_none() {
            self.start_next(speed);
        }
        let (mut motion, mut line) = (0, 0);
        if let Some(running) = &mut self.running {
            (motion, line) = (running.number, running.motion.line);
            let pace = match self.stop {
                Some(stop) => Pace { speed: 0.0, stop },
                None => Pace { speed, stop: Stop::General },
            };
            running.take_pace(pace);
            running.time += dt;
            running.state = running.profile.at(running.time);
            let at = running.state.at;
            let Motion { path, start, end, .. } = &running.motion;
            self.joints = path.joints(&self.robot.kinematics, start, end, at, &self.joints);
            if at >= 1.0 {
                self.finished = running.number;
                self.running = None;
            }
        }
        self.drop_at_rest();
        Step { joints: self.joints, tcp: self.tcp(), motion, line, finished: self.finished, rests: self.rests() }
    }

    fn start_next(&mut self, speed: f64) {
        while let Some(motion) = self.waiting.pop_front() {
            self.tool = motion.tool;
            match motion.limits {
                // A motion that goes nowhere has ended when it starts.
                None => self.finished += 1,
                Some(limits) => {
                    let pace = Pace { speed: 0.0, stop: Stop::General };
                    let profile = Profile::resting(0.0);
                    let state = State::resting(0.0);
                    let number = self.finished + 1;
                    let mut running = Running { number, motion, limits, pace, profile, time: 0.0, state };
                    running.take_pace(Pace { speed, stop: Stop::General });
                    self.running = Some(running);
                    return;
                }
            }
        }
    }

    fn drop_at_rest(&mut self) {
        if self.dropping && self.rests() {
            self.finished = self.added;
            self.running = None;
            self.dropping = false;
        }
    }
}

impl Running {
    /// Makes the rest of the path a profile of this pace, from the state that has been reached.
    fn take_pace(&mut self, pace: Pace) {
        if pace == self.pace || (self.pace.stop == Stop::Fast && !self.state.rests()) {
            return;
        }
        self.pace = pace;
        let profile = if pace.speed > 0.0 { self.onwards(pace.speed) } else { self.to_rest(pace.stop) };
        // No profile: the motion brakes already and comes to rest at its target, and there is no gentler way.
        if let Some(profile) = profile {
            self.profile = profile;
            self.time = 0.0;
        }
    }

    fn to_rest(&self, stop: Stop) -> Option<Profile> {
        let harder = if stop == Stop::Fast { FAST } else { 1.0 };
        let limits = Limits { vel: self.limits.vel, acc: self.limits.acc * harder, jerk: self.limits.jerk * harder };
        let profile = Profile::stop(self.state, &limits);
        (profile.end() < 1.0).then_some(profile)
    }

    /// At a constant override a motion is the same as at 100 %, only slower: its ramps are slowed, too. To change from one
    /// override to another, and where a slowed ramp is too long for what is left of the path, the motion's own limits are
    /// used.
    fn onwards(&self, speed: f64) -> Option<Profile> {
        let slowed = self.limits.slowed(speed);
        if self.state.rests() {
            return Profile::to_rest(self.state, 1.0, &slowed);
        }
        let limits = Limits { vel: slowed.vel, ..self.limits };
        Profile::reaching(self.state, 1.0, &limits, &slowed).or_else(|| Profile::to_rest(self.state, 1.0, &limits))
    }
}
