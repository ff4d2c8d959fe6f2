//! Motion that is stopped and suspended so that other motions can come in between: `stopmove` and `startmove`.
//!
//! What is suspended is the path itself, with the robot at rest on it. So after a return to that very place the robot
//! continues along the same path. Only where motions are skipped, those behind them are planned again, from the target
//! that the robot goes to instead.

mod return_motion;

use std::collections::VecDeque;

use crate::command::error::PlanError;
use crate::command::joints::Joints;
use crate::command::{Command, Settings, Target, Zone};
use crate::overlay::CompensationState;
use crate::plan::gate;
use crate::plan::planner::plan;
use crate::queue::layer::{Asked, Layer, RESERVED_SUSPENSIONS, Requests};
use crate::queue::{Queue, Stop};
use return_motion::{ReturnMotion, Skipped};

/// How near to the place of the stop a return motion has to end, in deg (mm).
const SAME_PLACE_DEG_OR_MM: f64 = 1e-6;
/// Number of motions that are planned again in a cycle.
const REPLANNED_A_CYCLE: usize = 4;
/// A stop in progress.
#[derive(Clone, Debug)]
struct Stopping {
    stop: Stop,
    level: u32,
    /// How to continue what was suspended before.
    starts: VecDeque<Start>,
    going: bool,
    /// Whether what is being stopped will be dropped rather than continued.
    drops: bool,
}

/// A stop requested while the robot was already braking and was to continue then. Once at rest, it takes effect before
/// the robot continues.
#[derive(Clone, Debug)]
struct Again {
    level: u32,
    /// How to continue what was suspended before.
    starts: VecDeque<Start>,
}

/// How to continue what was suspended last.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Start {
    /// Number of motions that are dropped, counted from the stopped one: the robot goes to the target of the last of
    /// them. 0: to the place of the stop.
    pub skip: u32,
    /// Whether the robot goes there at manual speed.
    pub manual: bool,
    /// The program line, for the trace and for errors.
    pub line: u32,
}

/// Motion that was suspended by a stop.
#[derive(Clone, Debug)]
struct SuspendedMotion {
    /// The program level that stopped it.
    level: u32,
    /// Where the robot stopped.
    joints: Joints,
    /// Running number of the motion that had been added last.
    added: u64,
    layer: Layer,
}

/// What is suspended, and what is about to be.
#[derive(Clone, Debug)]
pub(crate) struct Suspension {
    stopping: Option<Stopping>,
    again: Vec<Again>,
    /// Suspended motions, the last one on top.
    suspended: Vec<SuspendedMotion>,
    /// The return motion that was planned last, until a caller takes it.
    return_motion: Option<(u64, Command, Settings)>,
    /// Whether more motions were to be dropped than there were.
    beyond: bool,
    broken: Option<PlanError>,
}

impl Default for Suspension {
    fn default() -> Self {
        Self {
            stopping: None,
            again: Vec::with_capacity(RESERVED_SUSPENSIONS),
            suspended: Vec::with_capacity(RESERVED_SUSPENSIONS),
            return_motion: None,
            beyond: false,
            broken: None,
        }
    }
}

impl Suspension {
    /// The kind of the stop in progress.
    pub(crate) fn stop(&self) -> Option<Stop> {
        self.stopping.as_ref().map(|stopping| stopping.stop)
    }

    /// Whether something is suspended that no caller has asked to continue yet.
    fn waits_for_start(&self, requests: &Requests) -> bool {
        let below = |suspended: &SuspendedMotion| suspended.layer.requests.starts.len();
        let stopping = self.stopping.as_ref().map_or(0, |stopping| stopping.starts.len());
        let again = self.again.iter().map(|again| again.starts.len()).sum::<usize>();
        let asked = requests.starts.len() + self.suspended.iter().map(below).sum::<usize>() + stopping + again;
        self.suspended.len() + usize::from(self.stopping.is_some()) + self.again.len() > asked
    }

    /// Drops everything.
    pub(crate) fn clear(&mut self) {
        self.again.clear();
        self.suspended.clear();
        (self.stopping, self.return_motion, self.broken) = (None, None, None);
        self.beyond = false;
    }

    /// Whether a motion whose number is no higher than that of the last ended one has really ended.
    fn has_ended(&self, motion: u64, ended: impl Fn(&SuspendedMotion) -> u64) -> bool {
        let within = |early: &[(u64, u64)]| early.iter().any(|(from, to)| (*from..=*to).contains(&motion));
        self.suspended.iter().all(|suspended| {
            motion <= ended(suspended) || motion > suspended.added || within(&suspended.layer.requests.early)
        })
    }
}

