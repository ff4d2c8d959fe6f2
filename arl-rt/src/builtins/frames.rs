//! Frames and poses as transforms: products, inverses, displacements.
//!
//! A frame's angles are in deg: a about z, b about the new y, c about the new x. A component that depends on an unset
//! component of a pose is unset.

use crate::motion::is_unset;
use crate::values::{Frame, Pose, Tool, UNSET, Wobj};
use arl_robot::kinematics;
use nalgebra::{Matrix3, Vector3};
use std::ops::Mul;

pub use arl_robot::frames::{Carried, Mount, Rig, Setting, Unmoved};

/// Whether a component is unset or not finite, so that nothing can be computed from it.
pub(crate) fn is_open(component: f64) -> bool {
    is_unset(component) || !component.is_finite()
}

impl From<&Tool> for Mount {
    fn from(tool: &Tool) -> Self {
        Self { frame: (&tool.t_frame).into(), on_flange: !tool.stationary }
    }
}

impl From<&Wobj> for Mount {
    fn from(wobj: &Wobj) -> Self {
        Self { frame: (&wobj.w_frame).into(), on_flange: wobj.robhold }
    }
}

impl From<&Frame> for kinematics::Frame {
    fn from(frame: &Frame) -> Self {
        kinematics::frame(frame.components())
    }
}

/// Angles of turns that are closer to zero than this, deg, are rounding noise.
const ANGLE_NOISE: f64 = 1e-10;

/// Below this cosine of b, the first and the last turn are about the same axis.
const GIMBAL_LOCK: f64 = 1e-10;

