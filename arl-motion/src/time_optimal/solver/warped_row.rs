//! What limits say at a place, over the warped parameter.

use crate::time_optimal::solver::warp::WarpedPoint;
use crate::time_optimal::solver::way::Row;

/// The rows of a place over the warped parameter, divided by their limits.
#[derive(Clone, Copy, Default, Debug)]
pub(crate) struct WarpedRow {
    /// Of x by velocity.
    pub(crate) vel: f64,
    /// Of the acceleration and x.
    pub(crate) acc: [f64; 2],
    /// Of the bend, the acceleration and x.
    pub(crate) jerk: [f64; 3],
}

impl WarpedRow {
    pub(crate) fn new(row: &Row, place: WarpedPoint) -> Self {
        let slope = place.first;
        let first = row.first * slope;
        let second = row.second * slope * slope + row.first * place.second;
        let third =
            row.third * slope * slope * slope + 3.0 * row.second * slope * place.second + row.first * place.third;
        // An infinite limit leaves zeros.
        Self {
            vel: (first / row.vel) * (first / row.vel),
            acc: [first / row.acc, second / row.acc],
            jerk: [first / row.jerk, 3.0 * second / row.jerk, third / row.jerk],
        }
    }

    /// Over the squares of speed in units of `unit`, with limits that are so many times as strict: on the square of the
    /// speed, and on acceleration and jerk.
    pub(crate) fn scale(&mut self, unit: f64, [speed, hold]: [f64; 2]) {
        let turn = unit * unit.sqrt() * hold;
        self.vel *= unit * speed;
        self.acc.iter_mut().for_each(|value| *value *= unit * hold);
        self.jerk.iter_mut().for_each(|value| *value *= turn);
    }

    /// With a share of what the limits are used: of that on the square of the speed, and of the others.
    pub(crate) fn ease(&mut self, speed: f64, factor: f64) {
        self.vel *= speed;
        self.acc.iter_mut().chain(&mut self.jerk).for_each(|value| *value *= factor);
    }
}