impl Queue {
    /// Whether nothing is suspended, about to be suspended or to be continued.
    pub(crate) fn is_clear(&self) -> bool {
        self.suspension.suspended.is_empty() && self.is_settled()
    }

    /// Whether nothing is about to be suspended or to be continued.
    fn is_settled(&self) -> bool {
        self.suspension.stopping.is_none()
            && self.layer.requests.starts.is_empty()
            && self.layer.requests.anew.is_empty()
            && !self.suspension.beyond
    }

    /// Whether a program level may move the robot while motions are suspended.
    fn is_open_to(&self, level: u32) -> bool {
        self.is_settled() && self.suspension.suspended.last().is_none_or(|suspended| level >= suspended.level)
    }

    /// Brings the robot to rest on its path and suspends its motions, so that others can be added that come before they
    /// continue. Only program level `level` or a higher one may add motions: see [`Queue::takes`].
    pub fn request_suspension(&mut self, stop: Stop, level: u32) {
        if let Some(stopping) = &mut self.suspension.stopping {
            if stop == Stop::Fast {
                stopping.stop = stop;
            }
            if self.layer.requests.starts.is_empty() {
                stopping.level = stopping.level.max(level);
            } else {
                let starts = self.layer.requests.take_starts();
                self.suspension.again.push(Again { level, starts });
            }
            return;
        }
        let again = self.suspension.suspended.last().is_some_and(|suspended| suspended.level >= level);
        if again && self.is_layer_idle() && self.is_settled() {
            return;
        }
        let starts = self.layer.requests.take_starts();
        let going = std::mem::take(&mut self.layer.requests.going);
        self.suspension.stopping = Some(Stopping { stop, level, starts, going, drops: false });
        self.suspend_at_rest();
    }

    /// Continues what was suspended last, once the robot is at rest and what was added since is done. Returns whether
    /// anything was suspended that is not already to be continued.
    pub fn start_again(&mut self, start: Start) -> bool {
        if !self.suspension.waits_for_start(&self.layer.requests) {
            return false;
        }
        self.layer.requests.starts.push_back(start);
        self.go_on();
        true
    }

    /// Drops what is suspended, where no caller has asked to continue it; returns whether there was anything. A stop in
    /// progress is completed.
    pub fn drop_suspended(&mut self) -> bool {
        let waits = self.suspension.waits_for_start(&self.layer.requests);
        if waits {
            self.suspension.suspended.clear();
            self.layer.requests.starts.clear();
            self.layer.requests.going = false;
            if let Some(stopping) = &mut self.suspension.stopping {
                stopping.starts.clear();
                self.suspension.again.clear();
                (stopping.going, stopping.drops) = (false, true);
            }
        }
        waits
    }

    /// Whether motions are suspended, or about to be.
    pub fn is_suspended(&self) -> bool {
        self.suspension.stopping.is_some() || !self.suspension.suspended.is_empty()
    }

    /// The number of stops that have suspended motions.
    pub fn depth(&self) -> usize {
        self.suspension.suspended.len()
    }

    /// The running number of the first motion that has not ended.
    pub fn oldest(&self) -> u64 {
        self.suspension.suspended.first().map_or(self.layer.finished, |suspended| suspended.layer.finished) + 1
    }

    /// Whether a program level can add a motion now.
    pub fn takes(&self, level: u32) -> bool {
        self.is_open_to(level) && self.has_room() && !self.has_planned_enough()
    }

    /// Whether nothing is left that a program level has to wait for: all motions except those suspended for it.
    pub fn idle_for(&self, level: u32) -> bool {
        if self.is_open_to(level) { self.is_layer_idle() } else { self.idle() }
    }

    /// Whether a motion has ended.
    pub fn has_ended(&self, motion: u64) -> bool {
        let ended =
            motion <= self.layer.finished && self.suspension.has_ended(motion, |suspended| suspended.layer.finished);
        ended || self.layer.requests.ended_early(motion)
    }

    /// Whether a motion is no longer executed: it has ended, or a blend leads away from it.
    pub fn is_over(&self, motion: u64) -> bool {
        let over = motion <= self.layer.over && self.suspension.has_ended(motion, |suspended| suspended.layer.over);
        over || self.layer.requests.ended_early(motion)
    }

    /// Whether, since the last call, more motions were to be dropped than there were. In that case all were dropped.
    pub fn take_beyond(&mut self) -> bool {
        std::mem::take(&mut self.suspension.beyond)
    }

