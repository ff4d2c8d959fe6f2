//! The arrangement of frames: the tool on the flange or stationary in the world, the workpiece in the world or held by
//! the robot, the base of the robot, and the offsets of all tools and workpieces.

use std::fmt;

use super::rig::{Carried, Rig};
use crate::kinematics::{Frame, frame};

/// A tool or a workpiece: its frame, and whether the robot carries it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Mount {
    /// Relative to the flange if the robot carries it, otherwise in the world; translation in mm.
    pub frame: Frame,
    /// Whether it is on the flange.
    pub on_flange: bool,
}

/// The frames between a programmed pose and the flange. Translations are in mm, as in all frames.
///
/// A pose is the tool's frame relative to the workpiece frame. `tool` is relative to the flange, or to the world if the
/// tool is stationary; `wobj` is in the world, or relative to the flange if the robot holds the workpiece; `base` is
/// the robot's base in the world.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Setting {
    tool: Frame,
    stationary: bool,
    wobj: Frame,
    held: bool,
    base: Frame,
}

/// Tool and workpiece do not move relative to each other, so that no motion of the robot reaches a pose.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Unmoved {
    /// Both are on the flange.
    BothHeld,
    /// Neither is on the flange.
    NeitherHeld,
}

impl fmt::Display for Unmoved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Unmoved::BothHeld => {
                "the robot holds both the tool and the workpiece, which then do not move relative to each other; a workpiece \
                 with robhold needs a tool with stationary"
            }
            Unmoved::NeitherHeld => {
                "the robot holds neither the tool nor the workpiece, so it cannot move them; a stationary tool needs a \
                 workpiece with robhold"
            }
        })
    }
}

impl std::error::Error for Unmoved {}

impl Setting {
    /// A setting with the tool and workpiece of a program, and the base in the world (`$BASE`).
    pub fn new(tool: impl Into<Mount>, wobj: impl Into<Mount>, base: impl Into<Frame>) -> Self {
        let (tool, wobj) = (tool.into(), wobj.into());
        Self {
            tool: tool.frame,
            stationary: !tool.on_flange,
            wobj: wobj.frame,
            held: wobj.on_flange,
            base: base.into(),
        }
    }

    /// The setting with `$TOOL_OFFSET` and `$WOBJ_OFFSET` (mm, deg), which apply to motions, but not to queries: each
    /// shifts and turns its frame along and about that frame's own axes.
    pub fn with_offsets(self, tool: &[f64; 6], wobj: &[f64; 6]) -> Self {
        Self { tool: self.tool * frame(*tool), wobj: self.wobj * frame(*wobj), ..self }
    }

    /// Checks that tool and workpiece move relative to each other.
    ///
    /// # Errors
    /// They do not move relative to each other.
    pub fn check(&self) -> Result<(), Unmoved> {
        match (self.stationary, self.held) {
            (false, false) | (true, true) => Ok(()),
            (false, true) => Err(Unmoved::BothHeld),
            (true, false) => Err(Unmoved::NeitherHeld),
        }
    }

    /// What the robot carries, and where its base is.
    pub fn rig(&self) -> Rig {
        let base = self.base;
        let carried =
            if self.stationary { Carried::Workpiece(base.inverse() * self.tool) } else { Carried::Tool(self.tool) };
        Rig { carried, base, workpiece: Mount { frame: self.wobj, on_flange: self.held } }
    }

    /// The workpiece frame in the frame in which paths of the TCP are given (see [`Carried`]).
    pub fn workpiece(&self) -> Frame {
        if self.held { self.wobj } else { self.base.inverse() * self.wobj }
    }

    /// The flange in the robot's base when the tool is at `pose` in the workpiece frame.
    ///
    /// # Errors
    /// Tool and workpiece do not move relative to each other.
    pub fn flange_of(&self, pose: &Frame) -> Result<Frame, Unmoved> {
        self.check()?;
        Ok(self.rig().carried.flange_at(&(self.workpiece() * pose)))
    }

