//! The moving joints of a URDF, from the base to the flange.

use super::place::{Place, Vector, length};
use urdf_rs::{Joint, JointType, Robot};

/// A moving joint.
#[derive(Clone, Debug)]
pub(in crate::cli) struct Moving {
    pub(in crate::cli) name: String,
    /// The link that it moves.
    pub(in crate::cli) child: String,
    /// Whether it slides instead of turning.
    pub(super) slides: bool,
    /// From the frame that the joint before moves to its own.
    pub(super) origin: Place,
    /// In its own frame.
    pub(super) axis: Vector,
    /// rad or m, per s.
    pub(super) lower: f64,
    pub(super) upper: f64,
    pub(super) velocity: f64,
}

/// A robot's joints, and the flange seen from the frame that the last one moves.
#[derive(Clone, Debug)]
pub(in crate::cli) struct Chain {
    pub(super) name: String,
    /// The link that is the base.
    pub(in crate::cli) root: String,
    pub(in crate::cli) joints: Vec<Moving>,
    pub(super) flange: Place,
}

/// Links of these names behind the last joint are the flange, the first found goes first.
const FLANGES: [&str; 2] = ["tool0", "flange"];

impl Chain {
    /// The chain of a robot.
    pub(in crate::cli) fn of(robot: &Robot) -> Result<Self, String> {
        let root = root(robot)?;
        let (name, root_name) = (robot.name.clone(), root.to_owned());
        let mut chain = Chain { name, root: root_name, joints: Vec::new(), flange: Place::ORIGIN };
        let (mut link, mut carried) = (root, Place::ORIGIN);
        for _ in &robot.joints {
            let next: Vec<&Joint> = robot.joints.iter().filter(|joint| joint.parent.link == link).collect();
            let leading: Vec<&&Joint> = next.iter().filter(|joint| moves(robot, joint)).collect();
            let joint = match leading.as_slice() {
                [] => break,
                [joint] => joint,
                [one, other, ..] => {
                    return Err(format!(
                        "behind the link `{link}` moving joints go two ways, by `{}` and by `{}`; a robot file has one arm",
                        one.name, other.name
                    ));
                }
            };
            let origin = carried.then(&Place::of_urdf(joint.origin.xyz.0, joint.origin.rpy.0));
            carried = match moving(joint, origin)? {
                Some(moving) => {
                    chain.joints.push(moving);
                    Place::ORIGIN
                }
                None => origin,
            };
            link = &joint.child.link;
        }
        chain.flange = carried.then(&flange(robot, link));
        Ok(chain)
    }

    /// The frames that the joints move, then the flange, in the base, when the joints stand at these positions (rad, m).
    pub(in crate::cli) fn forward(&self, at: &[f64]) -> Vec<Place> {
        let mut place = Place::ORIGIN;
        let mut all = Vec::new();
        for (joint, at) in self.joints.iter().zip(at) {
            let own = if joint.slides {
                Place::shift(joint.axis.map(|component| component * at))
            } else {
                Place::about(joint.axis, *at)
            };
            place = place.then(&joint.origin).then(&own);
            all.push(place);
        }
        all.push(place.then(&self.flange));
        all
    }
}

/// Reads a URDF.
pub(in crate::cli) fn parse(text: &str) -> Result<Robot, String> {
    if text.contains("xacro:") {
        return Err("this is a xacro file; make a URDF of it first: `xacro FILE.xacro > FILE.urdf`".to_owned());
    }
    urdf_rs::read_from_string(text).map_err(|error| format!("this is no URDF: {error}"))
}

/// The link that no joint leads to.
pub(in crate::cli) fn root(robot: &Robot) -> Result<&str, String> {
    let is_child = |link: &str| robot.joints.iter().any(|joint| joint.child.link == link);
    let mut roots = robot.links.iter().filter(|link| !is_child(&link.name));
    let Some(root) = roots.next() else {
        return Err("no link is the base: the joints go round in a circle".to_owned());
    };
    match roots.next() {
        None => Ok(&root.name),
        Some(second) => Err(format!("two links have no joint to them: `{}` and `{}`", root.name, second.name)),
    }
}

/// A link, and those behind it with joints at 0, each with its place. The joints `moving` are not gone over.
pub(in crate::cli) fn fixed_to<'a>(robot: &'a Robot, link: &'a str, moving: &[&str]) -> Vec<(&'a str, Place)> {
    let mut found: Vec<(&str, Place)> = vec![(link, Place::ORIGIN)];
    let mut at = 0;
    while let Some((link, place)) = found.get(at).copied() {
        at += 1;
        for joint in robot.joints.iter().filter(|joint| joint.parent.link == link) {
            let known = found.iter().any(|(known, _)| *known == joint.child.link);
            if !known && !moving.contains(&joint.name.as_str()) {
                let own = Place::of_urdf(joint.origin.xyz.0, joint.origin.rpy.0);
                found.push((&joint.child.link, place.then(&own)));
            }
        }
    }
    found
}

/// Whether a joint, or one behind it, moves.
fn moves(robot: &Robot, joint: &Joint) -> bool {
    let mut links = vec![joint.child.link.as_str()];
    let mut all: Vec<&Joint> = vec![joint];
    // Every joint is looked at once at most, also where a broken file goes round in a circle.
    while let Some(link) = links.pop() {
        for next in robot.joints.iter().filter(|joint| joint.parent.link == link) {
            if !all.iter().any(|known| known.name == next.name) {
                all.push(next);
                links.push(&next.child.link);
            }
        }
    }
    all.iter().any(|joint| joint.joint_type != JointType::Fixed && joint.mimic.is_none())
}

/// The joint, if it moves.
fn moving(joint: &Joint, origin: Place) -> Result<Option<Moving>, String> {
    let name = &joint.name;
    let (slides, around) = match joint.joint_type {
        JointType::Fixed => return Ok(None),
        JointType::Revolute => (false, None),
        JointType::Continuous => (false, Some(std::f64::consts::TAU)),
        JointType::Prismatic => (true, None),
        _ => return Err(format!("the joint `{name}` neither turns about a line nor slides along one")),
    };
    let size = length(joint.axis.xyz.0);
    if size < 1e-9 {
        return Err(format!("the axis of the joint `{name}` has no direction"));
    }
    let (lower, upper) = around.map_or((joint.limit.lower, joint.limit.upper), |turn| (-turn, turn));
    if lower >= upper {
        return Err(format!("the joint `{name}` has no range: `lower` must be below `upper`"));
    }
    if joint.limit.velocity <= 0.0 && around.is_none() {
        return Err(format!("the joint `{name}` has no speed: its limit needs a `velocity` above 0"));
    }
    let velocity = if joint.limit.velocity > 0.0 { joint.limit.velocity } else { std::f64::consts::PI };
    let axis = joint.axis.xyz.0.map(|component| component / size);
    Ok(Some(Moving {
        name: name.clone(),
        child: joint.child.link.clone(),
        slides,
        origin,
        axis,
        lower,
        upper,
        velocity,
    }))
}

/// The flange behind the last moving link: a link of a usual name that is fixed to it, or that link itself.
fn flange(robot: &Robot, link: &str) -> Place {
    let found = fixed_to(robot, link, &[]);
    let named = FLANGES.iter().find_map(|name| found.iter().find(|(link, _)| link.ends_with(name)));
    named.map_or(Place::ORIGIN, |(_, place)| *place)
}
