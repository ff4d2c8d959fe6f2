//! Torques compared with those of another implementation, and forces with those determined from torques.

use nalgebra::{Translation3, UnitQuaternion};

use super::*;
use crate::values::{CentroidPos, InertiaTensor, ToolInertiaPara};
use arl_robot::kinematics::random::Random;
use arl_robot::robot::Description;

/// Torques computed by Pinocchio: see `scripts/newton-euler.py`.
const CASES: &str = include_str!("../../../tests/data/newton-euler.txt");

fn numbers<const N: usize>(text: &str) -> [f64; N] {
    let mut all = [0.0; N];
    for (number, word) in all.iter_mut().zip(text.split_whitespace()) {
        *number = word.parse().unwrap();
    }
    all
}

#[test]
fn torques_equal_those_of_pinocchio() {
    let mut cases = 0;
    for line in CASES.lines() {
        let fields: Vec<&str> = line.split(';').map(str::trim).collect();
        let [name, axes, rates, accelerations, load, outside, base, expected] = fields[..] else { panic!("{line}") };
        let mut dynamics = Dynamics::new(&Robot::builtin(name).unwrap()).unwrap();
        let [mass, x, y, z, xx, xy, xz, yy, yz, zz] = numbers(load);
        dynamics.set_load(&Load::new(mass, [x, y, z], [xx, xy, xz, yy, yz, zz]));
        let turned = UnitQuaternion::from_scaled_axis(Vector3::from(numbers::<3>(base)));
        dynamics.set_base(&Frame::from_parts(Translation3::new(100.0, 200.0, 300.0), turned));
        let [fx, fy, fz, tx, ty, tz] = numbers(outside);
        let outside = Wrench { force: Vector3::new(fx, fy, fz), torque: Vector3::new(tx, ty, tz) };
        let found = dynamics.torques(&numbers(axes), &numbers(rates), &numbers(accelerations), &outside);
        for (found, expected) in found.iter().zip(numbers::<6>(expected)) {
            assert!((found - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{line}\n{found} {expected}");
        }
        cases += 1;
    }
    assert_eq!(cases, 56);
}

#[test]
fn a_load_can_be_taken_off_and_weighs_what_it_weighs() {
    let mut dynamics = Dynamics::new(&Robot::builtin("kr10-r1420").unwrap()).unwrap();
    // Arm stretched forwards: axis 2 carries the load at 610 + 660 + 80 + 100 mm.
    let axes = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let second = |dynamics: &Dynamics| {
        let [_, second, ..] = dynamics.torques(&axes, &[0.0; 6], &[0.0; 6], &Wrench::default());
        second
    };
    let bare = second(&dynamics);
    let tool = ToolInertiaPara {
        m: 5000.0,
        centroidpos: CentroidPos { x: 0.0, y: 0.0, z: 100.0 },
        inertiatensor: InertiaTensor { ixx: 1e6, iyy: 1e6, izz: 1e6, ..InertiaTensor::default() },
    };
    dynamics.set_load(&Load::from(&tool));
    assert!(((second(&dynamics) - bare).abs() - 5.0 * GRAVITY * 1.45).abs() < 1e-9);
    dynamics.set_load(&Load::none());
    assert_eq!(second(&dynamics), bare);
}

#[test]
fn a_force_from_outside_is_held_and_found_again() {
    let mut random = Random::new(21);
    for name in Robot::builtin_names() {
        let robot = Robot::builtin(name).unwrap();
        let dynamics = Dynamics::new(&robot).unwrap();
        for _ in 0..200 {
            let mut axes = [0.0; 6];
            axes.iter_mut().zip(&robot.axes).for_each(|(value, axis)| *value = random.between(axis.min, axis.max));
            if robot.kinematics.clearance(&axes) < 0.05 {
                continue;
            }
            let mut vector = |size: f64| {
                Vector3::new(random.between(-size, size), random.between(-size, size), random.between(-size, size))
            };
            let (force, turn) = (vector(100.0), vector(10.0));
            let torque = if robot.links.len() == 4 { Vector3::new(0.0, 0.0, turn.z) } else { turn };
            let outside = Wrench { force, torque };
            let flange = robot.kinematics.forward(&axes).translation.vector;
            // Two ways to compute the same torques.
            let rest = [0.0; 6];
            let bare = dynamics.torques(&axes, &rest, &rest, &Wrench::default());
            let pushed = dynamics.torques(&axes, &rest, &rest, &outside);
            let torques = dynamics.holding(&axes, &outside, &flange);
            for ((pushed, bare), torque) in pushed.iter().zip(bare).zip(torques) {
                assert!((pushed - bare - torque).abs() < 1e-9 * (1.0 + pushed.abs()), "{name} {axes:?}");
            }
            // The torques beyond those of the model press back.
            let point = flange + vector(100.0);
            let found = dynamics.pressing(&axes, &dynamics.holding(&axes, &outside, &point), &point).unwrap();
            assert!((found.force + force).norm() < 1e-7 && (found.torque + torque).norm() < 1e-7, "{name} {found:?}");
        }
    }
    let dynamics = Dynamics::new(&Robot::builtin("kr10-r1420").unwrap()).unwrap();
    let singular = [0.0, -90.0, 90.0, 0.0, 0.0, 0.0];
    assert_eq!(dynamics.pressing(&singular, &[1.0; 6], &Vector3::zeros()), None);
    // The force and torque found there act on the axes in the same way.
    let (outside, point) =
        (Wrench { force: Vector3::new(10.0, -20.0, 30.0), torque: Vector3::zeros() }, Vector3::new(800.0, 50.0, 900.0));
    let felt = dynamics.holding(&singular, &outside, &point);
    let estimated = dynamics.felt(&singular, &felt, &point);
    let again = dynamics.holding(&singular, &Wrench { force: -estimated.force, torque: -estimated.torque }, &point);
    assert!(estimated.force.norm() + estimated.torque.norm() > 1.0);
    for (again, felt) in again.iter().zip(felt) {
        assert!((again - felt).abs() < 1e-4, "{again} {felt}");
    }
}

#[test]
fn currents_follow_gear_and_motor() {
    let robot = Robot::builtin("kr10-r1420").unwrap();
    let dynamics = Dynamics::new(&robot).unwrap();
    let [first, ..] = dynamics.currents(&[120.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(first, 120.0 / (robot.links[0].gear * robot.links[0].torque_constant));
}

#[test]
fn a_robot_without_masses_has_no_dynamics() {
    let described = Robot::builtin("kr10-r1420").unwrap().into_description();
    let robot = Robot::new(Description { links: Vec::new(), ..described }).unwrap();
    assert_eq!(Dynamics::new(&robot), None);
}
