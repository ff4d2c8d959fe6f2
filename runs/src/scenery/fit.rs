//! Which link of a robot each link of its URDF is.

use arl_robot::kinematics::Frame;
use arl_robot::robot::Robot;

use super::description::frame;
use crate::urdf::Chain;

/// At this many positions it is checked whether links move with each other; they may differ by this much, in mm and
/// rad.
const POSITIONS: u32 = 24;
const SLACK_MM: f64 = 1.0;
const SLACK_RAD: f64 = 0.003;
/// Fractions of multiples of this are spread evenly.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// For the base of the URDF and each link that its joints move: the link of the robot (0 is the base) that moves with
/// it, and its place in that link; `None` if there is no such link.
///
/// # Errors
/// The flanges of the two are at different places.
pub(super) fn fit(chain: &Chain, robot: &Robot, order: &[usize]) -> Result<Vec<Option<(usize, Frame)>>, String> {
    let mut samples: Vec<[Vec<Frame>; 2]> = Vec::new();
    for number in 1..=POSITIONS {
        let part = |axis: usize| (f64::from(number) * GOLDEN * (axis as f64 + 1.0)).fract();
        let axes = robot.own_axes().iter().enumerate();
        let values: Vec<f64> = axes.map(|(at, axis)| axis.min + part(at) * (axis.max - axis.min)).collect();
        let (links, flange) = of_robot(robot, &values);
        let (of_chain, its_flange) = of_chain(chain, robot, order, &values);
        let off = (flange.translation.vector - its_flange.translation.vector).norm();
        if off > SLACK_MM {
            return Err(format!(
                "its flange is {off:.1} mm from that of {} at {values:.1?}; {}",
                robot.name,
                made_of(robot)
            ));
        }
        samples.push([links, of_chain]);
    }
    let count = robot.own_axes().len();
    let found = |of: usize| {
        // First the link that is as many links from the base.
        let all = std::iter::once(of).chain((0..=count).filter(|link| *link != of));
        all.into_iter().find_map(|link| Some((link, moved_with(&samples, link, of)?)))
    };
    Ok((0..=chain.joints.len()).map(found).collect())
}

/// What would be right.
pub(super) fn made_of(robot: &Robot) -> String {
    let axes = robot.own_axes().len();
    format!("a URDF with {axes} joints fits the robot file that `arl2rs robots --import` makes from it")
}

/// Where a link of the URDF is in a link of the robot, if that is the same at all positions.
fn moved_with(samples: &[[Vec<Frame>; 2]], link: usize, of: usize) -> Option<Frame> {
    let mut all = samples.iter().map(|[links, of_chain]| Some(links.get(link)?.inverse() * of_chain.get(of)?));
    let first = all.next()??;
    let same = |there: Option<Frame>| {
        there.is_some_and(|there| {
            let off = (there.translation.vector - first.translation.vector).norm();
            off <= SLACK_MM && there.rotation.angle_to(&first.rotation) <= SLACK_RAD
        })
    };
    all.all(same).then_some(first)
}

/// The base and the links of the robot, and its flange, while its axes have these values, in deg and mm.
fn of_robot(robot: &Robot, values: &[f64]) -> (Vec<Frame>, Frame) {
    let (joints, flange) = robot.kinematics.links();
    let mut links = vec![Frame::identity()];
    let mut place = Frame::identity();
    for (joint, value) in joints.iter().zip(values) {
        place *= joint.at(*value);
        links.push(place);
    }
    (links, place * flange)
}

/// The same for the URDF; `order` gives the joint of each axis.
fn of_chain(chain: &Chain, robot: &Robot, order: &[usize], values: &[f64]) -> (Vec<Frame>, Frame) {
    let mut at = vec![0.0; chain.joints.len()];
    for ((joint, axis), value) in order.iter().zip(robot.own_axes()).zip(values) {
        if let Some(place) = at.get_mut(*joint) {
            *place = if axis.linear { value / 1000.0 } else { value.to_radians() };
        }
    }
    let mut all = chain.forward(&at);
    let flange = all.pop().map_or_else(Frame::identity, |flange| frame(&flange));
    (std::iter::once(Frame::identity()).chain(all.iter().map(frame)).collect(), flange)
}
