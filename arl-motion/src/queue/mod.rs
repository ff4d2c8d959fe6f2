//! The look-ahead and the interpolator: motions wait in a queue, and each cycle moves along the first one.

mod look_ahead;
mod motion_progress;
mod path_buffer;
mod record;
mod suspend;

use std::sync::Arc;

use crate::blend::blend_thread::BlendThread;
use crate::command::error::PlanError;
use crate::command::joints::Joints;
use crate::command::{Command, Settings, Target};
use crate::follow::governor::Pacing;
use crate::overlay::Led;
use crate::plan::chain::Held;
use crate::plan::gate;
use crate::plan::lay_overlay::Beginning;
use crate::plan::motion::Motion;
use crate::plan::planner::{not_led, plan_behind};
use arl_robot::frames::Rig;
use arl_robot::kinematics::Frame;
use arl_robot::robot::Robot;
use look_ahead::{Done, Ready, Waiting};
pub use motion_progress::Progress;
use motion_progress::progress_at;
pub use path_buffer::UnblendedTarget;
use path_buffer::{Answer, PathBuffer};
pub use record::{Closest, Figure, Limited, MotionRecord, Rate, Recorder};
pub use suspend::Start;
use suspend::Suspension;

/// How many motions can always wait, the one being executed not counted.
pub const LOOK_AHEAD: usize = 64;
/// As many motions wait at the very most.
const MOST_MOTIONS_AHEAD: u64 = 8192;
/// The way ahead, in s at full speed, beyond which no more than [`LOOK_AHEAD`] motions wait.
const LOOK_AHEAD_S: f64 = 3.0;

/// How to come to rest on the path.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Stop {
    /// With the limits of the motion.
    General,
    /// With five times the acceleration and jerk.
    Fast,
}

/// How long the robot stands still, in s, before a motion that waits for the next one of its way goes without it.
const LONGEST_WAIT_FOR_NEXT_S: f64 = 0.1;
/// How much harder a fast stop is.
const FAST_STOP_FACTOR: f64 = 5.0;

/// What one cycle did.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Step {
    /// The commanded positions.
    pub joints: Joints,
    /// The TCP in the world, with the tool and the base of the motion that is or was last executed, translation in mm.
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

/// The motions of one robot, planned ahead and executed cycle by cycle.
#[derive(Clone, Debug)]
pub struct Queue {
    robot: Arc<Robot>,
    path: PathBuffer,
    stop: Option<Stop>,
    /// Whether a fast stop is on its way to rest.
    braking_hard: bool,
    dropping: bool,
    joints: Joints,
    /// Where the last motion ends.
    end: Joints,
    rig: Rig,
    last_rig: Rig,
    added: u64,
    finished: u64,
    /// The motion being executed.
    started: Option<u64>,
    /// The motion whose time counts, and the s that it has run at an override of 100 %.
    timed: u64,
    elapsed: f64,
    /// The s that the motion being executed still takes, and for how many cycles that has been counted down.
    foreseen: Option<(u64, f64, u32)>,
    progress: Option<Progress>,
    /// How far motions had come that were left behind in the last cycle.
    left: Vec<Progress>,
    /// The last motion that is not executed any more: it has ended, or a blend leads away from it.
    over: u64,
    cycle: f64,
    /// The last target that was not rounded off because a motion came too late, and the last beside which there is no way.
    late: Option<UnblendedTarget>,
    unblended: Option<UnblendedTarget>,
    /// Motions that wait until they are laid on the path.
    waiting: Waiting,
    /// Who finds their blends.
    blend_thread: BlendThread,
    /// How many cycles there have been, and what was planned in this one.
    cycles: u64,
    taken: Done,
    /// How long the robot can go on without them, where that is known.
    spare: Option<f64>,
    /// The last motion, where its way depends on the next one.
    held: Option<Held>,
    /// How long the robot has stood still for it, in s.
    waited: f64,
    broken: Option<PlanError>,
    /// What was laid on the way, where somebody watches.
    laid: Option<Vec<Laid>>,
    /// How a compensation stands at the end of the last motion.
    led: Led,
    /// The least part of its speed that what is laid over it has left to a motion, and that motion's line.
    slowed: (f64, u32),
    suspension: Suspension,
}

