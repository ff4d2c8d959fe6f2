//! The way ahead: pieces of motions and the blends between them, one behind the other.

mod lead;

use std::collections::VecDeque;
use std::sync::Arc;

use super::bend::{Bend, bend};
use super::blend::{Blend, bent_blend, blend};
use super::finder::Finder;
use super::governor::{Governor, MARGIN, Pacing};
use super::joints::Joints;
use super::overlay::joined;
use super::piece::Piece;
use super::pilot::Pilot;
use super::plan::Motion;
use super::profile::{Change, Limits, State};
use super::remaining::{self, Leg};
use super::timing::Timing;
use super::zone::asks;
use crate::robot::Robot;
pub(super) use lead::Answer;
use lead::{Next, Sought};

/// A piece that takes no longer, in s, is none.
const NO_TIME: f64 = 1e-12;

/// What is left of the way to a stop, in s of nominal time, when only rounding is left.
const NEAR_STOP: f64 = 1e-9;

/// Cycles in which an acceleration rises at the fastest.
const RISE: f64 = 4.0;

/// All pieces from the one that the robot is on.
#[derive(Clone, Debug, Default)]
pub(super) struct Course {
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
    /// Who leads the robot in the profile O.
    pilot: Option<Box<Pilot>>,
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

/// Why the robot stops at a target that should be rounded off.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Sharp {
    /// The next motion came too late.
    Late,
    /// Beside the corner of the motion of this line the robot cannot go, however small the zone.
    NoWay {
        /// The program line.
        line: u32,
    },
}

/// The end of the way.
#[derive(Clone, Debug)]
struct Tail {
    motion: Motion,
    limits: Limits,
    /// The motion before it, where a blend leads from there.
    joined: Option<Joined>,
}

/// A blend whose end, in the middle of a motion, is straight as long as it is not known what comes behind that motion.
#[derive(Clone, Debug)]
struct Joined {
    before: Motion,
    /// How the motion before is bent where the blend begins.
    bend: Bend,
    /// How many pieces there are from the blend's first half on.
    pieces: usize,
}

/// Two motions and the blend between them.
struct Blended {
    from: (Motion, Limits),
    to: (Motion, Limits),
    blend: Blend,
    /// The part of the first motion behind which it would have to be another one for the blend.
    until: f64,
}

/// The blend that two motions ask for; a weave goes on through it.
fn blended(robot: &Robot, from: (&Motion, Limits), to: (&Motion, Limits)) -> Option<Blended> {
    let fades_from = from.0.laid.as_ref().map_or(1.0, |laid| laid.fades_from());
    let limited = |motion: Motion| Some((motion.limits?, motion)).map(|(limits, motion)| (motion, limits));
    let going_on = joined(robot, from.0, to.0).and_then(|(from, to)| Some((limited(from)?, limited(to)?)));
    if let Some((from, to)) = going_on
        && let Some(blend) = blend(robot, &from.0, &to.0)
    {
        return Some(Blended { from, to, blend, until: fades_from });
    }
    let blend = blend(robot, from.0, to.0)?;
    Some(Blended { from: (from.0.clone(), from.1), to: (to.0.clone(), to.1), blend, until: 1.0 })
}

impl Course {
    /// The piece that the robot is on.
    pub(super) fn first(&self) -> Option<&Piece> {
        self.pieces.front().map(|piece| &**piece)
    }

    /// The motion that is blended with the one that was appended last, `number`, and the share at which it is left.
    pub(super) fn left_before(&self, number: u64) -> Option<(u64, f64)> {
        let before = self.pieces.iter().rev().find(|piece| piece.number != number)?;
        let rounded = before.ends && !before.stops && before.progress.is_some();
        rounded.then(|| (before.number, before.shares[0]))
    }

