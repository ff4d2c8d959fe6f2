//! A place on a curve whose parameter moves with another one.

use nalgebra::Vector3;

use crate::geometry::parametrization::Parametrization;

/// A step for differences, as part of the whole.
const DIFFERENCE_STEP: f64 = 1e-3;

/// A place on the curve: its parameter, and how that changes with the share of the nominal time.
#[derive(Clone, Copy)]
pub(crate) struct CurvePoint {
    pub(crate) at: f64,
    pub(crate) first: f64,
    pub(crate) second: f64,
    pub(crate) third: f64,
}

impl CurvePoint {
    pub(crate) fn at(parametrization: &Parametrization, share: f64) -> Self {
        let [first, second, third] = [1, 2, 3].map(|order| parametrization.derivative(order, share));
        Self { at: parametrization.at(share), first, second, third }
    }

    /// By a parameter of which `width` is the derivative of the one before.
    pub(crate) fn scaled(self, width: f64) -> Self {
        let Self { at, first, second, third } = self;
        Self { at, first: first * width, second: second * width * width, third: third * width * width * width }
    }

    /// Derivatives by the curve's parameter become derivatives by the share of the time.
    pub(crate) fn rates<const N: usize>(&self, [p1, p2, p3]: [[f64; N]; 3]) -> [[f64; N]; 3] {
        let Self { first: a, second: b, third: c, .. } = *self;
        let mut out = [[0.0; N]; 3];
        let [first, second, third] = &mut out;
        let places = first.iter_mut().zip(second).zip(third);
        for (((first, second), third), ((p1, p2), p3)) in places.zip(p1.iter().zip(&p2).zip(&p3)) {
            *first = p1 * a;
            *second = p2 * a * a + p1 * b;
            *third = p3 * a * a * a + 3.0 * p2 * a * b + p1 * c;
        }
        out
    }

    pub(crate) fn vectors(&self, vectors: [Vector3<f64>; 3]) -> [Vector3<f64>; 3] {
        self.rates(vectors.map(<[f64; 3]>::from)).map(Vector3::from)
    }
}

/// The part of the second difference of a way in steps that lies along the first of them; no number where that is none.
pub(crate) fn second_difference_along([first, second]: [&Vector3<f64>; 2]) -> f64 {
    (second - first).dot(first) / first.norm()
}

/// The part of the third difference of a way in steps that lies along it; no number where the middle step is none.
pub(crate) fn third_difference_along([first, second, third]: [&Vector3<f64>; 3]) -> f64 {
    (third - 2.0 * second + first).dot(second) / second.norm()
}

/// Three derivatives of a point's place, in mm, by what `of` takes, from 0 to `end`: by differences.
pub(crate) fn by_differences(of: impl Fn(f64) -> Vector3<f64>, at: f64, end: f64) -> [Vector3<f64>; 3] {
    let step = DIFFERENCE_STEP * end;
    let at = at.clamp(2.0 * step, end - 2.0 * step);
    let [b, a, here, c, d] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|steps| of(at + steps * step));
    let first = (c - a) / (2.0 * step);
    let second = (c - 2.0 * here + a) / (step * step);
    [first, second, (d - 2.0 * c + 2.0 * a - b) / (2.0 * step * step * step)]
}
