//! Frames from points, without a robot. Lengths are mm.

use std::fmt;

use nalgebra::{Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};

use arl_robot::kinematics::Frame;

/// Points nearer to each other than this, mm, define no direction: a teaching error of a tenth of a millimetre would
/// turn it by several degrees.
const NEAREST: f64 = 1.0;

/// A third point whose direction from the first is this near to that of the second, deg, defines no plane.
const FLATTEST: f64 = 1.0;

/// Below this sine of the angle between z and the world's x axis, x cannot be derived from the latter.
const ALONG_X: f64 = 1e-3;

/// The reason why points define no frame. Points are counted from 1.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Flaw {
    /// Two points are nearer to each other than [`NEAREST`].
    Near { points: (u8, u8), distance: f64 },
    /// The points are nearly in a line: the angle at the first is below [`FLATTEST`].
    InLine { angle: f64 },
}

impl fmt::Display for Flaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Flaw::Near { points: (one, other), distance } => {
                write!(
                    f,
                    "points {one} and {other} are {distance:.3} mm apart, but must be at least {NEAREST} mm apart"
                )
            }
            Flaw::InLine { angle } => write!(
                f,
                "the points are nearly in a line: seen from point 1, point 3 is {angle:.3} deg off the line through \
                 point 2, but must be at least {FLATTEST} deg off it"
            ),
        }
    }
}

/// The frame with its origin at the first point, the second on its +x axis, and the third in its xy plane on the +y
/// side.
///
/// # Errors
/// The points are too close together, or in a line.
pub(super) fn through([origin, on_x, beside]: [Point3<f64>; 3]) -> Result<Frame, Flaw> {
    let x = direction(&origin, &on_x, 2)?;
    let across = direction(&origin, &beside, 3)?;
    let normal = x.cross(&across);
    let sine = normal.norm();
    if sine < libm::sin(FLATTEST.to_radians()) {
        return Err(Flaw::InLine { angle: libm::asin(sine.min(1.0)).to_degrees() });
    }
    let z = normal / sine;
    Ok(Frame::from_parts(Translation3::from(origin), axes(x, z.cross(&x), z)))
}

/// The unit vector from the first point to another one, which has the number `number`.
fn direction(first: &Point3<f64>, other: &Point3<f64>, number: u8) -> Result<Vector3<f64>, Flaw> {
    let difference = other - first;
    let distance = difference.norm();
    if distance < NEAREST { Err(Flaw::Near { points: (1, number), distance }) } else { Ok(difference / distance) }
}

/// The rotation whose axes point along these unit vectors.
pub(super) fn axes(x: Vector3<f64>, y: Vector3<f64>, z: Vector3<f64>) -> UnitQuaternion<f64> {
    let matrix = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, y, z]));
    UnitQuaternion::from_rotation_matrix(&matrix)
}

/// The orientation with this unit vector as z, and x as near to the world's x axis as possible; if z is along that
/// axis, y is as near to the world's y axis as possible.
pub(super) fn around(z: Vector3<f64>) -> UnitQuaternion<f64> {
    let x = Vector3::x() - z * z.x;
    if x.norm() > ALONG_X {
        let x = x.normalize();
        return axes(x, z.cross(&x), z);
    }
    let y = (Vector3::y() - z * z.y).normalize();
    axes(y.cross(&z), y, z)
}

/// The triangle of points that defines no frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Triangle {
    /// The points as known in the frame.
    Known,
    /// The points as found in the world.
    Found,
}

/// The frame in which points that were `found` have the coordinates `known`, and the largest distance, in mm, of a
/// point from its expected position. The misfit is distributed over the points by least squares.
///
/// # Errors
/// Points of one of the triangles are too close together, or in a line.
pub(super) fn fitted(known: [Point3<f64>; 3], found: [Point3<f64>; 3]) -> Result<(Frame, f64), (Triangle, Flaw)> {
    // The planes of both triangles are made to coincide, which leaves a problem in the plane.
    let known_plane = through(known).map_err(|flaw| (Triangle::Known, flaw))?;
    let found_plane = through(found).map_err(|flaw| (Triangle::Found, flaw))?;
    let (from, from_middle) = in_plane(&known_plane, &known);
    let (to, to_middle) = in_plane(&found_plane, &found);
    let pairs = || from.iter().zip(&to);
    let cosine: f64 = pairs().map(|(a, b)| a.x * b.x + a.y * b.y).sum();
    let sine: f64 = pairs().map(|(a, b)| a.x * b.y - a.y * b.x).sum();
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), libm::atan2(sine, cosine));
    let between = Translation3::from(to_middle) * turn * Translation3::from(-from_middle);
    let frame = found_plane * between * known_plane.inverse();
    let off = known.iter().zip(&found).map(|(a, b)| (frame * a - b).norm()).fold(0.0, f64::max);
    Ok((frame, off))
}

