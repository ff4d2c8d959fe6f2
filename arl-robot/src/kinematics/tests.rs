//! Kinematics in closed form compared with products of transforms, forward and inverse.

use nalgebra::{Matrix4, Rotation3, Translation3, UnitQuaternion, Vector3};

use super::*;
use crate::kinematics::random::Random;
use crate::robot::{Axis, Robot};

const SCARAS: [&str; 2] = ["hsr065", "cobra600"];
const ROBOTS: [&str; 5] = ["kr10-r1420", "kr6-r700", "irb2400-10", "tx2-60", "six-10"];

fn opw(robot: &Robot) -> &Opw {
    match &robot.kinematics {
        Kinematics::SixAxis(opw) => opw,
        Kinematics::Scara(_) => panic!("{} is not a six-axis robot", robot.name),
    }
}

fn random_axes(robot: &Robot, random: &mut Random) -> Axes {
    let mut axes = [0.0; 6];
    for (value, axis) in axes.iter_mut().zip(&robot.axes) {
        *value = random.between(axis.min, axis.max);
    }
    axes
}

/// Forward kinematics as a plain product of matrices, one for each step along the arm.
fn chain(p: &OpwParameters, axes: &Axes) -> Matrix4<f64> {
    let angle = |i: usize| (axes[i] * p.signs[i] - p.offsets[i]).to_radians();
    let y = |i| Rotation3::from_axis_angle(&Vector3::y_axis(), angle(i)).to_homogeneous();
    let z = |i| Rotation3::from_axis_angle(&Vector3::z_axis(), angle(i)).to_homogeneous();
    let step = |x, y, z| Translation3::new(x, y, z).to_homogeneous();
    z(0) * step(p.a1, p.b, p.c1)
        * y(1)
        * step(0.0, 0.0, p.c2)
        * y(2)
        * step(p.a2, 0.0, p.c3)
        * z(3)
        * y(4)
        * z(5)
        * step(0.0, 0.0, p.c4)
}

fn distance(a: &Frame, b: &Frame) -> (f64, f64) {
    ((a.translation.vector - b.translation.vector).norm(), (a.rotation.inverse() * b.rotation).angle())
}

#[test]
fn forward_equals_a_plain_chain_of_matrices() {
    let mut random = Random::new(1);
    for name in ROBOTS {
        let robot = Robot::builtin(name).unwrap();
        for _ in 0..2000 {
            let axes = random_axes(&robot, &mut random);
            let found = robot.kinematics.forward(&axes).to_homogeneous();
            let expected = chain(opw(&robot).parameters(), &axes);
            assert!((found - expected).amax() < 1e-9, "{name} {axes:?}: {found}{expected}");
        }
    }
}

#[test]
fn known_poses_of_the_default_robot() {
    let robot = Robot::builtin("kr10-r1420").unwrap();
    let near = |axes: Axes, expected: [f64; 6]| {
        let found = frame_components(&robot.kinematics.forward(&axes));
        for (a, b) in found.iter().zip(expected) {
            assert!((a - b).abs() < 1e-9, "{axes:?}: {found:?}");
        }
    };
    // Upper arm up, forearm forwards: 150 + 660 + 80 forwards, 450 + 610 + 20 high.
    near([0.0, -90.0, 90.0, 0.0, 0.0, 0.0], [890.0, 0.0, 1080.0, 0.0, 90.0, 0.0]);
    // Axis 1 turns in the negative sense about z, the hand points down.
    near([90.0, -90.0, 90.0, 0.0, 90.0, 0.0], [0.0, -810.0, 1000.0, 90.0, 0.0, 180.0]);
}

