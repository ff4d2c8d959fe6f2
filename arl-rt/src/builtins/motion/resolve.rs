//! Turns targets of motion instructions into commands for the planner.

use super::modal::{Kind, Resolved};
use crate::context::cx::Cx;
use crate::context::standstill::WaitsFor;
use crate::fault::Fault;
use crate::motion::{Command, Joints, Settings, Target, UNSET, Zone, is_unset};
use crate::unit::{Mounts, Unit, joint};
use crate::values::{Joint, Pose, VelProfile, is_set};
use arl_robot::kinematics::{CONFIGURATIONS, Wanted};
use arl_robot::robot::{EXTERNAL_AXES, VelocityProfile};

/// The name, in messages, of what a background channel cannot do.
const MOTION: &str = "motion";

/// The message for a first motion with unset components.
const FIRST: &str = "the first motion of a program must set all components of its target";

/// Above this, mm or deg, a component is the result of a calculation with 9e+09.
const FARTHEST: f64 = 1e9;

/// A motion that keeps a smaller share of its speed under a weave or a compensation causes a warning.
const SLOWED: f64 = 0.98;

/// The axes of a target.
pub(super) fn joints(cx: &Cx, target: &Joint) -> Result<Joints, Fault> {
    let joints = Joints { axes: target.axes(), external: target.external() };
    let unit = cx.channel_state().unit(MOTION)?;
    let own = joints.axes.get(..unit.robot().own_axes().len()).unwrap_or_default();
    first(cx, &unit, own, &joints.external)?;
    sensible(own)?;
    sensible(there(&unit, &joints.external))?;
    Ok(joints)
}

/// The pose of a target, the wanted solution, and its external axes.
pub(super) fn pose(
    cx: &Cx,
    target: &Pose,
    modal: &Resolved,
) -> Result<([f64; 6], Wanted, [f64; EXTERNAL_AXES]), Fault> {
    modal.setting.check().map_err(|unmoved| Fault::Motion(unmoved.to_string().into()))?;
    let system = cx.system();
    let (mut pose, external) = (target.components(), target.external());
    let unit = cx.channel_state().unit(MOTION)?;
    first(cx, &unit, &pose, &external)?;
    sensible(&pose)?;
    sensible(there(&unit, &external))?;
    if system.ignore_ori.get() {
        let [x, y, z, ..] = pose;
        pose = [x, y, z, UNSET, UNSET, UNSET];
    }
    // Lines keep the configuration of their start, whatever that of their target is.
    let as_taught = system.config_check.get() && modal.kind == Kind::Axes;
    Ok((pose, wanted(target, as_taught)?, external))
}

/// The position of the via point of a circle.
pub(super) fn via(point: &Pose) -> Result<[f64; 3], Fault> {
    let [x, y, z, ..] = point.components();
    sensible(&[x, y, z])?;
    Ok([x, y, z])
}

/// The wanted solution of a pose: the taught one, or the nearest.
pub(crate) fn wanted(target: &Pose, as_taught: bool) -> Result<Wanted, Fault> {
    if !as_taught {
        return Ok(Wanted { cfg: None, turn: -1 });
    }
    match u8::try_from(target.cfg) {
        Ok(cfg) => Ok(Wanted { cfg: Some(cfg), turn: target.turn }),
        Err(_) => {
            Err(Fault::Motion(format!("the robot has no configuration cfg {}: {CONFIGURATIONS}", target.cfg).into()))
        }
    }
}

/// Checks that all components are set in the first motion of a program, which has no start to take unset ones from.
fn first(cx: &Cx, unit: &Unit, own: &[f64], external: &[f64]) -> Result<(), Fault> {
    if cx.has_moved() {
        return Ok(());
    }
    if all_set(own) && all_set(there(unit, external)) { Ok(()) } else { Err(Fault::Motion(FIRST.into())) }
}

/// The external axes that the robot has.
fn there<'a>(unit: &Unit, external: &'a [f64]) -> &'a [f64] {
    external.get(..unit.robot().external_axes().len()).unwrap_or_default()
}

