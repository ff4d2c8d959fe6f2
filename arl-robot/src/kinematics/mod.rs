//! Kinematics: axes to pose and back, in closed form.
//!
//! Lengths are in mm and angles in deg in the interface of this module; internally it computes in m.

mod angles;
mod choose;
mod frame;
mod links;
mod opw;
mod passing;
#[doc(hidden)]
pub mod random;
mod rates;
mod scara;
#[cfg(test)]
#[cfg(feature = "files")]
mod tests;
mod wrist;

pub use angles::sin_cos;
pub use choose::{CONFIGURATIONS, RANGE_SLACK, Refusal, Wanted};
pub use frame::{Frame, frame, frame_components};
pub use links::LinkJoint;
pub use opw::{Opw, OpwParameters, Singularity, Solutions};
pub use passing::{PASSAGE, Passage};
pub use rates::{
    CLEAR_OF_SINGULAR, LOWEST_TRAVEL_MM_S, LOWEST_TURNING_DEG_S, Rates, SHORTEST_STEP_S, Twist, lowest_pace, outruns,
};
pub use scara::Scara;

/// The axes of a robot in deg (mm where linear); a SCARA leaves the last two at 0.
pub type Axes = [f64; 6];

/// A robot's geometry with its closed-form solutions.
#[derive(Clone, PartialEq, Debug)]
#[expect(clippy::large_enum_variant, reason = "there is one robot, and its kinematics run in every cycle")]
pub enum Kinematics {
    /// Six axes with a spherical wrist.
    SixAxis(Opw),
    /// Four axes.
    Scara(Scara),
}

impl Kinematics {
    /// The flange's frame in the robot's base, translation in mm.
    pub fn forward(&self, axes: &Axes) -> Frame {
        match self {
            Kinematics::SixAxis(opw) => opw.forward(axes),
            Kinematics::Scara(scara) => scara.forward(axes),
        }
    }

    /// The `cfg` of a joint vector: 0 to 7 for six-axis robots, 0 or 4 for SCARA.
    pub fn cfg(&self, axes: &Axes) -> u8 {
        match self {
            Kinematics::SixAxis(opw) => opw.cfg(axes),
            Kinematics::Scara(scara) => scara.cfg(axes),
        }
    }

    /// The axes that bring the flange to `flange` in configuration `cfg`, each within (-180, 180] deg; axes that the
    /// pose leaves open at a singular point stay as in `near`. `None` if the pose is out of reach in this
    /// configuration.
    pub fn inverse(&self, flange: &Frame, cfg: u8, near: &Axes) -> Option<Axes> {
        match self {
            Kinematics::SixAxis(opw) => opw.inverse(flange, cfg, near),
            Kinematics::Scara(scara) => scara.inverse(flange, cfg, near),
        }
    }

    /// The reason why no configuration, or none of the requested ones, reaches `flange`.
    pub fn refusal(&self, flange: &Frame) -> Refusal {
        match self {
            Kinematics::Scara(scara) if scara.tilt(flange) > 0.0 => Refusal::Tilted { by: scara.tilt(flange) },
            _ => Refusal::Unreachable { beyond: self.beyond_reach(flange) },
        }
    }

    /// The values that `cfg` can have.
    pub fn configurations(&self) -> &'static [u8] {
        match self {
            Kinematics::SixAxis(_) => &[0, 1, 2, 3, 4, 5, 6, 7],
            Kinematics::Scara(_) => &[0, 4],
        }
    }

    /// The distance, in mm, of the pose from the reach of the arm in any configuration; 0 if the length of the arm is
    /// not the reason.
    pub fn beyond_reach(&self, flange: &Frame) -> f64 {
        match self {
            Kinematics::SixAxis(opw) => opw.beyond_reach(flange),
            Kinematics::Scara(scara) => scara.beyond_reach(flange),
        }
    }
}

/// The angle wrapped to (-180, 180].
pub fn wrap_degrees(angle: f64) -> f64 {
    let [wrapped] = angles::wrap([angle]);
    wrapped
}
