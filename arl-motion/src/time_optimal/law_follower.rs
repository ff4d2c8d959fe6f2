//! How the robot moves along the path where time laws lead.
//!
//! Invariant: the current law brings the robot to rest on the path, within all limits, at whatever share of its speed
//! it is followed. Another law takes its place only when it starts from exactly the state of the robot; where none is
//! found, the robot keeps to the current one. So no motion, stop or change of the override can lead the robot off the
//! path or beyond a limit.
//!
//! From rest the robot starts before it has a law, on a ramp that would come to rest again, and joins the law while
//! moving.
//!
//! Laws are found in parallel with the cycle. What has to be done at once, stops and changes of the override, is done
//! with the current law and with the limits that it was found from; where that makes a long stop, a shorter one is
//! sought in parallel with the cycle.

use std::sync::Arc;

use crate::limits::profile::State;
use crate::time_optimal::constraint_sampler::{ConstraintSampler, SampledPath};
use crate::time_optimal::law_solver_thread::Found;
use crate::time_optimal::limit_check::{LimitCheck, Timed};
use crate::time_optimal::ramp::Ramp;
use crate::time_optimal::solver::{BoundaryState, Law, Moment};
use crate::time_optimal::speed_scaling::{SpeedScaling, followed};

/// A law is renewed when less than this share of it is left, if there is more path.
const RENEWED_AT_REMAINING_SHARE: f64 = 0.5;
/// A law is renewed when no more than this number of searches fit into what is left of it.
const REMAINING_SEARCHES: f64 = 2.0;
/// A new law must be about as quick as the current one over this share of what is left of the current one.
const COMPARED_SHARE: f64 = 0.3;
const SLOWEST_RENEWAL_FACTOR: f64 = 1.1;
/// Time in s until the next attempt after a search without a result.
const RETRY_AFTER_S: f64 = 0.02;
/// A stop that ends no more than this many s before the law does counts as the stop of the law.
const SAME_STOP_S: f64 = 0.001;
/// Possible durations in s of a change of the override, or of a stop for which no ramp is found.
const SCALING_DURATIONS_S: [f64; 7] = [0.03, 0.06, 0.12, 0.25, 0.5, 1.0, 2.0];
/// A stop that takes longer than this, in s, is begun, and a shorter one is sought, which has to save at least this
/// much.
const LONG_STOP_S: f64 = 0.05;
const LEAST_GAIN_S: f64 = 0.004;
/// A law is joined with this share of the acceleration and jerk where possible: between the places, limits are not
/// exact.
const JOINING_SHARE_OF_LIMITS: f64 = 0.985;
/// The longest time of a change of the override along the current law, where there is another possibility.
const QUICK_SCALING_S: f64 = 0.25;
/// A start from rest looks ahead for this multiple of the time of speeding up.
const SETTING_OFF_LOOK_FACTOR: f64 = 2.5;
/// A remainder of a duration or of a distance, in s, that counts as zero.
const NO_TIME_S: f64 = 1e-9;

/// The position of the robot on its law.
#[derive(Clone, Debug)]
struct Drive {
    found: Found,
    /// Time on the law, in s.
    time: f64,
}

impl Drive {
    fn remaining_time(&self) -> f64 {
        self.found.law.duration() - self.time
    }

    fn is_over(&self) -> bool {
        self.remaining_time() <= NO_TIME_S
    }

    /// Whether another law that starts here is about as quick, before this one slows down for its end.
    fn is_as_quick(&self, other: &Found) -> bool {
        let later = COMPARED_SHARE * self.remaining_time();
        let there = self.found.law.at(self.time + later).at.min(other.end);
        let own = self.found.law.time_at(there) - self.time;
        other.law.time_at(there) <= SLOWEST_RENEWAL_FACTOR * own
    }

