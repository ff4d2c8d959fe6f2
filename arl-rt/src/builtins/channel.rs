//! Queries of a foreground channel: position, motion and forces of its robot, and the position of its program.

use std::cell::Ref;
use std::rc::Rc;

use crate::builtins::pose::{known, pose, setting};
use crate::context::cx::Cx;
use crate::cycle::channel_id::{ChannelId, MOST_FOREGROUND};
use crate::fault::Fault;
use crate::motion::Joints;
use crate::storage::pointers::CodePosition;
use crate::unit::{Unit, joint, tidy};
use crate::values::{Joint, Jtci, Jttq, Jvel, Pose, Str, Tcpforce, Tool, UNSET, Wobj};
use arl_robot::kinematics::Axes;
use arl_robot::robot::Axis;

/// A foreground channel, as all channels see it.
struct Foreground<'a> {
    /// The channel's own context.
    cx: &'a Cx,
    unit: Ref<'a, Unit>,
}

/// Calls `look` with the channel of this number, from 1.
fn foreground<T>(
    cx: &Cx,
    function: &'static str,
    number: i32,
    look: impl FnOnce(&Foreground<'_>) -> Result<T, Fault>,
) -> Result<T, Fault> {
    let found = cx.programs().foreground(number);
    let unit = found.as_ref().and_then(|cx| Some((cx, cx.channel_state().robot()?)));
    match unit {
        Some((cx, unit)) => look(&Foreground { cx, unit }),
        None => Err(Fault::Domain { function, problem: no_such(cx, number).into() }),
    }
}

/// The number of a foreground channel that need not exist.
pub(crate) fn number(function: &'static str, channel: u32) -> Result<i32, Fault> {
    match i32::try_from(channel) {
        Ok(number) if (1..=MOST_FOREGROUND as i32).contains(&number) => Ok(number),
        _ => {
            let problem = format!("the channel is {channel}, but must be 1 to {MOST_FOREGROUND}");
            Err(Fault::Domain { function, problem: problem.into() })
        }
    }
}

/// `switcharl`: ends the program of a foreground channel, whose robot stops on its path, and starts another loadable
/// program there; true on success. It acts at once, and continues as soon as the other program is loaded.
///
/// # Errors
/// The channel is not within 1 to 6, or this is not a background channel.
pub async fn switcharl(cx: &Cx, channel: u32, file_name: &Str) -> Result<bool, Fault> {
    const FUNCTION: &str = "switcharl";
    let number = number(FUNCTION, channel)?;
    if !matches!(cx.channel_state().id, ChannelId::Background(_)) {
        let problem = "only the program of a background channel may switch programs";
        return Err(Fault::Domain { function: FUNCTION, problem: problem.into() });
    }
    match begin_to_switch(cx, number, &file_name.to_text()) {
        Ok(there) => {
            while there.is_loading() {
                cx.next_cycle().await;
            }
            Ok(true)
        }
        Err(refused) => {
            warn_of(cx, FUNCTION, &refused);
            Ok(false)
        }
    }
}

/// Lets the channel with this number load another program; `Err` is the reason why it does not.
fn begin_to_switch(cx: &Cx, number: i32, name: &str) -> Result<Rc<Cx>, String> {
    let there = cx.programs().foreground(number).ok_or_else(|| no_such(cx, number))?;
    let program = cx.programs().loadable.load(name);
    let program = program.ok_or_else(|| format!("the controller has no program {name} to load"))?;
    there.load(program)?;
    Ok(there)
}

/// Warns that a function returns false, with the reason.
pub(crate) fn warn_of(cx: &Cx, function: &str, why: &str) {
    let (file, line) = cx.place();
    cx.shared().warn(format!("{}:{line}: {function}: {why}", file.name()));
}

/// The message that a foreground channel with this number does not exist.
pub(crate) fn no_such(cx: &Cx, number: i32) -> String {
    match cx.programs().foreground_count() {
        1 => format!("there is no foreground channel {number}, only channel 1"),
        count => format!("there is no foreground channel {number}, only channels 1 to {count}"),
    }
}

impl Foreground<'_> {
    fn positions(&self, commanded: bool) -> &Joints {
        &self.unit.moving(commanded).at
    }

    fn pose(&self, joints: &Joints, tool: Tool, wobj: &Wobj) -> Pose {
        pose(self.cx, &self.unit, &joints.axes, &joint(joints), tool, wobj)
    }

    /// Returns a result that needs the masses of the robot, or the fault that they are missing.
    fn known<T>(&self, function: &'static str, found: Option<T>) -> Result<T, Fault> {
        found.ok_or_else(|| Fault::NoMasses { function, robot: self.unit.robot().name.as_str().into() })
    }

    /// The torques of the robot's own axes.
    fn torques(&self, function: &'static str, commanded: bool) -> Result<Axes, Fault> {
        self.known(function, self.unit.torques(commanded))
    }

    /// Values of the robot's own axes for a program: axes that the robot does not have are unset.
    fn own(&self, values: Axes) -> [f64; 6] {
        let mut own = [UNSET; 6];
        let there = self.unit.robot().own_axes().len();
        own.iter_mut().zip(values).take(there).for_each(|(own, value)| *own = tidy(value));
        own
    }

    /// The position of the current or else the last motion, even from before the controller was switched on.
    fn motion_pointer(&self) -> CodePosition {
        let kept = || self.cx.channel_state().kept().motion.clone();
        let now = self.unit.motion_pointer().map(CodePosition::from);
        now.or_else(kept).unwrap_or_else(|| (self.cx.program(), 0).into())
    }

    /// The position of the program now, or before the controller was switched on.
    fn program_pointer(&self) -> CodePosition {
        let channel_state = self.cx.channel_state();
        let kept = channel_state.kept().program.clone().filter(|_| !channel_state.begun.get());
        kept.unwrap_or_else(|| self.cx.place().into())
    }
}

