//! Circles through three points.

use nalgebra::Vector3;

use crate::geometry::track::Arc;

/// Points closer than this, in mm, are the same.
const SAME_POINT_MM: f64 = 1e-6;
/// Three points whose angle has a smaller sine than this are on a line.
const COLLINEAR_SINE: f64 = 1e-9;

/// A circle with a sense of rotation.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Circle {
    /// In mm.
    centre: Vector3<f64>,
    /// A unit vector, about which the circle is traversed.
    normal: Vector3<f64>,
}

/// The circle through three points (mm) in their order; `None` where two are the same or all are on a line.
pub(crate) fn circle_through([start, via, end]: &[Vector3<f64>; 3]) -> Option<Circle> {
    let (to_via, to_end, rest) = (via - start, end - start, end - via);
    let lengths = [to_via.norm(), to_end.norm(), rest.norm()];
    if lengths.iter().any(|length| *length < SAME_POINT_MM) {
        return None;
    }
    let normal = to_via.cross(&to_end);
    let [a, b, _] = lengths;
    if normal.norm() < COLLINEAR_SINE * a * b {
        return None;
    }
    // The centre of the circumscribed circle, relative to the start.
    let to_centre = (normal.cross(&to_via) * b * b + to_end.cross(&normal) * a * a) / (2.0 * normal.norm_squared());
    // With this normal the second point always comes before the third.
    Some(Circle { centre: start + to_centre, normal: normal.normalize() })
}

impl Circle {
    /// The arc from one of its points to another (mm).
    pub(crate) fn arc(&self, from: &Vector3<f64>, to: &Vector3<f64>) -> Arc {
        let across = from - self.centre;
        let along = self.normal.cross(&across);
        let from_centre = to - self.centre;
        let angle = libm::atan2(from_centre.dot(&along), from_centre.dot(&across));
        let sweep = if angle < 0.0 { angle + std::f64::consts::TAU } else { angle };
        Arc { centre: self.centre, across, along, sweep }
    }
}

/// The arc from the first of three points (mm) over the second to the third; `None` where they define no circle.
pub(crate) fn arc_through(points: &[Vector3<f64>; 3]) -> Option<Arc> {
    let [start, _, end] = points;
    Some(circle_through(points)?.arc(start, end))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::track::Track;
    use arl_robot::kinematics::random::Random;

    #[test]
    fn it_passes_the_points_in_their_order() {
        let mut random = Random::new(71);
        for _ in 0..2000 {
            let mut point = || Vector3::from_fn(|_, _| random.between(-500.0, 500.0));
            let points = [point(), point(), point()];
            let arc = arc_through(&points).unwrap();
            let track = Track::Arc(arc);
            assert!((track.at(0.0) - points[0]).norm() < 1e-7 * arc.across.norm());
            assert!((track.at(1.0) - points[2]).norm() < 1e-7 * arc.across.norm());
            let nearest = (1..1000)
                .map(|step| (track.at(f64::from(step) / 1000.0) - points[1]).norm())
                .fold(f64::INFINITY, f64::min);
            assert!(nearest <= arc.across.norm() * arc.sweep / 1000.0, "{nearest} mm beside the point on the way");
            assert!((track.length() - arc.across.norm() * arc.sweep).abs() < 1e-9);
        }
    }

    #[test]
    fn points_on_a_line_make_no_circle() {
        let point = |x: f64| Vector3::new(x, 2.0 * x, -x);
        assert!(arc_through(&[point(0.0), point(1.0), point(2.0)]).is_none());
        assert!(arc_through(&[point(0.0), point(0.0), point(2.0)]).is_none());
        assert!(arc_through(&[point(0.0), point(1.0), point(0.0)]).is_none());
    }
}
