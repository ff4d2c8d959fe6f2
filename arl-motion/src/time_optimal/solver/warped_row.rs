//! The limits at a place, over the warped parameter.

use crate::time_optimal::solver::constrained_path::Row;
use crate::time_optimal::solver::warp::WarpedPoint;

/// A row of a place over the warped parameter, divided by its limits.
#[derive(Clone, Copy, Default, Debug)]
pub(crate) struct WarpedRow {
    /// Factor of x in the velocity limit.
    pub(crate) vel: f64,
    /// Factors of the acceleration and of x.
    pub(crate) acc: [f64; 2],
    /// Factors of the bend, of the acceleration and of x.
    pub(crate) jerk: [f64; 3],
}

impl WarpedRow {
    pub(crate) fn new(row: &Row, place: WarpedPoint) -> Self {
        let slope = place.first;
        let first = row.first * slope;
        let second = row.second * slope * slope + row.first * place.second;
        let third =
            row.third * slope * slope * slope + 3.0 * row.second * slope * place.second + row.first * place.third;
        // An infinite limit results in zeros.
        Self {
            vel: (first / row.vel) * (first / row.vel),
            acc: [first / row.acc, second / row.acc],
            jerk: [first / row.jerk, 3.0 * second / row.jerk, third / row.jerk],
        }
    }

    /// Scales the row to squares of the speed in units of `unit`, with limits stricter by two factors: one for the
    /// square of the speed, and one for acceleration and jerk.
    pub(crate) fn scale(&mut self, unit: f64, [speed, reserve]: [f64; 2]) {
        let turn = unit * unit.sqrt() * reserve;
        self.vel *= unit * speed;
        self.acc.iter_mut().for_each(|value| *value *= unit * reserve);
        self.jerk.iter_mut().for_each(|value| *value *= turn);
    }

    /// Multiplies the used shares of the limits: that of the square of the speed by `speed`, the others by `factor`.
    pub(crate) fn ease(&mut self, speed: f64, factor: f64) {
        self.vel *= speed;
        self.acc.iter_mut().chain(&mut self.jerk).for_each(|value| *value *= factor);
    }
}
