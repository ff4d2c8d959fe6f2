//! The description of the cell that viewers draw: `cell.urdf`, with the names of the recording's frames and joints.
//!
//! Robots and bodies look as in the recording; of parts that follow others only the first one is there.

use std::fmt::Write;

use arl_robot::cell::{Body, Solid};
use arl_robot::kinematics::Frame;
use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use percent_encoding::{AsciiSet, CONTROLS, utf8_percent_encode};

use super::links::{Carried, Own, RecordedArm, WORLD, straight};
use super::scene::frame_of;
use crate::scenery::{Looks, Piece, Scenery, Shape};
use arl_wire::{Limb, placed};

/// The characters of a path that an address has to escape.
const IN_ADDRESS: &AsciiSet = &CONTROLS.add(b' ').add(b'#').add(b'%').add(b'?');
/// The limits of a joint of which only the range is known; readers require numbers.
const EFFORT: f64 = 1000.0;
const VELOCITY: f64 = 10.0;

/// The first lines of each description.
const HEAD: &str = "<?xml version=\"1.0\"?>\n<!-- Written by arl2rs, for the recording beside it. -->\n";

/// Whether a file is a description that a recording wrote, or began to.
pub(super) fn is_written_here(text: &[u8]) -> bool {
    // Those of 0.1 had no comment.
    let without = format!("<?xml version=\"1.0\"?>\n<robot name=\"cell\">\n  <link name=\"{WORLD}\"/>\n");
    text.is_empty() || text.starts_with(HEAD.as_bytes()) || text.starts_with(without.as_bytes())
}

/// The description of these arms, by channels, and of what is around them.
pub(super) fn urdf(arms: &[Option<RecordedArm>], scenery: &Scenery) -> String {
    let mut out = format!("{HEAD}<robot name=\"cell\">\n");
    let _ = writeln!(out, "  <link name=\"{WORLD}\"/>");
    for (channel, arm) in arms.iter().enumerate() {
        if let Some(arm) = arm {
            add_arm(&mut out, arm, scenery.shape(channel));
        }
    }
    for (body, looks) in scenery.bodies.iter().filter(|(body, _)| body.grip.is_none_or(|grip| !grip.follows)) {
        add_body(&mut out, body, looks, &frame_of(body.holder, arms, scenery));
    }
    out.push_str("</robot>\n");
    out
}

fn add_arm(out: &mut String, arm: &RecordedArm, shape: Option<&Shape>) {
    let _ = writeln!(out, "  <!-- {} -->", escaped(&arm.robot).replace("--", "- -"));
    for number in 0..=arm.links.len() {
        let name = if number == 0 { arm.base() } else { arm.link(number) };
        let tubes = || arm.limbs.iter().filter(|limb| limb.link == number).map(tube).collect();
        let looks = shape.and_then(|shape| shape.links().find(|(link, _)| *link == number));
        let limbs: String = looks.map_or_else(tubes, |(_, looks)| looks.seen.iter().map(visual).collect());
        let _ = writeln!(out, "  <link name=\"{name}\">{limbs}</link>");
    }
    let _ = writeln!(out, "  <link name=\"{}\"/>", arm.flange_frame());
    let base = arm.base();
    joint(out, "fixed", &format!("{base}_to_{WORLD}"), [WORLD, &base], &arm.stands, "");
    for (at, (joined, own)) in arm.links.iter().zip(&arm.axes).enumerate() {
        let before = if at == 0 { arm.base() } else { arm.link(at) };
        let place = placed(&joined.origin);
        let moves = moves(own, joined.axis);
        joint(out, kind(own), &arm.joint(&own.name), [&before, &arm.link(at + 1)], &place, &moves);
    }
    for Carried { frame, parent, joint: moved, axis } in &arm.carriers {
        let Some(own) = arm.axes.get(*axis) else { continue };
        let _ = writeln!(out, "  <link name=\"{frame}\"/>");
        joint(
            out,
            kind(own),
            &arm.joint(&own.name),
            [parent, frame],
            &moved.origin,
            &moves(own, moved.axis.into_inner().into()),
        );
    }
    let (last, flange) = (arm.link(arm.links.len()), arm.flange_frame());
    joint(out, "fixed", &format!("{flange}_to_{last}"), [&last, &flange], &placed(&arm.flange), "");
}

