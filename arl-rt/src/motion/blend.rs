//! Blending zones: a curve that leaves one motion before its target and joins the next one behind its start.
//!
//! The curve meets both motions with position, direction and curvature, and depends on the geometry of the zone alone,
//! never on a speed. It is a polynomial of the fifth degree: in the TCP's position and orientation where both motions
//! lead the same TCP, else in the axes. Only then is it timed.

use nalgebra::Vector3;

use super::bounds::{Bounds, Pace};
use super::curve::{Curve, ToolCurve, Track};
use super::joints::{ALL, Joints};
use super::limits::passing;
use super::place::Place;
use super::plan::Motion;
use super::profile::Limits;
use super::progress::Progress;
use super::quintic::{Knot, Quintic};
use super::survey::survey;
use super::zone::parts;
use crate::kinematics::Rates;
use crate::robot::{ROBOT_AXES, Robot};

/// Length of the tangents at the ends of a blend, in lengths of the zone. With 2 the blend of two straight lines that are
/// left and joined at the same distance accelerates along the bisector alone.
const TANGENT: f64 = 2.0;
/// How often a zone is halved before it is given up: where its blend would leave an axis's range or the reach.
const HALVINGS: u32 = 4;
/// Places at which a blend is looked at.
const PLACES: u32 = 32;

/// The way between two motions.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Blend {
    /// The part of the first motion after which it is left.
    pub(super) leave: f64,
    /// The part of the second motion at which it is joined.
    pub(super) join: f64,
    pub(super) curve: Curve,
    /// The curve's parameter over the time that is nominal for it, both from 0 to 1.
    pub(super) progress: Progress,
    /// The nominal time in s.
    pub(super) time: f64,
    /// In shares of the nominal time per s.
    pub(super) limits: Limits,
}

/// The blend that the first motion's zone asks for; `None` where it asks for none, or there is no way.
pub(super) fn blend(robot: &Robot, from: &Motion, to: &Motion) -> Option<Blend> {
    let (mut leaving, mut joining) = parts(robot, from, to)?;
    for _ in 0..=HALVINGS {
        if let Some(blend) = attempt(robot, from, to, leaving, joining) {
            return Some(blend);
        }
        (leaving, joining) = (leaving / 2.0, joining / 2.0);
    }
    None
}

fn attempt(robot: &Robot, from: &Motion, to: &Motion, leaving: f64, joining: f64) -> Option<Blend> {
    let (vel_from, vel_to) = (from.rate, to.rate);
    let (leave, join) = (1.0 - leaving, joining);
    let (slope_from, slope_to) = (TANGENT * leaving, TANGENT * joining);
    // Both ends are met at the speeds that the motions have there.
    let (start_rate, end_rate) = (vel_from / slope_from, vel_to / slope_to);
    let mut time = 2.0 / (start_rate + end_rate);
    let mut progress = Progress::between(start_rate * time, end_rate * time);

    let mut bounds = Bounds::new(robot);
    let pace = common_pace(from, to);
    let curve = match (&from.curve, &to.curve) {
        (Curve::Tool(a), Curve::Tool(b)) if go_on(a, leave, b, join) => {
            let curve = tool_blend(a, b, leave, join, slope_from, slope_to);
            let ends = (along(&a.track, leave, vel_from), along(&b.track, join, vel_to));
            // What is laid over a motion does not go evenly: it is met best by a parameter that does.
            if from.laid.is_none()
                && to.laid.is_none()
                && let Some(even) = Progress::along(&curve.track, ends.0, ends.1)
            {
                (progress, time) = even;
            }
            let start = joints_at(robot, from, leave)?;
            let found = survey(robot, &curve, &start).ok()?;
            let there = joints_at(robot, to, join)?;
            if found.end.iter().zip(&there.axes).any(|(a, b)| (a - b).abs() > 0.01) {
                return None;
            }
            for (at, rates) in &found.rates {
                let place = Place::at(&progress, inverse(&progress, *at));
                let [first, second, third] = place.rates([rates.first, rates.second, rates.third]);
                bounds.axes(&first, &second, &third, &pace);
            }
            for step in 0..=PLACES {
                let place = Place::at(&progress, f64::from(step) / f64::from(PLACES));
                let moving = [1, 2, 3].map(|order| curve.track.derivative(order, place.at));
                let turning = curve.rotation_rates(place.at);
                if from.laid.is_some() || to.laid.is_some() {
                    bounds.swinging(&place.vectors(moving), &pace);
                } else {
                    bounds.moving(&place.vectors(moving), &pace);
                }
                if pace.manual {
                    bounds.manual_moving(&place.vectors(moving));
                    bounds.manual_flange(&curve, place.at, place.first);
                }
                bounds.turning(&place.vectors(turning), &pace);
                let external = [1, 2, 3].map(|order| curve.external.derivative(order, place.at));
                bounds.external(&place.rates(external), &pace);
            }
            Curve::Tool(curve)
        }
        _ => {
            let curve =
                Quintic::between(&axes_knot(robot, from, leave, slope_from)?, &axes_knot(robot, to, join, slope_to)?);
            for step in 0..=PLACES {
                let place = Place::at(&progress, f64::from(step) / f64::from(PLACES));
                if !within_ranges(robot, &Joints::of(&curve.at(place.at))) {
                    return None;
                }
                let derivatives = [1, 2, 3].map(|order| curve.derivative(order, place.at));
                bounds.all_axes(&place.rates(derivatives), &pace);
                if pace.manual {
                    let [first, ..] = place.rates(derivatives);
                    bounds.manual_place(&Joints::of(&curve.at(place.at)), &first, &to.rig.carried);
                }
            }
            Curve::Axes(curve)
        }
    };
    let limits = passing(&bounds.rows, 1.0 / time);
    Some(Blend { leave, join, curve, progress, time, limits })
}