    /// A change of the share of its speed, from a share with two derivatives, that keeps the limits, within `longest`
    /// s.
    fn easing(&self, shares: [f64; 3], to: f64, stop_scale: f64, longest: f64) -> Option<Easing> {
        SCALING_DURATIONS_S.iter().take_while(|duration| **duration <= longest).find_map(|duration| {
            let easing = Easing { scaling: SpeedScaling::new(shares, to, *duration), time: 0.0, from: self.time };
            self.found.check.keeps(&Eased { law: &self.found.law, easing }, stop_scale).then_some(easing)
        })
    }
}

/// A change of the share at which the law is followed.
#[derive(Clone, Copy, Debug)]
struct Easing {
    scaling: SpeedScaling,
    time: f64,
    /// Time on the law at which the change began.
    from: f64,
}

impl Easing {
    /// The remaining time, in s.
    fn remaining_time(&self) -> f64 {
        self.scaling.duration() - self.time
    }

    /// Whether it leads to rest.
    fn stops(&self) -> bool {
        self.scaling.to() == 0.0
    }
}

/// A law while the share of its speed changes.
struct Eased<'a> {
    law: &'a Law,
    easing: Easing,
}

impl Timed for Eased<'_> {
    fn at(&self, time: f64) -> Moment {
        let Easing { scaling, time: begun, .. } = self.easing;
        followed(&self.of_law(time), scaling.at(begun + time))
    }

    fn duration(&self) -> f64 {
        self.easing.remaining_time()
    }

    fn known(&self, time: f64) -> Option<Moment> {
        Some(self.of_law(time))
    }
}

impl Eased<'_> {
    /// The moment of the law at the same place.
    fn of_law(&self, time: f64) -> Moment {
        let Easing { scaling, time: begun, from } = self.easing;
        self.law.at(from + scaling.passed(begun + time))
    }
}

/// How the robot continues if nothing else is requested.
#[derive(Clone, Debug, Default)]
struct Ahead {
    /// The law; `None` at rest.
    main: Option<Drive>,
    /// The share of its speed at which the law is followed, and the change of that share.
    share: f64,
    easing: Option<Easing>,
    /// A ramp that leads away from the law, to rest; the law is then no longer followed.
    ramp: Option<Ramp>,
}

/// Follows laws, cycle by cycle.
#[derive(Clone, Debug, Default)]
pub(crate) struct LawFollower {
    ahead: Ahead,
    /// The s until another attempt is made.
    pause: f64,
    /// The s until another attempt for another share of the speed is made.
    share_pause: f64,
    /// The s until another attempt for a shorter stop is made.
    stop_pause: f64,
    /// The scale of the limits with which it brakes, where it does.
    stop_scale: f64,
    /// Whether the current stop is already the shortest.
    shortest: bool,
    /// Whether its last start was in vain.
    in_vain: bool,
}

/// The state from which another law is requested, some cycles from now.
pub(crate) struct RenewalRequest {
    /// Place, in s of nominal time.
    pub(crate) at: f64,
    pub(crate) start: BoundaryState,
    /// The law that leads there.
    pub(crate) law: Option<Arc<Law>>,
    /// Share of its speed at which the law will be followed.
    pub(crate) share: f64,
    /// Number of cycles until then.
    pub(crate) cycles: u32,
}

/// The state from which a shorter stop is requested, some cycles from now.
pub(crate) struct StopRequest {
    /// Place, in s of nominal time.
    pub(crate) at: f64,
    pub(crate) start: BoundaryState,
    /// The distance to rest if the limits there stay the same, and the farthest place at which it has to be at rest.
    pub(crate) about: f64,
    pub(crate) end: f64,
}

impl Ahead {
    fn rests(&self) -> bool {
        self.main.is_none() && self.ramp.is_none()
    }

    /// The share of the law's speed, with two derivatives.
    fn shares(&self) -> [f64; 3] {
        self.easing.map_or([self.share, 0.0, 0.0], |easing| easing.scaling.at(easing.time))
    }