    /// Takes the reason why the robot cannot go to where [`Queue::start_again`] was to take it, since the last call.
    pub fn take_broken_start(&mut self) -> Option<PlanError> {
        self.suspension.broken.take()
    }

    /// Takes the return motion that [`Queue::start_again`] has added since the last call, with its running number.
    pub fn take_return_motion(&mut self) -> Option<(u64, Command, Settings)> {
        self.suspension.return_motion.take()
    }

    /// Whether there is no motion being executed or waiting, apart from suspended ones.
    pub(crate) fn is_layer_idle(&self) -> bool {
        self.layer.finished == self.added
    }

    /// Notes a motion that is being added from `start` on.
    pub(crate) fn note_asked(&mut self, number: u64, start: Joints, command: &Command, settings: &Settings) {
        while self.layer.requests.asked.get(1).is_some_and(|next| next.number <= self.layer.finished) {
            self.layer.requests.asked.pop_front();
        }
        let end = *self.end();
        let compensation_state =
            if self.layer.deferred.is_some() { CompensationState::default() } else { self.layer.compensation_state };
        let (command, settings) = (command.clone(), *settings);
        self.layer.requests.asked.push_back(Asked { number, command, settings, start, end, compensation_state });
    }

    /// Notes where a motion ends that had waited for the next one and has now been planned.
    pub(crate) fn note_released(&mut self, number: u64) {
        if let Some(asked) = self.layer.requests.asked.iter_mut().rev().find(|asked| asked.number == number) {
            (asked.end, asked.compensation_state) = (self.layer.end, self.layer.compensation_state);
        }
    }

    /// The number of motions of this layer that have been added and have not ended, including the one being executed.
    pub(crate) fn unfinished(&self) -> usize {
        let asked = &self.layer.requests.asked;
        asked.len() - asked.partition_point(|asked| asked.number <= self.layer.finished)
    }

    /// Handles suspended motions at the end of a cycle.
    pub(crate) fn advance_suspension(&mut self) {
        self.layer.requests.early.retain(|(_, to)| *to > self.layer.finished);
        self.suspend_at_rest();
        self.plan_anew();
        self.go_on();
    }

    /// Suspends everything once the robot is at rest.
    fn suspend_at_rest(&mut self) {
        if self.halt.dropping || !self.rests() {
            return;
        }
        let Some(Stopping { level, starts, going, drops, .. }) = self.suspension.stopping.take() else { return };
        self.suspend(level, starts, going);
        for at in 0..self.suspension.again.len() {
            if let Some(again) = self.suspension.again.get_mut(at) {
                let (level, starts) = (again.level, std::mem::take(&mut again.starts));
                self.suspend(level, starts, false);
            }
        }
        self.suspension.again.clear();
        self.forecast = None;
        self.halt.braking_hard = false;
        self.look_ahead.waited = 0.0;
        if drops {
            self.suspension.suspended.pop();
        }
    }

    /// Suspends the current layer.
    fn suspend(&mut self, level: u32, starts: VecDeque<Start>, going: bool) {
        let layer = self.layer.suspend(self.commanded.joints, self.added, starts, going);
        let suspended = SuspendedMotion { level, joints: self.commanded.joints, added: self.added, layer };
        self.suspension.suspended.push(suspended);
    }

    /// Continues what was suspended, where the robot is already there; else adds the return motion.
    fn go_on(&mut self) {
        while let Some(start) = self.layer.requests.starts.front().copied() {
            if self.suspension.stopping.is_some()
                || !self.layer.requests.anew.is_empty()
                || !self.is_layer_idle()
                || !self.rests()
            {
                return;
            }
            let Some(suspended) = self.suspension.suspended.last() else {
                self.layer.requests.starts.clear();
                return;
            };
            if !self.layer.requests.going && start.skip > 0 && suspended.leads_on() {
                // It was stopped on the path to another suspended motion, or before that: the motions to skip are those
                // of the other.
                self.pass_on(start);
                continue;
            }
            let skipped = suspended.skipped(start.skip);
            if !self.layer.requests.going {
                let motion = match &skipped {
                    Skipped::None => suspended.return_motion(&self.robot, &self.commanded.joints),
                    Skipped::To(last) => Some(last.motion_to_target(&self.robot)),
                    Skipped::Beyond => {
                        self.suspension.beyond = true;
                        self.layer.requests.starts.clear();
                        self.suspension.suspended.clear();
                        return;
                    }
                };
                if let Some(motion) = motion {
                    self.layer.requests.going = true;
                    if let Err(error) = self.go(motion, start) {
                        self.suspension.broken = Some(PlanError::Earlier { line: start.line, error: Box::new(error) });
                        self.layer.requests.starts.clear();
                        self.layer.requests.going = false;
                    }
                    return;
                }
            }
            let skipped =
                if let Skipped::To(last) = skipped { Some((last.number, last.compensation_state)) } else { None };
            self.layer.requests.starts.pop_front();
            self.layer.requests.going = false;
            self.resume_suspended(skipped);
        }
    }

