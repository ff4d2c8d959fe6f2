//! Every axis keeps its range, and its limits of speed, acceleration and jerk.

use super::{Account, CYCLE, EXACT, Leg, ROUNDING, SLACK, Tally};
use crate::motions::plan::Profile;

/// What holds in a row: shares of the axes' own limits, and speeds of external axes.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Scale {
    /// Of speed, acceleration, jerk.
    own: [f64; 3],
    /// deg/s
    exj: f64,
    /// mm/s
    exl: f64,
}

const NOTHING: Scale = Scale { own: [0.0; 3], exj: 0.0, exl: 0.0 };

impl Scale {
    fn of(leg: &Leg) -> Scale {
        let motion = &leg.motion;
        let axes = if leg.leads_tool() { 1.0 } else { motion.speeds.axes.min(1.0) };
        let [acc, ramp] = motion.accset;
        let jerk = if motion.profile == Profile::T { f64::INFINITY } else { ramp };
        Scale { own: [axes, acc, jerk], exj: motion.speeds.exj, exl: motion.speeds.exl }
    }

    fn max(self, other: Scale) -> Scale {
        let own = std::array::from_fn(|i| self.own[i].max(other.own[i]));
        Scale { own, exj: self.exj.max(other.exj), exl: self.exl.max(other.exl) }
    }
}

impl Account<'_> {
    pub(super) fn limits(&self, faults: &mut Vec<String>, tally: &mut Tally) {
        let (rows, scales) = (&self.rows, self.scales());
        for (index, axis) in self.robot.axes.iter().enumerate() {
            let name = if index < self.robot.own {
                format!("j{}", index + 1)
            } else {
                format!("ej{}", index + 1 - self.robot.own)
            };
            let mut series: Vec<f64> = rows.iter().map(|row| row.axes[index]).collect();
            for (value, row) in series.iter().zip(rows) {
                if *value < axis.min - EXACT || *value > axis.max + EXACT {
                    faults.push(format!("line {}, {} s: {name} at {value}", row.line, row.t));
                    break;
                }
            }
            // It stands after the trace. (Where it stood before is not in the trace.)
            series.extend([series[series.len() - 1]; 3]);
            let limits = [
                ("speed", "limits: speed of an axis / limit", axis.vel),
                ("acceleration", "limits: acceleration of an axis / limit", axis.acc),
                ("jerk", "limits: jerk of an axis / limit", axis.jerk),
            ];
            for (order, (what, note, most)) in limits.into_iter().enumerate() {
                series = series.windows(2).map(|pair| (pair[1] - pair[0]) / CYCLE).collect();
                let noise = ROUNDING * f64::from(2 << order) / CYCLE.powi(order as i32 + 1);
                let allowed = |scale: &Scale| match order {
                    0 if index >= self.robot.own => most.min(if axis.linear { scale.exl } else { scale.exj }),
                    _ => most * scale.own[order],
                };
                let share = |at: usize| {
                    let end = (at + order + 1).min(rows.len() - 1);
                    let near = at.min(end)..=end;
                    let factor = |row: usize| if order == 0 { self.shares[row] } else { self.hard[row] };
                    let allowed = near.map(|row| allowed(&scales[row]) * factor(row)).fold(0.0, f64::max);
                    ((series[at].abs() - noise) / allowed, end)
                };
                let worst = (0..series.len()).map(share).max_by(|a, b| a.0.total_cmp(&b.0));
                let Some((share, end)) = worst else { continue };
                let note =
                    if order == 2 && self.disturbed { "limits: jerk of an axis / limit, disturbed" } else { note };
                tally.note_many(note, series.len(), share);
                if share > SLACK {
                    let row = &rows[end];
                    faults.push(format!("line {}, {} s: {share:.4} of the {what} of {name}", row.line, row.t));
                }
            }
        }
    }

    /// What holds in each row: the most that the motion, and those that it is blended with, may use.
    fn scales(&self) -> Vec<Scale> {
        let (legs, count) = (&self.legs, self.rows.len());
        // Of a trace of which nothing else is known.
        if legs.iter().all(|leg| leg.rows.is_empty()) {
            return vec![legs.iter().map(Scale::of).fold(NOTHING, Scale::max); count];
        }
        let mut scales = vec![NOTHING; count];
        for (at, leg) in legs.iter().enumerate() {
            let before = at.checked_sub(1).map(|at| &legs[at]).filter(|leg| !leg.rests);
            let behind = legs.get(at + 1).filter(|_| !leg.rests);
            let scale =
                before.into_iter().chain(behind).fold(Scale::of(leg), |scale, other| scale.max(Scale::of(other)));
            scales[leg.rows.clone()].fill(scale);
        }
        // Where nothing is executed, nothing moves: what is beside it counts.
        for at in 1..count {
            if scales[at] == NOTHING {
                scales[at] = scales[at - 1];
            }
        }
        for at in (1..count).rev() {
            if scales[at - 1] == NOTHING {
                scales[at - 1] = scales[at];
            }
        }
        scales
    }
}
