//! How far a pose of the flange is beyond the length of an arm, whatever the configuration and the ranges of the axes.
//!
//! It is the one piece of kinematics that the checker has: the border of what can be reached, which needs no solution.

use crate::Arm;

impl Arm {
    /// How far, in mm, the pose x, y, z (mm), a, b, c (deg) of the flange in the robot's base is beyond what the arm can reach;
    /// 0 where its length is not what hinders.
    pub(crate) fn beyond(&self, [x, y, z, a, b, c]: [f64; 6]) -> f64 {
        match *self {
            Arm::Scara { l1, l2 } => {
                let distance = x.hypot(y);
                (distance - (l1 + l2)).max((l1 - l2).abs() - distance).max(0.0)
            }
            Arm::SixAxis { a1, a2, b: aside, c1, c2, c3, c4 } => {
                // The centre of the wrist lies on the flange's z axis, c4 behind it.
                let [(sa, ca), (sb, cb), (sc, cc)] = [a, b, c].map(|angle| angle.to_radians().sin_cos());
                let [x, y, z] =
                    [x - c4 * (ca * sb * cc + sa * sc), y - c4 * (sa * sb * cc - ca * sc), z - c4 * cb * cc];
                let across = x.hypot(y);
                if across < aside.abs() {
                    return aside.abs() - across;
                }
                let depth = (across * across - aside * aside).sqrt();
                let forearm = a2.hypot(c3);
                // Facing it, or bent over backwards.
                let miss = |depth: f64| {
                    let distance = (depth - a1).hypot(z - c1);
                    (distance - (c2 + forearm)).max((c2 - forearm).abs() - distance).max(0.0)
                };
                miss(depth).min(miss(-depth))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arms_reach_as_far_as_they_are_long() {
        let arm = Arm::SixAxis { a1: 150.0, a2: -20.0, b: 0.0, c1: 450.0, c2: 610.0, c3: 660.0, c4: 80.0 };
        let reach = 150.0 + 610.0 + 20.0_f64.hypot(660.0) + 80.0;
        // Stretched to the front, the flange's z along the arm.
        let front = |x: f64| [x, 0.0, 450.0, 0.0, 90.0, 0.0];
        assert_eq!(arm.beyond(front(reach - 0.001)), 0.0);
        assert!((arm.beyond(front(reach + 5.0)) - 5.0).abs() < 1e-9);
        // The same with the flange looking down: the wrist is c4 above and has less to bridge.
        assert!(arm.beyond([reach - 50.0, 0.0, 370.0, 0.0, 180.0, 0.0]) < 31.0);
        assert_eq!(arm.beyond([900.0, -200.0, 500.0, 30.0, 0.0, 180.0]), 0.0);
        // Too near to the shoulder for the shorter of two unequal arms.
        let folded = Arm::SixAxis { a1: 0.0, a2: 0.0, b: 0.0, c1: 0.0, c2: 600.0, c3: 400.0, c4: 0.0 };
        assert!((folded.beyond([150.0, 0.0, 0.0, 0.0, 0.0, 0.0]) - 50.0).abs() < 1e-9);
        let scara = Arm::Scara { l1: 375.0, l2: 275.0 };
        assert_eq!(scara.beyond([300.0, 400.0, 10.0, 0.0, 0.0, 0.0]), 0.0);
        assert!((scara.beyond([600.0, 800.0, 10.0, 0.0, 0.0, 0.0]) - 350.0).abs() < 1e-9);
        assert!((scara.beyond([30.0, 40.0, 10.0, 0.0, 0.0, 0.0]) - 50.0).abs() < 1e-9);
    }
}
