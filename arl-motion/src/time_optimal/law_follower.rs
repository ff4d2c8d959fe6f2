//! How the robot goes along the path where time laws lead.
//!
//! Invariant: the law in hand leads the robot to rest on the path, within all limits, at whatever share of its speed it
//! is followed. Another one takes its place only when it starts from the robot's very state; where none is found, the
//! robot keeps to the one it has. So nothing that comes up, a motion, a stop or another override, can lead it off the
//! path or beyond a limit.
//!
//! From rest the robot sets off before it has a law, on a ramp that would come to rest again: it joins the law on the
//! way.
//!
//! Laws are found beside the cycle. What has to be done at once, stops and changes of the override, is done with the
//! law in hand and with the limits that it was found from; where that makes a long stop, a shorter one is looked for
//! beside the cycle.

use std::sync::Arc;

use crate::limits::profile::State;
use crate::time_optimal::constraint_sampler::{ConstraintSampler, SampledPath};
use crate::time_optimal::law_solver_thread::Found;
use crate::time_optimal::limit_check::{LimitCheck, Timed};
use crate::time_optimal::ramp::Ramp;
use crate::time_optimal::solver::{BoundaryState, Law, Moment};
use crate::time_optimal::speed_scaling::{SpeedScaling, followed};

/// A law of which a smaller part is left is made longer when there is more path.
const RENEWED_AT_SHARE_LEFT: f64 = 0.5;
/// It is made longer when no more than so many searches fit in what is left of it.
const SEARCHES_LEFT: f64 = 2.0;
/// A new law must be about as quick as the one in hand over the next part of that.
const COMPARED_SHARE: f64 = 0.3;
const SLOWEST_RENEWAL_FACTOR: f64 = 1.1;
/// After something was not found, the next attempt is made so many s later.
const RETRY_AFTER_S: f64 = 0.02;
/// A stop that ends no more than so many s before the law does is that of the law.
const SAME_STOP_S: f64 = 0.001;
/// How many s a change of the override, or a stop for which no ramp is found, may take.
const SCALING_DURATIONS_S: [f64; 7] = [0.03, 0.06, 0.12, 0.25, 0.5, 1.0, 2.0];
/// A stop that takes longer, in s, is begun, and a shorter one looked for, which has to be shorter by so much.
const LONG_STOP_S: f64 = 0.05;
const LEAST_GAIN_S: f64 = 0.004;
/// A law is joined with this part of the acceleration and jerk, where that can be: between the places limits are not
/// certain.
const JOINING_SHARE_OF_LIMITS: f64 = 0.985;
/// So long may a change of the override take that follows the law in hand all the time, where there is another way.
const QUICK_SCALING_S: f64 = 0.25;
/// What sets off from rest looks ahead for so many times the time in which it does.
const SETTING_OFF_LOOK_FACTOR: f64 = 2.5;
/// A rest of a duration or of the way, in s, that is none.
const NO_TIME_S: f64 = 1e-9;

/// Where the robot is on its law.
#[derive(Clone, Debug)]
struct Drive {
    found: Found,
    /// s on the law.
    time: f64,
}

impl Drive {
    fn left(&self) -> f64 {
        self.found.law.duration() - self.time
    }

    fn is_over(&self) -> bool {
        self.left() <= NO_TIME_S
    }

    /// Whether another law that starts here goes on about as quickly, before this one slows down for its end.
    fn is_as_quick(&self, other: &Found) -> bool {
        let later = COMPARED_SHARE * self.left();
        let there = self.found.law.at(self.time + later).at.min(other.end);
        let own = self.found.law.time_at(there) - self.time;
        other.law.time_at(there) <= SLOWEST_RENEWAL_FACTOR * own
    }

    /// A change of the share of its speed, from one with two derivatives, that keeps the limits, within `longest` s.
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
    /// The time on the law where it began.
    from: f64,
}

impl Easing {
    /// How long it goes on, in s.
    fn left(&self) -> f64 {
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
        self.easing.left()
    }

    fn known(&self, time: f64) -> Option<Moment> {
        Some(self.of_law(time))
    }
}

impl Eased<'_> {
    /// The law at the same place.
    fn of_law(&self, time: f64) -> Moment {
        let Easing { scaling, time: begun, from } = self.easing;
        self.law.at(from + scaling.passed(begun + time))
    }
}

/// How the robot goes on if nothing comes up.
#[derive(Clone, Debug, Default)]
struct Ahead {
    /// The law; `None` at rest.
    main: Option<Drive>,
    /// The share of its speed at which it is followed, and the change of that.
    share: f64,
    easing: Option<Easing>,
    /// What leads away from the law, to rest; the law is not followed any more then.
    ramp: Option<Ramp>,
}

