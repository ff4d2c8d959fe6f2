//! Checks whether motion can be planned with the values of a command. What belongs to the path itself (targets, speeds,
//! ranges) is checked where it is planned.

use super::{Command, Compensation, Gate, PlanError, Settings, Target, Weave};
use arl_robot::frames::Carried;
use arl_robot::kinematics::Frame;

/// A range of values, with its description.
#[derive(Clone, Copy)]
struct Range {
    low: f64,
    high: f64,
    expected: &'static str,
}

/// A quantity with its value and its range.
type Ranged = (&'static str, f64, Range);

const POSITIVE: Range = Range { low: f64::MIN_POSITIVE, high: f64::MAX, expected: "a finite number above 0" };
const NOT_NEGATIVE: Range = Range { low: 0.0, high: f64::MAX, expected: "a finite number, 0 or more" };
const FINITE: Range = Range { low: -f64::MAX, high: f64::MAX, expected: "a finite number" };
/// Includes infinite values, where these mean that nothing is limited.
const NUMBER: Range = Range { low: f64::NEG_INFINITY, high: f64::INFINITY, expected: "a number" };
const HALF_TURN: Range = Range { low: 0.0, high: 180.0, expected: "0 to 180" };

/// Checks whether a command can be planned with its values.
///
/// # Errors
/// The first value that is not a number, or is outside its range.
pub(crate) fn check(command: &Command, settings: &Settings) -> Result<(), PlanError> {
    all_within(&[
        ("the acceleration in percent", settings.acc_percent, NUMBER),
        ("the jerk in percent", settings.jerk_percent, NUMBER),
    ])?;
    let zone = &command.zone;
    for value in [zone.percent, zone.tcp, zone.ori, zone.joint, zone.turning, zone.linear] {
        within(("a blending zone", value, NUMBER))?;
    }
    let carried = match &command.rig.carried {
        Carried::Tool(tool) | Carried::Workpiece(tool) => tool,
    };
    let frames = [carried, &command.rig.base, &command.rig.workpiece.frame];
    if !frames.into_iter().chain(wobj(&command.target)).all(is_finite) {
        return Err(PlanError::NotANumber);
    }
    if let Target::Gate { gate, .. } = &command.target {
        check_gate(gate)?;
    }
    settings.weave.as_ref().map_or(Ok(()), check_weave)?;
    settings.compensation.as_ref().map_or(Ok(()), check_compensation)
}

fn check_gate(gate: &Gate) -> Result<(), PlanError> {
    within(("the highest position of a gate in mm", gate.highest.unwrap_or_default(), FINITE))?;
    for lift in [&gate.rising, &gate.falling] {
        within(("the acceleration of a gate in percent", lift.acc.unwrap_or_default(), NUMBER))?;
    }
    Ok(())
}

fn check_weave(weave: &Weave) -> Result<(), PlanError> {
    all_within(&[
        ("the frequency of the weave in 1/s", weave.frequency, POSITIVE),
        ("the amplitude of the weave in mm", weave.amplitude, NOT_NEGATIVE),
        ("the radius of the weave in mm", weave.radius, NOT_NEGATIVE),
        ("the angle of the weave in deg", weave.angle, HALF_TURN),
    ])?;
    weave.dwells.iter().try_for_each(|stay| within(("a dwell of the weave in s", *stay, NOT_NEGATIVE)))?;
    weave.turned.iter().try_for_each(|turn| within(("the turn of the weave in rad", *turn, FINITE)))
}

fn check_compensation(compensation: &Compensation) -> Result<(), PlanError> {
    compensation.limits.iter().try_for_each(|limit| within(("a limit of the compensation", *limit, POSITIVE)))?;
    compensation.all().try_for_each(|by| within(("the compensation in mm (deg)", by, FINITE)))
}

/// The workpiece frame of a target.
fn wobj(target: &Target) -> Option<&Frame> {
    match target {
        Target::Joints(_) => None,
        Target::Pose { wobj, .. }
        | Target::Line { wobj, .. }
        | Target::Arc { wobj, .. }
        | Target::Gate { wobj, .. }
        | Target::Circle { wobj, .. }
        | Target::Spline { wobj, .. } => Some(wobj),
    }
}

fn is_finite(frame: &Frame) -> bool {
    frame.translation.vector.iter().chain(frame.rotation.coords.iter()).all(|value| value.is_finite())
}

fn all_within(values: &[Ranged]) -> Result<(), PlanError> {
    values.iter().try_for_each(|value| within(*value))
}

fn within((what, value, Range { low, high, expected }): Ranged) -> Result<(), PlanError> {
    if (low..=high).contains(&value) { Ok(()) } else { Err(PlanError::OutOfRange { what, value, expected }) }
}
