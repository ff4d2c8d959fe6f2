//! The motion of the axes, computed from their positions from cycle to cycle.

use crate::motion::Joints;
use arl_robot::robot::{EXTERNAL_AXES, ROBOT_AXES};

/// The positions of the axes, in deg (mm), and their motion: differences of the last cycles, per s and s2, unless it is
/// measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moving {
    pub(crate) at: Joints,
    /// The positions of the cycle before.
    pub(crate) before: Joints,
    pub(crate) rates: [f64; ROBOT_AXES],
    pub(crate) external_rates: [f64; EXTERNAL_AXES],
    pub(crate) accelerations: [f64; ROBOT_AXES],
    rates_before: [f64; ROBOT_AXES],
    /// The length of the last cycle in s.
    pub(crate) period: f64,
}

impl Moving {
    /// Axes at rest.
    pub(super) fn resting(at: Joints) -> Self {
        Self {
            at,
            before: at,
            rates: [0.0; ROBOT_AXES],
            external_rates: [0.0; EXTERNAL_AXES],
            accelerations: [0.0; ROBOT_AXES],
            rates_before: [0.0; ROBOT_AXES],
            period: 1.0,
        }
    }

    /// Moves on by a cycle of `period` s.
    pub(super) fn go_to(&mut self, at: Joints, period: f64) {
        (self.before, self.rates_before) = (std::mem::replace(&mut self.at, at), self.rates);
        self.period = period;
        let axes = self.at.axes.iter().zip(&self.before.axes);
        let rates = self.rates.iter_mut().zip(&mut self.accelerations);
        for ((rate, acceleration), (at, before)) in rates.zip(axes) {
            let new = (at - before) / period;
            *acceleration = (new - *rate) / period;
            *rate = new;
        }
        let external = self.at.external.iter().zip(&self.before.external);
        for (rate, (at, before)) in self.external_rates.iter_mut().zip(external) {
            *rate = (at - before) / period;
        }
    }
    /// Takes the measured speeds of this cycle, in deg/s (mm/s): they are better than those computed from positions.
    pub(super) fn measured(&mut self, velocity: &Joints) {
        (self.rates, self.external_rates) = (velocity.axes, velocity.external);
        let rates = self.rates.iter().zip(&self.rates_before);
        for (acceleration, (rate, before)) in self.accelerations.iter_mut().zip(rates) {
            *acceleration = (rate - before) / self.period;
        }
    }
}
