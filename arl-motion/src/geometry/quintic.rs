//! Polynomials of the fifth degree: straight paths, blends, splines.

/// Factors of the powers in the first, second and third derivative.
const FACTORS: [[f64; 6]; 3] =
    [[0.0, 1.0, 2.0, 3.0, 4.0, 5.0], [0.0, 0.0, 2.0, 6.0, 12.0, 20.0], [0.0, 0.0, 0.0, 6.0, 24.0, 60.0]];

/// A polynomial of up to the fifth degree for each of `N` values, lowest power first.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Quintic<const N: usize>(pub(crate) [[f64; N]; 6]);

/// A value with its first and second derivative.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Knot<const N: usize> {
    pub(crate) value: [f64; N],
    pub(crate) first: [f64; N],
    pub(crate) second: [f64; N],
}

impl<const N: usize> Quintic<N> {
    /// An even change from `start` at 0 by `travel` per unit.
    pub(crate) fn even(start: [f64; N], travel: [f64; N]) -> Self {
        let zero = [0.0; N];
        Self([start, travel, zero, zero, zero, zero])
    }

    /// From one knot at 0 to another at 1.
    pub(crate) fn between(from: &Knot<N>, to: &Knot<N>) -> Self {
        let mut powers = [[0.0; N]; 6];
        for index in 0..N {
            let (p0, v0, a0) = (from.value[index], from.first[index], from.second[index]);
            let (p1, v1, a1) = (to.value[index], to.first[index], to.second[index]);
            let distance = p1 - p0;
            let column = [
                p0,
                v0,
                a0 / 2.0,
                10.0 * distance - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1,
                -15.0 * distance + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1,
                6.0 * distance - 3.0 * (v0 + v1) - 0.5 * a0 + 0.5 * a1,
            ];
            for (power, value) in powers.iter_mut().zip(column) {
                power[index] = value;
            }
        }
        Self(powers)
    }

    /// The values at `at`.
    pub(crate) fn at(&self, at: f64) -> [f64; N] {
        self.0.iter().rev().fold([0.0; N], |sum, power| times_plus(sum, at, power))
    }

    /// The derivative of the order `order`, 1 to 3, at `at`.
    pub(crate) fn derivative(&self, order: usize, at: f64) -> [f64; N] {
        let [first, second, third] = &FACTORS;
        let factors = match order {
            1 => first,
            2 => second,
            _ => third,
        };
        let mut sum = [0.0; N];
        for (values, factor) in self.0.iter().zip(factors).skip(order).rev() {
            sum = times_plus(sum, at, &values.map(|value| value * factor));
        }
        sum
    }

    /// The values at `at` with their first two derivatives.
    pub(crate) fn knot(&self, at: f64) -> Knot<N> {
        Knot { value: self.at(at), first: self.derivative(1, at), second: self.derivative(2, at) }
    }

    /// Whether it changes evenly.
    pub(crate) fn is_even(&self) -> bool {
        self.0.iter().skip(2).all(|power| power.iter().all(|value| *value == 0.0))
    }
}

fn times_plus<const N: usize>(sum: [f64; N], at: f64, add: &[f64; N]) -> [f64; N] {
    let mut out = *add;
    for (out, sum) in out.iter_mut().zip(sum) {
        *out += sum * at;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_takes_the_knots_at_both_ends() {
        let from = Knot { value: [1.0, -2.0], first: [3.0, 0.5], second: [-4.0, 2.0] };
        let to = Knot { value: [0.0, 5.0], first: [-1.0, 2.0], second: [6.0, -7.0] };
        let curve = Quintic::between(&from, &to);
        for (at, knot) in [(0.0, from), (1.0, to)] {
            let found = curve.knot(at);
            for (found, wanted) in [(found.value, knot.value), (found.first, knot.first), (found.second, knot.second)] {
                assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {wanted:?}");
            }
        }
        let step = 1e-4;
        let third = curve.derivative(3, 0.3);
        let (before, after) = (curve.derivative(2, 0.3 - step), curve.derivative(2, 0.3 + step));
        for index in 0..2 {
            assert!((third[index] - (after[index] - before[index]) / (2.0 * step)).abs() < 1e-4);
        }
    }
}
