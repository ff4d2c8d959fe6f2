//! What can touch something else: limbs of robots, bodies of the cell.

use arl_robot::cell::{self, Body, Signal, Solid};
use parry3d_f64::math::{Pose, Rotation, Vector};
use parry3d_f64::shape::{Ball, Capsule, Cuboid, Cylinder, SharedShape};

use super::arm::{Arm, of_frame};
use super::mesh::Mesh;
use crate::scenery::{Looks, Piece};
use arl_wire::Runs;

/// A body, or a part of a robot.
#[derive(Clone)]
pub(super) struct Item {
    pub(super) name: String,
    /// What all of its kind are called: bodies of a `count`, or that limb of every robot.
    pub(super) kind: Option<String>,
    pub(super) shape: SharedShape,
    pub(super) holder: Holder,
    /// Where the shape is in its holder.
    pub(super) at: Pose,
    /// What it is of a robot, if it is.
    pub(super) limb: Option<Limb>,
    /// How far its places are from its shape's origin at most, in mm.
    pub(super) radius: f64,
    /// It is there only while this has this level.
    pub(super) when: Option<(Signal, bool)>,
    /// What it is of a body that a robot takes along, if it is.
    pub(super) part: Option<CarriedForm>,
    /// Such a body is not there, or it is held and this is how it stands, or the other way round.
    pub(super) absent: bool,
    /// The names of what it may touch, and of kinds.
    pub(super) may_touch: Vec<String>,
}

/// A limb of a robot.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Limb {
    /// A capsule: its place from the base on, its length and its radius in mm.
    Capsule { at: usize, length: f64, radius: f64 },
    /// A form of a link, of so many links; the base is 0.
    Link { link: usize, of: usize },
}

/// A form of a body that a robot takes along.
#[derive(Clone, Copy, Debug)]
pub(super) struct CarriedForm {
    /// Which body of the cell.
    pub(super) body: usize,
    /// Where the form is in the body.
    pub(super) piece: Pose,
    /// The channel, from 0, whose robot takes it.
    pub(super) by: usize,
}

/// What an item is fixed to. Arms are the robots of the channels, from 0, and behind them what carriers are.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Holder {
    World,
    /// A link, from 1, or the base, 0.
    Link {
        arm: usize,
        link: usize,
    },
    Flange {
        arm: usize,
    },
    /// A carrier of the cell, as long as the robots are not known.
    Carrier(usize),
}

impl Holder {
    /// The arm that moves it.
    pub(super) fn arm(self) -> Option<usize> {
        match self {
            Self::World | Self::Carrier(_) => None,
            Self::Link { arm, .. } | Self::Flange { arm } => Some(arm),
        }
    }

    /// The same, once robots are known: a carrier is the last link of an arm behind those of so many channels.
    pub(super) fn in_arms(self, channels: usize, arms: &[Option<Arm>]) -> Self {
        let Self::Carrier(number) = self else { return self };
        let arm = channels + number;
        let links = arms.get(arm).and_then(Option::as_ref).map_or(0, Arm::count);
        Self::Link { arm, link: links }
    }
}

impl Item {
    /// A shape that reaches so far, in mm, on something.
    fn new(name: String, (shape, radius): (SharedShape, f64), holder: Holder, at: Pose) -> Self {
        let (kind, limb, when, part, absent, may_touch) = (None, None, None, None, false, Vec::new());
        Self { name, kind, shape, holder, at, limb, radius, when, part, absent, may_touch }
    }

    /// Whether it says that it may touch another one.
    pub(super) fn may_touch(&self, other: &Self) -> bool {
        self.may_touch.iter().any(|name| *name == other.name || other.kind.as_ref() == Some(name))
    }

    /// How far its places are from its holder's origin at most, in mm.
    pub(super) fn farthest(&self) -> f64 {
        self.at.translation.length() + self.radius
    }
}

