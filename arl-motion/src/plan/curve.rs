//! The geometry of motion: all positions as a function of a parameter from 0 to 1, with their derivatives.

use nalgebra::{Translation3, UnitQuaternion, Vector3};

use crate::command::joints::{ALL, Joints};
use crate::geometry::paced_quintic::PacedQuintic;
use crate::geometry::quintic::Quintic;
use crate::geometry::rotation;
use crate::geometry::tcp_path::TcpPath;
use crate::geometry::track::Track;
use crate::overlay::Overlay;
use arl_robot::frames::Carried;
use arl_robot::kinematics::{Axes, Frame, Kinematics, Passage, Rates, Twist, wrap_degrees};
use arl_robot::robot::{EXTERNAL_AXES, ROBOT_AXES};

/// Closer to a singular point than this (see [`arl_robot::kinematics::Kinematics::clearance`]), rounding spoils the
/// derivatives.
pub(crate) const SINGULAR_CLEARANCE: f64 = 1e-5;

/// What a motion moves along.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum Curve {
    /// All axes by polynomials.
    Axes(Quintic<ALL>),
    /// The TCP along a track, external axes by polynomials.
    Tool(ToolCurve),
}

/// A path of the TCP, relative to what [`Carried`] specifies.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct ToolCurve {
    /// The position of the TCP and the orientation of the tool, without overlays.
    pub(crate) path: TcpPath,
    /// What the robot moves along the path.
    pub(crate) carried: Carried,
    /// The external axes.
    pub(crate) external: PacedQuintic<EXTERNAL_AXES>,
    /// The configuration at the start, which only a passage changes.
    pub(crate) cfg: u8,
    /// Where axis 4 is led through the wrist singularity.
    pub(crate) passages: Vec<Passage>,
    /// Places near singular points, where the axes' motion changes quickly.
    pub(crate) close_places: Vec<f64>,
    /// The overlays on the path.
    pub(crate) over: Option<Box<Overlay>>,
}

/// Half the width of the span over which derivatives are measured within a passage, as a share of the passage.
const STENCIL_SHARE: f64 = 1.0 / 128.0;

impl ToolCurve {
    /// The TCP's frame at `at`, translation in mm.
    pub(crate) fn tcp(&self, at: f64) -> Frame {
        let [place, ..] = self.moving(at);
        Frame::from_parts(Translation3::from(place), self.rotation(at))
    }

    /// The position of the TCP at `at` in mm, with its first three derivatives.
    pub(crate) fn moving(&self, at: f64) -> [Vector3<f64>; 4] {
        let over = self.over.as_ref().map_or([Vector3::zeros(); 4], |over| over.offset(&self.path, at));
        let [place, first, second, third] = over;
        let of = |order| self.path.track.derivative(order, at);
        [self.path.track.at(at) + place, of(1) + first, of(2) + second, of(3) + third]
    }

    /// Whether the speed and the rotation of the TCP are constant along the whole curve.
    pub(crate) fn is_even(&self) -> bool {
        let even = match &self.path.track {
            Track::Poly(poly) => poly.is_even(),
            Track::Arc(_) => true,
        };
        even && self.path.turning.is_even() && self.over.is_none()
    }

    /// Whether the parameter's pace consists of parts, between which third derivatives jump.
    pub(crate) fn is_paced(&self) -> bool {
        matches!(&self.path.track, Track::Poly(polynomial) if polynomial.is_paced())
    }

    /// The orientation at `at`.
    pub(crate) fn rotation(&self, at: f64) -> UnitQuaternion<f64> {
        let plain = self.path.rotation(at);
        self.over.as_ref().filter(|over| over.turns()).map_or(plain, |over| over.turned(&self.path, at) * plain)
    }

    /// The angle in deg by which the tool turns along the whole curve.
    pub(crate) fn turned_angle(&self) -> f64 {
        const PARTS: u32 = 16;
        let place = |part: u32| self.rotation(f64::from(part) / f64::from(PARTS));
        let angle = |part: u32| UnitQuaternion::angle_to(&place(part), &place(part + 1));
        (0..PARTS).map(angle).sum::<f64>().to_degrees()
    }

    /// The flange's frame at `at` in the robot's base, translation in mm.
    pub(crate) fn flange(&self, at: f64) -> Frame {
        self.carried.flange_at(&self.tcp(at))
    }

    /// The passage that contains `at`.
    pub(crate) fn passage(&self, at: f64) -> Option<&Passage> {
        self.passages.iter().find(|passage| passage.from <= at && at <= passage.to)
    }

    /// Where passages begin and end: third derivatives of the axes jump there.
    pub(crate) fn borders(&self) -> impl Iterator<Item = f64> {
        self.passages.iter().flat_map(|passage| [passage.from, passage.to])
    }

    /// The configuration at `at`; within a passage, the one before it.
    pub(crate) fn cfg_at(&self, at: f64) -> u8 {
        self.passages.iter().rev().find(|passage| passage.to < at).map_or(self.cfg, |passage| passage.cfg_behind)
    }

