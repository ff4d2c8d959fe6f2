//! How long the robot still takes to the end of a motion at full speed: a prediction of what the governor will do,
//! segment by segment.
//!
//! The prediction carries no acceleration over from one segment to the next, which the governor does where it can; so
//! the predicted time is a little longer than the actual one.

use crate::limits::profile::{Change, Limits};
use crate::limits::search::{self, Enough};

/// A stretch of the path ahead with constant limits, in s of nominal time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leg {
    pub(crate) length: f64,
    pub(crate) limits: Limits,
}

/// Maximum number of legs that are examined.
pub(crate) const MOST_LEGS: usize = 24;
/// Relative tolerance of a speed, and tolerance of a distance, in s of nominal time.
const SPEED_TOLERANCE: f64 = 1e-9;
const DISTANCE_TOLERANCE_S: f64 = 1e-10;

/// How long a robot that starts with the speed `vel` and the acceleration `acc` takes over the legs, in s, where it
/// ends with at most the speed `exit`.
pub(crate) fn time_over(legs: &[Leg], exit: f64, mut vel: f64, mut acc: f64) -> f64 {
    let mut exits = [exit; MOST_LEGS];
    let legs = legs.get(..MOST_LEGS.min(legs.len())).unwrap_or_default();
    let mut behind = exit;
    for (leg, exit) in legs.iter().zip(&mut exits).rev() {
        *exit = behind;
        behind = leg.entry(behind);
    }
    let mut time = 0.0;
    for (leg, exit) in legs.iter().zip(&exits) {
        let (taken, exit) = leg.pass(vel, acc, *exit);
        time += taken;
        (vel, acc) = (exit, 0.0);
    }
    time
}

impl Leg {
    /// The highest speed at its start from which it can be left at `exit`.
    fn entry(&self, exit: f64) -> f64 {
        let most = self.limits.vel;
        let excess = |vel: f64| self.limits.slowing(vel, exit) - self.length;
        if exit >= most || excess(most) <= 0.0 { most } else { highest(exit, most, excess) }
    }

    /// How long it takes, and the speed at its end, which is at most `exit`.
    fn pass(&self, vel: f64, acc: f64, exit: f64) -> (f64, f64) {
        let limits = &self.limits;
        let changes = |peak: f64| {
            let (up, down) = (Change::new(vel, acc, peak, limits), Change::new(peak, 0.0, exit.min(peak), limits));
            let distance = up.distance(vel, acc) + down.distance(peak, 0.0);
            (distance, up.duration() + down.duration())
        };
        let excess = |peak: f64| changes(peak).0 - self.length;
        let least = exit.min(vel);
        let peak = if excess(limits.vel) <= 0.0 { limits.vel } else { highest(least, limits.vel, excess) };
        let (distance, time) = changes(peak);
        let even = if peak > 0.0 { (self.length - distance).max(0.0) / peak } else { 0.0 };
        (time + even, exit.min(peak))
    }
}

/// The highest of a range of speeds whose path is not too long.
fn highest(low: f64, high: f64, excess: impl Fn(f64) -> f64) -> f64 {
    search::highest(low, high, Enough { value: SPEED_TOLERANCE * high, excess: DISTANCE_TOLERANCE_S }, excess)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn from_rest_to_rest_it_is_the_profile() {
        let limits = Limits { vel: 1.0, acc: 4.0, jerk: 40.0 };
        for length in [0.01, 0.3, 1.35, 10.0] {
            let time = time_over(&[Leg { length, limits }], 0.0, 0.0, 0.0);
            assert!((time - limits.duration(length)).abs() < 1e-6, "{time}");
        }
    }

    #[test]
    fn a_slow_leg_behind_makes_the_one_before_brake() {
        let (quick, slow) = (Limits { vel: 1.0, acc: 4.0, jerk: 40.0 }, Limits { vel: 0.5, acc: 4.0, jerk: 40.0 });
        let legs = [Leg { length: 2.0, limits: quick }, Leg { length: 1.0, limits: slow }];
        // Braking from 1 to 0.5: 0.225 s at 0.75 on average.
        let braking = Change::new(1.0, 0.0, 0.5, &quick).duration();
        let first = time_over(&legs[..1], 0.5, 1.0, 0.0);
        assert!((first - (2.0 - 0.75 * braking + braking)).abs() < 1e-6);
        assert!((time_over(&legs, 0.5, 1.0, 0.0) - first - 2.0).abs() < 1e-6);
    }
}
