//! Frames and their six components: x, y, z in mm, a about z, b about the new y, c about the new x in deg.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

/// A frame or transform: rotation, and translation in mm.
pub type Frame = Isometry3<f64>;

/// Below this cosine of b, a and c turn about the same axis and c is taken as 0.
const GIMBAL_LOCK: f64 = 1e-9;

/// The frame of the components x, y, z (mm), a, b, c (deg).
pub fn frame([x, y, z, a, b, c]: [f64; 6]) -> Frame {
    let ((sa, ca), (sb, cb), (sc, cc)) = (half(a), half(b), half(c));
    let rotation = Quaternion::new(
        ca * cb * cc + sa * sb * sc,
        ca * cb * sc - sa * sb * cc,
        ca * sb * cc + sa * cb * sc,
        sa * cb * cc - ca * sb * sc,
    );
    Frame::from_parts(Translation3::new(x, y, z), UnitQuaternion::new_normalize(rotation))
}

fn half(angle: f64) -> (f64, f64) {
    libm::sincos(angle.to_radians() * 0.5)
}

/// The components x, y, z (mm), a, b, c (deg) of a frame: a and c above -180 to 180, b within -90..90, c = 0 where b is
/// 90 or -90.
pub fn frame_components(frame: &Frame) -> [f64; 6] {
    let rotation = frame.rotation.to_rotation_matrix();
    let r = |row: usize, column: usize| rotation[(row, column)];
    let level = libm::hypot(r(0, 0), r(1, 0));
    let b = libm::atan2(-r(2, 0), level);
    let (a, c) = if level < GIMBAL_LOCK {
        (libm::atan2(-r(0, 1), r(1, 1)), 0.0)
    } else {
        // c is measured after a is turned back, so that an imprecise a near the lock does not spoil the rotation.
        let a = libm::atan2(r(1, 0), r(0, 0));
        let (sa, ca) = libm::sincos(a);
        (a, libm::atan2(sa * r(0, 2) - ca * r(1, 2), ca * r(1, 1) - sa * r(0, 1)))
    };
    let [x, y, z] = frame.translation.vector.into();
    [x, y, z, half_turn(a.to_degrees()), b.to_degrees(), half_turn(c.to_degrees())]
}

/// Returns half a turn as 180, whatever its sign after rounding.
fn half_turn(angle: f64) -> f64 {
    if angle <= -180.0 + 1e-10 { angle + 360.0 } else { angle }
}
