//! How the follower leads the robot along the path, and how motions join the path meanwhile.
//!
//! Finding a law takes some cycles. What changes the path where such a law may lead waits until the law is there. What
//! changes the path under the current law is an offer: it joins the path once a law has been found for it. Where none
//! is found, the robot keeps to what it has and the offer is repeated until it would come too late.

use std::sync::Arc;

use crate::command::joints::Joints;
use crate::follow::governor::Pacing;
use crate::follow::segment::Segment;
use crate::junction::blend_thread::Prepared;
use crate::limits::profile::{Change, State};
use crate::plan::motion::Motion;
use crate::queue::path_buffer::leader::{Appending, Leader};
use crate::queue::path_buffer::{ACCELERATION_RISE_CYCLES, NEAR_STOP_S, PathBuffer, Tail, UnblendedTarget};
use crate::time_optimal::constraint_sampler::{ConstraintSampler, Part};
use crate::time_optimal::law_follower::{LawFollower, RenewalRequest, StopRequest};
use crate::time_optimal::law_solver_thread::{FIRST_LOOK_AHEAD_S, Found, LawRequest, LawSolver, Search, Status};
use crate::time_optimal::solver::{BoundaryState, Law};
use arl_robot::robot::Robot;

/// A law looks no farther than this, in s of nominal time.
const FARTHEST_LOOK_S: f64 = 4.0 * FIRST_LOOK_AHEAD_S;
/// Where the path exceeds the first look-ahead by this factor, its end may be left out.
const LOOK_AHEAD_FACTOR: f64 = 1.2;
/// With this much path, in s of nominal time, laws no faster than nominal time leave its end out; a little more, since
/// they begin where the robot will be.
pub(crate) const LOOKED_AHEAD_S: f64 = LOOK_AHEAD_FACTOR * FIRST_LOOK_AHEAD_S + 0.2;

/// A chain of more segments than this is dense: this share of it stays open behind a law that looks at least this many
/// s ahead. Each motion that joins where a law leads waits for another law, and too many would.
const SEGMENTS_OF_DENSE_CHAIN: usize = 1500;
const OPEN_SHARE_OF_DENSE_CHAIN: f64 = 0.4;
const LEAST_LAW_ON_DENSE_CHAIN_S: f64 = 0.4;
/// Time in s after which an offer for which no law was found is repeated.
const OFFERED_AGAIN_AFTER_S: f64 = 0.01;

/// The mean speed of a law relative to nominal time, at least 1. Where motions are slow at a few places only, the
/// look-ahead is that much longer.
pub(crate) fn faster(law: Option<&Law>) -> f64 {
    law.map_or(1.0, |law| law.mean_speed().max(1.0))
}

/// What leads the robot along the path, and the laws that are sought.
#[derive(Clone, Debug, Default)]
pub(crate) struct LawHandOver {
    pub(crate) leader: Leader,
    /// The scale of the stop for which a stop shorter than the governor's was requested.
    pub(crate) stop_asked: Option<f64>,
    /// Finds laws.
    pub(crate) solver: LawSolver,
    /// The law that is being sought.
    pub(crate) pending: Option<PendingLaw>,
    /// The law from the next stop on.
    pub(crate) next: Option<Next>,
    /// What became of motions that were offered, and the s until they are offered again where no law was found.
    pub(crate) answer: Option<OfferOutcome>,
    pub(crate) offer_pause: f64,
    pub(crate) appending: Appending,
}

/// A law that is being sought, and its purpose.
#[derive(Clone, Debug)]
pub(crate) struct PendingLaw {
    pub(crate) search: Search,
    pub(crate) purpose: Purpose,
    /// End of the part of the path that it may lead over, in s of nominal time.
    reach: f64,
}

impl PendingLaw {
    /// Whether the law will be of use however late it comes.
    fn begins_at_rest(&self, follower: &LawFollower) -> bool {
        match self.purpose {
            Purpose::Next => true,
            Purpose::Start => follower.rests(),
            Purpose::Renew | Purpose::GoOn(_) | Purpose::StopRequest(_) | Purpose::ShorterStop | Purpose::Offer(_) => {
                false
            }
        }
    }
}

#[derive(Clone, Debug)]
pub(crate) enum Purpose {
    /// To start from rest.
    Start,
    /// To continue behind the current law.
    Renew,
    /// To continue, at a share of the speed, in the middle of braking.
    GoOn(f64),
    /// To come to rest sooner, with acceleration and jerk scaled by this factor.
    StopRequest(f64),
    /// To come to rest sooner where the governor brakes.
    ShorterStop,
    /// To start from the next stop.
    Next,
    /// To continue along another path.
    Offer(Box<Draft>),
}

