//! The plain path of the TCP: its position and the rotation of the tool.

use nalgebra::{UnitQuaternion, Vector3};

use crate::geometry::paced_quintic::PacedQuintic;
use crate::geometry::rotation;
use crate::geometry::track::Track;

/// The path of the TCP without overlays.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct TcpPath {
    /// The position of the TCP.
    pub(crate) track: Track,
    /// The orientation to which `turning` is added.
    pub(crate) base: UnitQuaternion<f64>,
    /// A rotation vector in rad, about the axes of what the path is relative to.
    pub(crate) turning: PacedQuintic<3>,
}

impl TcpPath {
    /// The orientation at `at`.
    pub(crate) fn rotation(&self, at: f64) -> UnitQuaternion<f64> {
        UnitQuaternion::from_scaled_axis(Vector3::from(self.turning.at(at))) * self.base
    }

    /// How the orientation changes at `at`: the speed of rotation in rad per unit, and its first two derivatives.
    pub(crate) fn rotation_rates(&self, at: f64) -> [Vector3<f64>; 3] {
        if self.turning.is_even() {
            return [Vector3::from(self.turning.derivative(1, at)), Vector3::zeros(), Vector3::zeros()];
        }
        let derivatives = [1, 2, 3].map(|order| Vector3::from(self.turning.derivative(order, at)));
        rotation::speeds(&self.turning.at(at).into(), &derivatives)
    }
}
