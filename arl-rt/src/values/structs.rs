//! The structures. A component's field is its name in lower case.

use super::{Literal, Str, UNSET, Weaverotaxis, Weaveshape};
use crate::values::text::{Print, Style, Typed};

/// What all structures have in common: their components, by number.
pub trait Structure: Default + Clone + 'static {
    /// The names of the components in order.
    const COMPONENTS: &'static [&'static str];

    /// Aliases of components, each with the proper name.
    const ALIASES: &'static [(&'static str, &'static str)] = &[];

    /// The number of components that values without names can set.
    const POSITIONAL: usize;

    /// The component with this number.
    fn component(&self, index: usize) -> Option<&dyn Literal>;

    /// The component with this number, for writing.
    fn component_mut(&mut self, index: usize) -> Option<&mut dyn Literal>;

    /// The number of the component with this name, whatever its case.
    fn component_index(name: &str) -> Option<usize> {
        let alias = Self::ALIASES.iter().find(|(alias, _)| alias.eq_ignore_ascii_case(name));
        let name = alias.map_or(name, |(_, right)| right);
        Self::COMPONENTS.iter().position(|component| component.eq_ignore_ascii_case(name))
    }

    /// The number of components that are printed: some structures print their last one only if it was set.
    fn shown(&self) -> usize {
        Self::COMPONENTS.len()
    }
}

