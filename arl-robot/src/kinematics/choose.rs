//! The choice among several joint vectors for one pose: by `cfg`, `turn`, axis limits and distance.

use std::fmt;

use super::frame::Frame;
use super::{Axes, Kinematics, wrap_degrees};
use crate::robot::Axis;

/// The wanted solution of a pose.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Wanted {
    /// The configuration; `None` for the one whose axes are nearest to the start.
    pub cfg: Option<u8>,
    /// -1: every axis as near to the start as its range allows. Otherwise bit i requests an angle of axis i + 1 below 0
    /// (set) or from 0 on (clear), which matters if whole turns leave a choice.
    pub turn: i32,
}

/// The possible values of `cfg`, in words.
pub const CONFIGURATIONS: &str = "a six-axis robot has 0 to 7, a SCARA robot has 0 (right-handed) and 4 (left-handed)";

/// The reason why no joint vector for a pose was found.
#[derive(Clone, PartialEq, Debug)]
pub enum Refusal {
    /// The robot does not have this configuration.
    NoSuchCfg {
        /// The requested configuration.
        cfg: u8,
    },
    /// The pose is out of reach.
    Unreachable {
        /// The missing reach of the arm, in mm; 0 if the configuration is the reason.
        beyond: f64,
    },
    /// The flange would have to tilt, which a SCARA robot cannot do.
    Tilted {
        /// The tilt, in deg.
        by: f64,
    },
    /// The pose can only be reached with an axis outside its range.
    AxisLimit {
        /// The axis, counted from 0.
        axis: usize,
        /// The position that it would need, in deg (mm).
        value: f64,
    },
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Refusal::NoSuchCfg { cfg } => write!(f, "the robot has no configuration {cfg}: {CONFIGURATIONS}"),
            Refusal::Unreachable { beyond } if *beyond > 0.0 => write!(f, "the arm falls short by {beyond:.1} mm"),
            Refusal::Unreachable { .. } => write!(f, "the configuration does not reach the pose"),
            Refusal::Tilted { by } => write!(f, "the flange would have to tilt by {by:.1} deg"),
            Refusal::AxisLimit { axis, value } => {
                write!(f, "axis {} would have to be at {value:.3} deg (mm), outside its range", axis + 1)
            }
        }
    }
}

impl std::error::Error for Refusal {}

impl Kinematics {
    /// The wanted joint vector for `flange`, within the ranges of `axes`, the robot's own.
    ///
    /// # Errors
    /// None is found; the reason is that of the requested configuration, or that of the nearest one.
    pub fn choose(&self, flange: &Frame, wanted: Wanted, axes: &[Axis], near: &Axes) -> Result<Axes, Refusal> {
        let one = |cfg: u8| {
            let solution = self.inverse(flange, cfg, near).ok_or_else(|| self.refusal(flange))?;
            turn(&solution, wanted.turn, axes, near)
        };
        if let Some(cfg) = wanted.cfg {
            return if self.configurations().contains(&cfg) { one(cfg) } else { Err(Refusal::NoSuchCfg { cfg }) };
        }
        let mut best: Option<(f64, Axes)> = None;
        let mut refusal = None;
        for cfg in self.configurations() {
            match one(*cfg) {
                Ok(found) => {
                    let far = found.iter().zip(near).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                    if best.is_none_or(|(least, _)| far < least) {
                        best = Some((far, found));
                    }
                }
                // A limit is more informative than a configuration that does not reach the pose.
                Err(found @ Refusal::AxisLimit { .. }) => refusal = Some(found),
                Err(found) => {
                    refusal.get_or_insert(found);
                }
            }
        }
        best.map(|(_, axes)| axes).ok_or_else(|| refusal.unwrap_or_else(|| self.refusal(flange)))
    }
}

/// Adds whole turns so that every axis is in its range, has the sign that `turn` requests if possible, and is near.
fn turn(solution: &Axes, turn: i32, axes: &[Axis], near: &Axes) -> Result<Axes, Refusal> {
    let mut chosen = *solution;
    for (index, ((value, axis), near)) in chosen.iter_mut().zip(axes).zip(near).enumerate() {
        let below = (turn != -1).then_some((turn >> index) & 1 == 1);
        match with_turns(*value, below, axis, *near) {
            Some(found) => *value = found,
            None => return Err(Refusal::AxisLimit { axis: index, value: *value }),
        }
    }
    Ok(chosen)
}

/// Positions outside a range by at most this (deg, mm) are clamped to it.
pub const RANGE_SLACK: f64 = 1e-6;

fn with_turns(value: f64, below: Option<bool>, axis: &Axis, near: f64) -> Option<f64> {
    let fits = |value: f64| value >= axis.min - RANGE_SLACK && value <= axis.max + RANGE_SLACK;
    if axis.linear {
        return fits(value).then(|| value.clamp(axis.min, axis.max));
    }
    let first = wrap_degrees(value);
    let nearest = first + ((near - first) - wrap_degrees(near - first));
    if below.is_none() && fits(nearest) {
        return Some(nearest.clamp(axis.min, axis.max));
    }
    let lowest = ((axis.min - first) / 360.0).floor() as i64;
    let highest = ((axis.max - first) / 360.0).ceil() as i64;
    let cost = |value: f64| {
        let wrong_side = below.is_some_and(|below| below != (value < -1e-9));
        (wrong_side, (value - near).abs())
    };
    (lowest..=highest)
        .map(|turns| first + 360.0 * turns as f64)
        .filter(|value| fits(*value))
        .map(|value| value.clamp(axis.min, axis.max))
        .min_by(|a, b| {
            let ((side_a, far_a), (side_b, far_b)) = (cost(*a), cost(*b));
            side_a.cmp(&side_b).then(far_a.total_cmp(&far_b))
        })
}
