//! The look-ahead and the interpolator: motions wait in a queue, and each cycle moves along the first one.

mod elapsed;
mod layer;
mod look_ahead;
mod motion_progress;
mod path_buffer;
mod path_speed;
mod preview;
mod record;
mod step;
mod suspend;

use std::sync::Arc;

use crate::blend::no_blend::NoBlend;
use crate::command::check::check;
use crate::command::error::PlanError;
use crate::command::joints::Joints;
use crate::command::{Command, Cycle, Override, Settings, Target};
use crate::follow::governor::Pacing;
use crate::follow::segment::{PlainSpeed, Segment};
use crate::junction::blend_thread::BlendThread;
use crate::overlay::Led;
use crate::plan::chain::Held;
use crate::plan::gate;
use crate::plan::lay_overlay::OverlayStart;
use crate::plan::motion::Motion;
use crate::plan::planner::{not_led, plan_behind};
use arl_robot::frames::Rig;
use arl_robot::kinematics::Frame;
use arl_robot::robot::Robot;
use layer::Layer;
use look_ahead::{Done, LateBlends, Ready};
pub use motion_progress::Progress;
use motion_progress::progress_at;
pub use path_buffer::UnblendedTarget;
use path_buffer::{Leaving, OfferOutcome};
pub use preview::Preview;
pub use record::{Closest, Figure, Limited, MotionRecord, Rate, Recorder, SmallerZone};
pub use step::Step;
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

/// The motions of one robot, planned ahead and executed cycle by cycle.
#[derive(Clone, Debug)]
pub struct Queue {
    robot: Arc<Robot>,
    /// What moves the robot.
    layer: Layer,
    /// What was stopped and put away, and what is about to be.
    suspension: Suspension,
    stop: Option<Stop>,
    /// Whether a fast stop is on its path to rest.
    braking_hard: bool,
    dropping: bool,
    /// The commanded positions, and how fast they change.
    joints: Joints,
    velocity: Joints,
    /// Whether steps tell how fast the axes are.
    tells_rates: bool,
    /// The running number of the motion that was added last.
    added: u64,
    /// The s that the motion being executed still takes, and for how many cycles that has been counted down.
    forecast: Option<(u64, f64, u32)>,
    /// How far motions had come that were left behind in the last cycle.
    left: Vec<Progress>,
    /// The length of a cycle, in s, and whether cycles take the time that they stand for.
    cycle: f64,
    in_real_time: bool,
    /// Targets that are not rounded off though they should be, since somebody asked last; each once.
    unblended: Vec<UnblendedTarget>,
    /// Who finds the blends of motions that wait.
    blend_thread: BlendThread,
    late_blends: LateBlends,
    /// How many cycles there have been, and what was planned in this one.
    cycles: u64,
    taken: Done,
    /// How long the robot can go on without the motions that wait, where that is known.
    spare: Option<f64>,
    /// How long the robot has stood still, in s, for a motion that is held back.
    waited: f64,
    /// How long it has stood still, in s, while motions came.
    waited_for_motion: f64,
    broken: Option<PlanError>,
    /// What was laid on the way, where somebody watches.
    laid: Option<Vec<LaidMotion>>,
    /// The least part of its speed that what is laid over it has left to a motion, and that motion's line.
    slowed: (f64, u32),
}

/// A motion that was laid on the way.
#[derive(Clone, Debug)]
pub(crate) struct LaidMotion {
    pub(crate) number: u64,
    pub(crate) motion: Arc<Motion>,
    /// The motion that is blended with it.
    pub(crate) left: Option<Leaving>,
    /// Why it is not blended with the motion before it though that was asked for.
    pub(crate) unblended: Option<NoBlend>,
}

impl Queue {
    /// An empty queue of a robot that rests at `start`, for cycles in real time. No cycle waits for what threads find
    /// beside it (blends and time laws): the robot goes on with what it has, and comes to rest on its path where
    /// nothing more comes. So the set-points depend on the computer, too; [`Queue::found_late`] counts what came too
    /// late.
    pub fn new(robot: Arc<Robot>, start: Joints) -> Self {
        let mut queue = Self::repeatable(robot, start);
        queue.follow_real_time(true);
        queue
    }