/// A motion that was laid on the way.
#[derive(Clone, Debug)]
pub(crate) struct Laid {
    pub(crate) number: u64,
    pub(crate) motion: Arc<Motion>,
    /// The motion that is blended with it, and the share at which that one is left.
    pub(crate) left: Option<(u64, f64)>,
}

impl Queue {
    /// An empty queue of a robot that rests at `start`.
    pub fn new(robot: Arc<Robot>, start: Joints) -> Self {
        Self {
            robot,
            path: PathBuffer::default(),
            stop: None,
            braking_hard: false,
            dropping: false,
            joints: start,
            end: start,
            rig: Rig::bare(),
            last_rig: Rig::bare(),
            added: 0,
            finished: 0,
            started: None,
            timed: 0,
            elapsed: 0.0,
            foreseen: None,
            progress: None,
            left: Vec::with_capacity(LOOK_AHEAD),
            over: 0,
            cycle: 0.001,
            late: None,
            unblended: None,
            waiting: Waiting::default(),
            blend_thread: BlendThread::default(),
            cycles: 1,
            taken: Done::default(),
            spare: None,
            held: None,
            waited: 0.0,
            broken: None,
            laid: None,
            led: Led::default(),
            slowed: (1.0, 0),
            suspension: Suspension::default(),
        }
    }

    /// The robot that moves.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Whether another motion can be added: up to [`LOOK_AHEAD`] always, then as long as the way ahead is shorter than what
    /// stopping may take.
    pub fn has_room(&self) -> bool {
        let executing = u64::from(self.started == Some(self.finished + 1));
        let waiting = (self.unfinished() as u64).saturating_sub(executing);
        waiting < LOOK_AHEAD as u64 || (waiting < MOST_MOTIONS_AHEAD && self.is_short_of_way())
    }

    /// Plans a motion from the end of the last one and appends it; returns its running number, from 1. A motion whose way
    /// depends on the next one waits for that one, or for [`Queue::conclude`].
    ///
    /// # Errors
    /// The motion cannot be planned, or the one before it cannot now that this one is known ([`PlanError::Earlier`]), or
    /// there is no room, or dropped motions have not come to rest yet. It was not added.
    pub fn add(&mut self, command: &Command, settings: &Settings) -> Result<u64, PlanError> {
        if self.dropping {
            return Err(PlanError::Stopping);
        }
        if !self.has_room() {
            return Err(PlanError::Full);
        }
        self.add_as(command, settings, self.added + 1)?;
        self.added += 1;
        Ok(self.added)
    }

    /// Plans a motion and appends it under a number.
    fn add_as(&mut self, command: &Command, settings: &Settings, number: u64) -> Result<(), PlanError> {
        let from = *self.end();
        let start = match &self.held {
            Some(held) => *held.end(),
            None if command.target.chained().is_some() => self.plain_end(command, settings)?,
            None => self.end,
        };
        let mut next = Held::new(&self.robot, &start, command, settings, number)?;
        self.release(next.as_mut())?;
        if next.is_some() {
            self.held = next;
        } else if matches!(command.target, Target::Gate { .. }) {
            for motion in gate::plan(&self.robot, &self.end, command, settings)? {
                self.append(motion, number);
            }
        } else {
            let motion = plan_behind(&self.robot, &self.end, &self.led, command, settings)?;
            self.append(motion, number);
        }
        self.note_asked(number, from, command, settings);
        Ok(())
    }

    /// From now on notes the motions that are laid on the way, for [`Queue::take_laid`].
    pub(crate) fn watch(&mut self) {
        self.laid = Some(Vec::new());
    }

    /// The motions that were laid on the way since this was asked last.
    pub(crate) fn take_laid(&mut self) -> Vec<Laid> {
        self.laid.as_mut().map_or_else(Vec::new, std::mem::take)
    }

