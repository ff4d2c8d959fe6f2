//! Stops in mid-motion and other overrides: they change when the robot is where, never where it goes.

use super::{Account, CYCLE, Tally, largest};
use super::{Excursion, Parts};
use crate::motions::plan::Plan;
use crate::motions::scenario::{Scenario, Share};
use crate::motions::trace::Row;

/// deg (mm) that an axis may be off the path of an undisturbed run, between whose rows this one guesses: without a
/// limit of the jerk a way bends much within a cycle.
const BESIDE: f64 = 1e-3;

/// How much longer than an axis alone would take a stop on the path may take: speed, acceleration and jerk share the
/// limits, and what uses all of them cannot be left at once.
const LONGER: f64 = 5.0;

/// The same for coming down to a lower override.
const SLOWER: f64 = 6.0;

/// How many times the acceleration and the jerk a fast stop has.
const FAST: f64 = 5.0;

/// What is wrong with a run that somebody disturbed, beside the same program undisturbed.
pub(crate) fn compare(undisturbed: &[Row], rows: &[Row], tally: &mut Tally) -> Vec<String> {
    let mut at = 0;
    let mut worst = (0.0, 0);
    for (index, row) in rows.iter().enumerate() {
        let (off, next) = beside(undisturbed, at, &row.axes);
        at = next;
        if off > worst.0 {
            worst = (off, index);
        }
    }
    let (off, index) = worst;
    tally.note_many("stops: off the undisturbed path, deg (mm)", rows.len(), off);
    let mut faults = Vec::new();
    if off > BESIDE {
        let row = &rows[index];
        faults.push(format!("line {}, {} s: {off} deg (mm) off where it goes undisturbed", row.line, row.t));
    }
    faults
}

/// The times between which the robot may brake fast.
pub(super) fn fast_stops(plan: &Plan, scenario: &Scenario, rows: &[Row], parts: &Parts) -> Vec<(f64, f64)> {
    let known = parts.unknown.map_or(f64::INFINITY, |at| rows.get(at - 1).map_or(0.0, |row| row.t));
    let is_fast = |input| plan.handlers.iter().any(|handler| handler.input == input && handler.fast);
    let windows = scenario.inputs().filter(|(_, input)| is_fast(*input)).map(|(at, _)| {
        let from = rows.partition_point(|row| row.t < at + CYCLE / 2.0).max(1);
        let stands = (from..rows.len()).find(|row| rows[*row].axes == rows[*row - 1].axes);
        let stands = stands.map_or(f64::INFINITY, |row| rows[row].t);
        // Something else may have been under way, behind which the stop comes.
        (at - CYCLE, if at < known && stands < known { stands } else { f64::INFINITY })
    });
    windows.collect()
}

/// How far axes are off a path, from its row `at` on, and the row that they are near to.
fn beside(path: &[Row], mut at: usize, axes: &[f64]) -> (f64, usize) {
    let far = |at: usize| -> f64 { path[at].axes.iter().zip(axes).map(|(a, b)| (a - b) * (a - b)).sum() };
    let mut near = far(at);
    while at + 1 < path.len() {
        let next = far(at + 1);
        if next > near {
            break;
        }
        (near, at) = (next, at + 1);
    }
    // Between rows the path is a polynomial through four of them.
    let first = at.saturating_sub(1).min(path.len().saturating_sub(4));
    let Some(around) = path.get(first..first + 4) else { return (near.sqrt(), at) };
    let mut place = (at - first) as f64;
    let mut off = f64::INFINITY;
    for _ in 0..4 {
        let (mut along, mut square) = (0.0, 0.0);
        let [weights, slopes] = weights(place);
        off = 0.0;
        for (index, axis) in axes.iter().enumerate() {
            let sum = |weights: &[f64; 4]| weights.iter().zip(around).map(|(w, row)| w * row.axes[index]).sum::<f64>();
            let (here, slope) = (sum(&weights), sum(&slopes));
            off = f64::max(off, (here - axis).abs());
            along += (axis - here) * slope;
            square += slope * slope;
        }
        if square < 1e-18 {
            break;
        }
        place = (place + along / square).clamp(0.0, 3.0);
    }
    (off.min(near.sqrt()), at)
}

/// Of four values at 0, 1, 2, 3: the value between them, and its slope.
fn weights(at: f64) -> [[f64; 4]; 2] {
    let (a, b, c, d) = (at, at - 1.0, at - 2.0, at - 3.0);
    [
        [-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0],
        [
            -(b * c + b * d + c * d) / 6.0,
            (a * c + a * d + c * d) / 2.0,
            -(a * b + a * d + b * d) / 2.0,
            (a * b + a * c + b * c) / 6.0,
        ],
    ]
}

