//! Places on a curve whose parameter is a function of another parameter.

use nalgebra::Vector3;

use crate::geometry::parametrization::Parametrization;

/// The step for differences, as a share of the whole.
const DIFFERENCE_STEP: f64 = 1e-3;

/// A place on the curve: its parameter with derivatives by the share of the nominal time.
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

    /// The place by another parameter, by which the derivative of the previous one is `width`.
    pub(crate) fn scaled(self, width: f64) -> Self {
        let Self { at, first, second, third } = self;
        Self { at, first: first * width, second: second * width * width, third: third * width * width * width }
    }

    /// Converts derivatives by the curve's parameter into derivatives by the share of the time.
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

/// The component of the second difference of consecutive steps along the first step; NaN where the first step is zero.
pub(crate) fn second_difference_along([first, second]: [&Vector3<f64>; 2]) -> f64 {
    (second - first).dot(first) / first.norm()
}

/// The component of the third difference of consecutive steps along the path; NaN where the middle step is zero.
pub(crate) fn third_difference_along([first, second, third]: [&Vector3<f64>; 3]) -> f64 {
    (third - 2.0 * second + first).dot(second) / second.norm()
}

/// The first three derivatives of a point's position, in mm, by the argument of `of`, from 0 to `end`: by differences.
pub(crate) fn by_differences(of: impl Fn(f64) -> Vector3<f64>, at: f64, end: f64) -> [Vector3<f64>; 3] {
    let step = DIFFERENCE_STEP * end;
    let at = at.clamp(2.0 * step, end - 2.0 * step);
    let [b, a, here, c, d] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|steps| of(at + steps * step));
    let first = (c - a) / (2.0 * step);
    let second = (c - 2.0 * here + a) / (step * step);
    [first, second, (d - 2.0 * c + 2.0 * a - b) / (2.0 * step * step * step)]
}