#[test]
fn hundred_thousand_poses_have_all_their_solutions() {
    let mut random = Random::new(2);
    let (mut worst, mut worst_angle) = (0.0_f64, 0.0_f64);
    for name in ROBOTS {
        let robot = Robot::builtin(name).unwrap();
        let opw = opw(&robot);
        for _ in 0..20_000 {
            let axes = random_axes(&robot, &mut random);
            let pose = opw.forward(&axes);
            let solutions = opw.solutions(&pose, &[0.0; 6]);
            for (cfg, found) in solutions.iter() {
                let (far, turned) = distance(&opw.forward(found), &pose);
                worst = worst.max(far);
                worst_angle = worst_angle.max(turned);
                assert!(far < 1e-6 && turned < 1e-9, "{name} {axes:?} cfg {cfg}: {far} mm, {turned} rad");
                assert_eq!(opw.cfg(found), cfg, "{name} {axes:?} -> {found:?}");
                assert_eq!(opw.inverse(&pose, cfg, &[0.0; 6]).as_ref().map(|one| one.map(wrap_degrees)), Some(*found));
            }
            // The configuration that made the pose is among them, and each arm that reaches has both wrists.
            let own = solutions.get(opw.cfg(&axes)).unwrap_or_else(|| panic!("{name}: {axes:?} is missing"));
            for (a, b) in own.iter().zip(axes) {
                assert!(wrap_degrees(a - b).abs() < 1e-5, "{name} {axes:?} -> {own:?}");
            }
            let arms = (0..4).filter(|pair| solutions.get(2 * pair).is_some()).count();
            assert_eq!(solutions.iter().count(), 2 * arms);
            assert_eq!(arms, reachable_arms(opw.parameters(), &pose), "{name} {axes:?}");
        }
    }
    assert!(worst < 1e-7, "1e-10 m: {worst} mm, {worst_angle} rad");
}

/// The number of the four arm positions that reach a pose, by the triangle rule alone.
fn reachable_arms(p: &OpwParameters, pose: &Frame) -> usize {
    let centre = (pose * Translation3::new(0.0, 0.0, -p.c4)).translation.vector;
    let across = centre.x.hypot(centre.y);
    let (k, depth) = (p.a2.hypot(p.c3), (across * across - p.b * p.b).max(0.0).sqrt());
    if across < p.b.abs() {
        return 0;
    }
    let reaches = |x: f64| {
        let far = (x - p.a1).hypot(centre.z - p.c1);
        far <= p.c2 + k && far >= (p.c2 - k).abs()
    };
    2 * (usize::from(reaches(depth)) + usize::from(reaches(-depth)))
}

#[test]
fn cfg_follows_the_table() {
    let robot = Robot::builtin("kr10-r1420").unwrap();
    let cfg = |axes: Axes| robot.kinematics.cfg(&axes);
    // Arm forwards, forearm bent down in front: right, right.
    assert_eq!(cfg([0.0, -90.0, 90.0, 0.0, 30.0, 0.0]), 0);
    assert_eq!(cfg([0.0, -90.0, 90.0, 0.0, -30.0, 0.0]), 1);
    // Upper arm forwards, forearm bent up and still in front of axis 1: right, left.
    assert_eq!(cfg([0.0, -20.0, -60.0, 0.0, 30.0, 0.0]), 2);
    assert_eq!(cfg([0.0, -20.0, -60.0, 0.0, -30.0, 0.0]), 3);
    // Arm bent over backwards.
    assert_eq!(cfg([0.0, -150.0, -60.0, 0.0, 30.0, 0.0]), 4);
    assert_eq!(cfg([0.0, -150.0, -60.0, 0.0, -30.0, 0.0]), 5);
    assert_eq!(cfg([0.0, -180.0, 90.0, 0.0, 30.0, 0.0]), 6);
    assert_eq!(cfg([0.0, -180.0, 90.0, 0.0, -30.0, 0.0]), 7);
    // Zero counts as positive, even with rounding errors.
    assert_eq!(cfg([0.0, -90.0, 90.0, 0.0, -1e-12, 0.0]), 0);
}

