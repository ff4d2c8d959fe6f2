//! The parameter of a blend as a function of time, such that the TCP's speed changes smoothly from that of one motion
//! to that of the other, whatever the shape of the blend.

use std::iter::repeat_n;
use std::sync::Arc;

use nalgebra::SVector;

use crate::geometry::quintic::{Knot, Quintic};

/// Number of parts of the time, each with a polynomial of its own.
const PARTS: usize = 16;
/// Number of places of a part at which the path length is summed up.
const PLACES_OF_PART: usize = 8;
/// Share of the time over which the speed changes at either end.
const EASING_SHARE: f64 = 5.0 / 16.0;

/// The parameter of a curve over the share of the nominal time, both from 0 to 1.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum Parametrization {
    /// By one polynomial.
    One(Quintic<1>),
    /// By a polynomial for each part.
    Many(Arc<[Quintic<1>; PARTS]>),
}

impl Parametrization {
    /// Number of parts between which the third derivative jumps, all of the same length.
    pub(crate) const PARTS: usize = PARTS;

    /// Whether its third derivative jumps between parts.
    pub(crate) fn has_parts(&self) -> bool {
        matches!(self, Self::Many(_))
    }

    /// A smooth change from one rate of the parameter to another, each with its derivative.
    pub(crate) fn between([start, end]: [[f64; 2]; 2]) -> Self {
        let knot = |value: f64, [first, second]: [f64; 2]| Knot { value: [value], first: [first], second: [second] };
        Self::One(Quintic::between(&knot(0.0, start), &knot(1.0, end)))
    }

    /// Like [`Parametrization::along`], for a path that hardly bends and hardly changes its speed, from the path's
    /// first and second derivatives.
    pub(crate) fn gently<const N: usize>(
        derivative: impl Fn(usize, f64) -> SVector<f64, N>,
        start: [f64; 2],
        end: [f64; 2],
    ) -> Option<(Self, f64)> {
        if start[0] <= 0.0 || end[0] <= 0.0 {
            return None;
        }
        // Gauss's rule with three points.
        let speed = |at: f64| derivative(1, at).norm();
        let length =
            (5.0 * (speed(0.112_701_665_379_258_3) + speed(0.887_298_334_620_741_7)) + 8.0 * speed(0.5)) / 18.0;
        let time = time_along(length, start, end)?;
        let knot = |at: f64, [vel, acc]: [f64; 2]| {
            let (first, second) = (derivative(1, at), derivative(2, at));
            let rate = time * vel / first.norm();
            let change = time * time * acc - first.dot(&second) / first.norm() * rate * rate;
            Knot { value: [at], first: [rate], second: [change / first.norm()] }
        };
        let whole = Quintic::between(&knot(0.0, start), &knot(1.0, end));
        Some((Self::One(whole), time))
    }

    /// A parametrization along the path with these derivatives, with a speed in mm/s that changes smoothly from that of
    /// `start` to that of `end`, as do the accelerations, in mm/s2; with the nominal time in s. `None` where the path
    /// or the speed stands still or reverses somewhere.
    pub(crate) fn along<const N: usize>(
        derivative: impl Fn(usize, f64) -> SVector<f64, N>,
        [start, start_acc]: [f64; 2],
        [end, end_acc]: [f64; 2],
    ) -> Option<(Self, f64)> {
        const STEPS: usize = PARTS * PLACES_OF_PART;
        let speed = |at: f64| derivative(1, at).norm();
        // The path length up to each place, by Simpson's rule.
        let mut path_lengths = [0.0; STEPS + 1];
        let step = 1.0 / STEPS as f64;
        let mut sum = 0.0;
        let mut slowest = f64::INFINITY;
        for (index, path_length) in path_lengths.iter_mut().enumerate().skip(1) {
            let at = index as f64 * step;
            sum += (speed(at - step) + 4.0 * speed(at - step / 2.0) + speed(at)) * step / 6.0;
            slowest = slowest.min(speed(at)).min(speed(at - step / 2.0));
            *path_length = sum;
        }
        if slowest < 0.25 * sum || start <= 0.0 || end <= 0.0 {
            return None;
        }
        // The speed over the share of the time is a polynomial of the third degree; its integral is the path length.
        let time = time_along(sum, [start, start_acc], [end, end_acc])?;
        let (rise, fall) = (time * start_acc, time * end_acc);
        let wanted = |x: f64| {
            let easing = x * x * (3.0 - 2.0 * x);
            start + (end - start) * easing + x * (1.0 - x) * ((1.0 - x) * rise - x * fall)
        };
        if (0..=PARTS).any(|part| wanted(part as f64 / PARTS as f64) < 0.25 * start.min(end)) {
            return None;
        }
        let along = Self::of(|share| {
            let x = share;
            let eased = x * x * x * (1.0 - x / 2.0);
            let by_acc = x * x * (rise * (0.5 - x * (2.0 / 3.0 - x / 4.0)) - fall * x * (1.0 / 3.0 - x / 4.0));
            let path_length = time * (start * x + (end - start) * eased + by_acc);
            let mut at = parameter(&path_lengths, path_length);
            // The table provides a first guess.
            for _ in 0..3 {
                let base = (at / step).floor().clamp(0.0, (STEPS - 1) as f64);
                let from = base * step;
                let rest = at - from;
                let part = (speed(from) + 4.0 * speed(from + rest / 2.0) + speed(at)) * rest / 6.0;
                let there = path_lengths.get(base as usize).copied().unwrap_or(0.0) + part;
                at = (at + (path_length - there) / speed(at)).clamp(0.0, 1.0);
            }
            let (first, second) = (derivative(1, at), derivative(2, at));
            let rate = time * wanted(x) / first.norm();
            let by_acc = rise * (1.0 + x * (3.0 * x - 4.0)) + fall * x * (3.0 * x - 2.0);
            let change = time * ((end - start) * 6.0 * x * (1.0 - x) + by_acc);
            let bend = first.dot(&second) / first.norm();
            [at, rate, (change - bend * rate * rate) / first.norm()]
        });
        Some((along, time))
    }

