//! The path ahead: segments of motions and the blends between them, in a row.

mod append;
mod law_hand_over;
mod leader;
mod segments;
mod shorter_stop;
mod time_left;

use std::sync::Arc;

use crate::blend::no_blend::NoBlend;
use crate::blend::zone::asks;
use crate::command::LARGEST_ZONE;
use crate::command::joints::{ALL, Joints};
use crate::follow::governor::{Governor, Pacing};
use crate::follow::segment::{PlainSpeed, Segment};
use crate::follow::timing::Timing;
use crate::junction::{Before, MotionPair};
use crate::limits::profile::{Change, LOOK_AHEAD_MARGIN, State};
use crate::plan::motion::Motion;
use crate::time_optimal::law_follower::LawFollower;
use arl_robot::kinematics::Kinematics;
use arl_robot::robot::Robot;
pub(crate) use law_hand_over::OfferOutcome;
use law_hand_over::{LOOKED_AHEAD_S, LawHandOver, faster};
use leader::{Appending, Leader};
use segments::Segments;

/// Distance to a stop, in s of nominal time, that is only due to rounding.
const NEAR_STOP_S: f64 = 1e-9;

/// Margin factor: a little more time is left for braking than it takes.
const BRAKING_FACTOR: f64 = 1.1;

/// Number of cycles that an acceleration takes to rise at least.
const ACCELERATION_RISE_CYCLES: f64 = 4.0;

/// The path ahead, from the segment that the robot is on.
#[derive(Clone, Debug, Default)]
pub(crate) struct PathBuffer {
    segments: Segments,
    /// Position of the robot on the first segment, in s of nominal time.
    at: f64,
    /// The length of a cycle in s.
    cycle: f64,
    timing: Timing,
    /// Position of the robot on the first cell of the timing, and how it moves.
    state: State,
    /// The governor's backup for that state; meaningless where a law leads.
    backup: Change,
    /// The share of the speed at which the robot has settled.
    share: f64,
    laws: LawHandOver,
    /// The last motion, whose end the next motion may still round off.
    tail: Option<Tail>,
    /// Whether `tail` stays the last motion until the robot is at rest.
    is_last: bool,
}

/// A target at which the robot stops although it should be rounded off.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct UnblendedTarget {
    /// Running number of the motion behind it.
    pub number: u64,
    /// Program line of that motion.
    pub line: u32,
    /// Program line of the motion before it; `None` where both are parts of the same motion.
    pub corner: Option<u32>,
    /// Reason why it is not rounded off.
    pub why: NoBlend,
}

impl UnblendedTarget {
    /// Whether it is between the same program lines, with the same reason.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        (self.line, self.corner, &self.why) == (other.line, other.corner, &other.why)
    }
}

/// A motion that is left by a blend.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Leaving {
    /// Running number of the motion.
    pub(crate) number: u64,
    /// Share of the motion at which the blend begins.
    pub(crate) share: f64,
    /// Reason why the zone is smaller than requested, if it is.
    pub(crate) less: Option<NoBlend>,
}

/// The end of the path.
#[derive(Clone, Debug)]
struct Tail {
    motion: Arc<Motion>,
    /// The motion before it, where a blend joins the two.
    joined: Option<Joined>,
}

/// A blend whose end is straight until the motion behind the one that it leads into is known.
#[derive(Clone, Debug)]
struct Joined {
    before: Before,
    /// Number of segments from the first half of the blend on.
    segments: usize,
}

/// Limits the rise of acceleration so that a motion can be appended where cycles take `cycle` s.
pub(crate) fn limit_rise(motion: Motion, cycle: f64) -> Arc<Motion> {
    Arc::new(motion.rising_in(ACCELERATION_RISE_CYCLES * cycle))
}

impl Tail {
    fn pair(&self, next: &Arc<Motion>) -> MotionPair {
        let before = self.joined.as_ref().and_then(|joined| joined.before.clone());
        MotionPair { before, from: Arc::clone(&self.motion), to: Arc::clone(next) }
    }
}

impl PathBuffer {
    /// The segment that the robot is on.
    pub(crate) fn first(&self) -> Option<&Segment> {
        self.segments.front().map(|segment| &**segment)
    }

    /// The segment that the robot is on, and its speed there where the segment is not part of a blend.
    pub(crate) fn plain_speed(&self) -> Option<(&Segment, Option<PlainSpeed>)> {
        let first = self.segments.front()?;
        Some((first, first.plain_speed(self.at, self.state.vel)))
    }

    /// How a blend leads from a motion into the motion `number`, where one does.
    pub(crate) fn leaving_before(&self, number: u64) -> Option<Leaving> {
        let is_own = |segment: &&Arc<Segment>| segment.number == number;
        let before = self.segments.iter().rev().skip_while(|it| !is_own(it)).find(|it| !is_own(it))?;
        let rounded = before.ends && !before.stops && before.parametrization.is_some();
        rounded.then(|| Leaving { number: before.number, share: before.leave, less: before.less.clone() })
    }

