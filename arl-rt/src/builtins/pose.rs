//! `cjoint`, `cpose`, `getpose` and `getjoint`: the robot's current position, and conversions between poses and axes.

pub use crate::builtins::frames::{offset, poseinv, reltool};

use crate::builtins::frames::{Setting, is_open};
use crate::builtins::motion::wanted;
use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::unit::{Unit, joint, tidy};
use crate::values::{Joint, Pose, Tool, Wobj};
use arl_robot::kinematics::{Axes, CONFIGURATIONS, Refusal, frame_components};

/// The axes as the robot reports them now, in deg (mm); external axes that do not exist are unset.
pub fn cjoint(cx: &Cx) -> Joint {
    match cx.channel_state().robot() {
        Some(unit) => joint(unit.feedback()),
        None => cx.without_robot("cjoint"),
    }
}

/// The pose of the tool in the workpiece frame as the robot reports it now, in mm and deg, with the external axes.
///
/// # Errors
/// The tool or the workpiece frame contains a value that is not a number.
pub fn cpose(cx: &Cx, t: Tool, w: &Wobj) -> Result<Pose, Fault> {
    let unit = cx.channel_state().unit("cpose")?;
    known("cpose", &t, w)?;
    let feedback = unit.feedback();
    Ok(pose(cx, &unit, &feedback.axes, &joint(feedback), t, w))
}

/// The pose of `$DFTOOL` in `$DFWOBJ` as the robot reports it now, in mm and deg, with the external axes.
///
/// # Errors
/// Those of [`cpose`].
pub fn cpose_default(cx: &Cx) -> Result<Pose, Fault> {
    cpose(cx, cx.system().dftool.get(), &cx.system().dfwobj.get())
}

/// The pose of the tool in the workpiece frame for given axes.
///
/// # Errors
/// Axes of the robot are unset; or the axes, the tool or the workpiece frame contains a value that is not a number.
pub fn getpose(cx: &Cx, j: Joint, t: Tool, w: &Wobj) -> Result<Pose, Fault> {
    let unit = cx.channel_state().unit("getpose")?;
    known("getpose", &t, w)?;
    let mut axes = j.axes();
    let own = unit.robot().own_axes().len();
    if axes.iter().take(own).any(|axis| is_open(*axis)) {
        return Err(domain("getpose", "axes of the robot are not set or are not numbers".to_owned()));
    }
    axes.iter_mut().skip(own).for_each(|axis| *axis = 0.0);
    Ok(pose(cx, &unit, &axes, &j, t, w))
}

/// The axes that bring the tool to a pose in the workpiece frame, in the configuration of the pose; the external axes
/// are those of the pose.
///
/// # Errors
/// Components of the pose are unset; the pose, the tool or the workpiece frame contains a value that is not a number;
/// or the pose cannot be reached in this configuration.
pub fn getjoint(cx: &Cx, p: Pose, t: Tool, w: &Wobj) -> Result<Joint, Fault> {
    let components = p.components();
    if components.iter().any(|component| is_open(*component)) {
        return Err(domain("getjoint", "components of the pose are not set or are not numbers".to_owned()));
    }
    known("getjoint", &t, w)?;
    let unit = cx.channel_state().unit("getjoint")?;
    let robot = unit.robot();
    let target = arl_robot::kinematics::frame(components);
    let flange = setting(cx, &t, w).flange_of(&target).map_err(|unmoved| domain("getjoint", unmoved.to_string()))?;
    let near = unit.target().axes;
    let axes = robot
        .kinematics
        .choose(&flange, wanted(&p, true)?, robot.own_axes(), &near)
        .map_err(|refusal| domain("getjoint", refused(&unit, &refusal)))?;
    let mut joint = Joint::of_axes(axes.map(tidy));
    (joint.ej1, joint.ej2, joint.ej3, joint.ej4, joint.ej5, joint.ej6) = (p.ej1, p.ej2, p.ej3, p.ej4, p.ej5, p.ej6);
    Ok(joint)
}

/// The pose of the tool in the workpiece frame for the robot's axes, with these external axes.
pub(crate) fn pose(cx: &Cx, unit: &Unit, axes: &Axes, external: &Joint, t: Tool, w: &Wobj) -> Pose {
    let kinematics = &unit.robot().kinematics;
    let [x, y, z, a, b, c] = frame_components(&setting(cx, &t, w).pose_of(&kinematics.forward(axes))).map(tidy);
    let cfg = i32::from(kinematics.cfg(axes));
    let [ej1, ej2, ej3, ej4, ej5, ej6] = external.external();
    Pose { x, y, z, a, b, c, cfg, turn: -1, ej1, ej2, ej3, ej4, ej5, ej6 }
}

/// The frames between poses and the flange; `$TOOL_OFFSET` and `$WOBJ_OFFSET` apply to motions only.
pub(crate) fn setting(cx: &Cx, tool: &Tool, wobj: &Wobj) -> Setting {
    let base = cx.system().base.with(|base| base.first().map_or_else(Default::default, |base| base.w_frame));
    Setting::new(tool, wobj, &base)
}

/// Checks that the frames of tool and workpiece contain numbers only.
pub(crate) fn known(function: &'static str, tool: &Tool, wobj: &Wobj) -> Result<(), Fault> {
    for (name, frame) in [("tool", tool.t_frame), ("workpiece", wobj.w_frame)] {
        if let Some(value) = frame.components().into_iter().find(|component| is_open(*component)) {
            return Err(domain(function, format!("the {name} frame holds {value}, which is not a length or angle")));
        }
    }
    Ok(())
}

fn refused(unit: &Unit, refusal: &Refusal) -> String {
    match refusal {
        Refusal::NoSuchCfg { cfg } => format!("the robot has no configuration cfg {cfg}: {CONFIGURATIONS}"),
        Refusal::Unreachable { beyond } if *beyond > 0.0 => format!("the pose is {beyond:.3} mm out of reach"),
        Refusal::Unreachable { .. } => "the pose cannot be reached in this configuration".to_owned(),
        Refusal::Tilted { by } => format!("the pose tilts the flange by {by:.3} deg, which a SCARA robot cannot do"),
        Refusal::AxisLimit { axis, value } => match unit.robot().own_axes().get(*axis) {
            Some(axis) => {
                format!("{} would have to go to {value:.3}, but its range is {} to {}", axis.name, axis.min, axis.max)
            }
            None => format!("an axis would have to go to {value:.3}"),
        },
    }
}

fn domain(function: &'static str, problem: String) -> Fault {
    Fault::Domain { function, problem: problem.into() }
}