/// Follows laws, cycle by cycle.
#[derive(Clone, Debug, Default)]
pub(crate) struct LawFollower {
    ahead: Ahead,
    /// s until another attempt is made.
    pause: f64,
    /// The same for another share of the speed.
    share_pause: f64,
    /// The same for a shorter stop than the one in hand.
    stop_pause: f64,
    /// How hard it brakes, where it does.
    stop_scale: f64,
    /// Whether there is no shorter way to rest than the one in hand.
    shortest: bool,
    /// Whether it last set off in vain.
    in_vain: bool,
}

/// The state from which another law is wanted, some cycles from now.
pub(crate) struct RenewalRequest {
    /// Where, in s of nominal time.
    pub(crate) at: f64,
    pub(crate) start: BoundaryState,
    /// The law that leads there.
    pub(crate) law: Option<Arc<Law>>,
    /// The share of its speed at which the law will be followed.
    pub(crate) share: f64,
    /// How many cycles it is until then.
    pub(crate) cycles: u32,
}

/// The state from which a shorter stop is wanted, some cycles from now.
pub(crate) struct StopRequest {
    /// Where, in s of nominal time.
    pub(crate) at: f64,
    pub(crate) start: BoundaryState,
    /// How far it is to rest, if the limits there hold on, and where it has to rest at the farthest.
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

    /// The limits along the path in hand, and where it ends; behind that the path may be another one by now.
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

    /// Goes on for a cycle; returns where it has come to rest, if it has.
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
    /// One that leads to rest, where the limits are those of the way times `stop_scale`.
    pub(crate) fn resting(found: Found, stop_scale: f64) -> Self {
        let ahead = Ahead { ramp: Some(Ramp::along(found)), share: 1.0, ..Ahead::default() };
        Self { ahead, stop_scale, shortest: true, ..Self::default() }
    }

    /// Whether it stands still.
    pub(crate) fn rests(&self) -> bool {
        self.ahead.rests()
    }

    /// Whether it brakes for a stop, and will not go on by itself.
    pub(crate) fn brakes(&self) -> bool {
        self.ahead.ramp.is_some() || self.ahead.easing.as_ref().is_some_and(Easing::stops)
    }

    /// The law in hand; `None` at rest, and before there is one.
    pub(crate) fn law(&self) -> Option<&Law> {
        self.ahead.main.as_ref().map(|main| &*main.found.law)
    }

    /// How far the path is laid down by what is in hand.
    pub(crate) fn end(&self) -> f64 {
        match (&self.ahead.ramp, &self.ahead.main) {
            (Some(ramp), _) => ramp.end,
            (None, Some(main)) => main.found.end,
            (None, None) => f64::NEG_INFINITY,
        }
    }

    /// s until the parameter is at `at` at full speed, or at where the law is known to be followed to if that is
    /// nearer, and where that is; `None` where it does not follow a law.
    pub(crate) fn time_to(&self, at: f64) -> Option<(f64, f64)> {
        let Drive { found: Found { law, end, stops, .. }, time } = self.ahead.main.as_ref()?;
        // What comes later will be another law, if there is one.
        let renewed = law.duration() * (1.0 - RENEWED_AT_SHARE_LEFT);
        let sure = if *stops || *time >= renewed { *end } else { law.at(renewed).at };
        let to = at.min(sure);
        Some(((law.time_at(to) - time).max(0.0), to))
    }

    /// The state a cycle later, in s of nominal time since the path began; `None` where it rests already.
    pub(crate) fn next(&mut self, cycle: f64) -> Option<State> {
        self.pause = (self.pause - cycle).max(0.0);
        self.share_pause = (self.share_pause - cycle).max(0.0);
        self.stop_pause = (self.stop_pause - cycle).max(0.0);
        match self.ahead.advance(cycle) {
            Some(at) => Some(State { at, vel: 0.0, acc: 0.0 }),
            None => self.ahead.state(),
        }
    }

    /// Goes off from rest.
    pub(crate) fn start(&mut self, found: Found, share: f64) {
        self.ahead = Ahead { main: Some(Drive { found, time: 0.0 }), share, ..Ahead::default() };
    }

    /// Sets off from rest before there is a law, for `time` s in which it is found, and would rest again soon if it
    /// were not: not where it has just done so in vain.
    pub(crate) fn set_off(&mut self, sampler: &ConstraintSampler, share: f64, time: f64) {
        if std::mem::take(&mut self.in_vain) {
            return;
        }
        let start = State { at: sampler.at, ..State::default() };
        let glimpsed = sampler.sample_short_part(sampler.at + SETTING_OFF_LOOK_FACTOR * time);
        let ramp = glimpsed.and_then(|SampledPath { way, end, .. }| {
            let mut ramp = Ramp::setting_off(start, &Arc::new(LimitCheck::new(way)), end, share, time)?;
            ramp.arrives = sampler.stops && sampler.end - ramp.end <= NO_TIME_S;
            // It must not rest on its path before the law is there.
            (ramp.arrives || ramp.duration() > time).then_some(ramp)
        });
        (self.stop_scale, self.pause) = (0.0, 0.0);
        self.ahead = Ahead { ramp, share, ..Ahead::default() };
    }

