//! How the pilot leads the robot along the course, and how motions join the course meanwhile.
//!
//! Looking for a law takes some cycles. What changes the course where such a law may lead waits until it is there; what changes it
//! under the law in hand is an offer: it is made when a law has been found for it, else the robot keeps to what it has.

use std::sync::Arc;

use crate::blend::blend_thread::Prepared;
use crate::command::joints::Joints;
use crate::follow::governor::Pacing;
use crate::follow::segment::Piece;
use crate::limits::profile::MARGIN;
use crate::limits::profile::State;
use crate::plan::motion::Motion;
use crate::queue::path_buffer::{Course, NEAR_STOP, RISE, Sharp, Tail};
use crate::time_optimal::constraint_sampler::Scout;
use crate::time_optimal::law_follower::{Halt, Pilot, Wish};
use crate::time_optimal::law_solver_thread::{Finder, Found, Quest, Search, WINDOW};
use crate::time_optimal::solver::Edge;
use arl_robot::robot::Robot;

/// A law looks no farther than so many s of nominal time.
const FARTHEST: f64 = 4.0 * WINDOW;
/// With a part of this more than the first look ahead, the end of the course may be left out.
const ROOM: f64 = 1.2;
/// With so much course, in s of nominal time, laws leave its end out; a little more, as they begin where the robot will be.
pub(crate) const LOOKED_AHEAD: f64 = ROOM * WINDOW + 0.2;

/// A law that is being looked for, and what for.
#[derive(Clone, Debug)]
pub(crate) struct Sought {
    pub(crate) search: Search,
    pub(crate) purpose: Purpose,
    /// Where the part of the course ends that it may lead over, in s of nominal time.
    reach: f64,
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
    Halt(f64),
    /// The same where the governor brakes.
    Sooner,
    /// To go off from the next stop.
    Next,
    /// To go on along another course.
    Offer(Box<Draft>),
}

/// A law from the next stop on.
#[derive(Clone, Debug)]
pub(crate) struct Next {
    found: Option<Found>,
    /// As in [`Sought`], counted from the stop.
    reach: f64,
}

/// The course as it would be with some motions more.
#[derive(Clone, Debug)]
pub(crate) struct Draft {
    /// The number of pieces, since the course began, that stay.
    same: u64,
    pieces: Vec<Arc<Piece>>,
    tail: Option<Tail>,
    /// Up to where nothing changes, in s of nominal time.
    same_to: f64,
    /// Why targets are not rounded off that should be.
    sharp: Vec<Sharp>,
    /// How many motions they are.
    count: usize,
}

/// What became of an offer.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum Answer {
    /// So many motions joined the course, and why targets are not rounded off that should be.
    Taken { sharp: Vec<Sharp>, count: usize },
    /// They have to come behind a stop.
    Refused,
}

impl Course {
    /// Whether the next motion has to wait: a law is being found that might lead over what it changes.
    pub(crate) fn is_asking(&self) -> bool {
        let offers = |sought: &Sought| matches!(sought.purpose, Purpose::Offer(_));
        let waits = |sought: &Sought| offers(sought) || (self.leads_on(sought) && self.changes(sought.reach));
        // It rests soon, and goes on as the governor says.
        self.sought.as_ref().is_some_and(waits) || (self.relieved && self.is_laid_down())
    }

    /// Whether a motion that is appended now changes the course where the law in hand leads.
    pub(crate) fn is_laid_down(&self) -> bool {
        self.pilot.as_ref().is_some_and(|pilot| self.changes(pilot.end()))
    }

    /// Appends a motion behind the stop at the end; returns the same as [`Course::append`].
    pub(crate) fn append_behind_stop(
        &mut self,
        robot: &Robot,
        motion: (&Arc<Motion>, u64),
        prepared: Option<&Prepared>,
        cycle: f64,
    ) -> Option<Sharp> {
        self.refusing = true;
        let sharp = self.append(robot, motion, prepared, cycle);
        self.refusing = false;
        sharp
    }

    /// What became of the motions that were offered, once it is known.
    pub(crate) fn take_answer(&mut self) -> Option<Answer> {
        self.answer.take()
    }

    /// Whether the robot rests until a law is found.
    pub(crate) fn awaits_law(&self) -> bool {
        !self.unled && self.pilot.as_ref().is_some_and(|pilot| pilot.rests())
    }

    /// Whether a law is for this part of the course, up to the next stop.
    fn leads_on(&self, sought: &Sought) -> bool {
        !matches!(sought.purpose, Purpose::Next)
    }

    /// Whether the next motion may change the course before `reach`.
    fn changes(&self, reach: f64) -> bool {
        reach > self.end() - self.open_time()
    }

