//! The governor: chooses the speed along the path, cycle by cycle.
//!
//! Invariant: there is always a current backup. It is a change of speed that keeps the limits over the whole distance
//! that it covers, and at whose end, without acceleration, the robot can reach the speed of every segment ahead in
//! time, and come to rest before the end, within the limits of the segments in between. So a stop, a change of the
//! override or a motion that comes late never leads off the path or beyond a limit: each cycle takes the highest jerk
//! behind which another backup is found, and follows the current backup where there is none.

mod aim;
mod demands;

use std::collections::VecDeque;
use std::ops::ControlFlow;

use crate::follow::timing::{Cell, Stretch};
use crate::limits::profile::{Change, LOOK_AHEAD_MARGIN, Limits, State};
use crate::limits::search::{self, Enough};
use demands::{ALL_CELLS, Cells, NO_CELLS};

/// The requested speed.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Pacing {
    /// Continue at a share of the full speed, above 0 to 1, with proportionally slower ramps.
    Go(f64),
    /// Continue, changing to a share of the full speed that is new, with all that the limits permit.
    Settle(f64),
    /// Come to rest on the path, with acceleration and jerk scaled by this factor.
    Stop(f64),
}

/// Factors on speed, acceleration and jerk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    vel: f64,
    acc: f64,
    jerk: f64,
}

/// The limits themselves.
const FULL_LIMITS: Scale = Scale { vel: 1.0, acc: 1.0, jerk: 1.0 };
/// Share of the acceleration that counts as zero once the override has been reached.
const SETTLED_SHARE_OF_ACCELERATION: f64 = 0.02;
/// Relative slack for rounding in comparisons.
const RELATIVE_SLACK: f64 = 1e-9;
/// Relative slack for the speed at which a slower segment is entered.
const ENTRY_SPEED_SLACK: f64 = 1e-6;
/// Relative slack for a speed within its cell, where a little acceleration may be left from before.
const CELL_SPEED_SLACK: f64 = 1e-5;
/// Where the braking distance is shorter than the distance to a stop by no more than this share, the robot stops there
/// anyway.
const ENDING_STOP_SHARE: f64 = 0.02;
/// Slack for rounding, in s of nominal time and in shares of the full speed.
const ROUNDING_SLACK: f64 = 1e-12;
/// Slack for a state that was found at the edge of what is possible.
const EDGE_SLACK: f64 = 1e-9;
/// Tolerance of the sought jerk, as a share of the interval in which it is sought.
const JERK_TOLERANCE: f64 = 1e-9;
/// Number of bisections of that interval, where no better method applies.
const JERK_HALVINGS: u32 = 16;
/// A remaining distance that is a smaller share than this of what a cycle's jerk moves counts as zero.
const SNAP_SHARE: f64 = 0.005;

/// Finds the next state from the path ahead.
pub(crate) struct Governor<'a> {
    pub(crate) stretches: &'a VecDeque<Stretch>,
    /// The length of a cycle in s.
    pub(crate) cycle: f64,
}

