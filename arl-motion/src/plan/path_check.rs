//! Walks a path of the TCP before it is executed: checks that it is reachable, within the ranges of the axes and clear
//! of singular points, and finds how the axes move along it.

use crate::command::error::PlanError;
use crate::command::joints::{Joints, is_unset};
use crate::geometry::parametrization::Parametrization;
use crate::plan::curve::{SINGULAR_CLEARANCE, ToolCurve};
use crate::plan::motion::NO_MOTION_MM_OR_DEG;
use arl_robot::kinematics::{
    Axes, CLEAR_OF_SINGULAR, RANGE_SLACK, Rates, Refusal, SHORTEST_STEP_S, Twist, lowest_pace, outruns,
};
use arl_robot::robot::{ROBOT_AXES, Robot};
use nalgebra::Vector3;

/// The result of the walk.
pub(crate) struct Survey {
    /// The axes at the end.
    pub(crate) end: Axes,
    /// The derivatives of the axes by the parameter, at places close enough to see every change.
    pub(crate) rates: Vec<(f64, Rates)>,
    /// The slowest place near a singular point, if the path comes near one.
    pub(crate) near_singular: Option<NearSingular>,
}

/// The longest step, as a share of the path.
const LONGEST_STEP_SHARE: f64 = 1.0 / 16.0;
/// The longest step on a path on which no axis moves farther than `SHORT_PATH_DEG_OR_MM` deg (mm).
const LONGEST_SHORT_STEP_SHARE: f64 = 0.5;
const SHORT_PATH_DEG_OR_MM: f64 = 3.0;
/// A step as a share of the length over which the axes' motion changes. A singular point is never stepped over: the
/// steps get shorter in proportion to its distance, and a step over which an axis jumps is halved.
const STEP_SHARE_OF_SCALE: f64 = 0.04;
/// A step, as a share of the path, where the derivatives of the axes are not known.
const BLIND_STEP_SHARE: f64 = 1e-3;
/// A path that changes over less than this share of it turns too sharply, or its overlay is too dense.
const DENSEST_SHARE: f64 = 1e-3;
/// An axis that is this far (deg) from its expected position has jumped to another solution, or the step was too long.
const JUMP_DEG: f64 = 10.0;
/// Distances ahead of a singular place (s at the lowest reasonable speed) at which the end of the arm's reach is
/// sought.
const ENDS_AHEAD_S: [f64; 5] = [0.01, 0.1, 1.0, 3.0, 10.0];
/// Steps through a passage of the wrist singularity.
const PASSAGE_STEPS: f64 = 48.0;
/// Index of axis 4.
const AXIS_4: usize = 3;
/// Distance from a jump at which its other side is checked.
const BESIDE_SHARE: f64 = 1e-9;
/// A place just behind the start and one just before the end, where the axes must not differ from the ends by more than
/// `BEHIND_END_JUMP_DEG` deg.
const BEHIND_END_SHARE: f64 = 1e-6;
const BEHIND_END_JUMP_DEG: f64 = 0.05;

/// Places of a path are close together where the axes' motion changes over less than this share of it: near singular
/// points.
const CLOSE_SHARE: f64 = 0.02;
/// The distance between close places, as a share of the length over which the axes' motion changes.
const CLOSE_STEP_SHARE: f64 = 0.06;

/// Where a motion passes close to a singular point, so that its axes slow it down.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub struct NearSingular {
    /// The axis that slows it down most: its index in [`Robot::axes`](arl_robot::robot::Description::axes).
    pub axis: usize,
    /// Place, as a share of the path.
    pub along: f64,
    /// Highest speed straight on along the path there, by the limits of the robot's own axes: mm/s of the TCP, or deg/s
    /// where the tool only turns.
    pub speed: f64,
    /// `mm/s` or `deg/s`.
    pub unit: &'static str,
}

