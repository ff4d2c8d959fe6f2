//! Whether a robot can reach a target, according to its kinematics.

use crate::diagnostics::targets::TargetProblem;
use arl_robot::Robot;
use arl_robot::frames::{Carried, StraightPath};
use arl_robot::kinematics::{Axes, Frame, RANGE_SLACK, Refusal};

/// Closer to a singular point than this, the pose does not determine all axes; they are then where the path has led
/// them.
pub(super) const OPEN: f64 = 1e-4;

/// The result of checking a pose.
pub(super) enum Verdict {
    /// These axes reach it; if no configuration was requested, those of the first one that does.
    Reached(Axes),
    /// Possibly reached, depending on the path.
    Open,
    /// No axes reach it.
    Refused(TargetProblem),
}

/// A straight line of the TCP.
pub(super) struct TcpLine<'a> {
    pub(super) start: &'a Axes,
    pub(super) carried: Carried,
    /// The TCP at the end of the line.
    pub(super) end: Frame,
    pub(super) cfg: u8,
}

/// The first axis of a joint target that is out of its range.
pub(super) fn joints(robot: &Robot, target: &[(&str, f64)]) -> Option<TargetProblem> {
    robot.axes.iter().find_map(|axis| {
        let (_, value) = *target.iter().find(|(name, _)| axis.name.eq_ignore_ascii_case(name))?;
        let by = (axis.min - value).max(value - axis.max);
        (by > RANGE_SLACK).then(|| TargetProblem::joint(robot, axis, value, by))
    })
}

/// Whether the flange can reach `flange`, relative to the robot's base, in configuration `cfg` or, without one, in any.
pub(super) fn pose(robot: &Robot, flange: &Frame, cfg: Option<u8>) -> Verdict {
    let kinematics = &robot.kinematics;
    let all = kinematics.configurations();
    let asked = match &cfg {
        None => all,
        Some(cfg) if all.contains(cfg) => std::slice::from_ref(cfg),
        Some(cfg) => return Verdict::Refused(TargetProblem::no_such_cfg(robot, i32::from(*cfg))),
    };
    let mut beyond = None;
    for cfg in asked {
        let Some(axes) = kinematics.inverse(flange, *cfg, &[0.0; 6]) else { continue };
        match beyond_range(robot, &axes) {
            None => return Verdict::Reached(axes),
            Some(_) if kinematics.clearance(&axes) < OPEN => return Verdict::Open,
            Some(found) => beyond = beyond.or(Some((*cfg, found))),
        }
    }
    let others = || all.iter().copied().filter(|cfg| fits(robot, flange, *cfg)).collect();
    match (beyond, kinematics.refusal(flange)) {
        (Some((found, (axis, value, by))), _) => {
            let others = if cfg.is_some() { others() } else { Vec::new() };
            let Some(axis) = robot.axes.get(axis) else { return Verdict::Open };
            Verdict::Refused(TargetProblem::pose(robot, axis, value, by, found, others))
        }
        (None, Refusal::Tilted { by }) => Verdict::Refused(TargetProblem::tilted(robot, by)),
        (None, Refusal::Unreachable { beyond }) if beyond > RANGE_SLACK => {
            Verdict::Refused(TargetProblem::out_of_reach(robot, beyond))
        }
        (None, _) => match cfg {
            // At the boundary of the reach rounding matters, so the path decides.
            Some(cfg) if others_reach(robot, flange) => {
                Verdict::Refused(TargetProblem::configuration(robot, cfg, others()))
            }
            _ => Verdict::Open,
        },
    }
}

fn others_reach(robot: &Robot, flange: &Frame) -> bool {
    let kinematics = &robot.kinematics;
    kinematics
        .configurations()
        .iter()
        .filter_map(|cfg| kinematics.inverse(flange, *cfg, &[0.0; 6]))
        .any(|axes| kinematics.clearance(&axes) > OPEN)
}

fn fits(robot: &Robot, flange: &Frame, cfg: u8) -> bool {
    robot.kinematics.inverse(flange, cfg, &[0.0; 6]).is_some_and(|axes| beyond_range(robot, &axes).is_none())
}

/// The first axis that no number of whole turns brings into its range: its index, its value nearest to the range, and
/// how far that is beyond the range.
fn beyond_range(robot: &Robot, axes: &Axes) -> Option<(usize, f64, f64)> {
    robot.own_axes().iter().zip(axes).enumerate().find_map(|(at, (axis, value))| {
        let (value, by) = axis.nearest_to_range(*value);
        (by > RANGE_SLACK).then_some((at, value, by))
    })
}

/// The singular point that a line passes.
pub(super) fn line(robot: &Robot, line: &TcpLine<'_>) -> Option<TargetProblem> {
    let start = line.carried.path_frame_at(&robot.kinematics.forward(line.start));
    let path = StraightPath::new(line.carried, start, &line.end);
    let (at, axes) = path.singular_point(robot, line.cfg, line.start)?;
    Some(TargetProblem::singular(robot, at, robot.kinematics.nearest_singularity(&axes)))
}
