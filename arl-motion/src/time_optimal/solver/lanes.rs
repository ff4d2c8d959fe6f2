//! Numbers side by side, for vector instructions of the processor.

use std::ops::{Add, AddAssign, Mul, Neg, Sub};

/// Number of lanes: what every processor of an architecture has registers for.
pub(crate) const LANES: usize = 2;

/// Numbers side by side.
#[derive(Clone, Copy, Default, PartialEq, Debug)]
pub(crate) struct Lanes(pub(crate) [f64; LANES]);

impl Lanes {
    /// The same number in all lanes.
    #[inline(always)]
    pub(crate) fn all(value: f64) -> Self {
        Self([value; LANES])
    }

    /// The reciprocals.
    #[inline(always)]
    pub(crate) fn inverse(self) -> Self {
        Self(self.0.map(|value| 1.0 / value))
    }

    /// The higher of the two, lane by lane.
    #[inline(always)]
    pub(crate) fn more(self, other: Self) -> Self {
        let Self([a, b]) = self;
        let Self([c, d]) = other;
        Self([if c > a { c } else { a }, if d > b { d } else { b }])
    }

    #[inline(always)]
    pub(crate) fn sum(self) -> f64 {
        self.0.iter().sum()
    }

    /// The highest lane.
    pub(crate) fn most(self) -> f64 {
        self.0.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }
}

impl Add for Lanes {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self([self.0[0] + other.0[0], self.0[1] + other.0[1]])
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Lanes {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self([self.0[0] - other.0[0], self.0[1] - other.0[1]])
    }
}

impl Mul for Lanes {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self([self.0[0] * other.0[0], self.0[1] * other.0[1]])
    }
}

impl Neg for Lanes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self([-self.0[0], -self.0[1]])
    }
}