#[test]
fn open_axes_stay_where_they_were_at_singular_points() {
    for name in ROBOTS {
        let robot = Robot::builtin(name).unwrap();
        let opw = opw(&robot);
        let near = [10.0, -40.0, 60.0, 77.0, 0.0, -31.0];
        let pose = opw.forward(&near);
        let found = opw.inverse(&pose, opw.cfg(&near), &near).unwrap();
        let flipped = opw.inverse(&pose, opw.cfg(&near) ^ 1, &near).unwrap();
        for (a, b) in found.iter().zip(near).chain(flipped.iter().zip(near)) {
            assert!((a - b).abs() < 1e-6, "{name}: {found:?} {flipped:?}");
        }
    }
    // Wrist centre on axis 1: any angle of axis 1 is possible.
    let robot = Robot::builtin("tx2-60").unwrap();
    let without_width = Opw::new(OpwParameters { b: 0.0, ..*opw(&robot).parameters() });
    let near = [33.0, 0.0, 0.0, 10.0, 20.0, 30.0];
    let found = without_width.inverse(&without_width.forward(&near), 0, &near).unwrap();
    assert!((found[0] - 33.0).abs() < 1e-9, "{found:?}");
}

#[test]
fn poses_near_the_wrist_singularity_are_exact() {
    let mut random = Random::new(3);
    let robot = Robot::builtin("irb2400-10").unwrap();
    for exponent in 3..14 {
        for _ in 0..200 {
            let mut axes = random_axes(&robot, &mut random);
            axes[4] = 10.0_f64.powi(-exponent);
            let pose = robot.kinematics.forward(&axes);
            let found = robot.kinematics.inverse(&pose, robot.kinematics.cfg(&axes), &axes).unwrap();
            let (far, turned) = distance(&robot.kinematics.forward(&found), &pose);
            assert!(far < 1e-7 && turned < 1e-9, "{axes:?} {found:?} {far} {turned}");
        }
    }
}

#[test]
fn turn_picks_whole_turns_and_ranges_hold() {
    let robot = Robot::builtin("kr10-r1420").unwrap();
    let start = [0.0, -90.0, 90.0, 0.0, 45.0, 300.0];
    let goal = [10.0, -80.0, 80.0, 20.0, 45.0, 170.0];
    let pose = robot.kinematics.forward(&goal);
    let choose = |cfg, turn, near: &Axes| robot.kinematics.choose(&pose, Wanted { cfg, turn }, &robot.axes, near);
    let close = |found: Axes, expected: Axes| {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{found:?} {expected:?}");
    };
    close(choose(Some(0), -1, &start).unwrap(), goal);
    close(choose(Some(0), -1, &[0.0, 0.0, 0.0, 0.0, 0.0, -100.0]).unwrap(), [10.0, -80.0, 80.0, 20.0, 45.0, -190.0]);
    // Bit 5 requests axis 6 below 0; axis 2 cannot be above 0 although its bit requests it.
    close(choose(Some(0), 0b10_0000, &start).unwrap(), [10.0, -80.0, 80.0, 20.0, 45.0, -190.0]);
    close(choose(Some(0), 0, &[0.0, 0.0, 0.0, 0.0, 0.0, -100.0]).unwrap(), goal);
    // No cfg: the nearest one.
    close(choose(None, -1, &start).unwrap(), goal);
    assert_eq!(choose(Some(8), -1, &start), Err(Refusal::NoSuchCfg { cfg: 8 }));
    let far = frame([3000.0, 0.0, 500.0, 0.0, 90.0, 0.0]);
    let refused = robot.kinematics.choose(&far, Wanted { cfg: Some(0), turn: -1 }, &robot.axes, &start);
    // Wrist centre 2920 away from the base: 2770.45 from axis 2, of which the arm reaches 1270.303.
    assert!(matches!(refused, Err(Refusal::Unreachable { beyond }) if (beyond - 1500.147).abs() < 0.01), "{refused:?}");
}