/// `cjttq`: the torques of the axes in Nm (N of linear axes), as commanded or as measured. Those of external axes are
/// unset: their masses are not known.
///
/// # Errors
/// The channel does not exist, or the robot file has no masses.
pub fn cjttq(cx: &Cx, chan_no: i32, ls_cmd: bool) -> Result<Jttq, Fault> {
    const FUNCTION: &str = "cjttq";
    foreground(cx, FUNCTION, chan_no, |channel| {
        let [jt1, jt2, jt3, jt4, jt5, jt6] = channel.own(channel.torques(FUNCTION, ls_cmd)?);
        Ok(Jttq { jt1, jt2, jt3, jt4, jt5, jt6, ..Jttq::default() })
    })
}

/// `cjtci`: the currents of the motors in A, as commanded or as measured. Those of external axes are unset.
///
/// # Errors
/// The channel does not exist, or the robot file has no masses.
pub fn cjtci(cx: &Cx, chan_no: i32, ls_cmd: bool) -> Result<Jtci, Fault> {
    const FUNCTION: &str = "cjtci";
    foreground(cx, FUNCTION, chan_no, |channel| {
        let model = channel.known(FUNCTION, channel.unit.model())?;
        let [ji1, ji2, ji3, ji4, ji5, ji6] = channel.own(model.currents(&channel.torques(FUNCTION, ls_cmd)?));
        Ok(Jtci { ji1, ji2, ji3, ji4, ji5, ji6, ..Jtci::default() })
    })
}

/// `channeltojoint`: the axes (deg, mm) at the target of the current motion; without one, of the last.
///
/// # Errors
/// The channel does not exist.
pub fn channeltojoint(cx: &Cx, chan_no: i32) -> Result<Joint, Fault> {
    foreground(cx, "channeltojoint", chan_no, |channel| Ok(joint(channel.unit.current_target())))
}

/// `channeltopose`: the pose (mm, deg) of the tool in the workpiece frame at the target of the current motion; without
/// one, of the last.
///
/// # Errors
/// The channel does not exist, or the tool or the workpiece frame contains a value that is not a number.
pub fn channeltopose(cx: &Cx, chan_no: i32, t: Tool, w: &Wobj) -> Result<Pose, Fault> {
    known("channeltopose", &t, w)?;
    foreground(cx, "channeltopose", chan_no, |channel| Ok(channel.pose(channel.unit.current_target(), t, w)))
}

/// `channeljoint`: the axes (deg, mm) now, as commanded or as the robot reports them.
///
/// # Errors
/// The channel does not exist.
pub fn channeljoint(cx: &Cx, chan_no: i32, ls_cmd: bool) -> Result<Joint, Fault> {
    foreground(cx, "channeljoint", chan_no, |channel| Ok(joint(channel.positions(ls_cmd))))
}

/// `channelpose`: the pose (mm, deg) of the tool in the workpiece frame now, as commanded or as the robot reports it.
///
/// # Errors
/// The channel does not exist, or the tool or the workpiece frame contains a value that is not a number.
pub fn channelpose(cx: &Cx, chan_no: i32, t: Tool, w: &Wobj, ls_cmd: bool) -> Result<Pose, Fault> {
    known("channelpose", &t, w)?;
    foreground(cx, "channelpose", chan_no, |channel| Ok(channel.pose(channel.positions(ls_cmd), t, w)))
}