    /// A parametrization along a path for which `gait` gives the length per unit of the parameter and its derivative at
    /// every place, with a speed that changes smoothly from `start` over `middle` to `end`, per s; with the nominal
    /// time in s. All values are above zero.
    pub(crate) fn eased(gait: impl Fn(f64) -> [f64; 2], [start, middle, end]: [f64; 3]) -> (Self, f64) {
        const STEPS: usize = 4 * PARTS;
        let length = |at: f64| gait(at)[0];
        let step = 1.0 / STEPS as f64;
        let part = |from: f64, to: f64| {
            (length(from) + 4.0 * length(f64::midpoint(from, to)) + length(to)) * (to - from) / 6.0
        };
        let mut path_lengths = [0.0; STEPS + 1];
        let mut sum = 0.0;
        for (index, path_length) in path_lengths.iter_mut().enumerate().skip(1) {
            let at = index as f64 * step;
            sum += part(at - step, at);
            *path_length = sum;
        }
        // The speed eases like 3 x2 - 2 x3 in the first and in the last part of the time.
        let easing = |x: f64| x * x * (3.0 - 2.0 * x);
        let eased = |x: f64| x * x * x * (1.0 - x / 2.0);
        let mean = middle + EASING_SHARE * ((start - middle) / 2.0 + (end - middle) / 2.0);
        let time = sum / mean;
        let speed = |share: f64| {
            let (rising, falling) = ((share / EASING_SHARE).min(1.0), ((1.0 - share) / EASING_SHARE).min(1.0));
            let change = |x: f64, from: f64| (middle - from) * 6.0 * x * (1.0 - x) / EASING_SHARE;
            let speed = start + (middle - start) * easing(rising) + (end - middle) * (1.0 - easing(falling));
            let path_length = middle * share
                + (start - middle) * EASING_SHARE * (rising - eased(rising))
                + (end - middle) * EASING_SHARE * (0.5 - (falling - eased(falling)));
            (path_length, speed, change(rising, start) - change(falling, end))
        };
        let along = Self::of(|share| {
            let (path_length, speed, change) = speed(share);
            let path_length = path_length * time;
            let mut at = parameter(&path_lengths, path_length);
            // The table provides a first guess.
            for _ in 0..3 {
                let base = (at / step).floor().clamp(0.0, (STEPS - 1) as f64);
                let known = path_lengths.get(base as usize).copied().unwrap_or(0.0);
                at = (at + (path_length - known - part(base * step, at)) / length(at)).clamp(0.0, 1.0);
            }
            if share >= 1.0 {
                at = 1.0;
            }
            let [length, slope] = gait(at);
            let rate = time * speed / length;
            [at, rate, (time * change - slope * rate * rate) / length]
        });
        (along, time)
    }

    /// Creates a parametrization from the value and its first two derivatives at the ends of the parts.
    fn of(at: impl Fn(f64) -> [f64; 3]) -> Self {
        let width = 1.0 / PARTS as f64;
        let knot = |index: usize| {
            let [value, first, second] = at(index as f64 * width);
            Knot { value: [value], first: [first * width], second: [second * width * width] }
        };
        Self::Many(Arc::new(std::array::from_fn(|index| Quintic::between(&knot(index), &knot(index + 1)))))
    }

    /// The part that contains `share`, the place in it, and the number of parts.
    fn part(&self, share: f64) -> (&Quintic<1>, f64, f64) {
        match self {
            Parametrization::One(whole) => (whole, share.clamp(0.0, 1.0), 1.0),
            Parametrization::Many(parts) => {
                let place = share.clamp(0.0, 1.0) * PARTS as f64;
                let index = (place as usize).min(PARTS - 1);
                let [first, ..] = &**parts;
                (parts.get(index).unwrap_or(first), place - index as f64, PARTS as f64)
            }
        }
    }

    /// The parameter.
    pub(crate) fn at(&self, share: f64) -> f64 {
        let (part, place, _) = self.part(share);
        let [value] = part.at(place);
        value.clamp(0.0, 1.0)
    }

