//! What limits the speed along the path ahead, as the governor sees it: stretches of constant acceleration and jerk,
//! each divided into cells of constant speed. Lengths are in s of nominal time.

use std::collections::VecDeque;

use crate::limits::profile::{ALIKE_FACTOR, Limits, State};
use crate::limits::search::{self, Enough};

/// A part of a stretch with one permitted speed.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Cell {
    pub(crate) length: f64,
    pub(crate) limits: Limits,
}

/// A part of the path on which one acceleration and one jerk hold.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Stretch {
    pub(crate) cells: VecDeque<Cell>,
    pub(crate) acc: f64,
    pub(crate) jerk: f64,
    /// The highest speed at the start, without acceleration, from which everything behind the start of the stretch can
    /// be kept.
    pub(crate) entry: f64,
    /// Whether the robot has to come to rest at the end.
    pub(crate) stops: bool,
    /// Whether `entry` has been found since the last change of the stretch.
    known: bool,
}

/// Relative tolerance of the highest entry speed.
const ENTRY_SPEED_TOLERANCE: f64 = 1e-14;

/// Tolerance of the entry speed where braking only has to be known approximately.
const BRAKING_TOLERANCE: Enough = Enough { value: 1e-3, excess: 1e-3 };

/// All stretches from the one that the robot is on.
#[derive(Clone, Debug, Default)]
pub(crate) struct Timing {
    pub(crate) stretches: VecDeque<Stretch>,
    /// Length of all cells.
    length: f64,
}

impl Stretch {
    fn new(cell: Cell) -> Self {
        let Limits { acc, jerk, .. } = cell.limits;
        Self { cells: VecDeque::from([cell]), acc, jerk, entry: 0.0, stops: false, known: false }
    }

    /// Whether a cell is sufficiently like the others to join them.
    fn takes(&self, cell: &Cell) -> bool {
        let alike = |a: f64, b: f64| a <= b * ALIKE_FACTOR && b <= a * ALIKE_FACTOR;
        alike(self.acc, cell.limits.acc) && alike(self.jerk, cell.limits.jerk)
    }

    fn measure(&mut self) {
        let lowest =
            |of: fn(&Limits) -> f64| self.cells.iter().map(|cell| of(&cell.limits)).fold(f64::INFINITY, f64::min);
        (self.acc, self.jerk) = (lowest(|limits| limits.acc), lowest(|limits| limits.jerk));
    }

    /// Merges the last cells where speeds are the same, except for `open` cells at the end.
    fn settle(&mut self, open: usize) {
        /// An upper bound of the number of new cells.
        const NEW: usize = 80;
        let count = self.cells.len();
        for at in (1..count.saturating_sub(open)).rev().take(NEW) {
            let (Some(before), Some(cell)) = (self.cells.get(at - 1).copied(), self.cells.get(at).copied()) else {
                return;
            };
            let (a, b) = (before.limits, cell.limits);
            // Neither cell may lose speed: the robot may depend on both already.
            if a.vel.to_bits() == b.vel.to_bits() {
                let limits = Limits { vel: a.vel, acc: a.acc.min(b.acc), jerk: a.jerk.min(b.jerk) };
                if let Some(place) = self.cells.get_mut(at - 1) {
                    *place = Cell { length: before.length + cell.length, limits };
                }
                self.cells.remove(at);
            }
        }
    }

    /// Acceleration and jerk, with no speed limit.
    pub(crate) fn limits(&self) -> Limits {
        Limits { vel: f64::INFINITY, acc: self.acc, jerk: self.jerk }
    }

    /// The speed at which it may be entered, where `exit` is the highest speed at its end.
    fn entry(&self, exit: f64, margin: f64, cycle: f64) -> f64 {
        self.highest_speed(0.0, exit, margin, cycle)
    }

