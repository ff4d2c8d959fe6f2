//! The alarms for motions that cannot be planned, in terms of ARL.

use crate::fault::{Alarm, Fault, File};
use crate::motion::{Joints, PlanError, Target, UNSET};
use std::fmt::Write;

/// A tool or workpiece frame that an earlier motion, or a variable, has set.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Inherited {
    /// x, y, z in mm, a, b, c in deg.
    pub(crate) frame: [f64; 6],
    /// The motion that set it; `None` where the program wrote the system variable.
    pub(crate) from: Option<(File, u32)>,
}

/// Tool and workpiece frame that a motion does not give itself, where they are not the flange and the world.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub(crate) struct Mounts {
    pub(crate) tool: Option<Inherited>,
    pub(crate) wobj: Option<Inherited>,
}

impl Mounts {
    /// The words about them to append to the alarm of a target out of reach.
    fn words(&self, file: File) -> String {
        let all = [("w", "workpiece frame", "$DFWOBJ", self.wobj), ("t", "tool", "$DFTOOL", self.tool)];
        let words = all.into_iter().filter_map(|(label, name, variable, mount)| {
            let Inherited { frame, from } = mount?;
            let frame: Vec<String> = frame.iter().map(|value| ((value * 1e3).round() / 1e3).to_string()).collect();
            let from = match from {
                Some((other, line)) if other == file => format!("of line {line}"),
                Some((other, line)) => format!("of {}:{line}", other.name()),
                None => format!("in {variable}"),
            };
            Some(format!("; this motion gives no `{label}:`, so the {name} {{{}}} {from} applies", frame.join(",")))
        });
        words.collect()
    }
}

/// The alarm of a motion, here or in an earlier line of another file. An alarm about `target` shows it.
pub(super) fn alarm(
    error: PlanError,
    earlier: File,
    file: File,
    line: u32,
    target: Option<(&Target, Mounts)>,
) -> Alarm {
    if let PlanError::Earlier { line, error } = error {
        return alarm(*error, earlier, earlier, line, None);
    }
    let mut words = words(&error);
    if let Some((target, mounts)) = target.filter(|_| is_about_target(&error)) {
        let there = if words.ends_with("at the target") { "" } else { "; the target is" };
        let _ = write!(words, "{there} {}{}", written(target), mounts.words(file));
    }
    let words = words.into();
    let fault = match error {
        PlanError::NoCircle | PlanError::LoneCircle => Fault::ArcPlane(words),
        PlanError::AboveLimit { .. } => Fault::GateHeight(words),
        _ => Fault::Motion(words),
    };
    Alarm::new(fault, file, line)
}

/// Whether the error is about reaching the target.
fn is_about_target(error: &PlanError) -> bool {
    matches!(
        error,
        PlanError::AxisLimit { .. }
            | PlanError::Unreachable { .. }
            | PlanError::Tilted { .. }
            | PlanError::Singular { .. }
            | PlanError::Wrist { .. }
            | PlanError::TooDense { .. }
            | PlanError::TooSharp { .. }
            | PlanError::NoCircle
            | PlanError::NoSuchCfg { .. }
    )
}

/// A target as programs write it, with the components that are set: `{x 800, y 0}`.
fn written(target: &Target) -> String {
    const POSE: [&str; 6] = ["x", "y", "z", "a", "b", "c"];
    const AXES: [&str; 6] = ["j1", "j2", "j3", "j4", "j5", "j6"];
    const EXTERNAL: [&str; 6] = ["ej1", "ej2", "ej3", "ej4", "ej5", "ej6"];
    let (names, values, external) = match target {
        Target::Joints(Joints { axes, external }) => (AXES, axes, external),
        Target::Pose { pose, external, .. }
        | Target::Line { pose, external, .. }
        | Target::Arc { pose, external, .. }
        | Target::Gate { pose, external, .. }
        | Target::Circle { pose, external, .. }
        | Target::Spline { pose, external, .. } => (POSE, pose, external),
    };
    let all = names.into_iter().zip(values).chain(EXTERNAL.into_iter().zip(external));
    let set = all.filter(|(_, value)| value.abs() < UNSET);
    let parts: Vec<String> = set.map(|(name, value)| format!("{name} {}", (value * 1e3).round() / 1e3)).collect();
    format!("{{{}}}", parts.join(", "))
}

/// The text of the error. What programs set with instructions is given by the names of these.
fn words(error: &PlanError) -> String {
    const ABOVE_ZERO: &str = "it must be a number above 0";
    match error {
        PlanError::LoneCircle => {
            "one ccir alone makes no arc: another one must follow directly, before the program waits for the robot"
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
        PlanError::NoReturnMotion => {
            "the robot cannot go straight back to its path: it is in another configuration, or \
             in another turn of an axis, than when it was stopped; movej it near that position first"
                .into()
        }
        error => error.to_string(),
    }
}
