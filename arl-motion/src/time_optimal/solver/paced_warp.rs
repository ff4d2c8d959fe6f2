//! A parameter that runs roughly as time does.
//!
//! Where the path bends sharply, the motion is slower by orders of magnitude than elsewhere, over a distance that is
//! shorter in proportion. Over the path parameter, such a problem cannot be solved with floating point numbers. So a
//! first guess of the speed makes another parameter, in which all places are about as far apart as they are in time,
//! and the speed is about the same everywhere.
//!
//! Invariant: the path parameter is a strictly increasing function of it with two continuous derivatives. Third
//! derivatives jump at the places.

use crate::time_optimal::solver::guess::smooth;
use crate::time_optimal::solver::pace::Pace;
use crate::time_optimal::solver::warp::{Warp, WarpedPoint};

/// The warped parameter ([`Warp`]) as a function of the paced one from one place to the next: a cubic.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Knot {
    /// The paced parameter.
    at: f64,
    /// The warped parameter and its derivatives.
    value: f64,
    first: f64,
    second: f64,
    third: f64,
}

/// The path parameter as a function of the paced one.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct PacedWarp {
    warp: Warp,
    knots: Vec<Knot>,
    length: f64,
    /// Whether it is the warped parameter itself.
    is_even: bool,
}

/// The least ratio of the speeds at two places for which a parameter of its own is worthwhile, and the largest ratio at
/// neighbouring places.
const LEAST_RANGE: f64 = 20.0;
const FARTHEST_APART: f64 = 5.0;
/// Maximum number of times that guessed speeds are smoothed because the paced parameter would otherwise turn back.
const ATTEMPTS: usize = 4;
/// Its least growth at a place, as a share of its growth between the neighbouring places.
const LEAST_GROWTH: f64 = 0.1;

impl PacedWarp {
    /// Creates a paced warp from the warped places, and a guess of the warped parameter's speed at each. Where that is
    /// not much lower anywhere than elsewhere, or the places are too far apart to judge, the result is the warped
    /// parameter itself.
    pub(crate) fn guessed(warp: Warp, places: &[f64], speeds: Vec<f64>) -> Self {
        let (least, most) =
            speeds.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), speed| (least.min(*speed), most.max(*speed)));
        let apart = speeds.windows(2).map(|pair| (pair[0] / pair[1]).max(pair[1] / pair[0])).fold(1.0, f64::max);
        if most < LEAST_RANGE * least || apart > FARTHEST_APART || apart.is_nan() {
            return Self::even(warp, places);
        }
        let mut speeds = speeds;
        for _ in 0..ATTEMPTS {
            speeds = smooth(speeds);
            if let Some(paced) = Pace::at_speeds(places, &speeds).and_then(|pace| Self::along(warp, places, &pace)) {
                return paced;
            }
        }
        Self::even(warp, places)
    }

    /// The speeds of the warped parameter at the places where the paced one has these speeds; `None` where the two
    /// parameters are the same.
    pub(crate) fn speeds(&self, own: impl Iterator<Item = f64>) -> Option<Vec<f64>> {
        (!self.is_even).then(|| self.knots.iter().zip(own).map(|(knot, own)| knot.first * own).collect())
    }

    /// The warped parameter itself.
    pub(crate) fn even(warp: Warp, places: &[f64]) -> Self {
        let knot = |at: &f64| Knot { at: *at, value: *at, first: 1.0, second: 0.0, third: 0.0 };
        let length = places.last().copied().unwrap_or_default();
        Self { warp, knots: places.iter().map(knot).collect(), length, is_even: true }
    }

    /// The spline through the places, as far apart as they are in time along a motion; `None` where that turns back.
    pub(crate) fn along(warp: Warp, places: &[f64], pace: &Pace) -> Option<Self> {
        let widths: Vec<f64> = pace.times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let slopes = slopes(places, &widths, pace.ends);
        let mut at = 0.0;
        let mut knots = Vec::with_capacity(places.len());
        for ((place, slope), width) in places.windows(2).zip(slopes.windows(2)).zip(&widths) {
            let (mean, [from, to]) = ((place[1] - place[0]) / width, [slope[0], slope[1]]);
            let second = (6.0 * mean - 4.0 * from - 2.0 * to) / width;
            let third = 6.0 * (from + to - 2.0 * mean) / (width * width);
            // The slope is a parabola: its minimum is at an end or where its own slope is zero.
            let turn = (-second / third).clamp(0.0, *width);
            let least = from.min(to).min(from + turn * (second + turn * third / 2.0));
            if least.is_nan() || least < LEAST_GROWTH * mean {
                return None;
            }
            knots.push(Knot { at, value: place[0], first: from, second, third });
            at += width;
        }
        let last = knots.last()?;
        let width = at - last.at;
        let second = last.second + width * last.third;
        knots.push(Knot { at, value: *places.last()?, first: *slopes.last()?, second, third: 0.0 });
        at.is_finite().then_some(Self { warp, knots, length: at, is_even: false })
    }

    /// Whether it is the warped parameter itself.
    pub(crate) fn is_even(&self) -> bool {
        self.is_even
    }

    /// The end of the range of the paced parameter, which starts at 0.
    pub(crate) fn length(&self) -> f64 {
        self.length
    }

    /// The paced parameters of the places.
    pub(crate) fn places(&self) -> impl Iterator<Item = f64> {
        self.knots.iter().map(|knot| knot.at)
    }

    /// The path parameter and its derivatives at `at`, on the stretch from the place `index` to the next one.
    pub(crate) fn place(&self, index: usize, at: f64) -> WarpedPoint {
        let Some(knot) = self.knots.get(index) else { return self.warp.place(at) };
        let Knot { value, first, second, third, .. } = *knot;
        let t = at - knot.at;
        let (first, rise, value) = (
            first + t * (second + t * third / 2.0),
            second + t * third,
            value + t * (first + t * (second / 2.0 + t * third / 6.0)),
        );
        let place = self.warp.place(value.min(self.warp.length()));
        WarpedPoint {
            at: place.at,
            first: place.first * first,
            second: place.second * first * first + place.first * rise,
            third: place.third * first * first * first + 3.0 * place.second * first * rise + place.first * third,
        }
    }

    /// The paced parameter of a path parameter.
    pub(crate) fn find(&self, at: f64) -> f64 {
        let value = self.warp.find(at).max(0.0);
        let index = self.knots.partition_point(|knot| knot.value <= value).saturating_sub(1);
        let (Some(knot), next) = (self.knots.get(index), self.knots.get(index + 1)) else { return value };
        let Some(next) = next else { return self.length };
        let (mut low, mut high) = (0.0, next.at - knot.at);
        let mut t = high * (value - knot.value) / (next.value - knot.value);
        for _ in 0..60 {
            let off = knot.value + t * (knot.first + t * (knot.second / 2.0 + t * knot.third / 6.0)) - value;
            if off < 0.0 {
                low = t;
            } else {
                high = t;
            }
            let step = t - off / (knot.first + t * (knot.second + t * knot.third / 2.0));
            let step = if step > low && step < high { step } else { f64::midpoint(low, high) };
            let is_near = (step - t).abs() <= 1e-14 * next.at;
            t = step;
            if is_near {
                break;
            }
        }
        knot.at + t
    }
}