    /// Says that no motion will come soon: one that waited for the next goes without it.
    ///
    /// # Errors
    /// It cannot be moved without a next one ([`PlanError::Earlier`]). It was dropped.
    pub fn conclude(&mut self) -> Result<(), PlanError> {
        self.release(None)
    }

    /// What was wrong with a motion that had waited in vain for the next one, since this was asked last.
    pub fn take_broken(&mut self) -> Option<PlanError> {
        self.broken.take()
    }

    /// Plans the motion that waits, before the next one where there is one.
    fn release(&mut self, next: Option<&mut Held>) -> Result<(), PlanError> {
        let Some(mut held) = self.held.take() else { return Ok(()) };
        if let Some(next) = &next {
            held.stop_before(&self.robot, next);
        }
        let joined = next.as_deref().filter(|next| held.goes_on(&self.robot, next));
        let goes_on = joined.is_some();
        let (plain, before) = held.plan(&self.robot, joined)?;
        let end = *plain.end();
        let last = self.waiting.last().or_else(|| self.path.last().map(|motion| &**motion));
        let flows_from = last.filter(|_| plain.flows);
        let beginning = Beginning {
            start: flows_from.map_or(&self.end, Motion::end),
            before: &self.led.for_next(held.settings(), &held.command().rig),
            flows_from,
            goes_on: joined.is_some_and(|next| held.weaves_on(next)),
        };
        let motion = held.laid(&self.robot, plain, &beginning)?;
        self.append(motion, held.number);
        self.note_released(held.number);
        match next {
            Some(next) if goes_on => next.goes_on_from(&end, before),
            Some(next) => next.goes_on_from(&self.plain_end(next.command(), next.settings())?, None),
            None => {}
        }
        Ok(())
    }

    /// Where the last motion on the way ends, as the next one's own way begins: without a compensation that goes on.
    fn plain_end(&self, command: &Command, settings: &Settings) -> Result<Joints, PlanError> {
        not_led(&self.robot, &self.end, &self.led.for_next(settings, &command.rig), command)
    }

    fn append(&mut self, motion: Motion, number: u64) {
        self.end = *motion.end();
        self.last_rig = motion.rig;
        self.led = motion.led();
        self.foreseen = None;
        let share = motion.share_of_speed();
        if share < self.slowed.0 {
            self.slowed = (share, motion.line);
        }
        self.enqueue(motion, number);
    }

    /// Does what the path says about motions that it was offered.
    fn take_answer(&mut self) {
        match self.path.take_answer() {
            Some(Answer::Taken { unblended, count }) => {
                self.note_unblended(unblended);
                for _ in 0..count {
                    if let Some(taken) = self.waiting.pop() {
                        self.note_laid(&taken.motion, taken.number);
                    }
                }
            }
            Some(Answer::Refused) => {
                if let Some(Ready { motion, number, prepared, .. }) = self.waiting.pop() {
                    let motion = (&motion, number);
                    let unblended = self.path.append_behind_stop(&self.robot, motion, prepared.as_ref(), self.cycle);
                    self.note_unblended(unblended);
                    self.note_laid(motion.0, number);
                }
            }
            None => {}
        }
    }

    fn note_unblended(&mut self, unblended: impl IntoIterator<Item = UnblendedTarget>) {
        for unblended in unblended {
            let of_its_kind = if unblended.corner.is_some() { &mut self.unblended } else { &mut self.late };
            *of_its_kind = Some(unblended);
        }
    }

    fn note_laid(&mut self, motion: &Arc<Motion>, number: u64) {
        if let Some(laid) = &mut self.laid {
            let left = self.path.left_before(number).filter(|_| motion.goes());
            laid.push(Laid { number, motion: Arc::clone(motion), left });
        }
    }

    /// Lets a motion go that waits while the robot stands still, where it can be the last one of its way.
    fn release_after_wait(&mut self, dt: f64) {
        let starves = self.path.is_empty() && self.held.as_ref().is_some_and(Held::can_end);
        self.waited = if starves { self.waited + dt } else { 0.0 };
        if self.waited >= LONGEST_WAIT_FOR_NEXT_S
            && let Err(error) = self.release(None)
        {
            self.broken = Some(error);
        }
    }

