//! From a command to a motion: geometry, checks, and the limits of its path parameter.

use nalgebra::Vector3;

use super::command::{Command, Settings, Speed, Target};
use super::error::PlanError;
use super::joints::{Joints, is_unset};
use super::limits::{Bound, quickest};
use super::path::{Line, Path, distances};
use super::profile::{Limits, Profile, State};
use super::survey::survey;
use crate::kinematics::{Frame, RANGE_SLACK, Rates, Refusal, frame, frame_components};
use crate::robot::{Axis, Robot, TcpLimits};

/// The highest speed of the TCP in manual low-speed mode, in mm/s.
const MANUAL_SPEED: f64 = 250.0;
/// Between the places where a line is surveyed, derivatives are a little larger than at them.
const BETWEEN_SAMPLES: f64 = 1.005;
/// Distances up to this are no motion: mm or deg of an axis; mm and deg of the TCP.
const NO_DISTANCE: f64 = 1e-10;

/// A motion that is ready to run.
#[derive(Clone, PartialEq, Debug)]
pub struct Motion {
    pub(super) path: Path,
    pub(super) start: Joints,
    pub(super) end: Joints,
    pub(super) tool: Frame,
    /// `None` for a motion that goes nowhere.
    pub(super) limits: Option<Limits>,
    /// The line's length in mm, 0 for axis motions.
    pub(super) length: f64,
    pub(super) line: u32,
}

impl Motion {
    /// Where it starts.
    pub fn start(&self) -> &Joints {
        &self.start
    }

    /// Where it ends.
    pub fn end(&self) -> &Joints {
        &self.end
    }

    /// How long it takes at an override of 100 %, in s.
    pub fn duration(&self) -> f64 {
        self.limits.map_or(0.0, |limits| limits.duration(1.0))
    }

    /// The length of a line in mm; 0 for axis motions.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The profile that it has at an override of 100 %.
    pub(super) fn profile(&self) -> Profile {
        let whole = |limits| Profile::to_rest(State::default(), 1.0, &limits);
        self.limits.and_then(whole).unwrap_or(Profile::resting(1.0))
    }
}

/// Plans a motion that starts from rest at `start`.
///
/// # Errors
/// The target or the way to it is out of reach or of an axis's range, the line passes a singular point, the duration is
/// too short, a speed is not above zero. Nothing has moved then.
pub fn plan(robot: &Robot, start: &Joints, command: &Command, settings: &Settings) -> Result<Motion, PlanError> {
    let planner = Planner { robot, start, command, settings };
    match &command.target {
        Target::Joints(joints) => planner.axes(joints.completed(start, robot)),
        Target::Pose { pose, wobj, wanted, external } => {
            let target = planner.target_frame(pose, wobj)? * command.tool.inverse();
            let found = robot.kinematics.choose(&target, *wanted, robot.own_axes(), &start.axes);
            let axes = found.map_err(|refusal| planner.refused(refusal))?;
            planner.axes(Joints { axes, external: *external }.completed(start, robot))
        }
        Target::Line { pose, wobj, external } => {
            let end = planner.target_frame(pose, wobj)?;
            planner.line(end, Joints { axes: start.axes, external: *external }.completed(start, robot))
        }
    }
}

struct Planner<'a> {
    robot: &'a Robot,
    start: &'a Joints,
    command: &'a Command,
    settings: &'a Settings,
}

