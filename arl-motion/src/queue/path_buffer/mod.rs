//! The way ahead: segments of motions and the blends between them, one behind the other.

mod law_hand_over;
mod leader;
mod shorter_stop;
mod time_left;

use std::collections::VecDeque;
use std::sync::Arc;

use crate::blend::no_blend::NoBlend;
use crate::blend::zone::asks;
use crate::command::LARGEST_ZONE;
use crate::command::joints::{ALL, Joints};
use crate::follow::governor::{Governor, Pacing};
use crate::follow::segment::{PlainSpeed, Segment};
use crate::follow::shared_deque::SharedDeque;
use crate::follow::timing::Timing;
use crate::junction::blend_thread::Prepared;
use crate::junction::{self, Before, Blended, CurvedBlends, MotionPair};
use crate::limits::profile::{Change, LOOK_AHEAD_MARGIN, Limits, State};
use crate::plan::motion::Motion;
use crate::time_optimal::law_follower::LawFollower;
use crate::time_optimal::law_solver_thread::LawSolver;
use arl_robot::kinematics::Kinematics;
use arl_robot::robot::Robot;
pub(crate) use law_hand_over::OfferOutcome;
use law_hand_over::{LOOKED_AHEAD_S, Next, PendingLaw, faster};
use leader::{Appending, Leader};

/// A segment that takes no longer, in s, is none.
const NO_TIME_S: f64 = 1e-12;

/// What is left of the way to a stop, in s of nominal time, when only rounding is left.
const NEAR_STOP_S: f64 = 1e-9;

/// A little more than braking takes is left for it.
const BRAKING_FACTOR: f64 = 1.1;

/// Cycles in which an acceleration rises at the fastest.
const ACCELERATION_RISE_CYCLES: f64 = 4.0;

/// All segments from the one that the robot is on.
#[derive(Clone, Debug, Default)]
pub(crate) struct PathBuffer {
    segments: SharedDeque<Segment>,
    /// Where each of them ends, in s of nominal time since the path began.
    ends: VecDeque<f64>,
    /// Which of them the robot stops at, counted from the first segment that there ever was.
    stops: VecDeque<u64>,
    /// Where the robot is on the first segment, in s of nominal time.
    at: f64,
    /// The length of a cycle in s.
    cycle: f64,
    timing: Timing,
    /// Where the robot is on the first cell of the timing, and how it moves.
    state: State,
    /// The governor's backup for that state; of no meaning where a law leads.
    backup: Change,
    /// The share of the speed that the robot has settled to.
    share: f64,
    leader: Leader,
    /// How hard the stop is for which a shorter one than the governor's has been asked for.
    stop_asked: Option<f64>,
    /// Who finds laws, what is looked for, and the law from the next stop on.
    law_solver: LawSolver,
    pending: Option<PendingLaw>,
    next: Option<Next>,
    /// What became of motions that were offered, and s until they are offered again where nothing did.
    answer: Option<OfferOutcome>,
    offer_pause: f64,
    appending: Appending,
    /// How many segments have been left behind.
    gone: u64,
    /// s of nominal time before the first segment, since the path began.
    passed: f64,
    /// The last motion, which the next one may still round off.
    tail: Option<Tail>,
    /// Whether it stays the last one until the robot rests.
    is_last: bool,
}

/// A target that should be rounded off, at which the robot stops.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct UnblendedTarget {
    /// The running number of the motion behind it.
    pub number: u64,
    /// Its program line.
    pub line: u32,
    /// The program line of the motion before it; `None` where the two are one motion of several parts.
    pub corner: Option<u32>,
    /// Why it is not rounded off.
    pub why: NoBlend,
}

impl UnblendedTarget {
    /// Whether it is between the same program lines for the same reason.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        (self.line, self.corner, &self.why) == (other.line, other.corner, &other.why)
    }
}

/// A motion that is left by a blend.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Leaving {
    /// Its running number.
    pub(crate) number: u64,
    /// The share at which it is left.
    pub(crate) share: f64,
    /// Why that is a smaller zone than was asked for, where it is.
    pub(crate) less: Option<NoBlend>,
}

/// The end of the path.
#[derive(Clone, Debug)]
struct Tail {
    motion: Arc<Motion>,
    /// The motion before it, where a blend leads from there.
    joined: Option<Joined>,
}

/// A blend whose end is straight as long as it is not known what comes behind the motion that it leads into.
#[derive(Clone, Debug)]
struct Joined {
    before: Before,
    /// How many segments there are from the blend's first half on.
    segments: usize,
}

