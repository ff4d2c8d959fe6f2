//! The governor: how fast to go along the course, cycle by cycle.
//!
//! Invariant: from the state that it returns, the robot can come to the speed of every piece ahead before it gets there,
//! and to rest before the end, within the limits of the pieces in between. So a stop, a change of the override or a motion
//! that comes late never leads off the path or beyond a limit. Each cycle takes the highest jerk that keeps this true.

mod demands;

use std::collections::VecDeque;
use std::ops::{ControlFlow, RangeInclusive};

use super::profile::{Change, Limits, State};
use super::timing::{Cell, Stretch};
use demands::{ALL_CELLS, Cells, Demand, NO_CELLS};

/// How fast to go.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Pacing {
    /// On, at a share of the full speed, above 0 to 1, with ramps as slow in proportion.
    Go(f64),
    /// On, to a share of the full speed that has just changed, with all that the limits allow.
    Settle(f64),
    /// To rest on the path, with so many times the acceleration and jerk.
    Stop(f64),
}

/// Factors on speed, acceleration and jerk.
#[derive(Clone, Copy, Debug)]
struct Scale {
    vel: f64,
    acc: f64,
    jerk: f64,
}

/// Nothing but the limits.
const FREE: Scale = Scale { vel: 1.0, acc: 1.0, jerk: 1.0 };
/// Looking ahead counts on a little less than the limits, so that whole cycles can follow what it found.
pub(super) const MARGIN: f64 = 0.998;
/// The part of the acceleration that counts as none when the override has been reached.
const CALM: f64 = 0.02;
/// Relative slack for rounding in comparisons.
const SLACK: f64 = 1e-9;
/// The same for the speed at which a slower piece is entered.
const SLOWER: f64 = 1e-6;
/// The same for a speed within its cell, where a little acceleration may be left from before it.
const TOO_FAST: f64 = 1e-5;
/// A stop that is only by this part farther away than braking takes is where the robot stops anyway.
const ENDING: f64 = 0.02;
/// Slack for rounding in s of nominal time, and in full speeds.
const ROUNDING: f64 = 1e-12;
/// Slack for a state that was found at the edge of what is possible.
const EDGE: f64 = 1e-9;
/// Halvings of the interval in which the jerk is looked for.
const HALVINGS: u32 = 30;
/// A rest of the way that is so small a part of what a cycle's jerk moves is no way.
const SNAP: f64 = 0.005;

/// Looks at the way ahead.
pub(super) struct Governor<'a> {
    pub(super) stretches: &'a VecDeque<Stretch>,
    /// The length of a cycle in s.
    pub(super) cycle: f64,
}

