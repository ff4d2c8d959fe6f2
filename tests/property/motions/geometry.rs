//! The little geometry that the checks of traces need.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

pub(crate) type Vector = Vector3<f64>;
pub(crate) type Frame = Isometry3<f64>;

/// Of x, y, z in mm and turns about z, the new y and the new x in deg.
pub(crate) fn frame([x, y, z, a, b, c]: [f64; 6]) -> Frame {
    let turn = UnitQuaternion::from_euler_angles(c.to_radians(), b.to_radians(), a.to_radians());
    Frame::from_parts(Translation3::new(x, y, z), turn)
}

/// A frame with so much added to each of its components.
pub(crate) fn shifted(of: &Frame, shift: &[f64; 6]) -> Frame {
    let (c, b, a) = of.rotation.euler_angles();
    let place = of.translation.vector;
    let now = [place.x, place.y, place.z, a.to_degrees(), b.to_degrees(), c.to_degrees()];
    frame(std::array::from_fn(|i| now[i] + shift[i]))
}

/// How far a frame's origin is from another's.
pub(crate) fn distance(a: &Frame, b: &Frame) -> f64 {
    (a.translation.vector - b.translation.vector).norm()
}

/// By how much frames are turned against each other, in deg.
pub(crate) fn turned(a: &Frame, b: &Frame) -> f64 {
    a.rotation.angle_to(&b.rotation).to_degrees()
}

/// The share of the piece of line between two points that is nearest to another.
pub(crate) fn share_of_line(from: &Vector, to: &Vector, at: &Vector) -> f64 {
    let (direction, here) = (to - from, at - from);
    let square = direction.norm_squared();
    if square > 1e-12 { (here.dot(&direction) / square).clamp(0.0, 1.0) } else { 0.0 }
}

/// The circle through three points, from the first to the last.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Circle {
    from: Vector,
    center: Vector,
    normal: Vector,
    pub(crate) radius: f64,
}

impl Circle {
    pub(crate) fn through(a: Vector, b: Vector, c: Vector) -> Circle {
        let (u, v) = (b - a, c - a);
        let normal = u.cross(&v);
        let square = normal.norm_squared();
        let to_center = (normal.cross(&u) * v.norm_squared() + v.cross(&normal) * u.norm_squared()) / (2.0 * square);
        Circle { from: a, center: a + to_center, normal: normal / square.sqrt(), radius: to_center.norm() }
    }

    /// Distance of a point from the circle.
    pub(crate) fn off(&self, at: &Vector) -> f64 {
        let here = at - self.center;
        let height = here.dot(&self.normal);
        ((here - self.normal * height).norm() - self.radius).hypot(height)
    }

    /// The angle from the first point to another, in rad, 0 to 2 pi.
    fn angle(&self, at: &Vector) -> f64 {
        let (start, here) = (self.from - self.center, at - self.center);
        let angle = self.normal.dot(&start.cross(&here)).atan2(start.dot(&here));
        if angle < 0.0 { angle + std::f64::consts::TAU } else { angle }
    }

    /// The length of the arc from the first point to another.
    pub(crate) fn length(&self, to: &Vector) -> f64 {
        self.radius * self.angle(to)
    }
}
