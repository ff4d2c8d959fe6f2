//! The frame that moves along a path: x forward, y to the left, z away from where the tool points.

use nalgebra::{UnitQuaternion, Vector3};

use crate::command::error::PlanError;
use crate::geometry::quintic::{Knot, Quintic};
use crate::geometry::rotation;
use crate::geometry::tcp_path::TcpPath;

/// A path shorter than this, in mm, has no direction.
const NO_LENGTH: f64 = 1e-6;
/// Below this sine of the angle between tool and path, no plane across the path is defined.
const PARALLEL: f64 = 1e-3;

/// A value with its first three derivatives by the path parameter.
pub(crate) type Rates = [Vector3<f64>; 4];

/// A rotation: its speed in rad per unit of the path parameter, and the first two derivatives of that.
pub(crate) type Turning = [Vector3<f64>; 3];

/// The frame of a path: x along it, y across x and the tool's z axis, z across x and y (manual 3.2.11.2).
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct PathFrame {
    start: UnitQuaternion<f64>,
    turns: Turns,
}

/// How the frame of a path turns.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Turns {
    /// With a line or a circle and, about the path, evenly with the tool.
    Evenly {
        /// Rotation of the path, in rad per unit about an axis of the base.
        path: Vector3<f64>,
        /// Rotation of the frame about the path due to the tool, in rad per unit.
        roll: f64,
    },
    /// From the direction at the start to that at the end of a segment of a spline: a rotation vector in rad about axes
    /// of the base. Where segments meet, the frame turns evenly, which their directions themselves do not: otherwise
    /// acceleration would jump there.
    Smoothly(Quintic<3>),
}

impl PathFrame {
    /// The frame of a path of the TCP; `None` where the path has no direction.
    ///
    /// # Errors
    /// The tool points along the path at its start or its end.
    pub(crate) fn along(curve: &TcpPath) -> Result<Option<Self>, PlanError> {
        let Some(turning) = curve.track.even_turning() else { return Self::smoothly(curve).map(Some) };
        let tangent = |at: f64| curve.track.derivative(1, at);
        if tangent(0.0).norm() < NO_LENGTH {
            return Ok(None);
        }
        let axes = |at: f64| {
            let (x, tool) = (tangent(at).normalize(), curve.rotation(at) * Vector3::z());
            let y = x.cross(&tool);
            if y.norm() < PARALLEL { Err(PlanError::ToolAlongPath) } else { Ok((x, y.normalize())) }
        };
        let ((x, y), (_, last_y)) = (axes(0.0)?, axes(1.0)?);
        let z = x.cross(&y);
        let start = UnitQuaternion::from_matrix(&nalgebra::Matrix3::from_columns(&[x, y, z]));
        let carried = UnitQuaternion::from_scaled_axis(turning);
        let (y, z) = (carried * y, carried * z);
        let roll = libm::atan2(last_y.dot(&z), last_y.dot(&y));
        Ok(Some(Self { start, turns: Turns::Evenly { path: turning, roll } }))
    }

    /// The frame of a segment of a spline.
    fn smoothly(curve: &TcpPath) -> Result<Self, PlanError> {
        let ((start, first), (end, last)) = (directed(curve, 0.0)?, directed(curve, 1.0)?);
        let turned = (end * start.inverse()).scaled_axis();
        let knot = |value: Vector3<f64>, speed: Vector3<f64>| {
            let [first, second] = rotation::of_speeds(&value, &[speed, Vector3::zeros()]);
            Knot { value: value.into(), first: first.into(), second: second.into() }
        };
        let turns = Turns::Smoothly(Quintic::between(&knot(Vector3::zeros(), first), &knot(turned, last)));
        Ok(Self { start, turns })
    }

    /// Its orientation in the base.
    pub(crate) fn rotation(&self, at: f64) -> UnitQuaternion<f64> {
        match &self.turns {
            Turns::Evenly { path, roll } => {
                let roll = UnitQuaternion::from_scaled_axis(Vector3::x() * (roll * at));
                UnitQuaternion::from_scaled_axis(path * at) * self.start * roll
            }
            Turns::Smoothly(turned) => UnitQuaternion::from_scaled_axis(turned.at(at).into()) * self.start,
        }
    }

