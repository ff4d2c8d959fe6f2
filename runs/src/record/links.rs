//! A robot's arm as viewers see it: the frames from the world to the flange and the TCP, and those of what its external
//! axes move, in m and rad.

use arl_robot::cell::Carrier;
use arl_robot::kinematics::{self, Frame, frame};
use nalgebra::{Translation3, UnitQuaternion, Vector3 as Vector};

use super::messages::{FrameTransform, Link, Quaternion, Timestamp, Vector3};
use arl_wire::{Channel, Limb, LinkJoint, Placed, Runs, placed};

/// The frame that everything is in.
pub(super) const WORLD: &str = "world";

/// The arm of a channel.
pub(super) struct RecordedArm {
    /// The prefix of the names of its frames and joints.
    prefix: String,
    pub(super) robot: String,
    pub(super) links: Vec<LinkJoint>,
    pub(super) flange: Placed,
    /// Its shape.
    pub(super) limbs: Vec<Limb>,
    /// Where its base is in the world, as far as that is known.
    pub(super) stands: Frame,
    pub(super) axes: Vec<Own>,
    /// What its external axes move.
    pub(super) carriers: Vec<Carried>,
}

/// What an external axis moves.
pub(super) struct Carried {
    pub(super) frame: String,
    /// The frame that it is on.
    pub(super) parent: String,
    pub(super) joint: kinematics::LinkJoint,
    /// The index of this axis among the robot's axes.
    pub(super) axis: usize,
}

/// An axis: its name, its range in rad (m), and whether it is linear.
pub(super) struct Own {
    pub(super) name: String,
    pub(super) range: [f64; 2],
    pub(super) linear: bool,
}

impl RecordedArm {
    /// The robot of a channel, from 0.
    pub(super) fn new(prefix: String, runs: &Runs, channel: usize, carriers: &[Carrier]) -> Self {
        let own = |axis: &arl_wire::Axis| {
            let linear = axis.is_linear();
            Own { name: axis.name.clone(), range: [axis.min, axis.max].map(|value| si(value, linear)), linear }
        };
        let named = |carrier: &Carrier| carrier_frame(&prefix, &carrier.axis);
        let moved = |carrier: &Carrier| {
            let (axis, about) = runs.external(carrier.number)?;
            let below = carrier.on.and_then(|on| carriers.get(on)).map_or_else(|| WORLD.to_owned(), named);
            Some(Carried { frame: named(carrier), parent: below, joint: carrier.joint(about.is_linear()), axis })
        };
        let its_own = carriers.iter().filter(|carrier| carrier.channel as usize == channel + 1);
        Self {
            carriers: its_own.filter_map(moved).collect(),
            prefix,
            robot: runs.robot.clone().unwrap_or_default(),
            links: runs.links.clone(),
            flange: runs.flange,
            limbs: runs.limbs.clone(),
            stands: Frame::identity(),
            axes: runs.axes.iter().map(own).collect(),
        }
    }

    /// Sets the place of its base: x, y, z in mm, a, b, c in deg.
    pub(super) fn stands_on(&mut self, base: &[f64]) {
        self.stands = components(base);
    }

    /// The common name of a link; 0 is the base.
    pub(super) fn name_of(&self, link: usize) -> &str {
        arl_wire::name_of_link(link, self.links.len(), &self.limbs)
    }

    /// The frame of its base, of the link `number`, from 1, ...
    pub(super) fn base(&self) -> String {
        format!("{}base_link", self.prefix)
    }

    pub(super) fn link(&self, number: usize) -> String {
        format!("{}link_{number}", self.prefix)
    }

    /// ... and of its flange.
    pub(super) fn flange_frame(&self) -> String {
        format!("{}flange", self.prefix)
    }

    pub(super) fn joint(&self, name: &str) -> String {
        format!("{}{name}", self.prefix)
    }

    /// The frame of its TCP.
    pub(super) fn tcp_frame(&self) -> String {
        format!("{}tcp", self.prefix)
    }

    /// The workpiece frame of its motion.
    fn workpiece_frame(&self) -> String {
        format!("{}workpiece", self.prefix)
    }

    /// The frame of what an external axis moves.
    pub(super) fn carrier_frame(&self, axis: &str) -> String {
        carrier_frame(&self.prefix, axis)
    }

