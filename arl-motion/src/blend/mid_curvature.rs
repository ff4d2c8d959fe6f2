//! Curvature where two blends meet in the middle of a motion.
//!
//! Blends that take whole halves of short motions leave nothing straight between them. If every motion were
//! nevertheless straight in its middle, a circle of short lines would become a path whose curvature falls to zero and
//! rises again on each of them, and the jerk limit would permit only a small part of the speed. So the middle gets
//! about the mean curvature of the corners at both ends: on a circle, that of the circle. Where one corner is much
//! sharper than the other, or bends the other way, the middle gets little curvature or none, so that the path does not
//! swing out.
//!
//! Motions of the axes are as fast as the slowest axis permits: along a dense chain, the combined speed of all axes
//! changes with every direction, all the time. So these motions also get a change of speed in the middle, or their
//! speed would swing within each blend. The path does not depend on that.

use nalgebra::{SVector, Vector3};

use crate::blend::zone::parts;
use crate::command::LARGEST_ZONE;
use crate::command::joints::{ALL, Joints, slowness};
use crate::plan::curve::Curve;
use crate::plan::motion::Motion;
use arl_robot::robot::{EXTERNAL_AXES, Robot};

/// Up to about this difference between the directions of motions, as a share of their length, the mean of both corners
/// is used unchanged.
const GENTLE_DIFFERENCE: f64 = 0.1;
/// Up to this amount, in rad or shares of the motion, a turn is ignored.
const NO_TURN: f64 = 1e-9;
/// A motion that is longer than a neighbour by more than this factor is curved less.
const LONG_MOTION_FACTOR: f64 = 2.0;

/// The curvature of a motion in its middle: second derivatives by its parameter.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct MidCurvature {
    /// Of the TCP's position, in mm.
    pub(crate) position: Vector3<f64>,
    /// Of the tool's rotation in rad, about axes of the base.
    pub(crate) turning: Vector3<f64>,
    /// Of all axes, where the motion is an axis motion; else of the external ones.
    pub(crate) axes: [f64; ALL],
    /// The change of its speed at its nominal pace, where the motion is an axis motion: per s, where an axis at its
    /// highest speed counts as 1 per s.
    pub(crate) surge: f64,
}

impl MidCurvature {
    /// No curvature.
    pub(crate) const NONE: Self = Self {
        position: Vector3::new(0.0, 0.0, 0.0),
        turning: Vector3::new(0.0, 0.0, 0.0),
        axes: [0.0; ALL],
        surge: 0.0,
    };

    /// The second derivatives of the external axes.
    pub(crate) fn external(&self) -> [f64; EXTERNAL_AXES] {
        Joints::of(&self.axes).external
    }
}

/// How something changes with the length of the path, for a motion and for its neighbours.
type Changes<const N: usize> = [SVector<f64, N>; 3];

/// The curvature of `here` between two motions; `None` where the blends at its ends do not meet, or the motions lead
/// different things.
pub(crate) fn mid_curvature(robot: &Robot, before: &Motion, here: &Motion, after: &Motion) -> Option<MidCurvature> {
    // A motion with an overlay keeps its own shape.
    if [before, here, after].iter().any(|motion| motion.laid.is_some()) {
        return None;
    }
    let meet = parts(robot, before, here)?.1 == LARGEST_ZONE && parts(robot, here, after)?.0 == LARGEST_ZONE;
    // The corners of a gate stay as they are.
    if !meet || before.corner.is_some() || here.corner.is_some() {
        return None;
    }
    let mut curvature = MidCurvature::NONE;
    match (&before.curve, &here.curve, &after.curve) {
        (Curve::Tool(a), Curve::Tool(b), Curve::Tool(c)) => {
            if !a.goes_on(0.5, b, 0.5) || !b.goes_on(0.5, c, 0.5) || !b.is_even() {
                return None;
            }
            let motions = [before, here, after];
            let moves = motions.iter().all(|motion| motion.length > 1e-9);
            let lengths = motions.map(|motion| if moves { motion.length } else { motion.angle });
            let lengths = Lengths::new(lengths)?;
            let track =
                [a.path.track.derivative(1, 1.0), b.path.track.derivative(1, 0.5), c.path.track.derivative(1, 0.0)];
            if let Some(direction) = track[1].try_normalize(1e-12)
                && matches!(&b.path.track, crate::geometry::track::Track::Poly(_))
            {
                let second = lengths.curvature(&track);
                curvature.position = second - direction * direction.dot(&second);
            }
            let speed = |curve: &crate::plan::curve::ToolCurve, at: f64| {
                let [speed, ..] = curve.rotation_rates(at);
                speed
            };
            curvature.turning = lengths.curvature(&[speed(a, 1.0), speed(b, 0.5), speed(c, 0.0)]);
            let external =
                [a.external.derivative(1, 1.0), b.external.derivative(1, 0.5), c.external.derivative(1, 0.0)];
            let second = lengths.curvature_of_each(&external.map(SVector::from));
            curvature.axes = Joints { axes: [0.0; 6], external: second.into() }.all();
        }
        (Curve::Axes(a), Curve::Axes(b), Curve::Axes(c)) if b.is_even() => {
            let slowness = slowness(robot);
            let rates = [a.derivative(1, 1.0), b.derivative(1, 0.5), c.derivative(1, 0.0)]
                .map(|rates| SVector::from(rates).component_mul(&slowness));
            let [_, direction, _] = &rates;
            let second = Lengths::new(rates.map(|rates| rates.norm()))?.curvature(&rates);
            let turn = second - direction * (direction.dot(&second) / direction.norm_squared());
            curvature.axes =
                std::array::from_fn(|index| if slowness[index] > 0.0 { turn[index] / slowness[index] } else { 0.0 });
            let times = [before, here, after].map(|motion| 1.0 / motion.rate);
            let speeds = rates.map(|rates| SVector::<f64, 1>::new(rates.norm()));
            curvature.surge = Lengths::new(times)?.curvature(&speeds).x * here.rate * here.rate;
        }
        _ => return None,
    }
    Some(curvature)
}

