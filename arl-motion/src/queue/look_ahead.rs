//! Motions that are planned and wait to be laid on the path.
//!
//! Blends take long to find, so a thread is given some time for them where the robot does not need the motion
//! meanwhile. How much time that is depends on the path alone, never on the thread.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::blend::zone::asks;
use crate::junction::blend_thread::{BlendThread, Joining, Prepared};
use crate::junction::{Junction, MotionPair};
use crate::plan::motion::Motion;
use crate::queue::path_buffer::limit_rise;
use crate::queue::{LOOK_AHEAD_S, Queue};

/// The longest time, in s, for finding a blend.
const LONGEST_WAIT_S: f64 = 0.05;
/// The waiting time as a share of the time after which the robot may have to brake without the motion; and the shortest
/// waiting time, in s.
const WAITED_SHARE_OF_SPARE_TIME: f64 = 0.5;
const LEAST_WAIT_S: f64 = 0.003;
/// The shortest waiting time, in s, where the robot moves and further laws may have to decide whether a blend saves
/// time.
const LEAST_WAIT_BESIDE_LAW_S: f64 = 0.02;
/// Limits of the number of motions in a cycle, so that no cycle takes long: motions that can always be laid and taken
/// from the program; motions while not enough path is ahead; short motions, whose blends a thread finds, while the
/// robot is at rest. As many motions as the robot may cover in `CYCLES_WORTH_OF_MOTIONS` cycles are always possible.
const LEAST_MOTIONS_A_CYCLE: u32 = 2;
const MOST_MOTIONS_A_CYCLE: u32 = 4;
const SHORT_MOTIONS_A_CYCLE_AT_REST: u32 = 16;
const CYCLES_WORTH_OF_MOTIONS: f64 = 2.0;
/// A robot at rest does not start along motions shorter than this, in s at full speed, before enough of them are ahead:
/// one acceleration then holds for all of them, and it could no longer be lowered while the robot speeds up.
const SHORT_MOTION_S: f64 = 0.02;
/// Enough path ahead, in s at full speed; and the same where laws look along it.
const ENOUGH_AHEAD_S: f64 = 0.5;
const ENOUGH_AHEAD_FOR_LAWS_S: f64 = 5.0;
/// How long, in s, a robot at rest waits for motions that come cycle by cycle, or for their blends, and how much path
/// ahead, in s at full speed, ends this. Then the same where the motions are short: laws along very many of them leave
/// some open, for which there has to be room.
const GATHERING_S: (f64, f64) = (0.05, ENOUGH_AHEAD_FOR_LAWS_S);
const GATHERING_OF_DENSE_CHAIN_S: (f64, f64) = (0.5, 0.9);

/// A motion that waits.
#[derive(Clone, Debug)]
pub(crate) struct Ready {
    pub(crate) motion: Arc<Motion>,
    pub(crate) number: u64,
    /// The cycle in which it is laid; 0 means at once.
    due: u64,
    pub(crate) prepared: Option<Prepared>,
}

/// The motions that wait, in order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Waiting {
    motions: VecDeque<Ready>,
    /// Their duration, in s at full speed.
    duration: f64,
}

/// Motions that had to wait for their blends when they were due, in real time.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LateBlends {
    /// Number of these motions.
    pub(crate) count: u64,
    /// Number of the last of them.
    last: u64,
}

impl LateBlends {
    fn note(&mut self, number: u64) {
        if number > self.last {
            *self = Self { count: self.count + 1, last: number };
        }
    }
}

/// State of planning ahead.
#[derive(Clone, Debug)]
pub(crate) struct LookAhead {
    /// Finds the blends of motions that wait.
    blend_thread: BlendThread,
    pub(crate) late_blends: LateBlends,
    /// Whether cycles run in real time.
    pub(crate) in_real_time: bool,
    /// Number of the current cycle.
    cycles: u64,
    /// What was planned in this cycle.
    taken: Done,
    /// How long, in s, the robot can continue without the motions that wait, where that is known.
    spare: Option<f64>,
    /// How long, in s, the robot has been at rest for a motion that is held back.
    pub(crate) waited: f64,
    /// How long, in s, the robot has been at rest while motions came.
    waited_for_motion: f64,
}

