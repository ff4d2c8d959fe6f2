//! What can touch something else: limbs of robots, bodies of the cell.

use arl_robot::cell::{Body, Signal, Solid};
use parry3d_f64::math::{Pose, Rotation, Vector};
use parry3d_f64::shape::{Capsule, Cuboid, Cylinder, SharedShape};

use super::super::said::Runs;
use super::arm::of_frame;
use super::mesh;

/// A body, or a part of a robot.
#[derive(Clone)]
pub(super) struct Item {
    pub(super) name: String,
    pub(super) shape: SharedShape,
    pub(super) holder: Holder,
    /// Where the shape is in its holder.
    pub(super) at: Pose,
    /// Of a limb: its place from the base on, its length and its radius in mm.
    pub(super) limb: Option<[f64; 3]>,
    /// How far its places are from its holder's origin at most, in mm.
    pub(super) farthest: f64,
    /// It is there only while this has this level.
    pub(super) when: Option<(Signal, bool)>,
    /// The names of what it may touch.
    pub(super) may_touch: Vec<String>,
}

/// What an item is fixed to; channels count from 0.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Holder {
    World,
    /// A link, from 1, or the base, 0.
    Link {
        channel: usize,
        link: usize,
    },
    Flange {
        channel: usize,
    },
}

impl Holder {
    /// The channel whose robot moves it.
    pub(super) fn channel(self) -> Option<usize> {
        match self {
            Self::World => None,
            Self::Link { channel, .. } | Self::Flange { channel } => Some(channel),
        }
    }
}

/// The limbs of the robot of a channel; with several robots their names tell whose they are.
pub(super) fn limbs(channel: usize, runs: &Runs, several: bool) -> Vec<Item> {
    let of = if several { format!(" of channel {}", channel + 1) } else { String::new() };
    let limb = |(at, limb): (usize, &super::super::said::Limb)| {
        let [from, to] = limb.ends.map(|[x, y, z]| Vector::new(x, y, z));
        Item {
            name: format!("{}{of}", limb.name),
            shape: SharedShape::new(Capsule::new(from, to, limb.radius)),
            holder: Holder::Link { channel, link: limb.link },
            at: Pose::IDENTITY,
            limb: Some([at as f64, (to - from).length(), limb.radius]),
            farthest: from.length().max(to.length()) + limb.radius,
            when: None,
            may_touch: Vec::new(),
        }
    };
    runs.limbs.iter().enumerate().map(limb).collect()
}

/// A body of the cell.
pub(super) fn of_body(body: &Body) -> Result<Item, String> {
    let place = of_frame(&body.at);
    let (shape, at, half) = match &body.solid {
        Solid::Box(edges) => {
            let half = Vector::from_array(*edges) * 0.5;
            (SharedShape::new(Cuboid::new(half)), place, half.length())
        }
        Solid::Cylinder { radius, length } => {
            // The library's stands along y.
            let upright = Rotation::from_rotation_x(std::f64::consts::FRAC_PI_2);
            let at = place * Pose::from_parts(Vector::ZERO, upright);
            (SharedShape::new(Cylinder::new(0.5 * length, *radius)), at, radius.hypot(0.5 * length))
        }
        Solid::Mesh(file) => {
            let (mesh, farthest) = mesh::load(file)?;
            (SharedShape::new(mesh), place, farthest)
        }
    };
    let holder = match body.carried_by {
        None => Holder::World,
        Some(channel) => Holder::Flange { channel: channel as usize - 1 },
    };
    let farthest = place.translation.length() + half;
    let (name, may_touch) = (body.name.clone(), body.may_touch.clone());
    Ok(Item { name, shape, holder, at, limb: None, farthest, when: body.when, may_touch })
}
