//! Lays weave and compensation over a planned motion, and finds how fast it may then be.

use nalgebra::{UnitQuaternion, Vector3};

use crate::command::Reference;
use crate::command::Settings;
use crate::command::error::PlanError;
use crate::command::joints::Joints;
use crate::limits::constant::{Constraint, passing, quickest};
use crate::overlay::compensation::{CompensationState, Shift};
use crate::overlay::path_frame::PathFrame;
use crate::overlay::weave::Pattern;
use crate::overlay::{Overlay, Woven};
use crate::plan::constraints::{Constraints, MANUAL_SPEED_MM_S};
use crate::plan::curve::{Curve, ToolCurve};
use crate::plan::motion::{Motion, OverlaidMotion, Weaving};
use crate::plan::path_check::check_path;
use arl_robot::frames::Carried;
use arl_robot::kinematics::Rates;
use arl_robot::robot::Robot;

/// The shortest and the longest rounding of corners that is tried, as shares of the time that a figure swings.
const ROUNDING_SHARES: [f64; 2] = [0.01, 0.125];
/// Factor from one tried rounding to the next.
const ROUNDING_STEP_FACTOR: f64 = 1.5;
/// Corners count as sufficiently rounded when the motion keeps this share of its speed.
const UNSLOWED_SHARE: f64 = 0.999;
/// Number of consecutive places whose rates form one bound.
const PLACES_OF_CONSTRAINT: usize = 6;
/// Factor for derivatives, which are a little larger between the checked places than at them.
const BETWEEN_SAMPLES_FACTOR: f64 = 1.005;

/// The start of a motion with overlays, and what comes before and behind it.
pub(crate) struct OverlayStart<'a> {
    /// Where the robot really is.
    pub(crate) start: &'a Joints,
    /// State of a compensation there.
    pub(crate) before: &'a CompensationState,
    /// The segment of a spline that flows into the motion.
    pub(crate) flows_from: Option<&'a Motion>,
    /// Whether a weave continues into the motion behind.
    pub(crate) goes_on: bool,
}

/// Lays the overlays of the settings over `plain`. `workpiece` is the orientation of the workpiece frame, relative to
/// what the path is relative to.
pub(crate) fn lay(
    robot: &Robot,
    plain: Motion,
    beginning: &OverlayStart<'_>,
    workpiece: &UnitQuaternion<f64>,
    settings: &Settings,
) -> Result<Motion, PlanError> {
    let OverlayStart { start, before, flows_from, goes_on } = *beginning;
    let (Curve::Tool(curve), compensation) = (&plain.curve, settings.compensation) else { return Ok(plain) };
    let weave = settings.weave.filter(|weave| weave.amplitude > 0.0 && plain.length > 0.0 && plain.limits.is_some());
    if weave.is_none() && compensation.is_none() {
        return Ok(plain);
    }
    // The time of a figure is counted at the speed that is reached.
    let mut plain = plain.clone();
    if let Some(limits) = plain.limits.filter(|_| !curve.is_paced()) {
        plain.rate = limits.vel;
    }
    let Curve::Tool(curve) = &plain.curve else { return Ok(plain) };
    let seconds = if plain.limits.is_some() { 1.0 / plain.rate } else { 0.0 };
    let directed = weave.is_some() || compensation.is_some_and(|compensation| compensation.follows_path());
    let frame = if directed { PathFrame::along(&curve.path)? } else { None };
    let world = match plain.rig.carried {
        Carried::Tool(_) => plain.rig.base.rotation.inverse(),
        Carried::Workpiece(_) if compensation.is_some_and(|by| by.total(Reference::World) != [0.0; 6]) => {
            return Err(PlanError::WorldTurns);
        }
        Carried::Workpiece(_) => UnitQuaternion::identity(),
    };
    let shift =
        compensation.map(|by| Shift::new(&by, before, &curve.path, frame.as_ref(), [workpiece, &world], seconds));
    let shift = shift.filter(Shift::leads);
    if weave.is_none() && shift.is_none() {
        return Ok(plain);
    }
    let manual = if settings.manual { MANUAL_SPEED_MM_S } else { f64::INFINITY };
    let weave = weave.map(|weave| Weaving { weave, rounding: 0.0, begun: 0.0, fades: !goes_on });
    let mut laid = OverlaidMotion { start: *start, frame, weave, shift, fastest: settings.max_tcp.min(manual), plain };
    let goes_on_from = flows_from.and_then(|motion| motion.laid.as_ref()?.at_end());
    if let (Some(weaving), Some(before)) = (weave, goes_on_from)
        && weaving.weave == before.weave
    {
        laid.weave = Some(Weaving { fades: weaving.fades, ..before });
        return laid.finished(robot);
    }
    match weave {
        Some(weaving) if weaving.weave.is_cornered() => laid.with_corners(robot, weaving),
        _ => laid.finished(robot),
    }
}