impl Default for LookAhead {
    fn default() -> Self {
        Self {
            blend_thread: BlendThread::default(),
            late_blends: LateBlends::default(),
            in_real_time: false,
            cycles: 1,
            taken: Done::default(),
            spare: None,
            waited: 0.0,
            waited_for_motion: 0.0,
        }
    }
}

/// Work done in a cycle: the number of motions, and their duration in s at full speed.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Done {
    count: u32,
    duration: f64,
}

impl Done {
    fn add(&mut self, motion: &Motion) {
        self.count += 1;
        self.duration += duration(motion);
    }

    /// Whether this is `count` motions, and enough of the path for a cycle of `cycle` s.
    fn suffices(&self, cycle: f64, count: u32) -> bool {
        self.count >= count && self.duration >= CYCLES_WORTH_OF_MOTIONS * cycle
    }
}

/// The duration of a motion in s at full speed.
fn duration(motion: &Motion) -> f64 {
    if motion.goes() { 1.0 / motion.rate } else { 0.0 }
}

impl Waiting {
    pub(crate) fn is_empty(&self) -> bool {
        self.motions.is_empty()
    }

    pub(crate) fn first(&self) -> Option<&Ready> {
        self.motions.front()
    }

    pub(crate) fn last(&self) -> Option<&Motion> {
        self.motions.back().map(|ready| &*ready.motion)
    }

    pub(crate) fn pop(&mut self) -> Option<Ready> {
        let first = self.motions.pop_front()?;
        // Rounding errors must not accumulate.
        self.duration = if self.motions.is_empty() { 0.0 } else { self.duration - duration(&first.motion) };
        Some(first)
    }

    pub(crate) fn clear(&mut self) {
        self.motions.clear();
        self.duration = 0.0;
    }

    /// The motions that are due.
    pub(crate) fn due(&self, cycle: u64) -> impl Iterator<Item = &Ready> {
        self.motions.iter().take_while(move |ready| ready.due <= cycle)
    }

    fn push(&mut self, ready: Ready) {
        self.duration += duration(&ready.motion);
        self.motions.push_back(ready);
    }

    /// Makes all motions due at once.
    fn lay_at_once(&mut self) {
        self.motions.iter_mut().for_each(|ready| ready.due = 0);
    }
}

impl Queue {
    /// Whether so little path is ahead that more than the motions that can always wait may be added.
    pub(crate) fn is_short_of_path(&self) -> bool {
        // Motions may wait for a law.
        let lays = self.layer.waiting.is_empty() || !(self.layer.path.is_asking() || self.layer.path.is_laid_down());
        lays && self.time_ahead() < LOOK_AHEAD_S
    }

    /// Whether so many motions were planned in this cycle that the next one can wait for the next cycle, which must
    /// come in time.
    pub(crate) fn has_planned_enough(&self) -> bool {
        let enough = if self.layer.path.wants_laws() { ENOUGH_AHEAD_FOR_LAWS_S } else { ENOUGH_AHEAD_S };
        let can_wait = || {
            self.look_ahead.spare.unwrap_or_else(|| self.layer.path.spare())
                >= LEAST_WAIT_S / WAITED_SHARE_OF_SPARE_TIME
        };
        let is_short_of_path = self.time_ahead() < enough || !can_wait();
        let path = &self.layer.path;
        let count = if path.rests() && path.wants_laws() && self.is_dense() {
            SHORT_MOTIONS_A_CYCLE_AT_REST
        } else if is_short_of_path {
            MOST_MOTIONS_A_CYCLE
        } else {
            LEAST_MOTIONS_A_CYCLE
        };
        self.look_ahead.taken.suffices(self.cycle, count)
    }

    /// Whether the motion added last is short.
    fn is_dense(&self) -> bool {
        self.last_ahead().is_some_and(|last| duration(last) < SHORT_MOTION_S)
    }

    /// The motion added last, if it has not been executed yet.
    pub(crate) fn last_ahead(&self) -> Option<&Motion> {
        self.layer.waiting.last().or_else(|| self.layer.path.last().map(|motion| &**motion))
    }

