//! Four axes: two arms that turn about z, a lift, a flange that turns about z.

use nalgebra::{Quaternion, Translation3, UnitQuaternion};

use super::angles::{atan2, sin_cos, wrap};
use super::frame::Frame;
use super::{Axes, wrap_degrees};

/// The geometry of a SCARA robot in mm. At zero its flange frame is oriented like the base.
#[derive(Clone, PartialEq, Debug)]
pub struct Scara {
    /// Length of the first arm.
    pub l1: f64,
    /// Length of the second arm.
    pub l2: f64,
    /// Height of the flange when j3 is 0.
    pub z0: f64,
}

/// Beyond this tilt (sine of half of it) a pose is not upright.
const UPRIGHT: f64 = 5e-7;

impl Scara {
    /// The flange's frame in the base, translation in mm.
    pub fn forward(&self, axes: &Axes) -> Frame {
        let [j1, j2, j3, j4, ..] = *axes;
        let ([s1, s12, half_sin, _], [c1, c12, half_cos, _]) = sin_cos([j1, j1 + j2, 0.5 * (j1 + j2 + j4), 0.0]);
        Frame::from_parts(
            Translation3::new(self.l1 * c1 + self.l2 * c12, self.l1 * s1 + self.l2 * s12, self.z0 + j3),
            UnitQuaternion::new_unchecked(Quaternion::new(half_cos, 0.0, 0.0, half_sin)),
        )
    }

    /// 0 if j2 is 0 or more, otherwise 4.
    pub fn cfg(&self, axes: &Axes) -> u8 {
        let [_, j2, ..] = *axes;
        if wrap_degrees(j2) < -1e-9 { 4 } else { 0 }
    }

    /// The axes for a flange frame (translation in mm) with hand `cfg`, 0 or 4; if the arm is folded upon itself, axis
    /// 1 stays as in `near`. `None` if the frame is out of reach or not upright.
    pub fn inverse(&self, flange: &Frame, cfg: u8, near: &Axes) -> Option<Axes> {
        if self.tilt(flange) > 0.0 || !matches!(cfg, 0 | 4) {
            return None;
        }
        let [x, y, z]: [f64; 3] = flange.translation.vector.into();
        let (l1, l2) = (self.l1, self.l2);
        let square = x * x + y * y;
        let cosine = (square - l1 * l1 - l2 * l2) / (2.0 * l1 * l2);
        let rest = 1.0 - cosine * cosine;
        if rest < -1e-12 {
            return None;
        }
        let (sine, cosine) = (rest.max(0.0).sqrt(), cosine.clamp(-1.0, 1.0));
        let sine = if cfg == 0 { sine } else { -sine };
        let q = flange.rotation.quaternion();
        let (along, beside) = (l1 + l2 * cosine, l2 * sine);
        let [found1, j2, half] = atan2([along * y - beside * x, sine, q.k], [along * x + beside * y, cosine, q.w]);
        let [near1, ..] = *near;
        let j1 = if square < 1e-14 { near1 } else { found1 };
        let [j1, j2, j4, _] = wrap([j1, j2, 2.0 * half - j1 - j2, 0.0]);
        Some([j1, j2, z - self.z0, j4, 0.0, 0.0])
    }

    /// The tilt of a flange frame from upright, in deg; 0 if it is only rounding.
    pub fn tilt(&self, flange: &Frame) -> f64 {
        let q = flange.rotation.quaternion();
        let half = (q.i * q.i + q.j * q.j).sqrt();
        if half <= UPRIGHT { 0.0 } else { 2.0 * libm::atan2(half, (q.w * q.w + q.k * q.k).sqrt()).to_degrees() }
    }

    /// The distance, in mm, of the pose outside or inside the ring that the arms reach.
    pub fn beyond_reach(&self, flange: &Frame) -> f64 {
        let distance = flange.translation.vector.xy().norm();
        (distance - (self.l1 + self.l2)).max((self.l1 - self.l2).abs() - distance).max(0.0)
    }

    /// How clear the axes are of the singular points, where the arm is stretched or folded: the sine at the elbow.
    pub fn clearance(&self, axes: &Axes) -> f64 {
        let [_, j2, ..] = *axes;
        libm::sin(j2.to_radians()).abs()
    }
}
