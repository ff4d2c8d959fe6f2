//! The figures of a weave: the offset of the TCP from the path as a function of time.

use nalgebra::{Rotation3, Vector3};

use crate::command::{Weave, WeaveShape};
use crate::overlay::path_frame::Rates;

/// The start of a straight leg of the figure: time, place, and the speed from there on.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Leg {
    time: f64,
    place: Vector3<f64>,
    speed: Vector3<f64>,
}

#[derive(Clone, PartialEq, Debug)]
enum Figure {
    /// `sine sin(w t) + cosine (cos(w t) - 1) + double sin(2 w t)`.
    Smooth { rate: f64, sine: Vector3<f64>, cosine: Vector3<f64>, double: Vector3<f64> },
    /// Legs whose corners are rounded over `rounding` s on both sides.
    Cornered { legs: Vec<Leg>, rounding: f64 },
}

/// A figure that can be followed: twice differentiable, with a finite third derivative.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Pattern {
    figure: Figure,
    pub(crate) period: f64,
}

/// Number of places at which a figure is measured.
const PLACES: u32 = 512;

impl Pattern {
    /// Creates the figure of `weave`; corners are rounded over `rounding` s before and behind them.
    pub(crate) fn new(weave: &Weave, rounding: f64) -> Self {
        let period = weave.period();
        let turned = Rotation3::new(weave.turned);
        let across = turned * Vector3::y() * weave.amplitude;
        let along = turned * Vector3::x() * weave.radius;
        let rate = std::f64::consts::TAU / period;
        let none = Vector3::zeros();
        let figure = match weave.shape {
            _ if weave.is_cornered() => return Self::cornered(weave, &turned, rounding),
            WeaveShape::Ellipse => Figure::Smooth { rate, sine: across, cosine: along, double: none },
            WeaveShape::Eight => Figure::Smooth { rate, sine: across, cosine: none, double: along },
            _ => Figure::Smooth { rate, sine: across, cosine: none, double: none },
        };
        Self { figure, period }
    }

    fn cornered(weave: &Weave, turned: &Rotation3<f64>, rounding: f64) -> Self {
        let half = if weave.shape == WeaveShape::Simple { 90.0 } else { weave.angle / 2.0 };
        let (sine, cosine) = libm::sincos(half.to_radians());
        let side = |sign: f64| {
            let cosine = if weave.shape == WeaveShape::Simple { 0.0 } else { cosine };
            turned * Vector3::new(0.0, sign * sine, cosine) * weave.amplitude
        };
        let (left, right, middle) = (side(1.0), side(-1.0), Vector3::zeros());
        let [stay_left, stay_right, stay_middle] = weave.dwells;
        let stops: &[(Vector3<f64>, f64)] = match weave.shape {
            WeaveShape::Triangle => &[(left, stay_left), (right, stay_right), (middle, stay_middle)],
            _ => &[(left, stay_left), (middle, stay_middle), (right, stay_right), (middle, stay_middle)],
        };
        // The legs share the time in proportion to their lengths.
        let length = |stops: &[(Vector3<f64>, f64)]| {
            let mut from = middle;
            stops.iter().map(|(to, _)| (to - std::mem::replace(&mut from, *to)).norm()).sum::<f64>()
        };
        let whole = length(stops).max(f64::MIN_POSITIVE);
        let mut legs = Vec::with_capacity(2 * stops.len());
        let (mut time, mut from) = (0.0, middle);
        for (to, stay) in stops {
            let needed = (to - from).norm() / whole / weave.frequency;
            let moving = (needed > 0.0).then(|| Leg { time, place: from, speed: (to - from) / needed });
            let staying = (*stay > 0.0).then(|| Leg { time: time + needed, place: *to, speed: Vector3::zeros() });
            legs.extend(moving.into_iter().chain(staying));
            (time, from) = (time + needed + stay, *to);
        }
        let period = if time > 0.0 { time } else { weave.period() };
        let mut pattern = Self { figure: Figure::Cornered { legs, rounding }, period };
        // Rounding cuts the corners off: the figure is enlarged so that it reaches as far as requested.
        let widest = (0..PLACES).map(|place| pattern.at(period * f64::from(place) / f64::from(PLACES)));
        let widest = widest.map(|[offset, ..]| offset.norm()).fold(0.0, f64::max);
        if let Figure::Cornered { legs, .. } = &mut pattern.figure
            && widest > 0.0
        {
            for leg in legs {
                leg.place *= weave.amplitude / widest;
                leg.speed *= weave.amplitude / widest;
            }
        }
        pattern
    }

    /// The largest change of speed at a corner, in mm/s.
    pub(crate) fn sharpest(&self) -> f64 {
        let Figure::Cornered { legs, .. } = &self.figure else { return 0.0 };
        let before = legs.iter().cycle().skip(legs.len().saturating_sub(1));
        legs.iter().zip(before).map(|(leg, before)| (leg.speed - before.speed).norm()).fold(0.0, f64::max)
    }

    /// The shortest time, in s, over which the figure changes.
    pub(crate) fn grain(&self) -> f64 {
        match &self.figure {
            Figure::Smooth { double, .. } if *double != Vector3::zeros() => self.period / 64.0,
            Figure::Smooth { .. } => self.period / 32.0,
            Figure::Cornered { rounding, .. } => (rounding / 3.0).min(self.period / 32.0),
        }
    }