impl Purpose {
    /// Whether the law is for the path up to the next stop.
    fn leads_on(&self) -> bool {
        !matches!(self, Self::Next)
    }
}

impl LawHandOver {
    /// Whether a law for such a purpose is being sought.
    pub(crate) fn seeks(&self, is_wanted: impl Fn(&Purpose) -> bool) -> bool {
        self.pending.as_ref().is_some_and(|pending| is_wanted(&pending.purpose))
    }
}

/// A law from the next stop on.
#[derive(Clone, Debug)]
pub(crate) struct Next {
    found: Option<Found>,
    /// As in [`PendingLaw`], counted from the stop.
    reach: f64,
}

/// The path as it would be with some more motions.
#[derive(Clone, Debug)]
pub(crate) struct Draft {
    /// Number of segments, since the path began, that stay.
    same: u64,
    segments: Vec<Arc<Segment>>,
    tail: Option<Tail>,
    /// Place up to which nothing changes, in s of nominal time.
    same_to: f64,
    /// Targets that are not rounded off although they should be, with the reasons.
    unblended: Vec<UnblendedTarget>,
    /// Number of motions.
    count: usize,
}

/// What became of an offer.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum OfferOutcome {
    /// `count` motions joined the path; `unblended`: targets that are not rounded off although they should be.
    Taken { unblended: Vec<UnblendedTarget>, count: usize },
    /// The motions have to be laid behind a stop.
    Refused,
}

impl PathBuffer {
    /// See [`crate::queue::Queue::follow_real_time`].
    pub(crate) fn follow_real_time(&mut self, in_real_time: bool) {
        self.laws.solver.follow_real_time(in_real_time);
    }

    /// The number of laws that came too late.
    pub(crate) fn late_laws(&self) -> u64 {
        self.laws.solver.late()
    }

    /// Whether the next motion has to wait: a law is being sought that might lead over what the motion changes.
    pub(crate) fn is_asking(&self) -> bool {
        let offers = |pending: &PendingLaw| matches!(pending.purpose, Purpose::Offer(_));
        let waits =
            |pending: &PendingLaw| offers(pending) || (pending.purpose.leads_on() && self.changes(pending.reach));
        // The robot will soon be at rest, and then continues with the governor.
        self.laws.pending.as_ref().is_some_and(waits)
            || (self.laws.offer_pause > 0.0 && self.is_laid_down())
            || (matches!(self.laws.leader, Leader::ShorterStop(_)) && self.is_laid_down())
    }

    /// Whether a motion that is appended now changes the path where the current law leads.
    pub(crate) fn is_laid_down(&self) -> bool {
        self.laws.leader.follower().is_some_and(|follower| self.changes(follower.end()))
    }

    /// Appends a motion behind the stop at the end; returns the same as [`PathBuffer::append`].
    pub(crate) fn append_behind_stop(
        &mut self,
        robot: &Robot,
        motion: &Arc<Motion>,
        number: u64,
        prepared: Option<&Prepared>,
        cycle: f64,
    ) -> Option<UnblendedTarget> {
        self.laws.appending = Appending::BehindStop;
        let unblended = self.append(robot, motion, number, prepared, cycle);
        self.laws.appending = Appending::Blended;
        unblended
    }

    /// What became of the motions that were offered, once it is known.
    pub(crate) fn take_answer(&mut self) -> Option<OfferOutcome> {
        self.laws.answer.take()
    }

    /// Whether the robot is at rest until a law is found.
    pub(crate) fn awaits_law(&self) -> bool {
        self.laws.leader.follower().is_some_and(|follower| follower.rests())
    }

    /// Whether the next motion may change the path before `reach`.
    fn changes(&self, reach: f64) -> bool {
        reach > self.segments.end() - self.open_time()
    }

    /// How long the last segments take that the next motion may replace, in s of nominal time.
    pub(crate) fn open_time(&self) -> f64 {
        self.segments.iter().rev().take(self.open()).map(|segment| segment.time).sum()
    }

    /// The number of last segments that the next motion may replace.
    fn open(&self) -> usize {
        self.tail.as_ref().and_then(|tail| tail.joined.as_ref()).map_or(1, |joined| joined.segments.max(1))
    }