    /// The derivative of the order `order`, 1 to 3.
    pub(crate) fn derivative(&self, order: usize, share: f64) -> f64 {
        let (part, place, parts) = self.part(share);
        let [value] = part.derivative(order, place);
        value * repeat_n(parts, order).product::<f64>()
    }
}

/// The time in s for a distance in mm with a smooth change from one speed and acceleration, in mm/s and mm/s2, to
/// others.
fn time_along(distance: f64, [start, start_acc]: [f64; 2], [end, end_acc]: [f64; 2]) -> Option<f64> {
    let (mean, gain) = (f64::midpoint(start, end), (start_acc - end_acc) / 12.0);
    let inside = mean * mean + 4.0 * gain * distance;
    (inside >= 0.0).then(|| 2.0 * distance / (mean + inside.sqrt())).filter(|time| time.is_finite())
}

/// The parameter at which the table of path lengths has reached `path_length`.
fn parameter(path_lengths: &[f64], path_length: f64) -> f64 {
    let after = path_lengths.partition_point(|known| *known < path_length).clamp(1, path_lengths.len() - 1);
    let (Some(low), Some(high)) = (path_lengths.get(after - 1), path_lengths.get(after)) else { return 0.0 };
    ((after - 1) as f64 + (path_length - low) / (high - low)) / (path_lengths.len() - 1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::track::Track;

    #[test]
    fn the_speed_along_a_bend_is_even() {
        let knot = |value: [f64; 3], first: [f64; 3]| Knot { value, first, second: [0.0; 3] };
        let bend =
            Quintic::between(&knot([0.0, 0.0, 0.0], [40.0, 0.0, 0.0]), &knot([20.0, 20.0, 0.0], [0.0, 40.0, 0.0]));
        let track = Track::Poly(bend.into());
        for (start, end) in [(100.0, 100.0), (50.0, 300.0)] {
            let (parametrization, time) =
                Parametrization::along(|order, at| track.derivative(order, at), [start, 0.0], [end, 0.0]).unwrap();
            assert!((track.length() / time - f64::midpoint(start, end)).abs() < 1e-3);
            let mut before = 0.0;
            for step in 0..=1000 {
                let share = f64::from(step) / 1000.0;
                let at = parametrization.at(share);
                let speed = track.derivative(1, at).norm() * parametrization.derivative(1, share) / time;
                let expected = start + (end - start) * share * share * (3.0 - 2.0 * share);
                assert!((speed - expected).abs() < 2e-3 * expected, "{share}: {speed} {expected}");
                assert!(at >= before, "{share}: {before} {at}");
                before = at;
            }
            assert!((parametrization.at(1.0) - 1.0).abs() < 1e-9 && parametrization.at(0.0) == 0.0);
        }
    }

    #[test]
    fn speed_and_acceleration_are_met_at_both_ends() {
        let knot = |value: [f64; 3], first: [f64; 3]| Knot { value, first, second: [30.0, -20.0, 10.0] };
        let track = Track::Poly(
            Quintic::between(&knot([0.0; 3], [40.0, 0.0, 0.0]), &knot([20.0, 20.0, 0.0], [0.0, 40.0, 5.0])).into(),
        );
        let (start, end) = ([100.0, 400.0], [150.0, -300.0]);
        let (parametrization, time) =
            Parametrization::along(|order, at| track.derivative(order, at), start, end).unwrap();
        for (share, [speed, acc]) in [(0.0, start), (1.0, end)] {
            let (first, second) = (track.derivative(1, share), track.derivative(2, share));
            let (rate, change) =
                (parametrization.derivative(1, share) / time, parametrization.derivative(2, share) / time / time);
            assert!((first.norm() * rate - speed).abs() < 1e-9);
            let along = (second * rate * rate + first * change).dot(&first) / first.norm();
            assert!((along - acc).abs() < 1e-9, "{along}");
        }
        // Whatever the parts, the path length is exact.
        assert!((parametrization.at(1.0) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn an_eased_path_takes_its_speeds() {
        let gait = |at: f64| [1.0 + at * (1.0 - at), 1.0 - 2.0 * at];
        let (parametrization, time) = Parametrization::eased(gait, [2.0, 5.0, 1.0]);
        let mut distance = 0.0;
        for step in 0..=1000 {
            let share = f64::from(step) / 1000.0;
            let at = parametrization.at(share);
            let speed = gait(at)[0] * parametrization.derivative(1, share) / time;
            let wanted = match step {
                0 => 2.0,
                320..=680 => 5.0,
                1000 => 1.0,
                _ => speed,
            };
            assert!((speed - wanted).abs() < 1e-3 && speed > 0.99, "{share}: {speed}");
            distance += speed * time / 1000.0;
        }
        assert!(
            (distance - (1.0 + 1.0 / 6.0)).abs() < 5e-3 && (parametrization.at(1.0) - 1.0).abs() < 1e-9,
            "{distance}"
        );
    }
}