    /// How long the last pieces take that the next motion may take the place of, in s of nominal time.
    pub(crate) fn open_time(&self) -> f64 {
        self.pieces.iter().rev().take(self.open()).map(|piece| piece.time).sum()
    }

    /// How many of the last pieces the next motion may take the place of.
    fn open(&self) -> usize {
        self.tail.as_ref().and_then(|tail| tail.joined.as_ref()).map_or(1, |joined| joined.pieces.max(1))
    }

    /// Offers motions to the course: they join it as soon as a law has been found that leads along them. At once where none is
    /// needed.
    pub(crate) fn offer<'a>(
        &mut self,
        (robot, here): (&Arc<Robot>, &Joints),
        motions: impl Iterator<Item = ((&'a Arc<Motion>, u64), Option<&'a Prepared>)>,
        cycle: f64,
    ) {
        let Some(pilot) = &self.pilot else { return };
        let mut draft = Self {
            pieces: self.pieces.clone(),
            at: self.at,
            passed: self.passed,
            tail: self.tail.clone(),
            drafted: Some(f64::INFINITY),
            ..Self::default()
        };
        let (mut sharp, mut count) = (Vec::new(), 0);
        for (motion, prepared) in motions {
            sharp.extend(draft.append(robot, motion, prepared, cycle));
            count += 1;
        }
        let same = self.pieces.iter().zip(&draft.pieces).take_while(|(a, b)| Arc::ptr_eq(a, b)).count();
        let offered = Draft {
            same: self.gone + same as u64,
            pieces: draft.pieces.iter().skip(same).cloned().collect(),
            tail: draft.tail.clone(),
            same_to: draft.drafted.unwrap_or(f64::NEG_INFINITY),
            sharp,
            count,
        };
        if pilot.end() <= offered.same_to {
            self.take(offered);
            return;
        }
        // The cycle in which it is taken over has not begun either.
        let wish = pilot.state_after(Finder::cycles(cycle) - 1, cycle);
        match wish.filter(|wish| wish.at < offered.same_to) {
            Some(wish) => {
                let purpose = Purpose::Offer(Box::new(offered));
                let scout = draft.scout(robot, here, wish.at);
                self.search(scout, wish.start, Finder::cycles(cycle), purpose);
            }
            None => self.answer = Some(Answer::Refused),
        }
    }

    /// Puts the pieces of a draft in place of those at the end.
    fn take(&mut self, draft: Draft) {
        let Some(kept) = draft.same.checked_sub(self.gone) else {
            self.answer = Some(Answer::Refused);
            return;
        };
        self.take_back(self.pieces.len().saturating_sub(kept as usize));
        for piece in draft.pieces {
            self.push_shared(piece, true);
        }
        self.tail = draft.tail;
        self.settle(self.open());
        self.timing.find_entries(MARGIN, self.cycle);
        self.answer = Some(Answer::Taken { sharp: draft.sharp, count: draft.count });
    }

    /// Whether somebody counts on the course as it is.
    pub(crate) fn is_watched(&self) -> bool {
        self.drafted.is_some() || self.sought.is_some() || self.next.is_some() || self.pilot.is_some()
    }

    /// Whether pieces may join the course as far as the pilot is concerned: where nothing changes up to the end of its law. A
    /// draft takes everything, and notes from where on it changes.
    pub(crate) fn may_change_from(&mut self, same_to: f64) -> bool {
        if let Some(drafted) = &mut self.drafted {
            *drafted = drafted.min(same_to);
            return true;
        }
        if self.refusing {
            return false;
        }
        // A law from the next stop on may not hold any more.
        let sought = self.sought.as_ref().filter(|sought| !self.leads_on(sought)).map(|sought| sought.reach);
        if let Some(reach) = sought.or(self.next.as_ref().map(|next| next.reach))
            && reach + if self.pilot.is_some() { self.next_stop() } else { 0.0 } > same_to
        {
            self.next = None;
            if sought.is_some() {
                self.forsake();
            }
        }
        self.pilot.as_ref().is_none_or(|pilot| pilot.end() <= same_to)
    }

    /// Where the robot has to stop next, in s of nominal time since the course began.
    fn next_stop(&self) -> f64 {
        let mut end = self.passed;
        for piece in &self.pieces {
            end += piece.time;
            if piece.stops {
                break;
            }
        }
        end
    }

    /// What a law from `at` on has to know: the course up to the next stop, or as far as a law looks; but for its last pieces
    /// where it is long enough without.
    fn scout(&self, robot: &Arc<Robot>, near: &Joints, at: f64) -> Scout {
        let pieces = self.pieces.iter();
        let settled = self.pieces.len().saturating_sub(self.open());
        Scout::new(robot, (pieces, self.passed), (at, near), at + FARTHEST, (settled, at + ROOM * WINDOW))
    }

