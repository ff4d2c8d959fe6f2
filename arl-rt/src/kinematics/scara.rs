//! Four axes: two arms that turn about z, a lift, a flange that turns about z.

use nalgebra::{Translation3, UnitQuaternion, Vector3};

use super::frame::Frame;
use super::{Axes, wrap_degrees};

/// The geometry of a SCARA robot in mm. At zero its flange frame points as the base.
#[derive(Clone, PartialEq, Debug)]
pub struct Scara {
    /// Length of the first arm.
    pub l1: f64,
    /// Length of the second arm.
    pub l2: f64,
    /// Height of the flange where j3 is 0.
    pub z0: f64,
}

/// Beyond this tilt (sine) a pose does not stand upright.
const UPRIGHT: f64 = 1e-6;

impl Scara {
    /// The flange's frame in the base, translation in mm.
    pub fn forward(&self, axes: &Axes) -> Frame {
        let [j1, j2, j3, j4, ..] = *axes;
        let (s1, c1) = j1.to_radians().sin_cos();
        let (s12, c12) = (j1 + j2).to_radians().sin_cos();
        Frame::from_parts(
            Translation3::new(self.l1 * c1 + self.l2 * c12, self.l1 * s1 + self.l2 * s12, self.z0 + j3),
            UnitQuaternion::from_axis_angle(&Vector3::z_axis(), (j1 + j2 + j4).to_radians()),
        )
    }

    /// 0 where j2 is 0 or more, else 4.
    pub fn cfg(&self, axes: &Axes) -> u8 {
        let [_, j2, ..] = *axes;
        if wrap_degrees(j2) < -1e-9 { 4 } else { 0 }
    }

    /// The axes for a flange frame (translation in mm) with hand `cfg`, 0 or 4. `None`: out of reach, or not upright.
    pub fn inverse(&self, flange: &Frame, cfg: u8) -> Option<Axes> {
        let rotation = flange.rotation.to_rotation_matrix();
        let tilt = rotation[(0, 2)].hypot(rotation[(1, 2)]);
        if tilt > UPRIGHT || rotation[(2, 2)] < 0.0 || !matches!(cfg, 0 | 4) {
            return None;
        }
        let [x, y, z]: [f64; 3] = flange.translation.vector.into();
        let (l1, l2) = (self.l1, self.l2);
        let cosine = (x * x + y * y - l1 * l1 - l2 * l2) / (2.0 * l1 * l2);
        let rest = 1.0 - cosine * cosine;
        if rest < -1e-12 {
            return None;
        }
        let sine = rest.max(0.0).sqrt();
        let sine = if cfg == 0 { sine } else { -sine };
        let j1 = y.atan2(x) - (l2 * sine).atan2(l1 + l2 * cosine);
        let j2 = sine.atan2(cosine);
        let heading = rotation[(1, 0)].atan2(rotation[(0, 0)]);
        let turn = |angle: f64| wrap_degrees(angle.to_degrees());
        Some([turn(j1), turn(j2), z - self.z0, turn(heading - j1 - j2), 0.0, 0.0])
    }

    /// How far, in mm, the pose is outside or inside the ring that the arms reach.
    pub fn beyond_reach(&self, flange: &Frame) -> f64 {
        let distance = flange.translation.vector.xy().norm();
        (distance - (self.l1 + self.l2)).max((self.l1 - self.l2).abs() - distance).max(0.0)
    }

    /// How clear the axes are of the singular points, where the arm is stretched or folded: the sine at the elbow.
    pub fn clearance(&self, axes: &Axes) -> f64 {
        let [_, j2, ..] = *axes;
        j2.to_radians().sin().abs()
    }
}
