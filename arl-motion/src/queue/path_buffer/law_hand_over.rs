//! How the follower leads the robot along the path, and how motions join the path meanwhile.
//!
//! Looking for a law takes some cycles. What changes the path where such a law may lead waits until it is there; what
//! changes it under the law in hand is an offer: it joins the path when a law has been found for it. Where none is, the
//! robot keeps to what it has and the offer is made again, until it would come too late.

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
use crate::time_optimal::law_solver_thread::{FIRST_LOOK_AHEAD_S, Found, LawRequest, Search, Status};
use crate::time_optimal::solver::{BoundaryState, Law};
use arl_robot::robot::Robot;

/// A law looks no farther than so many s of nominal time.
const FARTHEST_LOOK_S: f64 = 4.0 * FIRST_LOOK_AHEAD_S;
/// With a part of this more than the first look ahead, the end of the path may be left out.
const LOOK_AHEAD_FACTOR: f64 = 1.2;
/// With so much path, in s of nominal time, laws that are no faster leave its end out; a little more, as they begin
/// where the robot will be.
pub(crate) const LOOKED_AHEAD_S: f64 = LOOK_AHEAD_FACTOR * FIRST_LOOK_AHEAD_S + 0.2;

/// Of so many segments this part stays open behind a law that looks so many s ahead at least: each motion that joins
/// what a law leads along waits for another law, and too many would.
const SEGMENTS_OF_DENSE_CHAIN: usize = 1500;
const OPEN_SHARE_OF_DENSE_CHAIN: f64 = 0.4;
const LEAST_LAW_ON_DENSE_CHAIN_S: f64 = 0.4;
/// An offer for which no law was found is made again so many s later.
const OFFERED_AGAIN_AFTER_S: f64 = 0.01;

/// How many times as fast as nominal time a law goes, in the mean; once at least. Where motions are slow at a few
/// places only, it is looked as much farther.
pub(crate) fn faster(law: Option<&Law>) -> f64 {
    law.map_or(1.0, |law| law.mean_speed().max(1.0))
}

/// A law that is being looked for, and what for.
#[derive(Clone, Debug)]
pub(crate) struct PendingLaw {
    pub(crate) search: Search,
    pub(crate) purpose: Purpose,
    /// Where the part of the path ends that it may lead over, in s of nominal time.
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
    /// To go off from rest.
    Start,
    /// To go on behind the law in hand.
    Renew,
    /// To go on, at a share of the speed, in the middle of braking.
    GoOn(f64),
    /// To rest sooner, with so much more acceleration and jerk.
    StopRequest(f64),
    /// The same where the governor brakes.
    ShorterStop,
    /// To go off from the next stop.
    Next,
    /// To go on along another path.
    Offer(Box<Draft>),
}

/// A law from the next stop on.
#[derive(Clone, Debug)]
pub(crate) struct Next {
    found: Option<Found>,
    /// As in [`PendingLaw`], counted from the stop.
    reach: f64,
}

/// The path as it would be with some motions more.
#[derive(Clone, Debug)]
pub(crate) struct Draft {
    /// The number of segments, since the path began, that stay.
    same: u64,
    segments: Vec<Arc<Segment>>,
    tail: Option<Tail>,
    /// Up to where nothing changes, in s of nominal time.
    same_to: f64,
    /// Why targets are not rounded off that should be.
    unblended: Vec<UnblendedTarget>,
    /// How many motions they are.
    count: usize,
}

/// What became of an offer.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum OfferOutcome {
    /// So many motions joined the path, and why targets are not rounded off that should be.
    Taken { unblended: Vec<UnblendedTarget>, count: usize },
    /// They have to come behind a stop.
    Refused,
}

impl PathBuffer {
    /// As [`crate::queue::Queue::follow_real_time`].
    pub(crate) fn follow_real_time(&mut self, in_real_time: bool) {
        self.law_solver.follow_real_time(in_real_time);
    }

    /// How many laws came too late.
    pub(crate) fn late_laws(&self) -> u64 {
        self.law_solver.late()
    }

    /// Whether the next motion has to wait: a law is being found that might lead over what it changes.
    pub(crate) fn is_asking(&self) -> bool {
        let offers = |pending: &PendingLaw| matches!(pending.purpose, Purpose::Offer(_));
        let waits = |pending: &PendingLaw| offers(pending) || (self.leads_on(pending) && self.changes(pending.reach));
        // It rests soon, and goes on as the governor says.
        self.pending.as_ref().is_some_and(waits)
            || (self.offer_pause > 0.0 && self.is_laid_down())
            || (matches!(self.leader, Leader::ShorterStop(_)) && self.is_laid_down())
    }