#[test]
fn a_linear_axis_takes_no_turns() {
    let robot = Robot::builtin("hsr065").unwrap();
    let near = [0.0, 10.0, 0.0, 0.0, 0.0, 0.0];
    let at = |axes: Axes| robot.kinematics.forward(&axes);
    let choose = |axes: Axes, cfg| {
        let wanted = Wanted { cfg: Some(cfg), turn: -1 };
        robot.kinematics.choose(&at(axes), wanted, &robot.axes, &near)
    };
    let found = choose([20.0, 30.0, 100.0, 40.0, 0.0, 0.0], 0).unwrap();
    assert!(found.iter().zip([20.0, 30.0, 100.0, 40.0, 0.0, 0.0]).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?}");
    assert_eq!(
        choose([20.0, 30.0, 250.0, 40.0, 0.0, 0.0], 0),
        Err(Refusal::AxisLimit { axis: 2, value: 250.0 }),
        "the lift ends at 220"
    );
    let left = choose([20.0, -30.0, 100.0, 40.0, 0.0, 0.0], 4).unwrap();
    assert!((left[1] + 30.0).abs() < 1e-9);
    let tilted = frame([400.0, 0.0, 300.0, 0.0, 1.0, 0.0]);
    assert_eq!(robot.kinematics.inverse(&tilted, 0, &near), None, "a SCARA cannot tilt its flange");
}

#[test]
fn a_hundred_thousand_scara_poses_have_both_hands() {
    let mut random = Random::new(4);
    for name in SCARAS {
        let robot = Robot::builtin(name).unwrap();
        let kinematics = &robot.kinematics;
        for _ in 0..50_000 {
            let axes = random_axes(&robot, &mut random);
            let pose = kinematics.forward(&axes);
            assert_eq!(kinematics.beyond_reach(&pose), 0.0);
            for cfg in [0, 4] {
                let found = kinematics.inverse(&pose, cfg, &axes).unwrap();
                let (far, turned) = distance(&kinematics.forward(&found), &pose);
                assert!(far < 1e-7 && turned < 1e-9, "{name} {axes:?} {found:?}: {far} {turned}");
                let stretched = kinematics.clearance(&found) < 1e-6;
                assert!(kinematics.cfg(&found) == cfg || stretched, "{name} {axes:?} {found:?}");
            }
            let wanted = Wanted { cfg: Some(kinematics.cfg(&axes)), turn: -1 };
            let own = kinematics.choose(&pose, wanted, robot.own_axes(), &axes).unwrap();
            let near = own.iter().zip(axes).all(|(a, b)| (a - b).abs() < 1e-6);
            assert!(near || kinematics.clearance(&axes) < 1e-3, "{name} {axes:?} {own:?}");
        }
    }
}

#[test]
fn a_scara_says_why_it_refuses() {
    let robot = Robot::builtin("hsr065").unwrap();
    let choose = |pose: [f64; 6], cfg| {
        let wanted = Wanted { cfg, turn: -1 };
        robot.kinematics.choose(&frame(pose), wanted, robot.own_axes(), &[0.0; 6])
    };
    let tilted = |pose: [f64; 6], degrees: f64| match choose(pose, None) {
        Err(Refusal::Tilted { by }) => assert!((by - degrees).abs() < 1e-9, "{by}"),
        other => panic!("{other:?}"),
    };
    tilted([400.0, 0.0, 300.0, 30.0, 1.0, 0.0], 1.0);
    tilted([400.0, 0.0, 300.0, 30.0, 0.0, 180.0], 180.0);
    let far = choose([700.0, 0.0, 300.0, 0.0, 0.0, 0.0], Some(0));
    assert!(matches!(far, Err(Refusal::Unreachable { beyond }) if (beyond - 50.0).abs() < 1e-9), "{far:?}");
    let close = choose([0.0, 60.0, 300.0, 0.0, 0.0, 0.0], Some(4));
    assert!(matches!(close, Err(Refusal::Unreachable { beyond }) if (beyond - 40.0).abs() < 1e-9), "{close:?}");
    assert_eq!(choose([400.0, 0.0, 300.0, 0.0, 0.0, 0.0], Some(1)), Err(Refusal::NoSuchCfg { cfg: 1 }));
    // If the whole arm is folded upon itself, axis 1 stays.
    let folding = Scara { l1: 300.0, l2: 300.0, z0: 0.0 };
    let found = folding.inverse(&frame([0.0; 6]), 0, &[25.0; 6]).unwrap();
    assert!((found[0] - 25.0).abs() < 1e-9 && (found[1] - 180.0).abs() < 1e-9, "{found:?}");
}

