//! Polynomials that are followed at a pace of their own.

use std::sync::Arc;

use crate::geometry::parametrization::Parametrization;
use crate::geometry::quintic::{Knot, Quintic};

/// Values along a path: a polynomial of the path's parameter or, where it has a pace of its own, of the parametrization
/// as a function of that parameter.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct PacedQuintic<const N: usize> {
    poly: Quintic<N>,
    pace: Option<Arc<Parametrization>>,
}

impl<const N: usize> From<Quintic<N>> for PacedQuintic<N> {
    fn from(poly: Quintic<N>) -> Self {
        Self { poly, pace: None }
    }
}

impl<const N: usize> PacedQuintic<N> {
    /// A polynomial at a pace.
    pub(crate) fn paced(poly: Quintic<N>, pace: Arc<Parametrization>) -> Self {
        Self { poly, pace: Some(pace) }
    }

    /// Whether it has a pace of its own.
    pub(crate) fn is_paced(&self) -> bool {
        self.pace.is_some()
    }

    /// The values at `at`.
    pub(crate) fn at(&self, at: f64) -> [f64; N] {
        self.poly.at(self.pace.as_ref().map_or(at, |pace| pace.at(at)))
    }

    /// The derivative of the order `order`, 1 to 3, at `at`.
    pub(crate) fn derivative(&self, order: usize, at: f64) -> [f64; N] {
        let Some(pace) = &self.pace else { return self.poly.derivative(order, at) };
        let place = pace.at(at);
        let [a, b, c] = [1, 2, 3].map(|order| pace.derivative(order, at));
        let of = |order: usize| self.poly.derivative(order, place);
        match order {
            1 => of(1).map(|first| first * a),
            2 => sum([of(1), of(2), [0.0; N]], [b, a * a, 0.0]),
            _ => sum([of(1), of(2), of(3)], [c, 3.0 * a * b, a * a * a]),
        }
    }

    /// The values at `at` with their first two derivatives.
    pub(crate) fn knot(&self, at: f64) -> Knot<N> {
        Knot { value: self.at(at), first: self.derivative(1, at), second: self.derivative(2, at) }
    }

    /// Whether it changes evenly.
    pub(crate) fn is_even(&self) -> bool {
        self.pace.is_none() && self.poly.is_even()
    }
}

fn sum<const N: usize>([a, b, c]: [[f64; N]; 3], [x, y, z]: [f64; 3]) -> [f64; N] {
    let mut out = [0.0; N];
    for (((out, a), b), c) in out.iter_mut().zip(a).zip(b).zip(c) {
        *out = a * x + b * y + c * z;
    }
    out
}