/// The sine and the cosine of an angle in deg; multiples of 90 give exact values.
pub fn sin_cos(angle: f64) -> (f64, f64) {
    let turned = angle % 360.0;
    let quarter = (turned / 90.0).round();
    let (sin, cos) = libm::sincos((turned - 90.0 * quarter).to_radians());
    match (quarter as i32).rem_euclid(4) {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// The rotation of the angles a about z, b about the new y, c about the new x, deg.
pub fn rotation([a, b, c]: [f64; 3]) -> Matrix3<f64> {
    let ((sa, ca), (sb, cb), (sc, cc)) = (sin_cos(a), sin_cos(b), sin_cos(c));
    #[rustfmt::skip]
    let matrix = Matrix3::new(
        ca * cb, ca * sb * sc - sa * cc, ca * sb * cc + sa * sc,
        sa * cb, sa * sb * sc + ca * cc, sa * sb * cc - ca * sc,
        -sb, cb * sc, cb * cc,
    );
    matrix
}

/// The angles a, b, c of a rotation, deg: a and c above -180 to 180, b from -90 to 90, c = 0 where b is 90 or -90.
pub fn angles(rotation: &Matrix3<f64>) -> [f64; 3] {
    let r = |row: usize, column: usize| rotation[(row, column)];
    let level = libm::hypot(r(0, 0), r(1, 0));
    let (a, b, c) = if level < GIMBAL_LOCK {
        (libm::atan2(-r(0, 1), r(1, 1)), (-r(2, 0)).signum() * std::f64::consts::FRAC_PI_2, 0.0)
    } else {
        // As a is turned back first, an imprecise a near the lock does not spoil the rotation.
        let a = libm::atan2(r(1, 0), r(0, 0));
        let (sa, ca) = libm::sincos(a);
        (a, libm::atan2(-r(2, 0), level), libm::atan2(sa * r(0, 2) - ca * r(1, 2), ca * r(1, 1) - sa * r(0, 1)))
    };
    [a, b, c].map(|angle| tidy(angle.to_degrees()))
}

fn tidy(angle: f64) -> f64 {
    if angle.abs() < ANGLE_NOISE {
        0.0
    } else if angle < -180.0 + ANGLE_NOISE {
        180.0
    } else {
        angle
    }
}

/// The translation and the rotation of a frame or pose; a part with unset components is absent.
#[derive(Clone, Copy, Debug)]
struct Transform {
    place: Option<Vector3<f64>>,
    turn: Option<Matrix3<f64>>,
}

impl Transform {
    fn of_frame(frame: &Frame) -> Self {
        Self { place: Some(Vector3::new(frame.x, frame.y, frame.z)), turn: Some(rotation([frame.a, frame.b, frame.c])) }
    }

    fn of_pose(pose: &Pose) -> Self {
        let [place, turn] = [[pose.x, pose.y, pose.z], [pose.a, pose.b, pose.c]].map(set);
        Self { place: place.map(Vector3::from), turn: turn.map(rotation) }
    }

    /// The other transform, seen through this one.
    fn then(&self, other: &Transform) -> Transform {
        let place = match (self.place, self.turn, other.place) {
            (Some(origin), Some(turn), Some(place)) => Some(moved(&origin, &turn, &place)),
            _ => None,
        };
        Transform { place, turn: self.turn.zip(other.turn).map(|(outer, inner)| outer * inner) }
    }

    fn inverse(&self) -> Transform {
        let turn = self.turn.map(|turn| turn.transpose());
        let place = self.place.zip(turn).map(|(place, turn)| moved(&Vector3::zeros(), &turn, &-place));
        Transform { place, turn }
    }

    fn components(&self) -> [f64; 6] {
        let [x, y, z] = self.place.map_or([UNSET; 3], Into::into);
        let [a, b, c] = self.turn.map_or([UNSET; 3], |turn| angles(&turn));
        [x, y, z, a, b, c]
    }
}

/// The three components, if all of them are set.
fn set(components: [f64; 3]) -> Option<[f64; 3]> {
    if components.contains(&UNSET) { None } else { Some(components) }
}

/// `origin + turn * place`; the remainder of terms that cancel each other becomes zero.
fn moved(origin: &Vector3<f64>, turn: &Matrix3<f64>, place: &Vector3<f64>) -> Vector3<f64> {
    let sum = origin + turn * place;
    let size = origin.abs() + turn.abs() * place.abs();
    sum.zip_map(&size, |sum, size| if sum.abs() <= 4.0 * f64::EPSILON * size { 0.0 } else { sum })
}

impl Frame {
    /// The frame of the components x, y, z (mm), a, b, c (deg).
    pub const fn of_components([x, y, z, a, b, c]: [f64; 6]) -> Self {
        Self { x, y, z, a, b, c }
    }

    /// The components x, y, z (mm), a, b, c (deg).
    pub const fn components(&self) -> [f64; 6] {
        [self.x, self.y, self.z, self.a, self.b, self.c]
    }

    /// The inverse: this frame's parent, seen from it.
    pub fn inverse(&self) -> Frame {
        Frame::of_components(Transform::of_frame(self).inverse().components())
    }
}

impl Pose {
    /// The components x, y, z (mm), a, b, c (deg).
    pub const fn components(&self) -> [f64; 6] {
        [self.x, self.y, self.z, self.a, self.b, self.c]
    }

    /// The same target with the components x, y, z (mm), a, b, c (deg) instead of its own.
    pub const fn with_components(self, [x, y, z, a, b, c]: [f64; 6]) -> Pose {
        Pose { x, y, z, a, b, c, ..self }
    }
}

impl Mul for Frame {
    type Output = Frame;

    /// The right frame, seen through the left one.
    fn mul(self, other: Frame) -> Frame {
        Frame::of_components(Transform::of_frame(&self).then(&Transform::of_frame(&other)).components())
    }
}

impl Mul<Pose> for Frame {
    type Output = Pose;

    /// The pose, seen through the frame. Its `cfg`, `turn` and external axes stay.
    fn mul(self, pose: Pose) -> Pose {
        pose.with_components(Transform::of_frame(&self).then(&Transform::of_pose(&pose)).components())
    }
}

impl Mul<Frame> for Pose {
    type Output = Pose;

    /// The frame, seen through the pose. The pose's `cfg`, `turn` and external axes stay.
    fn mul(self, frame: Frame) -> Pose {
        self.with_components(Transform::of_pose(&self).then(&Transform::of_frame(&frame)).components())
    }
}

impl Mul for Pose {
    type Output = Pose;

    /// The right pose, seen through the left one. The right one's `cfg`, `turn` and external axes stay.
    fn mul(self, other: Pose) -> Pose {
        other.with_components(Transform::of_pose(&self).then(&Transform::of_pose(&other)).components())
    }
}

/// The inverse of a pose. `cfg`, `turn` and external axes stay.
pub fn poseinv(p: Pose) -> Pose {
    p.with_components(Transform::of_pose(&p).inverse().components())
}

/// A target moved by `dx`, `dy`, `dz` (mm) along the axes of its workpiece, and turned about itself by `rz`, `ry`, `rx`
/// (deg) about those axes: z first, then the new y, then the new x.
pub fn offset(p: Pose, dx: f64, dy: f64, dz: f64, rz: f64, ry: f64, rx: f64) -> Pose {
    let shift = |place: f64, by: f64| if place == UNSET { UNSET } else { place + by };
    let turned = [rz, ry, rx];
    let [a, b, c] = if turned == [0.0; 3] {
        [p.a, p.b, p.c]
    } else {
        set([p.a, p.b, p.c]).map_or([UNSET; 3], |own| angles(&(rotation(turned) * rotation(own))))
    };
    p.with_components([shift(p.x, dx), shift(p.y, dy), shift(p.z, dz), a, b, c])
}

/// A target moved by `dx`, `dy`, `dz` (mm) and turned by `rz`, `ry`, `rx` (deg: z first, then the new y, then the new
/// x) along and about the axes of its tool.
pub fn reltool(p: Pose, dx: f64, dy: f64, dz: f64, rz: f64, ry: f64, rx: f64) -> Pose {
    let moved = Transform::of_pose(&p).then(&Transform::of_frame(&Frame { x: dx, y: dy, z: dz, a: rz, b: ry, c: rx }));
    let [x, y, z, a, b, c] = moved.components();
    let [x, y, z] = if [dx, dy, dz] == [0.0; 3] { [p.x, p.y, p.z] } else { [x, y, z] };
    let [a, b, c] = if [rz, ry, rx] == [0.0; 3] { [p.a, p.b, p.c] } else { [a, b, c] };
    p.with_components([x, y, z, a, b, c])
}

#[cfg(test)]
mod tests;