/// `channeljointvel`: the speeds of the axes in rad/s (mm/s of linear axes), as commanded or as the robot reports them.
///
/// # Errors
/// The channel does not exist.
pub fn channeljointvel(cx: &Cx, chan_no: i32, ls_cmd: bool) -> Result<Jvel, Fault> {
    foreground(cx, "channeljointvel", chan_no, |channel| {
        let robot = channel.unit.robot();
        let moving = channel.unit.moving(ls_cmd);
        let speed = |axis: &Axis, rate: f64| tidy(if axis.linear { rate } else { rate.to_radians() });
        let mut speeds = [UNSET; 12];
        let (own, external) = speeds.split_at_mut(6);
        let own = own.iter_mut().zip(robot.own_axes().iter().zip(moving.rates));
        let external = external.iter_mut().zip(robot.external_axes().iter().zip(moving.external_rates));
        own.chain(external).for_each(|(value, (axis, rate))| *value = speed(axis, rate));
        Ok(Jvel::from(speeds))
    })
}

/// `channeltcpvel`: the speed of the tool in the workpiece frame in mm/s, as commanded or as the robot reports it.
///
/// # Errors
/// The channel does not exist, or the tool or the workpiece frame contains a value that is not a number.
pub fn channeltcpvel(cx: &Cx, chan_no: i32, t: Tool, w: &Wobj, ls_cmd: bool) -> Result<f64, Fault> {
    known("channeltcpvel", &t, w)?;
    foreground(cx, "channeltcpvel", chan_no, |channel| {
        let (setting, moving) = (setting(channel.cx, &t, w), channel.unit.moving(ls_cmd));
        let kinematics = &channel.unit.robot().kinematics;
        let place = |joints: &Joints| setting.pose_of(&kinematics.forward(&joints.axes)).translation.vector;
        Ok(tidy((place(&moving.at) - place(&moving.before)).norm() / moving.period))
    })
}

/// `ctcpforce`: the force (N) and the torque (Nm) that the robot exerts on its surroundings, at the TCP and along the
/// axes of the workpiece frame. Components that the axes cannot sense at a singular point are 0.
///
/// # Errors
/// The channel does not exist, the robot file has no masses, or the tool or the workpiece frame contains a value that
/// is not a number.
pub fn ctcpforce(cx: &Cx, chan_no: i32, t: Tool, w: &Wobj) -> Result<Tcpforce, Fault> {
    const FUNCTION: &str = "ctcpforce";
    known(FUNCTION, &t, w)?;
    foreground(cx, FUNCTION, chan_no, |channel| {
        let unit = &channel.unit;
        let model = channel.known(FUNCTION, unit.model())?;
        let surplus = channel.known(FUNCTION, unit.surplus())?;
        let (setting, axes) = (setting(channel.cx, &t, w), &unit.feedback().axes);
        let flange = unit.robot().kinematics.forward(axes);
        let rig = setting.rig();
        let tcp = rig.tcp_at(&flange);
        let point = (rig.base.inverse() * tcp).translation.vector;
        let pressing = model.pressing(axes, &surplus, &point).unwrap_or_else(|| model.felt(axes, &surplus, &point));
        // From the base via the world and the TCP to the workpiece.
        let turn = setting.pose_of(&flange).rotation * tcp.rotation.inverse() * rig.base.rotation;
        let [fx, fy, fz]: [f64; 3] = (turn * pressing.force).into();
        let [tx, ty, tz]: [f64; 3] = (turn * pressing.torque).into();
        let [fx, fy, fz, tx, ty, tz] = [fx, fy, fz, tx, ty, tz].map(tidy);
        Ok(Tcpforce { fx, fy, fz, tx, ty, tz })
    })
}

/// `curmpfile`: the file of the current or else the last motion, even from before the controller was switched on;
/// before the very first motion the program's own.
///
/// # Errors
/// The channel does not exist.
pub fn curmpfile(cx: &Cx, channel_index: i32) -> Result<Str, Fault> {
    foreground(cx, "curmpfile", channel_index, |channel| Ok(channel.motion_pointer().file))
}

/// `curmpline`: the line of the current or else the last motion, even from before the controller was switched on;
/// before the very first motion 0.
///
/// # Errors
/// The channel does not exist.
pub fn curmpline(cx: &Cx, channel_index: i32) -> Result<i32, Fault> {
    foreground(cx, "curmpline", channel_index, |channel| Ok(channel.motion_pointer().line as i32))
}

/// `curppfile`: the file in which the program stands; until it runs, the one in which the channel's program stood when
/// the controller was switched off.
///
/// # Errors
/// The channel does not exist.
pub fn curppfile(cx: &Cx, channel_index: i32) -> Result<Str, Fault> {
    foreground(cx, "curppfile", channel_index, |channel| Ok(channel.program_pointer().file))
}

/// `curppline`: the line that the program stands on; until it runs, the one on which the channel's program stood when
/// the controller was switched off.
///
/// # Errors
/// The channel does not exist.
pub fn curppline(cx: &Cx, channel_index: i32) -> Result<i32, Fault> {
    foreground(cx, "curppline", channel_index, |channel| Ok(channel.program_pointer().line as i32))
}
