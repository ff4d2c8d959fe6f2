//! Frames of tools, workpieces and the base from taught positions (manual 5.9).
//!
//! A position is given by the robot's axes there. Positions that are too close together, in a line, not set or not
//! numbers define no frame and raise an alarm.

mod geometry;

use nalgebra::{Point3, UnitQuaternion, Vector3};

use crate::builtins::frames::is_open;
use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::unit::tidy;
use crate::values::{self, Joint, Pos, Tool, Wobj};
use arl_robot::kinematics::{Frame, frame, frame_components};
use geometry::{Flaw, Triangle};

/// The distance, mm, from the position given by its coordinates, above which a point causes a warning.
const MAX_MISFIT_MM: f64 = 1.0;

/// The number of mechanical units of a channel.
const MECHANICAL_UNITS: i32 = 1;

/// The workpiece frame with its origin at the first position of the tool, the second on its +x axis, and the third in
/// its xy plane on the +y side.
///
/// # Errors
/// Axes are unset, the tool is stationary, or the positions are too close together or in a line.
pub fn getwobj_3p(cx: &Cx, j1: Joint, j2: Joint, j3: Joint, t: Tool) -> Result<Wobj, Fault> {
    let taught = Taught::new(cx, "getwobj_3p");
    let points = taught.touched([j1, j2, j3], &t)?;
    taught.through(points).map(|frame| workpiece(&frame))
}

/// The workpiece frame in which the three positions of the tool have the coordinates `p1`, `p2`, `p3` (mm). If the
/// distances differ, the frame is the best fit, and a deviation of more than 1 mm causes a warning.
///
/// # Errors
/// Axes or coordinates are unset, the tool is stationary, or points are too close together or in a line.
#[expect(clippy::too_many_arguments, reason = "the language's own")]
pub fn getwobj_indi(
    cx: &Cx,
    j1: Joint,
    j2: Joint,
    j3: Joint,
    p1: Pos,
    p2: Pos,
    p3: Pos,
    t: Tool,
) -> Result<Wobj, Fault> {
    let taught = Taught::new(cx, "getwobj_indi");
    let known = [p1, p2, p3].map(|p| [p.x, p.y, p.z]);
    if let Some(at) = known.iter().position(|point| point.iter().any(|component| is_open(*component))) {
        return Err(taught.refusal(format!("components of p{} are not set or are not numbers", at + 1)));
    }
    let found = taught.touched([j1, j2, j3], &t)?;
    let (frame, off) = geometry::fitted(known.map(Point3::from), found).map_err(|(triangle, flaw)| {
        taught.refusal(match triangle {
            Triangle::Known => format!("of p1, p2 and p3, {flaw}"),
            Triangle::Found => format!("of the taught points, {flaw}"),
        })
    })?;
    if off > MAX_MISFIT_MM {
        let (file, line) = cx.place();
        let file = file.name();
        cx.shared().warn(format!(
            "{file}:{line}: getwobj_indi: the distances between the taught points differ from those between p1, p2 and p3; \
             a point is {off:.3} mm from where its coordinates put it"
        ));
    }
    Ok(workpiece(&frame))
}

/// The frame with its origin at the first position of the tool (only the tool's x, y and z count), and its z along that
/// of the flange at the second. With `xydefault` x is as near to the world's as possible, otherwise x and y are the
/// flange's, too.
///
/// # Errors
/// Axes are unset, or the tool is stationary.
pub fn getwobj_flange(cx: &Cx, j1: Joint, j2: Joint, t: Tool, xydefault: bool) -> Result<Wobj, Fault> {
    let taught = Taught::new(cx, "getwobj_flange");
    let origin = taught.tip_in_world(1, &j1, &t)?;
    let turned = taught.flange(2, &j2)?.rotation;
    let rotation = if xydefault { geometry::around(turned * Vector3::z()) } else { turned };
    Ok(workpiece(&Frame::from_parts(origin.into(), rotation)))
}

