//! The last three axes of a six-axis robot: a spherical wrist that turns about z, y and z again.

use nalgebra::{Matrix3, Vector3};

use super::angles::sin_cos;

/// Below this sine of the middle angle the first angle is open, and keeps its value.
const SINGULAR: f64 = 1e-10;

/// The three wrist angles, each as sine and cosine (or a multiple of them): the solution whose middle angle is
/// positive.
#[derive(Clone, Copy)]
pub(super) struct Hand {
    pub(super) t4: (f64, f64),
    pub(super) t5: (f64, f64),
    pub(super) t6: (f64, f64),
    /// Whether the first angle is open: then it is `near4`, and the third angle belongs to that.
    pub(super) open: bool,
}

/// The wrist angles for `rotation` on an arm at `t1` (about z) and `t23` (about y), each given by sine and cosine.
/// `near4` (deg) is the first angle if the middle one is 0.
#[inline]
pub(super) fn hand(rotation: &Matrix3<f64>, t1: (f64, f64), t23: (f64, f64), near4: f64) -> Hand {
    let ((s1, c1), (s23, c23)) = (t1, t23);
    // Columns of Ry(-t23) Rz(-t1) R.
    let turned = |column: usize| {
        let [x, y, z]: [f64; 3] = rotation.column(column).into_owned().into();
        let along = c1 * x + s1 * y;
        Vector3::new(c23 * along - s23 * z, c1 * y - s1 * x, s23 * along + c23 * z)
    };
    let (first, second, third) = (turned(0), turned(1), turned(2));
    let sine = (third.x * third.x + third.y * third.y).sqrt();
    let open = sine < SINGULAR;
    let (s4, c4) = if open {
        let ([s4], [c4]) = sin_cos([near4]);
        (s4, c4)
    } else {
        let by_sine = 1.0 / sine;
        (third.y * by_sine, third.x * by_sine)
    };
    // The other two angles belong to the chosen t4, so that together they are exact also near the singular point.
    Hand {
        t4: (s4, c4),
        t5: (c4 * third.x + s4 * third.y, third.z),
        t6: (c4 * first.y - s4 * first.x, c4 * second.y - s4 * second.x),
        open,
    }
}