    /// The same, for cycles that take as long as they take, as in simulation and planning: a cycle that needs a blend
    /// or a time law waits for it (30 ms and more at times), so that the same commands at the same cycles give the same
    /// set-points, to the last bit, on every machine.
    pub fn repeatable(robot: Arc<Robot>, start: Joints) -> Self {
        Self {
            robot,
            layer: Layer::resting_at(start),
            suspension: Suspension::default(),
            stop: None,
            braking_hard: false,
            dropping: false,
            joints: start,
            velocity: Joints::ZERO,
            tells_rates: true,
            added: 0,
            forecast: None,
            left: Vec::with_capacity(LOOK_AHEAD),
            cycle: 0.001,
            in_real_time: false,
            unblended: Vec::new(),
            blend_thread: BlendThread::default(),
            late_blends: LateBlends::default(),
            cycles: 1,
            taken: Done::default(),
            spare: None,
            waited: 0.0,
            waited_for_motion: 0.0,
            broken: None,
            laid: None,
            slowed: (1.0, 0),
        }
    }

    /// Says whether cycles take the time that they stand for from now on, as with [`Queue::new`], or wait as with
    /// [`Queue::repeatable`].
    pub fn follow_real_time(&mut self, in_real_time: bool) {
        self.in_real_time = in_real_time;
        self.layer.path.follow_real_time(in_real_time);
    }

    /// How many time laws and blends came too late, in real time; not those without which the robot went on as it would
    /// have with them.
    pub fn found_late(&self) -> u64 {
        self.layer.path.late_laws() + self.late_blends.count
    }

    /// The robot that moves.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Whether another motion can be added: up to [`LOOK_AHEAD`] always, then as long as the way ahead is shorter than
    /// what stopping may take.
    pub fn has_room(&self) -> bool {
        let executing = u64::from(self.layer.execution.started == Some(self.layer.finished + 1));
        let waiting = (self.unfinished() as u64).saturating_sub(executing);
        waiting < LOOK_AHEAD as u64 || (waiting < MOST_MOTIONS_AHEAD && self.is_short_of_way())
    }