    /// The tool's frame in the workpiece frame when the flange is at `flange` in the robot's base.
    pub fn pose_of(&self, flange: &Frame) -> Frame {
        let wobj = if self.held { self.base * flange * self.wobj } else { self.wobj };
        wobj.inverse() * self.rig().tcp_at(flange)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::frame_components;
    use crate::kinematics::random::Random;
    use nalgebra::{Translation3, UnitQuaternion, Vector3};

    fn tool(components: [f64; 6], stationary: bool) -> Mount {
        Mount { frame: frame(components), on_flange: !stationary }
    }

    fn wobj(components: [f64; 6], robhold: bool) -> Mount {
        Mount { frame: frame(components), on_flange: robhold }
    }

    const NOWHERE: [f64; 6] = [0.0; 6];

    fn base(components: [f64; 6]) -> Frame {
        frame(components)
    }

    #[test]
    fn a_rig_knows_where_the_workpiece_is() {
        let flange = frame([700.0, 20.0, 400.0, 10.0, 170.0, 5.0]);
        let (stand, part) = (base([100.0, 200.0, 0.0, 30.0, 0.0, 0.0]), [50.0, 0.0, 10.0, 0.0, 0.0, 45.0]);
        // Also if tool and workpiece do not match: this does not matter to a motion of the axes.
        for stationary in [false, true] {
            let setting =
                |held| Setting::new(tool([0.0, 0.0, 90.0, 0.0, 0.0, 0.0], stationary), wobj(part, held), stand);
            close(&setting(false).rig().workpiece_at(&flange), part);
            let held = setting(true).rig().workpiece_at(&flange);
            close(&((stand * flange).inverse() * held), part);
        }
    }

    fn close(found: &Frame, expected: [f64; 6]) {
        let found = frame_components(found);
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?} {expected:?}");
    }

    #[test]
    fn the_examples_of_the_offsets_come_out() {
        let plain = Setting::new(tool(NOWHERE, false), wobj(NOWHERE, false), base(NOWHERE));
        let target = frame([400.0, 0.0, 800.0, 0.0, 0.0, 0.0]);
        let moved = plain.with_offsets(&NOWHERE, &[50.0, 50.0, 50.0, 0.0, 0.0, 0.0]).flange_of(&target).unwrap();
        close(&plain.pose_of(&moved), [450.0, 50.0, 850.0, 0.0, 0.0, 0.0]);
        let moved = plain.with_offsets(&[50.0, 0.0, 0.0, 0.0, 0.0, 0.0], &NOWHERE).flange_of(&target).unwrap();
        close(&plain.pose_of(&moved), [350.0, 0.0, 800.0, 0.0, 0.0, 0.0]);
        // Offsets are along the axes of their own frames.
        let turned = Setting::new(tool(NOWHERE, false), wobj([0.0, 0.0, 0.0, 90.0, 0.0, 0.0], false), base(NOWHERE));
        let moved = turned.with_offsets(&NOWHERE, &[10.0, 0.0, 0.0, 0.0, 0.0, 0.0]).flange_of(&Frame::identity());
        close(&moved.unwrap(), [0.0, 10.0, 0.0, 90.0, 0.0, 0.0]);
    }

    #[test]
    fn the_base_is_under_the_robot() {
        // The robot hangs upside down, 2 m above the floor.
        let hanging = base([0.0, 0.0, 2000.0, 0.0, 0.0, 180.0]);
        let setting = Setting::new(tool([0.0, 0.0, 100.0, 0.0, 0.0, 0.0], false), wobj(NOWHERE, false), hanging);
        let flange = setting.flange_of(&frame([500.0, 200.0, 900.0, 0.0, 0.0, 180.0])).unwrap();
        close(&flange, [500.0, -200.0, 1000.0, 0.0, 0.0, 0.0]);
        close(&setting.rig().tcp_at(&flange), [500.0, 200.0, 900.0, 0.0, 0.0, 180.0]);
    }