    /// The highest speed, without acceleration, at `from` behind its start, where `exit` is the highest speed at its
    /// end.
    fn highest_speed(&self, from: f64, exit: f64, margin: f64, cycle: f64) -> f64 {
        let limits = Limits { vel: 0.0, acc: self.acc * margin, jerk: self.jerk * margin };
        let mut distance = -from;
        let mut found: Option<(f64, f64)> = None;
        let speeds = self.cells.iter().skip(1).map(|cell| cell.limits.vel).chain([exit]);
        for (cell, speed) in self.cells.iter().zip(speeds) {
            distance += cell.length;
            if distance <= 0.0 {
                continue;
            }
            let first = || (cell.limits.vel, limits.slowing(cell.limits.vel, 0.0));
            let (highest, stop) = *found.get_or_insert_with(first);
            // It is entered in the middle of a cycle, and braking begins with the next one.
            let needed = |vel: f64| limits.slowing(vel, speed) + 2.0 * cycle * vel;
            if speed >= highest || needed(highest) <= distance {
                // Nothing beyond the stopping distance from here matters.
                if distance > stop {
                    break;
                }
                continue;
            }
            let enough = Enough { value: ENTRY_SPEED_TOLERANCE * highest, excess: 0.0 };
            let entry = search::highest(speed, highest, enough, |vel| needed(vel) - distance);
            found = Some((entry, limits.slowing(entry, 0.0)));
        }
        found.map_or(exit, |(highest, _)| highest)
    }
}

impl Timing {
    /// Appends a cell; with `stops`, the robot has to come to rest at its end. It joins the last stretch if it `may`.
    pub(crate) fn push(&mut self, cell: Cell, stops: bool, may: bool) {
        self.length += cell.length;
        match self.stretches.back_mut() {
            Some(last) if may && !last.stops && last.takes(&cell) => {
                last.cells.push_back(cell);
                (last.acc, last.jerk) = (last.acc.min(cell.limits.acc), last.jerk.min(cell.limits.jerk));
            }
            _ => self.stretches.push_back(Stretch::new(cell)),
        }
        if let Some(last) = self.stretches.back_mut() {
            (last.stops, last.known) = (stops, false);
        }
    }

    /// Removes the last cell; returns whether its stretch began with it.
    pub(crate) fn pop(&mut self) -> bool {
        let Some(last) = self.stretches.back_mut() else { return false };
        let popped = last.cells.pop_back();
        self.length -= popped.map_or(0.0, |cell| cell.length);
        (last.stops, last.known) = (false, false);
        if popped.is_none_or(|cell| cell.limits.acc <= last.acc || cell.limits.jerk <= last.jerk) {
            last.measure();
        }
        let began = last.cells.is_empty();
        if began {
            self.stretches.pop_back();
        }
        began
    }

    /// Merges cells whose speeds are the same, except for the last `open` ones of all, which may still be removed.
    pub(crate) fn settle(&mut self, open: usize) {
        // The last of them may have begun a stretch of their own.
        let mut open = open;
        for stretch in self.stretches.iter_mut().rev() {
            let count = stretch.cells.len();
            if open < count {
                stretch.settle(open);
                return;
            }
            open -= count;
        }
    }

    /// Finds the speeds at which stretches may be entered, from the last one backwards. `margin` is the share of the
    /// limits that may be used, `cycle` the length of a cycle in s.
    pub(crate) fn find_entries(&mut self, margin: f64, cycle: f64) {
        let (mut exit, mut changed) = (0.0, true);
        // The entry speed of the first stretch is not needed.
        for stretch in self.stretches.iter_mut().skip(1).rev() {
            // A stretch with the same exit speed as before has the same entry speed.
            if stretch.known && !changed {
                return;
            }
            let entry = stretch.entry(if stretch.stops { 0.0 } else { exit }, margin, cycle);
            changed = !stretch.known || entry != stretch.entry;
            (stretch.entry, stretch.known) = (entry, true);
            exit = entry;
        }
    }

    /// The speed at which the next stretch may be entered; `None` where no stretch follows that one, which may then
    /// still change in other ways.
    pub(crate) fn next_entry(&self) -> Option<f64> {
        if self.stretches.len() > 2 { self.stretches.get(1).map(|stretch| stretch.entry) } else { None }
    }

    /// The highest speed, without acceleration, at a place, given as in a state, from which everything behind it can be
    /// kept. `margin` and `cycle` are as in [`Self::find_entries`], which has to be called first.
    pub(crate) fn highest_speed(&self, at: f64, margin: f64, cycle: f64) -> f64 {
        let mut start = 0.0;
        let nexts = self.stretches.iter().skip(1).map(|next| next.entry).chain([0.0]);
        for (stretch, next) in self.stretches.iter().zip(nexts) {
            let end = start + stretch.cells.iter().map(|cell| cell.length).sum::<f64>();
            if at < end {
                return stretch.highest_speed(at - start, if stretch.stops { 0.0 } else { next }, margin, cycle);
            }
            start = end;
        }
        0.0
    }

