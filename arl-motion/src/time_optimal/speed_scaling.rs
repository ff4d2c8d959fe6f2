//! Following a law at a changing share of its speed: smoothly, from a share that may be changing already.

use crate::time_optimal::solver::Moment;

/// A share of the speed that changes to another one: a polynomial of the fifth degree in time.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct SpeedScaling {
    factors: [f64; 6],
    duration: f64,
    to: f64,
}

impl SpeedScaling {
    /// From a share with its first two derivatives, per s and s2, to another one within `duration` s.
    pub(crate) fn new([share, rate, change]: [f64; 3], to: f64, duration: f64) -> Self {
        let time = duration;
        // What remains for the terms of higher degree: value, first and second derivative at the end.
        let value = to - share - time * (rate + time * change / 2.0);
        let first = -(rate + time * change) * time;
        let second = -change * time * time;
        let cube = time * time * time;
        let factors = [
            share,
            rate,
            change / 2.0,
            (10.0 * value - 4.0 * first + 0.5 * second) / cube,
            (-15.0 * value + 7.0 * first - second) / (cube * time),
            (6.0 * value - 3.0 * first + 0.5 * second) / (cube * time * time),
        ];
        Self { factors, duration, to }
    }

    pub(crate) fn duration(&self) -> f64 {
        self.duration
    }

    /// The share that it leads to.
    pub(crate) fn to(&self) -> f64 {
        self.to
    }

    /// The share and its first two derivatives after `time` s.
    pub(crate) fn at(&self, time: f64) -> [f64; 3] {
        if time >= self.duration {
            return [self.to, 0.0, 0.0];
        }
        let [a, b, c, d, e, f] = self.factors;
        let t = time;
        [
            a + t * (b + t * (c + t * (d + t * (e + t * f)))),
            b + t * (2.0 * c + t * (3.0 * d + t * (4.0 * e + t * 5.0 * f))),
            2.0 * c + t * (6.0 * d + t * (12.0 * e + t * 20.0 * f)),
        ]
    }

    /// How far the time on the law advances within `time` s.
    pub(crate) fn passed(&self, time: f64) -> f64 {
        let [a, b, c, d, e, f] = self.factors;
        let t = time.min(self.duration);
        let inside = t * (a + t * (b / 2.0 + t * (c / 3.0 + t * (d / 4.0 + t * (e / 5.0 + t * f / 6.0)))));
        inside + self.to * (time - t)
    }
}

/// A moment of a law, followed at a share of its speed with these derivatives.
pub(crate) fn followed(law: &Moment, [share, rate, change]: [f64; 3]) -> Moment {
    let Moment { at, vel, acc, jerk } = *law;
    Moment {
        at,
        vel: vel * share,
        acc: acc * share * share + vel * rate,
        jerk: jerk * share * share * share + 3.0 * acc * share * rate + vel * change,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_joins_both_ends_and_its_sum_is_the_time_that_passes() {
        let start = [0.8, -0.4, 3.0];
        let scaling = SpeedScaling::new(start, 0.25, 0.3);
        for (found, wanted) in scaling.at(0.0).iter().zip(start) {
            assert!((found - wanted).abs() < 1e-12);
        }
        // Just before its end it has reached its goal.
        for (found, wanted) in scaling.at(0.3 - 1e-9).iter().zip([0.25, 0.0, 0.0]) {
            assert!((found - wanted).abs() < 1e-5, "{found}");
        }
        let steps = 3000;
        let step = 0.4 / f64::from(steps);
        let sum: f64 = (0..steps).map(|index| scaling.at((f64::from(index) + 0.5) * step)[0] * step).sum();
        assert!((sum - scaling.passed(0.4)).abs() < 1e-6);
    }

    #[test]
    fn derivatives_of_what_is_followed_are_those_of_its_positions() {
        // A law with constant jerk.
        let law = |t: f64| Moment { at: t * t * t, vel: 3.0 * t * t, acc: 6.0 * t, jerk: 6.0 };
        let scaling = SpeedScaling::new([1.0, 0.0, 0.0], 0.4, 0.5);
        let at = |time: f64| followed(&law(1.0 + scaling.passed(time)), scaling.at(time));
        let (time, step) = (0.2, 1e-4);
        let (before, now, after) = (at(time - step), at(time), at(time + step));
        assert!(((after.at - before.at) / (2.0 * step) - now.vel).abs() < 1e-5);
        assert!(((after.vel - before.vel) / (2.0 * step) - now.acc).abs() < 1e-5);
        assert!(((after.acc - before.acc) / (2.0 * step) - now.jerk).abs() < 1e-4);
    }
}
