//! What a cycle does: the speed, the advance along the path, and which motions end.

use std::sync::Arc;

use super::layer::Layer;
use super::motion_progress::progress_at;
use super::{FAST_STOP_FACTOR, Queue, Step, Stop};
use crate::command::{Cycle, Override};
use crate::follow::governor::Pacing;
use crate::follow::segment::Segment;
use crate::overlay::CompensationState;
use arl_robot::frames::Rig;

impl Queue {
    /// Advances by one cycle at an override. A motion that is not blended with the next one ends exactly at its target,
    /// and the next one starts in the following cycle.
    pub fn step(&mut self, cycle: Cycle, speed_override: Override) -> Step {
        let dt = cycle.period();
        self.cycle = dt;
        let waits_for_motion = self.waits_for_motion(dt);
        self.count_cycle();
        self.exited.clear();
        let before = self.commanded.joints;
        let speed = speed_override.percent() / 100.0;
        let pacing = self.choose_pacing(speed);
        let (motion, line) = if waits_for_motion { self.stand() } else { self.advance(dt, speed, pacing) };
        self.take_answer();
        self.lay_waiting();
        self.end_empty();
        self.leave_behind();
        self.drop_at_rest();
        if !matches!(pacing, Pacing::Stop(_)) {
            self.release_after_wait(dt);
        }
        // A resumed layer brings its own tool: from the next cycle on.
        let step = self.made_step(motion, line, &before, dt);
        self.advance_suspension();
        Step { finished: self.layer.finished, rests: self.rests(), ..step }
    }

    /// The pacing of this cycle at an override of `speed`, 0 to 1. A fast stop is continued to rest: from its
    /// acceleration, nothing else would be within the limits.
    fn choose_pacing(&mut self, speed: f64) -> Pacing {
        let stop =
            if self.halt.stop == Some(Stop::Fast) { self.halt.stop } else { self.suspension.stop().or(self.halt.stop) };
        let pacing = match stop {
            Some(Stop::Fast) => Pacing::Stop(FAST_STOP_FACTOR),
            Some(Stop::General) => Pacing::Stop(1.0),
            None if speed > 0.0 => Pacing::Go(speed),
            None => Pacing::Stop(1.0),
        };
        let is_hard = matches!(pacing, Pacing::Stop(stop_scale) if stop_scale > 1.0);
        self.halt.braking_hard = !self.layer.path.rests() && (self.halt.braking_hard || is_hard);
        if self.halt.braking_hard { Pacing::Stop(FAST_STOP_FACTOR) } else { pacing }
    }

    /// Advances along the path by a cycle; returns the motion executed in it, and its line.
    fn advance(&mut self, dt: f64, speed: f64, pacing: Pacing) -> (u64, u32) {
        let rested = self.layer.path.rests();
        let is_stopped = rested && matches!(pacing, Pacing::Stop(_));
        let Some(first) = self.layer.path.first().filter(|_| !is_stopped) else {
            if rested && self.layer.path.at() == 0.0 {
                // The robot is at a target and not within a motion.
                self.layer.progress = None;
            }
            return (0, 0);
        };
        let (motion, line, rig) = (first.number, first.line, first.rig);
        let before = self.layer.execution;
        self.execute(motion, rig);
        let passed = if matches!(pacing, Pacing::Go(_)) { dt * speed } else { 0.0 };
        self.count_time(passed);
        let (arrived, stands) = self.follow_path(dt, pacing);
        if rested && !stands && self.layer.path.awaits_law() {
            // The motion has not begun.
            self.layer.execution = before;
            return self.stand();
        }
        let executed = self.place_on_path((motion, line), arrived.as_deref().filter(|_| stands));
        self.layer.progress = match arrived.filter(|_| stands) {
            Some(segment) => Some(self.progress_at_end(&segment)),
            None => self.progress_on_path(passed),
        };
        executed
    }

    /// Stays at rest before a motion that will begin; returns that none is executed.
    fn stand(&mut self) -> (u64, u32) {
        self.layer.progress = self.progress_on_path(0.0);
        (0, 0)
    }

    /// Lets the path's leader advance by a cycle; returns the segment that was left behind last, and whether the robot
    /// has come to a stop at its end.
    fn follow_path(&mut self, dt: f64, pacing: Pacing) -> (Option<Arc<Segment>>, bool) {
        let Layer { path, waiting, concluded, execution, finished, .. } = &mut self.layer;
        path.note_end(*concluded && waiting.is_empty());
        let mut arrived = None;
        let stands = path.advance(&self.robot, &self.commanded.joints, dt, pacing, |passed| {
            *finished = if passed.ends { passed.number } else { *finished };
            if !passed.leaves() {
                let elapsed = if passed.number == execution.timed { execution.elapsed } else { 0.0 };
                let duration = passed.duration().unwrap_or(elapsed);
                self.exited.push(progress_at(&passed, passed.share_at_end(), duration, 0.0));
            }
            arrived = Some(passed);
        });
        (arrived, stands)
    }

    /// Sets the commanded positions to where the robot is on the path, or to the end of the segment at which it stands.
    /// Returns the motion executed there and its line, or `executed` where there is no other.
    fn place_on_path(&mut self, executed: (u64, u32), end: Option<&Segment>) -> (u64, u32) {
        let kinematics = &self.robot.kinematics;
        match (end, self.layer.path.first()) {
            (Some(segment), _) => {
                self.commanded.joints = segment.joints(kinematics, segment.time, &self.commanded.joints);
                (segment.number, segment.line)
            }
            (None, Some(segment)) => {
                self.commanded.joints = segment.joints(kinematics, self.layer.path.at(), &self.commanded.joints);
                let (motion, line, rig) = (segment.number, segment.line, segment.rig);
                self.execute(motion, rig);
                (motion, line)
            }
            (None, None) => executed,
        }
    }

    /// Notes that a motion is being executed.
    fn execute(&mut self, number: u64, rig: Rig) {
        self.layer.execution.started = Some(number);
        self.layer.execution.rig = rig;
    }

    /// Ends motions that go nowhere once those before them have ended.
    pub(super) fn end_empty(&mut self) {
        let anew = self.layer.requests.first_anew().unwrap_or(self.added + 1);
        let deferred = self.layer.deferred.as_ref().map_or(anew, |deferred| deferred.number);
        let waiting = self.layer.waiting.first().map_or(deferred, |ready| ready.number);
        let next = self.layer.path.first().map_or(waiting, |segment| segment.number);
        self.layer.finished = self.layer.finished.max(next - 1);
        if self.layer.path.is_empty() && self.layer.waiting.is_empty() && !self.halt.dropping {
            self.layer.execution.rig = self.layer.last_rig;
        }
    }

    pub(super) fn drop_at_rest(&mut self) {
        if self.halt.dropping && self.rests() {
            self.layer.finished = self.added;
            self.layer.over = self.added;
            self.layer.path.clear();
            self.layer.end = self.commanded.joints;
            self.layer.compensation_state = CompensationState::default();
            self.layer.execution.started = None;
            self.layer.progress = None;
            self.halt.dropping = false;
            self.halt.braking_hard = false;
        }
    }
}