    fn search(&mut self, scout: Scout, start: Edge, cycles: u32, purpose: Purpose) {
        self.search_for(Quest::Fastest(start), scout, cycles, purpose);
    }

    pub(crate) fn search_for(&mut self, quest: Quest, scout: Scout, cycles: u32, purpose: Purpose) {
        let reach = scout.end;
        self.sought = Some(Sought { search: self.finder.search(scout, quest, cycles), purpose, reach });
    }

    /// Says that nothing is looked for any more.
    pub(crate) fn forsake(&mut self) {
        if let Some(sought) = self.sought.take() {
            sought.search.forsake();
            if let Purpose::Offer(_) = sought.purpose {
                self.answer = Some(Answer::Refused);
            }
        }
    }

    /// Takes what is left away, at rest; another course can begin.
    pub(crate) fn lay_aside(&mut self) -> Self {
        self.forsake();
        (self.pilot, self.unled) = (None, false);
        (self.next, self.answer) = (None, None);
        self.hand_back();
        let empty = Self { finder: std::mem::take(&mut self.finder), ..Self::default() };
        std::mem::replace(self, empty)
    }

    /// Puts back what was laid aside, in place of a course that has come to its end.
    pub(crate) fn take_up(&mut self, course: Self) {
        self.forsake();
        *self = Self { finder: std::mem::take(&mut self.finder), ..course };
    }

    /// Drops what goes on behind the next stop.
    pub(crate) fn keep_laws_to_stop(&mut self) {
        self.next = None;
        if self.sought.as_ref().is_some_and(|sought| matches!(sought.purpose, Purpose::Next | Purpose::Offer(_))) {
            self.forsake();
        }
        self.answer = None;
    }

    /// At a stop: what is looked for is of use only if it goes on from there.
    pub(crate) fn arrive(&mut self) {
        (self.pilot, self.unled) = (None, false);
        self.hand_back();
        if self.sought.as_ref().is_some_and(|sought| self.leads_on(sought)) {
            self.forsake();
        }
    }

    /// Goes on for a cycle as the pilot says; `false` where there is none.
    pub(crate) fn follow_pilot(&mut self, robot: &Arc<Robot>, here: &Joints, cycle: f64, pacing: Pacing) -> bool {
        let Some(mut pilot) = self.pilot.take() else { return false };
        let share = match pacing {
            Pacing::Go(share) | Pacing::Settle(share) => Some(share),
            Pacing::Stop(_) => None,
        };
        self.take_sought(&mut pilot, share.unwrap_or(1.0));
        if self.unled {
            return false;
        }
        match pacing {
            Pacing::Stop(harder) if self.relieved => drop(pilot.brake(harder)),
            // It comes to rest, and goes on from there.
            _ if self.relieved => {}
            Pacing::Stop(harder) => self.halt(&mut pilot, (robot, here), cycle, harder),
            // Laws that are being looked for count on the share that is known.
            Pacing::Go(share) | Pacing::Settle(share) => {
                self.halt_no_more();
                if !self.sought.as_ref().is_some_and(|sought| self.leads_on(sought)) {
                    pilot.go_at(share, searching(cycle));
                    self.ask(&mut pilot, (robot, here), cycle, share);
                }
            }
        }
        if let Some(next) = pilot.next(cycle) {
            let mut way = next.at - self.passed - self.at;
            if pilot.rests() {
                // Rounding must neither keep it from a stop nor carry it past one.
                let stop = self.timing.to_stop() - self.state.at;
                way = if way > stop - NEAR_STOP { stop } else { way };
            }
            self.state = State { at: self.state.at + way, vel: next.vel, acc: next.acc };
            self.at += way;
        }
        if pilot.rests() {
            self.halt_no_more();
            if self.relieved {
                self.hand_back();
                return true;
            }
        }
        self.pilot = Some(pilot);
        true
    }

    /// Brakes to rest at once, and asks for a shorter way to rest where that takes long.
    fn halt(&mut self, pilot: &mut Pilot, (robot, here): (&Arc<Robot>, &Joints), cycle: f64, harder: f64) {
        match self.sought.as_ref().map(|sought| &sought.purpose) {
            Some(Purpose::Halt(sought)) if *sought >= harder => return,
            Some(Purpose::Halt(_) | Purpose::GoOn(_)) => self.forsake(),
            _ => {}
        }
        if pilot.brake(harder) {
            self.settle_offer(pilot);
        }
        let cycles = Finder::cycles(cycle);
        let Some(Halt { at, start, about, end }) = pilot.halt(cycles, cycle, harder) else { return };
        // What is looked for would lead on, or can wait.
        self.settle_offer(pilot);
        self.forsake();
        let scout = Scout::new(robot, (self.pieces.iter(), self.passed), (at, here), end, (usize::MAX, f64::INFINITY));
        let quest = Quest::Shortest { start, about, harder };
        self.search_for(quest, scout.up_to(end).for_stop(RISE * cycle), cycles, Purpose::Halt(harder));
    }