impl Governor<'_> {
    /// A backup for the state, where the robot can continue; see the invariant. Apart from rounding, the state is at
    /// the edge of that most of the time.
    pub(crate) fn holds(&self, state: &State) -> Option<Change> {
        self.possible(state, FULL_LIMITS, EDGE_SLACK, &ALL_CELLS).map(|aim| aim.change(state))
    }

    /// The state a cycle later; `backup` is replaced by the backup for that state. Beyond the end of the first cell,
    /// `at` continues into the next ones.
    pub(crate) fn next(&self, state: &State, backup: &mut Change, pacing: Pacing) -> State {
        let step = self.paced(state, backup, pacing);
        // Rounding must not carry it past a stop.
        let Step { state, backup: next } = match self.stop_end(step.state.at) {
            Some(end) => Step::rest(end),
            None => step,
        };
        *backup = next;
        state
    }

    /// Where the robot stops, if the stop is no farther than `at`.
    fn stop_end(&self, at: f64) -> Option<f64> {
        let mut end = 0.0;
        for stretch in self.stretches {
            end += stretch.cells.iter().map(|cell| cell.length).take_while_sum(at - end);
            if end > at {
                return None;
            }
            if stretch.stops {
                return Some(end);
            }
        }
        Some(end)
    }

    fn paced(&self, state: &State, backup: &Change, pacing: Pacing) -> Step {
        match pacing {
            Pacing::Stop(stop_scale) => {
                self.slower(state, backup, Scale { vel: 1.0, acc: stop_scale, jerk: stop_scale })
            }
            Pacing::Go(share) => {
                let slowed = slowed(share);
                let ends = self.arrives(state, slowed).or_else(|| self.arrives(state, FULL_LIMITS));
                let next = ends.or_else(|| self.faster(state, slowed));
                next.unwrap_or_else(|| self.paced(state, backup, Pacing::Settle(share)))
            }
            Pacing::Settle(share) => {
                let quick = Scale { vel: share, ..FULL_LIMITS };
                if let Some(next) = self.arrives(state, FULL_LIMITS).or_else(|| self.faster(state, quick)) {
                    return next;
                }
                // Too fast for this share yet: change to the speed that the share permits as soon as possible.
                let slowing = self.at(state.at).and_then(|(here, cell)| {
                    self.toward_within(state, cell.limits.vel * share, careful(here, FULL_LIMITS), FULL_LIMITS)
                });
                slowing.unwrap_or_else(|| self.along(state, backup))
            }
        }
    }

    /// The state a cycle later along the current backup, or along another one once the current one is over.
    fn along(&self, state: &State, backup: &Change) -> Step {
        let another = if backup.duration() > 0.0 { None } else { self.holds(state) };
        let backup = another.as_ref().unwrap_or(backup);
        let next = backup.after(*state, self.cycle);
        Step { state: State { vel: next.vel.max(0.0), ..next }, backup: backup.later(self.cycle) }
    }

    /// Whether a motion at this share of the speed may be in this state.
    pub(crate) fn settled(&self, state: &State, share: f64) -> bool {
        let scale = slowed(share);
        let calm = self
            .at(state.at)
            .is_none_or(|(here, _)| state.acc.abs() <= SETTLED_SHARE_OF_ACCELERATION * here.acc * scale.acc);
        state.rests() || (calm && self.feasible(state, scale))
    }

    /// The state at a stop, where the stop is reached within the cycle.
    fn arrives(&self, state: &State, scale: Scale) -> Option<Step> {
        let here = self.stretches.front()?;
        let limits = careful(here, scale);
        let length: f64 = here.cells.iter().map(|cell| cell.length).take(4).sum();
        if !here.stops || here.cells.len() > 4 {
            return None;
        }
        let remaining = length - state.at;
        let jerk = limits.jerk.min(limits.acc / self.cycle);
        let nothing = SNAP_SHARE * jerk * self.cycle * self.cycle * self.cycle;
        let end = Step::rest(length);
        if state.rests() {
            return (remaining <= nothing).then_some(end);
        }
        let (distance, time) = to_rest(state.vel, state.acc, &limits)?;
        let there = time <= self.cycle * 1.000_001 && (distance - remaining).abs() <= nothing.max(2.0 * ROUNDING_SLACK);
        (there || remaining <= 2.0 * ROUNDING_SLACK).then_some(end)
    }

    /// The quickest step forward within a cycle; `None` where there is none.
    fn faster(&self, state: &State, scale: Scale) -> Option<Step> {
        let limits = self.touched(state, scale)?;
        let highest = ((limits.acc - state.acc) / self.cycle).min(limits.jerk);
        let lowest = lowest_jerk(state, self.cycle, &limits)?;
        let next = |jerk: f64| state.after(jerk, self.cycle);
        let highest = highest.min(self.highest_jerk(state, &next(highest), scale)).max(lowest);
        if let Some(step) = self.step(next(highest), scale, 0.0) {
            return Some(step);
        }
        // The more jerk, the longer the distance to any speed: below the highest jerk, only what that jerk leaves
        // undone matters.
        let undone = self.undone(&next(highest), scale);
        let enough = Enough { value: JERK_TOLERANCE * (highest - lowest), excess: ROUNDING_SLACK };
        let within = search::highest(lowest, highest, enough, |jerk| self.excess(&next(jerk), scale, &undone));
        let quick = if self.fades_across(&next(highest), scale) {
            halved(within, highest, |jerk| self.across(&next(jerk), scale, 0.0).is_some())
        } else {
            within
        };
        let found = self.step(next(quick), scale, 0.0).or_else(|| {
            let some = farthest(lowest, highest, |jerk| self.feasible(&next(jerk), scale))?;
            self.step(next(some), scale, 0.0)
        });
        // What was feasible stays so, apart from the last digits, along the backup that was found for it.
        found.or_else(|| {
            let aim = self.possible(state, scale, 0.0, &ALL_CELLS)?;
            let along = || self.along(state, &aim.change(state));
            let braking = Some(self.braking(state, scale)).filter(|next| next.at >= state.at);
            Some(braking.and_then(|next| self.step(next, scale, EDGE_SLACK)).unwrap_or_else(along))
        })
    }

    /// A state with the backup that is found for it.
    fn step(&self, state: State, scale: Scale, slack: f64) -> Option<Step> {
        let aim = self.possible(&state, scale, slack, &ALL_CELLS)?;
        Some(Step { state, backup: aim.change(&state) })
    }

    /// The highest jerk of a cycle, which ends at about `next`, behind which the acceleration can fade before the speed
    /// is too high.
    fn highest_jerk(&self, state: &State, next: &State, scale: Scale) -> f64 {
        let fastest = |at: f64| self.at(at).map_or((0.0, f64::INFINITY), |(here, cell)| (cell.limits.vel, here.jerk));
        let (here, there) = (fastest(state.at), fastest(next.at));
        let fastest = here.0.max(there.0) * scale.vel * (1.0 + CELL_SPEED_SLACK - RELATIVE_SLACK);
        let jerk = here.1.max(there.1) * scale.jerk * LOOK_AHEAD_MARGIN;
        let short = fastest - state.vel - state.acc * self.cycle / 2.0;
        let ramp = jerk * self.cycle;
        let acc = if short > 0.0 {
            // The acceleration fades in whole cycles, the last of which may use less jerk: with n others, which leave
            // the part p of a ramp to it, short = ramp cycle (n (n + 1) / 2 + (n + 1) p). So the state reaches the
            // speed and stays there.
            let ramps = short / (ramp * self.cycle);
            let others = (((1.0 + 8.0 * ramps).sqrt() - 1.0) / 2.0).floor();
            ramp * (others + (ramps - others * (others + 1.0) / 2.0) / (others + 1.0))
        } else {
            2.0 * short / self.cycle
        };
        (acc - state.acc) / self.cycle
    }

    /// The cells whose speeds cannot be reached in time, and those between them.
    fn undone(&self, state: &State, scale: Scale) -> Cells {
        let mut undone: Option<Cells> = None;
        self.demands(state, scale, &ALL_CELLS, |demand| {
            if let Some(cell) = demand.cell
                && demand.least_remaining < 0.0
                && demand.remaining(state) < 0.0
            {
                undone = Some(undone.take().map_or(cell, |cells| cells.start)..cell + 1);
            }
            ControlFlow::Continue(())
        });
        undone.unwrap_or(NO_CELLS)
    }

    /// The slowest possible step, down to rest.
    fn slower(&self, state: &State, backup: &Change, scale: Scale) -> Step {
        let Some(here) = self.stretches.front() else { return Step::rest(state.at) };
        if state.rests() {
            return Step::rest(state.at);
        }
        // Near a stop that is hardly farther than the braking distance, the robot stops at that stop.
        if let Some(end) = self.arrives(state, FULL_LIMITS) {
            return end;
        }
        if self.at_its_end(state)
            && let Some(next) = self.faster(state, FULL_LIMITS)
        {
            return next;
        }
        // The hardest braking may lead into a stretch that permits less.
        let next = self.toward_within(state, 0.0, scaled(here, scale), scale);
        next.or_else(|| self.hardest(state, backup, scale)).unwrap_or_else(|| self.along(state, backup))
    }

    /// The state a cycle later with the lowest jerk that leaves a backup, where braking harder than the current backup
    /// leaves one.
    fn hardest(&self, state: &State, backup: &Change, scale: Scale) -> Option<Step> {
        let limits = self.touched(state, scale)?;
        let lowest = lowest_jerk(state, self.cycle, &limits)?;
        let known = (backup.after(*state, self.cycle).acc - state.acc) / self.cycle;
        let next = |jerk: f64| state.after(jerk, self.cycle);
        let found = farthest(known, lowest.min(known), |jerk| self.feasible(&next(jerk), scale))?;
        self.step(next(found), scale, 0.0)
    }

    /// The state a cycle later on the quickest change to a speed, with at most `limits`: within the limits of all
    /// stretches that the cycle touches, or of this stretch alone where only that leaves a backup.
    fn toward_within(&self, state: &State, goal: f64, limits: Limits, scale: Scale) -> Option<Step> {
        let all = self.touched(state, scale).map(|touched| lower(limits, touched));
        let found = all.into_iter().chain([limits]).map(|limits| self.toward(state, goal, &limits));
        found.filter(|next| next.at >= state.at).find_map(|next| self.step(next, scale, 0.0))
    }

    /// Whether the robot already brakes for a stop.
    fn at_its_end(&self, state: &State) -> bool {
        let mut nearest = f64::INFINITY;
        let mut distance = 0.0;
        self.demands(state, FULL_LIMITS, &ALL_CELLS, |demand| {
            if demand.goal == 0.0
                && let remaining = demand.remaining(state)
                && remaining < nearest
            {
                nearest = remaining;
                distance = to_rest(state.vel, state.acc, &demand.limits).map_or(0.0, |(distance, _)| distance);
            }
            ControlFlow::Continue(())
        });
        nearest <= ENDING_STOP_SHARE * distance
    }

    /// The state a cycle later on the way to the speed that is hardest to reach in time. What was found feasible ahead
    /// stays so, apart from the last digits.
    fn braking(&self, state: &State, scale: Scale) -> State {
        let Some((here, cell)) = self.at(state.at) else { return State { vel: 0.0, acc: 0.0, ..*state } };
        let highest = (cell.limits.vel * scale.vel).min(state.vel);
        let mut found = (highest, careful(here, scale));
        let mut least = f64::INFINITY;
        self.demands(state, scale, &ALL_CELLS, |demand| {
            if demand.goal <= highest
                && let remaining = demand.remaining(state)
                && remaining < least
            {
                (least, found) = (remaining, (demand.goal, demand.limits));
            }
            ControlFlow::Continue(())
        });
        let (goal, limits) = found;
        self.toward(state, goal, &limits)
    }

    /// The state a cycle later on the quickest change to a speed.
    fn toward(&self, state: &State, goal: f64, limits: &Limits) -> State {
        let State { at, vel, acc } = *state;
        if goal == 0.0 && acc < 0.0 && fading(vel, acc, limits) < 0.0 {
            // A little more than the jerk is needed to let the acceleration fade with the speed.
            if -2.0 * vel <= acc * self.cycle {
                return state.after(acc * acc / (2.0 * vel), self.cycle);
            }
            return State { at: at + 2.0 * vel * vel / (-3.0 * acc), vel: 0.0, acc: 0.0 };
        }
        let change = Change::new(vel, acc, goal, limits);
        let next = change.after(*state, self.cycle);
        if goal == 0.0 && change.duration() <= self.cycle {
            return State { at: next.at.max(at), vel: 0.0, acc: 0.0 };
        }
        // A state that would move backwards is invalid; rounding does not count.
        State { vel: if next.vel < -ROUNDING_SLACK { next.vel } else { next.vel.max(0.0) }, ..next }
    }

    /// Acceleration and jerk within the limits of all stretches that the robot is on within the cycle.
    fn touched(&self, state: &State, scale: Scale) -> Option<Limits> {
        let here = self.stretches.front()?;
        let limits = scaled(here, scale);
        let reach = state.after(limits.jerk, self.cycle).at;
        let mut found = limits;
        let mut end = 0.0;
        for (stretch, next) in self.stretches.iter().zip(self.stretches.iter().skip(1)) {
            end += stretch.cells.iter().map(|cell| cell.length).take_while_sum(reach - end);
            if stretch.stops || end > reach {
                break;
            }
            found = lower(found, scaled(next, scale));
        }
        Some(found)
    }

    /// Whether there is a backup for the state.
    fn feasible(&self, state: &State, scale: Scale) -> bool {
        self.possible(state, scale, 0.0, &ALL_CELLS).is_some()
    }

    fn at(&self, at: f64) -> Option<(&Stretch, &Cell)> {
        let mut end = 0.0;
        for stretch in self.stretches {
            for cell in &stretch.cells {
                end += cell.length;
                if at < end {
                    return Some((stretch, cell));
                }
            }
        }
        None
    }
}

