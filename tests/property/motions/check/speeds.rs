//! The TCP is never faster than programmed, nor than the robot allows, and a duration is kept.

use super::{Account, CYCLE, Leg, ROUNDING, SLACK, Tally};
use crate::motions::geometry::{distance, turned};
use crate::motions::plan::MANUAL;
use crate::motions::trace::Row;

/// What the TCP and the turning of the tool may do.
struct Most {
    tcp: f64,
    ori: f64,
    /// Of the robot's accelerations.
    acc: f64,
}

impl Account<'_> {
    pub(super) fn speeds(&self, faults: &mut Vec<String>, tally: &mut Tally) {
        for at in 1..self.legs.len() {
            if self.legs[at].rows.is_empty() {
                continue;
            }
            self.duration(at, faults, tally);
            if let Some(most) = self.most(at) {
                self.speeds_of(&self.legs[at], &most, faults, tally);
            }
        }
    }

    /// The limits of a motion of the TCP; nothing where a part of it is blended with a motion of the axes, or of
    /// another tool.
    fn most(&self, at: usize) -> Option<Most> {
        let leg = &self.legs[at];
        let blended = |at: usize, with: usize| self.legs.get(with).filter(|_| !self.legs[at].rests);
        let neighbours: Vec<&Leg> = blended(at - 1, at - 1).into_iter().chain(blended(at, at + 1)).collect();
        let same = |other: &&Leg| other.leads_tool() && other.motion.setting == leg.motion.setting;
        if !leg.leads_tool() || !neighbours.iter().all(same) {
            return None;
        }
        let all = || neighbours.iter().copied().chain([leg]).map(|leg| &leg.motion);
        let limits = &self.robot.tcp;
        // A blend of motions that hardly turn may turn as fast as the robot can.
        let ori = if neighbours.is_empty() { leg.motion.speeds.ori } else { f64::INFINITY };
        Some(Most {
            tcp: all().map(|motion| motion.speeds.tcp).fold(0.0, f64::max).min(limits.vel),
            ori: ori.min(limits.ori_vel),
            acc: all().map(|motion| motion.accset[0]).fold(0.0, f64::max),
        })
    }

    fn speeds_of(&self, leg: &Leg, most: &Most, faults: &mut Vec<String>, tally: &mut Tally) {
        let rows = &self.rows[leg.rows.clone()];
        let line = leg.motion.line;
        let speeds = |of: &dyn Fn(usize) -> f64| -> Vec<f64> { (1..rows.len()).map(|at| of(at) / CYCLE).collect() };
        let tcp = speeds(&|at| distance(&rows[at].tcp, &rows[at - 1].tcp));
        let shares = self.shares[leg.rows.clone()].windows(2).map(|pair| f64::max(pair[0], pair[1]));
        let shares: Vec<f64> = shares.collect();
        let most_of =
            |speeds: &[f64]| speeds.iter().zip(&shares).map(|(speed, share)| speed / share).fold(0.0, f64::max);
        let fastest = most_of(&tcp);
        tally.note_many("speeds: TCP / programmed", tcp.len(), fastest / most.tcp);
        if fastest > SLACK * most.tcp {
            faults.push(format!("line {line}: the TCP goes at {fastest} mm/s, {} are programmed", most.tcp));
        }
        let limits = &self.robot.tcp;
        let noise = 8.0 * ROUNDING / CYCLE.powi(2);
        let hard: Vec<f64> =
            self.hard[leg.rows.clone()].windows(3).map(|hard| hard.iter().copied().fold(1.0, f64::max)).collect();
        let acceleration = |speeds: &[f64]| {
            let changes = speeds.windows(2).map(|pair| (pair[1] - pair[0]).abs() / CYCLE - noise);
            changes.zip(&hard).map(|(change, hard)| change / hard).fold(0.0, f64::max)
        };
        let hardest = acceleration(&tcp) / (limits.acc * most.acc);
        tally.note_many("limits: acceleration along the TCP's way / limit", tcp.len(), hardest);
        if hardest > SLACK {
            faults.push(format!("line {line}: the TCP accelerates along its way with {hardest:.4} of its limit"));
        }
        if leg.motion.wrist {
            return;
        }
        let turning = speeds(&|at| turned(&rows[at].tcp, &rows[at - 1].tcp));
        let fastest = most_of(&turning);
        tally.note_many("speeds: turning of the tool / programmed", turning.len(), fastest / most.ori);
        if fastest > SLACK * most.ori + noise * CYCLE {
            faults.push(format!("line {line}: the tool turns at {fastest} deg/s, {} are programmed", most.ori));
        }
        let hardest = acceleration(&turning) / (limits.ori_acc * most.acc);
        tally.note_many("limits: acceleration of the tool's turning / limit", turning.len(), hardest);
        if hardest > SLACK {
            faults.push(format!("line {line}: the tool's turning accelerates with {hardest:.4} of its limit"));
        }
    }

    /// In manual operation nothing of the TCP is faster, on no kind of motion.
    pub(super) fn manual_speed(&self, faults: &mut Vec<String>, tally: &mut Tally) {
        for leg in self.legs.iter().filter(|leg| leg.motion.manual && leg.rows.len() > 1) {
            let rows = &self.rows[leg.rows.clone()];
            let flange = |row: &Row| self.robot.flange(&row.axes);
            let pairs = rows.windows(2);
            let speeds = pairs.map(|pair| {
                let tcp = distance(&pair[1].tcp, &pair[0].tcp);
                // What holds the workpiece must not be faster, either.
                let holder = leg.setting.held.then(|| distance(&flange(&pair[1]), &flange(&pair[0])));
                (tcp.max(holder.unwrap_or(0.0)) / CYCLE, pair[1].t)
            });
            let (fastest, t) = speeds.max_by(|a, b| a.0.total_cmp(&b.0)).expect("two rows");
            tally.note_many("speeds: TCP / 250 mm/s in manual operation", rows.len(), fastest / MANUAL);
            if fastest > SLACK * MANUAL {
                let line = leg.motion.line;
                faults.push(format!("line {line}, {t} s: the TCP goes at {fastest} mm/s in manual operation"));
            }
        }
    }

    /// A motion from rest to rest takes as long as it says, where nobody changes its speed.
    fn duration(&self, at: usize, faults: &mut Vec<String>, tally: &mut Tally) {
        let leg = &self.legs[at];
        let Some(wanted) = leg.motion.dura.filter(|_| leg.rests && self.legs[at - 1].rests && !self.disturbed) else {
            return;
        };
        let took = leg.rows.len() as f64 * CYCLE;
        tally.note("durations: s off", (took - wanted).abs());
        // A speed of velset may make it longer.
        if took < wanted - 2.5 * CYCLE || (took > wanted + 2.5 * CYCLE && leg.motion.speeds.tcp == f64::INFINITY) {
            faults.push(format!("line {}: it takes {took} s, {wanted} are programmed", leg.motion.line));
        }
    }
}
