//! The links of a robot as a chain of joints: for pictures, shapes and robot descriptions.
//!
//! Six axes: at zero of all inner angles (see [`Opw`]) every link's frame is oriented like the base; link 1 has its
//! origin on axis 1 at the height of axis 2, link 2 on axis 2 in the arm's plane, link 3 on axis 3, links 4 to 6 in the
//! wrist centre. SCARA: x points along the arm; link 1 has its origin on axis 1 at the height of the base, link 2 on
//! axis 2 at that height, links 3 and 4 in the flange.

use nalgebra::{Translation3, Unit, UnitQuaternion, Vector3};

use super::{Frame, Kinematics};

/// The joint that moves a link relative to the previous one, or the first link relative to the base.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct LinkJoint {
    /// The link's frame in that of the previous link while the axis is at 0, translation in mm.
    pub origin: Frame,
    /// The axis about which it turns, or along which it moves, in the link's frame.
    pub axis: Unit<Vector3<f64>>,
    /// Whether the joint moves along its axis.
    pub linear: bool,
}

impl LinkJoint {
    /// The link's frame in that of the previous link at `value` deg (mm) of the axis.
    pub fn at(&self, value: f64) -> Frame {
        let moved = if self.linear {
            Frame::from_parts(Translation3::from(self.axis.into_inner() * value), UnitQuaternion::identity())
        } else {
            Frame::rotation(self.axis.into_inner() * value.to_radians())
        };
        self.origin * moved
    }

    fn turning(at: [f64; 3], axis: Vector3<f64>, offset: f64, sign: f64) -> Self {
        let [x, y, z] = at;
        let turned = UnitQuaternion::from_scaled_axis(axis * -offset.to_radians());
        let origin = Frame::from_parts(Translation3::new(x, y, z), turned);
        Self { origin, axis: Unit::new_unchecked(axis * sign), linear: false }
    }

    fn moving(at: [f64; 3], axis: Vector3<f64>) -> Self {
        Self { linear: true, ..Self::turning(at, axis, 0.0, 1.0) }
    }
}

impl Kinematics {
    /// The joints of the axes, from the base on, and the flange's frame in that of the last link, translation in mm.
    ///
    /// ```
    /// # #[cfg(feature = "files")] {
    /// use arl_robot::kinematics::Frame;
    /// use arl_robot::robot::Robot;
    ///
    /// let robot = Robot::load("kr10-r1420")?;
    /// let axes = [10.0, -90.0, 80.0, 20.0, 30.0, -40.0];
    /// let (joints, flange) = robot.kinematics.links();
    /// let links = joints.iter().zip(axes).map(|(joint, axis)| joint.at(axis));
    /// let last = links.fold(Frame::identity(), |before, link| before * link);
    /// let away = (last * flange).translation.vector - robot.kinematics.forward(&axes).translation.vector;
    /// assert!(away.norm() < 1e-9);
    /// # }
    /// # Ok::<(), arl_robot::robot::RobotError>(())
    /// ```
    pub fn links(&self) -> (Vec<LinkJoint>, Frame) {
        let [y, z] = [Vector3::y(), Vector3::z()];
        match self {
            Self::SixAxis(opw) => {
                let parameters = opw.parameters();
                let chain = [
                    ([0.0, 0.0, parameters.c1], z),
                    ([parameters.a1, parameters.b, 0.0], y),
                    ([0.0, 0.0, parameters.c2], y),
                    ([parameters.a2, 0.0, parameters.c3], z),
                    ([0.0; 3], y),
                    ([0.0; 3], z),
                ];
                let own = parameters.offsets.iter().zip(&parameters.signs);
                let joints = chain
                    .into_iter()
                    .zip(own)
                    .map(|((at, axis), (offset, sign))| LinkJoint::turning(at, axis, *offset, *sign));
                (joints.collect(), Frame::translation(0.0, 0.0, parameters.c4))
            }
            Self::Scara(scara) => {
                let joints = vec![
                    LinkJoint::turning([0.0; 3], z, 0.0, 1.0),
                    LinkJoint::turning([scara.l1, 0.0, 0.0], z, 0.0, 1.0),
                    LinkJoint::moving([scara.l2, 0.0, scara.z0], z),
                    LinkJoint::turning([0.0; 3], z, 0.0, 1.0),
                ];
                (joints, Frame::identity())
            }
        }
    }
}

#[cfg(test)]
#[cfg(feature = "files")]
mod tests {
    use super::Frame;
    use crate::kinematics::random::Random;
    use crate::robot::Robot;

    #[test]
    fn the_last_link_leads_to_the_flange() {
        let mut random = Random::new(7);
        for name in Robot::builtin_names() {
            let robot = Robot::load(name).unwrap();
            for _ in 0..50 {
                let mut axes = [0.0; 6];
                for (value, axis) in axes.iter_mut().zip(robot.own_axes()) {
                    *value = random.between(axis.min, axis.max);
                }
                let (joints, flange) = robot.kinematics.links();
                let links = joints.iter().zip(axes).map(|(joint, axis)| joint.at(axis));
                let found = links.fold(Frame::identity(), |before, link| before * link) * flange;
                let expected = robot.kinematics.forward(&axes);
                assert!((found.translation.vector - expected.translation.vector).norm() < 1e-9, "{name}");
                assert!(found.rotation.angle_to(&expected.rotation) < 1e-9, "{name}");
            }
        }
    }
}
