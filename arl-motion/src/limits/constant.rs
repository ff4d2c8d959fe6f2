//! Constant limits of the path parameter that keep everything that moves with it within its own limits.

use crate::limits::profile::Limits;

/// One quantity at one place of the path: its derivatives by the path parameter, and its limits in time.
///
/// A parameter that moves with speed v, acceleration a and jerk j moves the quantity with speed `first` v, acceleration
/// `first` a + `second` v2, and jerk `first` j + 3 `second` v a + `third` v3. Functions for constant limits of the
/// parameter use the magnitudes of the derivatives.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Constraint {
    pub(crate) first: f64,
    pub(crate) second: f64,
    pub(crate) third: f64,
    pub(crate) vel: f64,
    pub(crate) acc: f64,
    pub(crate) jerk: f64,
}

impl Constraint {
    /// A quantity that changes evenly, by `by` in total.
    pub(crate) fn even(by: f64, vel: f64, acc: f64, jerk: f64) -> Self {
        Self { first: by.abs(), second: 0.0, third: 0.0, vel, acc, jerk }
    }

    /// The constraint with the magnitudes of the derivatives.
    pub(crate) fn size(self) -> Self {
        Self { first: self.first.abs(), second: self.second.abs(), third: self.third.abs(), ..self }
    }
}

/// Shares of the highest speed, and then of the highest acceleration, among which the quickest limits are sought. At
/// the full share of either, nothing may be left for the rest; at the other shares something always is.
const SPEED_SHARES: [f64; 9] = [1.0, 0.95, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3];
const ACC_SHARES: [f64; 5] = [1.0, 0.9, 0.75, 0.6, 0.4];

/// The highest speed that keeps all bounds without acceleration.
pub(crate) fn highest_speed(constraints: &[Constraint]) -> f64 {
    lowest(constraints.iter().flat_map(|constraint| {
        [
            constraint.vel / constraint.first,
            (constraint.acc / constraint.second).sqrt(),
            libm::cbrt(constraint.jerk / constraint.third),
        ]
    }))
}

/// Limits under which the path from 0 to 1 is completed soon, and within which every motion keeps all bounds.
pub(crate) fn quickest(constraints: &[Constraint]) -> Limits {
    let vel = highest_speed(constraints);
    if let Some(limits) = hardly_curved(constraints, vel) {
        return limits;
    }
    let curved = constraints.iter().any(|constraint| constraint.second > 0.0 || constraint.third > 0.0);
    let (speeds, accs) = if curved { (&SPEED_SHARES[..], &ACC_SHARES[..]) } else { (&[1.0][..], &[1.0][..]) };
    let mut best: Option<(f64, Limits)> = None;
    for share in speeds {
        let vel = vel * share;
        let most = lowest(constraints.iter().flat_map(|constraint| {
            let by_acc = (constraint.acc - constraint.second * vel * vel) / constraint.first;
            [by_acc, (constraint.jerk - constraint.third * vel * vel * vel) / (3.0 * constraint.second * vel)]
        }));
        for share in accs {
            let acc = most * share;
            let jerk = lowest(constraints.iter().map(|constraint| {
                (constraint.jerk - 3.0 * constraint.second * vel * acc - constraint.third * vel * vel * vel)
                    / constraint.first
            }));
            let limits = Limits { vel, acc, jerk };
            if acc > 0.0 && jerk > 0.0 {
                let duration = limits.duration(1.0);
                if best.is_none_or(|(least, _)| duration < least) {
                    best = Some((duration, limits));
                }
            }
        }
    }
    best.map_or(Limits { vel: 1.0, acc: 1.0, jerk: 1.0 }, |(_, limits)| limits)
}

/// Share of the acceleration and of the jerk available at rest that is as good as all of it.
const AS_GOOD_SHARE: f64 = 0.98;

/// The limits of a path that loses hardly anything to its curvature at the speed `vel`.
fn hardly_curved(constraints: &[Constraint], vel: f64) -> Option<Limits> {
    let mut rest = Limits { vel, acc: 1e12, jerk: 1e12 };
    let mut moving = rest;
    for constraint in constraints.iter().filter(|constraint| constraint.first > 0.0) {
        let curve = constraint.second * vel;
        rest.acc = rest.acc.min(constraint.acc / constraint.first);
        moving.acc = moving.acc.min((constraint.acc - curve * vel) / constraint.first);
    }
    for constraint in constraints.iter().filter(|constraint| constraint.first > 0.0) {
        let (curve, twist) = (constraint.second * vel, constraint.third * vel * vel * vel);
        rest.jerk = rest.jerk.min(constraint.jerk / constraint.first);
        moving.jerk = moving.jerk.min((constraint.jerk - 3.0 * curve * moving.acc - twist) / constraint.first);
    }
    // What does not move at first may still be curved.
    let still = constraints.iter().filter(|constraint| constraint.first <= 0.0);
    let met = |constraint: &Constraint| {
        let (curve, twist) = (constraint.second * vel, constraint.third * vel * vel * vel);
        curve * vel <= constraint.acc && 3.0 * curve * moving.acc + twist <= constraint.jerk
    };
    let good =
        moving.acc >= AS_GOOD_SHARE * rest.acc && moving.jerk >= AS_GOOD_SHARE * rest.jerk && still.clone().all(met);
    good.then_some(moving)
}

