//! Sines, cosines and arc tangents of several angles at once, in deg.
//!
//! The loops have no branches, so that the compiler handles several angles with one instruction; this gives most of the
//! speed of the closed forms. Results are within 2 units in the last place, exact at multiples of 90 deg, and, unlike
//! those of the system's functions, the same on every machine.

/// Polynomials in the square of the angle (rad), lowest power first, interpolated at the Chebyshev points of 0 to 45
/// deg (arc tangent: of 0 to tan 22.5 deg): sine = r + r^3 S, cosine = 1 - r^2 / 2 + r^4 C, arc tangent = r + r^3 T.
mod polynomials {
    pub(super) const S: [f64; 6] = [
        -0.16666666666666666,
        0.008333333333330948,
        -0.00019841269836756774,
        2.7557316101617874e-06,
        -2.505113165023518e-08,
        1.5918115263265974e-10,
    ];
    pub(super) const C: [f64; 6] = [
        0.041666666666666664,
        -0.0013888888888887398,
        2.480158729876456e-05,
        -2.7557317271145144e-07,
        2.087614614655861e-09,
        -1.1382623647474604e-11,
    ];
    pub(super) const T: [f64; 11] = [
        -0.3333333333333333,
        0.19999999999995516,
        -0.14285714284665682,
        0.11111111015187018,
        -0.0909090457530649,
        0.07692183125376892,
        -0.06664510525508936,
        0.05858140904866328,
        -0.050854078345894844,
        0.03923044778479309,
        -0.019175404711104935,
    ];
}
use polynomials::{C, S, T};

/// Adding and subtracting this constant rounds to a whole number; in between, the lowest bits contain that number.
const ROUND: f64 = 6_755_399_441_055_744.0;

const DEGREE: f64 = std::f64::consts::PI / 180.0;
const RADIAN: f64 = 180.0 / std::f64::consts::PI;
/// The tangent of 22.5 deg: up to it the polynomial is used directly, above it for the difference from 45 deg.
const EIGHTH: f64 = 0.414_213_562_373_095_05;

/// The powers are distributed over `SUMS` (2 or 4) independent sums, which the processor computes in parallel.
#[inline(always)]
fn polynomial<const SUMS: usize, const N: usize>(coefficients: &[f64; N], at: f64) -> f64 {
    let square = at * at;
    let step = if SUMS == 2 { square } else { square * square };
    let sum =
        |first: usize| coefficients.iter().skip(first).step_by(SUMS).rev().fold(0.0, |sum, each| sum * step + each);
    let low = sum(0) + at * sum(1);
    if SUMS == 2 { low } else { low + square * (sum(2) + at * sum(3)) }
}

/// Returns `yes` if all bits of `mask` are set, `no` if none is.
#[inline(always)]
fn either(mask: u64, yes: f64, no: f64) -> f64 {
    f64::from_bits((yes.to_bits() & mask) | (no.to_bits() & !mask))
}

/// The sines and cosines of angles in deg.
#[inline(always)]
pub fn sin_cos<const N: usize>(angles: [f64; N]) -> ([f64; N], [f64; N]) {
    let (mut sines, mut cosines) = ([0.0; N], [0.0; N]);
    for (angle, (sine, cosine)) in angles.iter().zip(sines.iter_mut().zip(&mut cosines)) {
        let quarters = angle * (1.0 / 90.0) + ROUND;
        let r = (angle - 90.0 * (quarters - ROUND)) * DEGREE;
        let quarters = quarters.to_bits();
        let z = r * r;
        let sin = r + r * z * polynomial::<2, _>(&S, z);
        let cos = 1.0 - (0.5 * z - z * z * polynomial::<2, _>(&C, z));
        let odd = 0_u64.wrapping_sub(quarters & 1);
        *sine = f64::from_bits(either(odd, cos, sin).to_bits() ^ ((quarters & 2) << 62));
        *cosine = f64::from_bits(either(odd, sin, cos).to_bits() ^ ((quarters.wrapping_add(1) & 2) << 62));
    }
    (sines, cosines)
}