/// Writes x, y and z of a tool that touched at `j2` the point that the tool `reference`, of which only x, y and z
/// count, touched at `j1`.
///
/// # Errors
/// Axes are unset, or the known tool is stationary.
pub fn gettooltcp_ref(cx: &Cx, j1: Joint, j2: Joint, reference: Tool, t: &mut Tool) -> Result<(), Fault> {
    let taught = Taught::new(cx, "gettooltcp_ref");
    let point = taught.tip_in_world(1, &j1, &reference)?;
    let [x, y, z] = taught.seen_from_flange(2, &j2, &point)?.coords.into();
    let t_frame = values::Frame { x: tidy(x), y: tidy(y), z: tidy(z), ..t.t_frame };
    *t = Tool { t_frame, ..*t };
    Ok(())
}

/// Writes a, b and c of a tool that stood at `j` with +x along the world's -z, +y along its +y, and +z along its +x.
///
/// # Errors
/// Axes are unset.
pub fn gettoolrot_world(cx: &Cx, j: Joint, t: &mut Tool) -> Result<(), Fault> {
    let taught = Taught::new(cx, "gettoolrot_world");
    let flange = taught.flange_named("j", &j)?;
    let tool = geometry::axes(-Vector3::z(), Vector3::y(), Vector3::x());
    turn(t, &(flange.rotation.inverse() * tool));
    Ok(())
}

/// Writes a, b and c of a tool whose x, y and z are known: a point was touched at `j1` with the TCP, at `j2` with a
/// place on its -x axis, and at `j3` with a place in its xy plane on the -y side.
///
/// # Errors
/// Axes are unset, the tool is stationary, or the positions are too close together or in a line.
pub fn gettoolrot_3p(cx: &Cx, j1: Joint, j2: Joint, j3: Joint, t: &mut Tool) -> Result<(), Fault> {
    let taught = Taught::new(cx, "gettoolrot_3p");
    let point = taught.tip_in_world(1, &j1, t)?;
    let tip = taught.tip(t)?;
    // Mirrored at the TCP, a place on -x is on +x, and a place on the -y side is on the +y side.
    let opposite = |place: Point3<f64>| tip + (tip - place);
    let on_x = opposite(taught.seen_from_flange(2, &j2, &point)?);
    let beside = opposite(taught.seen_from_flange(3, &j3, &point)?);
    let frame = taught.through([tip, on_x, beside])?;
    turn(t, &frame.rotation);
    Ok(())
}

/// The frame of a tool, or of a workpiece that the robot holds, from three places on it that touched the point of the
/// world given by `w` (only its x, y and z count): its origin, one on its +x axis, and one in its xy plane on the +y
/// side.
///
/// # Errors
/// Axes are unset, the robot holds `w`, or the places are too close together or in a line.
pub fn gettool_3p(cx: &Cx, j1: Joint, j2: Joint, j3: Joint, w: &Wobj) -> Result<Tool, Fault> {
    let taught = Taught::new(cx, "gettool_3p");
    if w.robhold {
        return Err(taught.refusal("w must be a point of the world, but the robot holds it (robhold)".to_owned()));
    }
    let point = taught.origin(&w.w_frame, "w")?;
    let place = |number: u8, joint: &Joint| taught.seen_from_flange(number, joint, &point);
    let frame = taught.through([place(1, &j1)?, place(2, &j2)?, place(3, &j3)?])?;
    Ok(Tool { t_frame: given(&frame), stationary: false })
}

/// Writes the position of a mechanical unit's base (counted from 1) to `$BASE`, from the positions of the tool at the
/// world's origin, on the world's +x axis, and in its xy plane on the +y side.
///
/// # Errors
/// The unit does not exist, axes are unset, the tool is stationary, or the positions are too close together or in a
/// line.
pub fn getbase_3p(cx: &Cx, j1: Joint, j2: Joint, j3: Joint, t: Tool, index: i32) -> Result<(), Fault> {
    let taught = Taught { base: Frame::identity(), ..Taught::new(cx, "getbase_3p") };
    if !(1..=MECHANICAL_UNITS).contains(&index) {
        let problem =
            format!("there is no mechanical unit {index}: this channel has {MECHANICAL_UNITS}, counted from 1");
        return Err(taught.refusal(problem));
    }
    let world_in_base = taught.through(taught.touched([j1, j2, j3], &t)?)?;
    cx.system().stand_on(given(&world_in_base.inverse()));
    Ok(())
}