    /// The offset from the path after `time` s, in mm, in the frame of the path, with its derivatives by the time.
    pub(crate) fn at(&self, time: f64) -> Rates {
        match &self.figure {
            Figure::Smooth { rate, sine, cosine, double } => {
                let ((s, c), (s2, c2)) = (libm::sincos(rate * time), libm::sincos(2.0 * rate * time));
                let r = 2.0 * rate;
                [
                    sine * s + cosine * (c - 1.0) + double * s2,
                    (sine * c - cosine * s) * *rate + double * (c2 * r),
                    -(sine * s + cosine * c) * (rate * rate) - double * (s2 * r * r),
                    (cosine * s - sine * c) * (rate * rate * rate) - double * (c2 * r * r * r),
                ]
            }
            Figure::Cornered { legs, rounding } => self.rounded(legs, *rounding, time.rem_euclid(self.period)),
        }
    }

    /// The legs, averaged over the time around `time`: straight parts stay straight, corners become smooth.
    fn rounded(&self, legs: &[Leg], rounding: f64, time: f64) -> Rates {
        let after = legs.partition_point(|leg| leg.time <= time);
        let Some(here) = legs.get(after.saturating_sub(1)) else { return [Vector3::zeros(); 4] };
        let mut rates = [here.place + here.speed * (time - here.time), here.speed, Vector3::zeros(), Vector3::zeros()];
        let [place, first, second, third] = &mut rates;
        let mut before = legs.last().unwrap_or(here).speed;
        for leg in legs {
            let change = leg.speed - before;
            before = leg.speed;
            for lap in [-self.period, 0.0, self.period] {
                let x = (time - leg.time - lap) / rounding;
                if x.abs() >= 1.0 {
                    continue;
                }
                // A ramp that begins at the corner, averaged with the weights 3/4 (1 - x2), minus the ramp itself.
                let (ramp, step) = if x >= 0.0 { (x, 1.0) } else { (0.0, 0.0) };
                let square = x * x;
                *place += change * (rounding * (0.1875 + x * 0.5 + square * (0.375 - square * 0.0625) - ramp));
                *first += change * (0.5 + x * (0.75 - square * 0.25) - step);
                *second += change * (0.75 * (1.0 - square) / rounding);
                *third -= change * (1.5 * x / (rounding * rounding));
            }
        }
        rates
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weave(shape: WeaveShape) -> Weave {
        Weave {
            shape,
            frequency: 2.0,
            amplitude: 15.0,
            dwells: [0.0; 3],
            angle: 60.0,
            radius: 4.0,
            turned: Vector3::zeros(),
        }
    }

    fn all() -> Vec<Weave> {
        use WeaveShape::{Eight, Ellipse, Simple, Triangle, VShape};
        let plain = [Simple, VShape, Triangle, Ellipse, Eight].map(weave);
        let staying = plain.map(|weave| Weave { dwells: [0.1, 0.2, 0.05], ..weave });
        let dwelling_left = plain.map(|weave| Weave { dwells: [0.003, 0.0, 0.0], turned: Vector3::z() * 0.3, ..weave });
        plain.into_iter().chain(staying).chain(dwelling_left).collect()
    }

    #[test]
    fn figures_are_as_wide_as_asked_begin_on_the_path_and_are_smooth() {
        for weave in all() {
            for rounding in [0.005, 0.02, 0.06] {
                let pattern = Pattern::new(&weave, rounding);
                assert!((pattern.period - weave.period()).abs() < 1e-12);
                let places: Vec<Rates> =
                    (0..4000).map(|step| pattern.at(pattern.period * f64::from(step) / 4000.0)).collect();
                let across = |v: &Vector3<f64>| Rotation3::new(-weave.turned) * v;
                let widest = places.iter().map(|[v, ..]| across(v).yz().norm()).fold(0.0, f64::max);
                assert!((widest - 15.0).abs() < 0.02, "{weave:?} {rounding}: {widest}");
                assert!(pattern.is_cornered() || pattern.at(0.0)[0].norm() < 1e-12);
                let h = 1e-6;
                for step in 0..500 {
                    let time = pattern.period * (f64::from(step) + 0.37) / 250.0;
                    let (before, here, after) = (pattern.at(time - h), pattern.at(time), pattern.at(time + h));
                    for order in 0..3 {
                        let measured = (after[order] - before[order]) / (2.0 * h);
                        let slack = [1e-4, 1e-2, 60.0][order] + 1e-4 * here[order + 1].norm();
                        // The third derivative has steps.
                        let steps = order == 2 && (after[3] - before[3]).norm() > 1.0;
                        assert!(steps || (measured - here[order + 1]).norm() < slack, "{weave:?} {order} at {time}");
                    }
                }
            }
        }
    }

    #[test]
    fn stays_last_as_long_as_asked() {
        let stays = Weave { dwells: [0.2, 0.3, 0.1], ..weave(WeaveShape::Simple) };
        let pattern = Pattern::new(&stays, 0.01);
        assert!((stays.period() - 1.2).abs() < 1e-12);
        let steps = 120_000;
        let resting = |y: f64| {
            let at = |step: u32| pattern.at(pattern.period * f64::from(step) / f64::from(steps));
            let near = |[place, speed, ..]: Rates| speed.norm() < 1e-6 && (place.y - y).abs() < 1e-6;
            (0..steps).filter(|step| near(at(*step))).count() as f64 * pattern.period / f64::from(steps)
        };
        // Rounding takes time from both ends of each dwell.
        assert!((resting(15.0) - 0.18).abs() < 1e-3 && (resting(-15.0) - 0.28).abs() < 1e-3);
        assert!((resting(0.0) - 2.0 * 0.08).abs() < 1e-3);
    }

    impl Pattern {
        fn is_cornered(&self) -> bool {
            matches!(self.figure, Figure::Cornered { .. })
        }
    }
}
