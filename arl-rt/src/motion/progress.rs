//! How the parameter of a blend goes with time: so that the TCP's speed changes smoothly from that of the one motion to
//! that of the other, whatever the shape of the blend.

use super::curve::Track;
use super::quintic::{Knot, Quintic};

/// Parts of the time, each with a polynomial of its own.
const PARTS: usize = 16;
/// Places of a part at which the way is summed up.
const PLACES: usize = 8;

/// The parameter of a curve over the share of the nominal time, both from 0 to 1.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Progress([Quintic<1>; PARTS]);

impl Progress {
    /// From one rate of the parameter to another, smoothly.
    pub(super) fn between(start_rate: f64, end_rate: f64) -> Self {
        let knot = |value: f64, first: f64| Knot { value: [value], first: [first], second: [0.0] };
        let whole = Quintic::between(&knot(0.0, start_rate), &knot(1.0, end_rate));
        Self::of(|share| {
            let ([value], [first], [second]) =
                (whole.at(share), whole.derivative(1, share), whole.derivative(2, share));
            [value, first, second]
        })
    }

    /// Along `track`, with a speed that goes smoothly from `start` to `end` mm/s; with the nominal time in s. `None` where
    /// the track stands still or turns back somewhere.
    pub(super) fn along(track: &Track, start: f64, end: f64) -> Option<(Self, f64)> {
        const STEPS: usize = PARTS * PLACES;
        let speed = |at: f64| track.derivative(1, at).norm();
        // The way up to each place, by Simpson's rule.
        let mut ways = [0.0; STEPS + 1];
        let step = 1.0 / STEPS as f64;
        let mut sum = 0.0;
        let mut slowest = f64::INFINITY;
        for (index, way) in ways.iter_mut().enumerate().skip(1) {
            let at = index as f64 * step;
            sum += (speed(at - step) + 4.0 * speed(at - step / 2.0) + speed(at)) * step / 6.0;
            slowest = slowest.min(speed(at)).min(speed(at - step / 2.0));
            *way = sum;
        }
        if slowest < 0.25 * sum || start <= 0.0 || end <= 0.0 {
            return None;
        }
        let time = sum / f64::midpoint(start, end);
        // The speed over the share of the time eases like 3 x2 - 2 x3; this is its integral.
        let easing = |x: f64| x * x * (3.0 - 2.0 * x);
        let eased = |x: f64| x * x * x * (1.0 - x / 2.0);
        let along = Self::of(|share| {
            let way = time * (start * share + (end - start) * eased(share));
            let mut at = parameter(&ways, way);
            // The table is a first guess.
            for _ in 0..3 {
                let base = (at / step).floor().clamp(0.0, (STEPS - 1) as f64);
                let from = base * step;
                let rest = at - from;
                let part = (speed(from) + 4.0 * speed(from + rest / 2.0) + speed(at)) * rest / 6.0;
                let there = ways.get(base as usize).copied().unwrap_or(0.0) + part;
                at = (at + (way - there) / speed(at)).clamp(0.0, 1.0);
            }
            let (first, second) = (track.derivative(1, at), track.derivative(2, at));
            let rate = time * (start + (end - start) * easing(share)) / first.norm();
            let change = time * (end - start) * 6.0 * share * (1.0 - share);
            let bend = first.dot(&second) / first.norm();
            [at, rate, (change - bend * rate * rate) / first.norm()]
        });
        Some((along, time))
    }

    /// From the value and its first two derivatives at the ends of the parts.
    fn of(at: impl Fn(f64) -> [f64; 3]) -> Self {
        let width = 1.0 / PARTS as f64;
        let knot = |index: usize| {
            let [value, first, second] = at(index as f64 * width);
            Knot { value: [value], first: [first * width], second: [second * width * width] }
        };
        Self(std::array::from_fn(|index| Quintic::between(&knot(index), &knot(index + 1))))
    }

    /// The part that `share` is in, and where in it.
    fn part(&self, share: f64) -> (&Quintic<1>, f64) {
        let place = share.clamp(0.0, 1.0) * PARTS as f64;
        let index = (place as usize).min(PARTS - 1);
        let [first, ..] = &self.0;
        (self.0.get(index).unwrap_or(first), place - index as f64)
    }

    /// The parameter.
    pub(super) fn at(&self, share: f64) -> f64 {
        let (part, place) = self.part(share);
        let [value] = part.at(place);
        value.clamp(0.0, 1.0)
    }

    /// The derivative of the order `order`, 1 to 3.
    pub(super) fn derivative(&self, order: usize, share: f64) -> f64 {
        let (part, place) = self.part(share);
        let [value] = part.derivative(order, place);
        value * (PARTS as f64).powi(order as i32)
    }
}

/// The parameter at which the table of ways has reached `way`.
fn parameter(ways: &[f64], way: f64) -> f64 {
    let after = ways.partition_point(|known| *known < way).clamp(1, ways.len() - 1);
    let (Some(low), Some(high)) = (ways.get(after - 1), ways.get(after)) else { return 0.0 };
    ((after - 1) as f64 + (way - low) / (high - low)) / (ways.len() - 1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_speed_along_a_bend_is_even() {
        let knot = |value: [f64; 3], first: [f64; 3]| Knot { value, first, second: [0.0; 3] };
        let track = Track::Poly(Quintic::between(
            &knot([0.0, 0.0, 0.0], [40.0, 0.0, 0.0]),
            &knot([20.0, 20.0, 0.0], [0.0, 40.0, 0.0]),
        ));
        for (start, end) in [(100.0, 100.0), (50.0, 300.0)] {
            let (progress, time) = Progress::along(&track, start, end).unwrap();
            assert!((track.length() / time - f64::midpoint(start, end)).abs() < 1e-3);
            let mut before = 0.0;
            for step in 0..=1000 {
                let share = f64::from(step) / 1000.0;
                let at = progress.at(share);
                let speed = track.derivative(1, at).norm() * progress.derivative(1, share) / time;
                let expected = start + (end - start) * share * share * (3.0 - 2.0 * share);
                assert!((speed - expected).abs() < 2e-3 * expected, "{share}: {speed} {expected}");
                assert!(at >= before, "{share}: {before} {at}");
                before = at;
            }
            assert!((progress.at(1.0) - 1.0).abs() < 1e-9 && progress.at(0.0) == 0.0);
        }
    }
}
