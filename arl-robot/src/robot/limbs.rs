//! The default shape of a robot: capsules along its links, as thick as those of robots of its size.

use nalgebra::Vector3;

use super::Robot;
use crate::kinematics::Kinematics;

/// Radii of column, upper arm, forearm and hand, as parts of the length of the arm.
const COLUMN: f64 = 0.07;
const UPPER_ARM: f64 = 0.05;
const FOREARM: f64 = 0.045;
const HAND: f64 = 0.03;
/// The distance of a SCARA's arms above the highest position of its flange, as part of the stroke.
const ABOVE_STROKE: f64 = 0.25;

/// All names of limbs: those of six-axis robots, then those that only SCARA robots have.
pub const LIMB_NAMES: [&str; 9] = [
    "the base",
    "the shoulder",
    "the upper arm",
    "the elbow",
    "the forearm",
    "the hand",
    "arm 1",
    "arm 2",
    "the spindle",
];

/// A capsule that belongs to a link: all points no farther than `radius` from the straight line between its ends.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Limb {
    /// The name for people: `the forearm`.
    pub name: &'static str,
    /// The link, from 1; 0 is the base.
    pub link: usize,
    /// Its ends in the link's frame (see [`Kinematics::links`]), in mm.
    pub ends: [[f64; 3]; 2],
    /// Its radius in mm.
    pub radius: f64,
}

impl Robot {
    /// The limbs of the robot, from the base to the flange, beyond which the last one does not extend. Adjacent limbs
    /// overlap.
    pub fn limbs(&self) -> Vec<Limb> {
        let limb = |name, link: usize, from: [f64; 3], to: [f64; 3], radius: f64| Limb {
            name,
            link,
            ends: [from, to],
            radius,
        };
        match &self.kinematics {
            Kinematics::SixAxis(opw) => {
                let p = opw.parameters();
                let reach = length([p.a1, p.b, 0.0]) + p.c2.abs() + length([p.a2, 0.0, p.c3]) + p.c4.abs();
                let elbow = [p.a2, 0.0, 0.0];
                vec![
                    limb("the base", 0, [0.0; 3], [0.0, 0.0, p.c1], COLUMN * reach),
                    limb("the shoulder", 1, [0.0; 3], [p.a1, p.b, 0.0], COLUMN * reach),
                    limb("the upper arm", 2, [0.0; 3], [0.0, 0.0, p.c2], UPPER_ARM * reach),
                    limb("the elbow", 3, [0.0; 3], elbow, UPPER_ARM * reach),
                    limb("the forearm", 3, elbow, [p.a2, 0.0, p.c3], FOREARM * reach),
                    limb("the hand", 6, [0.0; 3], [0.0, 0.0, (p.c4 - HAND * reach).max(0.0)], HAND * reach),
                ]
            }
            Kinematics::Scara(scara) => {
                let reach = scara.l1 + scara.l2;
                let [low, high] = self.axes.get(2).map_or([0.0; 2], |lift| [lift.min, lift.max]);
                let stroke = (high - low).max(0.0);
                let arms = scara.z0 + high + ABOVE_STROKE * stroke;
                let spindle = arms - scara.z0 - low;
                vec![
                    limb("the base", 0, [0.0; 3], [0.0, 0.0, arms], COLUMN * reach),
                    limb("arm 1", 1, [0.0, 0.0, arms], [scara.l1, 0.0, arms], COLUMN * reach),
                    limb("arm 2", 2, [0.0, 0.0, arms], [scara.l2, 0.0, arms], COLUMN * reach),
                    limb("the spindle", 3, [0.0, 0.0, spindle], [0.0, 0.0, HAND * reach], HAND * reach),
                ]
            }
        }
    }
}

fn length(ends: [f64; 3]) -> f64 {
    Vector3::from(ends).norm()
}

#[cfg(test)]
#[cfg(feature = "files")]
mod tests {
    use super::*;

    #[test]
    fn every_limb_has_one_of_the_names() {
        for name in Robot::builtin_names() {
            let robot = Robot::builtin(name).unwrap();
            assert!(robot.limbs().iter().all(|limb| LIMB_NAMES.contains(&limb.name)), "{name}");
        }
    }
}
