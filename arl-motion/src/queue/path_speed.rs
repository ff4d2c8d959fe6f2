//! The speed along a path that may reverse.

use nalgebra::Vector3;

use crate::geometry::derivatives::{second_difference_along, third_difference_along};

/// Speed and acceleration along a path. Where the path reverses, the speed continues with the opposite sign, so that
/// its derivatives are those of the robot's motion, not those of an absolute value. Where the path all but reverses,
/// the components of acceleration and jerk along the path count, as they do for limits.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(super) struct PathSpeed {
    /// The last two displacements.
    steps: [Vector3<f64>; 2],
    vel: f64,
    acc: f64,
}

impl PathSpeed {
    /// The speed with its first two derivatives after one more displacement, within `period` s.
    pub(super) fn derivatives(&mut self, step: Vector3<f64>, period: f64) -> [f64; 3] {
        let expected = self.vel + self.acc * period;
        let on = (step.norm() / period).copysign(self.vel);
        // In a sharp corner the path turns, too, but the speed does not change sign.
        let [first, second] = self.steps;
        let turns_back = step.dot(&second) < 0.0 && (-on - expected).abs() < (on - expected).abs();
        let vel = if turns_back { -on } else { on };
        let acc = (vel - self.vel) / period;
        let jerk = (acc - self.acc) / period;
        let along = [
            second_difference_along([&second, &step]) / (period * period),
            third_difference_along([&first, &second, &step]) / (period * period * period),
        ];
        *self = Self { steps: [second, step], vel, acc };
        [vel, nearer_to_zero(along[0], acc), nearer_to_zero(along[1], jerk)]
    }
}

/// The value nearer to zero; `other` where `one` is not a number.
fn nearer_to_zero(one: f64, other: f64) -> f64 {
    if one.abs() < other.abs() { one } else { other }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The highest acceleration and jerk along a path, after the first steps.
    fn most(displacements: impl Iterator<Item = Vector3<f64>>, period: f64) -> [f64; 2] {
        let displacements: Vec<Vector3<f64>> = displacements.collect();
        let mut speed = PathSpeed::default();
        let rates = displacements.windows(2).map(|pair| speed.derivatives(pair[1] - pair[0], period)).skip(3);
        rates.fold([0.0; 2], |[acc, jerk], rates| [acc.max(rates[1].abs()), jerk.max(rates[2].abs())])
    }

    #[test]
    fn a_return_motion_has_the_derivatives_of_the_robot() {
        let period = 0.001;
        let swing = (0..2000).map(|cycle| Vector3::new(100.0 * (f64::from(cycle) * period * 5.0).sin(), 0.0, 0.0));
        let [acc, jerk] = most(swing, period);
        assert!((acc - 2500.0).abs() < 5.0 && (jerk - 12_500.0).abs() < 50.0, "{acc} {jerk}");
    }

    #[test]
    fn a_path_that_brakes_into_a_hairpin_has_the_acceleration_along_it() {
        let period = 0.001;
        // It brakes to 4 mm/s at 8000 mm/s2, turns by 120 deg from one cycle to the next, and speeds up from 5.6 mm/s
        // in the same manner.
        let braking = (0..25).rev().map(|cycle| (4.0 + 8.0 * f64::from(cycle), 0.0_f64));
        let going_off = (0..25).map(|cycle| (5.6 + 8.0 * f64::from(cycle), 120.0_f64.to_radians()));
        let mut place = Vector3::zeros();
        let hairpin = braking.chain(going_off).map(|(speed, towards)| {
            place += speed * period * Vector3::new(towards.cos(), towards.sin(), 0.0);
            place
        });
        let [acc, _] = most(hairpin, period);
        assert!((acc - 8000.0).abs() < 1.0, "{acc}");
    }

    #[test]
    fn a_path_that_all_but_turns_back_has_no_jerk_to_speak_of() {
        let period = 0.001;
        let swing = (0..2000).map(|cycle| {
            let angle = f64::from(cycle) * period * 5.0;
            Vector3::new(100.0 * angle.sin(), 0.3 * angle.cos(), 0.0)
        });
        let [_, jerk] = most(swing, period);
        assert!(jerk < 12_600.0, "{jerk}");
    }

    #[test]
    fn a_sharp_corner_keeps_its_speed() {
        let period = 0.001;
        let corner = (0..200).map(|cycle| {
            let along = f64::from(cycle) * 0.1;
            if cycle < 100 {
                Vector3::new(along, 0.0, 0.0)
            } else {
                Vector3::new(19.8 - along, 0.01 * along - 0.099, 0.0)
            }
        });
        let [acc, _] = most(corner, period);
        assert!(acc < 10.0, "{acc}");
    }
}
