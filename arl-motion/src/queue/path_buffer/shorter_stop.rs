//! Shorter stops in the profiles S and T.
//!
//! The governor knows one acceleration and one jerk for each part of the way: those of its hardest place at full speed. Where the
//! robot is slower, or elsewhere on that part, it could brake harder. So when it stops, the shortest way to rest is looked
//! for beside the cycle, with the limits of each place, from the state that the governor's stop leads to meanwhile. If that is
//! much shorter, a pilot takes over and leads to rest; from there the governor goes on as before.

use crate::command::joints::Joints;
use crate::follow::governor::Pacing;
use crate::limits::profile::{Change, Limits, State};
use crate::queue::path_buffer::law_hand_over::{Purpose, Sought};
use crate::queue::path_buffer::{Course, RISE};
use crate::time_optimal::constraint_sampler::Scout;
use crate::time_optimal::law_follower::Pilot;
use crate::time_optimal::law_solver_thread::{Finder, Found, Quest};
use crate::time_optimal::stop_prediction::Foresight;
use arl_robot::robot::Robot;
use std::sync::Arc;

/// How far the state may be from what was foreseen, as rounding leaves it: s of nominal time, full speeds, and these per s.
const FORESEEN: [f64; 3] = [1e-9, 1e-9, 1e-6];

impl Course {
    /// Sees to a shorter stop while the governor leads.
    pub(crate) fn stop_sooner(&mut self, robot: &Arc<Robot>, here: &Joints, cycle: f64, pacing: Pacing) {
        if self.pilot.is_some() {
            return;
        }
        let harder = if let Pacing::Stop(harder) = pacing { harder } else { 0.0 };
        if harder == 0.0 || self.state.rests() {
            self.ask_no_more();
            return;
        }
        if self.asked.is_none_or(|asked| asked < harder) {
            self.ask_no_more();
            self.asked = Some(harder);
            if !self.stops_on_even_way(harder) {
                self.ask_for_stop(robot, here, cycle, harder);
            }
        } else if let Some(found) = self.take_stop() {
            self.pilot = Some(Box::new(Pilot::resting(found, harder)));
            self.relieved = true;
        }
    }

    /// The governor leads again, or nobody does.
    pub(crate) fn hand_back(&mut self) {
        if std::mem::take(&mut self.relieved) {
            self.backup = Change::default();
        }
        self.asked = None;
    }

    /// Whether the governor's stop stays on a piece that has the same limits everywhere: none is shorter.
    fn stops_on_even_way(&self, harder: f64) -> bool {
        let State { vel, acc, .. } = self.state;
        self.pieces.front().filter(|piece| piece.is_even()).is_some_and(|piece| {
            let Limits { acc: most, jerk, .. } = piece.limits;
            let limits = Limits { vel, acc: most * harder, jerk: jerk * harder };
            self.at + Change::new(vel, acc, 0.0, &limits).distance(vel, acc) < piece.time
        })
    }

    fn ask_for_stop(&mut self, robot: &Arc<Robot>, here: &Joints, cycle: f64, harder: f64) {
        self.forsake();
        let at = self.passed + self.at;
        let pieces = (self.pieces.iter(), self.passed);
        let scout = Scout::new(robot, pieces, (at, here), f64::INFINITY, (usize::MAX, f64::INFINITY));
        let foresight = Foresight::new(self.timing.clone(), self.state, self.backup, cycle, harder);
        let cycles = 2 * Finder::cycles(cycle);
        let quest = Quest::Sooner(Box::new(foresight), cycles);
        self.search_for(quest, scout.for_stop(RISE * cycle), cycles, Purpose::Sooner);
    }

    fn ask_no_more(&mut self) {
        self.asked = None;
        if self.sought.as_ref().is_some_and(is_for_stop) {
            self.forsake();
        }
    }

    /// The stop that was looked for, when it is time, if the robot is where it begins.
    fn take_stop(&mut self) -> Option<Found> {
        let found = self.sought.as_mut().filter(|sought| is_for_stop(sought))?.search.next()?;
        self.sought = None;
        let found = found?;
        let start = found.law.at(0.0);
        let State { vel, acc, .. } = self.state;
        let off = [start.at - self.passed - self.at, start.vel - vel, start.acc - acc];
        off.iter().zip(FORESEEN).all(|(off, most)| off.abs() <= most).then_some(found)
    }
}

fn is_for_stop(sought: &Sought) -> bool {
    matches!(sought.purpose, Purpose::Sooner)
}