    /// Offers motions to the path: they join it as soon as a law that leads along them has been found, or at once where
    /// none is needed.
    pub(crate) fn offer<'a>(
        &mut self,
        robot: &Arc<Robot>,
        here: &Joints,
        motions: impl Iterator<Item = (&'a Arc<Motion>, u64, Option<&'a Prepared>)>,
        cycle: f64,
    ) {
        let Some(follower) = self.laws.leader.follower() else { return };
        let mut draft = Self {
            segments: self.segments.clone(),
            at: self.at,
            tail: self.tail.clone(),
            laws: LawHandOver { appending: Appending::Draft(f64::INFINITY), ..LawHandOver::default() },
            ..Self::default()
        };
        let (mut unblended, mut count) = (Vec::new(), 0);
        for (motion, number, prepared) in motions {
            unblended.extend(draft.append(robot, motion, number, prepared, cycle));
            count += 1;
        }
        let same = self.segments.shared_with(&draft.segments);
        let offered = Draft {
            same: self.segments.gone() + same as u64,
            segments: draft.segments.range(same, draft.segments.len() - same).cloned().collect(),
            tail: draft.tail.clone(),
            same_to: if let Appending::Draft(same_to) = draft.laws.appending { same_to } else { f64::NEG_INFINITY },
            unblended,
            count,
        };
        if follower.end() <= offered.same_to {
            self.take(offered);
            return;
        }
        // The cycle in which it is taken over has not begun either.
        let cycles = self.search_cycles(cycle);
        let renewal = follower.state_after(cycles - 1, cycle);
        match renewal.filter(|renewal| renewal.at < offered.same_to) {
            Some(renewal) => {
                let purpose = Purpose::Offer(Box::new(offered));
                let sampler = draft.sampler(robot, here, renewal.at, renewal.law.as_deref());
                self.search(sampler, renewal.start, renewal.law, cycles, purpose);
            }
            None => self.laws.answer = Some(OfferOutcome::Refused),
        }
    }

    /// Puts the segments of a draft in place of those at the end.
    fn take(&mut self, draft: Draft) {
        let Some(kept) = draft.same.checked_sub(self.segments.gone()) else {
            self.laws.answer = Some(OfferOutcome::Refused);
            return;
        };
        self.drop_next_beyond(draft.same_to);
        self.take_back(self.segments.len().saturating_sub(kept as usize));
        for segment in draft.segments {
            self.push_shared(segment, true);
        }
        self.tail = draft.tail;
        self.settle(self.open());
        self.laws.answer = Some(OfferOutcome::Taken { unblended: draft.unblended, count: draft.count });
    }

    /// Whether anything depends on the path as it is.
    pub(crate) fn is_watched(&self) -> bool {
        self.is_law_driven() || self.laws.pending.is_some() || self.laws.next.is_some()
    }

    /// Whether segments may join the path as far as the follower is concerned: where nothing changes up to the end of
    /// its law. A draft accepts everything, and notes from where on it changes.
    pub(crate) fn may_change_from(&mut self, same_to: f64) -> bool {
        match &mut self.laws.appending {
            Appending::Draft(unchanged) => {
                *unchanged = unchanged.min(same_to);
                return true;
            }
            Appending::BehindStop => return false,
            Appending::Blended => {}
        }
        self.drop_next_beyond(same_to);
        self.laws.leader.follower().is_none_or(|follower| follower.end() <= same_to)
    }

    /// Drops the law from the next stop on where it leads beyond `same_to`: it may no longer be valid.
    fn drop_next_beyond(&mut self, same_to: f64) {
        let pending =
            self.laws.pending.as_ref().filter(|pending| !pending.purpose.leads_on()).map(|pending| pending.reach);
        let Some(reach) = pending.or(self.laws.next.as_ref().map(|next| next.reach)) else { return };
        let stop = if self.laws.leader.follower().is_some() { self.segments.next_stop() } else { 0.0 };
        if stop + reach > same_to {
            self.laws.next = None;
            if pending.is_some() {
                self.cancel();
            }
        }
    }

    /// What a law from `at` on has to know: the path up to the next stop, or as far as a law looks. The last segments
    /// are left out where the path is long enough without them, and a part of a dense chain, so that motions join
    /// behind the law.
    fn sampler(&self, robot: &Arc<Robot>, near: &Joints, at: f64, before: Option<&Law>) -> ConstraintSampler {
        let segments = self.segments.len();
        let faster = faster(before);
        let (settled, room) = if segments > SEGMENTS_OF_DENSE_CHAIN {
            ((segments as f64 * (1.0 - OPEN_SHARE_OF_DENSE_CHAIN)) as usize, at + LEAST_LAW_ON_DENSE_CHAIN_S)
        } else {
            (segments.saturating_sub(self.open()), at + faster * LOOK_AHEAD_FACTOR * FIRST_LOOK_AHEAD_S)
        };
        self.sampler_up_to(robot, at, near, at + faster * FARTHEST_LOOK_S, settled, room)
    }

    /// The path from `at` to the next stop, or to `farthest`. The segments from the index `settled` on are left out
    /// where they begin behind `room`.
    pub(crate) fn sampler_up_to(
        &self,
        robot: &Arc<Robot>,
        at: f64,
        near: &Joints,
        farthest: f64,
        settled: usize,
        room: f64,
    ) -> ConstraintSampler {
        let stop = self.segments.first_stop().unwrap_or(usize::MAX);
        let from = self.segments.index_at(at).min(stop);
        let far = self.segments.index_at(farthest).max(from);
        let to = far.min(stop).saturating_add(1).min(self.segments.len());
        let leaves_out = (from + 1..to).contains(&settled) && self.segments.start_of(settled) >= room;
        let to = if leaves_out { settled } else { to };
        let last = to.checked_sub(1).and_then(|last| self.segments.get(last));
        let part = Part {
            segments: self.segments.shared(),
            from,
            count: to.saturating_sub(from),
            begin: self.segments.start_of(from),
            end: self.segments.start_of(to),
            stops: !leaves_out && last.is_some_and(|last| last.stops),
        };
        ConstraintSampler::new(robot, part, at, near)
    }

    fn search(
        &mut self,
        sampler: ConstraintSampler,
        start: BoundaryState,
        law: Option<Arc<Law>>,
        cycles: u32,
        purpose: Purpose,
    ) {
        self.search_for(LawRequest::Fastest(start, law), sampler, cycles, purpose);
    }

    pub(crate) fn search_for(
        &mut self,
        request: LawRequest,
        sampler: ConstraintSampler,
        cycles: u32,
        purpose: Purpose,
    ) {
        let reach = sampler.end;
        self.cancel();
        self.laws.pending =
            Some(PendingLaw { search: self.laws.solver.search(sampler, request, cycles), purpose, reach });
    }

    /// Cancels the search for a law.
    pub(crate) fn cancel(&mut self) {
        if let Some(pending) = self.laws.pending.take() {
            pending.search.cancel();
        }
    }

    /// Takes away the remaining path at rest; another path can begin.
    pub(crate) fn suspend(&mut self) -> Self {
        self.cancel();
        (self.laws.next, self.laws.answer) = (None, None);
        self.return_to_governor();
        let laws = LawHandOver { solver: std::mem::take(&mut self.laws.solver), ..LawHandOver::default() };
        std::mem::replace(self, Self { laws, ..Self::default() })
    }

    /// Puts a suspended path back, in place of a path that has come to its end.
    pub(crate) fn resume_suspended(&mut self, path: Self) {
        self.cancel();
        let solver = std::mem::take(&mut self.laws.solver);
        *self = path;
        self.laws.solver = solver;
    }

    /// Drops what leads on behind the next stop.
    pub(crate) fn keep_laws_to_stop(&mut self) {
        self.laws.next = None;
        if self.laws.seeks(|purpose| matches!(purpose, Purpose::Next | Purpose::Offer(_))) {
            self.cancel();
        }
        self.laws.answer = None;
    }

    /// At a stop: a pending search is of use only if its law starts from there.
    pub(crate) fn end_at_stop(&mut self) {
        self.return_to_governor();
        if self.laws.seeks(Purpose::leads_on) {
            self.cancel();
        }
    }

    /// Advances by a cycle along the follower's law; returns `false` where there is no follower.
    pub(crate) fn follow_law(&mut self, robot: &Arc<Robot>, here: &Joints, cycle: f64, pacing: Pacing) -> bool {
        let (mut follower, is_shorter_stop) = match std::mem::take(&mut self.laws.leader) {
            Leader::Laws(follower) => (follower, false),
            Leader::ShorterStop(follower) => (follower, true),
            governor @ (Leader::Governor | Leader::GovernorWithoutLaw) => {
                self.laws.leader = governor;
                return false;
            }
        };
        let share = match pacing {
            Pacing::Go(share) | Pacing::Settle(share) => Some(share),
            Pacing::Stop(_) => None,
        };
        self.take_found(&mut follower, share.unwrap_or(1.0));
        if matches!(self.laws.leader, Leader::GovernorWithoutLaw) {
            return false;
        }
        match pacing {
            Pacing::Stop(stop_scale) if is_shorter_stop => drop(follower.brake(stop_scale)),
            // It comes to rest, and the robot continues from there.
            _ if is_shorter_stop => {}
            Pacing::Stop(stop_scale) => self.request_stop(&mut follower, robot, here, cycle, stop_scale),
            // Laws that are being sought assume the share that is known.
            Pacing::Go(share) | Pacing::Settle(share) => {
                self.drop_stop_search();
                if !self.laws.seeks(Purpose::leads_on) {
                    follower.go_at(share, self.searching(cycle));
                    self.request_law(&mut follower, robot, here, cycle, share);
                }
            }
        }
        if let Some(next) = follower.next(cycle) {
            let mut distance = next.at - self.segments.passed() - self.at;
            if follower.rests() {
                // Rounding must neither keep the robot from a stop nor carry it past one.
                let stop = self.timing.to_stop() - self.state.at;
                distance = if distance > stop - NEAR_STOP_S { stop } else { distance };
            }
            self.state = State { at: self.state.at + distance, vel: next.vel, acc: next.acc };
            self.at += distance;
        }
        if follower.rests() {
            self.drop_stop_search();
            if is_shorter_stop {
                (self.backup, self.laws.stop_asked) = (Change::default(), None);
                return true;
            }
        }
        self.laws.leader = if is_shorter_stop { Leader::ShorterStop(follower) } else { Leader::Laws(follower) };
        true
    }

    /// Brakes to rest at once, and requests a shorter stop where braking takes long.
    fn request_stop(
        &mut self,
        follower: &mut LawFollower,
        robot: &Arc<Robot>,
        here: &Joints,
        cycle: f64,
        stop_scale: f64,
    ) {
        match self.laws.pending.as_ref().map(|pending| &pending.purpose) {
            Some(Purpose::StopRequest(pending)) if *pending >= stop_scale => return,
            Some(Purpose::StopRequest(_) | Purpose::GoOn(_)) => self.cancel(),
            _ => {}
        }
        if follower.brake(stop_scale) {
            self.settle_offer(follower);
        }
        let cycles = self.search_cycles(cycle);
        let Some(StopRequest { at, start, about, end }) = follower.request_stop(cycles, cycle, stop_scale) else {
            return;
        };
        // What is being sought would lead on, or can wait.
        self.settle_offer(follower);
        self.cancel();
        let sampler = self.sampler_up_to(robot, at, here, end, usize::MAX, f64::INFINITY);
        let request = LawRequest::Shortest { start, about, stop_scale };
        self.search_for(
            request,
            sampler.up_to(end).for_stop(ACCELERATION_RISE_CYCLES * cycle),
            cycles,
            Purpose::StopRequest(stop_scale),
        );
    }

    /// Cancels the search for a shorter stop.
    fn drop_stop_search(&mut self) {
        if self.laws.seeks(|purpose| matches!(purpose, Purpose::StopRequest(_))) {
            self.cancel();
        }
    }

    /// Takes over the law that was sought, when it is due.
    fn take_found(&mut self, follower: &mut LawFollower, share: f64) {
        let Some(pending) = &mut self.laws.pending else { return };
        let found = match self.laws.solver.look(&mut pending.search) {
            Status::Running => return,
            Status::Done(found) => found,
            Status::Late if pending.begins_at_rest(follower) => {
                if follower.rests() {
                    self.laws.solver.note_late(&mut pending.search);
                }
                return;
            }
            Status::Late => {
                self.laws.solver.note_late(&mut pending.search);
                pending.search.cancel();
                None
            }
        };
        let Some(PendingLaw { purpose, reach, .. }) = self.laws.pending.take() else { return };
        match purpose {
            Purpose::Start if !follower.rests() => follower.join(found),
            Purpose::Start => match found {
                Some(found) => follower.start(found, share),
                None => self.laws.leader = Leader::GovernorWithoutLaw,
            },
            Purpose::Renew => {
                follower.renew(found);
            }
            Purpose::GoOn(share) => follower.go_on(found, share),
            Purpose::StopRequest(stop_scale) => follower.stop_along(found, stop_scale),
            Purpose::Next => self.laws.next = Some(Next { found, reach }),
            Purpose::Offer(draft) if follower.renew(found) => self.take(*draft),
            // The offer is repeated, as long as there is time.
            Purpose::Offer(_) => self.laws.offer_pause = OFFERED_AGAIN_AFTER_S,
            // There is a follower already.
            Purpose::ShorterStop => {}
        }
    }

    /// When the robot brakes, no law is needed for what comes behind the place where it will come to rest.
    fn settle_offer(&mut self, follower: &LawFollower) {
        let Some(pending) = self.laws.pending.take() else { return };
        match pending.purpose {
            Purpose::Next => self.laws.pending = Some(pending),
            Purpose::Offer(draft) if follower.end() <= draft.same_to => {
                pending.search.cancel();
                self.take(*draft);
            }
            Purpose::Offer(_)
            | Purpose::Start
            | Purpose::Renew
            | Purpose::GoOn(_)
            | Purpose::StopRequest(_)
            | Purpose::ShorterStop => {
                pending.search.cancel();
            }
        }
    }

    /// Requests the law that will be needed next.
    fn request_law(&mut self, follower: &mut LawFollower, robot: &Arc<Robot>, here: &Joints, cycle: f64, share: f64) {
        if follower.rests() {
            // A law from this stop that is already being sought will do.
            if self.laws.pending.is_some() {
                return;
            }
            // Only at a stop is the robot where the law from the next stop on begins.
            let at_stop = self.segments.passed() == 0.0 && self.at == 0.0;
            if let Some(Next { found: Some(found), .. }) = self.laws.next.take_if(|_| at_stop) {
                follower.start(found, share);
                return;
            }
            let sampler = self.sampler(robot, here, self.segments.passed() + self.at, None);
            follower.set_off(&sampler, share, self.searching(cycle));
            self.search(sampler, BoundaryState::REST, None, self.search_cycles(cycle), Purpose::Start);
            return;
        }
        let cycles = self.search_cycles(cycle);
        let renewal = follower.renewal_after_stop(cycles, cycle, share).map(|renewal| (renewal, true));
        let renewal = renewal.or_else(|| Some((follower.renewal(cycles, cycle)?, false)));
        if let Some((RenewalRequest { at, start, law, share, cycles }, braking)) = renewal {
            // A search for a law from the next stop on can wait.
            self.cancel();
            let sampler = self.sampler(robot, here, at, law.as_deref());
            self.search(sampler, start, law, cycles, if braking { Purpose::GoOn(share) } else { Purpose::Renew });
        } else if self.laws.next.is_none() && self.laws.pending.is_none() && follower.stops() {
            self.request_next_law(robot, cycle);
        }
    }

    /// The number of cycles after which a law that is requested now can be taken over.
    pub(crate) fn search_cycles(&self, cycle: f64) -> u32 {
        self.laws.solver.cycles(cycle, self.segments.len() > SEGMENTS_OF_DENSE_CHAIN)
    }

    /// How long a search takes, in s, plus two cycles, so that rounding does not matter.
    fn searching(&self, cycle: f64) -> f64 {
        cycle * f64::from(self.search_cycles(cycle) + 2)
    }

    /// Requests the law that leads on from the next stop.
    fn request_next_law(&mut self, robot: &Arc<Robot>, cycle: f64) {
        let Some(stop) = self.segments.first_stop() else { return };
        let Some(last) = self.segments.get(stop) else { return };
        if self.segments.get(stop + 1).is_none_or(|first| !first.is_free) || self.is_alone(robot, stop + 1) {
            return;
        }
        // Counted from the stop on, as it will be once the robot is there.
        let from = stop + 1;
        let settled = self.segments.len().saturating_sub(self.open());
        let (mut count, mut end, mut stops) = (0, 0.0, false);
        for segment in self.segments.range(from, self.segments.len() - from) {
            if from + count == settled && count > 0 && end >= LOOK_AHEAD_FACTOR * FIRST_LOOK_AHEAD_S {
                break;
            }
            (count, end, stops) = (count + 1, end + segment.time, segment.stops);
            if stops || end > FARTHEST_LOOK_S {
                break;
            }
        }
        let part = Part { segments: self.segments.shared(), from, count, begin: 0.0, end, stops };
        let sampler = ConstraintSampler::new(robot, part, 0.0, last.target());
        self.search(sampler, BoundaryState::REST, None, self.search_cycles(cycle), Purpose::Next);
    }
}

#[cfg(test)]
impl PathBuffer {
    pub(crate) fn find_no_laws(&mut self) {
        self.laws.solver.find_nothing();
    }

    pub(crate) fn await_law(&self) {
        self.laws.pending.iter().for_each(|pending| pending.search.wait());
    }
}