/// A motion that can be appended where cycles take `cycle` s.
pub(crate) fn limit_rise(motion: Motion, cycle: f64) -> Arc<Motion> {
    Arc::new(motion.rising_in(ACCELERATION_RISE_CYCLES * cycle))
}

/// Whether a stretch began with the first of segments that were taken back.
fn began(taken: &[(Arc<Segment>, bool)]) -> bool {
    taken.last().is_none_or(|(_, began)| *began)
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

    /// The segment that the robot is on, and how fast it goes there where that is not a blend.
    pub(crate) fn plain_speed(&self) -> Option<(&Segment, Option<PlainSpeed>)> {
        let first = self.segments.front()?;
        Some((first, first.plain_speed(self.at, self.state.vel)))
    }

    /// How a blend leaves a motion for the motion `number`, where one does.
    pub(crate) fn left_before(&self, number: u64) -> Option<Leaving> {
        let is_own = |segment: &&Arc<Segment>| segment.number == number;
        let before = self.segments.iter().rev().skip_while(|it| !is_own(it)).find(|it| !is_own(it))?;
        let rounded = before.ends && !before.stops && before.parametrization.is_some();
        rounded.then(|| Leaving { number: before.number, share: before.leave, less: before.less.clone() })
    }

    /// The motion that counts as being executed, and the share of its path that is done. A blend belongs to the motion
    /// that is joined (manual 7.3), whose path still counts from the target that is rounded off.
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

    /// Whether nothing is left to go.
    pub(crate) fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    /// Whether the robot stands still.
    pub(crate) fn rests(&self) -> bool {
        self.state.rests()
    }

    /// Where the robot is on the first segment, in s of nominal time.
    pub(crate) fn at(&self) -> f64 {
        self.at
    }

    /// How fast all axes move, and how that changes, where the robot is and they are at `joints`; `None` at a singular
    /// point.
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

    /// The nominal time in s that is left to go.
    pub(crate) fn time_left(&self) -> f64 {
        self.timing.length() - self.state.at
    }

    /// For how many s, at its full speed, the robot can go on before it may have to brake for the next motion: or
    /// rather for the end of what that one does not change. Where laws lead, one has to lead that far.
    pub(crate) fn spare(&self) -> f64 {
        let Some(last) = self.segments.back() else { return 0.0 };
        if self.wants_laws() {
            let law = self.leader.follower().and_then(LawFollower::law);
            return self.time_left() - self.open_time() - faster(law) * LOOKED_AHEAD_S;
        }
        let open = match self.tail.as_ref() {
            None => 0.0,
            Some(Tail { joined: None, motion }) if motion.corner.is_none() => last.time.min(LARGEST_ZONE / motion.rate),
            Some(_) => self.open_time(),
        };
        self.time_left() - open - BRAKING_FACTOR * self.timing.braking(open)
    }

    /// Whether the robot is led by laws, or will be.
    pub(crate) fn wants_laws(&self) -> bool {
        let ends = [self.segments.front(), self.segments.back()];
        self.is_led() || ends.into_iter().flatten().any(|segment| segment.is_free)
    }

    /// How the last motion is joined by the one before it.
    pub(crate) fn before(&self) -> Before {
        self.tail.as_ref().and_then(|tail| tail.joined.as_ref()?.before.clone())
    }

    /// Appends a motion that [`limit_rise`] has made ready, with what has been prepared for it. Returns why the motion
    /// before it is not rounded off, where that was asked for.
    pub(crate) fn append(
        &mut self,
        robot: &Robot,
        (motion, number): (&Arc<Motion>, u64),
        prepared: Option<&Prepared>,
        cycle: f64,
    ) -> Option<UnblendedTarget> {
        let limits = motion.limits?;
        self.cycle = cycle;
        let tail = self.tail.take();
        if motion.flows && tail.is_some() && self.flow_on(Segment::part(motion, limits, number, 0.0, 1.0), cycle) {
            self.settle(1);
            self.tail = Some(Tail { motion: Arc::clone(motion), joined: None });
            return None;
        }
        let tail = tail.filter(|_| !self.segments.is_empty());
        let known = prepared.zip(tail.as_ref()).map(|(prepared, tail)| prepared.take(robot, || tail.pair(motion)));
        let curved = tail.as_ref().and_then(|tail| self.curved(robot, known, tail, motion));
        let mut joined = tail.as_ref().zip(curved).and_then(|(tail, curved)| {
            let segments = self.join_curved(tail, &curved, (motion, limits), number, cycle)?;
            Some(Joined { before: Some((Arc::clone(&tail.motion), curved.curvature)), segments })
        });
        let unblended_for = |corner, why| Some(UnblendedTarget { number, line: motion.line, corner, why });
        let mut unblended = if motion.flows { unblended_for(None, NoBlend::Late) } else { None };
        let mut end = Arc::clone(motion);
        if let Some(tail) = tail {
            let corner = Some(tail.motion.line);
            let blended = joined.is_none().then(|| junction::blended(robot, known, &tail.motion, motion));
            let asks = asks(robot, &tail.motion);
            match blended {
                Some(Ok(blended)) => {
                    let before = blended.leaves();
                    joined = self.round_off(&blended, number, cycle).map(|segments| Joined { before, segments });
                    unblended = if joined.is_none() { unblended_for(corner, NoBlend::Late) } else { None };
                    if joined.is_some() {
                        end = blended.to;
                    }
                }
                Some(Err(why)) if asks => unblended = unblended_for(corner, why),
                Some(Err(_)) | None => {}
            }
        }
        let limits = end.limits?;
        if joined.is_none() {
            let whole = self.ready([Segment::part(&end, limits, number, 0.0, 1.0)]);
            // In a stretch of its own it asks for nothing that the stop before it did not.
            if self.is_led() || !self.lay(&whole, |_| true, cycle) {
                self.push(&whole, |_| false);
            }
        }
        self.settle(joined.as_ref().map_or(1, |joined| joined.segments));
        self.tail = Some(Tail { motion: end, joined });
        unblended
    }

    /// How the last motion bends towards the next one; `None` where it does not, or the robot is on the blend before
    /// already.
    fn curved(
        &self,
        robot: &Robot,
        known: Option<&junction::Junction>,
        tail: &Tail,
        motion: &Arc<Motion>,
    ) -> Option<CurvedBlends> {
        let Joined { before, segments } = tail.joined.as_ref()?;
        let (before, curvature) = before.as_ref()?;
        if self.segments.len() <= *segments {
            return None;
        }
        junction::curved(robot, known, (before, *curvature), (&tail.motion, motion))
    }

    /// Puts a blend behind the last one where the two meet in the middle of the last motion, and bends both there;
    /// returns how many segments there are from the new blend on. `None` where that is not possible any more.
    fn join_curved(
        &mut self,
        tail: &Tail,
        curved: &CurvedBlends,
        (motion, limits): (&Motion, Limits),
        number: u64,
        cycle: f64,
    ) -> Option<usize> {
        let Joined { before, segments: count } = tail.joined.as_ref()?;
        let (before, _) = before.as_ref()?;
        let [first, next] = &curved.blends;
        let (left, last) = (self.segments.get(self.segments.len() - *count)?.number, self.segments.back()?.number);
        let circle_steps = [
            Segment::half(first, (before, &tail.motion), left, true),
            Segment::half(first, (before, &tail.motion), last, false),
            Segment::half(next, (&tail.motion, motion), last, true),
            Segment::half(next, (&tail.motion, motion), number, false),
        ];
        let rest = Segment::part(motion, limits, number, next.join, 1.0);
        let segments = self.ready(circle_steps.into_iter().chain((rest.time > NO_TIME_S).then_some(rest)));
        let kept = self.take_back(*count);
        let same_to = self.unchanged_to(0.0);
        if self.lay_any(&segments, None, same_to, cycle) {
            return Some(segments.len() - 2);
        }
        self.put_back(kept);
        None
    }

    /// Puts a blend in place of the end of the last motion and the start of the next; returns how many segments there
    /// are from the blend on, `None` where the robot is not able to take it any more.
    fn round_off(&mut self, blended: &Blended, number: u64, cycle: f64) -> Option<usize> {
        let Blended { from: before, to: motion, blend, until } = blended;
        let (before_limits, limits) = (before.limits?, motion.limits?);
        let last = self.segments.back()?;
        // Another blend has taken what this one needs.
        if last.from > blend.leave {
            return None;
        }
        let gone = last.from + self.at * before.rate;
        if self.segments.len() == 1 && (gone >= blend.leave || gone > *until) {
            return None;
        }
        let same = (until.min(blend.leave) - last.from).max(0.0) / before.rate;
        let mut cut = Segment::part(before, before_limits, last.number, last.from, blend.leave);
        (cut.stops, cut.ends) = (false, false);
        let first = Segment::half(blend, (before, motion), last.number, true);
        let second = Segment::half(blend, (before, motion), number, false);
        let rest = Segment::part(motion, limits, number, blend.join, 1.0);
        let segments = self.ready([cut, first, second, rest].into_iter().filter(|segment| segment.time > NO_TIME_S));
        let from_blend = segments.iter().skip_while(|segment| segment.parametrization.is_none()).count();
        let kept = self.take_back(1);
        let same_to = self.unchanged_to(same);
        let own = segments.first().is_some_and(|first| first.parametrization.is_none()).then(|| began(&kept));
        if self.lay_any(&segments, own, same_to, cycle) {
            return Some(from_blend);
        }
        self.put_back(kept);
        None
    }

    /// Appends segments in whatever way the robot is able to keep to them; returns whether there is one. `own`: the
    /// first of them is of the motion that the robot may be on, and did a stretch begin with that? Up to `same_to`, in
    /// s of nominal time since the path began, nothing changes by them.
    fn lay_any(&mut self, segments: &[Arc<Segment>], own: Option<bool>, same_to: f64, cycle: f64) -> bool {
        let may = self.may_change_from(same_to);
        if self.is_led() {
            if may {
                self.push(segments, |_| true);
            }
            return may;
        }
        self.lay(segments, |_| true, cycle)
            || self.lay(segments, |index| index > 0, cycle)
            // A robot that speeds up on its motion needs that one's limits as they are.
            || own.is_some_and(|began| self.lay(segments, |index| if index == 0 { !began } else { index > 1 }, cycle))
    }

    /// Where changes begin that come so many s of nominal time behind the last segment, for whom that may concern.
    fn unchanged_to(&self, behind: f64) -> f64 {
        if self.is_watched() { self.end() + behind } else { f64::INFINITY }
    }

    /// Where the last segment ends, in s of nominal time since the path began.
    fn end(&self) -> f64 {
        self.ends.back().copied().unwrap_or(self.passed)
    }

    /// The index of the first segment at whose end the robot stops.
    fn first_stop(&self) -> Option<usize> {
        self.stops.front().map(|stop| stop.saturating_sub(self.gone) as usize)
    }

    /// Goes on from the last motion without a stop; returns whether the robot is still able to.
    fn flow_on(&mut self, segment: Segment, cycle: f64) -> bool {
        let Some(last) = self.segments.back() else { return false };
        let mut through = Segment::clone(last).flowing();
        through.stops = false;
        let segments = self.ready([through, segment.flowing()]);
        let kept = self.take_back(1);
        let same_to = self.unchanged_to(segments.first().map_or(0.0, |through| through.time));
        if self.lay_any(&segments, Some(began(&kept)), same_to, cycle) {
            return true;
        }
        self.put_back(kept);
        false
    }

    /// Whether laws lead the robot, or would.
    fn is_led(&self) -> bool {
        self.leader.follower().is_some() || matches!(self.appending, Appending::Draft(_))
    }

    /// Appends segments if the robot is able to keep to them, and returns whether it is; which of them `may` join the
    /// stretch before?
    fn lay(&mut self, segments: &[Arc<Segment>], may: impl Fn(usize) -> bool, cycle: f64) -> bool {
        // Nobody counts on the path yet.
        if self.state.rests() {
            self.push(segments, may);
            return true;
        }
        self.find_entries();
        let before = self.timing.next_entry();
        self.push(segments, may);
        self.find_entries();
        // The governor looks no farther than to the stretch behind the one where its backup ends.
        let unchanged = before.is_some() && self.timing.next_entry() >= before && self.backup_ends_here();
        if unchanged {
            return true;
        }
        match self.governor(cycle).holds(&self.state) {
            Some(backup) => {
                self.backup = backup;
                true
            }
            None => {
                self.take_back(segments.len());
                false
            }
        }
    }

    /// Whether the backup ends on the stretch on which the robot is.
    fn backup_ends_here(&self) -> bool {
        let State { at, vel, acc } = self.state;
        self.timing.is_on_first(at + self.backup.distance(vel, acc))
    }

    /// Segments as they can be pushed.
    fn ready(&self, segments: impl IntoIterator<Item = Segment>) -> Vec<Arc<Segment>> {
        // Set-points are those of whole cycles: an acceleration takes a few of them to rise, also without a limit of
        // the jerk.
        let rise = ACCELERATION_RISE_CYCLES * self.cycle;
        segments.into_iter().map(|segment| Arc::new(segment.rising_in(rise))).collect()
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
        self.ends.push_back(self.end() + segment.time);
        if segment.stops {
            self.stops.push_back(self.gone + self.segments.len() as u64);
        }
        self.segments.push_back(segment);
    }

    /// Joins what is alike in the timing, but for the last segments, which may still be taken away.
    fn settle(&mut self, open: usize) {
        let open = self.segments.iter().rev().take(open).map(|segment| segment.cells().count()).sum();
        self.timing.settle(open);
    }

    /// Takes the last segments away; returns them, the last one first, each with whether its stretch began with it.
    fn take_back(&mut self, count: usize) -> Vec<(Arc<Segment>, bool)> {
        let mut taken = Vec::with_capacity(count);
        for segment in (0..count).map_while(|_| self.segments.pop_back()) {
            self.ends.pop_back();
            if segment.stops {
                self.stops.pop_back();
            }
            let mut began = false;
            for _ in segment.cells() {
                began = self.timing.pop();
            }
            taken.push((segment, began));
        }
        taken
    }

    /// Puts segments back where they were.
    fn put_back(&mut self, taken: Vec<(Arc<Segment>, bool)>) {
        for (segment, began) in taken.into_iter().rev() {
            self.push_shared(segment, !began);
        }
    }

    /// Finds what the governor has to know of the path ahead, if it has changed; where a law leads, nobody asks for
    /// that.
    fn find_entries(&mut self) {
        self.timing.find_entries(LOOK_AHEAD_MARGIN, self.cycle);
    }

    fn governor(&self, cycle: f64) -> Governor<'_> {
        Governor { stretches: &self.timing.stretches, cycle }
    }

    /// Says whether the last motion stays the last one until the robot rests.
    pub(crate) fn note_end(&mut self, is_last: bool) {
        self.is_last = is_last;
    }

    /// Goes on for a cycle; tells of each segment that is left behind. Returns whether the robot has arrived where it
    /// had to stop: at the end of the last segment that was told of.
    pub(crate) fn advance(
        &mut self,
        (robot, here): (&Arc<Robot>, &Joints),
        cycle: f64,
        pacing: Pacing,
        mut passed: impl FnMut(Arc<Segment>),
    ) -> bool {
        self.offer_pause = (self.offer_pause - cycle).max(0.0);
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
            // What rounding leaves of segments before a stop is passed with it.
            let at_stop = stands && self.at >= first.time - 1e-9;
            if self.at < first.time && !at_stop {
                break;
            }
            let stops = first.stops;
            if stops && !stands {
                break;
            }
            self.at = if stops { 0.0 } else { self.at - first.time };
            self.passed += first.time;
            if let Some(segment) = self.segments.pop_front() {
                self.ends.pop_front();
                if stops {
                    self.stops.pop_front();
                }
                self.gone += 1;
                passed(segment);
            }
            if stops {
                self.begin();
                break;
            }
        }
        stands
    }

    /// The path begins where the robot stands.
    fn begin(&mut self) {
        self.passed = 0.0;
        let mut end = 0.0;
        for (known, segment) in self.ends.iter_mut().zip(self.segments.iter()) {
            end += segment.time;
            *known = end;
        }
    }

    /// Whoever leads the robot from rest leads it until it stops: laws where the first motion is free, but for one with
    /// the same limits everywhere that is to be gone from rest to rest. For that one the governor needs no search, and
    /// no law is faster.
    fn choose_leader(&mut self, robot: &Robot) {
        let is_free = || self.segments.front().is_some_and(|first| first.is_free);
        if self.state.rests() && matches!(self.leader, Leader::Governor) && is_free() && !self.is_alone(robot, 0) {
            self.leader = Leader::Laws(Box::default());
        }
    }

    /// Whether the segment of an index, at whose start the robot rests, is an even motion that will not be blended with
    /// the next one.
    fn is_alone(&self, robot: &Robot, index: usize) -> bool {
        let Some(segment) = self.segments.get(index) else { return false };
        let ends_exactly = || self.tail.as_ref().is_some_and(|tail| !asks(robot, &tail.motion));
        let stays = || index + 1 < self.segments.len() || self.is_last || ends_exactly();
        segment.is_even() && segment.stops && segment.duration().is_some() && stays()
    }

    /// The pacing with the way to a share of the speed that is new.
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

    /// Drops the motions behind the next place where the robot stops.
    pub(crate) fn keep_to_stop(&mut self) {
        let kept = self.first_stop().map_or(0, |last| last + 1);
        self.segments.truncate(kept);
        self.ends.truncate(kept);
        self.stops.truncate(1);
        self.timing.keep_to_stop();
        self.tail = None;
        self.keep_laws_to_stop();
    }

    /// Drops everything.
    pub(crate) fn clear(&mut self) {
        self.cancel();
        *self = Self { law_solver: std::mem::take(&mut self.law_solver), ..Self::default() };
    }
}