/// The speed and the acceleration along a track in mm/s and mm/s2, at a rate of its parameter.
fn along(track: &Track, at: f64, rate: f64) -> [f64; 2] {
    let (first, second) = (track.derivative(1, at), track.derivative(2, at));
    let length = first.norm();
    [length * rate, if length > 0.0 { first.dot(&second) / length * rate * rate } else { 0.0 }]
}

/// The faster of the two motions' speeds, the gentler of their accelerations.
pub(super) fn common_pace(from: &Motion, to: &Motion) -> Pace {
    let faster = |of: fn(&Pace) -> f64| of(&from.pace).max(of(&to.pace));
    let reached = |of: fn(&Motion) -> f64| {
        let speed = |motion: &Motion| match motion.curve {
            // With what is laid over it the TCP goes faster than the path.
            Curve::Tool(_) if motion.laid.is_some() => motion.fastest(),
            Curve::Tool(_) => of(motion) * motion.rate,
            Curve::Axes(_) => f64::INFINITY,
        };
        speed(from).max(speed(to))
    };
    Pace {
        axes: faster(|pace| pace.axes),
        tcp: reached(|motion| motion.length),
        ori: reached(|motion| motion.angle).max(1.0),
        turning: faster(|pace| pace.turning),
        linear: faster(|pace| pace.linear),
        acc: from.pace.acc.min(to.pace.acc),
        jerk: from.pace.jerk.min(to.pace.jerk),
        manual: from.pace.manual || to.pace.manual,
    }
}

fn tool_blend(from: &ToolCurve, to: &ToolCurve, leave: f64, join: f64, slope_from: f64, slope_to: f64) -> ToolCurve {
    let corner = from.rotation(1.0);
    let ([moved_from, turned_from], [moved_to, turned_to]) = (from.place(leave, &corner), to.place(join, &corner));
    let knot = |[value, first, second]: [Vector3<f64>; 3], slope: f64| Knot {
        value: value.into(),
        first: (first * slope).into(),
        second: (second * slope * slope).into(),
    };
    let external = |curve: &ToolCurve, at: f64, slope: f64| scaled(curve.external.knot(at), slope);
    ToolCurve {
        track: Track::Poly(Quintic::between(&knot(moved_from, slope_from), &knot(moved_to, slope_to)).into()),
        base: corner,
        turning: Quintic::between(&knot(turned_from, slope_from), &knot(turned_to, slope_to)).into(),
        carried: from.carried,
        external: Quintic::between(&external(from, leave, slope_from), &external(to, join, slope_to)).into(),
        cfg: to.cfg,
        passages: Vec::new(),
        over: None,
    }
}

fn scaled<const N: usize>(mut knot: Knot<N>, slope: f64) -> Knot<N> {
    for value in &mut knot.first {
        *value *= slope;
    }
    for value in &mut knot.second {
        *value *= slope * slope;
    }
    knot
}

/// The axes within a motion with their derivatives.
fn axes_knot(robot: &Robot, motion: &Motion, at: f64, slope: f64) -> Option<Knot<ALL>> {
    let knot = match &motion.curve {
        Curve::Axes(axes) => axes.knot(at),
        Curve::Tool(tool) => {
            let joints = joints_at(robot, motion, at)?;
            let Rates { first, second, .. } = tool.rates(&robot.kinematics, at, &joints.axes)?;
            let external = tool.external.knot(at);
            let all = |axes: [f64; ROBOT_AXES], external| Joints { axes, external }.all();
            Knot { value: joints.all(), first: all(first, external.first), second: all(second, external.second) }
        }
    };
    Some(scaled(knot, slope))
}

/// Whether the TCP can go from one way over to another: they lead the same TCP, and no passage makes their orientations
/// inexact there.
fn go_on(from: &ToolCurve, leave: f64, to: &ToolCurve, join: f64) -> bool {
    let exact =
        from.passages.iter().all(|passage| passage.to < leave) && to.passages.iter().all(|passage| passage.from > join);
    exact && from.carried == to.carried && from.cfg_at(1.0) == to.cfg
}

/// The joints within a motion, followed from its nearer end.
fn joints_at(robot: &Robot, motion: &Motion, at: f64) -> Option<Joints> {
    const STEPS: u32 = 64;
    let Curve::Tool(tool) = &motion.curve else { return Some(motion.curve.joints(&robot.kinematics, at, &motion.end)) };
    let (from, near) = if at > 0.5 { (1.0, &motion.end) } else { (0.0, &motion.start) };
    let mut axes = near.axes;
    for step in 1..=STEPS {
        axes = tool.axes(&robot.kinematics, from + (at - from) * f64::from(step) / f64::from(STEPS), &axes)?;
    }
    Some(Joints { axes, external: tool.external.at(at) })
}

fn within_ranges(robot: &Robot, joints: &Joints) -> bool {
    let own = robot.own_axes().len();
    let values = joints.axes.iter().take(own).chain(&joints.external);
    robot.axes.iter().zip(values).all(|(axis, value)| *value >= axis.min && *value <= axis.max)
}

/// The share of the nominal time at which the curve's parameter is `at`.
fn inverse(progress: &Progress, at: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..50 {
        let middle = f64::midpoint(low, high);
        if progress.at(middle) < at { low = middle } else { high = middle }
    }
    low
}