/// The points relative to their centre, in a frame in whose xy plane they lie; and that centre.
fn in_plane(plane: &Frame, points: &[Point3<f64>; 3]) -> ([Vector3<f64>; 3], Vector3<f64>) {
    let seen = points.map(|point| plane.inverse_transform_point(&point).coords);
    let middle = seen.iter().sum::<Vector3<f64>>() / 3.0;
    (seen.map(|point| point - middle), middle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_robot::kinematics::frame;
    use arl_robot::kinematics::random::Random;

    fn close(a: &Frame, b: &Frame) {
        assert!((a.translation.vector - b.translation.vector).norm() < 1e-9, "{a} {b}");
        assert!(a.rotation.angle_to(&b.rotation) < 1e-9, "{a} {b}");
    }

    fn place(random: &mut Random) -> Frame {
        let mut number = |size: f64| random.between(-size, size);
        frame([number(900.0), number(900.0), number(900.0), number(180.0), number(90.0), number(180.0)])
    }

    #[test]
    fn three_points_of_a_frame_give_it_back() {
        let mut random = Random::new(5);
        for _ in 0..500 {
            let expected = place(&mut random);
            let (far, along, side) =
                (random.between(2.0, 900.0), random.between(-50.0, 50.0), random.between(2.0, 400.0));
            let points = [Point3::origin(), Point3::new(far, 0.0, 0.0), Point3::new(along, side, 0.0)];
            close(&through(points.map(|point| expected * point)).unwrap(), &expected);
        }
    }

    #[test]
    fn points_too_near_or_in_a_line_are_refused() {
        let at = |x: f64, y: f64| Point3::new(100.0 + x, 50.0 + y, 3.0);
        assert!(through([at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)]).is_ok());
        assert_eq!(
            through([at(0.0, 0.0), at(0.5, 0.0), at(0.0, 1.0)]),
            Err(Flaw::Near { points: (1, 2), distance: 0.5 })
        );
        let Err(Flaw::Near { points: (1, 3), .. }) = through([at(0.0, 0.0), at(10.0, 0.0), at(0.0, 0.5)]) else {
            panic!()
        };
        assert!(through([at(0.0, 0.0), at(100.0, 0.0), at(50.0, 0.9)]).is_ok());
        let Err(Flaw::InLine { angle }) = through([at(0.0, 0.0), at(100.0, 0.0), at(50.0, 0.8)]) else { panic!() };
        assert!((angle - 0.917).abs() < 1e-3);
        assert!(through([at(0.0, 0.0), at(100.0, 0.0), at(-50.0, 0.1)]).is_err());
        assert!(Flaw::InLine { angle }.to_string().contains("0.917 deg"));
    }

    #[test]
    fn coordinates_that_fit_give_the_frame_exactly() {
        let mut random = Random::new(6);
        for _ in 0..500 {
            let expected = place(&mut random);
            let known = [(); 3].map(|()| place(&mut random).translation.vector.into());
            let Ok((found, off)) = fitted(known, known.map(|point| expected * point)) else { continue };
            close(&found, &expected);
            assert!(off < 1e-9);
        }
    }

    #[test]
    fn what_does_not_fit_is_spread_over_the_points() {
        let known = [Point3::origin(), Point3::new(100.0, 0.0, 0.0), Point3::new(0.0, 100.0, 0.0)];
        let found = [Point3::origin(), Point3::new(103.0, 0.0, 0.0), Point3::new(0.0, 103.0, 0.0)];
        let (frame, off) = fitted(known, found).unwrap();
        close(&frame, &Frame::translation(1.0, 1.0, 0.0));
        assert!((off - 5f64.sqrt()).abs() < 1e-9, "{off}");
        // No slightly different frame is better.
        let cost = |frame: &Frame| known.iter().zip(&found).map(|(a, b)| (frame * a - b).norm_squared()).sum::<f64>();
        for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
            for size in [1e-3, -1e-3] {
                let turned = frame * Frame::rotation(axis * size);
                let moved = frame * Frame::from(Translation3::from(axis * size));
                assert!(cost(&turned) > cost(&frame) && cost(&moved) > cost(&frame));
            }
        }
        assert!(matches!(fitted([known[0]; 3], found), Err((Triangle::Known, _))));
        assert!(matches!(fitted(known, [known[0]; 3]), Err((Triangle::Found, _))));
    }

    #[test]
    fn an_orientation_around_z_is_near_the_worlds() {
        let same = around(Vector3::z());
        assert!(same.angle() < 1e-12);
        let mut random = Random::new(7);
        for _ in 0..200 {
            let z = place(&mut random).rotation * Vector3::z();
            let turned = around(z);
            assert!((turned * Vector3::z() - z).norm() < 1e-12);
            assert!((turned * Vector3::y()).x.abs() < 1e-12 && (turned * Vector3::x()).x > 0.0);
        }
        for z in [Vector3::x(), -Vector3::x()] {
            let turned = around(z);
            assert!((turned * Vector3::z() - z).norm() < 1e-12);
            assert!((turned * Vector3::y() - Vector3::y()).norm() < 1e-12);
        }
    }
}
