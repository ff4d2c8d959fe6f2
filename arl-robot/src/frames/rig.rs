//! What the robot carries, and where its base is: from a path of the TCP to the flange.

use nalgebra::Vector3;

use super::setting::Mount;
use crate::kinematics::{Frame, Twist};

/// What is on the flange: the tool, or the workpiece that is held to a stationary tool.
///
/// A path of the TCP is the tool's frame relative to the frame in which the workpiece is at rest: the robot's base if
/// the robot carries the tool, the flange if it carries the workpiece. Thus speeds along a path are those of the TCP
/// relative to the workpiece. Translations are in mm.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Carried {
    /// The tool, at this frame of the flange.
    Tool(Frame),
    /// The workpiece; the tool is at this frame of the robot's base.
    Workpiece(Frame),
}

impl Carried {
    /// The flange in the robot's base when the tool's frame on its path is `frame`.
    pub fn flange_at(&self, frame: &Frame) -> Frame {
        match self {
            Carried::Tool(tool) => frame * tool.inverse(),
            Carried::Workpiece(tool) => tool * frame.inverse(),
        }
    }

    /// The tool's frame on its path when the flange is at `flange` in the robot's base.
    pub fn path_frame_at(&self, flange: &Frame) -> Frame {
        match self {
            Carried::Tool(tool) => flange * tool,
            Carried::Workpiece(tool) => flange.inverse() * tool,
        }
    }

    /// Two frames that coincide when the tool's frame on its path is `frame`: one in the robot's base, one on the
    /// flange.
    pub fn coincident_frames(&self, frame: &Frame) -> (Frame, Frame) {
        match self {
            Carried::Tool(tool) => (*frame, *tool),
            Carried::Workpiece(tool) => (*tool, *frame),
        }
    }

    /// The motion of the flange in the robot's base when the tool's frame on its path is `frame` and moves there with
    /// the first three derivatives `moving` of its position (mm per unit of the path parameter, its square, its cube)
    /// while it turns with `turning`, the speed and its first two derivatives (rad).
    pub fn twist(&self, frame: &Frame, moving: &[Vector3<f64>; 3], turning: &[Vector3<f64>; 3]) -> Twist {
        let Carried::Workpiece(_) = self else { return Twist::of_point(&frame.translation.vector, moving, turning) };
        // The tool is at rest; the flange moves the opposite way. The motion of its origin is given along its own axes,
        // which move with it.
        let flange = self.flange_at(frame);
        let p = frame.translation.vector;
        let ([v, a, j], [w, w1, w2]) = (*moving, *turning);
        let first = w.cross(&p) - v;
        let first1 = w1.cross(&p) + w.cross(&v) - a;
        let first2 = w2.cross(&p) + w1.cross(&v) * 2.0 + w.cross(&a) - j;
        let second = first1 - w.cross(&first);
        let third = first2 - w1.cross(&first) - w.cross(&first1) - w.cross(&second);
        let turning = [-w, -w1, w.cross(&w1) - w2];
        let turned = |vectors: [Vector3<f64>; 3]| vectors.map(|vector| flange.rotation * vector);
        Twist::of_point(&flange.translation.vector, &turned([first, second, third]), &turned(turning))
    }
}

/// What the robot carries, and where its base is in the world.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Rig {
    /// What is on the flange.
    pub carried: Carried,
    /// The robot's base in the world, translation in mm.
    pub base: Frame,
    /// The workpiece.
    pub workpiece: Mount,
}

impl Rig {
    /// A bare flange of a robot whose base is at the origin of the world.
    pub fn bare() -> Self {
        Self::with_tool(Frame::identity())
    }

    /// A tool at this frame of the flange of a robot whose base is at the origin of the world.
    pub fn with_tool(tool: Frame) -> Self {
        Self {
            carried: Carried::Tool(tool),
            base: Frame::identity(),
            workpiece: Mount { frame: Frame::identity(), on_flange: false },
        }
    }

    /// The TCP's frame in the world when the flange is at `flange` in the robot's base.
    pub fn tcp_at(&self, flange: &Frame) -> Frame {
        match self.carried {
            Carried::Tool(tool) => self.base * flange * tool,
            Carried::Workpiece(tool) => self.base * tool,
        }
    }

    /// The workpiece's frame in the world when the flange is at `flange` in the robot's base.
    pub fn workpiece_at(&self, flange: &Frame) -> Frame {
        let Mount { frame, on_flange } = self.workpiece;
        if on_flange { self.base * flange * frame } else { frame }
    }
}
