//! Where the links of a robot are, and what external axes move.

use arl_robot::cell::Carrier;
use arl_robot::kinematics::{Frame, LinkJoint, frame};
use parry3d_f64::math::{Pose, Rotation, Vector};

use arl_wire::{Moves, Runs, placed};

/// A robot's arm on its base, which is placed in the world; or a carrier, with the carriers that it is on as links.
/// Lengths are in mm.
pub(super) struct Arm {
    /// The channel of the robot, from 0.
    channel: usize,
    joints: Vec<Joint>,
    /// Which of the robot's axes are its own, in the order of its joints.
    own: Vec<usize>,
    /// Whether it is a carrier: what external axes move is where it is built, whatever `$BASE` is.
    is_carrier: bool,
    /// Whether the cell says where it stands: the place of its base is known from the start.
    is_placed: bool,
    flange: Pose,
    /// x, y, z in mm, a, b, c in deg; empty as long as the base is not known.
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
    /// The greatest distance of the link's origin from that of the link before, in mm.
    length: f64,
}

impl Joint {
    fn new(joint: LinkJoint, axis: &arl_wire::Axis) -> Self {
        let travel = if joint.linear { axis.min.abs().max(axis.max.abs()) } else { 0.0 };
        Self { joint, length: joint.origin.translation.vector.norm() + travel }
    }
}

impl Arm {
    /// The robot of a channel, from 0; `is_placed`: whether the cell says where it stands.
    pub(super) fn new(channel: usize, runs: &Runs, is_placed: bool) -> Self {
        let joint = |(joint, axis): (&arl_wire::LinkJoint, &arl_wire::Axis)| Joint::new(joint.joint(), axis);
        let joints: Vec<Joint> = runs.links.iter().zip(&runs.axes).map(joint).collect();
        let own = (0..joints.len()).collect();
        Self { is_placed, ..Self::of(channel, joints, own, of_frame(&placed(&runs.flange)), false) }
    }

    /// What an external axis of a channel's robot moves, with the carriers that it is on; `None` if the robot has no
    /// such axis.
    pub(super) fn carrier(carriers: &[Carrier], at: usize, all: &[Runs]) -> Option<Self> {
        let channel = carriers.get(at)?.channel as usize - 1;
        let runs = all.get(channel)?;
        let (mut joints, mut own) = (Vec::new(), Vec::new());
        for carrier in Carrier::chain(carriers, at) {
            let (number, axis) = runs.external(carrier.number)?;
            joints.push(Joint::new(carrier.joint(axis.is_linear()), axis));
            own.push(number);
        }
        Some(Self::of(channel, joints, own, Pose::IDENTITY, true))
    }

    fn of(channel: usize, joints: Vec<Joint>, own: Vec<usize>, flange: Pose, is_carrier: bool) -> Self {
        let (base, axes) = (Vec::new(), vec![0.0; joints.len()]);
        let (base_pose, links) = (Pose::IDENTITY, Vec::new());
        let (is_placed, based) = (false, 0);
        let mut arm = Self { channel, joints, own, is_carrier, is_placed, flange, base, base_pose, based, axes, links };
        arm.place_links();
        arm
    }

    /// The channel, from 0, of the robot that it is, or of the one whose axes move it.
    pub(super) fn channel(&self) -> usize {
        self.channel
    }

    /// Moves the arm to its present position; returns whether that is another one than before. Where the cell does not
    /// say where the robot stands, the place of its base is known once the robot has moved.
    pub(super) fn go_to(&mut self, moves: &Moves) -> bool {
        let is_based = (self.is_placed || moves.line > 0) && !self.is_carrier;
        let base = if is_based { &moves.base[..] } else { &[] };
        let mut stays = base == self.base;
        for (axis, at) in self.axes.iter_mut().zip(&self.own) {
            let Some(now) = moves.axes.get(*at) else { continue };
            stays &= axis == now;
            *axis = *now;
        }
        if stays {
            return false;
        }
        if base != self.base {
            base.clone_into(&mut self.base);
            let frame = <[f64; 6]>::try_from(base).map(frame).unwrap_or_default();
            self.base_pose = of_frame(&frame);
            self.based += 1;
        }
        self.place_links();
        true
    }

    /// Whether it is a robot, not a carrier.
    pub(super) fn is_robot(&self) -> bool {
        !self.is_carrier
    }

    /// How many joints it shares with another arm, from the world or the base on.
    pub(super) fn shared_with(&self, other: &Arm) -> usize {
        if (self.channel, self.is_carrier) != (other.channel, other.is_carrier) {
            return 0;
        }
        self.own.iter().zip(&other.own).take_while(|(one, other)| one == other).count()
    }

    /// Whether the place of its base is known.
    pub(super) fn is_based(&self) -> bool {
        self.is_carrier || !self.base.is_empty()
    }

    /// How often the place of its base has changed.
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

    /// The most that a point of the last of these links moves relative to the link before the first one, in mm, while
    /// the axes go from `before` to their present positions. The point is at most `away` from its link's origin.
    pub(super) fn moved(&self, before: &[f64], links: std::ops::Range<usize>, away: f64) -> f64 {
        // From the last joint backwards, each joint swings all links after it.
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

/// Converts a frame of the robot's kinematics.
pub(super) fn of_frame(frame: &Frame) -> Pose {
    let (at, turned) = (frame.translation.vector, frame.rotation.coords);
    Pose::from_parts(Vector::new(at.x, at.y, at.z), Rotation::from_xyzw(turned.x, turned.y, turned.z, turned.w))
}