#[test]
fn components_and_frames_go_both_ways() {
    let mut random = Random::new(5);
    for _ in 0..5000 {
        let given = [
            random.between(-1e3, 1e3),
            random.between(-1e3, 1e3),
            random.between(-1e3, 1e3),
            random.between(-179.0, 179.0),
            random.between(-89.0, 89.0),
            random.between(-179.0, 179.0),
        ];
        let found = frame_components(&frame(given));
        assert!(found.iter().zip(given).all(|(a, b)| (a - b).abs() < 1e-9), "{given:?} {found:?}");
    }
    // a about z, then b about the new y, then c about the new x.
    let about = |axis: Vector3<f64>, angle: f64| UnitQuaternion::from_scaled_axis(axis * f64::to_radians(angle));
    let expected = about(Vector3::z(), 30.0) * about(Vector3::y(), 40.0) * about(Vector3::x(), 50.0);
    assert!(frame([0.0, 0.0, 0.0, 30.0, 40.0, 50.0]).rotation.angle_to(&expected) < 1e-12);
}

#[test]
fn at_gimbal_lock_c_is_zero_and_the_rotation_right() {
    for (b, c) in [(90.0, 25.0), (-90.0, 25.0), (90.0, 0.0), (89.999_999_99, -70.0), (-89.999_999, 170.0)] {
        let given = frame([1.0, 2.0, 3.0, 10.0, b, c]);
        let found = frame_components(&given);
        assert!(frame(found).rotation.angle_to(&given.rotation) < 1e-8, "{found:?}");
        if b.abs() == 90.0 {
            assert_eq!(found[5], 0.0);
            assert!((found[4] - b).abs() < 1e-9);
        }
    }
}

/// Flange frames along a straight line with a uniform turn.
fn along(start: &Frame, travel: &Vector3<f64>, turning: &Vector3<f64>, u: f64) -> Frame {
    let rotation = UnitQuaternion::from_scaled_axis(turning * u) * start.rotation;
    Frame::from_parts(Translation3::from(start.translation.vector + travel * u), rotation)
}