/// What a joint moves along or about, and its range.
fn moves(own: &Own, [x, y, z]: [f64; 3]) -> String {
    let [low, high] = own.range;
    format!(
        "<axis xyz=\"{x} {y} {z}\"/><limit lower=\"{low}\" upper=\"{high}\" effort=\"{EFFORT}\" velocity=\"{VELOCITY}\"/>"
    )
}

fn kind(own: &Own) -> &'static str {
    if own.linear { "prismatic" } else { "revolute" }
}

fn add_body(out: &mut String, body: &Body, looks: &Looks, holder: &str) {
    // No frame of a robot has such a name.
    let name = format!("body/{}", escaped(&body.name));
    let forms: String = looks.seen.iter().map(visual).collect();
    let _ = writeln!(out, "  <link name=\"{name}\">{forms}</link>");
    joint(out, "fixed", &format!("{name}_to_{holder}"), [holder, &name], &body.at, "");
}

fn visual(piece: &Piece) -> String {
    let form = match &piece.solid {
        Solid::Box([x, y, z]) => format!("<box size=\"{} {} {}\"/>", x / 1000.0, y / 1000.0, z / 1000.0),
        Solid::Cylinder { radius, length } => cylinder(radius / 1000.0, length / 1000.0),
        Solid::Sphere(radius) => format!("<sphere radius=\"{}\"/>", radius / 1000.0),
        Solid::Mesh { file, scale: [x, y, z] } => {
            let file = std::path::absolute(file).unwrap_or_else(|_| file.clone());
            let address = escaped(&utf8_percent_encode(&file.display().to_string(), IN_ADDRESS).to_string());
            let scale = format!("{} {} {}", x / 1000.0, y / 1000.0, z / 1000.0);
            format!("<mesh filename=\"file://{address}\" scale=\"{scale}\"/>")
        }
    };
    let origin = if piece.at == Frame::identity() {
        String::new()
    } else {
        origin(&(piece.at.translation.vector / 1000.0), &piece.at.rotation)
    };
    let paint = piece.color.map_or_else(String::new, |[r, g, b, a]| {
        format!("<material name=\"{r}_{g}_{b}_{a}\"><color rgba=\"{r} {g} {b} {a}\"/></material>")
    });
    format!("<visual>{origin}<geometry>{form}</geometry>{paint}</visual>")
}

/// A capsule: a cylinder with a ball at either end.
fn tube(limb: &Limb) -> String {
    let radius = limb.radius / 1000.0;
    let ball = |at: [f64; 3]| {
        let origin = origin(&(Vector3::from(at) / 1000.0), &UnitQuaternion::identity());
        format!("<visual>{origin}<geometry><sphere radius=\"{radius:.5}\"/></geometry></visual>")
    };
    let straight = straight(limb).map_or_else(String::new, |(middle, length)| {
        let middle = origin(&(middle.translation.vector / 1000.0), &middle.rotation);
        format!("<visual>{middle}<geometry>{}</geometry></visual>", cylinder(radius, length / 1000.0))
    });
    let [from, to] = limb.ends;
    format!("{}{}{straight}", ball(from), ball(to))
}

fn cylinder(radius: f64, length: f64) -> String {
    format!("<cylinder radius=\"{radius:.5}\" length=\"{length:.5}\"/>")
}

fn joint(out: &mut String, kind: &str, name: &str, [parent, child]: [&str; 2], at: &Isometry3<f64>, moves: &str) {
    let origin = origin(&(at.translation.vector / 1000.0), &at.rotation);
    let _ = writeln!(
        out,
        "  <joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>{origin}{moves}</joint>"
    );
}

/// Where something is, in m and rad.
fn origin(at: &Vector3<f64>, turned: &UnitQuaternion<f64>) -> String {
    let (roll, pitch, yaw) = turned.euler_angles();
    format!("<origin xyz=\"{:.6} {:.6} {:.6}\" rpy=\"{:.9} {:.9} {:.9}\"/>", at.x, at.y, at.z, roll, pitch, yaw)
}

/// Escapes the characters that XML does not take as they are.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
