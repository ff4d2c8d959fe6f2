//! From a command to a motion: geometry, checks, and the limits of the motion's parameter.

use nalgebra::{UnitQuaternion, Vector3};

use crate::command::check::check;
use crate::command::error::PlanError;
use crate::command::joints::{Joints, is_unset};
use crate::command::{Command, Settings, Target};
use crate::geometry::arc::arc_through;
use crate::geometry::quintic::Quintic;
use crate::geometry::tcp_path::TcpPath;
use crate::geometry::track::Track;
use crate::limits::constant::{highest_speed, passing, quickest};
use crate::limits::duration::slowest_within;
use crate::limits::profile::LOOK_AHEAD_MARGIN;
use crate::limits::profile::Limits;
use crate::overlay::CompensationState;
use crate::plan::constraints::{Constraints, PathLimits};
use crate::plan::curve::{Curve, ToolCurve};
use crate::plan::lay_overlay::{OverlayStart, lay};
use crate::plan::motion::{Motion, NO_MOTION_MM_OR_DEG};
use crate::plan::path_check::check_path;
use arl_robot::kinematics::{Frame, Passage, RANGE_SLACK, Refusal, Wanted, frame, frame_components};
use arl_robot::robot::{Axis, Robot, VelocityProfile};

/// Distances of an axis up to this (mm or deg) do not count as motion.
const NO_DISTANCE: f64 = 1e-10;

/// The largest angle of a circle, in deg.
const LARGEST_CIRCLE_DEG: f64 = 7200.0;

/// Plans a motion that starts at `start`.
///
/// # Errors
/// The target or the path to it is out of reach or out of the range of an axis, the path passes a singular point, the
/// duration is too short, a speed is not above zero, or a value is not a number. Nothing has moved in these cases.
pub fn plan(robot: &Robot, start: &Joints, command: &Command, settings: &Settings) -> Result<Motion, PlanError> {
    if !start.is_finite() {
        return Err(PlanError::NotANumber);
    }
    check(command, settings)?;
    plan_behind(robot, start, &CompensationState::default(), command, settings)
}

/// Plans a motion that starts at `start`, with the compensation in the state `before`.
pub(crate) fn plan_behind(
    robot: &Robot,
    start: &Joints,
    before: &CompensationState,
    command: &Command,
    settings: &Settings,
) -> Result<Motion, PlanError> {
    let (Target::Line { wobj, .. } | Target::Arc { wobj, .. }) = &command.target else {
        return plan_plain(robot, start, command, settings);
    };
    let before = &before.for_next(settings, &command.rig);
    let plain = without_compensation(robot, start, before, command)?;
    let motion = plan_plain(robot, &plain, command, settings)?;
    let beginning = OverlayStart { start, before, flows_from: None, goes_on: false };
    lay(robot, motion, &beginning, &wobj.rotation, settings)
}

/// The position of the robot without the compensation that leads it to `start`.
pub(crate) fn without_compensation(
    robot: &Robot,
    start: &Joints,
    before: &CompensationState,
    command: &Command,
) -> Result<Joints, PlanError> {
    if before.number == 0 {
        return Ok(*start);
    }
    let (kinematics, carried) = (&robot.kinematics, &command.rig.carried);
    let tcp = before.lead.undone(&carried.path_frame_at(&kinematics.forward(&start.axes)));
    let axes = kinematics.inverse(&carried.flange_at(&tcp), kinematics.cfg(&start.axes), &start.axes);
    axes.map(|axes| Joints { axes, ..*start }).ok_or(PlanError::Unreachable { beyond: 0.0, along: 0.0 })
}