    /// Whether the TCP can change from one path to the other: both lead the same TCP, and no passage makes their
    /// orientations inexact there.
    pub(crate) fn goes_on(&self, leave: f64, to: &ToolCurve, join: f64) -> bool {
        let exact = self.passages.iter().all(|passage| passage.to < leave)
            && to.passages.iter().all(|passage| passage.from > join);
        exact && self.carried == to.carried && self.cfg_at(1.0) == to.cfg
    }

    /// The axes at `at`, no farther than half a turn from `near`; `None` where the arm does not reach. Within a
    /// passage, `near` has to be the axes shortly before.
    pub(crate) fn axes(&self, kinematics: &Kinematics, at: f64, near: &Axes) -> Option<Axes> {
        let mut axes = match self.passage(at) {
            None => kinematics.inverse(&self.flange(at), self.cfg_at(at), near)?,
            Some(passage) => {
                let (tcp, tool) = self.carried.coincident_frames(&self.tcp(at));
                kinematics.inverse_at_axis4(&tcp, &tool, passage.axis4(at), near)?
            }
        };
        for (value, near) in axes.iter_mut().zip(near) {
            *value = near + wrap_degrees(*value - near);
        }
        Some(axes)
    }

    /// The derivatives of the axes by the parameter at `at`, where the axes are at `axes`; `None` at a singular point.
    pub(crate) fn rates(&self, kinematics: &Kinematics, at: f64, axes: &Axes) -> Option<Rates> {
        match self.passage(at) {
            None => kinematics.rates(axes, &self.twist(at)),
            Some(passage) => self.rates_in(passage, kinematics, at, axes),
        }
    }

    /// The derivatives of the axes within a passage, from the axes at five places of it.
    fn rates_in(&self, passage: &Passage, kinematics: &Kinematics, at: f64, axes: &Axes) -> Option<Rates> {
        let h = (passage.to - passage.from) * STENCIL_SHARE;
        let middle = at.clamp(passage.from + 2.0 * h, passage.to - 2.0 * h);
        let place = |steps: f64| self.axes(kinematics, middle + steps * h, axes);
        let (m2, m1, here, p1, p2) = (place(-2.0)?, place(-1.0)?, place(0.0)?, place(1.0)?, place(2.0)?);
        let mut rates = Rates { first: [0.0; ROBOT_AXES], second: [0.0; ROBOT_AXES], third: [0.0; ROBOT_AXES] };
        let places = m2.iter().zip(&m1).zip(&here).zip(p1.iter().zip(&p2));
        let out = rates.first.iter_mut().zip(&mut rates.second).zip(&mut rates.third);
        for (((first, second), third), (((m2, m1), here), (p1, p2))) in out.zip(places) {
            // The polynomial of the fourth degree through the five places, at `t` steps from the middle.
            let t = (at - middle) / h;
            let a1 = (m2 - m1 * 8.0 + p1 * 8.0 - p2) / 12.0;
            let a2 = (-m2 + m1 * 16.0 - here * 30.0 + p1 * 16.0 - p2) / 12.0;
            let a3 = (-m2 + m1 * 2.0 - p1 * 2.0 + p2) / 2.0;
            let a4 = m2 - m1 * 4.0 + here * 6.0 - p1 * 4.0 + p2;
            *first = (a1 + t * (a2 + t * (a3 / 2.0 + t * a4 / 6.0))) / h;
            *second = (a2 + t * (a3 + t * a4 / 2.0)) / (h * h);
            *third = (a3 + t * a4) / (h * h * h);
        }
        Some(rates)
    }

    /// How the orientation changes at `at`: the speed of rotation in rad per unit, and its first two derivatives.
    pub(crate) fn rotation_rates(&self, at: f64) -> [Vector3<f64>; 3] {
        let Some(over) = self.over.as_ref().filter(|over| over.turns()) else { return self.path.rotation_rates(at) };
        let step = STENCIL_SHARE.min(over.longest_step() / 2.0);
        measured(|at| self.rotation(at), at, step)
    }

    /// How the flange moves at `at`, per unit of the parameter.
    pub(crate) fn twist(&self, at: f64) -> Twist {
        let [_, moving @ ..] = self.moving(at);
        self.carried.twist(&self.tcp(at), &moving, &self.rotation_rates(at))
    }

    /// The position and the rotation vector relative to `origin` at `at`, with their derivatives.
    pub(crate) fn place(&self, at: f64, origin: &UnitQuaternion<f64>) -> [[Vector3<f64>; 3]; 2] {
        let turned = (self.rotation(at) * origin.inverse()).scaled_axis();
        let [speed, change, _] = self.rotation_rates(at);
        let [first, second] = rotation::of_speeds(&turned, &[speed, change]);
        let [place, velocity, acceleration, _] = self.moving(at);
        [[place, velocity, acceleration], [turned, first, second]]
    }
}

