//! The way ahead: pieces of motions and the blends between them, one behind the other.

mod law_hand_over;
mod shorter_stop;

use std::collections::VecDeque;
use std::sync::Arc;

use crate::blend::blend_thread::{Joining, Prepared};
use crate::blend::junction::{self, Before, Bent, Blended, Meeting};
use crate::blend::mid_curvature::Bend;
use crate::blend::zone::asks;
use crate::command::LARGEST_ZONE;
use crate::command::joints::Joints;
use crate::follow::governor::{Governor, Pacing};
use crate::follow::remaining::{self, Leg};
use crate::follow::segment::Piece;
use crate::follow::timing::Timing;
use crate::limits::profile::MARGIN;
use crate::limits::profile::{Change, Limits, State};
use crate::plan::motion::Motion;
use crate::time_optimal::law_follower::Pilot;
use crate::time_optimal::law_solver_thread::Finder;
use arl_robot::robot::Robot;
pub(crate) use law_hand_over::Answer;
use law_hand_over::{Next, Sought};

/// A piece that takes no longer, in s, is none.
const NO_TIME: f64 = 1e-12;

/// What is left of the way to a stop, in s of nominal time, when only rounding is left.
const NEAR_STOP: f64 = 1e-9;

/// A little more than braking takes is left for it.
const BRAKING: f64 = 1.1;

/// Cycles in which an acceleration rises at the fastest.
const RISE: f64 = 4.0;

/// All pieces from the one that the robot is on.
#[derive(Clone, Debug, Default)]
pub(crate) struct Course {
    pieces: VecDeque<Arc<Piece>>,
    /// Where the robot is on the first piece, in s of nominal time.
    at: f64,
    /// The length of a cycle in s.
    cycle: f64,
    timing: Timing,
    /// Where the robot is on the first cell of the timing, and how it moves.
    state: State,
    /// The governor's backup for that state; of no meaning where the pilot leads.
    backup: Change,
    /// The share of the speed that the robot has settled to.
    share: f64,
    /// Who leads the robot in the profile O, and to rest where that is sooner than the governor would.
    pilot: Option<Box<Pilot>>,
    /// Whether the pilot has taken over from the governor, until the robot rests; and how hard the stop is for which that has been
    /// asked for.
    relieved: bool,
    asked: Option<f64>,
    /// Whether the pilot has found no law from rest here.
    unled: bool,
    /// Who finds laws for the pilot, what is looked for, and the law from the next stop on.
    finder: Finder,
    sought: Option<Sought>,
    next: Option<Next>,
    /// What became of motions that were offered.
    answer: Option<Answer>,
    /// Whether motions are to be appended behind a stop.
    refusing: bool,
    /// In a draft: up to where nothing has changed, in s of nominal time.
    drafted: Option<f64>,
    /// How many pieces have been left behind.
    gone: u64,
    /// s of nominal time before the first piece, since the course began.
    passed: f64,
    /// The last motion, which the next one may still round off.
    tail: Option<Tail>,
}

/// A target that should be rounded off, at which the robot stops.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Sharp {
    /// The running number of the motion behind it.
    pub number: u64,
    /// Its program line.
    pub line: u32,
    /// The program line of the motion before it, where the robot cannot go beside the target, however small the zone; `None`: the motion
    /// behind it came too late.
    pub corner: Option<u32>,
}

/// The end of the way.
#[derive(Clone, Debug)]
struct Tail {
    motion: Arc<Motion>,
    /// The motion before it, where a blend leads from there.
    joined: Option<Joined>,
}

/// A blend whose end, in the middle of a motion, is straight as long as it is not known what comes behind that motion.
#[derive(Clone, Debug)]
struct Joined {
    before: Arc<Motion>,
    /// How the motion before is bent where the blend begins.
    bend: Bend,
    /// How many pieces there are from the blend's first half on.
    pieces: usize,
}

/// A motion that can be appended where cycles take `cycle` s.
pub(crate) fn risen(motion: Motion, cycle: f64) -> Arc<Motion> {
    Arc::new(motion.rising_in(RISE * cycle))
}

/// Whether a stretch began with the first of pieces that were taken back.
fn began(taken: &[(Arc<Piece>, bool)]) -> bool {
    taken.last().is_none_or(|(_, began)| *began)
}

impl Tail {
    fn meeting(&self, next: &Arc<Motion>) -> Meeting {
        let before: Before = self.joined.as_ref().map(|joined| (Arc::clone(&joined.before), joined.bend));
        Meeting { before, from: Arc::clone(&self.motion), to: Arc::clone(next) }
    }
}

