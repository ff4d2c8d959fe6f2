//! Ramps in addition to time laws: stops with constant limits, which need neither samples of the path nor a solver; and
//! in their place the shortest stop, where it has been found.

use std::sync::Arc;

use crate::limits::profile::{Change, Limits, State};
use crate::time_optimal::law_solver_thread::Found;
use crate::time_optimal::limit_check::{LimitCheck, Timed};
use crate::time_optimal::solver::{Law, Moment};

/// Shares of the acceleration and the jerk at rest that are tried.
const TRIED_SHARES_OF_LIMITS: [f64; 14] =
    [1.0, 0.95, 0.9, 0.85, 0.8, 0.72, 0.64, 0.56, 0.48, 0.4, 0.32, 0.24, 0.16, 0.08];
/// A law that begins while the robot is slowed down begins at this share of the speed of the current law, there and
/// this many s later.
const LATER_LAW_SHARE_OF_SPEED: f64 = 0.9;
const LATER_LAW_AFTER_S: f64 = 0.15;
/// A robot that starts uses at most these shares of the speed, the acceleration and the jerk, a little less than the
/// law that it will join; and the number of shares that are tried.
const MOST_SHARE_OF_SPEED: f64 = 0.9;
const MOST_SHARE_OF_ACCELERATION: f64 = 0.95;
const MOST_SHARE_OF_JERK: f64 = 0.98;
const TRIED_SHARES: usize = 6;
/// Maximum number of times that the limits are found again for the path that a ramp covers.
const MOST_MEASUREMENTS: usize = 8;
/// Number of bisections of the time of speeding up on a short path: as many as are needed to end exactly.
const TIME_HALVINGS: u32 = 52;

/// A change of speed with constant limits.
#[derive(Clone, Debug)]
struct Leg {
    start: State,
    change: Change,
}

impl Leg {
    fn new(start: State, goal: f64, limits: &Limits) -> Self {
        Self { start, change: Change::new(start.vel, start.acc, goal, limits) }
    }

    /// Where it ends.
    fn end(&self) -> f64 {
        self.start.at + self.change.distance(self.start.vel, self.start.acc)
    }

    fn at(&self, time: f64) -> Moment {
        let State { at, vel, acc } = self.after(time);
        Moment { at, vel, acc, jerk: self.change.jerk(time) }
    }

    /// The state after `time` s; behind its end, at the speed that it led to.
    fn after(&self, time: f64) -> State {
        self.change.after(self.start, time)
    }
}

/// What brings the robot to rest.
#[derive(Clone, Debug)]
enum Stopping {
    Leg(Leg),
    Law(Arc<Law>),
}

impl Timed for Stopping {
    fn at(&self, time: f64) -> Moment {
        match self {
            Self::Leg(leg) => leg.at(time),
            Self::Law(law) => law.at(time),
        }
    }

    fn duration(&self) -> f64 {
        match self {
            Self::Leg(leg) => leg.change.duration(),
            Self::Law(law) => law.duration(),
        }
    }
}

/// A stop.
#[derive(Clone, Debug)]
pub(crate) struct Ramp {
    /// The change to another speed that comes first, and for how many s it is followed.
    first: Option<(Leg, f64)>,
    /// What brings the robot to rest.
    stopping: Stopping,
    /// Time in s from which another law can begin on it.
    calm: f64,
    /// Time that has passed, in s.
    pub(crate) time: f64,
    /// Where it ends.
    pub(crate) end: f64,
    /// Whether it ends where the robot has to stop.
    pub(crate) arrives: bool,
    /// The limits that it was found from.
    pub(crate) check: Arc<LimitCheck>,
}

impl Ramp {
    fn new(first: Option<(Leg, f64)>, start: State, limits: &Limits, check: &Arc<LimitCheck>) -> Self {
        let stopping = Leg::new(start, 0.0, limits);
        let end = stopping.end();
        let stopping = Stopping::Leg(stopping);
        Self { first, stopping, calm: 0.0, time: 0.0, end, arrives: false, check: Arc::clone(check) }
    }

    /// The stop along a law.
    pub(crate) fn along(Found { law, check, end, stops }: Found) -> Self {
        Self { first: None, stopping: Stopping::Law(law), calm: 0.0, time: 0.0, end, arrives: stops, check }
    }

    /// A ramp that starts from rest, speeds up for `time` s, or as long as the path up to `end` permits, and comes to
    /// rest before `end`: with the limits of the path at a share of the speed.
    pub(crate) fn setting_off(start: State, check: &Arc<LimitCheck>, end: f64, share: f64, time: f64) -> Option<Self> {
        let sets_off = |hardness: &f64| {
            let ramp = |limits: &Limits, time: f64| {
                let leg = Leg::new(start, limits.vel, limits);
                Self::new(Some((leg.clone(), time)), leg.after(time), limits, check)
            };
            let limits = |to: f64| {
                let Limits { vel, acc, jerk } = scaled(check.straight(start.at, to), *hardness);
                Limits {
                    vel: vel * MOST_SHARE_OF_SPEED,
                    acc: acc * MOST_SHARE_OF_ACCELERATION,
                    jerk: jerk * MOST_SHARE_OF_JERK,
                }
                .slowed(share)
            };
            // What lies behind the farthest end does not count.
            let farthest = ramp(&limits(start.at), time).end.min(end);
            let limits = limits(farthest);
            let mut found = ramp(&limits, time);
            if found.end > end {
                let (mut short, mut long) = (0.0, time);
                for _ in 0..TIME_HALVINGS {
                    let middle = f64::midpoint(short, long);
                    if ramp(&limits, middle).end <= end { short = middle } else { long = middle }
                }
                found = ramp(&limits, short);
            }
            found.will_do(check, end, 1.0).then_some(found)
        };
        TRIED_SHARES_OF_LIMITS.iter().take(TRIED_SHARES).find_map(sets_off)
    }

