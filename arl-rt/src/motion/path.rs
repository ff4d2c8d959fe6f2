//! The geometry of one motion: where everything is at a path parameter from 0 to 1.

use nalgebra::{Translation3, UnitQuaternion, Vector3};

use super::joints::{ALL, Joints, is_unset};
use crate::kinematics::{Axes, Frame, Kinematics, Twist, wrap_degrees};

/// What a motion moves along.
#[derive(Clone, PartialEq, Debug)]
#[expect(clippy::large_enum_variant, reason = "a box would be freed in the cycle that ends the motion")]
pub(super) enum Path {
    /// All axes evenly from start to end.
    Axes,
    /// The TCP straight and turning evenly; only external axes evenly by themselves.
    Line(Line),
}

/// A straight line of the TCP.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Line {
    start: Frame,
    end: Frame,
    /// mm.
    travel: Vector3<f64>,
    /// rad, about a fixed axis of the base.
    turning: Vector3<f64>,
    /// The flange seen from the TCP.
    flange: Frame,
    /// The configuration that the whole line keeps.
    pub(super) cfg: u8,
}

impl Line {
    pub(super) fn new(start: Frame, end: Frame, tool: &Frame, cfg: u8) -> Self {
        Self {
            travel: end.translation.vector - start.translation.vector,
            turning: (end.rotation * start.rotation.inverse()).scaled_axis(),
            flange: tool.inverse(),
            start,
            end,
            cfg,
        }
    }

    /// Its length in mm.
    pub(super) fn length(&self) -> f64 {
        self.travel.norm()
    }

    /// The angle in deg by which the TCP turns.
    pub(super) fn angle(&self) -> f64 {
        self.turning.norm().to_degrees()
    }

    fn tcp(&self, at: f64) -> Frame {
        if at >= 1.0 {
            return self.end;
        }
        Frame::from_parts(
            Translation3::from(self.start.translation.vector + self.travel * at),
            UnitQuaternion::from_scaled_axis(self.turning * at) * self.start.rotation,
        )
    }

    /// The axes at `at`, no farther than half a turn from `near`; `None` where the arm does not reach.
    pub(super) fn axes(&self, kinematics: &Kinematics, at: f64, near: &Axes) -> Option<Axes> {
        let mut axes = kinematics.inverse(&self.flange(at), self.cfg, near)?;
        for (value, near) in axes.iter_mut().zip(near) {
            *value = near + wrap_degrees(*value - near);
        }
        Some(axes)
    }

    /// The flange's frame at `at`, translation in mm.
    pub(super) fn flange(&self, at: f64) -> Frame {
        self.tcp(at) * self.flange
    }

    /// How the flange moves at `at`, per unit of the parameter.
    pub(super) fn twist(&self, at: f64) -> Twist {
        Twist::straight(&(self.start.translation.vector + self.travel * at), &self.travel, &self.turning)
    }
}

impl Path {
    /// The joints at `at`, for a motion from `start` to `end`; `near` are the joints of the cycle before.
    pub(super) fn joints(
        &self,
        kinematics: &Kinematics,
        start: &Joints,
        end: &Joints,
        at: f64,
        near: &Joints,
    ) -> Joints {
        if at <= 0.0 {
            return *start;
        }
        if at >= 1.0 {
            return *end;
        }
        let external = between(&start.external, &end.external, at);
        let axes = match self {
            Path::Axes => between(&start.axes, &end.axes, at),
            // Planning has walked the line; where rounding alone misses the edge of the reach, the axes stay.
            Path::Line(line) => line.axes(kinematics, at, &near.axes).unwrap_or(near.axes),
        };
        Joints { axes, external }
    }
}

fn between<const N: usize>(start: &[f64; N], end: &[f64; N], at: f64) -> [f64; N] {
    let mut values = *start;
    for (value, end) in values.iter_mut().zip(end) {
        *value += (end - *value) * at;
    }
    values
}

/// How far each axis has to go; axes that are not there go nowhere.
pub(super) fn distances(start: &Joints, end: &Joints) -> [f64; ALL] {
    let mut distances = [0.0; ALL];
    let values = |joints: &Joints| joints.axes.into_iter().chain(joints.external);
    for (distance, (start, end)) in distances.iter_mut().zip(values(start).zip(values(end))) {
        if !is_unset(start) {
            *distance = end - start;
        }
    }
    distances
}