/// A state with a backup for it.
#[derive(Clone, Copy, Debug)]
struct Step {
    state: State,
    backup: Change,
}

impl Step {
    /// At rest at a place.
    fn rest(at: f64) -> Self {
        Self { state: State { at, vel: 0.0, acc: 0.0 }, backup: Change::default() }
    }
}

/// A sum of lengths that ends once it has passed a bound.
trait TakeWhileSum {
    fn take_while_sum(self, bound: f64) -> f64;
}

impl<I: Iterator<Item = f64>> TakeWhileSum for I {
    fn take_while_sum(self, bound: f64) -> f64 {
        let mut sum = 0.0;
        for length in self {
            sum += length;
            if sum > bound {
                break;
            }
        }
        sum
    }
}

/// The limits of a motion at a share of its speed: the same motion, only slower.
fn slowed(share: f64) -> Scale {
    Scale { vel: share, acc: share * share, jerk: share * share * share }
}

/// Acceleration and jerk of a stretch under a scale.
fn scaled(stretch: &Stretch, scale: Scale) -> Limits {
    let Limits { vel, acc, jerk } = stretch.limits();
    Limits { vel, acc: acc * scale.acc, jerk: jerk * scale.jerk }
}

/// Acceleration and jerk that may be used when looking ahead.
fn careful(stretch: &Stretch, scale: Scale) -> Limits {
    let Limits { vel, acc, jerk } = scaled(stretch, scale);
    Limits { vel, acc: acc * LOOK_AHEAD_MARGIN, jerk: jerk * LOOK_AHEAD_MARGIN }
}