impl Course {
    /// The piece that the robot is on.
    pub(crate) fn first(&self) -> Option<&Piece> {
        self.pieces.front().map(|piece| &**piece)
    }

    /// The motion that is blended with the one that was appended last, `number`, and the share at which it is left.
    pub(crate) fn left_before(&self, number: u64) -> Option<(u64, f64)> {
        let before = self.pieces.iter().rev().find(|piece| piece.number != number)?;
        let rounded = before.ends && !before.stops && before.progress.is_some();
        rounded.then(|| (before.number, before.leave))
    }

    /// The motion that counts as being executed, and the share of its way that is done. A blend belongs to the motion that
    /// is joined (manual 7.3), whose way still counts from the target that is rounded off.
    pub(crate) fn current(&self) -> Option<(&Piece, f64)> {
        let first = self.pieces.front()?;
        match self.pieces.get(1).filter(|_| first.leaves()) {
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
        self.pieces.is_empty()
    }

    /// Whether the robot stands still.
    pub(crate) fn rests(&self) -> bool {
        self.state.rests()
    }

    /// Where the robot is on the first piece, in s of nominal time.
    pub(crate) fn at(&self) -> f64 {
        self.at
    }

    /// The nominal time in s that is left to go.
    pub(crate) fn time_left(&self) -> f64 {
        self.timing.length() - self.state.at
    }

    /// For how many s, at its full speed, the robot can go on before it may have to brake for the next motion: or rather for the end
    /// of what that one does not change. In the profile O a law has to lead that far.
    pub(crate) fn spare(&self) -> f64 {
        let Some(last) = self.pieces.back() else { return 0.0 };
        if self.wants_laws() {
            return self.time_left() - self.open_time() - law_hand_over::LOOKED_AHEAD;
        }
        let open = match self.tail.as_ref() {
            None => 0.0,
            Some(Tail { joined: None, motion }) if motion.corner.is_none() => last.time.min(LARGEST_ZONE / motion.rate),
            Some(_) => self.open_time(),
        };
        self.time_left() - open - BRAKING * self.timing.braking(open)
    }

    /// Whether the robot is led by laws, or will be.
    pub(crate) fn wants_laws(&self) -> bool {
        let ends = [self.pieces.front(), self.pieces.back()];
        self.is_led() || ends.into_iter().flatten().any(|piece| piece.is_free)
    }

    /// How the last motion is joined by the one before it.
    pub(crate) fn joining(&self) -> Joining {
        let joined = self.tail.as_ref().and_then(|tail| tail.joined.as_ref());
        Joining::Known(joined.map(|joined| (Arc::clone(&joined.before), joined.bend)))
    }

    /// Appends a motion that [`risen`] has made ready, with what has been prepared for it. Returns why the motion before it is not
    /// rounded off, where that was asked for.
    pub(crate) fn append(
        &mut self,
        robot: &Robot,
        (motion, number): (&Arc<Motion>, u64),
        prepared: Option<&Prepared>,
        cycle: f64,
    ) -> Option<Sharp> {
        let limits = motion.limits?;
        self.cycle = cycle;
        let tail = self.tail.take();
        if motion.flows && tail.is_some() && self.flow_on(Piece::part(motion, limits, number, 0.0, 1.0), cycle) {
            self.settle(1);
            self.timing.find_entries(MARGIN, cycle);
            self.tail = Some(Tail { motion: Arc::clone(motion), joined: None });
            return None;
        }
        let tail = tail.filter(|_| !self.pieces.is_empty());
        let known = prepared.zip(tail.as_ref()).map(|(prepared, tail)| prepared.take(robot, || tail.meeting(motion)));
        let bent = tail.as_ref().and_then(|tail| self.bent(robot, known, tail, motion));
        let mut joined = tail.as_ref().zip(bent).and_then(|(tail, bent)| {
            self.bend_into(tail, &bent, (motion, limits), number, cycle).map(|pieces| (bent.bend, pieces))
        });
        let late = Sharp { number, line: motion.line, corner: None };
        let mut sharp = motion.flows.then_some(late);
        let mut end = Arc::clone(motion);
        let mut before = None;
        if let Some(tail) = tail {
            let blended = if joined.is_none() { junction::blended(robot, known, &tail.motion, motion) } else { None };
            if joined.is_none() && blended.is_none() && asks(robot, &tail.motion) {
                sharp = Some(Sharp { corner: Some(tail.motion.line), ..late });
            }
            before = Some(tail.motion);
            if let Some(blended) = blended {
                joined = self.round_off(&blended, number, cycle).map(|pieces| (Bend::NONE, pieces));
                sharp = joined.is_none().then_some(late);
                if joined.is_some() {
                    (before, end) = (Some(blended.from), blended.to);
                }
            }
        }
        let limits = end.limits?;
        if joined.is_none() {
            let whole = self.ready([Piece::part(&end, limits, number, 0.0, 1.0)]);
            // In a stretch of its own it asks for nothing that the stop before it did not.
            if self.is_led() || !self.lay(&whole, |_| true, cycle) {
                self.push(&whole, |_| false);
            }
        }
        let joined = joined.zip(before).map(|((bend, pieces), before)| Joined { before, bend, pieces });
        self.settle(joined.as_ref().map_or(1, |joined| joined.pieces));
        self.timing.find_entries(MARGIN, cycle);
        self.tail = Some(Tail { motion: end, joined });
        sharp
    }

    /// How the last motion bends towards the next one; `None` where it does not, or the robot is on the blend before already.
    fn bent(
        &self,
        robot: &Robot,
        known: Option<&junction::Junction>,
        tail: &Tail,
        motion: &Arc<Motion>,
    ) -> Option<Bent> {
        let Joined { before, bend, pieces } = tail.joined.as_ref()?;
        if self.pieces.len() <= *pieces {
            return None;
        }
        junction::bent(robot, known, (before, *bend), (&tail.motion, motion))
    }

    /// Puts a blend behind the last one where the two meet in the middle of the last motion, and bends both there; returns
    /// how many pieces there are from the new blend on. `None` where that is not possible any more.
    fn bend_into(
        &mut self,
        tail: &Tail,
        bent: &Bent,
        (motion, limits): (&Motion, Limits),
        number: u64,
        cycle: f64,
    ) -> Option<usize> {
        let Joined { before, pieces: count, .. } = tail.joined.as_ref()?;
        let [first, next] = &bent.blends;
        let (left, last) = (self.pieces.get(self.pieces.len() - *count)?.number, self.pieces.back()?.number);
        let halves = [
            Piece::half(first, (before, &tail.motion), left, true),
            Piece::half(first, (before, &tail.motion), last, false),
            Piece::half(next, (&tail.motion, motion), last, true),
            Piece::half(next, (&tail.motion, motion), number, false),
        ];
        let rest = Piece::part(motion, limits, number, next.join, 1.0);
        let pieces = self.ready(halves.into_iter().chain((rest.time > NO_TIME).then_some(rest)));
        let kept = self.take_back(*count);
        let same_to = self.unchanged_to(0.0);
        if self.lay_any(&pieces, None, same_to, cycle) {
            return Some(pieces.len() - 2);
        }
        self.put_back(kept);
        None
    }

    /// Puts a blend in place of the end of the last motion and the start of the next; returns how many pieces there are
    /// from the blend on, `None` where the robot is not able to take it any more.
    fn round_off(&mut self, blended: &Blended, number: u64, cycle: f64) -> Option<usize> {
        let Blended { from: before, to: motion, blend, until } = blended;
        let (before_limits, limits) = (before.limits?, motion.limits?);
        let last = self.pieces.back()?;
        // Another blend has taken what this one needs.
        if last.from > blend.leave {
            return None;
        }
        let gone = last.from + self.at * before.rate;
        if self.pieces.len() == 1 && (gone >= blend.leave || gone > *until) {
            return None;
        }
        let same = (until.min(blend.leave) - last.from).max(0.0) / before.rate;
        let mut cut = Piece::part(before, before_limits, last.number, last.from, blend.leave);
        (cut.stops, cut.ends) = (false, false);
        let first = Piece::half(blend, (before, motion), last.number, true);
        let second = Piece::half(blend, (before, motion), number, false);
        let rest = Piece::part(motion, limits, number, blend.join, 1.0);
        let pieces = self.ready([cut, first, second, rest].into_iter().filter(|piece| piece.time > NO_TIME));
        let from_blend = pieces.iter().skip_while(|piece| piece.progress.is_none()).count();
        let kept = self.take_back(1);
        let same_to = self.unchanged_to(same);
        let own = pieces.first().is_some_and(|first| first.progress.is_none()).then(|| began(&kept));
        if self.lay_any(&pieces, own, same_to, cycle) {
            return Some(from_blend);
        }
        self.put_back(kept);
        None
    }

    /// Appends pieces in whatever way the robot is able to keep to them; returns whether there is one. `own`: the first of them
    /// is of the motion that the robot may be on, and did a stretch begin with that? Up to `same_to`, in s of nominal time since
    /// the course began, nothing changes by them.
    fn lay_any(&mut self, pieces: &[Arc<Piece>], own: Option<bool>, same_to: f64, cycle: f64) -> bool {
        let may = self.may_change_from(same_to);
        if self.is_led() {
            if may {
                self.push(pieces, |_| true);
            }
            return may;
        }
        self.lay(pieces, |_| true, cycle)
            || self.lay(pieces, |index| index > 0, cycle)
            // A robot that speeds up on its motion needs that one's limits as they are.
            || own.is_some_and(|began| self.lay(pieces, |index| if index == 0 { !began } else { index > 1 }, cycle))
    }

    /// Where changes begin that come so many s of nominal time behind the last piece, for whom that may concern.
    fn unchanged_to(&self, behind: f64) -> f64 {
        if self.is_watched() { self.end() + behind } else { f64::INFINITY }
    }

    /// Where the last piece ends, in s of nominal time since the course began.
    fn end(&self) -> f64 {
        self.passed + self.pieces.iter().map(|piece| piece.time).sum::<f64>()
    }

    /// Goes on from the last motion without a stop; returns whether the robot is still able to.
    fn flow_on(&mut self, piece: Piece, cycle: f64) -> bool {
        let Some(last) = self.pieces.back() else { return false };
        let mut through = Piece::clone(last).flowing();
        through.stops = false;
        let pieces = self.ready([through, piece.flowing()]);
        let kept = self.take_back(1);
        let same_to = self.unchanged_to(pieces.first().map_or(0.0, |through| through.time));
        if self.lay_any(&pieces, Some(began(&kept)), same_to, cycle) {
            return true;
        }
        self.put_back(kept);
        false
    }

    /// Whether the pilot leads, or would lead, the robot.
    fn is_led(&self) -> bool {
        self.pilot.is_some() || self.drafted.is_some()
    }

    /// Appends pieces if the robot is able to keep to them, and returns whether it is; which of them `may` join the stretch before?
    fn lay(&mut self, pieces: &[Arc<Piece>], may: impl Fn(usize) -> bool, cycle: f64) -> bool {
        let before = self.timing.next_entry();
        self.push(pieces, may);
        self.timing.find_entries(MARGIN, cycle);
        // The governor looks no farther than to the stretch behind the one where its backup ends.
        let unchanged = before.is_some() && self.timing.next_entry() >= before && self.backup_ends_here();
        if unchanged || self.state.rests() {
            return true;
        }
        match self.governor(cycle).holds(&self.state) {
            Some(backup) => {
                self.backup = backup;
                true
            }
            None => {
                self.take_back(pieces.len());
                false
            }
        }
    }

    /// Whether the backup ends on the stretch on which the robot is.
    fn backup_ends_here(&self) -> bool {
        let State { at, vel, acc } = self.state;
        self.timing.is_on_first(at + self.backup.distance(vel, acc))
    }

    /// Pieces as they can be pushed.
    fn ready(&self, pieces: impl IntoIterator<Item = Piece>) -> Vec<Arc<Piece>> {
        // Set-points are those of whole cycles: an acceleration takes a few of them to rise, also without a limit of the jerk.
        let rise = RISE * self.cycle;
        pieces.into_iter().map(|piece| Arc::new(piece.rising_in(rise))).collect()
    }

    fn push(&mut self, pieces: &[Arc<Piece>], may: impl Fn(usize) -> bool) {
        for (index, piece) in pieces.iter().enumerate() {
            self.push_shared(Arc::clone(piece), may(index));
        }
    }

    fn push_shared(&mut self, piece: Arc<Piece>, may: bool) {
        for (index, cell) in piece.cells().enumerate() {
            self.timing.push(cell, piece.stops, may || index > 0);
        }
        self.pieces.push_back(piece);
    }

    /// Joins what is alike in the timing, but for the last pieces, which may still be taken away.
    fn settle(&mut self, open: usize) {
        let open = self.pieces.iter().rev().take(open).map(|piece| piece.cells().count()).sum();
        self.timing.settle(open);
    }

    /// Takes the last pieces away; returns them, the last one first, each with whether its stretch began with it.
    fn take_back(&mut self, count: usize) -> Vec<(Arc<Piece>, bool)> {
        let mut taken = Vec::with_capacity(count);
        for piece in (0..count).map_while(|_| self.pieces.pop_back()) {
            let mut began = false;
            for _ in piece.cells() {
                began = self.timing.pop();
            }
            taken.push((piece, began));
        }
        taken
    }

    /// Puts pieces back where they were.
    fn put_back(&mut self, taken: Vec<(Arc<Piece>, bool)>) {
        for (piece, began) in taken.into_iter().rev() {
            self.push_shared(piece, !began);
        }
    }

    fn governor(&self, cycle: f64) -> Governor<'_> {
        Governor { stretches: &self.timing.stretches, cycle }
    }

