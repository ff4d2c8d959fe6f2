//! What a viewer draws: limbs of robots, bodies of the cell, each in its frame.

use arl_robot::cell::{Body, Signal, SignalKind, Solid};
use arl_robot::kinematics::Frame;
use arl_robot::regular_file;

use super::super::said::Limb;
use super::super::show;
use super::links::{Arm, WORLD, parts, straight};
use super::messages::{
    self, Color, Cylinder, Io, Model, Pose, SceneEntity, SceneEntityDeletion, SceneUpdate, Timestamp,
};

/// Robots, what stands, and what they carry.
const LIMB: Color = Color { r: 0.95, g: 0.55, b: 0.15, a: 1.0 };
const STANDS: Color = Color { r: 0.55, g: 0.6, b: 0.65, a: 1.0 };
const CARRIED: Color = Color { r: 0.25, g: 0.55, b: 0.85, a: 1.0 };
/// A mesh is in mm.
const MODEL_SCALE: messages::Vector3 = messages::Vector3 { x: 0.001, y: 0.001, z: 0.001 };

/// The bodies of a cell, and which of them are there.
pub(super) struct Scene {
    bodies: Vec<(Body, bool)>,
}

impl Scene {
    pub(super) fn new(bodies: &[Body]) -> Self {
        Self { bodies: bodies.iter().map(|body| (body.clone(), false)).collect() }
    }

    /// Bodies that are there from now on, and those that are not any more, by the levels of inputs and outputs.
    pub(super) fn bodies(&mut self, io: &Io, arms: &[Option<Arm>], now: Timestamp) -> Option<SceneUpdate> {
        let mut update = SceneUpdate::default();
        for (body, shown) in &mut self.bodies {
            let there = body.when.is_none_or(|(signal, wanted)| level(io, signal) == wanted);
            if std::mem::replace(shown, there) == there {
                continue;
            }
            let id = format!("body/{}", body.name);
            if there {
                let holder = body.carried_by.and_then(|channel| arms.get(channel as usize - 1)?.as_ref());
                let frame_id = holder.map_or_else(|| WORLD.to_owned(), Arm::flange_frame);
                let color = if holder.is_some() { CARRIED } else { STANDS };
                update.entities.push(SceneEntity { id, frame_id, frame_locked: true, ..drawn(body, color, now) });
            } else {
                update.deletions.push(SceneEntityDeletion { timestamp: Some(now), id });
            }
        }
        (!update.entities.is_empty() || !update.deletions.is_empty()).then_some(update)
    }
}

/// The limbs of all robots.
pub(super) fn robots(arms: &[Option<Arm>]) -> SceneUpdate {
    let of_arm = |arm: &Arm| {
        let limb = |limb: &Limb| {
            let frame_id = if limb.link == 0 { arm.base() } else { arm.link(limb.link) };
            let id = arm.joint(&limb.name);
            let (spheres, cylinders) = capsule(limb);
            SceneEntity { frame_id, id, frame_locked: true, spheres, cylinders, ..timed(Timestamp::default()) }
        };
        arm.limbs.iter().map(limb).collect::<Vec<_>>()
    };
    SceneUpdate { deletions: Vec::new(), entities: arms.iter().flatten().flat_map(of_arm).collect() }
}

fn timed(now: Timestamp) -> SceneEntity {
    SceneEntity { timestamp: Some(now), ..SceneEntity::default() }
}

fn level(io: &Io, signal: Signal) -> bool {
    let levels = if signal.kind == SignalKind::DigitalInput { &io.di } else { &io.r#do };
    levels.get(signal.channel as usize - 1) == Some(&true)
}

/// The form of a body.
fn drawn(body: &Body, color: Color, now: Timestamp) -> SceneEntity {
    let (pose, color) = (Some(pose(&body.at)), Some(color));
    let mut entity = timed(now);
    match &body.solid {
        Solid::Box(edges) => {
            entity.cubes.push(messages::Solid { pose, size: Some(metres(*edges)), color });
        }
        Solid::Cylinder { radius, length } => {
            entity.cylinders.push(cylinder(pose, (*radius, *length), color));
        }
        Solid::Mesh(file) => match regular_file::read(file) {
            Ok(data) => entity.models.push(Model {
                pose,
                scale: Some(MODEL_SCALE),
                color,
                override_color: true,
                media_type: "model/stl".to_owned(),
                data,
            }),
            Err(error) => show::warning(&format!("body `{}` is not drawn: {}: {error}", body.name, file.display())),
        },
    }
    entity
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
            (vec![ball(from), ball(to)], vec![cylinder(Some(pose(&middle)), (limb.radius, length), color)])
        }
    }
}

fn cylinder(pose: Option<Pose>, (radius, length): (f64, f64), color: Option<Color>) -> Cylinder {
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
