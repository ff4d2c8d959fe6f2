//! The last three axes of a six-axis robot: a spherical wrist that turns about z, y and z again.

use nalgebra::{Matrix3, Vector3};

/// Below this sine of the middle angle the first angle is open, and stays where it was.
const SINGULAR: f64 = 1e-10;

/// The wrist angles in rad for `rotation` behind an arm that stands at `t1` (about z) and `t23` (about y): the solution
/// whose middle angle is positive. `near4` is the first angle where the middle one is 0.
pub(super) fn wrist_angles(rotation: &Matrix3<f64>, t1: (f64, f64), t23: (f64, f64), near4: f64) -> [f64; 3] {
    let ((s1, c1), (s23, c23)) = (t1, t23);
    // Columns of Ry(-t23) Rz(-t1) R.
    let turned = |column: usize| {
        let [x, y, z]: [f64; 3] = rotation.column(column).into_owned().into();
        let along = c1 * x + s1 * y;
        Vector3::new(c23 * along - s23 * z, c1 * y - s1 * x, s23 * along + c23 * z)
    };
    let (first, second, third) = (turned(0), turned(1), turned(2));
    let sine = third.x.hypot(third.y);
    let (t4, (s4, c4)) = if sine < SINGULAR {
        (near4, near4.sin_cos())
    } else {
        (third.y.atan2(third.x), (third.y / sine, third.x / sine))
    };
    // The other two angles belong to the t4 that was taken, so that together they are exact also near the singular point.
    let t5 = (c4 * third.x + s4 * third.y).atan2(third.z);
    let t6 = (c4 * first.y - s4 * first.x).atan2(c4 * second.y - s4 * second.x);
    [t4, t5, t6]
}