    /// Whether a motion that is appended now changes the path where the law in hand leads.
    pub(crate) fn is_laid_down(&self) -> bool {
        self.leader.follower().is_some_and(|follower| self.changes(follower.end()))
    }

    /// Appends a motion behind the stop at the end; returns the same as [`PathBuffer::append`].
    pub(crate) fn append_behind_stop(
        &mut self,
        robot: &Robot,
        motion: (&Arc<Motion>, u64),
        prepared: Option<&Prepared>,
        cycle: f64,
    ) -> Option<UnblendedTarget> {
        self.appending = Appending::BehindStop;
        let unblended = self.append(robot, motion, prepared, cycle);
        self.appending = Appending::Blended;
        unblended
    }

    /// What became of the motions that were offered, once it is known.
    pub(crate) fn take_answer(&mut self) -> Option<OfferOutcome> {
        self.answer.take()
    }

    /// Whether the robot rests until a law is found.
    pub(crate) fn awaits_law(&self) -> bool {
        self.leader.follower().is_some_and(|follower| follower.rests())
    }

    /// Whether a law is for this part of the path, up to the next stop.
    fn leads_on(&self, pending: &PendingLaw) -> bool {
        !matches!(pending.purpose, Purpose::Next)
    }

    /// Whether the next motion may change the path before `reach`.
    fn changes(&self, reach: f64) -> bool {
        reach > self.end() - self.open_time()
    }

    /// How long the last segments take that the next motion may take the place of, in s of nominal time.
    pub(crate) fn open_time(&self) -> f64 {
        self.segments.iter().rev().take(self.open()).map(|segment| segment.time).sum()
    }

    /// How many of the last segments the next motion may take the place of.
    fn open(&self) -> usize {
        self.tail.as_ref().and_then(|tail| tail.joined.as_ref()).map_or(1, |joined| joined.segments.max(1))
    }

