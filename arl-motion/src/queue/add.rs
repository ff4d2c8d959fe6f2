//! Motions are planned one after the other as they are added.

use super::Queue;
use crate::command::check::check;
use crate::command::error::PlanError;
use crate::command::joints::Joints;
use crate::command::{Command, Settings, Target};
use crate::plan::chain::DeferredMotion;
use crate::plan::gate;
use crate::plan::lay_overlay::OverlayStart;
use crate::plan::motion::Motion;
use crate::plan::planner::{plan_behind, without_compensation};

/// How long, in s, the robot is at rest before a motion that waits for the next one of its path starts without it.
const LONGEST_WAIT_FOR_NEXT_S: f64 = 0.1;

impl Queue {
    /// Plans a motion from the end of the last one and appends it; returns its running number, from 1. A motion whose
    /// path depends on the next one waits for that one, or for [`Queue::conclude`].
    ///
    /// # Errors
    /// The motion cannot be planned, the one before it cannot be planned now that this one is known
    /// ([`PlanError::Earlier`]), there is no room, or dropped motions have not come to rest yet. The motion was not
    /// added.
    pub fn add(&mut self, command: &Command, settings: &Settings) -> Result<u64, PlanError> {
        if self.halt.dropping {
            return Err(PlanError::Stopping);
        }
        if !self.has_room() {
            return Err(PlanError::Full);
        }
        if !self.end().is_finite() {
            return Err(PlanError::NotANumber);
        }
        check(command, settings)?;
        self.add_as(command, settings, self.added + 1)?;
        self.added += 1;
        Ok(self.added)
    }

    /// Plans a motion and appends it under the given number.
    pub(super) fn add_as(&mut self, command: &Command, settings: &Settings, number: u64) -> Result<(), PlanError> {
        self.layer.concluded = false;
        let from = *self.end();
        let start = match &self.layer.deferred {
            Some(deferred) => *deferred.end(),
            None if command.target.chained().is_some() => self.plain_end(command, settings)?,
            None => self.layer.end,
        };
        let mut next = DeferredMotion::new(&self.robot, &start, command, settings, number)?;
        self.release(next.as_mut())?;
        if next.is_some() {
            self.layer.deferred = next;
        } else if matches!(command.target, Target::Gate { .. }) {
            for motion in gate::plan(&self.robot, &self.layer.end, command, settings)? {
                self.append(motion, number);
            }
        } else {
            let motion = plan_behind(&self.robot, &self.layer.end, &self.layer.compensation_state, command, settings)?;
            self.append(motion, number);
        }
        self.note_asked(number, from, command, settings);
        Ok(())
    }

    /// Declares that no further motion will come before the robot is at rest: a motion that waited for the next one
    /// goes without it, and a single motion starts as if it had no zone. A motion that is added nevertheless is planned
    /// as any other.
    ///
    /// # Errors
    /// The motion that waited cannot be planned without a next one ([`PlanError::Earlier`]). It was dropped.
    pub fn conclude(&mut self) -> Result<(), PlanError> {
        self.layer.concluded = true;
        self.release(None)
    }

    /// Plans the motion that waits, before `next` where there is one.
    fn release(&mut self, next: Option<&mut DeferredMotion>) -> Result<(), PlanError> {
        let Some(mut deferred) = self.layer.deferred.take() else { return Ok(()) };
        if let Some(next) = &next {
            deferred.stop_before(&self.robot, next);
        }
        let joined = next.as_deref().filter(|next| deferred.goes_on(&self.robot, next));
        let goes_on = joined.is_some();
        let (plain, before) = deferred.plan(&self.robot, joined)?;
        let end = *plain.end();
        let last = self.last_ahead();
        let flows_from = last.filter(|_| plain.flows);
        let beginning = OverlayStart {
            start: flows_from.map_or(&self.layer.end, Motion::end),
            before: &self.layer.compensation_state.for_next(deferred.settings(), &deferred.command().rig),
            flows_from,
            goes_on: joined.is_some_and(|next| deferred.weaves_on(next)),
        };
        let motion = deferred.laid(&self.robot, plain, &beginning)?;
        self.append(motion, deferred.number);
        self.note_released(deferred.number);
        match next {
            Some(next) if goes_on => next.goes_on_from(&end, before),
            Some(next) => next.goes_on_from(&self.plain_end(next.command(), next.settings())?, None),
            None => {}
        }
        Ok(())
    }

    /// Where the last motion ends, as the start of the next one's own path: without a compensation that continues.
    fn plain_end(&self, command: &Command, settings: &Settings) -> Result<Joints, PlanError> {
        without_compensation(
            &self.robot,
            &self.layer.end,
            &self.layer.compensation_state.for_next(settings, &command.rig),
            command,
        )
    }

    pub(super) fn append(&mut self, motion: Motion, number: u64) {
        self.layer.end = *motion.end();
        self.layer.last_rig = motion.rig;
        self.layer.compensation_state = motion.compensation_state();
        self.forecast = None;
        let share = motion.share_of_speed();
        if share < self.notices.slowed.0 {
            self.notices.slowed = (share, motion.line);
        }
        self.enqueue(motion, number);
    }

    /// Releases a motion that waits for the next one while the robot is at rest, where it can be the last one of its
    /// path.
    pub(super) fn release_after_wait(&mut self, dt: f64) {
        let starves = self.layer.path.is_empty() && self.layer.deferred.as_ref().is_some_and(DeferredMotion::can_end);
        self.look_ahead.waited = if starves { self.look_ahead.waited + dt } else { 0.0 };
        if self.look_ahead.waited >= LONGEST_WAIT_FOR_NEXT_S
            && let Err(error) = self.release(None)
        {
            self.notices.broken = Some(error);
        }
    }
}