/// Shares of the highest speed, fastest first; the first one that leaves enough to stop with is used.
const PASSING_SHARES: [f64; 8] = [1.0, 0.98, 0.96, 0.94, 0.92, 0.88, 0.8, 0.6];
/// Shares of the acceleration that is left at that speed; the one that reaches the speed soonest is used.
const PASSING_ACC_SHARES: [f64; 9] = [0.95, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1];
/// Least share of the acceleration and of the jerk available at rest that must be left at speed.
const LEAST_REMAINING_SHARE: f64 = 0.08;

/// Limits for passing through without stopping, no faster than `fastest`, that keep all bounds.
pub(crate) fn passing(constraints: &[Constraint], fastest: f64) -> Limits {
    let vel = highest_speed(constraints);
    let acc_at = |vel: f64| {
        lowest(constraints.iter().map(|constraint| (constraint.acc - constraint.second * vel * vel) / constraint.first))
    };
    let jerk_at = |vel: f64, acc: f64| {
        lowest(constraints.iter().map(|constraint| {
            (constraint.jerk - 3.0 * constraint.second * vel * acc - constraint.third * vel * vel * vel)
                / constraint.first
        }))
    };
    let (acc_at_rest, jerk_at_rest) = (acc_at(0.0), jerk_at(0.0, 0.0));
    // At half the speed, some of both is left in any case, with no more acceleration than the jerk permits.
    let half = (vel * 0.5).min(fastest);
    let by_jerk = |constraint: &Constraint| {
        (constraint.jerk - constraint.third * half * half * half) / (3.0 * constraint.second * half)
    };
    let acc = 0.5 * lowest(constraints.iter().map(by_jerk)).min(acc_at(half));
    let mut found = Limits { vel: half, acc, jerk: jerk_at(half, acc) };
    for share in PASSING_SHARES {
        let vel = (vel * share).min(fastest);
        // What the acceleration takes of the jerk is shared between the two.
        let most = acc_at(vel);
        let mut soonest = f64::INFINITY;
        for acc_share in PASSING_ACC_SHARES {
            let acc = most * acc_share;
            let jerk = jerk_at(vel, acc);
            let time = vel / acc + acc / jerk;
            if acc > 0.0 && jerk > 0.0 && time < soonest {
                (soonest, found) = (time, Limits { vel, acc, jerk });
            }
        }
        if found.vel == vel
            && found.acc >= LEAST_REMAINING_SHARE * acc_at_rest
            && found.jerk >= LEAST_REMAINING_SHARE * jerk_at_rest
        {
            return found;
        }
    }
    found
}

/// The lowest of the finite values; a very high value where there is none.
fn lowest(values: impl Iterator<Item = f64>) -> f64 {
    values.filter(|value| value.is_finite()).fold(1e12, f64::min)
}

#[cfg(test)]
impl Constraint {
    /// A random constraint, over orders of magnitude.
    pub(crate) fn random(random: &mut arl_robot::kinematics::random::Random) -> Self {
        let mut some = |low: f64, high: f64| 10.0_f64.powf(random.between(low, high));
        Self {
            first: some(-2.0, 2.0),
            second: some(-3.0, 3.0),
            third: some(-3.0, 4.0),
            vel: some(0.0, 2.0),
            acc: some(1.0, 3.0),
            jerk: some(2.0, 4.0),
        }
    }

    /// Asserts that every motion within the limits keeps the constraint.
    pub(crate) fn assert_kept(&self, Limits { vel, acc, jerk }: Limits) {
        assert!(self.first * vel <= self.vel * 1.000_001);
        assert!(self.first * acc + self.second * vel * vel <= self.acc * 1.000_001);
        let third = self.third * vel.powi(3) + 3.0 * self.second * vel * acc + self.first * jerk;
        assert!(third <= self.jerk * 1.000_001, "{self:?} {third}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_robot::kinematics::random::Random;

    #[test]
    fn no_bound_is_broken_by_any_motion_within_the_limits() {
        let mut random = Random::new(21);
        for _ in 0..2000 {
            let constraints: Vec<Constraint> = (0..20).map(|_| Constraint::random(&mut random)).collect();
            let limits = quickest(&constraints);
            assert!(limits.vel > 0.0 && limits.acc > 0.0 && limits.jerk > 0.0);
            for constraint in &constraints {
                constraint.assert_kept(limits);
            }
        }
    }

    #[test]
    fn no_bound_is_broken_by_whatever_passes() {
        let mut random = Random::new(22);
        for round in 0..3000 {
            let constraints: Vec<Constraint> = (0..1 + round % 20).map(|_| Constraint::random(&mut random)).collect();
            let fastest = highest_speed(&constraints) * 10.0_f64.powf(random.between(-1.0, 1.0));
            let limits = passing(&constraints, fastest);
            assert!(limits.vel > 0.0 && limits.acc > 0.0 && limits.jerk > 0.0 && limits.vel <= fastest);
            for constraint in &constraints {
                constraint.assert_kept(limits);
            }
        }
    }

    #[test]
    fn even_motion_takes_its_limits_whole() {
        let limits =
            quickest(&[Constraint::even(-90.0, 180.0, 900.0, 9000.0), Constraint::even(10.0, 100.0, 1000.0, 1e4)]);
        assert_eq!(limits, Limits { vel: 2.0, acc: 10.0, jerk: 100.0 });
    }
}