impl NearSingular {
    /// The slower of two places of one kind of motion, or the only one.
    pub fn slower(one: Option<Self>, other: Option<Self>) -> Option<Self> {
        match (one, other) {
            (Some(one), Some(other)) => Some(if other.speed < one.speed { other } else { one }),
            (one, other) => one.or(other),
        }
    }
}

impl Survey {
    /// The places near singular points where the axes' motion changes so quickly that other places may miss it.
    pub(crate) fn close_places(&self, robot: &Robot) -> Vec<f64> {
        let mut places: Vec<f64> = Vec::new();
        for (at, rates) in &self.rates {
            let scale = rates.scale(&robot.axes);
            let far = places.last().is_none_or(|last| at - last >= CLOSE_STEP_SHARE * scale);
            if scale < CLOSE_SHARE && far {
                places.push(*at);
            }
        }
        places
    }
}

struct Walk<'a> {
    robot: &'a Robot,
    curve: &'a ToolCurve,
    /// The same path without overlays.
    plain: Option<ToolCurve>,
}

/// Walks `curve` from `start`.
pub(crate) fn check_path(robot: &Robot, curve: &ToolCurve, start: &Joints) -> Result<Survey, PlanError> {
    let plain = curve.over.as_ref().map(|_| ToolCurve { over: None, ..curve.clone() });
    let walk = Walk { robot, curve, plain };
    // The target first: if it cannot be reached, that is what the programmer wants to know.
    let target = walk.reaches_target(&start.axes)?;
    let short = target.iter().zip(&start.axes).all(|(end, start)| (end - start).abs() <= SHORT_PATH_DEG_OR_MM);
    let longest = if short { LONGEST_SHORT_STEP_SHARE } else { LONGEST_STEP_SHARE };

    let mut rates = Vec::with_capacity(32);
    let mut limits = Ranges::new(robot);
    let (mut at, mut here) = (0.0, start.axes);
    let mut known = walk.rates(0.0, &here);
    let glimpse = walk.axes(BEHIND_END_SHARE, &here)?;
    walk.no_jump(&here, &glimpse, turned_beside_end(known.as_ref()), 0.0)?;
    let longest = curve.over.as_ref().map_or(longest, |over| over.longest_step().min(longest));
    let (mut strip, mut near_singular) = (0.0, None);
    while at < 1.0 - BEHIND_END_SHARE {
        if known.is_some() {
            near_singular = NearSingular::slower(near_singular, walk.near_singular(at, &here)?);
        }
        let next =
            walk.next(at, &here, known.as_ref(), longest)?.min(jump_ahead(curve, at)).min(1.0 - BEHIND_END_SHARE);
        let (next, found) = walk.step(at, &here, known.as_ref(), next)?;
        if let Some(known) = known {
            limits.between(at, &here, &known, next - at);
            rates.push((at, known));
        }
        limits.at(next, &found);
        (at, here) = (next, found);
        known = walk.rates(at, &here);
        // Figures of a weave that are almost alike need not all be walked.
        if let Some((skip, plain)) = walk.figures_alike(at, at - strip, &here) {
            limits.between(at, &here, &plain, skip);
            at += skip;
            here = walk.axes(at, &here)?;
            limits.at(at, &here);
            known = walk.rates(at, &here);
            strip = at;
        }
    }
    if let Some(known) = known {
        near_singular = NearSingular::slower(near_singular, walk.near_singular(at, &here)?);
        rates.push((at, known));
    }
    let end = walk.axes(1.0, &here)?;
    walk.no_jump(&here, &end, turned_beside_end(known.as_ref()), 1.0)?;
    limits.at(1.0, &end);
    limits.broken.map_or(Ok(Survey { end, rates, near_singular }), Err)
}

/// How far an axis may turn, in deg, between an end of the path and a place just beside it, with the derivatives
/// `rates` at the end.
fn turned_beside_end(rates: Option<&Rates>) -> f64 {
    let fastest = rates.map_or(0.0, |rates| rates.first.iter().fold(0.0, |most: f64, rate| most.max(rate.abs())));
    BEHIND_END_JUMP_DEG + 2.0 * BEHIND_END_SHARE * fastest
}

