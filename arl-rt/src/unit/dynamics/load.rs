//! A rigid body that is fixed to a frame: mass, centre of mass, inertia.

use nalgebra::{Matrix3, Vector3};

use crate::values::ToolInertiaPara;

/// A rigid body that is fixed to a frame: to the flange, for the load of a tool.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Load {
    /// kg.
    pub(super) mass: f64,
    /// m.
    pub(super) centre: Vector3<f64>,
    /// About the centre of mass, kg m2.
    pub(super) inertia: Matrix3<f64>,
}

impl Load {
    /// No load.
    pub fn none() -> Self {
        Self::new(0.0, [0.0; 3], [0.0; 6])
    }

    /// A body of `mass` (kg) whose centre of mass is at `centre` (mm) and whose inertia about that centre, in the axes
    /// of the frame, is `inertia` (kg mm2: xx, xy, xz, yy, yz, zz, as in the matrix).
    pub fn new(mass: f64, centre: [f64; 3], inertia: [f64; 6]) -> Self {
        let [xx, xy, xz, yy, yz, zz] = inertia;
        Self {
            mass,
            centre: Vector3::from(centre) / 1e3,
            inertia: Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) / 1e6,
        }
    }

    /// The mass in kg.
    pub fn mass(&self) -> f64 {
        self.mass
    }
}

impl From<&ToolInertiaPara> for Load {
    /// Converts the data of a tool in a program: g, mm in the flange's frame, and g mm2 about the centre of mass.
    fn from(tool: &ToolInertiaPara) -> Self {
        let (c, i) = (&tool.centroidpos, &tool.inertiatensor);
        let kilogram = |g: f64| g / 1e3;
        Self::new(kilogram(tool.m), [c.x, c.y, c.z], [i.ixx, i.ixy, i.ixz, i.iyy, i.iyz, i.izz].map(kilogram))
    }
}