    #[test]
    fn a_held_workpiece_goes_to_the_tool_that_stands() {
        // A grinder is at x 1000; the corner of the part is 200 in front of the flange.
        let grinder = tool([1000.0, 0.0, 500.0, 0.0, 0.0, 0.0], true);
        let part = wobj([0.0, 0.0, 200.0, 0.0, 0.0, 0.0], true);
        let setting = Setting::new(grinder, part, base(NOWHERE));
        let flange = setting.flange_of(&Frame::identity()).unwrap();
        close(&flange, [1000.0, 0.0, 300.0, 0.0, 0.0, 0.0]);
        // 50 further along the part: the part moves back by 50.
        let flange = setting.flange_of(&frame([50.0, 0.0, 0.0, 0.0, 0.0, 0.0])).unwrap();
        close(&flange, [950.0, 0.0, 300.0, 0.0, 0.0, 0.0]);
        close(&setting.pose_of(&flange), [50.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        close(&setting.rig().tcp_at(&flange), [1000.0, 0.0, 500.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn what_does_not_move_is_refused_but_can_be_asked_for() {
        let on_flange = tool([0.0, 0.0, 100.0, 0.0, 0.0, 0.0], false);
        let both = Setting::new(on_flange, wobj([0.0, 0.0, 30.0, 0.0, 0.0, 0.0], true), base(NOWHERE));
        assert_eq!(both.flange_of(&Frame::identity()), Err(Unmoved::BothHeld));
        close(&both.pose_of(&frame([7.0, 8.0, 9.0, 10.0, 20.0, 30.0])), [0.0, 0.0, 70.0, 0.0, 0.0, 0.0]);
        let neither = Setting::new(tool(NOWHERE, true), wobj(NOWHERE, false), base(NOWHERE));
        assert_eq!(neither.flange_of(&Frame::identity()), Err(Unmoved::NeitherHeld));
        assert!(Unmoved::NeitherHeld.to_string().contains("robhold"));
    }

    #[test]
    fn poses_and_flanges_go_both_ways_and_twists_are_their_derivatives() {
        let mut random = Random::new(31);
        let mut place = || {
            let mut number = |size: f64| random.between(-size, size);
            [number(800.0), number(800.0), number(800.0), number(170.0), number(80.0), number(170.0)]
        };
        for round in 0..200 {
            let held = round % 2 == 1;
            let setting =
                Setting::new(tool(place(), held), wobj(place(), held), base(place())).with_offsets(&place(), &place());
            let start = frame(place());
            let flange = setting.flange_of(&start).unwrap();
            let back = setting.pose_of(&flange);
            assert!((back.translation.vector - start.translation.vector).norm() < 1e-8);
            assert!(back.rotation.angle_to(&start.rotation) < 1e-12);

            // Along a curve: the twist predicts the flange where a straight prediction of third order reaches.
            let ([x, y, z, a, b, c], [u, v, w, ..], [r, s, t, ..]) = (place(), place(), place());
            let moving = [Vector3::new(x, y, z), Vector3::new(u, v, w), Vector3::new(r, s, t)];
            let axis = Vector3::new(a, b, c).normalize();
            let at = |h: f64| {
                let moved = moving[0] * h + moving[1] * (h * h / 2.0) + moving[2] * (h * h * h / 6.0);
                let turned = UnitQuaternion::from_scaled_axis(axis * (0.7 * h + 0.3 * h * h + 0.2 * h * h * h));
                let pose =
                    Frame::from_parts(Translation3::from(start.translation.vector + moved), turned * start.rotation);
                setting.flange_of(&pose).unwrap()
            };
            let frame = setting.workpiece();
            let turned = |vectors: [Vector3<f64>; 3]| vectors.map(|vector| frame.rotation * vector);
            let turning = turned([axis * 0.7, axis * 0.6, axis * 1.2]);
            let twist = setting.rig().carried.twist(&(frame * start), &turned(moving), &turning);
            let point = flange.translation.vector;
            let [first, second, third] = twist.of_place(&point);
            let h = 1e-3;
            let place = |h: f64| at(h).translation.vector;
            let (m2, m1, p1, p2) = (place(-2.0 * h), place(-h), place(h), place(2.0 * h));
            let near = |found: Vector3<f64>, expected: Vector3<f64>, slack: f64| {
                assert!((found - expected).norm() < slack * (1.0 + expected.norm()), "{held}: {found} {expected}");
            };
            near(((p1 - m1) * 8.0 - (p2 - m2)) / (12.0 * h), first, 1e-6);
            near(((p1 + m1) * 16.0 - (p2 + m2) - point * 30.0) / (12.0 * h * h), second, 1e-5);
            near((p2 - m2 - (p1 - m1) * 2.0) / (2.0 * h * h * h), third, 1e-3);
        }
    }
}
