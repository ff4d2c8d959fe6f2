//! The share of a motion that a blending zone takes.

use nalgebra::Vector3;

use crate::blend::smoothing::is_smooth;
use crate::command::LARGEST_ZONE;
use crate::command::joints::{Joints, is_unset};
use crate::plan::curve::Curve;
use crate::plan::motion::Motion;
use arl_robot::robot::Robot;

/// What a zone is measured by.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Measure {
    /// Share of the motion.
    Share,
    /// Distance of the TCP along its path, in mm.
    Tcp,
    /// Rotation of the tool in deg.
    Ori,
    /// The own axis that moves farthest, in deg (mm).
    Joint,
    /// The rotary external axis that moves farthest, in deg.
    Turning,
    /// The linear external axis that moves farthest, in mm.
    Linear,
}

/// The zone at the end of a motion: what was requested, and what the blend took of it.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub struct Rounding {
    /// The requested size.
    pub asked: f64,
    /// The used size, at most the requested one; 0 where the robot stops at the target.
    pub used: f64,
    /// `%` of the largest zone, `mm`, or `deg`.
    pub unit: &'static str,
}

/// The zone of a motion that is left at the share `leave`; `None` where none was requested.
pub(crate) fn rounding(robot: &Robot, motion: &Motion, leave: f64) -> Option<Rounding> {
    let (measure, size, asked) = leaving(robot, motion)?;
    // In a dense chain more may be rounded off: the path changes by no more than a thousandth of a millimetre.
    let part = (1.0 - leave).min(asked);
    let leave = 1.0 - part;
    Some(match (measure, &motion.curve) {
        (Measure::Share, _) => {
            Rounding { asked: 100.0 * size / LARGEST_ZONE, used: 100.0 * part / LARGEST_ZONE, unit: "%" }
        }
        (Measure::Tcp, Curve::Axes(_)) => {
            let far = tcp_place(robot, motion, leave) - tcp_place(robot, motion, 1.0);
            Rounding { asked: size, used: far.norm(), unit: "mm" }
        }
        _ => {
            let unit = if matches!(measure, Measure::Tcp | Measure::Linear) { "mm" } else { "deg" };
            Rounding { asked: size, used: part * extent(robot, motion, measure)?, unit }
        }
    })
}

/// The smallest share of a motion that a blend can take.
const LEAST_ZONE: f64 = 1e-6;

/// The shares that a blend takes from the end of one motion and from the start of the next; `None` where no blend is
/// requested. In a dense chain they are whole halves, whatever the zone.
pub(crate) fn parts(robot: &Robot, from: &Motion, to: &Motion) -> Option<(f64, f64)> {
    let asked = asked_parts(robot, from, to)?;
    Some(if is_smooth(from, to) { (LARGEST_ZONE, LARGEST_ZONE) } else { asked })
}

/// The shares that the zone requests, or that are given.
pub(crate) fn asked_parts(robot: &Robot, from: &Motion, to: &Motion) -> Option<(f64, f64)> {
    if let Some(given) = &from.corner {
        return Some(given.parts());
    }
    let (measure, size, leaving) = leaving(robot, from)?;
    let time = |motion: &Motion, part: f64| part / motion.rate;
    let entering = match extent(robot, to, measure) {
        _ if measure == Measure::Share => leaving,
        _ if measure == Measure::Tcp && matches!(to.curve, Curve::Axes(_)) => tcp_part(robot, to, size, 0.0),
        Some(extent) => size / extent,
        // The motion does not move in this measure: the blend takes as much time of it as of the other one.
        None => time(from, leaving) / time(to, 1.0),
    };
    // The part in which the next motion is left is no longer available for entering it.
    let free = to.corner.map_or(LARGEST_ZONE, |given| (1.0 - given.leaving.part).min(LARGEST_ZONE));
    let entering = entering.min(free);
    (entering > LEAST_ZONE).then_some((leaving, entering))
}

/// Whether the end of a motion is to be rounded off.
pub(crate) fn asks(robot: &Robot, motion: &Motion) -> bool {
    motion.corner.is_some() || leaving(robot, motion).is_some()
}

