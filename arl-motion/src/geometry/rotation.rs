//! Rotation vectors that change along a path, and the speed of rotation that follows from them.

use nalgebra::{Matrix3, Vector3};

/// Number of terms of the power series below: enough for every rotation vector up to two turns.
const SERIES_TERMS: u32 = 24;
/// Number of terms that are enough up to this square of the angle.
const SMALL_ANGLE_TERMS: u32 = 4;
const SMALL_ANGLE_SQUARED: f64 = 1e-3;

/// A power series of the squared angle, `first` + .., whose term k is the one before divided by -(2k + `n`)(2k + `n` -
/// 1); with its first two derivatives.
fn series(angle_squared: f64, first: f64, n: u32) -> [f64; 3] {
    let (mut value, mut slope, mut bend) = (0.0, 0.0, 0.0);
    let terms = if angle_squared < SMALL_ANGLE_SQUARED { SMALL_ANGLE_TERMS } else { SERIES_TERMS };
    for k in (1..=terms).rev() {
        let ratio = -1.0 / (f64::from(2 * k + n) * f64::from(2 * k + n - 1));
        // The sum from term k on is 1 + ratio * angle_squared * (the sum from the next term on).
        let (inner, inner_slope, inner_bend) = if k == terms { (1.0, 0.0, 0.0) } else { (value, slope, bend) };
        bend = ratio * (2.0 * inner_slope + angle_squared * inner_bend);
        slope = ratio * (inner + angle_squared * inner_slope);
        value = 1.0 + ratio * angle_squared * inner;
    }
    [value * first, slope * first, bend * first]
}

/// (1 - cos x) / x2 and (x - sin x) / x3, with their derivatives by x2.
fn factors(vector: &Vector3<f64>) -> [[f64; 3]; 2] {
    let squared = vector.norm_squared();
    [series(squared, 1.0 / 2.0, 2), series(squared, 1.0 / 6.0, 3)]
}

/// The speed of rotation, in rad per unit, of a rotation vector (rad) whose first three derivatives are given, with its
/// first two derivatives. The rotation of the vector is preceded by a fixed one and followed by none.
pub(crate) fn speeds(vector: &Vector3<f64>, derivatives: &[Vector3<f64>; 3]) -> [Vector3<f64>; 3] {
    let [d1, d2, d3] = derivatives;
    let (s1, s2) = (2.0 * vector.dot(d1), 2.0 * (d1.norm_squared() + vector.dot(d2)));
    // By the parameter, no longer by the squared angle.
    let [a, b] = factors(vector).map(|[value, slope, bend]| [value, slope * s1, bend * s1 * s1 + slope * s2]);
    let p = [vector.cross(d1), vector.cross(d2), d1.cross(d2) + vector.cross(d3)];
    let [p0, p1, p2] = &p;
    let q = [vector.cross(p0), d1.cross(p0) + vector.cross(p1), d2.cross(p0) + d1.cross(p1) * 2.0 + vector.cross(p2)];
    let product = |[f0, f1, f2]: [f64; 3], [v0, v1, v2]: &[Vector3<f64>; 3]| {
        [v0 * f0, v0 * f1 + v1 * f0, v0 * f2 + v1 * (2.0 * f1) + v2 * f0]
    };
    let ([a0, a1, a2], [b0, b1, b2]) = (product(a, &p), product(b, &q));
    [d1 + a0 + b0, d2 + a1 + b1, d3 + a2 + b2]
}

/// The first two derivatives of a rotation vector (rad, below a whole turn) that turns with a speed of rotation and its
/// derivative: the inverse of [`speeds`].
pub(crate) fn of_speeds(vector: &Vector3<f64>, [speed, change]: &[Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
    let [[a, ..], [b, ..]] = factors(vector);
    let across = vector.cross_matrix();
    let jacobian = Matrix3::identity() + across * a + across * across * b;
    let Some(inverse) = jacobian.try_inverse() else { return [*speed, *change] };
    let first = inverse * speed;
    let [_, by_turning, _] = speeds(vector, &[first, Vector3::zeros(), Vector3::zeros()]);
    [first, inverse * (change - by_turning)]
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;

    use super::*;
    use arl_robot::kinematics::random::Random;

    fn random_vector(random: &mut Random, size: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| random.between(-size, size))
    }

    #[test]
    fn the_speed_is_how_the_rotation_changes() {
        let mut random = Random::new(17);
        for _ in 0..500 {
            let size = random.between(0.0, 2.5);
            let [v, d1, d2, d3] = [size, 1.0, 2.0, 3.0].map(|size| random_vector(&mut random, size));
            let at = |t: f64| v + d1 * t + d2 * (t * t / 2.0) + d3 * (t * t * t / 6.0);
            let speed = |t: f64| {
                let derivatives = [d1 + d2 * t + d3 * (t * t / 2.0), d2 + d3 * t, d3];
                speeds(&at(t), &derivatives)
            };
            let h = 1e-5;
            let turned = |from: f64, to: f64| {
                let rotation = |t: f64| UnitQuaternion::from_scaled_axis(at(t));
                (rotation(to) * rotation(from).inverse()).scaled_axis()
            };
            let [w, dw, ddw] = speed(0.0);
            assert!((turned(-h, h) / (2.0 * h) - w).norm() < 1e-7 * (1.0 + w.norm()));
            assert!(((speed(h)[0] - speed(-h)[0]) / (2.0 * h) - dw).norm() < 1e-6 * (1.0 + dw.norm()));
            assert!(((speed(h)[1] - speed(-h)[1]) / (2.0 * h) - ddw).norm() < 1e-6 * (1.0 + ddw.norm()));
            let [first, second] = of_speeds(&v, &[w, dw]);
            assert!((first - d1).norm() < 1e-9 && (second - d2).norm() < 1e-8);
        }
    }
}
