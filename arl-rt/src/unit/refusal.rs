//! The alarms of motions that cannot be planned, in the words of ARL.

use crate::fault::{Alarm, Fault, File};
use crate::motion::PlanError;

/// The alarm of a motion, here or in an earlier line of another file.
pub(super) fn alarm(error: PlanError, earlier: File, (file, line): (File, u32)) -> Alarm {
    if let PlanError::Earlier { line, error } = error {
        return alarm(*error, earlier, (earlier, line));
    }
    let words = words(&error).into();
    let fault = match error {
        PlanError::NoCircle | PlanError::LoneCircle => Fault::ArcPlane(words),
        PlanError::AboveLimit { .. } => Fault::GateHeight(words),
        _ => Fault::Motion(words),
    };
    Alarm::new(fault, file, line)
}

/// What is wrong. Where the planner speaks of what programs set with instructions, these are named.
fn words(error: &PlanError) -> String {
    const ABOVE_ZERO: &str = "it must be a number above 0";
    match error {
        PlanError::LoneCircle => {
            "one ccir alone makes no arc: it takes another one right behind it, before the program waits for the robot"
                .into()
        }
        PlanError::AboveLimit { height, highest } => {
            format!("the jump starts or ends at the height {height:.3}, above its limit of {highest:.3}")
        }
        PlanError::NoOverride { percent } => {
            format!("the override of velset in percent is {percent}: {ABOVE_ZERO}")
        }
        PlanError::NoHighestSpeed { value } => {
            format!("the highest speed of velset in mm/s is {value}: {ABOVE_ZERO}")
        }
        PlanError::NoWayBack => {
            "the robot cannot go straight back to its path: it stands in another configuration, or \
             in another turn of an axis, than where it was stopped; movej it near that place first"
                .into()
        }
        error => error.to_string(),
    }
}