fn lower(a: Limits, b: Limits) -> Limits {
    Limits { vel: a.vel.min(b.vel), acc: a.acc.min(b.acc), jerk: a.jerk.min(b.jerk) }
}

/// The acceptable value nearest to `goal`, which is not acceptable itself, sought from `start` on; `None` where
/// `start` is not acceptable.
fn farthest(start: f64, goal: f64, will_do: impl Fn(f64) -> bool) -> Option<f64> {
    will_do(start).then(|| halved(start, goal, will_do))
}

/// The acceptable value nearest to `goal`, sought from a `start` that is acceptable.
fn halved(start: f64, goal: f64, will_do: impl Fn(f64) -> bool) -> f64 {
    let (mut found, mut beyond) = (start, goal);
    for _ in 0..JERK_HALVINGS {
        let middle = f64::midpoint(found, beyond);
        if will_do(middle) { found = middle } else { beyond = middle }
    }
    found
}

/// The speed that is left once the acceleration has faded out.
fn fading(vel: f64, acc: f64, limits: &Limits) -> f64 {
    vel + acc * acc.abs() / (2.0 * limits.jerk)
}

/// Whether the acceleration can fade before the speed is zero, with the whole jerk if necessary.
fn can_fade(vel: f64, acc: f64, limits: &Limits) -> bool {
    let whole = Limits { jerk: limits.jerk / LOOK_AHEAD_MARGIN, ..*limits };
    acc >= 0.0 || fading(vel, acc, &whole) >= -ROUNDING_SLACK
}

