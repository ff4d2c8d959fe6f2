//! The description of the cell's robots that viewers draw: `cell.urdf`, with the names of the recording's frames and joints.
//!
//! Links are cylinders from joint to joint: no shape of a robot needs a licence.

use std::fmt::Write;

use nalgebra::{UnitQuaternion, Vector3};

use super::links::{Arm, WORLD, placed};

/// How thick a link is, as part of the arm's length.
const THICKNESS: f64 = 0.045;
/// What a joint may do at most where only its range is known; a reader wants numbers.
const EFFORT: f64 = 1000.0;
const VELOCITY: f64 = 10.0;

/// The description of these arms, standing in the world.
pub(super) fn urdf<'a>(arms: impl Iterator<Item = &'a Arm>) -> String {
    let mut out = String::from("<?xml version=\"1.0\"?>\n<robot name=\"cell\">\n");
    let _ = writeln!(out, "  <link name=\"{WORLD}\"/>");
    arms.for_each(|arm| add(&mut out, arm));
    out.push_str("</robot>\n");
    out
}

fn add(out: &mut String, arm: &Arm) {
    let _ = writeln!(out, "  <!-- {} -->", arm.robot.replace("--", "- -"));
    let frames: Vec<_> = arm.links.iter().map(|link| placed(&link.origin)).chain([placed(&arm.flange)]).collect();
    let reach: f64 = frames.iter().map(|frame| frame.translation.vector.norm()).sum();
    let radius = THICKNESS * reach / 1000.0;
    // Each link leads from its own origin to where the next one begins.
    let names = (0..=arm.links.len()).map(|number| if number == 0 { arm.base() } else { arm.link(number) });
    for (name, next) in names.zip(&frames) {
        link(out, &name, &(next.translation.vector / 1000.0), radius);
    }
    link(out, &arm.flange_frame(), &Vector3::zeros(), 0.5 * radius);
    joint(out, &format!("{}_to_{WORLD}", arm.base()), [WORLD, &arm.base()], &nalgebra::Isometry3::identity(), "");
    for (at, (joined, own)) in arm.links.iter().zip(&arm.axes).enumerate() {
        let before = if at == 0 { arm.base() } else { arm.link(at) };
        let [low, high] = own.range;
        let [x, y, z] = joined.axis;
        let moves = format!(
            "<axis xyz=\"{x} {y} {z}\"/><limit lower=\"{low}\" upper=\"{high}\" effort=\"{EFFORT}\" velocity=\"{VELOCITY}\"/>"
        );
        let kind = if own.linear { "prismatic" } else { "revolute" };
        moving(out, kind, &arm.joint(&own.name), [&before, &arm.link(at + 1)], &placed(&joined.origin), &moves);
    }
    let last = arm.link(arm.links.len());
    let flange = arm.flange_frame();
    joint(out, &format!("{flange}_to_{last}"), [&last, &flange], &placed(&arm.flange), "");
}

/// A link from its origin to `end`, in m.
fn link(out: &mut String, name: &str, end: &Vector3<f64>, radius: f64) {
    let length = end.norm();
    let _ = writeln!(out, "  <link name=\"{name}\">");
    let ball = format!("<geometry><sphere radius=\"{:.5}\"/></geometry>", 1.1 * radius);
    let _ = writeln!(out, "    <visual>{ball}</visual>");
    if length > radius {
        let turned = UnitQuaternion::rotation_between(&Vector3::z(), end)
            .unwrap_or_else(|| UnitQuaternion::from_scaled_axis(Vector3::x() * std::f64::consts::PI));
        let origin = origin(&(0.5 * end), &turned);
        let tube = format!("<geometry><cylinder radius=\"{radius:.5}\" length=\"{length:.5}\"/></geometry>");
        let _ = writeln!(out, "    <visual>{origin}{tube}</visual>");
    }
    out.push_str("  </link>\n");
}

fn joint(out: &mut String, name: &str, links: [&str; 2], at: &nalgebra::Isometry3<f64>, moves: &str) {
    moving(out, "fixed", name, links, at, moves);
}

fn moving(
    out: &mut String,
    kind: &str,
    name: &str,
    [parent, child]: [&str; 2],
    at: &nalgebra::Isometry3<f64>,
    moves: &str,
) {
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