/// The limbs of a robot as capsules.
pub(super) fn limbs(channel: usize, runs: &Runs) -> Vec<Item> {
    let limb = |(at, limb): (usize, &arl_wire::Limb)| {
        let [from, to] = limb.ends.map(|[x, y, z]| Vector::new(x, y, z));
        let shape = SharedShape::new(Capsule::new(from, to, limb.radius));
        let radius = from.length().max(to.length()) + limb.radius;
        let holder = Holder::Link { arm: channel, link: limb.link };
        let kind = Limb::Capsule { at, length: (to - from).length(), radius: limb.radius };
        Item { limb: Some(kind), ..Item::new(limb.name.clone(), (shape, radius), holder, Pose::IDENTITY) }
    };
    runs.limbs.iter().enumerate().map(limb).collect()
}

/// A link of a robot by its forms: each mesh as its convex hull.
pub(super) fn of_link(channel: usize, (link, of): (usize, usize), looks: &Looks) -> Result<Vec<Item>, String> {
    let item = |piece: &Piece| {
        let (shape, at, radius) = form(piece, Meshes::Hulls)?;
        let limb = Some(Limb::Link { link, of });
        Ok(Item { limb, ..Item::new(String::new(), (shape, radius), Holder::Link { arm: channel, link }, at) })
    };
    looks.touched.iter().map(item).collect()
}

/// The forms of a body of the cell, which is number `number` of them. What a robot takes along is there twice, standing
/// and held.
pub(super) fn of_body(number: usize, body: &Body, looks: &Looks) -> Result<Vec<Item>, String> {
    let holder = match body.holder {
        cell::Holder::World => Holder::World,
        cell::Holder::Flange(channel) => Holder::Flange { arm: channel as usize - 1 },
        cell::Holder::Carrier(carrier) => Holder::Carrier(carrier),
    };
    let place = of_frame(&body.at);
    let mut items = Vec::new();
    for piece in &looks.touched {
        let (shape, piece, radius) = form(piece, Meshes::Surfaces)?;
        let (kind, may_touch) = (body.kind.clone(), body.may_touch.clone());
        let item = Item { kind, may_touch, ..Item::new(body.name.clone(), (shape, radius), holder, place * piece) };
        let Some(grip) = body.grip else {
            items.push(Item { when: body.when, ..item });
            continue;
        };
        let by = grip.channel as usize - 1;
        // Where it is will be said.
        let standing = Item { part: Some(CarriedForm { body: number, piece, by }), absent: true, ..item };
        items.push(Item { holder: Holder::Flange { arm: by }, ..standing.clone() });
        items.push(standing);
    }
    Ok(items)
}

/// The forms of a body, each where it is in the body: each mesh as its convex hull, in which places are, too.
pub(super) fn hulls(looks: &Looks) -> Result<Vec<(SharedShape, Pose)>, String> {
    let hull = |piece: &Piece| form(piece, Meshes::Hulls).map(|(shape, at, _)| (shape, at));
    looks.touched.iter().map(hull).collect()
}

/// What of a mesh counts.
#[derive(Clone, Copy, PartialEq)]
enum Meshes {
    Surfaces,
    Hulls,
}

/// The shape of a piece, where that is in what the piece belongs to, and how far it reaches from there, in mm.
fn form(piece: &Piece, meshes: Meshes) -> Result<(SharedShape, Pose, f64), String> {
    let at = of_frame(&piece.at);
    Ok(match &piece.solid {
        Solid::Box(edges) => {
            let half = Vector::from_array(*edges) * 0.5;
            (SharedShape::new(Cuboid::new(half)), at, half.length())
        }
        Solid::Cylinder { radius, length } => {
            // The library's stands along y.
            let upright = Rotation::from_rotation_x(std::f64::consts::FRAC_PI_2);
            let at = at * Pose::from_parts(Vector::ZERO, upright);
            (SharedShape::new(Cylinder::new(0.5 * length, *radius)), at, radius.hypot(0.5 * length))
        }
        Solid::Sphere(radius) => (SharedShape::new(Ball::new(*radius)), at, *radius),
        Solid::Mesh { file, scale } => {
            let mesh = Mesh::load(file, *scale)?;
            let farthest = mesh.farthest();
            let shape = if meshes == Meshes::Hulls { mesh.hull(file)? } else { mesh.surface(file)? };
            (shape, at, farthest)
        }
    })
}