/// The distance and the time to rest; `None` where the speed is zero before the acceleration can fade.
fn to_rest(vel: f64, acc: f64, limits: &Limits) -> Option<(f64, f64)> {
    if !can_fade(vel, acc, limits) {
        return None;
    }
    if acc < 0.0 && fading(vel, acc, limits) < 0.0 {
        // With the whole jerk, the acceleration fades evenly until rest.
        return Some((2.0 * vel * vel / (-3.0 * acc), -2.0 * vel / acc));
    }
    let change = Change::new(vel, acc, 0.0, limits);
    Some((change.distance(vel, acc), change.duration()))
}

/// The distance until the acceleration has faded out, or until rest where [`to_rest`] lets it fade a little quicker.
fn fading_distance(vel: f64, acc: f64, limits: &Limits) -> f64 {
    let faded = fading(vel, acc, limits);
    if faded < 0.0 {
        return 2.0 * vel * vel / (-3.0 * acc);
    }
    Change::new(vel, acc, faded, limits).distance(vel, acc)
}

/// An upper bound of the distance to rest.
fn longest_stop(vel: f64, acc: f64, limits: &Limits) -> f64 {
    let peak = fading(vel, acc.max(0.0), limits);
    peak * ((acc.abs() + 2.0 * limits.acc) / limits.jerk + peak / (2.0 * limits.acc))
}

