//! What a viewer draws: limbs of robots, bodies of the cell, each in its frame.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use arl_robot::cell::{Body, Holder, Solid};
use arl_robot::kinematics::Frame;
use arl_robot::regular_file;

use super::links::{RecordedArm, WORLD, parts, straight};
use super::messages::{self, Color, Cylinder, Model, Pose, SceneEntity, SceneEntityDeletion, SceneUpdate, Timestamp};
use crate::scenery::{Looks, Piece, Scenery, Shape, stl};
use arl_terminal::show;
use arl_wire::{Limb, Placing, State};

/// The colours of robots, of what stands, and of what they carry.
const LIMB: Color = Color { r: 0.95, g: 0.55, b: 0.15, a: 1.0 };
const STANDS: Color = Color { r: 0.55, g: 0.6, b: 0.65, a: 1.0 };
const CARRIED: Color = Color { r: 0.25, g: 0.55, b: 0.85, a: 1.0 };
/// Meshes have mm, viewers m.
const METRES: f64 = 0.001;

/// What is drawn around robots, and of the robots.
pub(super) struct Scene {
    scenery: Scenery,
    /// For each body, whether it is drawn.
    shown: Vec<bool>,
    meshes: Meshes,
}

/// The bytes of files that were read; `None`: the file cannot be read, which is reported once.
#[derive(Default)]
struct Meshes(BTreeMap<PathBuf, Option<Vec<u8>>>);

impl Meshes {
    fn read(&mut self, file: &Path) -> Option<Vec<u8>> {
        let read = || {
            let bytes = regular_file::read(file).map_err(|error| error.to_string());
            let wrong = |why| show::warning(&format!("{} is not drawn: {why}", file.display()));
            bytes.and_then(stl::for_viewers).map_err(wrong).ok()
        };
        self.0.entry(file.to_owned()).or_insert_with(read).clone()
    }
}

impl Scene {
    pub(super) fn new(scenery: &Scenery) -> Self {
        Self { scenery: scenery.clone(), shown: vec![false; scenery.bodies.len()], meshes: Meshes::default() }
    }

    /// The scenery around the robots.
    pub(super) fn scenery(&self) -> &Scenery {
        &self.scenery
    }

    /// The bodies that appear, and those that disappear, by the levels of inputs and outputs.
    pub(super) fn bodies(
        &mut self,
        state: &State,
        arms: &[Option<RecordedArm>],
        now: Timestamp,
    ) -> Option<SceneUpdate> {
        let mut update = SceneUpdate::default();
        for ((body, looks), shown) in self.scenery.bodies.iter().zip(&mut self.shown) {
            if body.grip.is_some() {
                // A later line reports where it is.
                continue;
            }
            let there = body.when.is_none_or(|level| state.has(level));
            if std::mem::replace(shown, there) == there {
                continue;
            }
            if there {
                let frame = frame_of(body.holder, arms, &self.scenery);
                let color = if matches!(body.holder, Holder::Flange(_)) { CARRIED } else { STANDS };
                update.entities.push(drawn(body, looks, frame, &body.at, color, &mut self.meshes, now));
            } else {
                update.deletions.push(SceneEntityDeletion { timestamp: Some(now), id: id(body) });
            }
        }
        (!update.entities.is_empty() || !update.deletions.is_empty()).then_some(update)
    }

    /// Moves a body that robots take along to another place.
    pub(super) fn place(
        &mut self,
        placing: &Placing,
        arms: &[Option<RecordedArm>],
        now: Timestamp,
    ) -> Option<SceneUpdate> {
        let (body, looks) = self.scenery.bodies.get(placing.body)?;
        let shown = self.shown.get_mut(placing.body)?;
        let was_shown = std::mem::replace(shown, placing.place.is_some());
        let mut update = SceneUpdate::default();
        match placing.place {
            Some(place) => {
                let holder = place.held_by.map_or(Holder::World, |channel| Holder::Flange(channel as u32 + 1));
                let frame = frame_of(holder, arms, &self.scenery);
                update.entities.push(drawn(body, looks, frame, &place.at, CARRIED, &mut self.meshes, now));
            }
            None if was_shown => update.deletions.push(SceneEntityDeletion { timestamp: Some(now), id: id(body) }),
            None => return None,
        }
        Some(update)
    }

    /// The limbs of all robots.
    pub(super) fn robots(&mut self, arms: &[Option<RecordedArm>]) -> SceneUpdate {
        let mut entities = Vec::new();
        for (channel, arm) in arms.iter().enumerate() {
            let Some(arm) = arm else { continue };
            match self.scenery.shape(channel) {
                Some(shape) => entities.extend(links(arm, shape, &mut self.meshes)),
                None => entities.extend(arm.limbs.iter().map(|limb| capsules(arm, limb))),
            }
        }
        SceneUpdate { deletions: Vec::new(), entities }
    }
}