impl Account<'_> {
    /// Notes the share of the speed that each row may have.
    pub(super) fn disturb(&mut self, events: &[Share]) {
        self.disturbed = true;
        let (mut share, mut free_until): (f64, f64) = (1.0, 0.0);
        for (at, event) in events.iter().enumerate() {
            if event.share < share {
                free_until = free_until.max(event.at + SLOWER * self.least_stop(self.row_at(event.at)));
            }
            share = event.share;
            let until = events.get(at + 1).map_or(f64::INFINITY, |next| next.at);
            let range = self.row_at(event.at.max(free_until))..self.row_at(until);
            // How it stands is looked at elsewhere.
            if share > 0.0 && range.start < range.end {
                self.shares[range].fill(share);
            }
        }
    }

    /// Notes where the robot may brake fast.
    pub(super) fn note_fast_stops(&mut self, windows: &[(f64, f64)]) {
        for (from, to) in windows {
            let rows = self.rows.iter().zip(&mut self.hard).filter(|(row, _)| row.t >= *from && row.t <= *to);
            rows.for_each(|(_, hard)| *hard = FAST);
        }
    }

    /// A `stopmove` brakes at once.
    pub(super) fn stopmoves(&self, excursions: &[&Excursion], faults: &mut Vec<String>, tally: &mut Tally) {
        for excursion in excursions {
            let Some(at) = excursion.input_at else { continue };
            let (from, to) = (self.row_at(at), self.row_at(excursion.stop.t) + 1);
            let least = self.least_stop(from);
            let moving =
                (from.max(1)..to.min(self.rows.len())).rev().find(|at| self.rows[*at].axes != self.rows[*at - 1].axes);
            let Some(moving) = moving.filter(|_| least > 0.0) else { continue };
            let took = (moving + 1 - from) as f64 * CYCLE;
            tally.note("stops: time of a stopmove / least time of an axis alone", took / least);
            if took > LONGER * least {
                faults.push(format!("{at} s: stopmove takes {took} s, {least} is the least"));
            }
        }
    }

    /// The first row not before a time.
    fn row_at(&self, t: f64) -> usize {
        self.rows.partition_point(|row| row.t < t - CYCLE / 2.0)
    }

    /// How long the axes and the TCP at least need to come to rest at a row, each alone, in s.
    fn least_stop(&self, at: usize) -> f64 {
        let rows = &self.rows;
        let Some([before, here]) = at.checked_sub(2).and_then(|from| rows.get(from..at)) else { return 0.0 };
        let part = self.legs.iter().flat_map(|leg| leg.motion.accset).fold(1.0, f64::min);
        let stop = |speed: f64, acc: f64, jerk: f64| {
            if speed < 1e-6 { 0.0 } else { speed / (acc * part) + 2.0 * acc / jerk }
        };
        let axes = self.robot.axes.iter().zip(here.axes.iter().zip(&before.axes));
        axes.map(|(axis, (now, before))| stop((now - before).abs() / CYCLE, axis.acc, axis.jerk)).fold(0.0, f64::max)
    }
}

/// What is wrong with how a robot comes to rest when it is told to.
pub(super) fn stops(account: &Account<'_>, scenario: &Scenario, tally: &mut Tally) -> Vec<String> {
    let mut faults = Vec::new();
    let rows = &account.rows;
    for pair in scenario.shares().windows(2) {
        let [Share { at, share: 0.0 }, Share { at: until, .. }] = pair else { continue };
        let until = until.min(scenario.jogged_from(*at));
        let (from, to) = (account.row_at(*at), account.row_at(until));
        let least = account.least_stop(from);
        // What came in between is looked at by itself.
        let aside = rows.get(from).is_none_or(|row| row.t > at + 1.5 * CYCLE);
        if least == 0.0 || to >= rows.len() || aside {
            continue;
        }
        // The row with which it stands.
        let stands = (from..to).rev().find(|at| rows[*at].axes != rows[*at - 1].axes).map_or(from, |at| at + 1);
        if stands == to {
            // Told to go on before it stood; but it must have stood by now if it had so long.
            if until - at > LONGER * least {
                faults.push(format!("{at} s: it still moves after {} s, {least} is the least", until - at));
            }
            continue;
        }
        let took = (stands - from) as f64 * CYCLE;
        tally.note("stops: time / least time of an axis alone", took / least);
        tally.note("stops: s", took);
        let travel = largest(rows[stands].axes.iter().zip(&rows[from].axes).map(|(a, b)| a - b));
        tally.note("stops: way of an axis, deg (mm)", travel);
        if took > LONGER * least {
            faults.push(format!("{at} s: it stands after {took} s, {least} is the least"));
        }
    }
    faults
}
