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
    /// The common name of its kind: of the bodies of a `count`, or of the same limb of every robot.
    pub(super) kind: Option<String>,
    pub(super) shape: SharedShape,
    pub(super) holder: Holder,
    /// Where the shape is in its holder.
    pub(super) at: Pose,
    /// Which limb of a robot it is, if any.
    pub(super) limb: Option<Limb>,
    /// The greatest distance of its points from its shape's origin, in mm.
    pub(super) radius: f64,
    /// It is there only while this signal has this level.
    pub(super) when: Option<(Signal, bool)>,
    /// Which form it is of a body that a robot takes along, if any.
    pub(super) part: Option<CarriedForm>,
    /// Whether such a form is not in use: the body is not there, or it is held and this is its standing form, or the
    /// other way round.
    pub(super) absent: bool,
    /// The names of the items, and of the kinds, that it may touch.
    pub(super) may_touch: Vec<String>,
}

/// A limb of a robot.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Limb {
    /// A capsule: its place from the base on, its length and its radius in mm.
    Capsule { at: usize, length: f64, radius: f64 },
    /// A form of a link, with the number of links; the base is 0.
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

/// What an item is fixed to. Arms are the robots of the channels, from 0, followed by the carriers.
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

    /// The holder once the robots are known: a carrier is the last link of an arm after those of the channels.
    pub(super) fn in_arms(self, channels: usize, arms: &[Option<Arm>]) -> Self {
        let Self::Carrier(number) = self else { return self };
        let arm = channels + number;
        let links = arms.get(arm).and_then(Option::as_ref).map_or(0, Arm::count);
        Self::Link { arm, link: links }
    }
}

impl Item {
    /// A shape that reaches `radius` mm, fixed to a holder.
    fn new(name: String, shape: SharedShape, radius: f64, holder: Holder, at: Pose) -> Self {
        let (kind, limb, when, part, absent, may_touch) = (None, None, None, None, false, Vec::new());
        Self { name, kind, shape, holder, at, limb, radius, when, part, absent, may_touch }
    }

    /// Whether it is declared that it may touch another item.
    pub(super) fn may_touch(&self, other: &Self) -> bool {
        self.may_touch.iter().any(|name| *name == other.name || other.kind.as_ref() == Some(name))
    }

    /// The greatest distance of its points from its holder's origin, in mm.
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
        Item { limb: Some(kind), ..Item::new(limb.name.clone(), shape, radius, holder, Pose::IDENTITY) }
    };
    runs.limbs.iter().enumerate().map(limb).collect()
}

/// The forms of a link of a robot, each mesh as its convex hull.
pub(super) fn of_link(channel: usize, link: usize, of: usize, looks: &Looks) -> Result<Vec<Item>, String> {
    let item = |piece: &Piece| {
        let (shape, at, radius) = form(piece, Meshes::Hulls)?;
        let limb = Some(Limb::Link { link, of });
        Ok(Item { limb, ..Item::new(String::new(), shape, radius, Holder::Link { arm: channel, link }, at) })
    };
    looks.touched.iter().map(item).collect()
}

/// The forms of body `number` of the cell. A body that a robot takes along is there twice, standing and held.
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
        let item = Item { kind, may_touch, ..Item::new(body.name.clone(), shape, radius, holder, place * piece) };
        let Some(grip) = body.grip else {
            items.push(Item { when: body.when, ..item });
            continue;
        };
        let by = grip.channel as usize - 1;
        // Its place will be reported.
        let standing = Item { part: Some(CarriedForm { body: number, piece, by }), absent: true, ..item };
        items.push(Item { holder: Holder::Flange { arm: by }, ..standing.clone() });
        items.push(standing);
    }
    Ok(items)
}

/// The forms of a body, each where it is in the body: each mesh as its convex hull, which points can be inside.
pub(super) fn hulls(looks: &Looks) -> Result<Vec<(SharedShape, Pose)>, String> {
    let hull = |piece: &Piece| form(piece, Meshes::Hulls).map(|(shape, at, _)| (shape, at));
    looks.touched.iter().map(hull).collect()
}

/// Which shape of a mesh counts.
#[derive(Clone, Copy, PartialEq)]
enum Meshes {
    Surfaces,
    Hulls,
}

/// The shape of a piece, its place in what the piece belongs to, and how far it reaches from there, in mm.
fn form(piece: &Piece, meshes: Meshes) -> Result<(SharedShape, Pose, f64), String> {
    let at = of_frame(&piece.at);
    Ok(match &piece.solid {
        Solid::Box(edges) => {
            let half = Vector::from_array(*edges) * 0.5;
            (SharedShape::new(Cuboid::new(half)), at, half.length())
        }
        Solid::Cylinder { radius, length } => {
            // The library's cylinder is along y.
            let upright = Rotation::from_rotation_x(std::f64::consts::FRAC_PI_2);
            let at = at * Pose::from_parts(Vector::ZERO, upright);
            (SharedShape::new(Cylinder::new(0.5 * length, *radius)), at, libm::hypot(*radius, 0.5 * length))
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