    /// Takes over the law that leads on from where it has set off, which it reaches smoothly; where it is not able to,
    /// it comes to rest again.
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

    /// Whether the law in hand leads to where the robot has to stop.
    pub(crate) fn stops(&self) -> bool {
        self.ahead.main.as_ref().is_some_and(|main| main.found.stops)
    }

    /// The state after so many cycles from which the law is wanted that goes on behind the one in hand, if it is time
    /// for that.
    pub(crate) fn renewal(&self, cycles: u32, cycle: f64) -> Option<RenewalRequest> {
        let main = self.ahead.main.as_ref()?;
        let search = f64::from(cycles) * cycle;
        let short = main.left() < (RENEWED_AT_SHARE_LEFT * main.found.law.duration()).max(SEARCHES_LEFT * search);
        if self.pause > 0.0 || main.found.stops || !short {
            return None;
        }
        self.state_after(cycles, cycle)
    }

    /// The state after so many cycles, for another law than the one in hand; `None` where it brakes.
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

    /// The state after so many cycles where it brakes, to go on at a share of the speed before it rests, or as soon as
    /// it does.
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

    /// How it will go on from after so many cycles on.
    fn after(&self, cycles: u32, cycle: f64) -> Ahead {
        let mut then = self.ahead.clone();
        for _ in 0..cycles {
            then.advance(cycle);
        }
        then
    }

    /// Takes over the law for which there was a [`LawFollower::renewal`] so many cycles ago; returns whether it did.
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

    /// The same for [`LawFollower::renewal_after_stop`].
    pub(crate) fn go_on(&mut self, found: Option<Found>, share: f64) {
        match found {
            Some(found) => self.start(found, share),
            None => self.pause = RETRY_AFTER_S,
        }
    }

    /// Goes over to another share of the speed: along the law in hand, or, where that leaves too little of the limits,
    /// by slowing down until another law begins, for which there is [`LawFollower::renewal_after_stop`]; that takes
    /// `search` s.
    pub(crate) fn go_at(&mut self, share: f64, search: f64) {
        let Ahead { main: Some(main), easing, ramp: None, .. } = &self.ahead else { return };
        let leads_to = easing.as_ref().map_or(self.ahead.share, |easing| easing.scaling.to());
        // What takes long may be done sooner from a later state.
        let (is_new, takes_long) =
            (leads_to != share, easing.as_ref().is_some_and(|easing| easing.left() > QUICK_SCALING_S));
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

    /// Brakes to rest, where the limits are those of the way times `stop_scale`, as can be done at once; returns
    /// whether that is something new. There may be a shorter stop then: [`LawFollower::request_stop`].
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
        let longest = ramp.as_ref().map_or(f64::INFINITY, Ramp::left);
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

    /// The state after so many cycles for a shorter stop, if there may be one.
    pub(crate) fn request_stop(&self, cycles: u32, cycle: f64, stop_scale: f64) -> Option<StopRequest> {
        let known = self.shortest && stop_scale <= self.stop_scale;
        if known || self.stop_pause > 0.0 || self.stop_left() < LONG_STOP_S {
            return None;
        }
        let State { at, vel, acc } = self.after(cycles, cycle).state()?;
        let (check, end) = self.ahead.limits()?;
        let start = State { at, vel, acc };
        let about = Ramp::way(start, check, stop_scale);
        (vel > 0.0 && about > 0.0 && at < end).then_some(StopRequest {
            at,
            start: BoundaryState { vel, acc },
            about,
            end,
        })
    }

    /// Takes over the stop for which there was a [`LawFollower::request_stop`] so many cycles ago, if it is shorter.
    pub(crate) fn stop_along(&mut self, found: Option<Found>, stop_scale: f64) {
        match found.filter(|found| found.law.duration() < self.stop_left() - LEAST_GAIN_S) {
            Some(found) => {
                self.ahead.ramp = Some(Ramp::along(found));
                (self.stop_scale, self.shortest) = (stop_scale, true);
            }
            None => {
                // Where nothing leads to rest soon, another attempt is made.
                self.shortest = self.stop_left() <= QUICK_SCALING_S;
                self.stop_pause = RETRY_AFTER_S;
            }
        }
    }

    /// s until it rests; infinitely many where it neither brakes nor arrives.
    fn stop_left(&self) -> f64 {
        let easing = self.ahead.easing.filter(Easing::stops).map_or(f64::INFINITY, |easing| easing.left());
        self.ahead.ramp.as_ref().map_or(easing.min(self.arrives_in()), Ramp::left)
    }

    /// s until the law leads to where the robot has to stop; infinitely many where it does not, or its speed changes
    /// meanwhile.
    fn arrives_in(&self) -> f64 {
        match &self.ahead {
            Ahead { main: Some(main), share, easing: None, ramp: None } if main.found.stops => main.left() / share,
            _ => f64::INFINITY,
        }
    }
}
