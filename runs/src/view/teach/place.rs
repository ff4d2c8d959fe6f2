//! How a robot would reach a place: in each configuration, how near to a limit or a singularity, or why not.

use arl_robot::Robot;
use arl_robot::frames::{Mount, Setting};
use arl_robot::kinematics::{Axes, Frame, Refusal, Singularity, Wanted, frame, frame_components, wrap_degrees};
use serde::{Deserialize, Serialize};

use super::points::expect_sensible;
use arl_wire::{Placed, placed, written};

/// Below this clearance of a singular point, the user is warned.
const NEAR_SINGULAR: f64 = 0.08;
/// The most places of a map.
const MOST_PLACES: usize = 40_000;

/// A place that is requested in one of three ways: as components in the workpiece frame, as the TCP in the world, as
/// axes.
#[derive(Clone, PartialEq, Deserialize, Debug)]
#[serde(deny_unknown_fields)]
pub(super) struct AskedPose {
    /// The channel of the robot, from 1.
    pub(super) channel: usize,
    #[serde(default)]
    components: Option<[f64; 6]>,
    #[serde(default)]
    placed: Option<Placed>,
    #[serde(default)]
    axes: Option<Vec<f64>>,
    setting: Where,
    /// The axes that a solution should be near.
    near: Vec<f64>,
    /// The components that the user sees: of the two ways to write an orientation, the one nearer to these is returned.
    #[serde(default)]
    before: Option<[f64; 6]>,
}

/// Tool, workpiece and base, as places.
#[derive(Clone, Copy, PartialEq, Deserialize, Debug)]
#[serde(deny_unknown_fields)]
pub(super) struct Where {
    tool: Placed,
    wobj: Placed,
    base: Placed,
}

/// How a place is reached.
#[derive(Clone, PartialEq, Serialize, Debug)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(in crate::view) struct TaughtPose {
    /// The TCP in the workpiece frame: x, y, z, a, b, c.
    components: [f64; 6],
    /// The TCP in the world.
    placed: Placed,
    solutions: Vec<Solution>,
    /// The nearest of the solutions that exist.
    nearest: Option<usize>,
}

/// A configuration: the axes, or why there are none.
#[derive(Clone, PartialEq, Serialize, Debug)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(in crate::view) struct Solution {
    cfg: u8,
    axes: Option<Axes>,
    why: Option<String>,
    /// 0 at a singular point, up to 1.
    clearance: f64,
    /// Which kind of singular point is near, if one is.
    near: Option<&'static str>,
}

/// A plane whose places are requested: that of x and y through a place in the workpiece frame, with its orientation.
#[derive(Clone, PartialEq, Deserialize, Debug)]
#[serde(deny_unknown_fields)]
pub(super) struct Map {
    /// The channel of the robot, from 1.
    pub(super) channel: usize,
    components: [f64; 6],
    setting: Where,
    near: Vec<f64>,
    /// How far it extends to each side of the robot, and the distance from place to place, in mm.
    half: f64,
    step: f64,
}

/// The places of a plane, row by row: a digit each, 0 where the robot does not reach, else how clear of singular points
/// it is.
#[derive(Clone, PartialEq, Serialize, Debug)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(in crate::view) struct Mapped {
    side: usize,
    step: f64,
    /// The first place, and the frame of the plane, in the world.
    origin: Placed,
    places: String,
}

impl Where {
    fn numbers(&self) -> impl Iterator<Item = f64> {
        [self.tool, self.wobj, self.base].into_iter().flatten()
    }

    fn setting(&self) -> Result<Setting, String> {
        [self.tool, self.wobj, self.base].iter().try_for_each(expect_turned)?;
        let tool = Mount { frame: placed(&self.tool), on_flange: true };
        let wobj = Mount { frame: placed(&self.wobj), on_flange: false };
        Ok(Setting::new(tool, wobj, placed(&self.base)))
    }
}

/// Checks that the quaternion of a place is a rotation.
fn expect_turned([.., i, j, k, w]: &Placed) -> Result<(), String> {
    let length = [i, j, k, w].iter().map(|part| *part * *part).sum::<f64>();
    if length > 0.0 { Ok(()) } else { Err("the quaternion of a pose must not be 0".to_owned()) }
}

/// The robot's own axes.
fn own(robot: &Robot, axes: &[f64]) -> Result<Axes, String> {
    let count = robot.own_axes().len();
    let given = axes.get(..count).ok_or_else(|| format!("{} has {count} axes", robot.name))?;
    let mut own = Axes::default();
    own.iter_mut().zip(given).for_each(|(axis, value)| *axis = *value);
    Ok(own)
}