#[test]
fn rates_are_the_derivatives_of_the_axes_along_a_line() {
    let mut random = Random::new(6);
    for name in ROBOTS.into_iter().chain(SCARAS) {
        let robot = Robot::builtin(name).unwrap();
        let kinematics = &robot.kinematics;
        let upright = matches!(kinematics, Kinematics::Scara(_));
        let mut tried = 0;
        while tried < 100 {
            let axes = random_axes(&robot, &mut random);
            let pose = kinematics.forward(&axes);
            let mut vector = |size: f64| {
                Vector3::new(random.between(-size, size), random.between(-size, size), random.between(-size, size))
            };
            let (travel, turning) = (vector(300.0), vector(1.0));
            let turning = if upright { Vector3::new(0.0, 0.0, turning.z) } else { turning };
            let twist = Twist::straight(&pose.translation.vector, &travel, &turning);
            let Some(rates) = kinematics.rates(&axes, &twist) else { continue };
            // Away from singular points, so that differences approximate the derivative.
            if rates.third.iter().any(|third| third.abs() > 3e3) {
                continue;
            }
            tried += 1;
            let h = 1e-3;
            let at = |u: f64| {
                let flange = along(&pose, &travel, &turning, u);
                let mut found = kinematics.inverse(&flange, kinematics.cfg(&axes), &axes).unwrap();
                for (value, near) in found.iter_mut().zip(axes) {
                    *value = near + wrap_degrees(*value - near);
                }
                found
            };
            let (m2, m1, p1, p2) = (at(-2.0 * h), at(-h), at(h), at(2.0 * h));
            for i in 0..6 {
                let first = (8.0 * (p1[i] - m1[i]) - (p2[i] - m2[i])) / (12.0 * h);
                let second = (16.0 * (p1[i] + m1[i]) - (p2[i] + m2[i]) - 30.0 * axes[i]) / (12.0 * h * h);
                let third = (p2[i] - m2[i] - 2.0 * (p1[i] - m1[i])) / (2.0 * h * h * h);
                let close = |a: f64, b: f64, slack: f64| (a - b).abs() < slack * (1.0 + b.abs());
                assert!(close(first, rates.first[i], 1e-6), "{name} axis {i}: {first} {rates:?}");
                assert!(close(second, rates.second[i], 1e-4), "{name} axis {i}: {second} {rates:?}");
                assert!(close(third, rates.third[i], 0.1), "{name} axis {i}: {third} {rates:?}");
            }
            let velocity = kinematics.point_velocity(&axes, &rates.first, &pose.translation.vector);
            assert!((velocity - travel).norm() < 1e-6);
        }
    }
}

/// The jacobian matches differences of the forward kinematics, and the rates of a curved path are consistent with it.
#[test]
fn the_jacobian_tells_how_a_point_on_the_flange_moves() {
    let mut random = Random::new(7);
    for name in ROBOTS.into_iter().chain(SCARAS) {
        let robot = Robot::builtin(name).unwrap();
        for _ in 0..200 {
            let axes = random_axes(&robot, &mut random);
            let pose = robot.kinematics.forward(&axes);
            let point = pose * nalgebra::Point3::new(30.0, -50.0, 120.0);
            let jacobian = robot.kinematics.jacobian(&axes, &point.coords);
            for column in 0..6 {
                let linear = robot.own_axes().get(column).is_some_and(|axis| axis.linear);
                let h = if linear { 1e-3 } else { 1e-6 };
                let moved = |by: f64| {
                    let mut axes = axes;
                    axes[column] += if linear { by } else { by.to_degrees() };
                    robot.kinematics.forward(&axes) * pose.inverse()
                };
                let (before, after) = (moved(-h), moved(h));
                let turning = (after.rotation * before.rotation.inverse()).scaled_axis() / (2.0 * h);
                let moving = (after * point - before * point) / (2.0 * h);
                let expected = [turning.x, turning.y, turning.z, moving.x, moving.y, moving.z];
                let found: [f64; 6] = jacobian.column(column).into_owned().into();
                let close = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5 * (1.0 + b.abs()));
                assert!(close, "{name} {axes:?} axis {column}: {found:?} {expected:?}");
            }
        }
    }
}