/// Plans a motion without overlays.
fn plan_plain(robot: &Robot, start: &Joints, command: &Command, settings: &Settings) -> Result<Motion, PlanError> {
    let planner = Planner { robot, start, command, settings };
    match &command.target {
        Target::Joints(joints) => planner.axes(joints.completed(start, robot)),
        Target::Pose { pose, wobj, wanted, external } => planner.axes(planner.choose(pose, wobj, *wanted, external)?),
        Target::Line { pose, wobj, external } | Target::Spline { pose, wobj, external } => {
            planner.line(pose, wobj, external)
        }
        Target::Arc { via, pose, wobj, angle, follow, external } => {
            let (track, turning) = planner.arc(via, pose, wobj, *angle, *follow)?;
            planner.tool(track, turning, external)
        }
        Target::Circle { .. } => Err(PlanError::LoneCircle),
        Target::Gate { .. } => Err(PlanError::NotForThisRobot),
    }
}

/// Plans one motion.
pub(crate) struct Planner<'a> {
    pub(crate) robot: &'a Robot,
    pub(crate) start: &'a Joints,
    pub(crate) command: &'a Command,
    pub(crate) settings: &'a Settings,
}

impl Planner<'_> {
    /// The TCP's frame at the start, on its path.
    pub(crate) fn start_frame(&self) -> Frame {
        self.command.rig.carried.path_frame_at(&self.robot.kinematics.forward(&self.start.axes))
    }

    /// The TCP's frame at the target, on its path; unset components keep their values at the start, in the workpiece
    /// frame.
    pub(crate) fn target_frame(&self, pose: &[f64; 6], wobj: &Frame) -> Result<Frame, PlanError> {
        if pose.iter().any(|value| !value.is_finite()) {
            return Err(PlanError::NotANumber);
        }
        if !pose.iter().any(|value| is_unset(*value)) {
            return Ok(wobj * frame(*pose));
        }
        let start = wobj.inverse() * self.start_frame();
        let mut components = frame_components(&start);
        for (component, wanted) in components.iter_mut().zip(pose) {
            if !is_unset(*wanted) {
                *component = *wanted;
            }
        }
        let mut target = frame(components);
        let [_, _, _, turns @ ..] = pose;
        if turns.iter().all(|turn| is_unset(*turn)) {
            target.rotation = start.rotation;
        }
        Ok(wobj * target)
    }

    fn line(&self, pose: &[f64; 6], wobj: &Frame, external: &[f64; 6]) -> Result<Motion, PlanError> {
        let (start, end) = (self.start_frame(), self.target_frame(pose, wobj)?);
        let track = Track::line(start.translation.vector, end.translation.vector);
        self.tool(track, (end.rotation * start.rotation.inverse()).scaled_axis(), external)
    }

    /// The circle, and the rotation vector of the tool along it.
    fn arc(
        &self,
        via: &[f64; 3],
        pose: &[f64; 6],
        wobj: &Frame,
        angle: Option<f64>,
        follow: bool,
    ) -> Result<(Track, Vector3<f64>), PlanError> {
        if via.iter().any(|value| !value.is_finite()) || angle.is_some_and(|angle| !angle.is_finite()) {
            return Err(PlanError::NotANumber);
        }
        let [x, y, z] = *via;
        let via =
            self.target_frame(&[x, y, z, crate::command::UNSET, crate::command::UNSET, crate::command::UNSET], wobj)?;
        let (start, end) = (self.start_frame(), self.target_frame(pose, wobj)?);
        let points = [start, via, end].map(|frame| frame.translation.vector);
        let mut arc = arc_through(&points).ok_or(PlanError::NoCircle)?;
        let whole = arc.sweep;
        if let Some(angle) = angle {
            if angle.abs() > LARGEST_CIRCLE_DEG {
                return Err(PlanError::Circles { angle, most: LARGEST_CIRCLE_DEG });
            }
            arc.sweep = angle.to_radians();
        }
        let turning = if follow {
            arc.across.cross(&arc.along).normalize() * arc.sweep
        } else {
            // The orientation of the target belongs to the position of the target on the circle.
            (end.rotation * start.rotation.inverse()).scaled_axis() * (arc.sweep / whole)
        };
        Ok((Track::Arc(arc), turning))
    }

    /// The error for a target that no axis positions reach.
    pub(crate) fn refused(&self, refusal: Refusal) -> PlanError {
        match refusal {
            Refusal::NoSuchCfg { cfg } => PlanError::NoSuchCfg { cfg },
            Refusal::Unreachable { beyond } => PlanError::Unreachable { beyond, along: 1.0 },
            Refusal::Tilted { by } => PlanError::Tilted { by, along: 1.0 },
            Refusal::AxisLimit { axis, value } => match self.robot.axes.get(axis) {
                Some(axis) => limit(axis, value),
                None => PlanError::NotForThisRobot,
            },
        }
    }

    /// Moves `end` into the ranges of the axes where it is outside only due to rounding.
    fn within_ranges(&self, mut end: Joints) -> Result<Joints, PlanError> {
        let own = self.robot.own_axes().len();
        for (index, axis) in self.robot.axes.iter().enumerate() {
            let value = if index < own { end.axes.get_mut(index) } else { end.external.get_mut(index - own) };
            let Some(value) = value else { continue };
            if !value.is_finite() {
                return Err(PlanError::NotANumber);
            }
            if *value < axis.min - RANGE_SLACK || *value > axis.max + RANGE_SLACK {
                return Err(limit(axis, *value));
            }
            *value = value.clamp(axis.min, axis.max);
        }
        Ok(end)
    }

    /// The axis positions at a target pose.
    pub(crate) fn choose(
        &self,
        pose: &[f64; 6],
        wobj: &Frame,
        wanted: Wanted,
        external: &[f64; 6],
    ) -> Result<Joints, PlanError> {
        let target = self.command.rig.carried.flange_at(&self.target_frame(pose, wobj)?);
        let found = self.robot.kinematics.choose(&target, wanted, self.robot.own_axes(), &self.start.axes);
        let axes = found.map_err(|refusal| self.refused(refusal))?;
        Ok(Joints { axes, external: *external }.completed(self.start, self.robot))
    }

    pub(crate) fn axes(&self, end: Joints) -> Result<Motion, PlanError> {
        let end = self.within_ranges(end)?;
        let curve = Curve::even_axes(self.start, &end);
        let moves = self.moves(&end);
        let constraints =
            |pace: &PathLimits, constraints: &mut Constraints| constraints.even_axes(self.start, &end, pace);
        let caps = |constraints: &mut Constraints| {
            if self.settings.manual && moves {
                constraints.manual_axes(&curve, &self.command.rig.carried, self.start);
            }
        };
        self.motion(&curve, end, moves, [0.0, 0.0], constraints, caps)
    }

    pub(crate) fn tool(&self, track: Track, turning: Vector3<f64>, external: &[f64; 6]) -> Result<Motion, PlanError> {
        let end = Joints { axes: self.start.axes, external: *external }.completed(self.start, self.robot);
        let mut curve = self.even_curve(track, turning, &end);
        curve.cfg = self.configuration(&curve);
        self.along(curve, end)
    }

    /// A curve from the start along which the tool turns evenly.
    pub(crate) fn even_curve(&self, track: Track, turning: Vector3<f64>, end: &Joints) -> ToolCurve {
        ToolCurve {
            path: TcpPath {
                track,
                base: self.start_frame().rotation,
                turning: Quintic::even([0.0; 3], turning.into()).into(),
            },
            carried: self.command.rig.carried,
            external: Curve::even_axes(self.start, end).external(),
            cfg: 0,
            passages: Vec::new(),
            close_places: Vec::new(),
            over: None,
        }
    }

    /// Plans a segment of a smooth path, nominally in `time` s. Where it `flows`, it joins the motion before it without
    /// a stop.
    pub(crate) fn segment(
        &self,
        mut curve: ToolCurve,
        time: f64,
        external: &[f64; 6],
        flows: bool,
    ) -> Result<Motion, PlanError> {
        curve.cfg = self.configuration(&curve);
        self.find_passages(&mut curve);
        let found = check_path(self.robot, &curve, self.start).map_err(|error| self.at_the_wrist(error, &curve))?;
        curve.close_places = found.close_places(self.robot);
        let near_singular = found.near_singular;
        let end = Joints { axes: found.end, external: *external }.completed(self.start, self.robot);
        let end = self.within_ranges(end)?;
        let mut pace = self.pace(true)?;
        pace.tcp = pace.tcp.min(self.programmed_cap()?);
        let mut constraints = Constraints::new(self.robot);
        constraints.tool(&curve, &pace);
        constraints.external_along(&curve, &pace);
        if self.settings.manual {
            constraints.cap_tool(&curve, crate::plan::constraints::MANUAL_SPEED_MM_S);
            for (at, _) in &found.rates {
                constraints.manual_flange(&curve, *at, 1.0);
            }
        }
        for (_, rates) in &found.rates {
            constraints.axes(&rates.first, &rates.second, &rates.third, &pace);
        }
        let limits = passing(&constraints.rows, 1.0 / time);
        Ok(Motion {
            start: *self.start,
            end,
            rig: self.command.rig,
            limits: Some(limits),
            rate: 1.0 / time,
            flows,
            pace,
            profile: self.settings.profile,
            timed: self.command.duration.map(|_| limits.vel),
            length: curve.path.track.length(),
            angle: curve.turned_angle(),
            zone: self.command.zone,
            corner: None,
            ends: true,
            stretch: [0.0, 1.0],
            line: self.command.line,
            curve: Curve::Tool(curve),
            near_singular,
            laid: None,
        })
    }

    /// The highest speed of the TCP, in mm/s.
    pub(crate) fn tcp_speed(&self) -> Result<f64, PlanError> {
        let speed = self.pace(true)?.tcp.min(self.robot.tcp.vel).min(self.programmed_cap()?);
        Ok(if self.settings.manual { speed.min(crate::plan::constraints::MANUAL_SPEED_MM_S) } else { speed })
    }

    /// Finds where axis 4 has to be led through the wrist singularity, if `$WRIST` requires that.
    fn find_passages(&self, curve: &mut ToolCurve) {
        if self.settings.wrist {
            let kinematics = &self.robot.kinematics;
            let (start, axes) = (&self.start.axes, self.robot.own_axes());
            curve.passages = kinematics.passages(|at| curve.flange(at), curve.cfg, start, axes);
        }
    }

    /// Plans a motion along a path of the TCP that starts where the robot is.
    fn along(&self, mut curve: ToolCurve, end: Joints) -> Result<Motion, PlanError> {
        self.find_passages(&mut curve);
        let length = curve.path.track.length();
        let angle = UnitQuaternion::from_scaled_axis(Vector3::from(curve.path.turning.derivative(1, 0.0)));
        let angle = if curve.path.turning.is_even() {
            Vector3::from(curve.path.turning.derivative(1, 0.0)).norm().to_degrees()
        } else {
            angle.angle().to_degrees()
        };
        let goes = length.max(angle) >= NO_MOTION_MM_OR_DEG;
        let found = if goes { Some(check_path(self.robot, &curve, self.start)) } else { None };
        let found = found.transpose().map_err(|error| self.at_the_wrist(error, &curve))?;
        curve.close_places = found.as_ref().map_or(Vec::new(), |found| found.close_places(self.robot));
        let near_singular = found.as_ref().and_then(|found| found.near_singular);
        let axes = found.as_ref().map_or(self.start.axes, |found| found.end);
        let end = self.within_ranges(Joints { axes, ..end })?;
        let moves = goes || self.moves(&end);

        let constraints = |pace: &PathLimits, constraints: &mut Constraints| {
            constraints.even_external(self.start, &end, pace);
            constraints.tool(&curve, pace);
            for (_, rates) in found.iter().flat_map(|found| &found.rates) {
                constraints.axes(&rates.first, &rates.second, &rates.third, pace);
            }
        };
        let programmed_cap = self.programmed_cap()?;
        let caps = |constraints: &mut Constraints| {
            constraints.cap_tool(&curve, programmed_cap);
            if self.settings.manual {
                constraints.cap_tool(&curve, crate::plan::constraints::MANUAL_SPEED_MM_S);
                for (at, _) in found.iter().flat_map(|found| &found.rates) {
                    constraints.manual_flange(&curve, *at, 1.0);
                }
            }
        };
        let motion = self.motion(&Curve::Tool(curve.clone()), end, moves, [length, angle], constraints, caps)?;
        Ok(Motion { near_singular, ..motion })
    }

    /// Turns the error for a singular point that `$WRIST` would pass into a wrist error.
    fn at_the_wrist(&self, error: PlanError, curve: &ToolCurve) -> PlanError {
        const BESIDE_SHARE: f64 = 0.02;
        match error {
            PlanError::Singular { axis, along } if !self.settings.wrist => {
                let (kinematics, start) = (&self.robot.kinematics, &self.start.axes);
                let passages = kinematics.passages(|at| curve.flange(at), curve.cfg, start, self.robot.own_axes());
                let wrist =
                    |passage: &Passage| passage.from - BESIDE_SHARE < along && along < passage.to + BESIDE_SHARE;
                if passages.iter().any(wrist) {
                    PlanError::Wrist { axis, along }
                } else {
                    PlanError::Singular { axis, along }
                }
            }
            error => error,
        }
    }

    /// The configuration at the start. At a singular start two configurations meet: then the one in which the axes
    /// continue evenly.
    fn configuration(&self, curve: &ToolCurve) -> u8 {
        let kinematics = &self.robot.kinematics;
        let own = kinematics.cfg(&self.start.axes);
        let at = |cfg: u8, part: f64| {
            let curve = ToolCurve { cfg, ..curve.clone() };
            let axes = curve.axes(kinematics, part, &self.start.axes)?;
            Some(axes.iter().zip(&self.start.axes).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max))
        };
        let meets = |cfg: u8| at(cfg, 0.0).is_some_and(|far| far < 1e-3);
        let candidates = kinematics.configurations().iter().copied().filter(|cfg| *cfg == own || meets(*cfg));
        let far = |cfg: u8| at(cfg, 1e-3).unwrap_or(f64::INFINITY);
        candidates.min_by(|a, b| far(*a).total_cmp(&far(*b))).unwrap_or(own)
    }

    /// Whether any axis has to move.
    fn moves(&self, end: &Joints) -> bool {
        let pairs = self.start.all().into_iter().zip(end.all());
        pairs.into_iter().any(|(start, end)| (end - start).abs() > NO_DISTANCE)
    }

    /// A programmed value under the override.
    fn programmed(&self, what: &'static str, value: f64) -> Result<f64, PlanError> {
        let percent = self.settings.speed_percent;
        if !percent.is_finite() || percent <= 0.0 {
            return Err(PlanError::NoOverride { percent });
        }
        if value.is_finite() && value > 0.0 {
            Ok(value * percent / 100.0)
        } else {
            Err(PlanError::NoSpeed { what, value })
        }
    }

    fn programmed_cap(&self) -> Result<f64, PlanError> {
        let value = self.settings.max_tcp;
        if value.is_nan() || value <= 0.0 { Err(PlanError::NoHighestSpeed { value }) } else { Ok(value) }
    }

    /// The programmed speeds, as far as this kind of motion uses them.
    fn pace(&self, tool: bool) -> Result<PathLimits, PlanError> {
        let speed = &self.command.speed;
        let mut pace = self.free();
        if tool {
            pace.tcp = self.programmed("the speed of the TCP in mm/s", speed.tcp)?;
            pace.ori = self.programmed("the turning speed in deg/s", speed.ori)?;
        } else {
            pace.axes = self.programmed("the speed in percent", speed.percent)?.min(100.0) / 100.0;
        }
        for axis in self.robot.external_axes() {
            if axis.linear {
                pace.linear = self.programmed("the speed of linear external axes in mm/s", speed.exl)?;
            } else {
                pace.turning = self.programmed("the speed of external axes in deg/s", speed.exj)?;
            }
        }
        Ok(pace)
    }

    /// The robot's own limits alone.
    fn free(&self) -> PathLimits {
        let share = |percent: f64| percent.clamp(20.0, 100.0) / 100.0;
        PathLimits {
            acc: share(self.settings.acc_percent),
            jerk: match self.settings.profile {
                VelocityProfile::T => f64::INFINITY,
                VelocityProfile::S | VelocityProfile::O => share(self.settings.jerk_percent),
            },
            manual: self.settings.manual,
            ..PathLimits::FREE
        }
    }

    /// Finds the timing: `collect` collects the limits at a programmed speed or, for a programmed duration, those of
    /// the robot alone. `caps` slow the motion down in either case.
    fn motion(
        &self,
        curve: &Curve,
        end: Joints,
        moves: bool,
        [length, angle]: [f64; 2],
        collect: impl Fn(&PathLimits, &mut Constraints),
        caps: impl Fn(&mut Constraints),
    ) -> Result<Motion, PlanError> {
        let is_tool = matches!(curve, Curve::Tool(_));
        let (mut pace, mut constraints) = (self.free(), Constraints::new(self.robot));
        let mut highest = f64::INFINITY;
        let limits = match self.command.duration {
            None => {
                pace = self.pace(is_tool)?;
                pace.tcp = pace.tcp.min(if is_tool { self.programmed_cap()? } else { f64::INFINITY });
                collect(&pace, &mut constraints);
                caps(&mut constraints);
                moves.then(|| quickest(&constraints.rows))
            }
            Some(duration) => {
                collect(&pace, &mut constraints);
                let free =
                    if moves { quickest(&constraints.rows).duration_braking(1.0, LOOK_AHEAD_MARGIN) } else { 0.0 };
                if !duration.is_finite() || duration <= 0.0 || is_unset(duration) {
                    return Err(PlanError::NoSpeed { what: "the duration in s", value: duration });
                }
                if duration < free * (1.0 - 1e-9) {
                    return Err(PlanError::Duration { wanted: duration, least: free });
                }
                caps(&mut constraints);
                moves.then(|| {
                    let capped = quickest(&constraints.rows);
                    highest = capped.vel;
                    let at = |vel: f64| Limits { vel, ..capped };
                    // Only its speed is lower: it stops as soon as any other motion does.
                    at(slowest_within(duration, [1.0 / duration, highest], at))
                })
            }
        };
        // Where one motion leaves some of its speed for its own ramps, and its neighbour does not, the path through
        // both is nevertheless an even one.
        let rate = match limits {
            Some(_) if self.command.duration.is_none() => highest_speed(&constraints.rows),
            limits => limits.map_or(1.0, |limits| limits.vel),
        };
        Ok(Motion {
            curve: curve.clone(),
            start: *self.start,
            end,
            rig: self.command.rig,
            limits,
            rate,
            flows: false,
            pace,
            profile: self.settings.profile,
            timed: self.command.duration.map(|_| highest),
            length,
            angle,
            zone: self.command.zone,
            corner: None,
            ends: true,
            stretch: [0.0, 1.0],
            line: self.command.line,
            near_singular: None,
            laid: None,
        })
    }
}

fn limit(axis: &Axis, value: f64) -> PlanError {
    PlanError::AxisLimit { axis: axis.name.clone(), value, min: axis.min, max: axis.max, along: 1.0 }
}
