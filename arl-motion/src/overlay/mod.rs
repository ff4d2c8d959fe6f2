//! Overlays on a path of the TCP: a weave beside it, and a compensation that shifts and turns it.
//!
//! Both are part of the geometry: functions of the path parameter. So everything that checks, limits and governs the
//! motion takes them into account, and the override, stops and late motions change their time but never their shape.

pub(crate) mod compensation;

pub(crate) mod path_frame;
pub(crate) mod weave;

use nalgebra::{UnitQuaternion, Vector3};

use crate::geometry::tcp_path::TcpPath;
use compensation::Shift;
use path_frame::{PathFrame, Rates, carried};
use weave::Pattern;

pub(crate) use compensation::CompensationState;

/// The overlay on a path of the TCP.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Overlay {
    /// The frame of the path, where it is needed.
    pub(crate) frame: Option<PathFrame>,
    pub(crate) woven: Option<Woven>,
    pub(crate) shift: Option<Shift>,
}

/// The part of a weave along one motion.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Woven {
    pub(crate) pattern: Pattern,
    /// How long the weave has been running at the start of the motion, in s at full speed.
    pub(crate) begun: f64,
    /// How long the motion takes, in s at full speed.
    pub(crate) seconds: f64,
    /// Time at its end in which it returns to the path, in s; 0 where the next motion continues it.
    pub(crate) fading: f64,
}

/// A value that changes smoothly from 0 to 1, with its first three derivatives.
type Easing = [f64; 4];

/// 0 before the start, 1 behind the end, and a polynomial of the fifth degree in between.
fn easing(x: f64) -> Easing {
    if x <= 0.0 {
        return [0.0; 4];
    }
    if x >= 1.0 {
        return [1.0, 0.0, 0.0, 0.0];
    }
    let rest = 1.0 - x;
    [
        x * x * x * (10.0 - x * (15.0 - 6.0 * x)),
        30.0 * x * x * rest * rest,
        60.0 * x * rest * (1.0 - 2.0 * x),
        60.0 * (1.0 - x * (6.0 - 6.0 * x)),
    ]
}

/// The derivatives by a parameter that is `rate` times as fast.
fn paced([value, first, second, third]: Easing, rate: f64) -> Easing {
    [value, first * rate, second * rate * rate, third * rate * rate * rate]
}

/// A product with its derivatives.
fn times([a, a1, a2, a3]: Easing, [v, v1, v2, v3]: Rates) -> Rates {
    [v * a, v * a1 + v1 * a, v * a2 + v1 * (2.0 * a1) + v2 * a, v * a3 + (v1 * a2 + v2 * a1) * 3.0 + v3 * a]
}

impl Woven {
    /// The offset in the frame of the path, in mm, with its derivatives by the parameter.
    fn at(&self, at: f64) -> Rates {
        let time = self.begun + self.seconds * at;
        let [place, first, second, third] = self.pattern.at(time);
        let rate = self.seconds;
        let mut rates = [place, first * rate, second * (rate * rate), third * (rate * rate * rate)];
        // It grows over the first half of the first figure.
        let growing = self.pattern.period / 2.0;
        if time < growing {
            rates = times(paced(easing(time / growing), rate / growing), rates);
        }
        let remaining = self.seconds * (1.0 - at);
        if remaining < self.fading {
            rates = times(paced(easing(remaining / self.fading), -rate / self.fading), rates);
        }
        rates
    }
}

impl Overlay {
    /// What the weave adds to the position of the TCP, in mm, along the axes of what the path is relative to, with its
    /// derivatives by the parameter.
    pub(crate) fn weaving(&self, at: f64) -> Option<Rates> {
        let (woven, frame) = (self.woven.as_ref()?, self.frame.as_ref()?);
        Some(carried(&frame.rotation(at), &frame.turning(at), &woven.at(at)))
    }

    /// What is added to the position of the TCP, in mm, along the axes of what the path is relative to, with its
    /// derivatives by the parameter.
    pub(crate) fn offset(&self, curve: &TcpPath, at: f64) -> Rates {
        let woven = self.weaving(at).unwrap_or([Vector3::zeros(); 4]);
        let shifted = self.shift.as_ref().map(|shift| shift.offset(curve, self.frame.as_ref(), at));
        let Some(shifted) = shifted else { return woven };
        std::array::from_fn(|order| {
            let of = |rates: &Rates| rates.get(order).copied().unwrap_or_default();
            of(&woven) + of(&shifted)
        })
    }

    /// The additional rotation of the TCP, about axes of what the path is relative to.
    pub(crate) fn turned(&self, curve: &TcpPath, at: f64) -> UnitQuaternion<f64> {
        let shift = self.shift.as_ref();
        UnitQuaternion::from_scaled_axis(
            shift.map_or(Vector3::zeros(), |shift| shift.turned(curve, self.frame.as_ref(), at)),
        )
    }

    /// Whether the TCP is turned.
    pub(crate) fn turns(&self) -> bool {
        self.shift.as_ref().is_some_and(Shift::turns)
    }

    /// The longest share of the motion over which no overlay changes much.
    pub(crate) fn longest_step(&self) -> f64 {
        let woven = self.woven.as_ref().map_or(1.0, |woven| woven.pattern.grain() / woven.seconds);
        self.shift.as_ref().map_or(woven, |shift| woven.min(shift.grain()))
    }

    /// The length of a figure of the weave as a share of the motion, and the place from which figures are no longer
    /// alike.
    pub(crate) fn figures(&self) -> Option<(f64, f64)> {
        let woven = self.woven.as_ref()?;
        // With a compensation that grows, no two figures are alike.
        let grows = self.shift.as_ref().is_some_and(Shift::grows);
        let like = if grows { 0.0 } else { 1.0 - woven.fading / woven.seconds };
        Some((woven.pattern.period / woven.seconds, like))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_and_easings_have_their_derivatives() {
        let vector = |u: f64| {
            let (s, c) = (2.0 * u).sin_cos();
            let v = Vector3::new(1.0, -2.0, 0.5);
            [v * s, v * (2.0 * c), v * (-4.0 * s), v * (-8.0 * c)]
        };
        let at = |u: f64| times(paced(easing(u / 0.5), 2.0), vector(u));
        let h = 1e-5;
        for u in [0.1, 0.25, 0.4] {
            for order in 0..3 {
                let measured = (at(u + h)[order] - at(u - h)[order]) / (2.0 * h);
                assert!((measured - at(u)[order + 1]).norm() < 1e-4, "{order}");
            }
        }
    }
}