    /// The rotation of the frame.
    pub(crate) fn turning(&self, at: f64) -> Turning {
        match &self.turns {
            Turns::Evenly { path, roll } => {
                let ahead = UnitQuaternion::from_scaled_axis(path * at) * self.start * Vector3::x() * *roll;
                let first = path.cross(&ahead);
                [path + ahead, first, path.cross(&first)]
            }
            Turns::Smoothly(turned) => {
                let derivatives = [1, 2, 3].map(|order| turned.derivative(order, at).into());
                rotation::speeds(&turned.at(at).into(), &derivatives)
            }
        }
    }
}

/// The axes along a path of the TCP at `at`, and their speed of rotation there, in rad per unit.
fn directed(curve: &TcpPath, at: f64) -> Result<(UnitQuaternion<f64>, Vector3<f64>), PlanError> {
    /// A vector scaled to length 1, with its derivative.
    fn unit(vector: Vector3<f64>, change: Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let (length, unit) = (vector.norm(), vector.normalize());
        (unit, (change - unit * unit.dot(&change)) / length)
    }
    // Splines end where they turn back, so that they have a direction at each point.
    let tangent = curve.track.derivative(1, at);
    let (x, dx) = unit(tangent, curve.track.derivative(2, at));
    let tool = curve.rotation(at) * Vector3::z();
    let [turning, ..] = curve.rotation_rates(at);
    let across = x.cross(&tool);
    // A value that is not a number defines no side either.
    if across.norm().is_nan() || across.norm() < PARALLEL {
        return Err(PlanError::ToolAlongPath);
    }
    let (y, dy) = unit(across, dx.cross(&tool) + x.cross(&turning.cross(&tool)));
    let (z, dz) = (x.cross(&y), dx.cross(&y) + x.cross(&dy));
    let rotation = UnitQuaternion::from_matrix(&nalgebra::Matrix3::from_columns(&[x, y, z]));
    Ok((rotation, (x.cross(&dx) + y.cross(&dy) + z.cross(&dz)) / 2.0))
}

/// A vector given in rotating axes, with its derivatives there, expressed in the base.
pub(crate) fn carried(rotation: &UnitQuaternion<f64>, [w, w1, w2]: &Turning, local: &Rates) -> Rates {
    let [v, v1, v2, v3] = local.map(|vector| rotation * vector);
    // Written with a prime in textbooks: the derivative of each of these in the base.
    let (d, d1, d2) = (w.cross(&v) + v1, w.cross(&v1) + v2, w.cross(&v2) + v3);
    let second = w1.cross(&v) + w.cross(&d) + d1;
    let second1 = w1.cross(&v1) + w.cross(&d1) + d2;
    let third = w2.cross(&v) + w1.cross(&d) * 2.0 + w.cross(&second) + second1;
    [v, d, second, third]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_the_place() {
        let frame = PathFrame {
            start: UnitQuaternion::from_euler_angles(0.3, -0.4, 1.0),
            turns: Turns::Evenly { path: Vector3::new(0.5, -1.0, 0.8), roll: 0.7 },
        };
        let local = |u: f64| {
            let ((s, c), (s2, c2)) = ((3.0 * u).sin_cos(), (2.0 * u).sin_cos());
            [
                Vector3::new(s, c2, u),
                Vector3::new(3.0 * c, -2.0 * s2, 1.0),
                Vector3::new(-9.0 * s, -4.0 * c2, 0.0),
                Vector3::new(-27.0 * c, 8.0 * s2, 0.0),
            ]
        };
        let at = |u: f64| carried(&frame.rotation(u), &frame.turning(u), &local(u));
        let h = 1e-4;
        for u in [0.0, 0.2, 0.9] {
            let (before, here, after) = (at(u - h), at(u), at(u + h));
            for order in 0..3 {
                let measured = (after[order] - before[order]) / (2.0 * h);
                assert!((measured - here[order + 1]).norm() < 1e-5, "{order}: {measured} {}", here[order + 1]);
            }
        }
    }
}