    /// The limits along the current path, and where it ends; behind its end the path may have changed meanwhile.
    fn limits(&self) -> Option<(&Arc<LimitCheck>, f64)> {
        match (&self.ramp, &self.main) {
            (Some(ramp), _) => Some((&ramp.check, ramp.end)),
            (None, Some(main)) => Some((&main.found.check, main.found.end)),
            (None, None) => None,
        }
    }

    /// The state now; `None` at rest.
    fn state(&self) -> Option<State> {
        let Moment { at, vel, acc, .. } = match (&self.ramp, &self.main) {
            (Some(ramp), _) => ramp.at(ramp.time),
            (None, Some(main)) => followed(&main.found.law.at(main.time), self.shares()),
            (None, None) => return None,
        };
        Some(State { at, vel, acc })
    }

    /// Advances by a cycle; returns where the robot has come to rest, if it has.
    fn advance(&mut self, cycle: f64) -> Option<f64> {
        if let Some(ramp) = &mut self.ramp {
            ramp.time += cycle;
            let end = (ramp.time >= ramp.duration() - NO_TIME_S).then_some(ramp.end);
            if end.is_some() {
                *self = Self::default();
            }
            return end;
        }
        let main = self.main.as_mut()?;
        let mut end = None;
        match &mut self.easing {
            Some(easing) => {
                easing.time += cycle;
                main.time = easing.from + easing.scaling.passed(easing.time);
                if easing.time >= easing.scaling.duration() - NO_TIME_S {
                    self.share = easing.scaling.to();
                    self.easing = None;
                    end = (self.share == 0.0).then(|| main.found.law.at(main.time).at);
                }
            }
            None => main.time += cycle * self.share,
        }
        if main.is_over() {
            end = Some(main.found.end);
        }
        if end.is_some() {
            *self = Self::default();
        }
        end
    }
}

impl LawFollower {
    /// A follower that leads to rest, within the limits of the path times `stop_scale`.
    pub(crate) fn resting(found: Found, stop_scale: f64) -> Self {
        let ahead = Ahead { ramp: Some(Ramp::along(found)), share: 1.0, ..Ahead::default() };
        Self { ahead, stop_scale, shortest: true, ..Self::default() }
    }

    /// Whether it is at rest.
    pub(crate) fn rests(&self) -> bool {
        self.ahead.rests()
    }

    /// Whether it brakes for a stop, and will not continue by itself.
    pub(crate) fn brakes(&self) -> bool {
        self.ahead.ramp.is_some() || self.ahead.easing.as_ref().is_some_and(Easing::stops)
    }

    /// The current law; `None` at rest, and before there is one.
    pub(crate) fn law(&self) -> Option<&Law> {
        self.ahead.main.as_ref().map(|main| &*main.found.law)
    }

    /// The place up to which the current law or ramp depends on the path.
    pub(crate) fn end(&self) -> f64 {
        match (&self.ahead.ramp, &self.ahead.main) {
            (Some(ramp), _) => ramp.end,
            (None, Some(main)) => main.found.end,
            (None, None) => f64::NEG_INFINITY,
        }
    }

    /// The s until the parameter reaches `at` at full speed, or the place up to which the law is certain to be followed
    /// if that is nearer, with that place; `None` where no law is followed.
    pub(crate) fn time_to(&self, at: f64) -> Option<(f64, f64)> {
        let Drive { found: Found { law, end, stops, .. }, time } = self.ahead.main.as_ref()?;
        // What comes later will be another law, if there is one.
        let renewed = law.duration() * (1.0 - RENEWED_AT_REMAINING_SHARE);
        let sure = if *stops || *time >= renewed { *end } else { law.at(renewed).at };
        let to = at.min(sure);
        Some(((law.time_at(to) - time).max(0.0), to))
    }