/// The slopes at all places of the spline through `values`, `widths` apart, with the slopes `ends` at its ends.
fn slopes(values: &[f64], widths: &[f64], [first, last]: [f64; 2]) -> Vec<f64> {
    // Each slope in terms of the next one: slope = offset - factor * next.
    let mut rows = vec![(0.0, first)];
    for ((value, width), before) in values.windows(3).zip(widths.windows(2)).zip(0..) {
        let [left, right] = [width[0], width[1]];
        let secants = [(value[1] - value[0]) / left, (value[2] - value[1]) / right];
        let (factor, offset): (f64, f64) = rows[before];
        let pivot = 2.0 * (left + right) - right * factor;
        let side = 3.0 * (right * secants[0] + left * secants[1]) - right * offset;
        rows.push((left / pivot, side / pivot));
    }
    let mut slopes = vec![last; values.len()];
    for index in (0..values.len() - 1).rev() {
        let (factor, offset) = rows[index];
        slopes[index] = offset - factor * slopes[index + 1];
    }
    slopes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_smooth_and_found_back() {
        let places: Vec<f64> = (0..=60).map(|index| (f64::from(index) / 60.0).powi(2) * 3.0).collect();
        let warp = Warp::new(-1.0, 2.0, false, false);
        let speeds = smooth(places.iter().map(|place| 0.1 + (place - 1.0).abs()).collect());
        let paced = PacedWarp::along(warp, &places, &Pace::at_speeds(&places, &speeds).unwrap()).unwrap();
        assert!(!paced.is_even);
        let knots: Vec<f64> = paced.places().collect();
        for (index, pair) in knots.windows(2).enumerate() {
            let (place, before) = (paced.place(index, pair[0]), paced.place(index.saturating_sub(1), pair[0]));
            assert!((place.at - (places[index] - 1.0)).abs() < 1e-12);
            assert!((place.at - before.at).abs() + (place.first - before.first).abs() < 1e-9);
            assert!((place.second - before.second).abs() < 1e-6 * (1.0 + place.second.abs()), "{place:?} {before:?}");
            let middle = f64::midpoint(pair[0], pair[1]);
            assert!((paced.find(paced.place(index, middle).at) - middle).abs() < 1e-9);
        }
    }
}