/// Computations with taught positions.
struct Taught<'a> {
    cx: &'a Cx,
    function: &'static str,
    /// The robot's base in the world.
    base: Frame,
}

impl<'a> Taught<'a> {
    fn new(cx: &'a Cx, function: &'static str) -> Self {
        let base = cx.system().base.with(|bases| bases.first().map_or_else(Default::default, |base| base.w_frame));
        Self { cx, function, base: frame(base.components()) }
    }

    /// The flange in the world at the position with this number.
    fn flange(&self, number: u8, joint: &Joint) -> Result<Frame, Fault> {
        self.flange_named(&format!("j{number}"), joint)
    }

    fn flange_named(&self, name: &str, joint: &Joint) -> Result<Frame, Fault> {
        let unit = self.cx.channel_state().unit(self.function)?;
        let own = unit.robot().own_axes().len();
        let mut axes = joint.axes();
        if axes.iter().take(own).any(|axis| is_open(*axis)) {
            return Err(self.refusal(format!("axes of {name} are not set or are not numbers")));
        }
        axes.iter_mut().skip(own).for_each(|axis| *axis = 0.0);
        Ok(self.base * unit.robot().kinematics.forward(&axes))
    }

    /// The TCP in the world at a position.
    fn tip_in_world(&self, number: u8, joint: &Joint, tool: &Tool) -> Result<Point3<f64>, Fault> {
        if tool.stationary {
            let problem = "the tool is stationary, so the robot cannot touch points with it";
            return Err(self.refusal(problem.to_owned()));
        }
        Ok(self.flange(number, joint)? * self.tip(tool)?)
    }

    /// The TCP relative to the flange.
    fn tip(&self, tool: &Tool) -> Result<Point3<f64>, Fault> {
        self.origin(&tool.t_frame, "the tool")
    }

    /// The origin of a frame; an error if it is not set.
    fn origin(&self, frame: &values::Frame, what: &str) -> Result<Point3<f64>, Fault> {
        let [x, y, z, ..] = frame.components();
        match [x, y, z].into_iter().find(|component| is_open(*component)) {
            None => Ok(Point3::new(x, y, z)),
            Some(value) => Err(self.refusal(format!("{what} has its origin at {value}, which is not a length"))),
        }
    }

    /// The TCP in the world at three positions.
    fn touched(&self, [j1, j2, j3]: [Joint; 3], tool: &Tool) -> Result<[Point3<f64>; 3], Fault> {
        let touched = |number: u8, joint: &Joint| self.tip_in_world(number, joint, tool);
        Ok([touched(1, &j1)?, touched(2, &j2)?, touched(3, &j3)?])
    }

    /// A point of the world relative to the flange at a position.
    fn seen_from_flange(&self, number: u8, joint: &Joint, point: &Point3<f64>) -> Result<Point3<f64>, Fault> {
        Ok(self.flange(number, joint)?.inverse_transform_point(point))
    }

    fn through(&self, points: [Point3<f64>; 3]) -> Result<Frame, Fault> {
        geometry::through(points).map_err(|flaw: Flaw| self.refusal(flaw.to_string()))
    }

    fn refusal(&self, problem: String) -> Fault {
        Fault::Domain { function: self.function, problem: problem.into() }
    }
}

/// Changes the orientation of a tool.
fn turn(tool: &mut Tool, rotation: &UnitQuaternion<f64>) {
    let values::Frame { a, b, c, .. } = given(&Frame::from_parts(Default::default(), *rotation));
    let t_frame = values::Frame { a, b, c, ..tool.t_frame };
    *tool = Tool { t_frame, ..*tool };
}

/// A workpiece in the world.
fn workpiece(frame: &Frame) -> Wobj {
    Wobj { w_frame: given(frame), ..Wobj::default() }
}

/// A frame as a program sees it.
fn given(frame: &Frame) -> values::Frame {
    values::Frame::of_components(frame_components(frame).map(tidy))
}