/// How `rotation` changes at `at`: the speed in rad per unit, and its first two derivatives.
fn measured(rotation: impl Fn(f64) -> UnitQuaternion<f64>, at: f64, h: f64) -> [Vector3<f64>; 3] {
    // The rotation vector relative to this place, at five places, gives derivatives that hold here.
    let here = rotation(at).inverse();
    let turned = |steps: f64| (rotation(at + steps * h) * here).scaled_axis();
    let (m2, m1, p1, p2) = (turned(-2.0), turned(-1.0), turned(1.0), turned(2.0));
    let first = (m2 - m1 * 8.0 + p1 * 8.0 - p2) / (12.0 * h);
    let second = (-m2 + m1 * 16.0 + p1 * 16.0 - p2) / (12.0 * h * h);
    let third = (-m2 + m1 * 2.0 - p1 * 2.0 + p2) / (2.0 * h * h * h);
    [first, second, third + first.cross(&second) * 0.5]
}

impl Curve {
    /// The external axes of the curve.
    pub(crate) fn external(&self) -> PacedQuintic<EXTERNAL_AXES> {
        match self {
            Curve::Axes(axes) => Quintic(axes.0.map(|power| Joints::of(&power).external)).into(),
            Curve::Tool(tool) => tool.external.clone(),
        }
    }

    /// Whether the parameter's pace consists of parts, between which third derivatives jump.
    pub(crate) fn is_paced(&self) -> bool {
        matches!(self, Curve::Tool(curve) if curve.is_paced())
    }

    /// All axes evenly from start to end.
    pub(crate) fn even_axes(start: &Joints, end: &Joints) -> Self {
        let (from, mut travel) = (start.all(), end.all());
        for (travel, from) in travel.iter_mut().zip(from) {
            *travel -= from;
        }
        Curve::Axes(Quintic::even(from, travel))
    }

    /// The first three derivatives of all joints by the parameter at `at`, where they are at `joints`. `None` at a
    /// singular point, where they would consist of rounding errors.
    pub(crate) fn rates(&self, kinematics: &Kinematics, at: f64, joints: &Joints) -> Option<[[f64; ALL]; 3]> {
        match self {
            Curve::Axes(axes) => Some([1, 2, 3].map(|order| axes.derivative(order, at))),
            Curve::Tool(tool) => {
                if tool.passage(at).is_none() && kinematics.clearance(&joints.axes) < SINGULAR_CLEARANCE {
                    return None;
                }
                let rates = tool.rates(kinematics, at, &joints.axes)?;
                let external = [1, 2, 3].map(|order| tool.external.derivative(order, at));
                let [first, second, third] = external;
                let all = |axes, external| Joints { axes, external }.all();
                Some([all(rates.first, first), all(rates.second, second), all(rates.third, third)])
            }
        }
    }

    /// The joints at `at`; `near` are the joints of the previous cycle.
    pub(crate) fn joints(&self, kinematics: &Kinematics, at: f64, near: &Joints) -> Joints {
        match self {
            Curve::Axes(axes) => Joints::of(&axes.at(at)),
            // Planning has checked the path; where only rounding misses the edge of the reach, the axes stay.
            Curve::Tool(tool) => Joints {
                axes: tool.axes(kinematics, at, &near.axes).unwrap_or(near.axes),
                external: tool.external.at(at),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::track::Arc;

    #[test]
    fn the_twist_is_how_the_flange_moves() {
        let turning = Quintic([
            [0.1, 0.2, 0.0],
            [0.5, -0.3, 0.2],
            [0.0, 0.4, -0.6],
            [0.3, 0.0, 0.1],
            [0.0, 0.2, 0.0],
            [-0.1, 0.0, 0.1],
        ]);
        let arc = Arc {
            centre: Vector3::new(500.0, 20.0, 300.0),
            across: Vector3::new(0.0, 90.0, 0.0),
            along: Vector3::new(0.0, 0.0, 90.0),
            sweep: 2.0,
        };
        let curve = ToolCurve {
            path: TcpPath {
                track: Track::Arc(arc),
                base: UnitQuaternion::from_euler_angles(0.3, 0.2, 0.1),
                turning: turning.into(),
            },
            carried: Carried::Tool(arl_robot::kinematics::frame([10.0, 20.0, 100.0, 5.0, 6.0, 7.0])),
            external: Quintic::even([0.0; 6], [0.0; 6]).into(),
            cfg: 0,
            passages: Vec::new(),
            close_places: Vec::new(),
            over: None,
        };
        let (at, h) = (0.4, 1e-3);
        let place = |at: f64| curve.flange(at).translation.vector;
        let derivatives = curve.twist(at).of_place(&place(at));
        let (m2, m1, here, p1, p2) =
            (place(at - 2.0 * h), place(at - h), place(at), place(at + h), place(at + 2.0 * h));
        let measured = [
            (p1 - m1) / (2.0 * h),
            (p1 - here * 2.0 + m1) / (h * h),
            (p2 - p1 * 2.0 + m1 * 2.0 - m2) / (2.0 * h * h * h),
        ];
        for (derivative, measured) in derivatives.iter().zip(measured) {
            assert!((derivative - measured).norm() < 1e-3 * measured.norm(), "{derivative} {measured}");
        }
    }
}
