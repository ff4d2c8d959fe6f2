//! The structures, with start values and units.

use super::declare::{base, components};
use super::types::{Component, Family, Struct, StructDef};

/// Declares a structure's definition.
macro_rules! structure {
    ($vis:vis $table:ident = $(#[doc = $doc:literal])+ $id:ident, $name:literal $(| $alias:literal)*, $rust:literal, $section:literal $(, $family:ident)? { $($body:tt)* }) => {
        $vis static $table: StructDef = StructDef {
            id: Struct::$id,
            name: $name,
            aliases: &[$($alias),*],
            family: structure!(@family $($family)?),
            rust: $rust,
            components: {
                const COMPONENTS: &[Component] = components!($($body)*);
                COMPONENTS
            },
            doc: concat!($($doc),+).trim_ascii(),
            section: $section,
        };
    };
    (@family) => { None };
    (@family $family:ident) => { Some(Family::$family) };
}

structure! { POS =
    /// A point in space.
    Pos, "pos", "Pos", "2.4.2" {
        x: double unset "x coordinate, mm",
        y: double unset "y coordinate, mm",
        z: double unset "z coordinate, mm",
    }
}

structure! { FRAME =
    /// A coordinate system as seen from another one: where its origin lies and how it is turned. The angles turn about
    /// z first, then about the new y, then about the new x.
    Frame, "frame", "Frame", "2.4.3" {
        x: double zero "x of the origin, mm",
        y: double zero "y of the origin, mm",
        z: double zero "z of the origin, mm",
        a: double zero "turn about z, deg",
        b: double zero "turn about the new y, deg",
        c: double zero "turn about the new x, deg",
    }
}

structure! { POSE =
    /// A target for the TCP in the workpiece frame, with the arm configuration and the external axes.
    Pose, "pose", "Pose", "2.4.4" {
        x: double unset "x of the TCP, mm",
        y: double unset "y of the TCP, mm",
        z: double unset "z of the TCP, mm",
        a: double unset "turn of the tool about z, deg",
        b: double unset "turn of the tool about the new y, deg",
        c: double unset "turn of the tool about the new x, deg",
        cfg: int zero "arm configuration: six axes 0 to 7; SCARA 0 right-handed, 4 left-handed",
        turn: int starts(-1) [range(-1.0, 63.0)] "bit i set: axis i+1 is below 0; -1 takes the solution nearest to the start",
        ej1 ej2 ej3 ej4 ej5 ej6: double unset "position of the external axis, deg (mm for a linear one)",
    }
}

structure! { JOINT =
    /// A target as axis positions.
    Joint, "joint", "Joint", "2.4.5" {
        j1 j2 j3 j4 j5 j6: double unset "position of the robot axis, deg",
        ej1 ej2 ej3 ej4 ej5 ej6: double unset "position of the external axis, deg (mm for a linear one)",
    }
}

structure! { JOINT_SCARA =
    /// A target as axis positions.
    Joint, "joint", "JointScara", "2.5.5" {
        j1 j2: double unset "position of the arm axis, deg",
        j3: double unset "position of the lift, mm",
        j4: double unset "position of the flange axis, deg",
        ej1 ej2 ej3 ej4 ej5 ej6: double unset "position of the external axis, deg (mm for a linear one)",
    }
}

structure! { TOOL =
    /// A tool: where its TCP lies, and whether it stands still in the cell.
    Tool, "tool", "Tool", "2.4.6" {
        t_frame: frame zero "the tool frame, seen from the flange (from the world where the tool is stationary)",
        stationary: bool zero "true: the tool is stationary in the cell, and the robot carries the workpiece",
    }
}

structure! { WOBJ =
    /// A workpiece frame.
    Wobj, "wobj", "Wobj", "2.4.7" {
        w_frame: frame zero "the workpiece frame, seen from the world (from the flange where the robot holds it)",
        robhold: bool zero "true: the robot holds the workpiece",
        mu_name: string zero "name of the mechanical unit that carries the workpiece; empty: none",
    }
}

structure! { WEAVEDATA =
    /// The weave pattern that is laid over a path.
    Weavedata, "weavedata", "Weavedata", "2.4.8" {
        weaveshape: weaveshape zero "the pattern",
        frequency: double zero [above(0.0)] "patterns per second at the speed of the path, not counting stays, Hz, above 0",
        amplitude: double zero [at_least(0.0)] "largest distance from the path, mm",
        dwell_left: double zero [at_least(0.0)] "stay at the left end, s, 0 or more",
        dwell_right: double zero [at_least(0.0)] "stay at the right end, s, 0 or more",
        dwell_middle: double zero [at_least(0.0)] "stay in the middle each time it is passed, s, 0 or more",
        track: bool zero [only_false()] "whether the seam is tracked: there is no weld tracking, only false is accepted",
        swing_angle: double zero [range(0.0, 180.0)] "opening angle of the V and triangle patterns, 0 to 180 deg",
        radius: double zero [at_least(0.0)] "radius of the round patterns along the path, mm, 0 or more",
        weaverotaxis: weaverotaxis zero "the axis about which the plane of the pattern is turned",
        rotation_angle: double zero "how far the plane of the pattern is turned, deg",
        vibrat: bool zero [only_false()] "whether the vibration is on: there is none, only false is accepted",
    }
}

structure! { SPEED =
    /// How fast a motion is programmed.
    Speed, "speed", "Speed", "2.4.9" {
        per: double unset [range(0.001, 100.0)] "axis speed of movej and ptp, % of the axes' limits, 0.001 to 100",
        tcp: double unset [at_least(0.0)] "TCP speed on lines and arcs, mm/s",
        ori: double unset [at_least(0.0)] "turning speed of the tool on lines and arcs, deg/s",
        exj: double unset [at_least(0.0)] "speed of rotary external axes, deg/s",
        exl: double unset [at_least(0.0)] "speed of linear external axes, mm/s",
    }
}

structure! { SLIP =
    /// How early a motion may leave its path for the next one. A `perdis` of 0 or more overrules the others; of the
    /// others, the one that comes nearest to the target counts.
    Slip, "slip", "Slip", "2.4.10" {
        perdis: double unset [at_most(100.0)] "blending zone, % of the largest one possible",
        pdis: double unset "distance of the TCP from the target where blending begins, mm; at most half of the path",
        odis: double unset "angle of the tool from the target where blending begins, deg; at most half of the turn",
        ejdis: double unset "distance of the slowest rotary external axis from its target, deg",
        eldis: double unset "distance of the slowest linear external axis from its target, mm",
        jdis: double unset [named] "distance of the axes from the target of movej and ptp, deg; set by name only",
    }
}

structure! { SLIP_SCARA =
    /// How early a motion may leave its path for the next one. A `perdis` of 0 or more overrules the others; of the
    /// others, the one that comes nearest to the target counts.
    Slip, "slip", "SlipScara", "2.5.9" {
        pdis: double unset "distance of the TCP from the target where blending begins, mm; at most half of the path",
        ejdis: double unset "distance of the slowest rotary external axis from its target, deg",
        eldis: double unset "distance of the slowest linear external axis from its target, mm",
        odis: double unset "angle of the tool from the target where blending begins, deg; at most half of the turn",
        perdis: double unset [at_most(100.0)] "blending zone, % of the largest one possible",
    }
}

structure! { JVEL =
    /// Speeds of the axes.
    Jvel, "jvel", "Jvel", "2.4.11" {
        jv1 jv2 jv3 jv4 jv5 jv6: double unset "speed of the robot axis, rad/s",
        ev1 ev2 ev3 ev4 ev5 ev6: double unset "speed of the external axis, rad/s",
    }
}

structure! { JVEL_SCARA =
    /// Speeds of the axes.
    Jvel, "jvel", "JvelScara", "2.5.10" {
        jv1 jv2 jv3 jv4: double unset "speed of the robot axis, rad/s",
        ev1 ev2 ev3 ev4 ev5 ev6: double unset "speed of the external axis, rad/s",
    }
}

structure! { CENTROID_POS =
    /// Where the centre of mass of a load lies.
    CentroidPos, "Centroid_Pos" | "CentroidPos", "CentroidPos", "2.4.12" {
        x: double zero "x of the centre of mass, mm",
        y: double zero "y of the centre of mass, mm",
        z: double zero "z of the centre of mass, mm",
    }
}

structure! { INERTIA_TENSOR =
    /// The inertia of a load about its centre of mass.
    InertiaTensor, "Inertia_Tensor" | "InertiaTensor", "InertiaTensor", "2.4.13" {
        Ixx: double zero [at_least(0.0), alias(&["lxx"])] "xx of the inertia matrix, g*mm^2",
        Ixy: double zero [alias(&["lxy"])] "xy of the inertia matrix, g*mm^2",
        Ixz: double zero [alias(&["lxz"])] "xz of the inertia matrix, g*mm^2",
        Iyy: double zero [at_least(0.0), alias(&["lyy"])] "yy of the inertia matrix, g*mm^2",
        Iyz: double zero [alias(&["lyz"])] "yz of the inertia matrix, g*mm^2",
        Izz: double zero [at_least(0.0), alias(&["lzz"])] "zz of the inertia matrix, g*mm^2",
    }
}

structure! { TOOL_INERTIA_PARA =
    /// A load: mass, centre of mass, inertia.
    ToolInertiaPara, "ToolInertiaPara", "ToolInertiaPara", "2.4.14" {
        m: double zero [at_least(0.0)] "mass, g",
        centroidpos: centroid_pos zero "centre of mass",
        inertiatensor: inertia_tensor zero "inertia",
    }
}

structure! { CONTROL =
    /// Speeds and accelerations of the lifting and the lowering part of a jump. What is not set follows the motion's
    /// own values.
    Control, "control", "Control", "2.5.11", Scara {
        rising_vel: double unset [range(0.0, 100.0)] "speed going up, % of the axis's limit",
        rising_acc: double unset [range(0.0, 100.0)] "acceleration going up, % of the axis's limit",
        rising_dec: double unset [range(0.0, 100.0)] "deceleration going up, % of the axis's limit",
        falling_vel: double unset [range(0.0, 100.0)] "speed going down, % of the axis's limit",
        falling_acc: double unset [range(0.0, 100.0)] "acceleration going down, % of the axis's limit",
        falling_dec: double unset [range(0.0, 100.0)] "deceleration going down, % of the axis's limit",
    }
}

structure! { COMPENDATA =
    /// How fast a path compensation may grow.
    Compendata, "compendata", "Compendata", "3.2.11.1" {
        tcp_max_vel: double zero [above(0.0)] "largest speed of the shift, mm/s",
        tcp_max_acc: double zero [above(0.0)] "largest acceleration of the shift, mm/s^2",
        tcp_max_jerk: double zero [above(0.0)] "largest jerk of the shift, mm/s^3",
        ori_max_vel: double zero [above(0.0)] "largest speed of the turn, deg/s",
        ori_max_acc: double zero [above(0.0)] "largest acceleration of the turn, deg/s^2",
        ori_max_jerk: double zero [above(0.0)] "largest jerk of the turn, deg/s^3",
    }
}

structure! { JTTQ =
    /// Torques of the axes.
    Jttq, "jttq", "Jttq", "5.8.8" {
        jt1 jt2 jt3 jt4 jt5 jt6: double unset "torque of the robot axis, N*m",
        et1 et2 et3 et4 et5 et6: double unset "torque of the external axis, N*m",
    }
}

structure! { JTCI =
    /// Motor currents of the axes.
    Jtci, "jtci", "Jtci", "5.8.9" {
        ji1 ji2 ji3 ji4 ji5 ji6: double unset "current of the robot axis's motor, A",
        ei1 ei2 ei3 ei4 ei5 ei6: double unset "current of the external axis's motor, A",
    }
}

structure! { TCPFORCE =
    /// Force and torque at the TCP, along the axes of the workpiece frame.
    Tcpforce, "tcpforce", "Tcpforce", "5.8.16" {
        fx: double unset "force along x, N",
        fy: double unset "force along y, N",
        fz: double unset "force along z, N",
        tx: double unset "torque about x, N*m",
        ty: double unset "torque about y, N*m",
        tz: double unset "torque about z, N*m",
    }
}

impl Struct {
    /// Every structure.
    pub const ALL: [Struct; 18] = [
        Struct::Pos,
        Struct::Frame,
        Struct::Pose,
        Struct::Joint,
        Struct::Tool,
        Struct::Wobj,
        Struct::Weavedata,
        Struct::Speed,
        Struct::Slip,
        Struct::Jvel,
        Struct::CentroidPos,
        Struct::InertiaTensor,
        Struct::ToolInertiaPara,
        Struct::Control,
        Struct::Compendata,
        Struct::Jttq,
        Struct::Jtci,
        Struct::Tcpforce,
    ];

    /// The definition for a robot family; `joint`, `jvel` and `slip` differ. `control`, which only SCARA robots have,
    /// has its family in its definition.
    pub fn def(self, family: Family) -> &'static StructDef {
        match (self, family) {
            (Struct::Joint, Family::SixAxis) => &JOINT,
            (Struct::Joint, Family::Scara) => &JOINT_SCARA,
            (Struct::Jvel, Family::SixAxis) => &JVEL,
            (Struct::Jvel, Family::Scara) => &JVEL_SCARA,
            (Struct::Slip, Family::SixAxis) => &SLIP,
            (Struct::Slip, Family::Scara) => &SLIP_SCARA,
            (Struct::Pos, _) => &POS,
            (Struct::Frame, _) => &FRAME,
            (Struct::Pose, _) => &POSE,
            (Struct::Tool, _) => &TOOL,
            (Struct::Wobj, _) => &WOBJ,
            (Struct::Weavedata, _) => &WEAVEDATA,
            (Struct::Speed, _) => &SPEED,
            (Struct::CentroidPos, _) => &CENTROID_POS,
            (Struct::InertiaTensor, _) => &INERTIA_TENSOR,
            (Struct::ToolInertiaPara, _) => &TOOL_INERTIA_PARA,
            (Struct::Control, _) => &CONTROL,
            (Struct::Compendata, _) => &COMPENDATA,
            (Struct::Jttq, _) => &JTTQ,
            (Struct::Jtci, _) => &JTCI,
            (Struct::Tcpforce, _) => &TCPFORCE,
        }
    }
}
