//! How the robot goes along the course in the profile O.
//!
//! Invariant: the law in hand leads the robot to rest on the course, within all limits. Another one takes its place only
//! when it has been found to start from the robot's very state; where none is found, the robot keeps to the one it has.
//! So nothing that comes up, a motion, a stop or another override, can lead it off the course or beyond a limit.

use super::optimal::{Edge, Law, Moment, Way, fastest};
use super::profile::{Change, Limits, State};
use super::scout::{Prospect, Scout};

/// How many s of nominal time are looked ahead at first.
const WINDOW: f64 = 2.0;
/// A law takes so many s at least, if there is so much course.
const AHEAD: f64 = 1.5;
/// A law of which a smaller part is left is made longer when there is more course.
const LEFT: f64 = 0.5;
/// A new law must be about as quick as the one in hand over the next part of that.
const AS_QUICK_FOR: f64 = 0.3;
const AS_QUICK: f64 = 1.1;
/// After a law was not found, the next attempt is made so many s later.
const PAUSE: f64 = 0.02;
/// A law is looked at every so many s, and may use so much of the limits.
const SAMPLE: f64 = 0.001;
const MOST_USED: f64 = 1.008;
/// Times, in s at full speed, after which a change of the override may be over.
const CHANGES: [f64; 7] = [0.03, 0.06, 0.12, 0.25, 0.5, 1.0, 2.0];
/// Shares of the acceleration and the jerk at rest that are tried for a stop.
const HARDNESS: [f64; 14] = [1.0, 0.95, 0.9, 0.85, 0.8, 0.72, 0.64, 0.56, 0.48, 0.4, 0.32, 0.24, 0.16, 0.08];

/// Where the robot is on its law.
#[derive(Clone, Debug)]
struct Drive<L> {
    law: L,
    /// s on the law.
    time: f64,
    /// Where the law ends, in s of nominal time.
    end: f64,
}

impl<L: Timed> Drive<L> {
    fn left(&self) -> f64 {
        self.law.duration() - self.time
    }

    fn is_over(&self) -> bool {
        self.left() <= 1e-9
    }
}

impl Drive<Law> {
    /// Whether another law that starts here goes on about as quickly, before this one slows down for its end.
    fn is_as_quick(&self, other: &Self) -> bool {
        let later = AS_QUICK_FOR * self.left();
        let there = self.law.at(self.time + later).at.min(other.end);
        let own = self.law.time_at(there) - self.time;
        other.law.time_at(there) <= AS_QUICK * own
    }
}

/// A motion along the course over time.
trait Timed {
    fn at(&self, time: f64) -> Moment;
    fn duration(&self) -> f64;
}

impl Timed for Law {
    fn at(&self, time: f64) -> Moment {
        Law::at(self, time)
    }

    fn duration(&self) -> f64 {
        Law::duration(self)
    }
}

/// A change to rest with constant limits.
#[derive(Clone, Debug)]
struct Ramp {
    start: State,
    change: Change,
}

impl Timed for Ramp {
    fn at(&self, time: f64) -> Moment {
        let State { at, vel, acc } = self.change.after(self.start, time);
        Moment { at, vel, acc, jerk: self.change.jerk(time) }
    }

    fn duration(&self) -> f64 {
        self.change.duration()
    }
}

/// What a bridge moves by.
#[derive(Clone, Debug)]
enum Line {
    Law(Law),
    Ramp(Ramp),
}

impl Timed for Line {
    fn at(&self, time: f64) -> Moment {
        match self {
            Line::Law(law) => law.at(time),
            Line::Ramp(ramp) => ramp.at(time),
        }
    }

    fn duration(&self) -> f64 {
        match self {
            Line::Law(law) => law.duration(),
            Line::Ramp(ramp) => ramp.duration(),
        }
    }
}

/// What comes after a law that leads from one state to another.
#[derive(Clone, Debug)]
enum Then {
    Rest,
    /// The full-speed law from a later time on.
    Go,
}

/// Follows laws, cycle by cycle.
#[derive(Clone, Debug, Default)]
pub(super) struct Pilot {
    /// The law at full speed; `None` at rest.
    main: Option<Drive<Law>>,
    /// The share of its speed at which it is followed.
    share: f64,
    /// A law that leads away from it in real time: to rest, or to another share of the speed.
    bridge: Option<(Drive<Line>, Then)>,
    /// The share of the speed that the bridge leads to.
    next_share: f64,
    /// s until another attempt is made.
    pause: f64,
}

impl Pilot {
    /// Whether it stands still.
    pub(super) fn rests(&self) -> bool {
        self.main.is_none() && self.bridge.is_none()
    }