    /// The state a cycle later, in s of nominal time since the path began; `None` where it is already at rest.
    pub(crate) fn next(&mut self, cycle: f64) -> Option<State> {
        self.pause = (self.pause - cycle).max(0.0);
        self.share_pause = (self.share_pause - cycle).max(0.0);
        self.stop_pause = (self.stop_pause - cycle).max(0.0);
        match self.ahead.advance(cycle) {
            Some(at) => Some(State { at, vel: 0.0, acc: 0.0 }),
            None => self.ahead.state(),
        }
    }

    /// Starts from rest along a law.
    pub(crate) fn start(&mut self, found: Found, share: f64) {
        self.ahead = Ahead { main: Some(Drive { found, time: 0.0 }), share, ..Ahead::default() };
    }

    /// Starts from rest before there is a law, for the `time` s in which it is found; comes to rest again soon after if
    /// it is not found. Does not start where it has just done so in vain.
    pub(crate) fn set_off(&mut self, sampler: &ConstraintSampler, share: f64, time: f64) {
        if std::mem::take(&mut self.in_vain) {
            return;
        }
        let start = State { at: sampler.at, ..State::default() };
        let glimpsed = sampler.sample_short_part(sampler.at + SETTING_OFF_LOOK_FACTOR * time);
        let ramp = glimpsed.and_then(|SampledPath { path, end, .. }| {
            let mut ramp = Ramp::setting_off(start, &Arc::new(LimitCheck::new(path)), end, share, time)?;
            ramp.arrives = sampler.stops && sampler.end - ramp.end <= NO_TIME_S;
            // It must not come to rest on its path before the law is there.
            (ramp.arrives || ramp.duration() > time).then_some(ramp)
        });
        (self.stop_scale, self.pause) = (0.0, 0.0);
        self.ahead = Ahead { ramp, share, ..Ahead::default() };
    }

    /// Joins the law that leads on from where it has started, with a smooth transition; where that is not possible, it
    /// comes to rest again.
    pub(crate) fn join(&mut self, found: Option<Found>) {
        let joined = found.zip(self.ahead.state()).and_then(|(found, now)| {
            let time = found.law.time_at(now.at);
            let there = found.law.at(time);
            let share = now.vel / there.vel;
            let shares = [share, (now.acc - share * share * there.acc) / there.vel, 0.0];
            let main = Drive { found, time };
            let join = |stop_scale: f64| main.easing(shares, self.ahead.share, stop_scale, f64::INFINITY);
            let easing = join(JOINING_SHARE_OF_LIMITS).or_else(|| join(1.0))?;
            Some(Ahead { main: Some(main), share: self.ahead.share, easing: Some(easing), ramp: None })
        });
        self.in_vain = joined.is_none();
        if let Some(ahead) = joined {
            self.ahead = ahead;
        }
    }

    /// Whether the current law leads to where the robot has to stop.
    pub(crate) fn stops(&self) -> bool {
        self.ahead.main.as_ref().is_some_and(|main| main.found.stops)
    }

    /// The state after `cycles` cycles from which a law behind the current one is needed, if it is time for that.
    pub(crate) fn renewal(&self, cycles: u32, cycle: f64) -> Option<RenewalRequest> {
        let main = self.ahead.main.as_ref()?;
        let search = f64::from(cycles) * cycle;
        let short = main.remaining_time()
            < (RENEWED_AT_REMAINING_SHARE * main.found.law.duration()).max(REMAINING_SEARCHES * search);
        if self.pause > 0.0 || main.found.stops || !short {
            return None;
        }
        self.state_after(cycles, cycle)
    }

    /// The state after `cycles` cycles, for another law than the current one; `None` where it brakes.
    pub(crate) fn state_after(&self, cycles: u32, cycle: f64) -> Option<RenewalRequest> {
        if self.brakes() {
            return None;
        }
        let then = self.after(cycles, cycle);
        let main = then.main.as_ref()?;
        let there = main.found.law.at(main.time);
        (there.vel > 0.0).then_some(RenewalRequest {
            at: there.at,
            start: BoundaryState { vel: there.vel, acc: there.acc },
            law: Some(Arc::clone(&main.found.law)),
            share: then.share,
            cycles,
        })
    }