#[test]
fn rates_of_a_curved_path_follow_it() {
    // The tip of a tool moves around a circle while the tool turns ever faster.
    let robot = Robot::builtin("irb2400-10").unwrap();
    let start = [10.0, 20.0, -15.0, 30.0, 50.0, -40.0];
    let pose = robot.kinematics.forward(&start);
    let tool = Translation3::new(40.0, 0.0, 150.0);
    let centre = (pose * tool).translation.vector - Vector3::new(100.0, 0.0, 0.0);
    let axis = Vector3::new(0.3, -0.2, 0.9).normalize();
    let at = |u: f64| {
        let tip = centre + Vector3::new(u.cos(), u.sin(), 0.0) * 100.0;
        let turned = UnitQuaternion::from_scaled_axis(axis * (0.4 * u + 0.3 * u * u)) * pose.rotation;
        let flange = Frame::from_parts(Translation3::from(tip), turned) * tool.inverse();
        robot.kinematics.inverse(&flange, robot.kinematics.cfg(&start), &start).unwrap()
    };
    let travel = [Vector3::new(0.0, 100.0, 0.0), Vector3::new(-100.0, 0.0, 0.0), Vector3::new(0.0, -100.0, 0.0)];
    let turning = [axis * 0.4, axis * 0.6, Vector3::zeros()];
    let tip = centre + Vector3::new(100.0, 0.0, 0.0);
    let rates = robot.kinematics.rates(&start, &Twist::of_point(&tip, &travel, &turning)).unwrap();
    let h = 1e-3;
    let (m2, m1, p1, p2) = (at(-2.0 * h), at(-h), at(h), at(2.0 * h));
    for i in 0..6 {
        let first = (8.0 * (p1[i] - m1[i]) - (p2[i] - m2[i])) / (12.0 * h);
        let second = (16.0 * (p1[i] + m1[i]) - (p2[i] + m2[i]) - 30.0 * start[i]) / (12.0 * h * h);
        let third = (p2[i] - m2[i] - 2.0 * (p1[i] - m1[i])) / (2.0 * h * h * h);
        let close = |a: f64, b: f64, slack: f64| (a - b).abs() < slack * (1.0 + b.abs());
        assert!(close(first, rates.first[i], 1e-7), "axis {i}: {first} {rates:?}");
        assert!(close(second, rates.second[i], 1e-5), "axis {i}: {second} {rates:?}");
        assert!(close(third, rates.third[i], 1e-2), "axis {i}: {third} {rates:?}");
    }
}

#[test]
fn rates_at_singular_points_and_of_a_tilting_scara_are_none() {
    let robot = Robot::builtin("kr10-r1420").unwrap();
    let twist = Twist::straight(&Vector3::zeros(), &Vector3::new(10.0, 20.0, 30.0), &Vector3::new(0.1, 0.2, 0.3));
    assert!(robot.kinematics.rates(&[10.0, -90.0, 90.0, 20.0, 0.0, 0.0], &twist).is_none(), "wrist");
    let scara = Robot::builtin("hsr065").unwrap();
    assert!(scara.kinematics.rates(&[10.0, 40.0, 0.0, 20.0, 0.0, 0.0], &twist).is_none(), "tilt");
    let upright = Twist::straight(&Vector3::zeros(), &Vector3::new(10.0, 20.0, 30.0), &Vector3::new(0.0, 0.0, 0.3));
    assert!(scara.kinematics.rates(&[10.0, 40.0, 0.0, 20.0, 0.0, 0.0], &upright).is_some());
    assert!(scara.kinematics.rates(&[10.0, 0.0, 0.0, 20.0, 0.0, 0.0], &upright).is_none(), "stretched");
    assert_eq!(scara.kinematics.clearance(&[10.0, 0.0, 0.0, 20.0, 0.0, 0.0]), 0.0);
}

#[test]
fn axis_limits_name_the_axis() {
    let robot = Robot::builtin("six-10").unwrap();
    let narrow: Vec<Axis> = robot.axes.iter().map(|axis| Axis { max: axis.max.min(20.0), ..axis.clone() }).collect();
    let goal = [0.0, 10.0, 10.0, 0.0, 40.0, 0.0];
    let wanted = Wanted { cfg: Some(robot.kinematics.cfg(&goal)), turn: -1 };
    match robot.kinematics.choose(&robot.kinematics.forward(&goal), wanted, &narrow, &goal) {
        Err(Refusal::AxisLimit { axis: 4, value }) => assert!((value - 40.0).abs() < 1e-6),
        other => panic!("{other:?}"),
    }
}