    /// How far the course is laid down by the laws in hand.
    pub(super) fn end(&self) -> f64 {
        match (&self.bridge, &self.main) {
            (Some((bridge, Then::Rest)), _) => bridge.end,
            (_, Some(main)) => main.end,
            (Some((bridge, Then::Go)), None) => bridge.end,
            (None, None) => f64::NEG_INFINITY,
        }
    }

    /// s until the parameter is at `at`, at full speed; `None` where no law leads there.
    pub(super) fn time_to(&self, at: f64) -> Option<f64> {
        let main = self.main.as_ref().filter(|main| at <= main.end)?;
        Some((main.law.time_at(at) - main.time).max(0.0))
    }

    /// The state a cycle later; `at` is in s of nominal time since the course began.
    pub(super) fn next(&mut self, scout: &Scout, cycle: f64, goal: Goal) -> State {
        self.pause = (self.pause - cycle).max(0.0);
        match goal {
            Goal::Stop(harder) => self.brake(scout, harder),
            Goal::Go(share) => self.go(scout, share),
        }
        self.advance(scout, cycle)
    }

    /// Makes a law for the course as it is now, from the robot's state; returns whether there is one.
    pub(super) fn renew(&mut self, scout: &Scout) -> bool {
        if self.rests() {
            return true;
        }
        if self.bridge.is_some() {
            return false;
        }
        let Some(main) = &self.main else { return true };
        let now = main.law.at(main.time);
        let found = law(scout, Edge { vel: now.vel, acc: now.acc });
        let renewed = found.filter(|found| main.is_as_quick(found));
        let is_new = renewed.is_some();
        self.main = renewed.or(self.main.take());
        is_new
    }

    fn go(&mut self, scout: &Scout, share: f64) {
        match (&self.bridge, &self.main) {
            (None, None) => {
                self.share = share;
                self.main = law(scout, Edge::REST);
            }
            (Some((bridge, Then::Rest)), _) if self.pause <= 0.0 => {
                // Told to go on before it rests: from the state on the way to rest, if that is one of the new share.
                let now = bridge.law.at(bridge.time);
                let edge = Edge { vel: now.vel / share, acc: now.acc / (share * share) };
                match law(scout, edge) {
                    Some(found) => (self.main, self.bridge, self.share) = (Some(found), None, share),
                    None => self.pause = PAUSE,
                }
            }
            (None, Some(main)) => {
                let more = main.end < scout.stop() - 1e-9;
                let short = main.left() < LEFT * main.law.duration();
                if self.pause <= 0.0 && more && short && !self.renew(scout) {
                    self.pause = PAUSE;
                }
                if share != self.share && self.pause <= 0.0 && !self.change(scout, share) {
                    self.pause = PAUSE;
                }
            }
            _ => {}
        }
    }

    /// Looks for the hardest ramp that leads to rest within the limits, where they are those of the way times `harder`.
    fn brake(&mut self, scout: &Scout, harder: f64) {
        if self.pause > 0.0 || self.rests() || matches!(&self.bridge, Some((_, Then::Rest))) {
            return;
        }
        self.pause = PAUSE;
        let (now, end) = (self.state(scout), self.end());
        let start = Edge { vel: now.vel, acc: now.acc };
        // The end is one of a moving robot: places need not be close together there.
        let Some(Prospect { way, end }) = scout.look(end, start, Edge { vel: now.vel, acc: 0.0 }, harder) else {
            return;
        };
        let limits = straight(&way);
        let ramp = |hardness: f64| {
            let limits = Limits { acc: limits.acc * hardness, jerk: limits.jerk * hardness, ..limits };
            // What brakes harder already would have to turn back.
            if now.acc < 0.0 && now.acc * now.acc > 2.0 * limits.jerk * now.vel {
                return None;
            }
            let ramp = Ramp { start: now, change: Change::new(now.vel, now.acc, 0.0, &limits) };
            let stop = ramp.at(ramp.duration());
            let last = stop.vel.abs() <= 1e-9 * now.vel && stop.at <= end;
            (last && keeps(&way, &ramp)).then_some((ramp, stop.at))
        };
        if let Some((ramp, end)) = HARDNESS.iter().find_map(|hardness| ramp(*hardness)) {
            let drive = Drive { law: Line::Ramp(ramp), time: 0.0, end };
            (self.main, self.bridge) = (None, Some((drive, Then::Rest)));
        }
    }

    /// Looks for a law that leads to another share of the speed; returns whether there is one.
    fn change(&mut self, scout: &Scout, share: f64) -> bool {
        let Some(main) = &self.main else { return true };
        let now = self.state(scout);
        let start = Edge { vel: now.vel, acc: now.acc };
        for later in CHANGES {
            let time = main.time + later;
            if time >= main.law.duration() {
                return false;
            }
            let there = main.law.at(time);
            let end = Edge { vel: there.vel * share, acc: there.acc * share * share };
            let Some(Prospect { way, end: reached }) = scout.look(there.at, start, end, 1.0) else { continue };
            if reached < there.at {
                return false;
            }
            if let Some(law) = sound(&way, start, end) {
                let bridge = Drive { law: Line::Law(law), time: 0.0, end: there.at };
                self.main = Some(Drive { time, ..main.clone() });
                (self.bridge, self.next_share) = (Some((bridge, Then::Go)), share);
                return true;
            }
        }
        false
    }