    /// Offers motions to the path: they join it as soon as a law has been found that leads along them. At once where
    /// none is needed.
    pub(crate) fn offer<'a>(
        &mut self,
        (robot, here): (&Arc<Robot>, &Joints),
        motions: impl Iterator<Item = ((&'a Arc<Motion>, u64), Option<&'a Prepared>)>,
        cycle: f64,
    ) {
        let Some(follower) = self.leader.follower() else { return };
        let mut draft = Self {
            segments: self.segments.clone(),
            ends: self.ends.clone(),
            stops: self.stops.clone(),
            gone: self.gone,
            at: self.at,
            passed: self.passed,
            tail: self.tail.clone(),
            appending: Appending::Draft(f64::INFINITY),
            ..Self::default()
        };
        let (mut unblended, mut count) = (Vec::new(), 0);
        for (motion, prepared) in motions {
            unblended.extend(draft.append(robot, motion, prepared, cycle));
            count += 1;
        }
        let same = self.segments.shared_with(&draft.segments);
        let offered = Draft {
            same: self.gone + same as u64,
            segments: draft.segments.range(same, draft.segments.len() - same).cloned().collect(),
            tail: draft.tail.clone(),
            same_to: if let Appending::Draft(same_to) = draft.appending { same_to } else { f64::NEG_INFINITY },
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
                self.search(sampler, (renewal.start, renewal.law), cycles, purpose);
            }
            None => self.answer = Some(OfferOutcome::Refused),
        }
    }

    /// Puts the segments of a draft in place of those at the end.
    fn take(&mut self, draft: Draft) {
        let Some(kept) = draft.same.checked_sub(self.gone) else {
            self.answer = Some(OfferOutcome::Refused);
            return;
        };
        self.drop_next_beyond(draft.same_to);
        self.take_back(self.segments.len().saturating_sub(kept as usize));
        for segment in draft.segments {
            self.push_shared(segment, true);
        }
        self.tail = draft.tail;
        self.settle(self.open());
        self.answer = Some(OfferOutcome::Taken { unblended: draft.unblended, count: draft.count });
    }

    /// Whether somebody counts on the path as it is.
    pub(crate) fn is_watched(&self) -> bool {
        self.is_led() || self.pending.is_some() || self.next.is_some()
    }

    /// Whether segments may join the path as far as the follower is concerned: where nothing changes up to the end of
    /// its law. A draft takes everything, and notes from where on it changes.
    pub(crate) fn may_change_from(&mut self, same_to: f64) -> bool {
        match &mut self.appending {
            Appending::Draft(unchanged) => {
                *unchanged = unchanged.min(same_to);
                return true;
            }
            Appending::BehindStop => return false,
            Appending::Blended => {}
        }
        self.drop_next_beyond(same_to);
        self.leader.follower().is_none_or(|follower| follower.end() <= same_to)
    }

    /// Drops the law from the next stop on where it leads beyond `same_to`: it may not hold any more.
    fn drop_next_beyond(&mut self, same_to: f64) {
        let pending = self.pending.as_ref().filter(|pending| !self.leads_on(pending)).map(|pending| pending.reach);
        let Some(reach) = pending.or(self.next.as_ref().map(|next| next.reach)) else { return };
        let stop = if self.leader.follower().is_some() { self.next_stop() } else { 0.0 };
        if stop + reach > same_to {
            self.next = None;
            if pending.is_some() {
                self.cancel();
            }
        }
    }

    /// Where the robot has to stop next, in s of nominal time since the path began.
    fn next_stop(&self) -> f64 {
        self.first_stop().and_then(|stop| self.ends.get(stop).copied()).unwrap_or(self.end())
    }

    /// What a law from `at` on has to know: the path up to the next stop, or as far as a law looks; but for its last
    /// segments where it is long enough without, and for a part of a dense chain, so that motions join that behind the
    /// law.
    fn sampler(&self, robot: &Arc<Robot>, near: &Joints, at: f64, before: Option<&Law>) -> ConstraintSampler {
        let segments = self.segments.len();
        let faster = faster(before);
        let settled = if segments > SEGMENTS_OF_DENSE_CHAIN {
            ((segments as f64 * (1.0 - OPEN_SHARE_OF_DENSE_CHAIN)) as usize, at + LEAST_LAW_ON_DENSE_CHAIN_S)
        } else {
            (segments.saturating_sub(self.open()), at + faster * LOOK_AHEAD_FACTOR * FIRST_LOOK_AHEAD_S)
        };
        self.sampler_up_to(robot, (at, near), at + faster * FARTHEST_LOOK_S, settled)
    }

    /// The path from `at` to the next stop, or to `farthest`; without the segments from the index `settled` on where
    /// that begins behind `room`.
    pub(crate) fn sampler_up_to(
        &self,
        robot: &Arc<Robot>,
        (at, near): (f64, &Joints),
        farthest: f64,
        (settled, room): (usize, f64),
    ) -> ConstraintSampler {
        let stop = self.first_stop().unwrap_or(usize::MAX);
        let from = self.ends.partition_point(|end| *end <= at).min(stop);
        let far = self.ends.partition_point(|end| *end <= farthest).max(from);
        let to = far.min(stop).saturating_add(1).min(self.segments.len());
        let leaves_out = (from + 1..to).contains(&settled) && self.start_of(settled) >= room;
        let to = if leaves_out { settled } else { to };
        let part = Part { segments: self.segments.clone(), from, count: to.saturating_sub(from) };
        let stops =
            !leaves_out && to.checked_sub(1).and_then(|last| self.segments.get(last)).is_some_and(|last| last.stops);
        ConstraintSampler::new(robot, part, self.start_of(from), (self.start_of(to), stops), (at, near))
    }

    /// Where the segment of an index begins, in s of nominal time since the path began.
    fn start_of(&self, index: usize) -> f64 {
        index.checked_sub(1).and_then(|before| self.ends.get(before).copied()).unwrap_or(self.passed)
    }

    fn search(
        &mut self,
        sampler: ConstraintSampler,
        (start, law): (BoundaryState, Option<Arc<Law>>),
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
        self.pending = Some(PendingLaw { search: self.law_solver.search(sampler, request, cycles), purpose, reach });
    }

    /// Says that nothing is looked for any more.
    pub(crate) fn cancel(&mut self) {
        if let Some(pending) = self.pending.take() {
            pending.search.cancel();
        }
    }

    /// Takes what is left away, at rest; another path can begin.
    pub(crate) fn suspend(&mut self) -> Self {
        self.cancel();
        (self.next, self.answer) = (None, None);
        self.return_to_governor();
        let empty = Self { law_solver: std::mem::take(&mut self.law_solver), ..Self::default() };
        std::mem::replace(self, empty)
    }

    /// Puts back what was laid aside, in place of a path that has come to its end.
    pub(crate) fn resume_suspended(&mut self, path: Self) {
        self.cancel();
        *self = Self { law_solver: std::mem::take(&mut self.law_solver), ..path };
    }

    /// Drops what goes on behind the next stop.
    pub(crate) fn keep_laws_to_stop(&mut self) {
        self.next = None;
        if self.pending.as_ref().is_some_and(|pending| matches!(pending.purpose, Purpose::Next | Purpose::Offer(_))) {
            self.cancel();
        }
        self.answer = None;
    }

    /// At a stop: what is looked for is of use only if it goes on from there.
    pub(crate) fn end_at_stop(&mut self) {
        self.return_to_governor();
        if self.pending.as_ref().is_some_and(|pending| self.leads_on(pending)) {
            self.cancel();
        }
    }

    /// Goes on for a cycle as the follower says; `false` where there is none.
    pub(crate) fn follow_law(&mut self, robot: &Arc<Robot>, here: &Joints, cycle: f64, pacing: Pacing) -> bool {
        let (mut follower, is_shorter_stop) = match std::mem::take(&mut self.leader) {
            Leader::Laws(follower) => (follower, false),
            Leader::ShorterStop(follower) => (follower, true),
            governor @ (Leader::Governor | Leader::GovernorWithoutLaw) => {
                self.leader = governor;
                return false;
            }
        };
        let share = match pacing {
            Pacing::Go(share) | Pacing::Settle(share) => Some(share),
            Pacing::Stop(_) => None,
        };
        self.take_found(&mut follower, share.unwrap_or(1.0));
        if matches!(self.leader, Leader::GovernorWithoutLaw) {
            return false;
        }
        match pacing {
            Pacing::Stop(stop_scale) if is_shorter_stop => drop(follower.brake(stop_scale)),
            // It comes to rest, and goes on from there.
            _ if is_shorter_stop => {}
            Pacing::Stop(stop_scale) => self.request_stop(&mut follower, (robot, here), cycle, stop_scale),
            // Laws that are being looked for count on the share that is known.
            Pacing::Go(share) | Pacing::Settle(share) => {
                self.drop_stop_search();
                if !self.pending.as_ref().is_some_and(|pending| self.leads_on(pending)) {
                    follower.go_at(share, self.searching(cycle));
                    self.request_law(&mut follower, (robot, here), cycle, share);
                }
            }
        }
        if let Some(next) = follower.next(cycle) {
            let mut way = next.at - self.passed - self.at;
            if follower.rests() {
                // Rounding must neither keep it from a stop nor carry it past one.
                let stop = self.timing.to_stop() - self.state.at;
                way = if way > stop - NEAR_STOP_S { stop } else { way };
            }
            self.state = State { at: self.state.at + way, vel: next.vel, acc: next.acc };
            self.at += way;
        }
        if follower.rests() {
            self.drop_stop_search();
            if is_shorter_stop {
                (self.backup, self.stop_asked) = (Change::default(), None);
                return true;
            }
        }
        self.leader = if is_shorter_stop { Leader::ShorterStop(follower) } else { Leader::Laws(follower) };
        true
    }

    /// Brakes to rest at once, and asks for a shorter way to rest where that takes long.
    fn request_stop(
        &mut self,
        follower: &mut LawFollower,
        (robot, here): (&Arc<Robot>, &Joints),
        cycle: f64,
        stop_scale: f64,
    ) {
        match self.pending.as_ref().map(|pending| &pending.purpose) {
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
        // What is looked for would lead on, or can wait.
        self.settle_offer(follower);
        self.cancel();
        let sampler = self.sampler_up_to(robot, (at, here), end, (usize::MAX, f64::INFINITY));
        let request = LawRequest::Shortest { start, about, stop_scale };
        self.search_for(
            request,
            sampler.up_to(end).for_stop(ACCELERATION_RISE_CYCLES * cycle),
            cycles,
            Purpose::StopRequest(stop_scale),
        );
    }

    /// Looks for a way to rest no longer.
    fn drop_stop_search(&mut self) {
        if self.pending.as_ref().is_some_and(|pending| matches!(pending.purpose, Purpose::StopRequest(_))) {
            self.cancel();
        }
    }

    /// Takes over the law that was looked for, when it is time.
    fn take_found(&mut self, follower: &mut LawFollower, share: f64) {
        let Some(pending) = &mut self.pending else { return };
        let found = match self.law_solver.look(&mut pending.search) {
            Status::Running => return,
            Status::Done(found) => found,
            Status::Late if pending.begins_at_rest(follower) => {
                if follower.rests() {
                    self.law_solver.note_late(&mut pending.search);
                }
                return;
            }
            Status::Late => {
                self.law_solver.note_late(&mut pending.search);
                pending.search.cancel();
                None
            }
        };
        let Some(PendingLaw { purpose, reach, .. }) = self.pending.take() else { return };
        match purpose {
            Purpose::Start if !follower.rests() => follower.join(found),
            Purpose::Start => match found {
                Some(found) => follower.start(found, share),
                None => self.leader = Leader::GovernorWithoutLaw,
            },
            Purpose::Renew => {
                follower.renew(found);
            }
            Purpose::GoOn(share) => follower.go_on(found, share),
            Purpose::StopRequest(stop_scale) => follower.stop_along(found, stop_scale),
            Purpose::Next => self.next = Some(Next { found, reach }),
            Purpose::Offer(draft) if follower.renew(found) => self.take(*draft),
            // It is made again, as long as there is time.
            Purpose::Offer(_) => self.offer_pause = OFFERED_AGAIN_AFTER_S,
            // It has a follower already.
            Purpose::ShorterStop => {}
        }
    }

    /// When it brakes, no law is needed for what comes behind the place where it will rest.
    fn settle_offer(&mut self, follower: &LawFollower) {
        let Some(pending) = self.pending.take() else { return };
        match pending.purpose {
            Purpose::Next => self.pending = Some(pending),
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

    /// Asks for the law that will be needed next.
    fn request_law(
        &mut self,
        follower: &mut LawFollower,
        (robot, here): (&Arc<Robot>, &Joints),
        cycle: f64,
        share: f64,
    ) {
        if follower.rests() {
            // One that is being looked for from this stop on will do.
            if self.pending.is_some() {
                return;
            }
            // Only at a stop it is where the law from the next stop on begins.
            let at_stop = self.passed == 0.0 && self.at == 0.0;
            if let Some(Next { found: Some(found), .. }) = self.next.take_if(|_| at_stop) {
                follower.start(found, share);
                return;
            }
            let sampler = self.sampler(robot, here, self.passed + self.at, None);
            follower.set_off(&sampler, share, self.searching(cycle));
            self.search(sampler, (BoundaryState::REST, None), self.search_cycles(cycle), Purpose::Start);
            return;
        }
        let cycles = self.search_cycles(cycle);
        let renewal = follower.renewal_after_stop(cycles, cycle, share).map(|renewal| (renewal, true));
        let renewal = renewal.or_else(|| Some((follower.renewal(cycles, cycle)?, false)));
        if let Some((RenewalRequest { at, start, law, share, cycles }, braking)) = renewal {
            // What is looked for from the next stop on can wait.
            self.cancel();
            let sampler = self.sampler(robot, here, at, law.as_deref());
            self.search(sampler, (start, law), cycles, if braking { Purpose::GoOn(share) } else { Purpose::Renew });
        } else if self.next.is_none() && self.pending.is_none() && follower.stops() {
            self.request_next_law(robot, cycle);
        }
    }

    /// After how many cycles a law that is asked for now can be taken over.
    pub(crate) fn search_cycles(&self, cycle: f64) -> u32 {
        self.law_solver.cycles(cycle, self.segments.len() > SEGMENTS_OF_DENSE_CHAIN)
    }

    /// How long a search takes, in s, and two cycles more, so that rounding does not count.
    fn searching(&self, cycle: f64) -> f64 {
        cycle * f64::from(self.search_cycles(cycle) + 2)
    }

    /// Asks for the law that leads on from the next stop.
    fn request_next_law(&mut self, robot: &Arc<Robot>, cycle: f64) {
        let Some(stop) = self.first_stop() else { return };
        let Some(last) = self.segments.get(stop) else { return };
        if self.segments.get(stop + 1).is_none_or(|first| !first.is_free) || self.is_alone(robot, stop + 1) {
            return;
        }
        // Counted from the stop on, as it will be when the robot is there.
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
        let part = Part { segments: self.segments.clone(), from, count };
        let sampler = ConstraintSampler::new(robot, part, 0.0, (end, stops), (0.0, last.target()));
        self.search(sampler, (BoundaryState::REST, None), self.search_cycles(cycle), Purpose::Next);
    }
}

#[cfg(test)]
impl PathBuffer {
    pub(crate) fn find_no_laws(&mut self) {
        self.law_solver.find_nothing();
    }

    pub(crate) fn await_law(&self) {
        self.pending.iter().for_each(|pending| pending.search.wait());
    }
}