    /// Goes on for a cycle; tells of each piece that is left behind. Returns whether the robot has arrived where it had
    /// to stop: at the end of the last piece that was told of.
    pub(crate) fn advance(
        &mut self,
        (robot, here): (&Arc<Robot>, &Joints),
        cycle: f64,
        pacing: Pacing,
        mut passed: impl FnMut(Arc<Piece>),
    ) -> bool {
        self.choose_leader();
        self.stop_sooner(robot, here, cycle, pacing);
        if !self.follow_pilot(robot, here, cycle, pacing) {
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
            self.arrive();
        }
        while let Some(first) = self.pieces.front() {
            // What rounding leaves of pieces before a stop is passed with it.
            let at_stop = stands && self.at >= first.time - 1e-9;
            if self.at < first.time && !at_stop {
                break;
            }
            let stops = first.stops;
            if stops && !stands {
                break;
            }
            self.at = if stops { 0.0 } else { self.at - first.time };
            self.passed = if stops { 0.0 } else { self.passed + first.time };
            if let Some(piece) = self.pieces.pop_front() {
                self.gone += 1;
                passed(piece);
            }
            if stops {
                break;
            }
        }
        stands
    }

    /// Whoever leads the robot from rest leads it until it stops: the pilot where the first motion has the profile O.
    fn choose_leader(&mut self) {
        if self.state.rests() && self.pilot.is_none() && !self.unled {
            let optimal = self.pieces.front().is_some_and(|first| first.is_free);
            self.pilot = optimal.then(Box::default);
        }
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
        let kept = self.pieces.iter().position(|piece| piece.stops).map_or(0, |last| last + 1);
        self.pieces.truncate(kept);
        self.timing.keep_to_stop();
        self.tail = None;
        self.keep_laws_to_stop();
    }