    /// The path ahead, in s at full speed.
    fn time_ahead(&self) -> f64 {
        self.layer.path.time_left() + self.layer.waiting.duration
    }

    /// Appends a motion to those that wait, and lays the motions that are due.
    pub(crate) fn enqueue(&mut self, motion: Motion, number: u64) {
        self.look_ahead.taken.add(&motion);
        let motion = limit_rise(motion, self.cycle);
        let (due, prepared) = self.begin_to_prepare(&motion);
        self.layer.waiting.push(Ready { motion, number, due, prepared });
        self.lay_waiting();
    }

    /// Starts to find how a motion is joined to the one before it, if that takes long and there is time. Returns the
    /// cycle in which the motion is laid.
    fn begin_to_prepare(&mut self, motion: &Arc<Motion>) -> (u64, Option<Prepared>) {
        let time = (WAITED_SHARE_OF_SPARE_TIME * self.spare()).min(LONGEST_WAIT_S);
        let before = self.layer.waiting.motions.iter().rev().find(|ready| ready.motion.goes());
        let on_path = self.layer.path.last().filter(|_| !self.layer.path.is_empty());
        let Some(last) = before.map(|ready| &ready.motion).or(on_path) else { return (0, None) };
        // What is laid over a motion depends on how the motions before it have been laid.
        let overlaid = motion.laid.is_some() || last.laid.is_some();
        let is_short = duration(motion) < SHORT_MOTION_S;
        let follows_laws = self.layer.path.wants_laws();
        let is_blended = !overlaid && motion.goes() && !motion.flows && asks(&self.robot, last);
        let mut hurries = if follows_laws {
            // What comes behind a motion that waits for its blend has to wait, too.
            self.layer.path.rests() && !is_short && before.is_none()
        } else {
            time < LEAST_WAIT_S || (is_short && self.layer.path.rests() && self.layer.path.time_left() < ENOUGH_AHEAD_S)
        };
        // The motion may nevertheless have to wait for a law, or behind a motion whose blend is late.
        let is_late = |first: &Ready| first.due <= self.look_ahead.cycles && !self.is_prepared(first);
        let is_blocked = self.layer.waiting.first().is_some_and(is_late);
        let waits = is_blocked || self.layer.path.is_asking() || self.layer.path.is_laid_down();
        if follows_laws && hurries && is_blended && !waits {
            let pair = MotionPair { before: self.layer.path.before(), from: Arc::clone(last), to: Arc::clone(motion) };
            match Junction::find_quickly(&self.robot, pair) {
                Some(junction) => return (0, Some(junction.into())),
                None => hurries = false,
            }
        }
        let prepared = (is_blended && (waits || !hurries)).then(|| {
            let joining = match before {
                Some(Ready { prepared: Some(prepared), .. }) => Joining::Behind(prepared.clone()),
                Some(_) => Joining::Known(None),
                None => Joining::Known(self.layer.path.before()),
            };
            self.look_ahead.blend_thread.prepare(&self.robot, joining, [last, motion])
        });
        if overlaid || (hurries && !waits) {
            self.layer.waiting.lay_at_once();
            return (0, prepared);
        }
        let time = match (is_blended, follows_laws && !is_short) {
            (false, _) => 0.0,
            (true, false) => time.max(LEAST_WAIT_S),
            // A robot at rest can wait longer if necessary.
            (true, true) if self.layer.path.rests() => LEAST_WAIT_S,
            (true, true) => time.max(LEAST_WAIT_BESIDE_LAW_S),
        };
        (self.look_ahead.cycles + (time / self.cycle) as u64, prepared)
    }

    /// See [`crate::queue::path_buffer::PathBuffer::spare`].
    fn spare(&mut self) -> f64 {
        *self.look_ahead.spare.get_or_insert_with(|| self.layer.path.spare())
    }