/// The distance until the speed has come down to `goal` and stays there.
fn distance_to_speed(vel: f64, acc: f64, goal: f64, limits: &Limits) -> f64 {
    let faded = fading(vel, acc, limits);
    if faded <= goal {
        if vel <= goal {
            return 0.0;
        }
        // It brakes enough: the acceleration fades, and the speed is passed meanwhile.
        let time = (-acc - (acc * acc - 2.0 * limits.jerk * (vel - goal)).max(0.0).sqrt()) / limits.jerk;
        return State { at: 0.0, vel, acc }.after(limits.jerk, time).at;
    }
    Change::new(vel, acc, goal, limits).distance(vel, acc)
}

/// The jerk of the hardest braking in a cycle from which the acceleration can still fade before the speed is zero;
/// `None` where the speed cannot be kept from falling below zero.
fn lowest_jerk(state: &State, cycle: f64, limits: &Limits) -> Option<f64> {
    let State { vel, acc, .. } = *state;
    let jerk = limits.jerk;
    // Where x < 0 is the acceleration afterwards: vel + (acc + x) cycle / 2 >= x2 / (2 jerk).
    let inner = jerk * jerk * cycle * cycle + 4.0 * jerk * (2.0 * vel + acc * cycle);
    let fades = if inner >= 0.0 { (jerk * cycle - inner.sqrt()) / 2.0 } else { return None };
    // Where the acceleration stays above zero, the speed must not fall below zero, nor the position behind the start.
    let least =
        if fades < 0.0 { fades } else { (-2.0 * vel / cycle - acc).max(-6.0 * vel / cycle - 2.0 * acc).max(0.0) };
    let lowest = ((least.max(-limits.acc) - acc) / cycle).max(-limits.jerk);
    (lowest <= limits.jerk).then_some(lowest)
}

#[cfg(test)]
mod tests;