/// The lengths of three motions.
struct Lengths([f64; 3]);

impl Lengths {
    fn new(lengths: [f64; 3]) -> Option<Self> {
        lengths.iter().all(|length| *length > 1e-9).then_some(Self(lengths))
    }

    /// The second derivative of something by the middle motion's parameter, from first derivatives by each motion's
    /// own.
    fn curvature<const N: usize>(&self, rates: &Changes<N>) -> SVector<f64, N> {
        let ([first, second], scale) = self.corners(rates);
        self.limited(&first, &second, scale)
    }

    /// The second derivative for components that are independent of each other.
    fn curvature_of_each<const N: usize>(&self, rates: &Changes<N>) -> SVector<f64, N> {
        let ([first, second], scale) = self.corners(rates);
        SVector::from_fn(|index, _| {
            let one = |all: &SVector<f64, N>| SVector::<f64, 1>::new(all.get(index).copied().unwrap_or(0.0));
            self.limited(&one(&first), &one(&second), scale).x
        })
    }

    /// The change of the derivative by length at both ends, and the derivative of the middle motion.
    fn corners<const N: usize>(&self, rates: &Changes<N>) -> ([SVector<f64, N>; 2], f64) {
        let ([before, here, after], [a, b, c]) = (self.0, rates);
        let (a, b, c) = (a / before, b / here, c / after);
        let corners = [(b - a) / f64::midpoint(before, here), (c - b) / f64::midpoint(here, after)];
        (corners, b.norm())
    }

    /// The mean of two changes of a speed `scale`, closer to the smaller one the sharper they are, and little or none
    /// where they bend in opposite directions; by the middle motion's parameter.
    fn limited<const N: usize>(
        &self,
        first: &SVector<f64, N>,
        second: &SVector<f64, N>,
        scale: f64,
    ) -> SVector<f64, N> {
        let [before, here, after] = self.0;
        let gentle = GENTLE_DIFFERENCE * scale / here;
        let (a, b, e) = (first.norm_squared(), second.norm_squared(), gentle * gentle);
        let sum = a + b + 2.0 * e;
        if sum <= 0.0 {
            return SVector::zeros();
        }
        let mean = (first * (b + e) + second * (a + e)) / sum;
        let apart = (-first.dot(second)).max(0.0);
        let together = if apart > 0.0 { e / (e + apart) } else { 1.0 };
        let longer = (LONG_MOTION_FACTOR * before.min(after) / here).min(1.0);
        let curvature = mean * (together * longer * here * here);
        if curvature.norm() > NO_TURN * here * scale { curvature } else { SVector::zeros() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_of_lines_is_bent_like_the_circle() {
        let (radius, step) = (100.0, 0.02_f64);
        let point = |index: f64| Vector3::new((index * step).cos(), (index * step).sin(), 0.0) * radius;
        let travel = [0.0, 1.0, 2.0].map(|index| point(index + 1.0) - point(index));
        let lengths = Lengths::new(travel.map(|travel| travel.norm())).unwrap();
        let second = lengths.curvature(&travel) / travel[1].norm_squared();
        let middle = (point(1.0) + point(2.0)) / 2.0;
        let wanted = -middle / middle.norm_squared();
        assert!((second - wanted).norm() < 1e-3 * wanted.norm(), "{second} {wanted}");
    }

    #[test]
    fn a_zigzag_or_a_single_corner_is_hardly_bent() {
        let lengths = Lengths::new([1.0; 3]).unwrap();
        let (x, y) = (Vector3::x(), Vector3::y());
        assert!(lengths.curvature(&[x, y, x]).norm() < 0.01);
        assert!(lengths.curvature(&[x, x, y]).norm() < 0.02);
        let long = Lengths::new([0.1, 10.0, 0.1]).unwrap();
        assert!(long.curvature(&[x * 0.1, y * 10.0, x * -0.1]).norm() < 0.5);
    }
}