/// The next side of a jump of the derivatives, where the path has an even pace in parts.
fn jump_ahead(curve: &ToolCurve, at: f64) -> f64 {
    if !curve.is_paced() {
        return f64::INFINITY;
    }
    let parts = Parametrization::PARTS as f64;
    let border = ((at + 2.0 * BESIDE_SHARE) * parts).floor() / parts;
    // From just before the border to just behind it, else to just before the next one.
    if (border - at).abs() < 2.0 * BESIDE_SHARE && at < border {
        border + BESIDE_SHARE
    } else {
        border + 1.0 / parts - BESIDE_SHARE
    }
}

/// An axis may differ from its expected position by this share of what the axes have moved since the previous place.
const EXPECTED_SHARE: f64 = 0.02;

/// Motion of an axis that takes less time than this, in s at its highest speed, is due to rounding.
const SEEN_S: f64 = 1e-9;
/// Where an axis differs from its expected position by more than this share of what the axes have moved since the
/// previous place, something in between has changed its motion.
const BENT_SHARE: f64 = 1e-3;

/// How long the slowest of the robot's own axes would take from `a` to `b`, in s at its highest speed.
fn farthest(robot: &Robot, a: &Axes, b: &Axes) -> f64 {
    let pairs = a.iter().zip(b).zip(robot.own_axes());
    pairs.map(|((a, b), axis)| (a - b).abs() / axis.vel).fold(0.0, f64::max)
}

/// Checks a short path at a few places, the first and the last of which are its ends; `None` where these are not enough
/// to know how the axes move, or where an axis leaves its range: [`check_path`] then gives the reason.
pub(crate) fn check_gentle_path<const N: usize>(
    robot: &Robot,
    curve: &ToolCurve,
    start: &Axes,
    places: &[f64; N],
) -> Option<Survey> {
    let walk = Walk { robot, curve, plain: None };
    let mut found = Survey { end: *start, rates: Vec::with_capacity(N), near_singular: None };
    let mut limits = Ranges::new(robot);
    for at in places {
        let expected = match found.rates.last() {
            Some((before, rates)) => ahead(&found.end, rates, at - before),
            None => *start,
        };
        let axes = curve.axes(&robot.kinematics, *at, &expected)?;
        if let Some((before, rates)) = found.rates.last() {
            let far = |other: &Axes| farthest(robot, &axes, other);
            if far(&expected) > EXPECTED_SHARE * far(&found.end) + SEEN_S {
                return None;
            }
            limits.between(*before, &found.end, rates, at - before);
        }
        limits.at(*at, &axes);
        let rates = walk.rates(*at, &axes)?;
        found.end = axes;
        found.rates.push((*at, rates));
    }
    limits.broken.is_none().then_some(found)
}