    /// The state after `cycles` cycles while it brakes, to continue at a share of the speed before it comes to rest, or
    /// as soon as it does.
    pub(crate) fn renewal_after_stop(&self, cycles: u32, cycle: f64, share: f64) -> Option<RenewalRequest> {
        let ramp = self.ahead.ramp.as_ref().filter(|_| self.pause <= 0.0)?;
        let (end, cycles) = (ramp.end, cycles.max((ramp.calm() / cycle).ceil() as u32));
        let then = self.after(cycles, cycle).state();
        if then.is_none() && ramp.arrives {
            return None;
        }
        let State { at, vel, acc } = then.unwrap_or(State { at: end, vel: 0.0, acc: 0.0 });
        let start = if then.is_some() {
            BoundaryState { vel: vel / share, acc: acc / (share * share) }
        } else {
            BoundaryState::REST
        };
        Some(RenewalRequest { at, start, law: None, share, cycles })
    }

    /// The state of following after `cycles` cycles.
    fn after(&self, cycles: u32, cycle: f64) -> Ahead {
        let mut then = self.ahead.clone();
        for _ in 0..cycles {
            then.advance(cycle);
        }
        then
    }

    /// Takes over the law that was requested by [`LawFollower::renewal`] a number of cycles ago; returns whether it
    /// did.
    pub(crate) fn renew(&mut self, found: Option<Found>) -> bool {
        let Ahead { main: Some(main), easing, .. } = &mut self.ahead else { return false };
        let eased = easing.map(|easing| Easing { from: -easing.scaling.passed(easing.time), ..easing });
        let keeps =
            |found: &Found| eased.is_none_or(|easing| found.check.keeps(&Eased { law: &found.law, easing }, 1.0));
        match found.filter(|found| main.is_as_quick(found) && keeps(found)) {
            Some(found) => {
                *main = Drive { found, time: 0.0 };
                *easing = eased;
                true
            }
            None => {
                self.pause = RETRY_AFTER_S;
                false
            }
        }
    }

    /// Takes over the law that was requested by [`LawFollower::renewal_after_stop`].
    pub(crate) fn go_on(&mut self, found: Option<Found>, share: f64) {
        match found {
            Some(found) => self.start(found, share),
            None => self.pause = RETRY_AFTER_S,
        }
    }

    /// Changes to another share of the speed: along the current law or, where that leaves too little of the limits, by
    /// slowing down until another law begins, which is requested by [`LawFollower::renewal_after_stop`]; that takes
    /// `search` s.
    pub(crate) fn go_at(&mut self, share: f64, search: f64) {
        let Ahead { main: Some(main), easing, ramp: None, .. } = &self.ahead else { return };
        let leads_to = easing.as_ref().map_or(self.ahead.share, |easing| easing.scaling.to());
        // What takes long may be done sooner from a later state.
        let (is_new, takes_long) =
            (leads_to != share, easing.as_ref().is_some_and(|easing| easing.remaining_time() > QUICK_SCALING_S));
        if !(is_new || takes_long) || self.share_pause > 0.0 {
            return;
        }
        let [now, ..] = self.ahead.shares();
        let too_fast = now > share;
        let slower = |now| Ramp::slower(now, &main.found, main.time, share, search);
        if let Some(easing) = main.easing(self.ahead.shares(), share, 1.0, QUICK_SCALING_S) {
            self.ahead.easing = Some(easing);
        } else if let Some(ramp) = self.ahead.state().filter(|_| is_new || too_fast).and_then(slower) {
            (self.ahead.ramp, self.stop_scale, self.pause) = (Some(ramp), 0.0, 0.0);
        } else {
            self.share_pause = RETRY_AFTER_S;
            if is_new {
                let slowly = main.easing(self.ahead.shares(), share, 1.0, f64::INFINITY);
                self.ahead.easing = slowly.or(self.ahead.easing);
            }
        }
    }

