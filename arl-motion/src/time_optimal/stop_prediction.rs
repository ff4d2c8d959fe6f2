//! Predicts what the governor will do at a stop, so that a shorter stop can be sought in parallel with the cycle.

use crate::follow::governor::{Governor, Pacing};
use crate::follow::timing::Timing;
use crate::limits::profile::{Change, State};
use crate::time_optimal::solver::BoundaryState;

/// A stop that takes more cycles than this is not considered.
const MOST_PREDICTED_CYCLES: u32 = 20_000;

/// The governor with a copy of everything it knows.
#[derive(Clone, Debug)]
pub(crate) struct StopPrediction {
    timing: Timing,
    state: State,
    backup: Change,
    cycle: f64,
    stop_scale: f64,
}

impl StopPrediction {
    /// Predicts a stop with acceleration and jerk times `stop_scale`, which begins in this state.
    pub(crate) fn new(timing: Timing, state: State, backup: Change, cycle: f64, stop_scale: f64) -> Self {
        Self { timing, state, backup, cycle, stop_scale }
    }

    /// The factor on acceleration and jerk.
    pub(crate) fn stop_scale(&self) -> f64 {
        self.stop_scale
    }

    /// The motion of the robot, in s of nominal time.
    pub(crate) fn edge(&self) -> BoundaryState {
        BoundaryState { vel: self.state.vel, acc: self.state.acc }
    }

    /// Brakes for `cycles` cycles; returns the distance covered, in s of nominal time. `None` where the robot is at
    /// rest by then.
    pub(crate) fn brake(&mut self, cycles: u32) -> Option<f64> {
        let mut distance = 0.0;
        for _ in 0..cycles {
            distance += self.step();
            if self.state.rests() {
                return None;
            }
        }
        Some(distance)
    }

    /// The remaining distance to rest, in s of nominal time, and the s that it takes. `None` where the result is no
    /// longer `wanted`.
    pub(crate) fn rest(mut self, wanted: impl Fn() -> bool) -> Option<[f64; 2]> {
        let mut distance = 0.0;
        for cycles in 1..MOST_PREDICTED_CYCLES {
            distance += self.step();
            if self.state.rests() {
                return Some([distance, f64::from(cycles) * self.cycle]);
            }
            if !wanted() {
                return None;
            }
        }
        None
    }

    /// Advances by a cycle; returns the distance covered.
    fn step(&mut self) -> f64 {
        let governor = Governor { stretches: &self.timing.stretches, cycle: self.cycle };
        let next = governor.next(&self.state, &mut self.backup, Pacing::Stop(self.stop_scale));
        let distance = next.at - self.state.at;
        self.state = next;
        self.timing.pass(&mut self.state);
        distance
    }
}