    /// What its external axes move, as [`chain`](Self::chain).
    pub(super) fn carried(&self) -> impl Iterator<Item = Link> {
        self.carriers.iter().map(|Carried { frame, parent, joint, axis }| Link {
            frame: frame.clone(),
            parent: parent.clone(),
            origin: arl_wire::written(&joint.origin).to_vec(),
            axis: joint.axis.iter().copied().collect(),
            linear: joint.linear,
            moved_by: self.axis_name(*axis),
        })
    }

    fn axis_name(&self, at: usize) -> String {
        self.axes.get(at).map(|own| own.name.clone()).unwrap_or_default()
    }

    /// Its links from the base on, and its flange.
    pub(super) fn chain(&self) -> Vec<Link> {
        let mut before = self.base();
        let mut chain = Vec::with_capacity(self.links.len() + 1);
        for (number, link) in (1..).zip(&self.links) {
            let frame = self.link(number);
            let parent = std::mem::replace(&mut before, frame.clone());
            let (origin, axis) = (link.origin.to_vec(), link.axis.to_vec());
            let moved_by = self.axis_name(number - 1);
            chain.push(Link { frame, parent, origin, axis, linear: link.linear, moved_by });
        }
        let (frame, origin) = (self.flange_frame(), self.flange.to_vec());
        chain.push(Link { frame, parent: before, origin, ..Link::default() });
        chain
    }

    /// The axes' values in rad (m), each with its name.
    pub(super) fn joints(&self, axes: &[f64]) -> impl Iterator<Item = (String, f64)> {
        self.axes.iter().zip(axes).map(|(own, value)| (self.joint(&own.name), si(*value, own.linear)))
    }

    /// All frames at a moment.
    pub(super) fn transforms(&self, reported: &Channel, now: Timestamp) -> Vec<FrameTransform> {
        let mut all = Vec::with_capacity(self.links.len() + 3);
        let mut add = |parent: String, child: String, frame: &Frame| all.push(transform(now, parent, child, frame));
        add(WORLD.into(), self.base(), &components(&reported.base));
        let mut before = self.base();
        for (number, (link, value)) in (1..).zip(self.links.iter().zip(&reported.axes)) {
            let name = self.link(number);
            add(before, name.clone(), &link.joint().at(*value));
            before = name;
        }
        add(before, self.flange_frame(), &placed(&self.flange));
        add(WORLD.into(), self.tcp_frame(), &components(&reported.tcp));
        add(WORLD.into(), self.workpiece_frame(), &components(&reported.workpiece));
        for Carried { frame, parent, joint, axis } in &self.carriers {
            add(parent.clone(), frame.clone(), &joint.at(reported.axes.get(*axis).copied().unwrap_or_default()));
        }
        all
    }
}

/// What an external axis moves is named after the axis.
fn carrier_frame(prefix: &str, axis: &str) -> String {
    format!("{prefix}{axis}")
}

/// deg to rad, mm to m.
fn si(value: f64, linear: bool) -> f64 {
    if linear { value / 1000.0 } else { value.to_radians() }
}

/// A frame from x, y, z, a, b, c; the frame of the world if these are missing.
fn components(values: &[f64]) -> Frame {
    <[f64; 6]>::try_from(values).map_or_else(|_| Frame::identity(), frame)
}

pub(super) fn transform(
    now: Timestamp,
    parent_frame_id: String,
    child_frame_id: String,
    frame: &Frame,
) -> FrameTransform {
    let (translation, rotation) = parts(frame);
    FrameTransform {
        timestamp: Some(now),
        parent_frame_id,
        child_frame_id,
        translation: Some(translation),
        rotation: Some(rotation),
    }
}

/// A frame in the form of messages, in m.
pub(super) fn parts(frame: &Frame) -> (Vector3, Quaternion) {
    let at = frame.translation.vector / 1000.0;
    let [x, y, z, w] = frame.rotation.coords.into();
    (Vector3 { x: at.x, y: at.y, z: at.z }, Quaternion { x, y, z, w })
}

/// The straight part of a limb: its middle, with z along it, and its length in mm. `None`: it is a ball.
pub(super) fn straight(limb: &Limb) -> Option<(Frame, f64)> {
    let [from, to] = limb.ends.map(Vector::from);
    let along = to - from;
    if along.norm() == 0.0 {
        return None;
    }
    // Where the limb points straight down, any half turn will do.
    let turned = UnitQuaternion::rotation_between(&Vector::z(), &along)
        .unwrap_or_else(|| UnitQuaternion::from_scaled_axis(Vector::x() * std::f64::consts::PI));
    Some((Frame::from_parts(Translation3::from(0.5 * (from + to)), turned), along.norm()))
}