impl Walk<'_> {
    fn axes(&self, at: f64, near: &Axes) -> Result<Axes, PlanError> {
        let found = self.curve.axes(&self.robot.kinematics, at, near);
        found.ok_or_else(|| match self.curve.passage(at) {
            Some(_) => PlanError::Singular { axis: self.name(AXIS_4), along: at },
            None => self.unreachable(at),
        })
    }

    fn reaches_target(&self, near: &Axes) -> Result<Axes, PlanError> {
        let found = self.robot.kinematics.inverse(&self.curve.flange(1.0), self.curve.cfg_at(1.0), near);
        found.ok_or_else(|| self.unreachable(1.0))
    }

    /// The next place to check; never beyond the border of a passage.
    fn next(&self, at: f64, axes: &Axes, known: Option<&Rates>, longest: f64) -> Result<f64, PlanError> {
        let step = match (self.curve.passage(at), known) {
            (Some(passage), _) if at < passage.to => (passage.to - passage.from) / PASSAGE_STEPS,
            (_, None) => BLIND_STEP_SHARE,
            (_, Some(known)) => {
                let scale = self.scale_on_plain_path(known, at, axes);
                if scale < DENSEST_SHARE {
                    self.not_too_sharp(at, axes)?;
                }
                (STEP_SHARE_OF_SCALE * scale).min(longest)
            }
        };
        Ok(self.curve.borders().filter(|border| *border > at).fold(at + step, f64::min))
    }

    /// Advances to `next`, or less far where an axis jumps on the way there: then a singular point is in between, which
    /// the axes pass at a low speed, or cannot pass.
    fn step(&self, at: f64, here: &Axes, known: Option<&Rates>, mut next: f64) -> Result<(f64, Axes), PlanError> {
        loop {
            let expected = known.map_or(*here, |known| ahead(here, known, next - at));
            let found = self.axes(next, &expected)?;
            let jumping = worst_jump(&expected, &found).filter(|(_, jump)| *jump > JUMP_DEG);
            let passed = self.curve.passage(at).is_some();
            let bends = known.is_some() && self.plain.is_none() && !passed && self.bends(here, &expected, &found);
            if jumping.is_none() && !bends {
                return Ok((next, found));
            }
            let time = self.lowest_pace(f64::midpoint(at, next)) * (next - at);
            let is_short = time < SHORTEST_STEP_S;
            match jumping {
                Some((axis, _)) if passed || is_short || outruns(self.robot.own_axes(), here, &found, time) => {
                    return Err(self.jumps(axis, next, &found));
                }
                None if is_short => return Ok((next, found)),
                _ => next = f64::midpoint(at, next),
            }
        }
    }

    /// Whether the axes are so far from their expected positions that their motion changed in between: an arm that is
    /// all but stretched turns back within a hair's breadth.
    fn bends(&self, here: &Axes, expected: &Axes, found: &Axes) -> bool {
        farthest(self.robot, found, expected) > BENT_SHARE * farthest(self.robot, found, here) + SEEN_S
    }

    /// The path without overlays.
    fn plain_path(&self) -> &ToolCurve {
        self.plain.as_ref().unwrap_or(self.curve)
    }

    /// s per unit of the parameter at the lowest reasonable speed.
    fn lowest_pace(&self, at: f64) -> f64 {
        let ([_, travel, ..], [turning, ..]) = (self.plain_path().moving(at), self.plain_path().rotation_rates(at));
        lowest_pace(&travel, &turning)
    }

    /// The speed straight on along the path near a singular point. A place from which the axes cannot go on at the
    /// lowest reasonable speed is singular. In a passage axis 4 is led.
    fn near_singular(&self, at: f64, axes: &Axes) -> Result<Option<NearSingular>, PlanError> {
        let kinematics = &self.robot.kinematics;
        if self.curve.passage(at).is_some() || kinematics.clearance(axes) > CLEAR_OF_SINGULAR {
            return Ok(None);
        }
        let Some(rates) = kinematics.rates(axes, &self.straight_on(at)) else { return Ok(None) };
        let pace = self.lowest_pace(at);
        let (margin, axis) = rates.speed_margin(self.robot.own_axes(), pace);
        if margin < 1.0 {
            return Err(self.singular(axis, at));
        }
        let ([_, travel, ..], [turning, ..]) = (self.plain_path().moving(at), self.plain_path().rotation_rates(at));
        let (rate, unit) = match travel.norm() {
            rate if rate > NO_MOTION_MM_OR_DEG => (rate, "mm/s"),
            _ => (turning.norm().to_degrees(), "deg/s"),
        };
        Ok(Some(NearSingular { axis, along: at, speed: margin * rate / pace, unit }))
    }

    /// Returns an error where the axes' motion changes over so little of the path although they could go straight on:
    /// the path itself turns too sharply, or its overlay does.
    fn not_too_sharp(&self, at: f64, axes: &Axes) -> Result<(), PlanError> {
        if self.is_plain_clear(at, axes) {
            return Err(PlanError::TooDense { along: at });
        }
        let straight = self.robot.kinematics.rates(axes, &self.straight_on(at));
        let is_clear = straight.is_some_and(|straight| self.scale(&straight) >= DENSEST_SHARE);
        if is_clear { Err(PlanError::TooSharp { along: at }) } else { Ok(()) }
    }

    /// How the flange moves where the path goes straight on and the tool turns evenly.
    fn straight_on(&self, at: f64) -> Twist {
        let path = self.plain_path();
        let ([_, travel, ..], [turning, ..], rest) = (path.moving(at), path.rotation_rates(at), Vector3::zeros());
        path.carried.twist(&path.tcp(at), &[travel, rest, rest], &[turning, rest, rest])
    }

    /// The error for a path that is out of reach from here on, with the largest excess.
    fn unreachable(&self, along: f64) -> PlanError {
        let (mut farthest, mut tilt) = (0.0_f64, 0.0_f64);
        for step in 0..=32 {
            let flange = self.curve.flange(along + (1.0 - along) * f64::from(step) / 32.0);
            match self.robot.kinematics.refusal(&flange) {
                Refusal::Unreachable { beyond } => farthest = farthest.max(beyond),
                Refusal::Tilted { by } => tilt = tilt.max(by),
                Refusal::NoSuchCfg { .. } | Refusal::AxisLimit { .. } => {}
            }
        }
        if tilt > 0.0 {
            PlanError::Tilted { by: tilt, along }
        } else {
            PlanError::Unreachable { beyond: farthest, along }
        }
    }

    /// The derivatives of the axes; `None` at a singular point, where they would consist of rounding errors.
    fn rates(&self, at: f64, axes: &Axes) -> Option<Rates> {
        let kinematics = &self.robot.kinematics;
        let spoilt = self.curve.passage(at).is_none() && kinematics.clearance(axes) < SINGULAR_CLEARANCE;
        if spoilt { None } else { self.curve.rates(kinematics, at, axes) }
    }

    /// The share of the path over which the axes' motion changes substantially.
    fn scale(&self, rates: &Rates) -> f64 {
        rates.scale(&self.robot.axes)
    }

    /// The same share where the path has an overlay: how the axes change along the plain path shows how near a singular
    /// point is, while a weave would be at rest now and then.
    fn scale_on_plain_path(&self, rates: &Rates, at: f64, axes: &Axes) -> f64 {
        let plain = self.plain.as_ref().and_then(|plain| Some((plain, self.plain_rates(at, axes)?)));
        let Some((plain, plain_rates)) = plain else { return self.scale(rates) };
        let ([_, travel, ..], [_, whole, ..]) = (plain.moving(at), self.curve.moving(at));
        let slower = if travel.norm() > 0.0 { (travel.norm() / whole.norm()).min(1.0) } else { 1.0 };
        self.scale(&plain_rates) * slower
    }

    /// Whether only the overlay makes the axes' motion change so quickly.
    fn is_plain_clear(&self, at: f64, axes: &Axes) -> bool {
        self.plain.is_some() && self.plain_rates(at, axes).is_some_and(|plain| self.scale(&plain) >= DENSEST_SHARE)
    }

    fn plain_rates(&self, at: f64, axes: &Axes) -> Option<Rates> {
        self.robot.kinematics.rates(axes, &self.plain.as_ref()?.twist(at))
    }

    /// How far to skip ahead, by whole figures of a weave, after the last one has been walked for `walked`; with the
    /// derivatives of the axes along the plain path.
    fn figures_alike(&self, at: f64, walked: f64, axes: &Axes) -> Option<(f64, Rates)> {
        let (figure, until) = self.curve.over.as_ref()?.figures()?;
        if walked < figure {
            return None;
        }
        let plain = self.plain_rates(at, axes)?;
        let room = (STEP_SHARE_OF_SCALE * self.scale(&plain)).min(LONGEST_STEP_SHARE).min(until - at - figure);
        let skip = (room / figure).floor() * figure;
        (skip > 0.0).then_some((skip, plain))
    }

    fn no_jump(&self, expected: &Axes, found: &Axes, most: f64, at: f64) -> Result<(), PlanError> {
        match worst_jump(expected, found) {
            Some((axis, jump)) if jump > most => Err(self.jumps(axis, at, found)),
            _ => Ok(()),
        }
    }

    /// The error for an axis that jumps.
    fn jumps(&self, axis: usize, at: f64, found: &Axes) -> PlanError {
        if self.is_plain_clear(at, found) {
            PlanError::TooDense { along: at }
        } else {
            PlanError::Singular { axis: self.name(axis), along: at }
        }
    }

    fn singular(&self, axis: usize, at: f64) -> PlanError {
        // A stretched arm is singular, too; but the error there is that the line continues beyond the arm's reach.
        let pace = self.lowest_pace(at);
        let ends = |time: &f64| {
            let ahead = (at + time / pace).min(1.0);
            self.curve.axes(&self.robot.kinematics, ahead, &[0.0; ROBOT_AXES]).is_none()
        };
        if ENDS_AHEAD_S.iter().any(ends) {
            return self.unreachable(at);
        }
        PlanError::Singular { axis: self.name(axis), along: at }
    }

    fn name(&self, index: usize) -> String {
        self.robot.axes.get(index).map_or(String::new(), |axis| axis.name.clone())
    }
}

