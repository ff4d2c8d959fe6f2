//! The positions of a point: by polynomials or along a circle, with derivatives and length.

use std::iter::repeat_n;

use nalgebra::Vector3;

use crate::geometry::paced_quintic::PacedQuintic;
use crate::geometry::quintic::Quintic;

/// The path of a point.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum Track {
    /// By polynomials, in mm.
    Poly(PacedQuintic<3>),
    /// Along a circle.
    Arc(Arc),
}

/// A part of a circle: `centre + across cos(sweep u) + along sin(sweep u)`, in mm and rad.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Arc {
    pub(crate) centre: Vector3<f64>,
    pub(crate) across: Vector3<f64>,
    pub(crate) along: Vector3<f64>,
    pub(crate) sweep: f64,
}

impl Track {
    /// A straight line.
    pub(crate) fn line(start: Vector3<f64>, end: Vector3<f64>) -> Self {
        Self::Poly(Quintic::even(start.into(), (end - start).into()).into())
    }

    /// The position at `at`, in mm.
    pub(crate) fn at(&self, at: f64) -> Vector3<f64> {
        match self {
            Track::Poly(poly) => poly.at(at).into(),
            Track::Arc(arc) => {
                let (sine, cosine) = libm::sincos(arc.sweep * at);
                arc.centre + arc.across * cosine + arc.along * sine
            }
        }
    }

    /// The derivative of the order `order`, 1 to 3, in mm per unit.
    pub(crate) fn derivative(&self, order: usize, at: f64) -> Vector3<f64> {
        match self {
            Track::Poly(poly) => poly.derivative(order, at).into(),
            Track::Arc(arc) => {
                let (sine, cosine) = libm::sincos(arc.sweep * at);
                let (x, y) = match order {
                    1 => (-sine, cosine),
                    2 => (-cosine, -sine),
                    _ => (sine, -cosine),
                };
                (arc.across * x + arc.along * y) * repeat_n(arc.sweep, order).product::<f64>()
            }
        }
    }

    /// The rotation of its direction, in rad per unit about an axis of the base; `None` where it does not turn evenly.
    pub(crate) fn even_turning(&self) -> Option<Vector3<f64>> {
        match self {
            Track::Poly(poly) => poly.is_even().then(Vector3::zeros),
            Track::Arc(arc) => Some(arc.across.cross(&arc.along).normalize() * arc.sweep),
        }
    }

    /// Its length in mm.
    pub(crate) fn length(&self) -> f64 {
        match self {
            Track::Poly(poly) if poly.is_even() => self.derivative(1, 0.0).norm(),
            Track::Arc(arc) => arc.along.norm() * arc.sweep.abs(),
            // Gauss's rule with five points, on eight parts.
            Track::Poly(_) => {
                const PLACES: [(f64, f64); 5] = [
                    (0.0, 0.568_888_888_888_888_9),
                    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
                    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
                    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
                    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
                ];
                let part = |part: u32| {
                    let speed = |(place, weight): &(f64, f64)| {
                        weight * self.derivative(1, (f64::from(part) + 0.5 + place / 2.0) / 8.0).norm()
                    };
                    PLACES.iter().map(speed).sum::<f64>() / 16.0
                };
                (0..8).map(part).sum()
            }
        }
    }
}