    /// Looks for a way to rest no longer.
    fn halt_no_more(&mut self) {
        if self.sought.as_ref().is_some_and(|sought| matches!(sought.purpose, Purpose::Halt(_))) {
            self.forsake();
        }
    }

    /// Takes over the law that was looked for, when it is time.
    fn take_sought(&mut self, pilot: &mut Pilot, share: f64) {
        let Some(found) = self.sought.as_mut().and_then(|sought| sought.search.next()) else { return };
        let Some(Sought { purpose, reach, .. }) = self.sought.take() else { return };
        match purpose {
            Purpose::Start if !pilot.rests() => pilot.join(found),
            Purpose::Start => match found {
                Some(found) => pilot.start(found, share),
                None => self.unled = true,
            },
            Purpose::Renew => {
                pilot.renew(found);
            }
            Purpose::GoOn(share) => pilot.go_on(found, share),
            Purpose::Halt(harder) => pilot.halt_along(found, harder),
            Purpose::Next => self.next = Some(Next { found, reach }),
            Purpose::Offer(draft) if pilot.renew(found) => self.take(*draft),
            Purpose::Offer(_) => self.answer = Some(Answer::Refused),
            // It has a pilot already.
            Purpose::Sooner => {}
        }
    }

    /// When it brakes, no law is needed for what comes behind the place where it will rest.
    fn settle_offer(&mut self, pilot: &Pilot) {
        let Some(sought) = self.sought.take() else { return };
        match sought.purpose {
            Purpose::Next => self.sought = Some(sought),
            Purpose::Offer(draft) if pilot.end() <= draft.same_to => {
                sought.search.forsake();
                self.take(*draft);
            }
            Purpose::Offer(_) => {
                sought.search.forsake();
                self.answer = Some(Answer::Refused);
            }
            Purpose::Start | Purpose::Renew | Purpose::GoOn(_) | Purpose::Halt(_) | Purpose::Sooner => {
                sought.search.forsake();
            }
        }
    }

    /// Asks for the law that will be needed next.
    fn ask(&mut self, pilot: &mut Pilot, (robot, here): (&Arc<Robot>, &Joints), cycle: f64, share: f64) {
        if pilot.rests() {
            // One that is being looked for from this stop on will do.
            if self.sought.is_some() {
                return;
            }
            // Only at a stop it is where the law from the next stop on begins.
            let at_stop = self.passed == 0.0 && self.at == 0.0;
            if let Some(Next { found: Some(found), .. }) = self.next.take_if(|_| at_stop) {
                pilot.start(found, share);
                return;
            }
            let scout = self.scout(robot, here, self.passed + self.at);
            pilot.set_off(&scout, share, searching(cycle));
            self.search(scout, Edge::REST, Finder::cycles(cycle), Purpose::Start);
            return;
        }
        let cycles = Finder::cycles(cycle);
        let wish = pilot.wish_to_go_on(cycles, cycle, share).map(|wish| (wish, true));
        let wish = wish.or_else(|| Some((pilot.wish(cycles, cycle)?, false)));
        if let Some((Wish { at, start, share, cycles }, braking)) = wish {
            // What is looked for from the next stop on can wait.
            self.forsake();
            let scout = self.scout(robot, here, at);
            self.search(scout, start, cycles, if braking { Purpose::GoOn(share) } else { Purpose::Renew });
        } else if self.next.is_none() && self.sought.is_none() && pilot.stops() {
            self.ask_next(robot, cycle);
        }
    }

    /// Asks for the law that leads on from the next stop.
    fn ask_next(&mut self, robot: &Arc<Robot>, cycle: f64) {
        let Some(stop) = self.pieces.iter().position(|piece| piece.stops) else { return };
        let Some(last) = self.pieces.get(stop) else { return };
        if self.pieces.get(stop + 1).is_none_or(|first| !first.is_free) {
            return;
        }
        let behind = self.pieces.iter().skip(stop + 1);
        let settled = self.pieces.len().saturating_sub(stop + 1 + self.open());
        let scout = Scout::new(robot, (behind, 0.0), (0.0, last.target()), FARTHEST, (settled, ROOM * WINDOW));
        self.search(scout, Edge::REST, Finder::cycles(cycle), Purpose::Next);
    }
}

/// How long a search takes, in s, and two cycles more, so that rounding does not count.
fn searching(cycle: f64) -> f64 {
    cycle * f64::from(Finder::cycles(cycle) + 2)
}