    /// The motion that counts as being executed, and the share of its path that is done. A blend belongs to the motion
    /// that it leads into (manual 7.3), whose path still counts from the target that is rounded off.
    pub(crate) fn current(&self) -> Option<(&Segment, f64)> {
        let first = self.segments.front()?;
        match self.segments.get(1).filter(|_| first.leaves()) {
            Some(next) => {
                let [half, _] = next.shares;
                Some((next, half * (self.at / first.time).clamp(0.0, 1.0)))
            }
            None => Some((first, first.share(self.at))),
        }
    }

    /// The motion that was appended last.
    pub(crate) fn last(&self) -> Option<&Arc<Motion>> {
        self.tail.as_ref().map(|tail| &tail.motion)
    }

    /// Whether no path is left.
    pub(crate) fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    /// Whether the robot is at rest.
    pub(crate) fn rests(&self) -> bool {
        self.state.rests()
    }

    /// Position of the robot on the first segment, in s of nominal time.
    pub(crate) fn at(&self) -> f64 {
        self.at
    }

    /// Velocities and accelerations of all axes at the position of the robot, where they are at `joints`; `None` at a
    /// singular point.
    pub(crate) fn rates(&self, kinematics: &Kinematics, joints: &Joints) -> Option<[Joints; 2]> {
        let Some(first) = self.segments.front().filter(|_| !self.rests()) else { return Some([Joints::ZERO; 2]) };
        let [first, second] = first.rates(kinematics, self.at, joints)?;
        let State { vel, acc, .. } = self.state;
        let mut rates = [[0.0; ALL]; 2];
        let [velocity, acceleration] = &mut rates;
        let all = velocity.iter_mut().zip(acceleration).zip(first.iter().zip(&second));
        for ((velocity, acceleration), (first, second)) in all {
            *velocity = first * vel;
            *acceleration = second * vel * vel + first * acc;
        }
        Some(rates.map(|rates| Joints::of(&rates)))
    }

    /// The remaining path, in s of nominal time.
    pub(crate) fn time_left(&self) -> f64 {
        self.timing.length() - self.state.at
    }

    /// For how many s the robot can continue at full speed before it may have to brake for the next motion, or rather
    /// for the end of the part that the next motion does not change. Where laws lead, the current law has to lead that
    /// far.
    pub(crate) fn spare(&self) -> f64 {
        let Some(last) = self.segments.back() else { return 0.0 };
        if self.wants_laws() {
            let law = self.laws.leader.follower().and_then(LawFollower::law);
            return self.time_left() - self.open_time() - faster(law) * LOOKED_AHEAD_S;
        }
        let open = match self.tail.as_ref() {
            None => 0.0,
            Some(Tail { joined: None, motion }) if motion.corner.is_none() => last.time.min(LARGEST_ZONE / motion.rate),
            Some(_) => self.open_time(),
        };
        self.time_left() - open - BRAKING_FACTOR * self.timing.braking(open)
    }

    /// Whether laws lead the robot, or will.
    pub(crate) fn wants_laws(&self) -> bool {
        let ends = [self.segments.front(), self.segments.back()];
        self.is_law_driven() || ends.into_iter().flatten().any(|segment| segment.is_free)
    }

    /// The motion before the last one, where a blend joins the two.
    pub(crate) fn before(&self) -> Before {
        self.tail.as_ref().and_then(|tail| tail.joined.as_ref()?.before.clone())
    }

    /// Whether laws lead the robot, or would along a draft.
    fn is_law_driven(&self) -> bool {
        self.laws.leader.follower().is_some() || matches!(self.laws.appending, Appending::Draft(_))
    }

    fn push(&mut self, segments: &[Arc<Segment>], may: impl Fn(usize) -> bool) {
        for (index, segment) in segments.iter().enumerate() {
            self.push_shared(Arc::clone(segment), may(index));
        }
    }

    fn push_shared(&mut self, segment: Arc<Segment>, may: bool) {
        debug_assert!(self.segments.back().is_none_or(|last| last.meets(&segment)), "a gap in line {}", segment.line);
        for (index, cell) in segment.cells().enumerate() {
            self.timing.push(cell, segment.stops, may || index > 0);
        }
        self.segments.push(segment);
    }

    /// Merges equal neighbours in the timing, except for the last segments, which may still be removed.
    fn settle(&mut self, open: usize) {
        let open = self.segments.iter().rev().take(open).map(|segment| segment.cells().count()).sum();
        self.timing.settle(open);
    }

