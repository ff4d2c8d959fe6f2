//! The little geometry that the checks of traces need.

pub(crate) type Vector = [f64; 3];

pub(crate) fn minus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] - b[i])
}

/// `a + b * scale`.
pub(crate) fn plus(a: Vector, b: Vector, scale: f64) -> Vector {
    [0, 1, 2].map(|i| a[i] + b[i] * scale)
}

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

pub(crate) fn distance(a: Vector, b: Vector) -> f64 {
    norm(minus(a, b))
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Distance of a point from the piece of line between two others.
pub(crate) fn off_line(from: Vector, to: Vector, at: Vector) -> f64 {
    let (way, here) = (minus(to, from), minus(at, from));
    let length = dot(way, way);
    let share = if length > 1e-12 { (dot(here, way) / length).clamp(0.0, 1.0) } else { 0.0 };
    norm(plus(here, way, -share))
}

/// The circle through three points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Circle {
    center: Vector,
    normal: Vector,
    radius: f64,
}

impl Circle {
    pub(crate) fn through(a: Vector, b: Vector, c: Vector) -> Circle {
        let (u, v) = (minus(b, a), minus(c, a));
        let normal = cross(u, v);
        let square = dot(normal, normal);
        let to_center = plus(cross(normal, u).map(|x| x * dot(v, v)), cross(v, normal), dot(u, u));
        let to_center = to_center.map(|x| x / (2.0 * square));
        Circle { center: plus(a, to_center, 1.0), normal: normal.map(|x| x / square.sqrt()), radius: norm(to_center) }
    }

    /// Distance of a point from the circle.
    pub(crate) fn off(&self, at: Vector) -> f64 {
        let here = minus(at, self.center);
        let height = dot(here, self.normal);
        (norm(plus(here, self.normal, -height)) - self.radius).hypot(height)
    }

    pub(crate) fn radius(&self) -> f64 {
        self.radius
    }
}

/// How far in deg two orientations are apart, each given by turns about z, the new y and the new x in deg.
pub(crate) fn turned(a: Vector, b: Vector) -> f64 {
    let (a, b) = (matrix(a), matrix(b));
    // The sine of half the angle from what the axes differ by: exact for small angles.
    let square: f64 = (0..3).map(|i| dot(minus(a[i], b[i]), minus(a[i], b[i]))).sum();
    2.0 * (square / 8.0).sqrt().min(1.0).asin().to_degrees()
}

fn matrix(turns: Vector) -> [Vector; 3] {
    let [(sa, ca), (sb, cb), (sc, cc)] = turns.map(|turn| turn.to_radians().sin_cos());
    [
        [ca * cb, ca * sb * sc - sa * cc, ca * sb * cc + sa * sc],
        [sa * cb, sa * sb * sc + ca * cc, sa * sb * cc - ca * sc],
        [-sb, cb * sc, cb * cc],
    ]
}