/// What the zone of a motion is measured by, its size, and the share of the motion that it takes.
fn leaving(robot: &Robot, motion: &Motion) -> Option<(Measure, f64, f64)> {
    let zone = &motion.zone;
    if !is_unset(zone.percent) && zone.percent >= 0.0 {
        let part = zone.percent.min(100.0) / 100.0 * LARGEST_ZONE;
        return (part > 0.0).then_some((Measure::Share, part, part));
    }
    let asked = |size: f64| !is_unset(size) && size > 0.0;
    let wanted = match motion.curve {
        Curve::Tool(_) if !is_unset(zone.tcp) && zone.tcp <= 0.0 => return None,
        Curve::Tool(_) => [(Measure::Tcp, zone.tcp), (Measure::Ori, zone.ori)],
        Curve::Axes(_) if asked(zone.joint) => [(Measure::Joint, zone.joint), (Measure::Joint, zone.joint)],
        Curve::Axes(_) => [(Measure::Tcp, zone.tcp), (Measure::Tcp, zone.tcp)],
    };
    let external = [(Measure::Turning, zone.turning), (Measure::Linear, zone.linear)];
    let found = wanted.into_iter().chain(external).filter(|(_, size)| asked(*size)).filter_map(|(measure, size)| {
        let part = match (measure, &motion.curve) {
            (Measure::Tcp, Curve::Axes(_)) => tcp_part(robot, motion, size, 1.0),
            _ => size / extent(robot, motion, measure)?,
        };
        Some((measure, size, part.min(LARGEST_ZONE)))
    });
    found.min_by(|(_, _, a), (_, _, b)| a.total_cmp(b))
}

/// The extent of a motion in a measure; `None` where it does not move in it.
fn extent(robot: &Robot, motion: &Motion, measure: Measure) -> Option<f64> {
    let is_tool = matches!(motion.curve, Curve::Tool(_));
    let external = |linear: bool| {
        let distances = motion.end.external.iter().zip(&motion.start.external).map(|(end, start)| (end - start).abs());
        let axes = robot.external_axes().iter().zip(distances).filter(|(axis, _)| axis.linear == linear);
        axes.map(|(_, distance)| distance).fold(0.0, f64::max)
    };
    let extent = match measure {
        Measure::Share => 1.0,
        Measure::Tcp => motion.length,
        Measure::Ori => motion.angle,
        Measure::Joint if is_tool => 0.0,
        Measure::Joint => {
            motion.end.axes.iter().zip(&motion.start.axes).map(|(end, start)| (end - start).abs()).fold(0.0, f64::max)
        }
        Measure::Turning => external(false),
        Measure::Linear => external(true),
    };
    (extent > 1e-9).then_some(extent)
}

/// The share of an axis motion, from its end at `of`, on which the TCP is within `distance` mm of that end.
fn tcp_part(robot: &Robot, motion: &Motion, distance: f64, of: f64) -> f64 {
    let tcp = |at: f64| tcp_place(robot, motion, at);
    let end = tcp(of);
    let far = |part: f64| (tcp((of - part).abs()) - end).norm() > distance;
    // The first place, going away from the end, where the TCP is too far.
    const STEPS: u32 = 32;
    let place = |step: u32| LARGEST_ZONE * f64::from(step) / f64::from(STEPS);
    let Some(step) = (1..=STEPS).find(|step| far(place(*step))) else { return LARGEST_ZONE };
    let (mut near, mut beyond) = (place(step - 1), place(step));
    for _ in 0..40 {
        let middle = f64::midpoint(near, beyond);
        if far(middle) { beyond = middle } else { near = middle }
    }
    near
}

/// The position of the TCP on its path at a share of an axis motion, in mm.
fn tcp_place(robot: &Robot, motion: &Motion, at: f64) -> Vector3<f64> {
    let joints: Joints = motion.curve.joints(&robot.kinematics, at, &motion.start);
    motion.rig.carried.path_frame_at(&robot.kinematics.forward(&joints.axes)).translation.vector
}