/// Two motions to be blended, with a weave that continues from the first into the second without a break.
pub(crate) fn joined(robot: &Robot, from: &Motion, to: &Motion) -> Option<(Motion, Motion)> {
    let (first, second) = (from.laid.as_ref()?, to.laid.as_ref()?);
    let (weaving, next) = (first.weave?, second.weave?);
    if weaving.weave != next.weave {
        return None;
    }
    let begun = weaving.begun + first.seconds();
    let on = OverlaidMotion { weave: Some(Weaving { fades: false, ..weaving }), ..OverlaidMotion::clone(first) };
    let on = on.finished(robot).ok()?;
    let taken =
        OverlaidMotion { weave: Some(Weaving { begun, ..next }), start: on.end, ..OverlaidMotion::clone(second) };
    Some((on, taken.finished(robot).ok()?))
}

impl OverlaidMotion {
    /// The share of the motion beyond which a blend with the next one comes too late, because the weave already fades
    /// out.
    pub(crate) fn fades_from(&self) -> f64 {
        let overlay = self.overlay().woven;
        overlay.map_or(1.0, |woven| 1.0 - woven.fading / woven.seconds)
    }

    /// How long the motion takes at full speed without overlays, in s.
    fn seconds(&self) -> f64 {
        if self.plain.limits.is_some() { 1.0 / self.plain.rate } else { 1.0 }
    }

    /// The weave that continues behind the motion.
    fn at_end(&self) -> Option<Weaving> {
        let weaving = self.weave.filter(|weaving| !weaving.fades)?;
        Some(Weaving { begun: weaving.begun + self.seconds(), ..weaving })
    }

    /// The motion with corners that are rounded as little as the speed allows.
    fn with_corners(&self, robot: &Robot, weaving: Weaving) -> Result<Motion, PlanError> {
        let swing = 1.0 / weaving.weave.frequency;
        let [shortest, longest] = ROUNDING_SHARES.map(|part| part * swing);
        let pace = &self.plain.pace;
        let (acc, jerk) = (robot.tcp.acc * pace.acc, robot.tcp.jerk * pace.jerk);
        let sharpest = Pattern::new(&weaving.weave, shortest).sharpest();
        let needed = (0.8 * sharpest / acc).max((1.6 * sharpest / jerk).sqrt());
        let mut rounding = needed.clamp(shortest, longest);
        let rounded = |rounding: f64| {
            let weave = Some(Weaving { rounding, ..weaving });
            OverlaidMotion { weave, ..self.clone() }.finished(robot)
        };
        let mut best = rounded(rounding)?;
        while best.share_of_speed() < UNSLOWED_SHARE && rounding < longest {
            rounding = (rounding * ROUNDING_STEP_FACTOR).min(longest);
            let motion = rounded(rounding)?;
            if motion.share_of_speed() > best.share_of_speed() {
                best = motion;
            }
        }
        Ok(best)
    }

    fn overlay(&self) -> Overlay {
        let seconds = self.seconds();
        let woven = self.weave.map(|Weaving { weave, rounding, begun, fades }| {
            let pattern = Pattern::new(&weave, rounding);
            // A blend with the motion before takes at most half of this one: what the blend meets must stay as it is.
            let fading = if fades { (pattern.period / 2.0).min(seconds / 2.0) } else { 0.0 };
            Woven { pattern, begun, seconds, fading }
        });
        Overlay { frame: self.frame, woven, shift: self.shift }
    }