    /// The state now, in real time.
    fn state(&self, scout: &Scout) -> State {
        match (&self.bridge, &self.main) {
            (Some((bridge, _)), _) => {
                let now = bridge.law.at(bridge.time);
                State { at: now.at, vel: now.vel, acc: now.acc }
            }
            (None, Some(main)) => {
                let (now, share) = (main.law.at(main.time), self.share);
                State { at: now.at, vel: now.vel * share, acc: now.acc * share * share }
            }
            (None, None) => State { at: scout.at, vel: 0.0, acc: 0.0 },
        }
    }

    fn advance(&mut self, scout: &Scout, cycle: f64) -> State {
        let mut left = cycle;
        if let Some((bridge, then)) = &mut self.bridge {
            bridge.time += left;
            left = -bridge.left();
            if left < 0.0 {
                return self.state(scout);
            }
            let end = State { at: bridge.end, vel: 0.0, acc: 0.0 };
            if let Then::Rest = then {
                self.bridge = None;
                return end;
            }
            self.share = self.next_share;
            self.bridge = None;
        }
        if let Some(main) = &mut self.main {
            main.time += left * self.share;
            if main.is_over() {
                let end = State { at: main.end, vel: 0.0, acc: 0.0 };
                self.main = None;
                return end;
            }
        }
        self.state(scout)
    }
}

/// What the robot is to do.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Goal {
    /// On, at a share of the full speed.
    Go(f64),
    /// To rest, with so many times the acceleration and jerk.
    Stop(f64),
}

/// The fastest law from a state on, to rest at the next stop or as far as is looked ahead.
fn law(scout: &Scout, start: Edge) -> Option<Drive<Law>> {
    let stop = scout.stop();
    let mut window = WINDOW;
    let mut found = None;
    loop {
        let to = if scout.at + 1.2 * window < stop { scout.at + window } else { stop };
        let Some(Prospect { way, end }) = scout.look(to, start, Edge::REST, 1.0) else { return found };
        let Some(law) = sound(&way, start, Edge::REST) else { return found };
        let ahead = law.duration();
        found = Some(Drive { law, time: 0.0, end });
        if end < to || to >= stop || ahead >= AHEAD {
            return found;
        }
        // Nominal times are short where constant limits are low: far enough, and not much farther.
        window *= (1.5 * AHEAD / ahead).clamp(1.5, 8.0);
    }
}

/// The fastest law, if it keeps the limits between the places, too: close to rest, from a state that moves, that is not
/// certain.
fn sound(way: &Way, start: Edge, end: Edge) -> Option<Law> {
    fastest(way, start, end).ok().filter(|law| keeps(way, law))
}

/// Whether a motion along `way` keeps its limits.
fn keeps(way: &Way, motion: &impl Timed) -> bool {
    let count = (motion.duration() / SAMPLE).clamp(16.0, 4000.0) as u32;
    let places = way.places();
    let used = |index: usize, now: &Moment| {
        way.rows(index).iter().fold(0.0_f64, |used, row| {
            let acc = row.first * now.acc + row.second * now.vel * now.vel;
            let jerk =
                row.first * now.jerk + 3.0 * row.second * now.vel * now.acc + row.third * now.vel * now.vel * now.vel;
            used.max((row.first * now.vel / row.vel).abs()).max((acc / row.acc).abs()).max((jerk / row.jerk).abs())
        })
    };
    (0..=count).all(|step| {
        let now = motion.at(motion.duration() * f64::from(step) / f64::from(count));
        let next = places.partition_point(|place| *place <= now.at).clamp(1, places.len() - 1);
        used(next - 1, &now).min(used(next, &now)) <= MOST_USED
    })
}

/// The acceleration and jerk that the parameter may have on all of a way where it hardly moves.
fn straight(way: &Way) -> Limits {
    let mut limits = Limits { vel: f64::INFINITY, acc: f64::INFINITY, jerk: f64::INFINITY };
    for row in (0..way.places().len()).flat_map(|index| way.rows(index)) {
        if row.first != 0.0 {
            limits.acc = limits.acc.min(row.acc / row.first.abs());
            limits.jerk = limits.jerk.min(row.jerk / row.first.abs());
        }
    }
    // Without any limit of its own a ramp takes a few cycles.
    Limits { jerk: limits.jerk.min(1e3 * limits.acc), ..limits }
}