macro_rules! structures {
    ($(
        $(#[$meta:meta])*
        $rust:ident $name:literal
            $(, $positional:literal by position)?
            $(, last shown if $shown:expr)?
            $(, also { $($alias:ident $right:ident)* })? ;
        {
            $($field:ident $doc:literal: $ty:ty = $start:expr,)*
        }
    )*) => { $(
        $(#[$meta])*
        #[derive(Clone, PartialEq, Debug)]
        pub struct $rust {
            $(
                #[doc = $doc]
                pub $field: $ty,
            )*
        }

        impl Default for $rust {
            // If inlined, the start values of a thousand variables become one function that takes minutes to compile.
            #[inline(never)]
            fn default() -> Self {
                Self { $($field: $start,)* }
            }
        }

        impl Structure for $rust {
            const COMPONENTS: &'static [&'static str] = &[$(stringify!($field),)*];
            const POSITIONAL: usize = structures!(@first $($positional,)? Self::COMPONENTS.len(),);

            $(const ALIASES: &'static [(&'static str, &'static str)] = &[$((stringify!($alias), stringify!($right)),)*];)?

            fn component(&self, index: usize) -> Option<&dyn Literal> {
                let components: [&dyn Literal; Self::COMPONENTS.len()] = [$(&self.$field,)*];
                components.get(index).copied()
            }

            fn component_mut(&mut self, index: usize) -> Option<&mut dyn Literal> {
                let components: [&mut dyn Literal; Self::COMPONENTS.len()] = [$(&mut self.$field,)*];
                components.into_iter().nth(index)
            }

            $(
                fn shown(&self) -> usize {
                    let set: fn(&Self) -> bool = $shown;
                    Self::COMPONENTS.len() - usize::from(!set(self))
                }
            )?
        }

        impl Typed for $rust {
            const NAME: &'static str = $name;
        }

        impl Print for $rust {
            fn print(&self, out: &mut Str, style: &Style) {
                let mut remaining = self.shown();
                let mut before = b'{';
                $(
                    if remaining > 0 {
                        remaining -= 1;
                        out.push(before);
                        before = b',';
                        self.$field.print(out, style);
                    }
                )*
                let _ = (remaining, before);
                out.push(b'}');
            }

            fn type_name(&self) -> String {
                $name.to_owned()
            }
        }
    )* };
    (@first $first:expr, $($rest:expr,)*) => { $first };
}

structures! {
    /// A point in space.
    #[derive(Copy)]
    Pos "pos"; {
        x "Along x, mm.": f64 = UNSET,
        y "Along y, mm.": f64 = UNSET,
        z "Along z, mm.": f64 = UNSET,
    }

    /// A coordinate system, relative to another one.
    #[derive(Copy)]
    Frame "frame"; {
        x "Origin along x, mm.": f64 = 0.0,
        y "Origin along y, mm.": f64 = 0.0,
        z "Origin along z, mm.": f64 = 0.0,
        a "Turn about z, deg.": f64 = 0.0,
        b "Turn about the new y, deg.": f64 = 0.0,
        c "Turn about the new x, deg.": f64 = 0.0,
    }

    /// A target of the TCP in the workpiece, with the external axes.
    #[derive(Copy)]
    Pose "pose"; {
        x "TCP along x, mm.": f64 = UNSET,
        y "TCP along y, mm.": f64 = UNSET,
        z "TCP along z, mm.": f64 = UNSET,
        a "Turn about z, deg.": f64 = UNSET,
        b "Turn about the new y, deg.": f64 = UNSET,
        c "Turn about the new x, deg.": f64 = UNSET,
        cfg "Which of the robot's configurations.": i32 = 0,
        turn "Signs of the axes, bit 0 for axis 1; -1: the nearest solution.": i32 = -1,
        ej1 "External axis 1, deg or mm.": f64 = UNSET,
        ej2 "External axis 2, deg or mm.": f64 = UNSET,
        ej3 "External axis 3, deg or mm.": f64 = UNSET,
        ej4 "External axis 4, deg or mm.": f64 = UNSET,
        ej5 "External axis 5, deg or mm.": f64 = UNSET,
        ej6 "External axis 6, deg or mm.": f64 = UNSET,
    }

    /// A target of the axes of a six-axis robot.
    #[derive(Copy)]
    Joint "joint"; {
        j1 "Axis 1, deg.": f64 = UNSET,
        j2 "Axis 2, deg.": f64 = UNSET,
        j3 "Axis 3, deg.": f64 = UNSET,
        j4 "Axis 4, deg.": f64 = UNSET,
        j5 "Axis 5, deg.": f64 = UNSET,
        j6 "Axis 6, deg.": f64 = UNSET,
        ej1 "External axis 1, deg or mm.": f64 = UNSET,
        ej2 "External axis 2, deg or mm.": f64 = UNSET,
        ej3 "External axis 3, deg or mm.": f64 = UNSET,
        ej4 "External axis 4, deg or mm.": f64 = UNSET,
        ej5 "External axis 5, deg or mm.": f64 = UNSET,
        ej6 "External axis 6, deg or mm.": f64 = UNSET,
    }

    /// A target of the axes of a SCARA robot.
    #[derive(Copy)]
    JointScara "joint"; {
        j1 "Axis 1, deg.": f64 = UNSET,
        j2 "Axis 2, deg.": f64 = UNSET,
        j3 "Axis 3, mm.": f64 = UNSET,
        j4 "Axis 4, deg.": f64 = UNSET,
        ej1 "External axis 1, deg or mm.": f64 = UNSET,
        ej2 "External axis 2, deg or mm.": f64 = UNSET,
        ej3 "External axis 3, deg or mm.": f64 = UNSET,
        ej4 "External axis 4, deg or mm.": f64 = UNSET,
        ej5 "External axis 5, deg or mm.": f64 = UNSET,
        ej6 "External axis 6, deg or mm.": f64 = UNSET,
    }

    /// A tool.
    #[derive(Copy)]
    Tool "tool"; {
        t_frame "The tool's frame, on the flange (or in the world where it is stationary).": Frame = Frame::default(),
        stationary "Whether the tool is fixed in the world instead of on the flange.": bool = false,
    }

    /// A workpiece.
    Wobj "wobj", last shown if |wobj| !wobj.mu_name.is_empty(); {
        w_frame "The workpiece's frame, in the world (or on the flange where the robot holds it).": Frame = Frame::default(),
        robhold "Whether the robot holds the workpiece.": bool = false,
        mu_name "The mechanical unit that carries it; empty for none.": Str = Str::new(),
    }

    /// How a weave swings.
    #[derive(Copy)]
    Weavedata "weavedata"; {
        weaveshape "The figure.": Weaveshape = Weaveshape::Simple,
        frequency "Swings per second, Hz.": f64 = 0.0,
        amplitude "The largest distance from the path, mm.": f64 = 0.0,
        dwell_left "Rest on the left, s.": f64 = 0.0,
        dwell_right "Rest on the right, s.": f64 = 0.0,
        dwell_middle "Rest in the middle, s.": f64 = 0.0,
        track "Whether the seam is tracked.": bool = false,
        swing_angle "The angle of the triangle and of the V, deg.": f64 = 0.0,
        radius "The radius of the figure, mm.": f64 = 0.0,
        weaverotaxis "The axis about which the plane is turned.": Weaverotaxis = Weaverotaxis::X,
        rotation_angle "How far the plane is turned, deg.": f64 = 0.0,
        vibrat "Whether vibration is on.": bool = false,
    }

    /// Speeds of a motion.
    #[derive(Copy)]
    Speed "speed"; {
        per "Share of the axes' speeds, %.": f64 = UNSET,
        tcp "TCP along the path, mm/s.": f64 = UNSET,
        ori "Turning of the tool, deg/s.": f64 = UNSET,
        exj "Rotating external axes, deg/s.": f64 = UNSET,
        exl "Linear external axes, mm/s.": f64 = UNSET,
    }

    /// Where the blending into the next motion begins, six-axis robots.
    #[derive(Copy)]
    Slip "slip", 5 by position, last shown if |slip| super::is_set(slip.jdis); {
        perdis "Share of the motion that may be blended, %; takes precedence over all others.": f64 = UNSET,
        pdis "Distance of the TCP from the target, mm.": f64 = UNSET,
        odis "Angle of the tool from its target, deg.": f64 = UNSET,
        ejdis "Rotating external axes from their target, deg.": f64 = UNSET,
        eldis "Linear external axes from their target, mm.": f64 = UNSET,
        jdis "Axes from their target, deg; set by name only.": f64 = UNSET,
    }

    /// Where the blending into the next motion begins, SCARA robots.
    #[derive(Copy)]
    SlipScara "slip"; {
        pdis "Distance of the TCP from the target, mm.": f64 = UNSET,
        ejdis "Rotating external axes from their target, deg.": f64 = UNSET,
        eldis "Linear external axes from their target, mm.": f64 = UNSET,
        odis "Angle of the tool from its target, deg.": f64 = UNSET,
        perdis "Share of the motion that may be blended, %; takes precedence over all others.": f64 = UNSET,
    }

    /// Speeds of the axes of a six-axis robot.
    #[derive(Copy)]
    Jvel "jvel"; {
        jv1 "Axis 1, rad/s.": f64 = UNSET,
        jv2 "Axis 2, rad/s.": f64 = UNSET,
        jv3 "Axis 3, rad/s.": f64 = UNSET,
        jv4 "Axis 4, rad/s.": f64 = UNSET,
        jv5 "Axis 5, rad/s.": f64 = UNSET,
        jv6 "Axis 6, rad/s.": f64 = UNSET,
        ev1 "External axis 1, rad/s.": f64 = UNSET,
        ev2 "External axis 2, rad/s.": f64 = UNSET,
        ev3 "External axis 3, rad/s.": f64 = UNSET,
        ev4 "External axis 4, rad/s.": f64 = UNSET,
        ev5 "External axis 5, rad/s.": f64 = UNSET,
        ev6 "External axis 6, rad/s.": f64 = UNSET,
    }

    /// Speeds of the axes of a SCARA robot.
    #[derive(Copy)]
    JvelScara "jvel"; {
        jv1 "Axis 1, rad/s.": f64 = UNSET,
        jv2 "Axis 2, rad/s.": f64 = UNSET,
        jv3 "Axis 3, rad/s.": f64 = UNSET,
        jv4 "Axis 4, rad/s.": f64 = UNSET,
        ev1 "External axis 1, rad/s.": f64 = UNSET,
        ev2 "External axis 2, rad/s.": f64 = UNSET,
        ev3 "External axis 3, rad/s.": f64 = UNSET,
        ev4 "External axis 4, rad/s.": f64 = UNSET,
        ev5 "External axis 5, rad/s.": f64 = UNSET,
        ev6 "External axis 6, rad/s.": f64 = UNSET,
    }

    /// The centroid of a load.
    #[derive(Copy)]
    CentroidPos "Centroid_Pos"; {
        x "Along x, mm.": f64 = 0.0,
        y "Along y, mm.": f64 = 0.0,
        z "Along z, mm.": f64 = 0.0,
    }

    /// The inertia of a load.
    #[derive(Copy)]
    InertiaTensor "Inertia_Tensor", also { lxx ixx lxy ixy lxz ixz lyy iyy lyz iyz lzz izz }; {
        ixx "Component xx, g*mm2.": f64 = 0.0,
        ixy "Component xy, g*mm2.": f64 = 0.0,
        ixz "Component xz, g*mm2.": f64 = 0.0,
        iyy "Component yy, g*mm2.": f64 = 0.0,
        iyz "Component yz, g*mm2.": f64 = 0.0,
        izz "Component zz, g*mm2.": f64 = 0.0,
    }

    /// A load: its mass, centroid and inertia.
    #[derive(Copy)]
    ToolInertiaPara "ToolInertiaPara"; {
        m "The mass, g.": f64 = 0.0,
        centroidpos "The centroid.": CentroidPos = CentroidPos::default(),
        inertiatensor "The inertia.": InertiaTensor = InertiaTensor::default(),
    }

    /// How a gate motion rises and falls.
    #[derive(Copy)]
    Control "control"; {
        rising_vel "Speed upwards, %.": f64 = UNSET,
        rising_acc "Acceleration upwards, %.": f64 = UNSET,
        rising_dec "Deceleration upwards, %.": f64 = UNSET,
        falling_vel "Speed downwards, %.": f64 = UNSET,
        falling_acc "Acceleration downwards, %.": f64 = UNSET,
        falling_dec "Deceleration downwards, %.": f64 = UNSET,
    }

    /// Limits of a compensation.
    #[derive(Copy)]
    Compendata "compendata"; {
        tcp_max_vel "TCP, mm/s.": f64 = 0.0,
        tcp_max_acc "TCP, mm/s2.": f64 = 0.0,
        tcp_max_jerk "TCP, mm/s3.": f64 = 0.0,
        ori_max_vel "Turning, deg/s.": f64 = 0.0,
        ori_max_acc "Turning, deg/s2.": f64 = 0.0,
        ori_max_jerk "Turning, deg/s3.": f64 = 0.0,
    }

    /// Torques of the axes.
    #[derive(Copy)]
    Jttq "jttq"; {
        jt1 "Axis 1, N*m.": f64 = UNSET,
        jt2 "Axis 2, N*m.": f64 = UNSET,
        jt3 "Axis 3, N*m.": f64 = UNSET,
        jt4 "Axis 4, N*m.": f64 = UNSET,
        jt5 "Axis 5, N*m.": f64 = UNSET,
        jt6 "Axis 6, N*m.": f64 = UNSET,
        et1 "External axis 1, N*m.": f64 = UNSET,
        et2 "External axis 2, N*m.": f64 = UNSET,
        et3 "External axis 3, N*m.": f64 = UNSET,
        et4 "External axis 4, N*m.": f64 = UNSET,
        et5 "External axis 5, N*m.": f64 = UNSET,
        et6 "External axis 6, N*m.": f64 = UNSET,
    }

    /// Currents of the motors.
    #[derive(Copy)]
    Jtci "jtci"; {
        ji1 "Axis 1, A.": f64 = UNSET,
        ji2 "Axis 2, A.": f64 = UNSET,
        ji3 "Axis 3, A.": f64 = UNSET,
        ji4 "Axis 4, A.": f64 = UNSET,
        ji5 "Axis 5, A.": f64 = UNSET,
        ji6 "Axis 6, A.": f64 = UNSET,
        ei1 "External axis 1, A.": f64 = UNSET,
        ei2 "External axis 2, A.": f64 = UNSET,
        ei3 "External axis 3, A.": f64 = UNSET,
        ei4 "External axis 4, A.": f64 = UNSET,
        ei5 "External axis 5, A.": f64 = UNSET,
        ei6 "External axis 6, A.": f64 = UNSET,
    }

    /// Force and torque at the TCP.
    #[derive(Copy)]
    Tcpforce "tcpforce"; {
        fx "Force along x, N.": f64 = UNSET,
        fy "Force along y, N.": f64 = UNSET,
        fz "Force along z, N.": f64 = UNSET,
        tx "Torque about x, N*m.": f64 = UNSET,
        ty "Torque about y, N*m.": f64 = UNSET,
        tz "Torque about z, N*m.": f64 = UNSET,
    }
}

#[cfg(test)]
mod tests;
