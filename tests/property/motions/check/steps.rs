//! Single steps: one motion each, and nothing is blended.

use super::{Account, CYCLE, Leg, Tally};
use crate::motions::plan::{Kind, Zone};
use crate::motions::scenario::{Deed, Scenario};
use crate::motions::trace::Row;

/// Lets motions that are planned in single steps rest at their targets, but those that make one way with the next.
pub(super) fn keep_apart(legs: &mut [Leg], rows: &[Row], until: f64) {
    for at in 0..legs.len() {
        let begins = rows.iter().find(|row| row.line == legs[at].motion.line).map_or(f64::INFINITY, |row| row.t);
        // What begins in the very cycle of the start is planned after it.
        if begins < until - CYCLE / 2.0 {
            let goes_on = is_chained(&legs[at..]);
            legs[at].rests |= !goes_on;
            legs[at].motion.zone = Zone::None;
        }
    }
}

/// Whether the first of these motions makes one way with the next.
fn is_chained(legs: &[Leg]) -> bool {
    match legs {
        [first, next, ..] => {
            first.motion.kind == Kind::CcirVia
                || first.motion.kind == Kind::Spl
                    && next.motion.kind == Kind::Spl
                    && first.motion.setting == next.motion.setting
        }
        _ => false,
    }
}

/// Whether they are one step.
fn is_one_step(kind: Kind, next: Kind) -> bool {
    matches!((kind, next), (Kind::CcirVia, Kind::Ccir) | (Kind::Spl, Kind::Spl))
}

impl Account<'_> {
    /// Between two presses of the button one motion begins at most, or one way.
    pub(super) fn steps(&self, scenario: &Scenario, faults: &mut Vec<String>, tally: &mut Tally) {
        let presses: Vec<f64> = scenario
            .events
            .iter()
            .take_while(|event| event.deed == Deed::Step)
            .map(|event| event.at)
            .chain(scenario.stepped_until())
            .collect();
        for pair in presses.windows(2) {
            let begins = |leg: &&Leg| {
                let t = self.rows.get(leg.rows.start).map_or(0.0, |row| row.t);
                !leg.rows.is_empty() && t >= pair[0] && t < pair[1]
            };
            let begun: Vec<&Leg> = self.legs.iter().filter(begins).collect();
            tally.note("steps", begun.len() as f64);
            let apart = begun.windows(2).find(|pair| !is_one_step(pair[0].motion.kind, pair[1].motion.kind));
            if let Some(legs) = apart {
                let [line, next] = [0, 1].map(|at| legs[at].motion.line);
                faults.push(format!("{} s: lines {line} and {next} are gone in one step", pair[0]));
            }
        }
    }
}