/// The axis that is farthest from its expected position, with the distance.
fn worst_jump(expected: &Axes, found: &Axes) -> Option<(usize, f64)> {
    let jumps = expected.iter().zip(found).map(|(expected, found)| (found - expected).abs());
    jumps.enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b))
}

/// The expected positions of the axes after a step.
fn ahead(here: &Axes, rates: &Rates, step: f64) -> Axes {
    let mut axes = *here;
    for (index, value) in axes.iter_mut().enumerate() {
        if let (Some(first), Some(second), Some(third)) =
            (rates.first.get(index), rates.second.get(index), rates.third.get(index))
        {
            *value += step * (first + step * (second / 2.0 + step * third / 6.0));
        }
    }
    axes
}

/// Watches the ranges of the axes, and remembers the first axis that leaves its range, with its farthest position.
struct Ranges<'a> {
    robot: &'a Robot,
    broken: Option<PlanError>,
}

impl<'a> Ranges<'a> {
    fn new(robot: &'a Robot) -> Self {
        Self { robot, broken: None }
    }

    fn at(&mut self, at: f64, axes: &Axes) {
        for (index, value) in axes.iter().enumerate() {
            self.check(at, index, *value);
        }
    }

    /// Checks an axis that turns back between two places, where it goes farthest.
    fn between(&mut self, at: f64, axes: &Axes, rates: &Rates, step: f64) {
        for (index, ((value, first), second)) in axes.iter().zip(&rates.first).zip(&rates.second).enumerate() {
            let back = -first / second;
            if back > 0.0 && back < step {
                self.check(at + back, index, value + 0.5 * first * back);
            }
        }
    }

    fn check(&mut self, at: f64, index: usize, value: f64) {
        let Some(axis) = self.robot.axes.get(index) else { return };
        let beyond = (value - axis.max).max(axis.min - value);
        if beyond <= RANGE_SLACK || is_unset(value) {
            return;
        }
        match &mut self.broken {
            None => {
                let (min, max) = (axis.min, axis.max);
                self.broken = Some(PlanError::AxisLimit { axis: axis.name.clone(), value, min, max, along: at });
            }
            Some(PlanError::AxisLimit { axis: first, value: farthest, min, max, .. }) if *first == axis.name => {
                if beyond > (*farthest - *max).max(*min - *farthest) {
                    *farthest = value;
                }
            }
            Some(_) => {}
        }
    }
}