    /// Whether a place, given as in a state, is on the first stretch.
    pub(crate) fn is_on_first(&self, at: f64) -> bool {
        let mut end = 0.0;
        self.stretches.front().is_some_and(|first| {
            first.cells.iter().any(|cell| {
                end += cell.length;
                at < end
            })
        })
    }

    /// Leaves behind what the robot has passed; returns whether it is at rest at a stop.
    pub(crate) fn pass(&mut self, state: &mut State) -> bool {
        while let Some(first) = self.stretches.front_mut() {
            let Some(cell) = first.cells.front().copied() else {
                let stops = first.stops;
                self.stretches.pop_front();
                if stops {
                    *state = State::default();
                    return true;
                }
                continue;
            };
            let last = first.cells.len() == 1;
            if state.at < cell.length {
                return false;
            }
            state.at -= cell.length;
            self.length -= cell.length;
            first.cells.pop_front();
            if last && first.stops {
                *state = State::default();
                self.stretches.pop_front();
                return true;
            }
        }
        false
    }

    /// Drops what is behind the next stop.
    pub(crate) fn keep_to_stop(&mut self) {
        let kept = self.stretches.iter().position(|stretch| stretch.stops).map_or(0, |last| last + 1);
        self.stretches.truncate(kept);
        self.length = self.stretches.iter().flat_map(|stretch| &stretch.cells).map(|cell| cell.length).sum();
    }

    /// The distance to the next stop, in s.
    pub(crate) fn to_stop(&self) -> f64 {
        let mut end = 0.0;
        for stretch in &self.stretches {
            end += stretch.cells.iter().map(|cell| cell.length).sum::<f64>();
            if stretch.stops {
                break;
            }
        }
        end
    }

    /// The distance in s, up to `open` s before the end of the path, over which the robot may have to brake if it has
    /// to come to rest there, however fast it may be before.
    pub(crate) fn braking(&self, open: f64) -> f64 {
        let (mut open, mut needed, mut exit) = (open, 0.0, 0.0);
        for stretch in self.stretches.iter().rev() {
            let (mut distance, mut fastest) = (-open, 0.0_f64);
            for cell in &stretch.cells {
                distance += cell.length;
                fastest = fastest.max(cell.limits.vel);
            }
            open = (-distance).max(0.0);
            if distance <= 0.0 {
                continue;
            }
            // The robot may just be speeding up.
            let fading = fastest * stretch.acc / stretch.jerk;
            let slowing = |vel: f64| stretch.limits().slowing(vel, exit) + fading;
            if slowing(fastest) <= distance {
                return needed + slowing(fastest);
            }
            needed += distance;
            exit = if fastest <= exit || slowing(exit) > distance {
                exit.min(fastest)
            } else {
                search::highest(exit, fastest, BRAKING_TOLERANCE, |vel| slowing(vel) - distance)
            };
        }
        needed
    }

    /// The distance in s to the end of the path.
    pub(crate) fn length(&self) -> f64 {
        self.length
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_robot::kinematics::random::Random;

    #[test]
    fn the_length_is_that_of_all_cells() {
        let mut random = Random::new(52);
        let mut timing = Timing::default();
        let mut state = State::default();
        for _ in 0..2000 {
            match random.between(0.0, 4.0) as u32 {
                0 => drop(timing.pop()),
                1 => {
                    state.at = random.between(0.0, 0.3);
                    timing.pass(&mut state);
                }
                _ => {
                    let limits = Limits { vel: 1.0, acc: random.between(1.0, 9.0), jerk: 10.0 };
                    timing.push(
                        Cell { length: random.between(0.01, 0.1), limits },
                        random.between(0.0, 1.0) > 0.9,
                        true,
                    );
                }
            }
            timing.settle(2);
            let cells = timing.stretches.iter().flat_map(|stretch| &stretch.cells);
            assert!((timing.length() - cells.map(|cell| cell.length).sum::<f64>()).abs() < 1e-9);
        }
    }
}