impl Governor<'_> {
    /// Whether the state can go on; see the invariant. It is at the edge of that most of the time, but for rounding.
    pub(super) fn holds(&self, state: &State) -> bool {
        self.possible(state, FREE, EDGE, &ALL_CELLS)
    }

    /// The state a cycle later. Beyond the end of the first cell `at` goes on into the next ones.
    pub(super) fn next(&self, state: &State, pacing: Pacing) -> State {
        let next = self.paced(state, pacing);
        // Rounding must not carry it past a stop.
        match self.stop_end(next.at) {
            Some(end) => State { at: end, vel: 0.0, acc: 0.0 },
            None => next,
        }
    }

    /// Where the robot stops, if it is up to `at`.
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

    fn paced(&self, state: &State, pacing: Pacing) -> State {
        match pacing {
            Pacing::Stop(harder) => self.slower(state, Scale { vel: 1.0, acc: harder, jerk: harder }),
            Pacing::Go(share) => {
                let slowed = slowed(share);
                let ends = self.arrives(state, slowed).or_else(|| self.arrives(state, FREE));
                let next = ends.or_else(|| self.faster(state, slowed));
                next.unwrap_or_else(|| self.paced(state, Pacing::Settle(share)))
            }
            Pacing::Settle(share) => {
                let quick = Scale { vel: share, ..FREE };
                if let Some(next) = self.arrives(state, FREE).or_else(|| self.faster(state, quick)) {
                    return next;
                }
                // Too fast for this share yet: as soon as can be to the speed that it allows.
                let slowing = self.at(state.at).and_then(|(here, cell)| {
                    self.toward_within(state, cell.limits.vel * share, careful(here, FREE), FREE)
                });
                slowing.unwrap_or_else(|| self.braking(state, FREE))
            }
        }
    }

    /// Whether the state is one that a motion at this share of the speed may have.
    pub(super) fn settled(&self, state: &State, share: f64) -> bool {
        let scale = slowed(share);
        let calm = self.at(state.at).is_none_or(|(here, _)| state.acc.abs() <= CALM * here.acc * scale.acc);
        state.rests() || (calm && self.feasible(state, scale))
    }

    /// The state at a stop, where it is reached within the cycle.
    fn arrives(&self, state: &State, scale: Scale) -> Option<State> {
        let here = self.stretches.front()?;
        let limits = careful(here, scale);
        let length: f64 = here.cells.iter().map(|cell| cell.length).take(4).sum();
        if !here.stops || here.cells.len() > 4 {
            return None;
        }
        let left = length - state.at;
        let jerk = limits.jerk.min(limits.acc / self.cycle);
        let nothing = SNAP * jerk * self.cycle * self.cycle * self.cycle;
        let end = State { at: length, vel: 0.0, acc: 0.0 };
        if state.rests() {
            return (left <= nothing).then_some(end);
        }
        let (way, time) = to_rest(state.vel, state.acc, &limits)?;
        let there = time <= self.cycle * 1.000_001 && (way - left).abs() <= nothing.max(2.0 * ROUNDING);
        (there || left <= 2.0 * ROUNDING).then_some(end)
    }

    /// The quickest way on for a cycle; `None` where there is none.
    fn faster(&self, state: &State, scale: Scale) -> Option<State> {
        let limits = self.touched(state, scale)?;
        let highest = ((limits.acc - state.acc) / self.cycle).min(limits.jerk);
        let lowest = lowest_jerk(state, self.cycle, &limits)?;
        let highest = highest.max(lowest);
        let next = |jerk: f64| state.after(jerk, self.cycle);
        if self.feasible(&next(highest), scale) {
            return Some(next(highest));
        }
        // The more jerk, the longer the way to any speed: what the highest leaves undone is all that counts below it.
        let undone = self.undone(&next(highest), scale);
        let quick = Self::highest(lowest..=highest, next, |state| self.possible(state, scale, 0.0, &undone));
        let found = quick.filter(|quick| self.feasible(quick, scale));
        let found = found.or_else(|| Self::highest(lowest..=highest, next, |state| self.feasible(state, scale)));
        // What was feasible stays so, if only to the last digits, on the way that was found for it.
        found.or_else(|| self.feasible(state, scale).then(|| self.braking(state, scale)))
    }

    /// The next state with the highest jerk that will do, of a range whose end does not; `None` where none does.
    fn highest(
        range: RangeInclusive<f64>,
        next: impl Fn(f64) -> State,
        will_do: impl Fn(&State) -> bool,
    ) -> Option<State> {
        let (mut low, mut high) = range.into_inner();
        if !will_do(&next(low)) {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(low, high);
            if will_do(&next(middle)) { low = middle } else { high = middle }
        }
        Some(next(low))
    }

    /// The cells whose speeds cannot be reached in time, and those between them.
    fn undone(&self, state: &State, scale: Scale) -> Cells {
        let mut undone: Option<Cells> = None;
        self.demands(state, scale, &ALL_CELLS, |demand| {
            if demand.left < 0.0
                && let Some(cell) = demand.cell
            {
                undone = Some(undone.take().map_or(cell, |cells| cells.start)..cell + 1);
            }
            ControlFlow::Continue(())
        });
        undone.unwrap_or(NO_CELLS)
    }

    /// As slow as it can be a cycle later, down to rest.
    fn slower(&self, state: &State, scale: Scale) -> State {
        let Some(here) = self.stretches.front() else { return State { vel: 0.0, acc: 0.0, ..*state } };
        if state.rests() {
            return *state;
        }
        // On the way to a stop that is hardly farther than braking takes, that is where to stop.
        if let Some(end) = self.arrives(state, FREE) {
            return end;
        }
        if self.at_its_end(state)
            && let Some(next) = self.faster(state, FREE)
        {
            return next;
        }
        // Braking hardest may lead into a stretch that allows less.
        let next = self.toward_within(state, 0.0, scaled(here, scale), scale);
        next.unwrap_or_else(|| self.braking(state, scale))
    }

    /// The state a cycle later on the quickest way to a speed, with no more than `limits`: within those of all stretches that
    /// the cycle touches, or of this one, where only that leaves it possible to go on.
    fn toward_within(&self, state: &State, goal: f64, limits: Limits, scale: Scale) -> Option<State> {
        let all = self.touched(state, scale).map(|touched| lower(limits, touched));
        let mut found = all.into_iter().chain([limits]).map(|limits| self.toward(state, goal, &limits));
        found.find(|next| self.feasible(next, scale))
    }

    /// Whether the robot brakes for a stop already.
    fn at_its_end(&self, state: &State) -> bool {
        let mut nearest = f64::INFINITY;
        let mut way = 0.0;
        self.demands(state, FREE, &ALL_CELLS, |Demand { goal, limits, left, .. }| {
            if goal == 0.0 && left < nearest {
                nearest = left;
                way = to_rest(state.vel, state.acc, &limits).map_or(0.0, |(way, _)| way);
            }
            ControlFlow::Continue(())
        });
        nearest <= ENDING * way
    }

    /// The state a cycle later on the way to the speed that is hardest to reach in time. What looking ahead found
    /// feasible stays so, to the last digits.
    fn braking(&self, state: &State, scale: Scale) -> State {
        let Some((here, cell)) = self.at(state.at) else { return State { vel: 0.0, acc: 0.0, ..*state } };
        let highest = (cell.limits.vel * scale.vel).min(state.vel);
        let mut found = (highest, careful(here, scale));
        let mut least = f64::INFINITY;
        self.demands(state, scale, &ALL_CELLS, |Demand { goal, limits, left, .. }| {
            if left < least && goal <= highest {
                (least, found) = (left, (goal, limits));
            }
            ControlFlow::Continue(())
        });
        let (goal, limits) = found;
        self.toward(state, goal, &limits)
    }

    /// The state a cycle later on the quickest way to a speed.
    fn toward(&self, state: &State, goal: f64, limits: &Limits) -> State {
        let State { at, vel, acc } = *state;
        if goal == 0.0 && acc < 0.0 && fading(vel, acc, limits) < 0.0 {
            // A little more than the jerk is needed for the acceleration to fade with the speed.
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
        State { vel: next.vel.max(0.0), ..next }
    }

    /// Acceleration and jerk of all stretches that the robot is on within the cycle.
    fn touched(&self, state: &State, scale: Scale) -> Option<Limits> {
        let here = self.stretches.front()?;
        let limits = scaled(here, scale);
        let reach = state.at + (state.vel + limits.acc * self.cycle) * self.cycle;
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

    /// Whether the state keeps to the limits where it is, and all demands of the way ahead can be met.
    fn feasible(&self, state: &State, scale: Scale) -> bool {
        self.possible(state, scale, 0.0, &ALL_CELLS)
    }

    /// The same, as far as it concerns these cells' speeds, with a slack for speeds, as a share, and for ways, in s of
    /// nominal time.
    fn possible(&self, state: &State, scale: Scale, slack: f64, cells: &Cells) -> bool {
        let State { vel, acc, .. } = *state;
        let Some((here, cell)) = self.at(state.at) else { return state.rests() };
        let limits = careful(here, scale);
        let peak = fading(vel, acc.max(0.0), &limits);
        let highest = cell.limits.vel * scale.vel * (1.0 + TOO_FAST + slack);
        if vel < 0.0 || acc.abs() * MARGIN > limits.acc * (1.0 + SLACK + slack) || peak > highest {
            return false;
        }
        let mut met = true;
        self.demands(state, scale, cells, |demand| {
            met = demand.left >= -slack;
            if met { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        met
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

/// A sum of lengths that ends when it has passed a bound.
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

/// Acceleration and jerk that looking ahead counts on.
fn careful(stretch: &Stretch, scale: Scale) -> Limits {
    let Limits { vel, acc, jerk } = scaled(stretch, scale);
    Limits { vel, acc: acc * MARGIN, jerk: jerk * MARGIN }
}

fn lower(a: Limits, b: Limits) -> Limits {
    Limits { vel: a.vel.min(b.vel), acc: a.acc.min(b.acc), jerk: a.jerk.min(b.jerk) }
}

/// The speed that is left when the acceleration has faded out.
fn fading(vel: f64, acc: f64, limits: &Limits) -> f64 {
    vel + acc * acc.abs() / (2.0 * limits.jerk)
}

/// The way to rest and the time that it takes; `None` where the speed ends before the acceleration can fade.
fn to_rest(vel: f64, acc: f64, limits: &Limits) -> Option<(f64, f64)> {
    if acc < 0.0 && fading(vel, acc, limits) < 0.0 {
        // With the whole jerk it may still fade in time: evenly until rest.
        let whole = Limits { jerk: limits.jerk / MARGIN, ..*limits };
        return (fading(vel, acc, &whole) >= -ROUNDING).then(|| (2.0 * vel * vel / (-3.0 * acc), -2.0 * vel / acc));
    }
    let change = Change::new(vel, acc, 0.0, limits);
    Some((change.distance(vel, acc), change.duration()))
}

/// At least as long as the way to rest.
fn longest_stop(vel: f64, acc: f64, limits: &Limits) -> f64 {
    let peak = fading(vel, acc.max(0.0), limits);
    peak * ((acc.abs() + 2.0 * limits.acc) / limits.jerk + peak / (2.0 * limits.acc))
}

/// The way until the speed has come down to `goal` and stays there.
fn way_to_speed(vel: f64, acc: f64, goal: f64, limits: &Limits) -> f64 {
    let left = fading(vel, acc, limits);
    if left <= goal {
        if vel <= goal {
            return 0.0;
        }
        // It brakes enough: the acceleration fades, and on the way the speed is passed.
        let time = (-acc - (acc * acc - 2.0 * limits.jerk * (vel - goal)).max(0.0).sqrt()) / limits.jerk;
        return State { at: 0.0, vel, acc }.after(limits.jerk, time).at;
    }
    Change::new(vel, acc, goal, limits).distance(vel, acc)
}

/// The hardest braking of a cycle from which the acceleration can still fade before the speed does; `None` where the
/// speed cannot be kept from falling below zero.
fn lowest_jerk(state: &State, cycle: f64, limits: &Limits) -> Option<f64> {
    let State { vel, acc, .. } = *state;
    let jerk = limits.jerk;
    // With x the acceleration afterwards: vel + (acc + x) cycle / 2 >= x2 / (2 jerk) where x < 0.
    let inner = jerk * jerk * cycle * cycle + 4.0 * jerk * (2.0 * vel + acc * cycle);
    let fades = if inner >= 0.0 { (jerk * cycle - inner.sqrt()) / 2.0 } else { return None };
    let least = if fades < 0.0 { fades } else { (-2.0 * vel / cycle - acc).max(0.0) };
    let lowest = ((least.max(-limits.acc) - acc) / cycle).max(-limits.jerk);
    (lowest <= limits.jerk).then_some(lowest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::random::Random;
    use crate::motion::timing::Timing;

    fn timing(cells: &[(f64, Limits)]) -> Timing {
        let mut timing = Timing::default();
        for (index, (length, limits)) in cells.iter().enumerate() {
            timing.push(Cell { length: *length, limits: *limits }, index + 1 == cells.len(), true);
        }
        timing.find_entries(MARGIN, 0.001);
        timing
    }

    /// Runs until the end; every cycle the state must keep to the limits where it is. Returns the cycles.
    fn run(cells: &[(f64, Limits)], pacing: impl Fn(u32) -> Pacing) -> u32 {
        let mut timing = timing(cells);
        let (mut state, mut cycle, mut done) = (State::default(), 0, 0.0);
        let whole: f64 = cells.iter().map(|(length, _)| length).sum();
        loop {
            let before = state;
            let pace = pacing(cycle);
            state = Governor { stretches: &timing.stretches, cycle: 0.001 }.next(&state, pace);
            cycle += 1;
            let told = format!("{cycle}: {done} {before:?} {state:?} {cells:?}");
            assert!(cycle < 100_000, "{told}");
            done += state.at - before.at;
            let harder = if let Pacing::Stop(harder) = pace { harder } else { 1.0 };
            let mut end = 0.0;
            let here = cells.iter().position(|(length, _)| {
                end += length;
                done - state.vel * 0.001 < end
            });
            let Some((_, Limits { vel, acc, jerk })) = here.and_then(|here| cells.get(here)) else {
                assert!(state.rests(), "{told}");
                return cycle;
            };
            let before_end = done < end;
            if before_end {
                assert!(state.vel >= 0.0 && state.vel <= vel * 1.000_2, "{told}");
                assert!(state.acc.abs() <= acc * harder * 1.001, "{told}");
                let change = (state.acc - before.acc).abs() / 0.001;
                assert!(change <= jerk * harder * 1.02, "{change} {told}");
            }
            let mut rest = state;
            if timing.pass(&mut rest) {
                assert!(state.rests() && (done - whole).abs() < 1e-9, "{told}");
                return cycle;
            }
            state = rest;
        }
    }

    #[test]
    fn rest_to_rest_takes_hardly_longer_than_the_shortest() {
        let mut random = Random::new(81);
        for _ in 0..100 {
            let (acc, time) = (random.between(1.0, 20.0), 10.0_f64.powf(random.between(-2.0, 0.5)));
            let limits = Limits { vel: 1.0, acc, jerk: acc * random.between(2.0, 60.0) };
            let cycles = run(&[(time, limits)], |_| Pacing::Go(1.0));
            let shortest = limits.duration(time);
            assert!(f64::from(cycles) * 0.001 <= shortest * 1.002 + 0.002, "{cycles} {shortest} {limits:?}");
            assert!(f64::from(cycles) * 0.001 >= shortest - 0.001, "{cycles} {shortest}");
        }
    }

    #[test]
    fn stops_and_overrides_keep_to_the_limits_and_the_end() {
        let mut random = Random::new(82);
        for round in 0..60 {
            let acc = random.between(1.0, 20.0);
            let limits = Limits { vel: 1.0, acc, jerk: acc * random.between(2.0, 60.0) };
            let cells = [(random.between(0.05, 2.0), limits)];
            let (stop, harder) = (random.between(1.0, 1500.0) as u32, if round % 2 == 0 { 1.0 } else { 5.0 });
            let share = random.between(0.01, 1.0);
            run(
                &cells,
                |cycle| {
                    if cycle >= stop && cycle < stop + 1500 { Pacing::Stop(harder) } else { Pacing::Go(1.0) }
                },
            );
            run(&cells, |cycle| if cycle >= stop { Pacing::Settle(share) } else { Pacing::Go(1.0) });
            // A slider that moves all the time.
            let shares: Vec<f64> = (0..100).map(|_| random.between(0.01, 1.0)).collect();
            run(&cells, |cycle| Pacing::Settle(shares[(cycle as usize / (1 + round % 7)) % shares.len()]));
        }
    }

    #[test]
    fn slower_cells_are_entered_at_their_speed() {
        let mut random = Random::new(83);
        for round in 0..60 {
            let mut some = || {
                let vel = random.between(0.1, 1.0);
                let acc = if round % 2 == 0 { random.between(1.0, 20.0) } else { random.between(5.0, 8.0) };
                let limits =
                    Limits { vel, acc, jerk: acc * random.between(5.0, if round % 4 < 2 { 60.0 } else { 8.0 }) };
                (10.0_f64.powf(random.between(-2.5, 0.0)), limits)
            };
            let cells: Vec<_> = (0..8).map(|_| some()).collect();
            run(&cells, |_| Pacing::Go(1.0));
            let stop = 100 + round * 3;
            run(&cells, |cycle| if cycle >= stop && cycle < stop + 900 { Pacing::Stop(1.0) } else { Pacing::Go(1.0) });
        }
    }
}