/// A place and its solutions.
pub(super) fn place(robot: &Robot, asked: &AskedPose) -> Result<TaughtPose, String> {
    let optional = asked.components.into_iter().chain(asked.before).flatten().chain(asked.placed.into_iter().flatten());
    let axes = asked.near.iter().chain(asked.axes.iter().flatten()).copied();
    asked.setting.numbers().chain(optional).chain(axes).try_for_each(expect_sensible)?;
    asked.placed.iter().try_for_each(expect_turned)?;
    let setting = asked.setting.setting()?;
    let near = own(robot, &asked.near)?;
    let pose = match asked {
        AskedPose { components: Some(components), .. } => frame(*components),
        AskedPose { placed: Some(tcp), .. } => setting.workpiece().inverse() * placed(tcp),
        AskedPose { axes: Some(axes), .. } => setting.pose_of(&robot.kinematics.forward(&own(robot, axes)?)),
        _ => return Err("expected a pose as `components`, `placed` or `axes`".to_owned()),
    };
    let flange = setting.flange_of(&pose).map_err(|error| error.to_string())?;
    let solution = |cfg: &u8| solution(robot, &flange, *cfg, &near);
    let solutions: Vec<Solution> = robot.kinematics.configurations().iter().map(solution).collect();
    let far = |axes: &Axes| axes.iter().zip(&near).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
    let reached = solutions.iter().enumerate().filter_map(|(at, one)| Some((at, far(one.axes.as_ref()?))));
    let nearest = reached.min_by(|one, other| one.1.total_cmp(&other.1)).map(|(at, _)| at);
    let shown = asked.components.unwrap_or_else(|| components(&pose, asked.before.as_ref()));
    Ok(TaughtPose { components: shown, placed: written(&(setting.workpiece() * pose)), solutions, nearest })
}

/// The components of a pose: the angles have a second form, with a and c turned half around and b beyond the quarter.
fn components(pose: &Frame, before: Option<&[f64; 6]>) -> [f64; 6] {
    let first = frame_components(pose);
    let Some(before) = before else { return first };
    let [x, y, z, a, b, c] = first;
    let other = [x, y, z, wrap_degrees(a + 180.0), wrap_degrees(180.0 - b), wrap_degrees(c + 180.0)];
    let far = |one: &[f64; 6]| {
        one.iter().zip(before).skip(3).map(|(one, other)| wrap_degrees(one - other).abs()).sum::<f64>()
    };
    if far(&other) < far(&first) { other } else { first }
}

fn solution(robot: &Robot, flange: &Frame, cfg: u8, near: &Axes) -> Solution {
    let wanted = Wanted { cfg: Some(cfg), turn: -1 };
    match robot.kinematics.choose(flange, wanted, robot.own_axes(), near) {
        Ok(axes) => {
            let clearance = robot.kinematics.clearance(&axes);
            let near = (clearance < NEAR_SINGULAR).then(|| word(robot.kinematics.nearest_singularity(&axes)));
            Solution { cfg, axes: Some(axes), why: None, clearance, near }
        }
        Err(refusal) => Solution { cfg, axes: None, why: Some(why(robot, &refusal)), clearance: 0.0, near: None },
    }
}

fn word(singularity: Singularity) -> &'static str {
    match singularity {
        Singularity::Wrist => "wrist",
        Singularity::Elbow => "elbow",
        Singularity::Shoulder => "shoulder",
    }
}

fn why(robot: &Robot, refusal: &Refusal) -> String {
    match refusal {
        Refusal::NoSuchCfg { cfg } => format!("there is no configuration {cfg}"),
        Refusal::Unreachable { beyond } if *beyond > 0.0 => format!("{beyond:.0} mm out of reach"),
        Refusal::Unreachable { .. } => "not in this configuration".to_owned(),
        Refusal::Tilted { by } => format!("tilted by {by:.1} deg, which this robot cannot reach"),
        Refusal::AxisLimit { axis, value } => robot.own_axes().get(*axis).map_or_else(String::new, |axis| {
            format!("{} would be at {value:.1}, but its range is {} to {}", axis.name, axis.min, axis.max)
        }),
    }
}

/// The places of a plane.
pub(super) fn map(robot: &Robot, map: &Map) -> Result<Mapped, String> {
    let numbers = map.components.into_iter().chain([map.half, map.step]).chain(map.near.iter().copied());
    map.setting.numbers().chain(numbers).try_for_each(expect_sensible)?;
    let side = (2.0 * map.half / map.step).floor() + 1.0;
    if !(side >= 1.0 && side * side <= MOST_PLACES as f64) {
        return Err(format!("a map has at most {MOST_PLACES} positions"));
    }
    let (side, setting, near) = (side as usize, map.setting.setting()?, own(robot, &map.near)?);
    let [_, _, z, a, b, c] = map.components;
    // Around the robot's base, in the plane of the workpiece.
    let base = setting.workpiece().inverse() * placed(&map.setting.base);
    let corner = [base.translation.x - map.half, base.translation.y - map.half];
    let mut places = String::with_capacity(side * side);
    for row in 0..side {
        for column in 0..side {
            let [x, y] = [(corner[0], column), (corner[1], row)].map(|(from, at)| from + at as f64 * map.step);
            let reached = setting.flange_of(&frame([x, y, z, a, b, c])).ok().and_then(|flange| {
                let solutions = robot.kinematics.configurations().iter();
                let clearances = solutions.filter_map(|cfg| {
                    let found = solution(robot, &flange, *cfg, &near);
                    found.axes.map(|_| found.clearance)
                });
                clearances.max_by(f64::total_cmp)
            });
            let digit = reached.map_or(0, |clearance| 1 + (clearance * 8.0).clamp(0.0, 8.0) as u32);
            places.extend(char::from_digit(digit, 10));
        }
    }
    let origin = written(&(setting.workpiece() * frame([corner[0], corner[1], z, 0.0, 0.0, 0.0])));
    Ok(Mapped { side, step: map.step, origin, places })
}
