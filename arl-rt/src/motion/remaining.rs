//! How long the robot still takes to the end of a motion at full speed: what the governor will do, foreseen piece by piece.
//!
//! It takes no acceleration over from one piece to the next, which the governor does where it can; so what is foreseen is a
//! little more than what it will take.

use super::profile::{Change, Limits};

/// A stretch of the way ahead with constant limits, in s of nominal time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leg {
    pub(super) length: f64,
    pub(super) limits: Limits,
    /// Whether the robot stands still at its end.
    pub(super) stops: bool,
}

/// So many legs are looked at; behind them the robot would stop.
pub(super) const MOST: usize = 24;
/// Halvings of the interval in which a speed is looked for.
const HALVINGS: u32 = 30;

/// How long a robot takes over the first `count` legs, in s, that goes at the speed `vel` with the acceleration `acc` where
/// they begin.
pub(super) fn time_over(legs: &[Leg], count: usize, mut vel: f64, mut acc: f64) -> f64 {
    let mut entries = [0.0; MOST + 1];
    let legs = legs.get(..MOST.min(legs.len())).unwrap_or_default();
    for (index, leg) in legs.iter().enumerate().rev() {
        let behind = entries.get(index + 1).copied().unwrap_or(0.0);
        if let Some(entry) = entries.get_mut(index) {
            *entry = leg.entry(if leg.stops { 0.0 } else { behind });
        }
    }
    let mut time = 0.0;
    for (leg, behind) in legs.iter().zip(entries.iter().skip(1)).take(count) {
        let (taken, exit) = leg.pass(vel, acc, if leg.stops { 0.0 } else { *behind });
        time += taken;
        (vel, acc) = (exit, 0.0);
    }
    time
}

impl Leg {
    /// The highest speed at its start from which it can be left at `exit`.
    fn entry(&self, exit: f64) -> f64 {
        let most = self.limits.vel;
        let fits = |vel: f64| Change::new(vel, 0.0, exit, &self.limits).distance(vel, 0.0) <= self.length;
        if exit >= most || fits(most) { most } else { highest(exit, most, fits) }
    }

    /// How long it takes, and the speed at its end, which is at most `exit`.
    fn pass(&self, vel: f64, acc: f64, exit: f64) -> (f64, f64) {
        let limits = &self.limits;
        let changes = |peak: f64| {
            let (up, down) = (Change::new(vel, acc, peak, limits), Change::new(peak, 0.0, exit.min(peak), limits));
            let way = up.distance(vel, acc) + down.distance(peak, 0.0);
            (way, up.duration() + down.duration())
        };
        let fits = |peak: f64| changes(peak).0 <= self.length;
        let least = exit.min(vel);
        let peak = if fits(limits.vel) { limits.vel } else { highest(least, limits.vel, fits) };
        let (way, time) = changes(peak);
        let even = if peak > 0.0 { (self.length - way).max(0.0) / peak } else { 0.0 };
        (time + even, exit.min(peak))
    }
}

/// The highest value between two that fits; the lower one where none does.
fn highest(mut low: f64, mut high: f64, fits: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if fits(middle) { low = middle } else { high = middle }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn from_rest_to_rest_it_is_the_profile() {
        let limits = Limits { vel: 1.0, acc: 4.0, jerk: 40.0 };
        for length in [0.01, 0.3, 1.35, 10.0] {
            let time = time_over(&[Leg { length, limits, stops: true }], 1, 0.0, 0.0);
            assert!((time - limits.duration(length)).abs() < 1e-6, "{time}");
        }
    }

    #[test]
    fn a_slow_leg_behind_makes_the_one_before_brake() {
        let (quick, slow) = (Limits { vel: 1.0, acc: 4.0, jerk: 40.0 }, Limits { vel: 0.5, acc: 4.0, jerk: 40.0 });
        let legs = [
            Leg { length: 2.0, limits: quick, stops: false },
            Leg { length: 1.0, limits: slow, stops: false },
            Leg { length: 1.0, limits: slow, stops: true },
        ];
        // Braking from 1 to 0.5: 0.225 s at 0.75 on the average.
        let braking = Change::new(1.0, 0.0, 0.5, &quick).duration();
        assert!((time_over(&legs, 1, 1.0, 0.0) - (2.0 - 0.75 * braking + braking)).abs() < 1e-6);
        assert!((time_over(&legs, 2, 1.0, 0.0) - time_over(&legs, 1, 1.0, 0.0) - 2.0).abs() < 1e-6);
    }
}