    /// Brakes to rest as is possible at once, within the limits of the path times `stop_scale`; returns whether this
    /// changed anything. There may then be a shorter stop: [`LawFollower::request_stop`].
    pub(crate) fn brake(&mut self, stop_scale: f64) -> bool {
        if (self.brakes() && stop_scale <= self.stop_scale) || (self.stop_pause > 0.0 && stop_scale <= 1.0) {
            return false;
        }
        let Some((now, check, end)) =
            self.ahead.state().zip(self.ahead.limits()).map(|(now, (check, end))| (now, check, end))
        else {
            return false;
        };
        let ramp = Ramp::hardest(now, check, end, stop_scale);
        let longest = ramp.as_ref().map_or(f64::INFINITY, Ramp::remaining_time);
        // Where the law ends as soon, rounding must not end the ramp just before it.
        if self.arrives_in() <= longest + SAME_STOP_S {
            return false;
        }
        let easing = match &self.ahead {
            Ahead { ramp: None, main: Some(main), .. } => main.easing(self.ahead.shares(), 0.0, stop_scale, longest),
            _ => None,
        };
        let found = easing.is_some() || ramp.is_some();
        match easing {
            Some(easing) => self.ahead.easing = Some(easing),
            None => self.ahead.ramp = ramp.or(self.ahead.ramp.take()),
        }
        self.shortest = false;
        if found {
            self.stop_scale = stop_scale;
        }
        self.stop_pause = 0.0;
        found
    }

    /// The state after `cycles` cycles for a shorter stop, if there may be one.
    pub(crate) fn request_stop(&self, cycles: u32, cycle: f64, stop_scale: f64) -> Option<StopRequest> {
        let known = self.shortest && stop_scale <= self.stop_scale;
        if known || self.stop_pause > 0.0 || self.time_to_rest() < LONG_STOP_S {
            return None;
        }
        let State { at, vel, acc } = self.after(cycles, cycle).state()?;
        let (check, end) = self.ahead.limits()?;
        let start = State { at, vel, acc };
        let about = Ramp::stop_distance(start, check, stop_scale);
        (vel > 0.0 && about > 0.0 && at < end).then_some(StopRequest {
            at,
            start: BoundaryState { vel, acc },
            about,
            end,
        })
    }

    /// Takes over the stop that was requested by [`LawFollower::request_stop`] a number of cycles ago, if it is
    /// shorter.
    pub(crate) fn stop_along(&mut self, found: Option<Found>, stop_scale: f64) {
        match found.filter(|found| found.law.duration() < self.time_to_rest() - LEAST_GAIN_S) {
            Some(found) => {
                self.ahead.ramp = Some(Ramp::along(found));
                (self.stop_scale, self.shortest) = (stop_scale, true);
            }
            None => {
                // Where nothing leads to rest soon, another attempt is made.
                self.shortest = self.time_to_rest() <= QUICK_SCALING_S;
                self.stop_pause = RETRY_AFTER_S;
            }
        }
    }

    /// The s until it is at rest; infinite where it neither brakes nor arrives at a stop.
    fn time_to_rest(&self) -> f64 {
        let easing = self.ahead.easing.filter(Easing::stops).map_or(f64::INFINITY, |easing| easing.remaining_time());
        self.ahead.ramp.as_ref().map_or(easing.min(self.arrives_in()), Ramp::remaining_time)
    }

    /// The s until the law leads to where the robot has to stop; infinite where it does not, or where its share of the
    /// speed is changing.
    fn arrives_in(&self) -> f64 {
        match &self.ahead {
            Ahead { main: Some(main), share, easing: None, ramp: None } if main.found.stops => {
                main.remaining_time() / share
            }
            _ => f64::INFINITY,
        }
    }
}