    /// The motion with all its overlays.
    fn finished(self, robot: &Robot) -> Result<Motion, PlanError> {
        let Curve::Tool(plain) = &self.plain.curve else { return Ok(self.plain) };
        let overlay = self.overlay();
        let curve = ToolCurve {
            over: Some(Box::new(overlay)),
            passages: Vec::new(),
            close_places: Vec::new(),
            ..plain.clone()
        };
        let found = check_path(robot, &curve, &self.start)?;
        let mut end = Joints { axes: found.end, ..self.plain.end };
        for (value, axis) in end.axes.iter_mut().zip(robot.own_axes()) {
            *value = value.clamp(axis.min, axis.max);
        }
        let ends_on_path = self.shift.is_none() && self.weave.is_none_or(|weave| weave.fades);
        if ends_on_path {
            end = self.plain.end;
        }
        let moves = self.plain.limits.is_some() || self.shift.is_some_and(|shift| shift.grows());
        let limits = moves.then(|| {
            let constraints = self.constraints(robot, &curve, &found.rates);
            // A segment of a spline meets its neighbours at full speed.
            if self.plain.curve.is_paced() { passing(&constraints, self.plain.rate) } else { quickest(&constraints) }
        });
        let own = self.plain.limits.map(|_| self.plain.rate);
        let rate = own.or(limits.map(|limits| limits.vel)).unwrap_or(1.0);
        let motion = Motion { start: self.start, end, limits, rate, laid: None, ..self.plain.clone() };
        Ok(Motion { curve: Curve::Tool(curve), laid: Some(Box::new(self)), ..motion })
    }

    /// Everything that limits the parameter: the plain motion's own limits, the axes, the TCP, and the compensation's
    /// limits.
    fn constraints(&self, robot: &Robot, curve: &ToolCurve, rates: &[(f64, Rates)]) -> Vec<Constraint> {
        let mut constraints = Constraints::new(robot);
        let pace = &self.plain.pace;
        if let Some(limits) = self.plain.limits {
            constraints.rows.push(Constraint::even(1.0, limits.vel, limits.acc, limits.jerk));
        }
        for places in rates.chunks(PLACES_OF_CONSTRAINT) {
            let mut most = Most::default();
            let mut axes = Rates { first: [0.0; 6], second: [0.0; 6], third: [0.0; 6] };
            for (at, rates) in places {
                highest(&mut axes.first, &rates.first);
                highest(&mut axes.second, &rates.second);
                highest(&mut axes.third, &rates.third);
                most.see(curve, *at);
                if pace.manual {
                    constraints.manual_flange(curve, *at, 1.0);
                }
            }
            constraints.axes(&axes.first, &axes.second, &axes.third, pace);
            constraints.rows.extend(most.rows(robot, pace.acc, pace.jerk, self.fastest));
        }
        constraints.rows.extend(self.shift.iter().flat_map(Shift::constraints));
        constraints.rows
    }
}

fn highest<const N: usize>(most: &mut [f64; N], values: &[f64; N]) {
    for (most, value) in most.iter_mut().zip(values) {
        *most = most.max(value.abs());
    }
}

/// The largest derivatives of the TCP's position, of what weaving adds to it (mm), and of the tool's rotation (rad).
#[derive(Default)]
struct Most {
    speed: f64,
    weaving: [f64; 3],
    turning: [f64; 3],
}

impl Most {
    fn see(&mut self, curve: &ToolCurve, at: f64) {
        let [_, speed, ..] = curve.moving(at);
        self.speed = self.speed.max(speed.norm());
        let norms = |vectors: [Vector3<f64>; 3]| vectors.map(|vector| vector.norm());
        if let Some([_, first, second, third]) = curve.over.as_ref().and_then(|over| over.weaving(at)) {
            highest(&mut self.weaving, &norms([first, second, third]));
        }
        if curve.over.as_ref().is_some_and(|over| over.turns()) {
            highest(&mut self.turning, &norms(curve.rotation_rates(at)));
        }
    }

    fn rows(&self, robot: &Robot, acc: f64, jerk: f64, fastest: f64) -> [Constraint; 3] {
        let tcp = &robot.tcp;
        let row = |rates: [f64; 3], [vel, acc, jerk]: [f64; 3]| {
            let [first, second, third] = rates.map(|rate| rate * BETWEEN_SAMPLES_FACTOR);
            Constraint { first, second, third, vel, acc, jerk }
        };
        let turning = self.turning.map(f64::to_degrees);
        [
            Constraint::even(self.speed * BETWEEN_SAMPLES_FACTOR, tcp.vel.min(fastest), f64::INFINITY, f64::INFINITY),
            row(self.weaving, [f64::INFINITY, tcp.acc * acc, tcp.jerk * jerk]),
            row(turning, [tcp.ori_vel, tcp.ori_acc * acc, tcp.ori_jerk * jerk]),
        ]
    }
}