    /// The motion that counts as being executed, and the share of its way that is done. A blend belongs to the motion that
    /// is joined (manual 7.3), whose way still counts from the target that is rounded off.
    pub(super) fn current(&self) -> Option<(&Piece, f64)> {
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
    pub(super) fn last(&self) -> Option<&Motion> {
        self.tail.as_ref().map(|tail| &tail.motion)
    }

    /// Whether nothing is left to go.
    pub(super) fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// Whether the robot stands still.
    pub(super) fn rests(&self) -> bool {
        self.state.rests()
    }

    /// Where the robot is on the first piece, in s of nominal time.
    pub(super) fn at(&self) -> f64 {
        self.at
    }

    /// The nominal time in s that is left to go.
    pub(super) fn time_left(&self) -> f64 {
        self.timing.length() - self.state.at
    }

    /// Appends a motion. Returns why the motion before it is not rounded off, where that was asked for.
    pub(super) fn append(&mut self, robot: &Robot, motion: Motion, number: u64, cycle: f64) -> Option<Sharp> {
        let motion = motion.rising_in(RISE * cycle);
        let limits = motion.limits?;
        self.cycle = cycle;
        let tail = self.tail.take();
        if motion.flows && tail.is_some() && self.flow_on(Piece::part(&motion, limits, number, 0.0, 1.0), cycle) {
            self.settle(1);
            self.timing.find_entries(MARGIN, cycle);
            self.tail = Some(Tail { motion, limits, joined: None });
            return None;
        }
        let tail = tail.filter(|_| !self.pieces.is_empty());
        let mut joined = tail.as_ref().and_then(|tail| self.bend_into(robot, tail, (&motion, limits), number, cycle));
        let mut sharp = motion.flows.then_some(Sharp::Late);
        let mut end = (motion, limits);
        let mut before = None;
        if let Some(tail) = tail {
            let blended =
                if joined.is_none() { blended(robot, (&tail.motion, tail.limits), (&end.0, limits)) } else { None };
            if joined.is_none() && blended.is_none() && asks(robot, &tail.motion) {
                sharp = Some(Sharp::NoWay { line: tail.motion.line });
            }
            before = Some(tail.motion);
            if let Some(blended) = blended {
                joined = self.round_off(&blended, number, cycle).map(|pieces| (Bend::NONE, pieces));
                sharp = joined.is_none().then_some(Sharp::Late);
                if joined.is_some() {
                    (before, end) = (Some(blended.from.0), blended.to);
                }
            }
        }
        let (motion, limits) = end;
        if joined.is_none() {
            let whole = [Piece::part(&motion, limits, number, 0.0, 1.0)];
            // In a stretch of its own it asks for nothing that the stop before it did not.
            if self.is_led() || !self.lay(&whole, true, cycle) {
                self.push(&whole, false);
            }
        }
        let joined = joined.zip(before).map(|((bend, pieces), before)| Joined { before, bend, pieces });
        self.settle(joined.as_ref().map_or(1, |joined| joined.pieces));
        self.timing.find_entries(MARGIN, cycle);
        self.tail = Some(Tail { motion, limits, joined });
        sharp
    }

    /// Puts a blend behind the last one where the two meet in the middle of the last motion, and bends both there; returns
    /// the bend and how many pieces there are from the new blend on. `None` where that is not possible any more.
    fn bend_into(
        &mut self,
        robot: &Robot,
        tail: &Tail,
        (motion, limits): (&Motion, Limits),
        number: u64,
        cycle: f64,
    ) -> Option<(Bend, usize)> {
        let Joined { before, bend: start, pieces: count } = tail.joined.as_ref()?;
        // The robot must not be on the blend yet.
        if self.pieces.len() <= *count {
            return None;
        }
        let bend = bend(robot, before, &tail.motion, motion)?;
        if bend == Bend::NONE {
            return None;
        }
        let bent = bent_blend(robot, before, &tail.motion, [*start, bend])?;
        let next = bent_blend(robot, &tail.motion, motion, [bend, Bend::NONE])?;
        let (first, last) = (self.pieces.get(self.pieces.len() - *count)?.number, self.pieces.back()?.number);
        let mut pieces = vec![
            Piece::half(&bent, (before, &tail.motion), first, true),
            Piece::half(&bent, (before, &tail.motion), last, false),
            Piece::half(&next, (&tail.motion, motion), last, true),
            Piece::half(&next, (&tail.motion, motion), number, false),
        ];
        let rest = Piece::part(motion, limits, number, next.join, 1.0);
        pieces.extend((rest.time > NO_TIME).then_some(rest));
        let kept = self.take_back(*count);
        let same_to = self.unchanged_to(0.0);
        if self.lay_any(&pieces, same_to, cycle) {
            return Some((bend, pieces.len() - 2));
        }
        self.put_back(kept);
        None
    }

    /// Puts a blend in place of the end of the last motion and the start of the next; returns how many pieces there are
    /// from the blend on, `None` where the robot is not able to take it any more.
    fn round_off(&mut self, blended: &Blended, number: u64, cycle: f64) -> Option<usize> {
        let Blended { from: (before, before_limits), to: (motion, limits), blend, until } = blended;
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
        let mut cut = Piece::part(before, *before_limits, last.number, last.from, blend.leave);
        (cut.stops, cut.ends) = (false, false);
        let first = Piece::half(blend, (before, motion), last.number, true);
        let second = Piece::half(blend, (before, motion), number, false);
        let rest = Piece::part(motion, *limits, number, blend.join, 1.0);
        let pieces: Vec<Piece> = [cut, first, second, rest].into_iter().filter(|piece| piece.time > NO_TIME).collect();
        let from_blend = pieces.iter().skip_while(|piece| piece.progress.is_none()).count();
        let kept = self.take_back(1);
        let same_to = self.unchanged_to(same);
        if self.lay_any(&pieces, same_to, cycle) {
            return Some(from_blend);
        }
        self.put_back(kept);
        None
    }

    /// Appends pieces in whatever way the robot is able to keep to them; returns whether there is one. Up to `same_to`, in s
    /// of nominal time since the course began, nothing changes by them.
    fn lay_any(&mut self, pieces: &[Piece], same_to: f64, cycle: f64) -> bool {
        let may = self.may_change_from(same_to);
        if self.is_led() {
            if may {
                self.push(pieces, true);
            }
            return may;
        }
        self.lay(pieces, true, cycle) || self.lay(pieces, false, cycle)
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
        let pieces = [through, piece.flowing()];
        let kept = self.take_back(1);
        let same_to = self.unchanged_to(pieces[0].time);
        if self.lay_any(&pieces, same_to, cycle) {
            return true;
        }
        self.put_back(kept);
        false
    }

    /// Whether the pilot leads, or would lead, the robot.
    fn is_led(&self) -> bool {
        self.pilot.is_some() || self.drafted.is_some()
    }

    /// Appends pieces if the robot is able to keep to them, and returns whether it is; `may` they join the last stretch?
    fn lay(&mut self, pieces: &[Piece], may: bool, cycle: f64) -> bool {
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

    fn push(&mut self, pieces: &[Piece], may: bool) {
        for (index, piece) in pieces.iter().enumerate() {
            self.push_one(piece.clone(), may || index > 0);
        }
    }

    fn push_one(&mut self, mut piece: Piece, may: bool) {
        // Set-points are those of whole cycles: an acceleration takes a few of them to rise, also without a limit of the jerk.
        piece.limits = piece.limits.rising_in(RISE * self.cycle);
        self.push_shared(Arc::new(piece), may);
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
    pub(super) fn advance(
        &mut self,
        (robot, here): (&Arc<Robot>, &Joints),
        cycle: f64,
        pacing: Pacing,
        mut passed: impl FnMut(Arc<Piece>),
    ) -> bool {
        self.choose_leader();
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
            let optimal = self.pieces.front().is_some_and(|first| first.pace.is_some());
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
    pub(super) fn keep_to_stop(&mut self) {
        let kept = self.pieces.iter().position(|piece| piece.stops).map_or(0, |last| last + 1);
        self.pieces.truncate(kept);
        self.timing.keep_to_stop();
        self.tail = None;
        self.keep_laws_to_stop();
    }

    /// Drops everything.
    pub(super) fn clear(&mut self) {
        self.forsake();
        *self = Self { finder: std::mem::take(&mut self.finder), ..Self::default() };
    }

    /// How long the motion that counts as being executed still takes, in s, when it has run for `elapsed` s at full speed:
    /// exact where it begins and ends at rest, else as its pieces and those behind them allow.
    pub(super) fn time_to_end(&self, elapsed: f64) -> f64 {
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