    /// The motion that came too late, since this was asked last, to be blended with the one before it, so that the robot
    /// stopped or will stop between the two.
    pub fn take_late(&mut self) -> Option<UnblendedTarget> {
        self.late.take()
    }

    /// A target, since this was asked last, that should be rounded off but is reached with a stop: beside it the robot would
    /// leave its reach or an axis's range, or meet a singular point, however small the zone.
    pub fn take_unblended(&mut self) -> Option<UnblendedTarget> {
        self.unblended.take()
    }

    /// The least part of its programmed speed, 0 to 1, that a weave or a compensation has left to a motion since this was
    /// asked last, and that motion's program line.
    pub fn take_slowed(&mut self) -> (f64, u32) {
        std::mem::replace(&mut self.slowed, (1.0, 0))
    }

    /// Where the last motion of the queue ends: where the next one starts.
    pub fn end(&self) -> &Joints {
        self.held.as_ref().map_or(&self.end, Held::end)
    }

    /// The commanded positions now.
    pub fn joints(&self) -> &Joints {
        &self.joints
    }

    /// The TCP now in the world, with the tool and the base of the motion that is or was last executed, translation in mm.
    pub fn tcp(&self) -> Frame {
        self.rig.tcp_at(&self.robot.kinematics.forward(&self.joints.axes))
    }

    /// Whether no motion is there, running, waiting or set aside.
    pub fn idle(&self) -> bool {
        self.is_layer_idle() && self.suspension.is_clear()
    }

    /// The running number of the motion that is executed, or comes next; `None` where none is laid.
    pub fn current(&self) -> Option<u64> {
        self.path.current().map(|(segment, _)| segment.number)
    }

