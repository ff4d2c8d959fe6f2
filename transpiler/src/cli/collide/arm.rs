//! Where the links of a robot are.

use arl_robot::kinematics::{Frame, LinkJoint, frame};
use parry3d_f64::math::{Pose, Rotation, Vector};

use super::super::said::{self, Moves, Runs, placed};

/// A robot's arm in its base, which stands in the world; lengths in mm.
pub(super) struct Arm {
    joints: Vec<Joint>,
    flange: Pose,
    /// x, y, z in mm, a, b, c in deg; empty as long as that is not known.
    base: Vec<f64>,
    base_pose: Pose,
    based: u32,
    /// deg (mm)
    axes: Vec<f64>,
    /// From the base, 0, to the last link.
    links: Vec<Pose>,
}

struct Joint {
    joint: LinkJoint,
    /// The farthest that the link's origin gets from that of the link before, in mm.
    length: f64,
}

impl Arm {
    pub(super) fn new(runs: &Runs) -> Self {
        let joint = |(joint, axis): (&said::LinkJoint, &said::Axis)| {
            let joint = joint.joint();
            let travel = if joint.linear { axis.min.abs().max(axis.max.abs()) } else { 0.0 };
            Joint { joint, length: joint.origin.translation.vector.norm() + travel }
        };
        let mut arm = Self {
            joints: runs.links.iter().zip(&runs.axes).map(joint).collect(),
            flange: of_frame(&placed(&runs.flange)),
            base: Vec::new(),
            base_pose: Pose::IDENTITY,
            based: 0,
            axes: vec![0.0; runs.links.len()],
            links: Vec::new(),
        };
        arm.place_links();
        arm
    }

    /// Takes in where it is. Where its base stands is known once it has moved.
    pub(super) fn go_to(&mut self, moves: &Moves) {
        let own = moves.axes.get(..self.joints.len()).unwrap_or(&moves.axes);
        let is_based = moves.line > 0;
        let base = if is_based { &moves.base[..] } else { &[] };
        if own == self.axes && base == self.base {
            return;
        }
        own.clone_into(&mut self.axes);
        if base != self.base {
            base.clone_into(&mut self.base);
            let frame = <[f64; 6]>::try_from(base).map(frame).unwrap_or_default();
            self.base_pose = of_frame(&frame);
            self.based += 1;
        }
        self.place_links();
    }

    /// Whether it is known where its base stands.
    pub(super) fn is_based(&self) -> bool {
        !self.base.is_empty()
    }

    /// How often its base came to stand elsewhere.
    pub(super) fn based(&self) -> u32 {
        self.based
    }

    fn place_links(&mut self) {
        self.links.clear();
        let mut place = self.base_pose;
        self.links.push(place);
        for (Joint { joint, .. }, value) in self.joints.iter().zip(&self.axes) {
            place *= of_frame(&joint.at(*value));
            self.links.push(place);
        }
    }

    /// The frame of a link, or of the base, 0.
    pub(super) fn link(&self, link: usize) -> Option<Pose> {
        self.links.get(link).copied()
    }

    pub(super) fn flange(&self) -> Pose {
        self.links.last().copied().unwrap_or(self.base_pose) * self.flange
    }

    /// How many links it has.
    pub(super) fn count(&self) -> usize {
        self.joints.len()
    }

    /// How far the flange is from the last link's origin, in mm.
    pub(super) fn flange_length(&self) -> f64 {
        self.flange.translation.length()
    }

    pub(super) fn axes(&self) -> &[f64] {
        &self.axes
    }

    /// The most that a place of the last of these links moves against the link before the first one, in mm, while the axes go from `before`
    /// to where they are now. The place is no farther from its link's origin than `away`.
    pub(super) fn moved(&self, before: &[f64], links: std::ops::Range<usize>, away: f64) -> f64 {
        // From the last joint on back, each one swings all that is behind it.
        let mut reach = away;
        let mut moved = 0.0;
        let all = self.joints.iter().zip(self.axes.iter().zip(before));
        for (joint, (now, before)) in all.take(links.end).skip(links.start).rev() {
            let change = (now - before).abs();
            moved += if joint.joint.linear { change } else { change.to_radians() * reach };
            reach += joint.length;
        }
        moved
    }
}

/// A frame of the robot's kinematics.
pub(super) fn of_frame(frame: &Frame) -> Pose {
    let (at, turned) = (frame.translation.vector, frame.rotation.coords);
    Pose::from_parts(Vector::new(at.x, at.y, at.z), Rotation::from_xyzw(turned.x, turned.y, turned.z, turned.w))
}