    /// The hardest ramp that keeps the limits times `stop_scale` and comes to rest before `end`.
    pub(crate) fn hardest(start: State, check: &Arc<LimitCheck>, end: f64, stop_scale: f64) -> Option<Self> {
        let limits = braking(start, check, end, stop_scale);
        // A state that already brakes harder would have to turn back.
        let turns = |limits: &Limits| start.acc < 0.0 && start.acc * start.acc > 2.0 * limits.jerk * start.vel;
        let scales =
            TRIED_SHARES_OF_LIMITS.iter().map(|hardness| scaled(limits, *hardness)).filter(|limits| !turns(limits));
        let mut ramps = scales.map(|limits| Self::new(None, start, &limits, check));
        ramps.find(|ramp| ramp.will_do(check, end, stop_scale))
    }

    /// The distance to rest if the limits at the start, acceleration and jerk times `stop_scale`, stay the same.
    pub(crate) fn stop_distance(start: State, check: &LimitCheck, stop_scale: f64) -> f64 {
        Leg::new(start, 0.0, &scaled(check.straight(start.at, start.at), stop_scale)).end() - start.at
    }

    /// The hardest ramp that first leads to a speed at which another law can begin, `search` s from now at the
    /// earliest, at a share of its speed. The current law is `found`, at `time` s.
    pub(crate) fn slower(start: State, found: &Found, time: f64, share: f64, search: f64) -> Option<Self> {
        let Found { law, check, end, .. } = found;
        let limits = braking(start, check, *end, 1.0);
        let ramp = |hardness: &f64| {
            let limits = scaled(limits, *hardness);
            let mut goal = share * law.at(time).vel;
            let mut leg = Leg::new(start, goal, &limits);
            // The law's speed is that at the place where the new one begins.
            for _ in 0..3 {
                let time = law.time_at(leg.after(leg.change.duration().max(search)).at);
                goal = share * LATER_LAW_SHARE_OF_SPEED * law.at(time).vel.min(law.at(time + LATER_LAW_AFTER_S).vel);
                leg = Leg::new(start, goal, &limits);
            }
            let until = leg.change.duration().max(search);
            let slow = State { acc: 0.0, ..leg.after(until) };
            let calm = leg.change.duration();
            (goal > 0.0 && goal < start.vel)
                .then(|| Self { calm, ..Self::new(Some((leg, until)), slow, &limits, check) })
        };
        TRIED_SHARES_OF_LIMITS.iter().filter_map(ramp).find(|ramp| ramp.will_do(check, *end, 1.0))
    }

    /// The s until another law can begin on it.
    pub(crate) fn calm(&self) -> f64 {
        (self.calm - self.time).max(0.0)
    }

    /// The s until it comes to rest.
    pub(crate) fn remaining_time(&self) -> f64 {
        self.duration() - self.time
    }

    /// Whether it comes to rest before `end` and keeps the limits times `stop_scale`.
    fn will_do(&self, check: &LimitCheck, end: f64, stop_scale: f64) -> bool {
        let stop = self.at(self.duration());
        stop.vel.abs() <= 1e-9 * self.stopping.at(0.0).vel && self.end <= end && check.surely_keeps(self, stop_scale)
    }
}

impl Timed for Ramp {
    fn at(&self, time: f64) -> Moment {
        match &self.first {
            Some((leg, until)) if time < *until => leg.at(time),
            Some((_, until)) => self.stopping.at(time - until),
            None => self.stopping.at(time),
        }
    }

    fn duration(&self) -> f64 {
        self.first.as_ref().map_or(0.0, |(_, until)| *until) + self.stopping.duration()
    }
}

/// Acceleration and jerk for braking to rest, times `stop_scale`: those that hold over the whole distance to rest, and
/// not those of what lies behind it.
fn braking(start: State, check: &LimitCheck, end: f64, stop_scale: f64) -> Limits {
    let over = |to: f64| scaled(check.straight(start.at, to), stop_scale);
    let mut limits = over(start.at);
    for _ in 0..MOST_MEASUREMENTS {
        let farthest = Leg::new(start, 0.0, &limits).end();
        let next = over(farthest.min(end));
        if next == limits {
            return limits;
        }
        if farthest >= end {
            break;
        }
        limits = next;
    }
    over(end)
}

fn scaled(limits: Limits, by: f64) -> Limits {
    Limits { acc: limits.acc * by, jerk: limits.jerk * by, ..limits }
}