    /// Whether a robot at rest waits one more cycle because motions come, or blends are being found, along which laws
    /// can then lead from the start: otherwise the current law would have to be found again for each of them, and the
    /// last ones might come too late.
    pub(crate) fn waits_for_motion(&mut self, cycle: f64) -> bool {
        let path = &self.layer.path;
        let is_open = || self.layer.deferred.is_some() || self.last_ahead().is_some_and(|last| asks(&self.robot, last));
        let comes_more = || !self.layer.concluded && is_open();
        let (longest, enough) = if self.is_dense() { GATHERING_OF_DENSE_CHAIN_S } else { GATHERING_S };
        let comes = || self.look_ahead.taken.count > 0 && comes_more();
        // No law leads along motions before their blends are found.
        let waits = || !(self.layer.waiting.is_empty() || path.is_asking());
        let may = self.look_ahead.waited_for_motion < longest
            && path.rests()
            && path.wants_laws()
            && path.time_left() < enough;
        let waits_for_motion = may && (comes() || waits());
        self.look_ahead.waited_for_motion =
            if waits_for_motion { self.look_ahead.waited_for_motion + cycle } else { 0.0 };
        waits_for_motion
    }

    /// Begins a cycle.
    pub(crate) fn count_cycle(&mut self) {
        self.look_ahead.cycles += 1;
        self.look_ahead.taken = Done::default();
        self.look_ahead.spare = None;
    }

    /// Whether a motion can be laid without waiting for the blend that leads to it, where that matters. The robot does
    /// not continue without the blend while there is path ahead; at the end of the path it needs none.
    fn is_prepared(&self, ready: &Ready) -> bool {
        !self.look_ahead.in_real_time
            || self.layer.path.is_empty()
            || ready.prepared.as_ref().is_none_or(Prepared::is_ready)
    }

    /// Lays the motions that are due on the path, as soon as the path can take them: a few per cycle, except those in a
    /// hurry and those for which a robot is at rest.
    pub(crate) fn lay_waiting(&mut self) {
        let mut laid = Done::default();
        let stands = self.layer.path.rests() && self.layer.path.wants_laws();
        while let Some(first) = self.layer.waiting.first() {
            let hurries = first.due == 0 || self.layer.path.is_empty();
            let is_due =
                first.due <= self.look_ahead.cycles && (stands || !laid.suffices(self.cycle, LEAST_MOTIONS_A_CYCLE));
            if self.layer.path.is_asking() || !(hurries || is_due) {
                return;
            }
            if !self.is_prepared(first) {
                self.look_ahead.late_blends.note(first.number);
                return;
            }
            laid.add(&first.motion);
            self.look_ahead.spare = None;
            self.forecast = None;
            if self.layer.path.is_laid_down() {
                let prepared =
                    self.layer.waiting.due(self.look_ahead.cycles).take_while(|ready| self.is_prepared(ready)).count();
                if let Some(late) = self.layer.waiting.due(self.look_ahead.cycles).nth(prepared) {
                    self.look_ahead.late_blends.note(late.number);
                }
                let due = self.layer.waiting.due(self.look_ahead.cycles).take(prepared);
                let motions = due.map(|ready| (&ready.motion, ready.number, ready.prepared.as_ref()));
                self.layer.path.offer(&self.robot, &self.commanded.joints, motions, self.cycle);
                self.take_answer();
            } else if let Some(Ready { motion, number, prepared, .. }) = self.layer.waiting.pop() {
                let unblended = self.layer.path.append(&self.robot, &motion, number, prepared.as_ref(), self.cycle);
                self.note_laid(&motion, number, unblended);
            }
        }
    }
}

#[cfg(test)]
impl Queue {
    /// Makes the thread never find anything.
    pub(crate) fn prepare_nothing(&mut self) {
        self.look_ahead.blend_thread = BlendThread::stuck();
    }

    /// Makes all threads never find anything.
    pub(crate) fn find_nothing(&mut self) {
        self.prepare_nothing();
        self.layer.path.find_no_laws();
    }

    /// Waits until the law that is being sought is found.
    pub(crate) fn await_law(&self) {
        self.layer.path.await_law();
    }

    /// Waits until the thread has found everything.
    pub(crate) fn await_prepared(&self) {
        self.layer.waiting.motions.iter().filter_map(|ready| ready.prepared.as_ref()).for_each(Prepared::wait);
    }
}
