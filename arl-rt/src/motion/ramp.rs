//! Ramps of the profile O: ways to rest with constant limits, which need neither a look along the course nor a solver.

use super::finder::{Found, Plot, Timed};
use super::optimal::Moment;
use super::profile::{Change, Limits, State};

/// Shares of the acceleration and the jerk at rest that are tried.
const HARDNESS: [f64; 14] = [1.0, 0.95, 0.9, 0.85, 0.8, 0.72, 0.64, 0.56, 0.48, 0.4, 0.32, 0.24, 0.16, 0.08];
/// A law that begins while the robot is slowed down begins at this part of the speed of the law in hand, there and so many s
/// later.
const SLOWER: f64 = 0.9;
const LATER: f64 = 0.15;

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

    fn at(&self, time: f64) -> Moment {
        let State { at, vel, acc } = self.after(time);
        Moment { at, vel, acc, jerk: self.change.jerk(time) }
    }

    /// The state after `time` s, behind its end at the speed that it led to.
    fn after(&self, time: f64) -> State {
        self.change.after(self.start, time)
    }
}

/// A way to rest.
#[derive(Clone, Debug)]
pub(super) struct Ramp {
    /// What leads to a lower speed first, and for how many s this goes on.
    slowing: Option<(Leg, f64)>,
    /// What leads to rest.
    stopping: Leg,
    /// How many s of it are over.
    pub(super) time: f64,
    /// Where it ends.
    pub(super) end: f64,
}

impl Ramp {
    fn new(slowing: Option<(Leg, f64)>, start: State, limits: &Limits) -> Self {
        let stopping = Leg::new(start, 0.0, limits);
        let end = stopping.after(stopping.change.duration()).at;
        Self { slowing, stopping, time: 0.0, end }
    }

    /// The hardest one that keeps the limits times `harder` and rests before `end`.
    pub(super) fn hardest(start: State, plot: &Plot, end: f64, harder: f64) -> Option<Self> {
        let limits = braking(start, plot, end, harder);
        // What brakes harder already would have to turn back.
        let turns = |limits: &Limits| start.acc < 0.0 && start.acc * start.acc > 2.0 * limits.jerk * start.vel;
        let scales = HARDNESS.iter().map(|hardness| scaled(limits, *hardness)).filter(|limits| !turns(limits));
        let mut ramps = scales.map(|limits| Self::new(None, start, &limits));
        ramps.find(|ramp| ramp.will_do(plot, end, harder))
    }

    /// The hardest one that first leads to a speed at which another law can begin, `search` s from now at the earliest, at a
    /// share of its speed; from `time` s on the law `found`.
    pub(super) fn slower(start: State, found: &Found, time: f64, share: f64, search: f64) -> Option<Self> {
        let Found { law, plot, end, .. } = found;
        let limits = braking(start, plot, *end, 1.0);
        let ramp = |hardness: &f64| {
            let limits = scaled(limits, *hardness);
            let mut goal = share * law.at(time).vel;
            let mut leg = Leg::new(start, goal, &limits);
            // The law's speed is that of the place where the new one begins.
            for _ in 0..3 {
                let time = law.time_at(leg.after(leg.change.duration().max(search)).at);
                goal = share * SLOWER * law.at(time).vel.min(law.at(time + LATER).vel);
                leg = Leg::new(start, goal, &limits);
            }
            let until = leg.change.duration().max(search);
            let slow = State { acc: 0.0, ..leg.after(until) };
            (goal > 0.0 && goal < start.vel).then(|| Self::new(Some((leg, until)), slow, &limits))
        };
        HARDNESS.iter().filter_map(ramp).find(|ramp| ramp.will_do(plot, *end, 1.0))
    }

    /// s until another law can begin on it.
    pub(super) fn calm(&self) -> f64 {
        self.slowing.as_ref().map_or(0.0, |(leg, _)| leg.change.duration() - self.time).max(0.0)
    }

    /// Whether it rests before `end` and keeps the limits times `harder`.
    fn will_do(&self, plot: &Plot, end: f64, harder: f64) -> bool {
        let stop = self.at(self.duration());
        stop.vel.abs() <= 1e-9 * self.stopping.start.vel && self.end <= end && plot.surely_keeps(self, harder)
    }
}

impl Timed for Ramp {
    fn at(&self, time: f64) -> Moment {
        match &self.slowing {
            Some((leg, until)) if time < *until => leg.at(time),
            Some((_, until)) => self.stopping.at(time - until),
            None => self.stopping.at(time),
        }
    }

    fn duration(&self) -> f64 {
        self.slowing.as_ref().map_or(0.0, |(_, until)| *until) + self.stopping.change.duration()
    }
}

/// Acceleration and jerk for braking to rest, times `harder`: what lies behind the longest stop does not count.
fn braking(start: State, plot: &Plot, end: f64, harder: f64) -> Limits {
    let farthest = Ramp::new(None, start, &scaled(plot.straight(start.at, end), harder)).end.min(end);
    scaled(plot.straight(start.at, farthest), harder)
}

fn scaled(limits: Limits, by: f64) -> Limits {
    Limits { acc: limits.acc * by, jerk: limits.jerk * by, ..limits }
}