/// Checks that no component results from calculating with one that is not set: a sum would silently be left out of the
/// target, and a difference would turn the tool to an arbitrary angle.
fn sensible(components: &[f64]) -> Result<(), Fault> {
    let calculated = |value: &f64| is_set(*value) && value.is_finite() && value.abs() > FARTHEST;
    match components.iter().copied().find(calculated) {
        None => Ok(()),
        Some(value) => {
            let problem = format!(
                "the target holds {value}, which comes from calculating with a component that is not set (9e+09): set it first"
            );
            Err(Fault::Motion(problem.into()))
        }
    }
}

/// Passes a motion to the planner as soon as there is room.
pub(super) async fn plan(cx: &Cx, modal: &Resolved, target: Target) -> Result<(), Fault> {
    let channel_state = cx.channel_state();
    if cx.spend() {
        cx.next_cycle().await;
    }
    // Motions that form one path are one step.
    let kind = match target {
        Target::Circle { .. } => 1,
        Target::Spline { .. } => 2,
        _ => 0,
    };
    if cx.chain(kind) != kind || kind == 0 {
        cx.step_point().await;
    }
    cx.goes_on();
    while !channel_state.unit(MOTION)?.takes(cx.level().number) {
        cx.wait_for(WaitsFor::Motion).await;
    }
    // Return to the path: the first motion runs at manual speed and stops at its end.
    let returns = channel_state.system.rpp_enable.get() && !cx.has_moved();
    let target = match target {
        Target::Spline { pose, wobj, external } if returns => Target::Line { pose, wobj, external },
        target => target,
    };
    let (_, line) = cx.place();
    let steps = channel_state.stepping.on.get();
    let command = Command {
        target,
        rig: modal.setting.rig(),
        speed: modal.speed,
        duration: modal.duration,
        zone: if returns || steps { Zone::NONE } else { modal.zone },
        line,
    };
    let current = channel_state.unit(MOTION)?.settings;
    let settings = Settings {
        profile: match channel_state.system.vel_profile.get() {
            VelProfile::T => VelocityProfile::T,
            VelProfile::S => VelocityProfile::S,
            VelProfile::O => VelocityProfile::O,
        },
        wrist: channel_state.system.wrist.get(),
        manual: current.manual || returns,
        compensation: current.compensation.filter(|_| !steps),
        ..current
    };
    let circle_steps = if steps { channel_state.unit(MOTION)?.circle_steps(&command, &settings) } else { None };
    if let Some([first, second]) = circle_steps {
        add(cx, &first, &settings, modal.mounts).await?;
        cx.next_step().await;
        add(cx, &second, &settings, modal.mounts).await?;
    } else {
        add(cx, &command, &settings, modal.mounts).await?;
    }
    if steps && kind == 0 {
        cx.motion_end().await;
    }
    Ok(())
}

/// Adds a motion to the planned ones.
async fn add(cx: &Cx, command: &Command, settings: &Settings, mounts: Mounts) -> Result<(), Fault> {
    let channel_state = cx.channel_state();
    let (file, line) = cx.place();
    let planned = channel_state.unit_mut(MOTION)?.plan(command, settings, mounts, file);
    if let Err(alarm) = planned {
        if (alarm.file, alarm.line) == (file, line) {
            return Err(alarm.fault);
        }
        channel_state.raise_alarm(alarm);
        // The controller ends the program here.
        loop {
            cx.next_cycle().await;
        }
    }
    let mut unit = channel_state.unit_mut(MOTION)?;
    channel_state.system.cjoint.set(joint(unit.target()));
    cx.moved(unit.motions().0);
    let file = cx.place().0.name();
    let (share, slowed) = unit.take_slowed();
    if share < SLOWED {
        let percent = if share < 0.01 { "less than 1".to_owned() } else { format!("{:.0}", 100.0 * share) };
        cx.shared().warn(format!("{file}:{slowed}: the weave or the compensation is too fast for the robot: the motion goes at {percent} % of its speed"));
    }
    drop(unit);
    channel_state.warn_of_missing_blends(cx.shared());
    Ok(())
}

/// Whether all components were set.
fn all_set(components: &[f64]) -> bool {
    !components.iter().any(|component| is_unset(*component))
}