    /// Whether the robot stands still, at the end of a motion or within one.
    pub fn rests(&self) -> bool {
        self.path.rests()
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
    /// rest. Without a stop it goes on to the next target that it reaches exactly first.
    pub fn clear(&mut self) {
        self.suspension.clear();
        self.path.keep_to_stop();
        self.waiting.clear();
        self.held = None;
        self.dropping = true;
        self.drop_at_rest();
    }

    /// Puts the commanded positions elsewhere, as when a robot is switched on; returns whether it could: not while there
    /// are motions.
    pub fn place(&mut self, joints: Joints) -> bool {
        let idle = self.is_layer_idle() && self.rests();
        if idle {
            (self.joints, self.end) = (joints, joints);
            self.led = Led::default();
        }
        idle
    }

    /// The running number of the last motion that is not executed any more: it has ended, or a blend leads away from it.
    pub fn over(&self) -> u64 {
        self.over
    }

    /// Where the motion ends that is being executed, or else the next one.
    pub fn target(&self) -> &Joints {
        self.path.current().map_or(&self.end, |(segment, _)| segment.target())
    }

    /// What the robot carries in the motion that is or was last executed, and where it stands.
    pub fn rig(&self) -> &Rig {
        &self.rig
    }

    /// Moves on by one cycle of `dt` s at an override of `override_percent`, 0 to 100. A motion that is not blended with the
    /// next one ends exactly at its target, and the next one starts with the cycle after.
    pub fn step(&mut self, dt: f64, override_percent: f64) -> Step {
        self.cycle = dt;
        self.count_cycle();
        self.left.clear();
        let speed = if override_percent > 0.0 { override_percent.min(100.0) / 100.0 } else { 0.0 };
        let stop = if self.stop == Some(Stop::Fast) { self.stop } else { self.suspension.stop().or(self.stop) };
        let pacing = match stop {
            Some(Stop::Fast) => Pacing::Stop(FAST_STOP_FACTOR),
            Some(Stop::General) => Pacing::Stop(1.0),
            None if speed > 0.0 => Pacing::Go(speed),
            None => Pacing::Stop(1.0),
        };
        self.braking_hard = match (pacing, self.path.rests()) {
            (_, true) => false,
            (Pacing::Stop(harder), false) => self.braking_hard || harder > 1.0,
            (Pacing::Go(_) | Pacing::Settle(_), false) => self.braking_hard,
        };
        // A fast stop is carried through to rest: from its acceleration nothing else would be within the limits.
        let pacing = if self.braking_hard { Pacing::Stop(FAST_STOP_FACTOR) } else { pacing };
        let rested = self.path.rests();
        let (mut motion, mut line) = (0, 0);
        let waits = rested && matches!(pacing, Pacing::Stop(_));
        if !waits && !self.path.is_empty() {
            let before = (self.started, self.rig, self.timed, self.elapsed);
            if let Some(segment) = self.path.first() {
                (motion, line) = self.enter(segment.number, segment.line, segment.rig);
            }
            let passed = if matches!(pacing, Pacing::Go(_)) { dt * speed } else { 0.0 };
            self.time(passed);
            let (mut arrived, mut finished) = (None, self.finished);
            let stands = self.path.advance((&self.robot, &self.joints), dt, pacing, |passed| {
                finished = if passed.ends { passed.number } else { finished };
                if !passed.leaves() {
                    let elapsed = if passed.number == self.timed { self.elapsed } else { 0.0 };
                    self.left.push(progress_at(
                        &passed,
                        passed.share_at_end(),
                        passed.duration().unwrap_or(elapsed),
                        0.0,
                    ));
                }
                arrived = Some(passed);
            });
            self.finished = finished;
            let waits = rested && !stands && self.path.awaits_law();
            if waits {
                // The motion has not begun.
                (self.started, self.rig, self.timed, self.elapsed) = before;
                (motion, line) = (0, 0);
            }
            match (stands, &arrived, self.path.first()) {
                (true, Some(segment), _) => {
                    (motion, line) = (segment.number, segment.line);
                    self.joints = segment.joints(&self.robot.kinematics, segment.time, &self.joints);
                }
                _ if waits => {}
                (_, _, Some(segment)) => {
                    self.joints = segment.joints(&self.robot.kinematics, self.path.at(), &self.joints);
                    (motion, line) = (segment.number, segment.line);
                    let rig = segment.rig;
                    self.enter(motion, line, rig);
                }
                _ => {}
            }
            self.progress = match arrived.filter(|_| stands) {
                Some(segment) => Some(self.at_the_end_of(&segment)),
                None => self.on_the_way(if waits { 0.0 } else { passed }),
            };
        } else if self.path.rests() && self.path.at() == 0.0 {
            // It stands at a target and not on the way.
            self.progress = None;
        }
        self.take_answer();
        self.lay_waiting();
        self.end_empty();
        self.leave_behind();
        self.drop_at_rest();
        if !matches!(pacing, Pacing::Stop(_)) {
            self.release_after_wait(dt);
        }
        // What is taken up again brings its own tool along: from the next cycle on.
        let tcp = self.tcp();
        self.advance_suspension();
        Step { joints: self.joints, tcp, motion, line, finished: self.finished, rests: self.rests() }
    }

    /// Notes that a motion is being executed.
    fn enter(&mut self, number: u64, line: u32, rig: Rig) -> (u64, u32) {
        self.started = Some(number);
        self.rig = rig;
        (number, line)
    }

    /// Motions that go nowhere end when those before them have ended.
    fn end_empty(&mut self) {
        let anew = self.suspension.first_anew().unwrap_or(self.added + 1);
        let held = self.held.as_ref().map_or(anew, |held| held.number);
        let waiting = self.waiting.first().map_or(held, |ready| ready.number);
        let next = self.path.first().map_or(waiting, |segment| segment.number);
        self.finished = self.finished.max(next - 1);
        if self.path.is_empty() && self.waiting.is_empty() && !self.dropping {
            self.rig = self.last_rig;
        }
    }

    fn drop_at_rest(&mut self) {
        if self.dropping && self.rests() {
            self.finished = self.added;
            self.over = self.added;
            self.path.clear();
            self.end = self.joints;
            self.led = Led::default();
            self.started = None;
            self.progress = None;
            self.dropping = false;
            self.braking_hard = false;
        }
    }
}