impl Planner<'_> {
    /// The TCP's frame at the start, in the base.
    fn start_frame(&self) -> Frame {
        self.robot.kinematics.forward(&self.start.axes) * self.command.tool
    }

    /// The TCP's frame at the target, in the base; unset components stay as at the start, seen in the workpiece frame.
    fn target_frame(&self, pose: &[f64; 6], wobj: &Frame) -> Result<Frame, PlanError> {
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

    fn refused(&self, refusal: Refusal) -> PlanError {
        match refusal {
            Refusal::NoSuchCfg { cfg } => PlanError::NoSuchCfg { cfg },
            Refusal::Unreachable { beyond } => PlanError::Unreachable { beyond, along: 1.0 },
            Refusal::Tilted { .. } => PlanError::Unreachable { beyond: 0.0, along: 1.0 },
            Refusal::AxisLimit { axis, value } => match self.robot.axes.get(axis) {
                Some(axis) => limit(axis, value),
                None => PlanError::NotForThisRobot,
            },
        }
    }

    /// Brings `end` into the ranges where it is beside them by rounding only.
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

    fn axes(&self, end: Joints) -> Result<Motion, PlanError> {
        let end = self.within_ranges(end)?;
        let travel = self.distances(&end);
        let own = self.robot.own_axes().len();
        let bounds = |speed: Option<&Speed>| -> Result<Vec<Bound>, PlanError> {
            let percent = match speed {
                Some(speed) => self.programmed("the speed in percent", speed.percent)?.min(100.0) / 100.0,
                None => 1.0,
            };
            let mut bounds = self.external_bounds(&end, speed)?;
            bounds.extend(self.robot.own_axes().iter().zip(&travel).map(|(axis, travel)| {
                let (acc, jerk) = self.softened(axis.acc, axis.jerk);
                Bound::even(*travel, axis.vel * percent, acc, jerk)
            }));
            Ok(bounds)
        };
        let moves = travel.iter().any(|travel| travel.abs() > NO_DISTANCE);
        let caps = if self.settings.manual && moves {
            let mut rates = [0.0; 6];
            for (rate, travel) in rates.iter_mut().zip(travel.iter().take(own)) {
                *rate = *travel;
            }
            vec![cap(self.fastest_tcp(&end, &rates), MANUAL_SPEED)]
        } else {
            Vec::new()
        };
        self.motion(Path::Axes, end, moves, 0.0, bounds, &caps)
    }

    /// The highest speed of the TCP along an axis motion, in mm per unit of the path.
    fn fastest_tcp(&self, end: &Joints, rates: &[f64; 6]) -> f64 {
        let farthest = rates.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        let steps = 16 + (farthest / 2.0) as usize;
        let speed = |step: usize| {
            let at = step as f64 / steps as f64;
            let joints = Path::Axes.joints(&self.robot.kinematics, self.start, end, at, self.start);
            let tcp: Vector3<f64> =
                (self.robot.kinematics.forward(&joints.axes) * self.command.tool).translation.vector;
            self.robot.kinematics.point_velocity(&joints.axes, rates, &tcp).norm()
        };
        (0..=steps).map(speed).fold(0.0, f64::max) * BETWEEN_SAMPLES
    }

    fn line(&self, target: Frame, end: Joints) -> Result<Motion, PlanError> {
        let start = self.start_frame();
        let line = Line::new(start, target, &self.command.tool, self.configuration(&start, &target));
        let (length, angle) = (line.length(), line.angle());
        let turns_or_travels = length > NO_DISTANCE || angle > NO_DISTANCE;
        let (axes, rates) = if turns_or_travels {
            let found = survey(self.robot, &line, self.start)?;
            (found.end, found.rates)
        } else {
            (self.start.axes, Vec::new())
        };
        let end = self.within_ranges(Joints { axes, ..end })?;
        let moves = turns_or_travels || self.distances(&end).iter().any(|travel| travel.abs() > NO_DISTANCE);

        let TcpLimits { vel, acc, jerk, ori_vel, ori_acc, ori_jerk } = self.robot.tcp;
        let bounds = |speed: Option<&Speed>| -> Result<Vec<Bound>, PlanError> {
            let (tcp, ori) = match speed {
                Some(speed) => (
                    self.programmed("the speed of the TCP in mm/s", speed.tcp)?.min(vel),
                    self.programmed("the turning speed in deg/s", speed.ori)?.min(ori_vel),
                ),
                None => (vel, ori_vel),
            };
            let mut bounds = self.external_bounds(&end, speed)?;
            let ((acc, jerk), (ori_acc, ori_jerk)) = (self.softened(acc, jerk), self.softened(ori_acc, ori_jerk));
            bounds.push(Bound::even(length, tcp, acc, jerk));
            bounds.push(Bound::even(angle, ori, ori_acc, ori_jerk));
            bounds.extend(rates.iter().flat_map(|rates| self.axis_bounds(rates)));
            Ok(bounds)
        };
        let mut caps = vec![cap(length, self.programmed_cap()?)];
        if self.settings.manual {
            caps.push(cap(length, MANUAL_SPEED));
        }
        self.motion(Path::Line(line), end, moves, length, bounds, &caps)
    }

    /// The configuration of the start. At a singular start two meet: then the one in which the axes go on evenly.
    fn configuration(&self, start: &Frame, target: &Frame) -> u8 {
        let kinematics = &self.robot.kinematics;
        let own = kinematics.cfg(&self.start.axes);
        let at = |cfg: u8, part: f64| {
            let line = Line::new(*start, *target, &self.command.tool, cfg);
            let axes = line.axes(kinematics, part, &self.start.axes)?;
            Some(axes.iter().zip(&self.start.axes).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max))
        };
        let meets = |cfg: u8| at(cfg, 0.0).is_some_and(|far| far < 1e-3);
        let candidates = kinematics.configurations().iter().copied().filter(|cfg| *cfg == own || meets(*cfg));
        let far = |cfg: u8| at(cfg, 1e-3).unwrap_or(f64::INFINITY);
        candidates.min_by(|a, b| far(*a).total_cmp(&far(*b))).unwrap_or(own)
    }

    fn axis_bounds(&self, rates: &Rates) -> impl Iterator<Item = Bound> {
        let derivatives = rates.first.into_iter().zip(rates.second).zip(rates.third);
        self.robot.own_axes().iter().zip(derivatives).map(|(axis, ((first, second), third))| {
            let (acc, jerk) = self.softened(axis.acc, axis.jerk);
            Bound {
                first: first.abs() * BETWEEN_SAMPLES,
                second: second.abs() * BETWEEN_SAMPLES,
                third: third.abs() * BETWEEN_SAMPLES,
                vel: axis.vel,
                acc,
                jerk,
            }
        })
    }

    fn external_bounds(&self, end: &Joints, speed: Option<&Speed>) -> Result<Vec<Bound>, PlanError> {
        let own = self.robot.own_axes().len();
        let travel = self.distances(end);
        let mut bounds = Vec::with_capacity(16);
        for (axis, travel) in self.robot.external_axes().iter().zip(travel.iter().skip(own)) {
            let vel = match speed {
                Some(speed) if axis.linear => {
                    self.programmed("the speed of linear external axes in mm/s", speed.exl)?
                }
                Some(speed) => self.programmed("the speed of external axes in deg/s", speed.exj)?,
                None => axis.vel,
            };
            let (acc, jerk) = self.softened(axis.acc, axis.jerk);
            bounds.push(Bound::even(*travel, vel.min(axis.vel), acc, jerk));
        }
        Ok(bounds)
    }

    /// How far every axis of the robot has to go, in the order of its axes.
    fn distances(&self, end: &Joints) -> Vec<f64> {
        let own = self.robot.own_axes().len();
        let all = distances(self.start, end);
        let (axes, external) = all.split_at(6.min(all.len()));
        axes.iter().take(own).chain(external.iter().take(self.robot.external_axes().len())).copied().collect()
    }

    /// A programmed speed under the override of `velset`.
    fn programmed(&self, what: &'static str, value: f64) -> Result<f64, PlanError> {
        let percent = self.settings.speed_percent;
        if percent.is_nan() || percent <= 0.0 {
            return Err(PlanError::NoSpeed { what: "the override of velset in percent", value: percent });
        }
        if value.is_nan() || value <= 0.0 {
            Err(PlanError::NoSpeed { what, value })
        } else {
            Ok(value * percent / 100.0)
        }
    }

    fn programmed_cap(&self) -> Result<f64, PlanError> {
        let value = self.settings.max_tcp;
        let what = "the highest speed of velset in mm/s";
        if value.is_nan() || value <= 0.0 { Err(PlanError::NoSpeed { what, value }) } else { Ok(value) }
    }

    /// Acceleration and jerk under `accset`.
    fn softened(&self, acc: f64, jerk: f64) -> (f64, f64) {
        let share = |percent: f64| percent.clamp(20.0, 100.0) / 100.0;
        (acc * share(self.settings.acc_percent), jerk * share(self.settings.jerk_percent))
    }

    /// Finds the timing: `bounds` gives the limits at a programmed speed or, for a programmed duration, those of the
    /// robot alone. `caps` slow the motion down in either case.
    fn motion(
        &self,
        path: Path,
        end: Joints,
        moves: bool,
        length: f64,
        bounds: impl Fn(Option<&Speed>) -> Result<Vec<Bound>, PlanError>,
        caps: &[Bound],
    ) -> Result<Motion, PlanError> {
        let limits = match self.command.duration {
            None => {
                let mut bounds = bounds(Some(&self.command.speed))?;
                bounds.extend(caps);
                moves.then(|| quickest(&bounds))
            }
            Some(duration) => {
                let mut bounds = bounds(None)?;
                let free = if moves { quickest(&bounds).duration(1.0) } else { 0.0 };
                if duration.is_nan() || duration <= 0.0 || duration < free * (1.0 - 1e-9) {
                    return Err(PlanError::Duration { wanted: duration, least: free });
                }
                bounds.extend(caps);
                moves.then(|| {
                    let capped = quickest(&bounds);
                    capped.slowed((capped.duration(1.0) / duration).min(1.0))
                })
            }
        };
        let (tool, line) = (self.command.tool, self.command.line);
        Ok(Motion { path, start: *self.start, end, tool, limits, length, line })
    }
}

fn limit(axis: &Axis, value: f64) -> PlanError {
    PlanError::AxisLimit { axis: axis.name.clone(), value, min: axis.min, max: axis.max, along: 1.0 }
}

/// A speed that must not be passed, whatever is programmed.
fn cap(by: f64, vel: f64) -> Bound {
    Bound::even(by, vel, f64::INFINITY, f64::INFINITY)
}