    /// Skips motions of what is below the topmost suspended one, to which the robot was on its path.
    fn pass_on(&mut self, start: Start) {
        self.layer.requests.starts.pop_front();
        if let Some(mut suspended) = self.suspension.suspended.pop() {
            if let Some(first) = suspended.layer.requests.starts.front_mut() {
                first.skip = first.skip.max(start.skip);
            }
            self.layer.requests.put_back(suspended.layer.requests.starts);
        }
    }

    /// Adds the motion to where the robot is to continue.
    fn go(&mut self, ReturnMotion { asked, command, end }: ReturnMotion, start: Start) -> Result<(), PlanError> {
        let plain = Settings { weave: None, compensation: None, ..asked };
        let settings = Settings { manual: plain.manual || start.manual, ..plain };
        let command = Command { zone: Zone::NONE, duration: None, line: start.line, ..command };
        let here = self.layer.end;
        let mut motions = match &command.target {
            Target::Gate { .. } => gate::plan(&self.robot, &here, &command, &settings)?,
            _ => vec![plan(&self.robot, &here, &command, &settings)?],
        };
        if let (Some(end), Some(last)) = (end, motions.last_mut()) {
            if !last.end.is_at(&end, SAME_PLACE_DEG_OR_MM) {
                return Err(PlanError::NoReturnMotion);
            }
            last.end = end;
        }
        let number = self.added + 1;
        for motion in motions {
            self.append(motion, number);
        }
        self.note_asked(number, here, &command, &settings);
        self.added = number;
        self.suspension.return_motion = Some((number, command, settings));
        Ok(())
    }

    /// Continues what was suspended last: where it was stopped, or behind the motion `skipped`, with the state of the
    /// compensation at its end.
    fn resume_suspended(&mut self, skipped: Option<(u64, CompensationState)>) {
        let Some(SuspendedMotion { mut layer, added, .. }) = self.suspension.suspended.pop() else { return };
        self.layer.requests.take_over(std::mem::take(&mut layer.requests), (added + 1, self.added));
        self.forecast = None;
        match skipped {
            None => self.layer.resume(layer),
            Some((last, compensation_state)) => {
                (self.layer.finished, self.layer.over) = (last, last);
                (self.layer.end, self.layer.compensation_state) = (self.commanded.joints, compensation_state);
                self.layer.execution.started = None;
                // What was still to be planned again when it was dropped was requested last.
                let Requests { asked, anew, .. } = &mut self.layer.requests;
                *anew = asked.iter().chain(&*anew).filter(|asked| asked.number > last).cloned().collect();
                asked.retain(|asked| asked.number <= last);
            }
        }
        self.end_empty();
        self.plan_anew();
    }

    /// Plans again some of the motions that come behind skipped ones.
    fn plan_anew(&mut self) {
        for _ in 0..REPLANNED_A_CYCLE {
            let Some(asked) = self.layer.requests.anew.pop_front() else { return };
            let before = self.layer.requests.asked.back().map(|before| (before.command.clone(), before.start));
            if let Err(error) = self.add_again(&asked, before) {
                self.layer.requests.anew.clear();
                self.notices.broken = Some(PlanError::Earlier { line: asked.command.line, error: Box::new(error) });
            }
        }
    }

    /// Adds a motion again, under its own number.
    fn add_again(&mut self, asked: &Asked, before: Option<(Command, Joints)>) -> Result<(), PlanError> {
        // A circle continues through the points of the one that was skipped.
        let start = before
            .filter(|_| self.layer.deferred.is_none())
            .filter(|(before, _)| {
                matches!((&before.target, &asked.command.target), (Target::Circle { .. }, Target::Circle { .. }))
            })
            .map(|(_, start)| start);
        self.add_as(&asked.command, &asked.settings, asked.number)?;
        if let (Some(start), Some(deferred)) = (start, &mut self.layer.deferred) {
            deferred.follows_circle_from(start);
        }
        Ok(())
    }
}
