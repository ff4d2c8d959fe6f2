//! The moving joints of a URDF, from the base to the flange.

use super::place::{Transform, Vector, length};
use super::tree::Tree;
use super::vet::vet;
use urdf_rs::{Joint, JointType, Robot};

/// A moving joint.
#[derive(Clone, Debug)]
pub struct Moving {
    pub name: String,
    /// The link that it moves.
    pub child: String,
    /// Whether it slides instead of turning.
    pub(super) slides: bool,
    /// From the frame that the previous joint moves to its own.
    pub(super) origin: Transform,
    /// In its own frame.
    pub(super) axis: Vector,
    /// rad or m, per s.
    pub(super) lower: f64,
    pub(super) upper: f64,
    pub(super) velocity: f64,
}

/// A robot's joints, and the flange seen from the frame that the last joint moves.
#[derive(Clone, Debug)]
pub struct Chain {
    pub(super) name: String,
    /// Its joints, from the base on.
    pub joints: Vec<Moving>,
    pub(super) flange: Transform,
}

/// Links with these names after the last joint are the flange; the first name that is found counts.
const FLANGES: [&str; 2] = ["tool0", "flange"];

impl Chain {
    /// The chain of a robot.
    ///
    /// # Errors
    /// Its moving joints are not a chain, or have no range.
    pub fn of(tree: &Tree<'_>) -> Result<Self, String> {
        let robot = tree.robot();
        let mut chain = Chain { name: robot.name.clone(), joints: Vec::new(), flange: Transform::ORIGIN };
        let (mut link, mut carried) = (tree.root(), Transform::ORIGIN);
        for _ in &robot.joints {
            let joint = match tree.moving_behind(link).as_slice() {
                [] => break,
                [joint] => *joint,
                [one, other, ..] => {
                    return Err(format!(
                        "after the link `{link}` the moving joints branch into `{}` and `{}`; a robot file has one arm",
                        one.name, other.name
                    ));
                }
            };
            let origin = carried.then(&Transform::of_urdf(joint.origin.xyz.0, joint.origin.rpy.0));
            carried = match moving(joint, origin)? {
                Some(moving) => {
                    chain.joints.push(moving);
                    Transform::ORIGIN
                }
                None => origin,
            };
            link = &joint.child.link;
        }
        chain.flange = carried.then(&flange(tree, link));
        Ok(chain)
    }

    /// The frames that the joints move, then the flange, in the base, when the joints are at these positions (rad, m).
    pub fn forward(&self, at: &[f64]) -> Vec<Transform> {
        let mut place = Transform::ORIGIN;
        let mut all = Vec::new();
        for (joint, at) in self.joints.iter().zip(at) {
            let own = if joint.slides {
                Transform::shift(joint.axis.map(|component| component * at))
            } else {
                Transform::about(joint.axis, *at)
            };
            place = place.then(&joint.origin).then(&own);
            all.push(place);
        }
        all.push(place.then(&self.flange));
        all
    }
}

/// Reads a URDF.
///
/// # Errors
/// The text is not a URDF, or has a number that no robot can have.
pub fn parse(text: &str) -> Result<Robot, String> {
    if text.contains("xacro:") {
        return Err("this is a xacro file; make a URDF from it first: `xacro FILE.xacro > FILE.urdf`".to_owned());
    }
    vet(text)?;
    urdf_rs::read_from_string(text).map_err(|error| format!("this is not URDF: {error}"))
}

/// The joint, if it moves.
fn moving(joint: &Joint, origin: Transform) -> Result<Option<Moving>, String> {
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
    // In a later version of the format, a missing limit means infinity.
    if !(lower < upper && lower.is_finite() && upper.is_finite()) {
        return Err(format!("the joint `{name}` has no range: its limit needs a finite `lower` below its `upper`"));
    }
    let velocity = Some(joint.limit.velocity).filter(|velocity| *velocity > 0.0 && velocity.is_finite());
    let Some(velocity) = velocity.or(around.map(|_| std::f64::consts::PI)) else {
        return Err(format!("the joint `{name}` has no speed: its limit needs a `velocity` above 0"));
    };
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

/// The flange after the last moving link: a link with a usual name that is fixed to it, or that link itself.
fn flange(tree: &Tree<'_>, link: &str) -> Transform {
    let Some(link) = tree.link(link) else { return Transform::ORIGIN };
    let found = tree.fixed_to(&link.name, &[]);
    let named = FLANGES.iter().find_map(|name| found.iter().find(|(link, _)| link.ends_with(name)));
    named.map_or(Transform::ORIGIN, |(_, place)| *place)
}