    /// Plans a motion from the end of the last one and appends it; returns its running number, from 1. A motion whose
    /// path depends on the next one waits for that one, or for [`Queue::conclude`].
    ///
    /// # Errors
    /// The motion cannot be planned, or the one before it cannot now that this one is known ([`PlanError::Earlier`]),
    /// or there is no room, or dropped motions have not come to rest yet. It was not added.
    pub fn add(&mut self, command: &Command, settings: &Settings) -> Result<u64, PlanError> {
        if self.dropping {
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

    /// Plans a motion and appends it under a number.
    fn add_as(&mut self, command: &Command, settings: &Settings, number: u64) -> Result<(), PlanError> {
        self.layer.concluded = false;
        let from = *self.end();
        let start = match &self.layer.held {
            Some(held) => *held.end(),
            None if command.target.chained().is_some() => self.plain_end(command, settings)?,
            None => self.layer.end,
        };
        let mut next = Held::new(&self.robot, &start, command, settings, number)?;
        self.release(next.as_mut())?;
        if next.is_some() {
            self.layer.held = next;
        } else if matches!(command.target, Target::Gate { .. }) {
            for motion in gate::plan(&self.robot, &self.layer.end, command, settings)? {
                self.append(motion, number);
            }
        } else {
            let motion = plan_behind(&self.robot, &self.layer.end, &self.layer.led, command, settings)?;
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
    pub(crate) fn take_laid(&mut self) -> Vec<LaidMotion> {
        self.laid.as_mut().map_or_else(Vec::new, std::mem::take)
    }

    /// Says that no motion will come before the robot rests: one that waited for the next goes without it, and one
    /// alone goes off as if it had no zone. A motion that comes all the same is planned as any other.
    ///
    /// # Errors
    /// It cannot be moved without a next one ([`PlanError::Earlier`]). It was dropped.
    pub fn conclude(&mut self) -> Result<(), PlanError> {
        self.layer.concluded = true;
        self.release(None)
    }

    /// What was wrong with a motion that had waited in vain for the next one, since this was asked last.
    pub fn take_broken(&mut self) -> Option<PlanError> {
        self.broken.take()
    }

    /// Plans the motion that waits, before the next one where there is one.
    fn release(&mut self, next: Option<&mut Held>) -> Result<(), PlanError> {
        let Some(mut held) = self.layer.held.take() else { return Ok(()) };
        if let Some(next) = &next {
            held.stop_before(&self.robot, next);
        }
        let joined = next.as_deref().filter(|next| held.goes_on(&self.robot, next));
        let goes_on = joined.is_some();
        let (plain, before) = held.plan(&self.robot, joined)?;
        let end = *plain.end();
        let last = self.last_ahead();
        let flows_from = last.filter(|_| plain.flows);
        let beginning = OverlayStart {
            start: flows_from.map_or(&self.layer.end, Motion::end),
            before: &self.layer.led.for_next(held.settings(), &held.command().rig),
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
        not_led(&self.robot, &self.layer.end, &self.layer.led.for_next(settings, &command.rig), command)
    }

    fn append(&mut self, motion: Motion, number: u64) {
        self.layer.end = *motion.end();
        self.layer.last_rig = motion.rig;
        self.layer.led = motion.led();
        self.forecast = None;
        let share = motion.share_of_speed();
        if share < self.slowed.0 {
            self.slowed = (share, motion.line);
        }
        self.enqueue(motion, number);
    }

    /// Does what the path says about motions that it was offered.
    fn take_answer(&mut self) {
        match self.layer.path.take_answer() {
            Some(OfferOutcome::Taken { unblended, count }) => {
                for _ in 0..count {
                    if let Some(taken) = self.layer.waiting.pop() {
                        let of_it = unblended.iter().find(|target| target.number == taken.number);
                        self.note_laid(&taken.motion, taken.number, of_it.cloned());
                    }
                }
            }
            Some(OfferOutcome::Refused) => {
                if let Some(Ready { motion, number, prepared, .. }) = self.layer.waiting.pop() {
                    let motion = (&motion, number);
                    let unblended =
                        self.layer.path.append_behind_stop(&self.robot, motion, prepared.as_ref(), self.cycle);
                    self.note_laid(motion.0, number, unblended);
                }
            }
            None => {}
        }
    }

    /// Notes a motion that was laid on the way, and the target before it where that should be rounded off but is not.
    fn note_laid(&mut self, motion: &Arc<Motion>, number: u64, unblended: Option<UnblendedTarget>) {
        if let Some(laid) = &mut self.laid {
            let left = self.layer.path.left_before(number).filter(|_| motion.goes());
            let unblended = unblended.as_ref().map(|target| target.why.clone());
            laid.push(LaidMotion { number, motion: Arc::clone(motion), left, unblended });
        }
        if let Some(target) = unblended
            && !self.unblended.iter().any(|known| known.is_same(&target))
        {
            self.unblended.push(target);
        }
    }

    /// Lets a motion go that waits while the robot stands still, where it can be the last one of its way.
    fn release_after_wait(&mut self, dt: f64) {
        let starves = self.layer.path.is_empty() && self.layer.held.as_ref().is_some_and(Held::can_end);
        self.waited = if starves { self.waited + dt } else { 0.0 };
        if self.waited >= LONGEST_WAIT_FOR_NEXT_S
            && let Err(error) = self.release(None)
        {
            self.broken = Some(error);
        }
    }

    /// The targets, since this was asked last, that should be rounded off but are reached with a stop. Those of the
    /// same two program lines for the same reason count as one.
    pub fn take_unblended(&mut self) -> Vec<UnblendedTarget> {
        std::mem::take(&mut self.unblended)
    }

    /// The least part of its programmed speed, 0 to 1, that a weave or a compensation has left to a motion since this
    /// was asked last, and that motion's program line.
    pub fn take_slowed(&mut self) -> (f64, u32) {
        std::mem::replace(&mut self.slowed, (1.0, 0))
    }

    /// Where the last motion of the queue ends: where the next one starts.
    pub fn end(&self) -> &Joints {
        self.layer.held.as_ref().map_or(&self.layer.end, Held::end)
    }

    /// The commanded positions now.
    pub fn joints(&self) -> &Joints {
        &self.joints
    }

    /// The TCP now in the world, with the tool and the base of the motion that is or was last executed, translation in
    /// mm.
    pub fn tcp(&self) -> Frame {
        self.layer.execution.rig.tcp_at(&self.robot.kinematics.forward(&self.joints.axes))
    }

    /// Whether no motion is there, running, waiting or set aside.
    pub fn idle(&self) -> bool {
        self.is_layer_idle() && self.is_clear()
    }

    /// The running number of the motion that is executed, or comes next; `None` where none is laid.
    pub fn current(&self) -> Option<u64> {
        self.layer.path.current().map(|(segment, _)| segment.number)
    }

    /// Whether the robot stands still, at the end of a motion or within one.
    pub fn rests(&self) -> bool {
        self.layer.path.rests()
    }

    /// Whether it was told to stop, and neither to resume nor to drop its motions.
    pub fn stopped(&self) -> bool {
        self.stop.is_some()
    }

    /// Comes to rest on the path; motions stay in the queue until [`Queue::resume`]. A general stop does not soften a
    /// fast one.
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
        self.drop_added();
    }

    /// Drops the motions that were added since others were set aside in the same way; what is set aside stays.
    pub fn drop_added(&mut self) {
        self.layer.requests.clear();
        self.layer.path.keep_to_stop();
        self.layer.waiting.clear();
        self.layer.held = None;
        self.dropping = true;
        self.drop_at_rest();
    }

    /// Puts the commanded positions elsewhere, as when a robot is switched on; returns whether it could: not while
    /// there are motions, and not to what is not a number.
    pub fn place(&mut self, joints: Joints) -> bool {
        let idle = self.is_layer_idle() && self.rests() && joints.is_finite();
        if idle {
            (self.joints, self.layer.end) = (joints, joints);
            self.velocity = Joints::ZERO;
            self.layer.led = Led::default();
        }
        idle
    }

    /// The running number of the last motion that is not executed any more: it has ended, or a blend leads away from
    /// it.
    pub fn over(&self) -> u64 {
        self.layer.over
    }

    /// Where the motion ends that is being executed, or else the next one.
    pub fn target(&self) -> &Joints {
        self.layer.path.current().map_or(&self.layer.end, |(segment, _)| segment.target())
    }

    /// What the robot carries in the motion that is or was last executed, and where it stands.
    pub fn rig(&self) -> &Rig {
        &self.layer.execution.rig
    }

    /// Moves on by one cycle at an override. A motion that is not blended with the next one ends exactly at its target,
    /// and the next one starts with the cycle after.
    pub fn step(&mut self, cycle: Cycle, speed_override: Override) -> Step {
        let dt = cycle.period();
        self.cycle = dt;
        let waits_for_motion = self.waits_for_motion(dt);
        self.count_cycle();
        self.left.clear();
        let before = self.joints;
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
        // What is resumed brings its own tool along: from the next cycle on.
        let step = self.made_step((motion, line), &before, dt);
        self.advance_suspension();
        Step { finished: self.layer.finished, rests: self.rests(), ..step }
    }

    /// Whether steps tell velocities, accelerations and the speed of the TCP; they do unless this says otherwise.
    /// Whoever takes the positions alone saves what finding them costs: then they are 0.
    pub fn tell_rates(&mut self, wanted: bool) {
        if wanted != self.tells_rates {
            // It was not kept up.
            self.velocity = Joints::ZERO;
        }
        self.tells_rates = wanted;
    }

    /// The length of the last cycle, in s.
    pub(super) fn cycle(&self) -> f64 {
        self.cycle
    }

    /// The segment that the robot is on, and how fast it goes there where that is not a blend.
    pub(super) fn plain_speed(&self) -> Option<(&Segment, Option<PlainSpeed>)> {
        self.layer.path.plain_speed()
    }

    /// How much higher than those of the robot file the limits of acceleration and jerk were in the last cycle.
    pub(super) fn hardness(&self) -> f64 {
        if self.braking_hard { FAST_STOP_FACTOR } else { 1.0 }
    }

    /// How fast to go in this cycle, at an override of `speed`, 0 to 1. A fast stop is carried through to rest: from
    /// its acceleration nothing else would be within the limits.
    fn choose_pacing(&mut self, speed: f64) -> Pacing {
        let stop = if self.stop == Some(Stop::Fast) { self.stop } else { self.suspension.stop().or(self.stop) };
        let pacing = match stop {
            Some(Stop::Fast) => Pacing::Stop(FAST_STOP_FACTOR),
            Some(Stop::General) => Pacing::Stop(1.0),
            None if speed > 0.0 => Pacing::Go(speed),
            None => Pacing::Stop(1.0),
        };
        let is_hard = matches!(pacing, Pacing::Stop(stop_scale) if stop_scale > 1.0);
        self.braking_hard = !self.layer.path.rests() && (self.braking_hard || is_hard);
        if self.braking_hard { Pacing::Stop(FAST_STOP_FACTOR) } else { pacing }
    }

    /// Goes along the path for a cycle; returns the motion executed in it, and its line.
    fn advance(&mut self, dt: f64, speed: f64, pacing: Pacing) -> (u64, u32) {
        let rested = self.layer.path.rests();
        let is_held = rested && matches!(pacing, Pacing::Stop(_));
        let Some(first) = self.layer.path.first().filter(|_| !is_held) else {
            if rested && self.layer.path.at() == 0.0 {
                // It stands at a target and not on the way.
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
            None => self.progress_on_way(passed),
        };
        executed
    }

    /// Stands still before a motion that will begin; returns that none is executed.
    fn stand(&mut self) -> (u64, u32) {
        self.layer.progress = self.progress_on_way(0.0);
        (0, 0)
    }

    /// Has the path's leader go on for a cycle; returns the segment that was left behind last, and whether the robot
    /// has come to a stop at its end.
    fn follow_path(&mut self, dt: f64, pacing: Pacing) -> (Option<Arc<Segment>>, bool) {
        let Layer { path, waiting, concluded, execution, finished, .. } = &mut self.layer;
        path.note_end(*concluded && waiting.is_empty());
        let mut arrived = None;
        let stands = path.advance((&self.robot, &self.joints), dt, pacing, |passed| {
            *finished = if passed.ends { passed.number } else { *finished };
            if !passed.leaves() {
                let elapsed = if passed.number == execution.timed { execution.elapsed } else { 0.0 };
                let duration = passed.duration().unwrap_or(elapsed);
                self.left.push(progress_at(&passed, passed.share_at_end(), duration, 0.0));
            }
            arrived = Some(passed);
        });
        (arrived, stands)
    }

    /// Puts the commanded positions where the robot is on the path, or at the end of the segment at which it stands;
    /// returns the motion executed there and its line, `executed` where there is no other.
    fn place_on_path(&mut self, executed: (u64, u32), end: Option<&Segment>) -> (u64, u32) {
        let kinematics = &self.robot.kinematics;
        match (end, self.layer.path.first()) {
            (Some(segment), _) => {
                self.joints = segment.joints(kinematics, segment.time, &self.joints);
                (segment.number, segment.line)
            }
            (None, Some(segment)) => {
                self.joints = segment.joints(kinematics, self.layer.path.at(), &self.joints);
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

    /// Motions that go nowhere end when those before them have ended.
    fn end_empty(&mut self) {
        let anew = self.layer.requests.first_anew().unwrap_or(self.added + 1);
        let held = self.layer.held.as_ref().map_or(anew, |held| held.number);
        let waiting = self.layer.waiting.first().map_or(held, |ready| ready.number);
        let next = self.layer.path.first().map_or(waiting, |segment| segment.number);
        self.layer.finished = self.layer.finished.max(next - 1);
        if self.layer.path.is_empty() && self.layer.waiting.is_empty() && !self.dropping {
            self.layer.execution.rig = self.layer.last_rig;
        }
    }

    fn drop_at_rest(&mut self) {
        if self.dropping && self.rests() {
            self.layer.finished = self.added;
            self.layer.over = self.added;
            self.layer.path.clear();
            self.layer.end = self.joints;
            self.layer.led = Led::default();
            self.layer.execution.started = None;
            self.layer.progress = None;
            self.dropping = false;
            self.braking_hard = false;
        }
    }
}