/// The angles in deg, within -180 to 180, whose sines and cosines are in the ratio of `y` to `x`; 0 if both are 0.
#[inline(always)]
pub(super) fn atan2<const N: usize>(y: [f64; N], x: [f64; N]) -> [f64; N] {
    let mut angles = [0.0; N];
    for ((y, x), angle) in y.iter().zip(&x).zip(&mut angles) {
        let (up, across) = (y.abs(), x.abs());
        let steep = up > across;
        let (low, high) = if steep { (across, up) } else { (up, across) };
        let wide = low > EIGHTH * high;
        let (above, below) = if wide { (low - high, low + high) } else { (low, high) };
        let r = above / if below > 0.0 { below } else { 1.0 };
        let z = r * r;
        let mut turned = (r + r * z * polynomial::<4, _>(&T, z)) * RADIAN + if wide { 45.0 } else { 0.0 };
        turned = if steep { 90.0 - turned } else { turned };
        turned = if *x < 0.0 { 180.0 - turned } else { turned };
        *angle = turned.copysign(*y);
    }
    angles
}

/// The angles (deg) wrapped to (-180, 180].
#[inline(always)]
pub(super) fn wrap<const N: usize>(mut angles: [f64; N]) -> [f64; N] {
    for angle in &mut angles {
        let turned = *angle - 360.0 * ((*angle * (1.0 / 360.0) + ROUND) - ROUND);
        let turned = turned + if turned <= -180.0 { 360.0 } else { 0.0 };
        *angle = turned - if turned > 180.0 { 360.0 } else { 0.0 };
    }
    angles
}

#[cfg(test)]
mod tests {
    use super::super::random::Random;
    use super::*;

    #[test]
    fn sines_and_cosines_are_right() {
        let mut random = Random::new(11);
        for _ in 0..100_000 {
            let angle = random.between(-2000.0, 2000.0);
            let ([sine, _], [cosine, _]) = sin_cos([angle, 0.0]);
            // Whole turns are subtracted first: the system's function is subject to rounding of the angle in rad.
            let (s, c) = (angle % 360.0).to_radians().sin_cos();
            assert!((sine - s).abs() < 1e-15 && (cosine - c).abs() < 1e-15, "{angle}: {sine} {s} {cosine} {c}");
        }
    }

    #[test]
    fn multiples_of_90_are_exact() {
        for (quarter, (s, c)) in (-8..8).zip([(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)].into_iter().cycle()) {
            let angle = 90.0 * f64::from(quarter);
            let ([sine], [cosine]) = sin_cos([angle]);
            assert_eq!((sine, cosine), (s, c), "{angle}");
            let [back] = atan2([s], [c]);
            assert_eq!(wrap([back - angle]), [0.0]);
        }
        assert_eq!(atan2([0.0], [0.0]), [0.0]);
        assert_eq!(atan2([-1.0], [-1.0]), [-135.0]);
    }

    #[test]
    fn arc_tangents_are_right() {
        let mut random = Random::new(12);
        for _ in 0..100_000 {
            let (y, x) =
                (random.between(-1.0, 1.0), random.between(-1.0, 1.0) * 10.0_f64.powf(random.between(-9.0, 9.0)));
            let [angle] = atan2([y], [x]);
            let expected = y.atan2(x).to_degrees();
            assert!((angle - expected).abs() < 1e-13, "{y} {x}: {angle} {expected}");
        }
        // Small angles are as precise as their size.
        let [angle] = atan2([1e-12], [3.0]);
        assert!((angle / (1e-12_f64 / 3.0).to_degrees() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn angles_wrap_into_one_turn() {
        for (given, expected) in [
            (180.0, 180.0),
            (-180.0, 180.0),
            (181.0, -179.0),
            (540.0, 180.0),
            (-541.0, 179.0),
            (7.5, 7.5),
            (-900.0, 180.0),
        ] {
            assert_eq!(wrap([given]), [expected]);
        }
    }
}