    /// Removes the last segments; returns them, the last one first, each with whether its stretch began with it.
    fn take_back(&mut self, count: usize) -> Vec<(Arc<Segment>, bool)> {
        let mut taken = Vec::with_capacity(count);
        for segment in (0..count).map_while(|_| self.segments.pop_back()) {
            let mut began = false;
            for _ in segment.cells() {
                began = self.timing.pop();
            }
            taken.push((segment, began));
        }
        taken
    }

    /// Puts removed segments back.
    fn put_back(&mut self, taken: Vec<(Arc<Segment>, bool)>) {
        for (segment, began) in taken.into_iter().rev() {
            self.push_shared(segment, !began);
        }
    }

    /// Finds what the governor has to know about the path ahead, if the path has changed; not needed where a law leads.
    fn find_entries(&mut self) {
        self.timing.find_entries(LOOK_AHEAD_MARGIN, self.cycle);
    }

    fn governor(&self, cycle: f64) -> Governor<'_> {
        Governor { stretches: &self.timing.stretches, cycle }
    }

    /// Sets whether the last motion stays the last one until the robot is at rest.
    pub(crate) fn note_end(&mut self, is_last: bool) {
        self.is_last = is_last;
    }

    /// Advances by a cycle; calls `passed` with each segment that is left behind. Returns whether the robot has arrived
    /// where it had to stop: at the end of the last of these segments.
    pub(crate) fn advance(
        &mut self,
        robot: &Arc<Robot>,
        here: &Joints,
        cycle: f64,
        pacing: Pacing,
        mut passed: impl FnMut(Arc<Segment>),
    ) -> bool {
        self.laws.offer_pause = (self.laws.offer_pause - cycle).max(0.0);
        self.choose_leader(robot);
        self.shorten_stop(robot, here, cycle, pacing);
        if !self.follow_law(robot, here, cycle, pacing) {
            self.find_entries();
            let pacing = self.settling(cycle, pacing);
            let mut backup = self.backup;
            let next = self.governor(cycle).next(&self.state, &mut backup, pacing);
            self.backup = backup;
            self.at += next.at - self.state.at;
            self.state = next;
        }
        let stands = self.timing.pass(&mut self.state);
        if stands {
            self.backup = Change::default();
            self.end_at_stop();
        }
        while let Some(first) = self.segments.front() {
            // The remainder of a segment before a stop that is only due to rounding is passed with the stop.
            let at_stop = stands && self.at >= first.time - 1e-9;
            if self.at < first.time && !at_stop {
                break;
            }
            let stops = first.stops;
            if stops && !stands {
                break;
            }
            self.at = if stops { 0.0 } else { self.at - first.time };
            if let Some(segment) = self.segments.pass() {
                passed(segment);
            }
            if stops {
                self.segments.begin();
                break;
            }
        }
        stands
    }

    /// Chooses the leader at rest, which then leads until the robot stops: laws where the first motion is free, except
    /// a motion with the same limits everywhere that goes from rest to rest. For that one the governor needs no search,
    /// and no law is faster.
    fn choose_leader(&mut self, robot: &Robot) {
        let is_free = || self.segments.front().is_some_and(|first| first.is_free);
        if self.state.rests() && matches!(self.laws.leader, Leader::Governor) && is_free() && !self.is_alone(robot, 0) {
            self.laws.leader = Leader::Laws(Box::default());
        }
    }

    /// Whether the segment at `index`, at whose start the robot is at rest, is an even motion that will not be blended
    /// with the next one.
    fn is_alone(&self, robot: &Robot, index: usize) -> bool {
        let Some(segment) = self.segments.get(index) else { return false };
        let ends_exactly = || self.tail.as_ref().is_some_and(|tail| !asks(robot, &tail.motion));
        let stays = || index + 1 < self.segments.len() || self.is_last || ends_exactly();
        segment.is_even() && segment.stops && segment.duration().is_some() && stays()
    }

    /// The pacing, with a settling phase towards a share of the speed that is new.
    fn settling(&mut self, cycle: f64, pacing: Pacing) -> Pacing {
        match pacing {
            Pacing::Go(share) if share != self.share => {
                if self.governor(cycle).settled(&self.state, share) {
                    self.share = share;
                    return pacing;
                }
                Pacing::Settle(share)
            }
            Pacing::Stop(_) => {
                self.share = 0.0;
                pacing
            }
            _ => pacing,
        }
    }

    /// Drops the motions behind the next stop.
    pub(crate) fn keep_to_stop(&mut self) {
        self.segments.keep_to_stop();
        self.timing.keep_to_stop();
        self.tail = None;
        self.keep_laws_to_stop();
    }

    /// Drops everything.
    pub(crate) fn clear(&mut self) {
        self.cancel();
        let solver = std::mem::take(&mut self.laws.solver);
        *self = Self::default();
        self.laws.solver = solver;
    }
}