/// The frame of what a body is fixed to.
pub(super) fn frame_of(holder: Holder, arms: &[Option<RecordedArm>], scenery: &Scenery) -> String {
    let arm = |channel: u32| arms.get(channel as usize - 1)?.as_ref();
    let frame = match holder {
        Holder::World => None,
        Holder::Flange(channel) => arm(channel).map(RecordedArm::flange_frame),
        Holder::Carrier(at) => {
            let carrier = scenery.carriers.get(at);
            carrier.and_then(|carrier| Some(arm(carrier.channel)?.carrier_frame(&carrier.axis)))
        }
    };
    frame.unwrap_or_else(|| WORLD.to_owned())
}

/// The id of a body in a scene.
fn id(body: &Body) -> String {
    format!("body/{}", body.name)
}

/// A body at a place in a frame.
fn drawn(
    body: &Body,
    looks: &Looks,
    frame_id: String,
    at: &Frame,
    color: Color,
    meshes: &mut Meshes,
    now: Timestamp,
) -> SceneEntity {
    let mut entity = SceneEntity { id: id(body), frame_id, frame_locked: true, ..timed(now) };
    for piece in &looks.seen {
        draw(&mut entity, piece, &(at * piece.at), color, meshes);
    }
    entity
}

/// A limb as a capsule.
fn capsules(arm: &RecordedArm, limb: &Limb) -> SceneEntity {
    let frame_id = if limb.link == 0 { arm.base() } else { arm.link(limb.link) };
    let (spheres, cylinders) = capsule(limb);
    let id = arm.joint(&limb.name);
    SceneEntity { frame_id, id, frame_locked: true, spheres, cylinders, ..timed(Timestamp::default()) }
}

/// The links of a robot that has a shape of its own. Links with the same common name are one thing to users:
/// `the forearm`, and what axis 4 turns of it; a later one has the number of its link after its name.
fn links(arm: &RecordedArm, shape: &Shape, meshes: &mut Meshes) -> Vec<SceneEntity> {
    let mut entities: Vec<SceneEntity> = Vec::new();
    for (link, looks) in shape.links().filter(|(_, looks)| !looks.seen.is_empty()) {
        let frame_id = if link == 0 { arm.base() } else { arm.link(link) };
        let name = arm.joint(arm.name_of(link));
        let is_taken = entities.iter().any(|entity| entity.id == name);
        let id = if is_taken { format!("{name}/{link}") } else { name };
        let mut entity = SceneEntity { id, frame_id, frame_locked: true, ..timed(Timestamp::default()) };
        for piece in &looks.seen {
            draw(&mut entity, piece, &piece.at, LIMB, meshes);
        }
        entities.push(entity);
    }
    entities
}

fn timed(now: Timestamp) -> SceneEntity {
    SceneEntity { timestamp: Some(now), ..SceneEntity::default() }
}

/// Adds a piece. A mesh that cannot be read is reported, and left out.
fn draw(entity: &mut SceneEntity, piece: &Piece, at: &Frame, color: Color, meshes: &mut Meshes) {
    let color = Some(piece.color.map_or(color, |[r, g, b, a]| Color { r, g, b, a }));
    let pose = Some(pose(at));
    match &piece.solid {
        Solid::Box(edges) => entity.cubes.push(messages::Solid { pose, size: Some(metres(*edges)), color }),
        Solid::Cylinder { radius, length } => entity.cylinders.push(cylinder(pose, *radius, *length, color)),
        Solid::Sphere(radius) => {
            entity.spheres.push(messages::Solid { pose, size: Some(metres([2.0 * radius; 3])), color });
        }
        Solid::Mesh { file, scale: [x, y, z] } => entity.models.extend(meshes.read(file).map(|data| Model {
            pose,
            scale: Some(messages::Vector3 { x: x * METRES, y: y * METRES, z: z * METRES }),
            color,
            override_color: true,
            media_type: "model/stl".to_owned(),
            data,
        })),
    }
}

/// A cylinder with a ball at either end.
fn capsule(limb: &Limb) -> (Vec<messages::Solid>, Vec<Cylinder>) {
    let color = Some(LIMB);
    let size = Some(metres([2.0 * limb.radius; 3]));
    let ball = |[x, y, z]: [f64; 3]| messages::Solid { pose: Some(pose(&Frame::translation(x, y, z))), size, color };
    let [from, to] = limb.ends;
    match straight(limb) {
        None => (vec![ball(from)], Vec::new()),
        Some((middle, length)) => {
            (vec![ball(from), ball(to)], vec![cylinder(Some(pose(&middle)), limb.radius, length, color)])
        }
    }
}

fn cylinder(pose: Option<Pose>, radius: f64, length: f64, color: Option<Color>) -> Cylinder {
    let size = Some(metres([2.0 * radius, 2.0 * radius, length]));
    Cylinder { pose, size, bottom_scale: 1.0, top_scale: 1.0, color }
}

fn metres([x, y, z]: [f64; 3]) -> messages::Vector3 {
    messages::Vector3 { x: x / 1000.0, y: y / 1000.0, z: z / 1000.0 }
}

fn pose(at: &Frame) -> Pose {
    let (position, orientation) = parts(at);
    Pose { position: Some(position), orientation: Some(orientation) }
}