    /// Drops everything.
    pub(crate) fn clear(&mut self) {
        self.forsake();
        *self = Self { finder: std::mem::take(&mut self.finder), ..Self::default() };
    }

    /// How long the motion that counts as being executed still takes, in s, when it has run for `elapsed` s at full speed:
    /// exact where it begins and ends at rest, else as its pieces and those behind them allow.
    pub(crate) fn time_to_end(&self, elapsed: f64) -> f64 {
        let (Some(first), Some((current, _))) = (self.pieces.front(), self.current()) else { return 0.0 };
        if let Some(duration) = current.duration().filter(|_| self.pilot.is_none()) {
            return (duration - elapsed).max(0.0);
        }
        let own = |piece: &&Arc<Piece>| piece.number == current.number && !piece.leaves();
        let later = self.pieces.iter().skip(1).take_while(own);
        let end = self.passed + first.time + later.clone().map(|piece| piece.time).sum::<f64>();
        if let Some(time) = self.pilot.as_ref().and_then(|pilot| pilot.time_to(end)) {
            return time;
        }
        let mut legs = [Leg { length: 0.0, limits: first.limits }; remaining::MOST];
        let (mut known, mut at, mut stops) = (0, self.at, false);
        for (leg, piece) in legs.iter_mut().zip([first].into_iter().chain(later)) {
            let length = (piece.time - at).max(0.0);
            let vel = if length > 0.0 { length / piece.time_from(at) } else { piece.limits.vel };
            *leg = Leg { length, limits: Limits { vel, ..piece.limits } };
            (known, at, stops) = (known + 1, 0.0, piece.stops);
        }
        let legs = legs.get(..known).unwrap_or_default();
        let way: f64 = legs.iter().map(|leg| leg.length).sum();
        let exit = if stops { 0.0 } else { self.timing.highest_speed(self.state.at + way, MARGIN, self.cycle) };
        remaining::time_over(legs, exit, self.state.vel, self.state.acc)
    }
}
