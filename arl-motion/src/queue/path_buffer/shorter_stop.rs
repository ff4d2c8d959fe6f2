//! Shorter stops where the governor leads.
//!
//! The governor knows one acceleration and one jerk for each part of the path: those of its hardest place at full
//! speed. Where the robot is slower, or elsewhere on that part, it could brake harder. So when it brakes, the shortest
//! stop is sought in parallel with the cycle, with the limits of each place, from the state that the governor's stop
//! leads to meanwhile. If the stop found is much shorter, a follower takes over and brings the robot to rest; from
//! there the governor continues as before.

use crate::command::joints::Joints;
use crate::follow::governor::Pacing;
use crate::limits::profile::{Change, Limits, State};
use crate::queue::path_buffer::law_hand_over::Purpose;
use crate::queue::path_buffer::leader::Leader;
use crate::queue::path_buffer::{ACCELERATION_RISE_CYCLES, PathBuffer};
use crate::time_optimal::law_follower::LawFollower;
use crate::time_optimal::law_solver_thread::{Found, LawRequest, Status};
use crate::time_optimal::stop_prediction::StopPrediction;
use arl_robot::robot::Robot;
use std::sync::Arc;

/// Allowed differences from the predicted state, due to rounding: s of nominal time, shares of full speed, and such
/// shares per s.
const STATE_TOLERANCES: [f64; 3] = [1e-9, 1e-9, 1e-6];

impl PathBuffer {
    /// Requests a shorter stop while the governor leads, and takes it over once it is found.
    pub(crate) fn shorten_stop(&mut self, robot: &Arc<Robot>, here: &Joints, cycle: f64, pacing: Pacing) {
        if self.laws.leader.follower().is_some() {
            return;
        }
        let stop_scale = if let Pacing::Stop(stop_scale) = pacing { stop_scale } else { 0.0 };
        if stop_scale == 0.0 || self.state.rests() {
            self.drop_stop_request();
            return;
        }
        if self.laws.stop_asked.is_none_or(|asked| asked < stop_scale) {
            self.drop_stop_request();
            self.laws.stop_asked = Some(stop_scale);
            if !self.stops_within_even_segment(stop_scale) {
                self.request_stop_law(robot, here, cycle, stop_scale);
            }
        } else if let Some(found) = self.take_stop_law()
            && matches!(self.laws.leader, Leader::Governor)
        {
            self.laws.leader = Leader::ShorterStop(Box::new(LawFollower::resting(found, stop_scale)));
        }
    }

    /// Returns the lead to the governor, or to none.
    pub(crate) fn return_to_governor(&mut self) {
        if matches!(std::mem::take(&mut self.laws.leader), Leader::ShorterStop(_)) {
            self.backup = Change::default();
        }
        self.laws.stop_asked = None;
    }

    /// Whether the governor's stop stays on a segment that has the same limits everywhere: no stop is shorter.
    fn stops_within_even_segment(&self, stop_scale: f64) -> bool {
        let State { vel, acc, .. } = self.state;
        self.segments.front().filter(|segment| segment.is_even()).is_some_and(|segment| {
            let Limits { acc: most, jerk, .. } = segment.limits;
            let limits = Limits { vel, acc: most * stop_scale, jerk: jerk * stop_scale };
            self.at + Change::new(vel, acc, 0.0, &limits).distance(vel, acc) < segment.time
        })
    }

    fn request_stop_law(&mut self, robot: &Arc<Robot>, here: &Joints, cycle: f64, stop_scale: f64) {
        self.cancel();
        let at = self.segments.passed() + self.at;
        let sampler = self.sampler_up_to(robot, at, here, f64::INFINITY, usize::MAX, f64::INFINITY);
        self.find_entries();
        let prediction = StopPrediction::new(self.timing.clone(), self.state, self.backup, cycle, stop_scale);
        let cycles = 2 * self.search_cycles(cycle);
        let request = LawRequest::ShorterStop(Box::new(prediction), cycles);
        self.search_for(request, sampler.for_stop(ACCELERATION_RISE_CYCLES * cycle), cycles, Purpose::ShorterStop);
    }

    fn drop_stop_request(&mut self) {
        self.laws.stop_asked = None;
        if self.laws.seeks(is_for_stop) {
            self.cancel();
        }
    }

    /// Takes the stop that was requested, when it is due, if the robot is where it begins.
    fn take_stop_law(&mut self) -> Option<Found> {
        let pending = self.laws.pending.as_mut().filter(|pending| is_for_stop(&pending.purpose))?;
        let found = match self.laws.solver.look(&mut pending.search) {
            Status::Running => return None,
            Status::Done(found) => found,
            Status::Late => {
                self.laws.solver.note_late(&mut pending.search);
                pending.search.cancel();
                None
            }
        };
        self.laws.pending = None;
        let found = found?;
        let start = found.law.at(0.0);
        let State { vel, acc, .. } = self.state;
        let off = [start.at - self.segments.passed() - self.at, start.vel - vel, start.acc - acc];
        off.iter().zip(STATE_TOLERANCES).all(|(off, most)| off.abs() <= most).then_some(found)
    }
}

fn is_for_stop(purpose: &Purpose) -> bool {
    matches!(purpose, Purpose::ShorterStop)
}
