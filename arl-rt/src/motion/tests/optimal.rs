//! The profile O.

use super::blends::run_chains;
use super::stops::{change_override, stop_and_resume};
use super::*;
use crate::robot::VelocityProfile;

fn optimal() -> Settings {
    Settings { profile: VelocityProfile::O, ..Settings::default() }
}

fn start() -> Joints {
    axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0])
}

/// Two lines of 300 mm at 1 m/s and a corner of 90 deg between them, with a zone in mm.
fn corner(zone: f64, settings: &Settings) -> Vec<Step> {
    let robot = robot("kr10-r1420");
    let mut queue = Queue::new(robot.clone(), start());
    let origin = frame_components(&robot.kinematics.forward(&start().axes));
    for (y, z) in [(300.0, 0.0), (300.0, -300.0)] {
        let mut pose = origin;
        (pose[1], pose[2]) = (origin[1] + y, origin[2] + z);
        let (speed, zone) = (Speed { tcp: 1000.0, ..fast() }, Zone { tcp: zone, ..Zone::NONE });
        queue.add(&Command { zone, speed, ..lin(pose) }, settings).unwrap();
    }
    let rows = run(&mut queue, 100.0);
    assert_within_limits(&robot, &rows, "corner");
    rows
}

#[test]
fn a_corner_is_quicker_than_with_constant_limits() {
    for zone in [-1.0, 5.0, 20.0, 100.0] {
        let (constant, optimal) = (corner(zone, &Settings::default()).len(), corner(zone, &optimal()).len());
        assert!(optimal <= constant, "{zone} mm: {constant} {optimal}");
    }
}

#[test]
fn chains_of_all_kinds_keep_every_limit() {
    run_chains(&optimal(), 92, 3);
}

#[test]
fn stops_stay_on_the_path_and_resume() {
    stop_and_resume(&optimal(), 93, 8);
}

#[test]
fn the_override_changes_time_alone() {
    change_override(&optimal(), 94, 5, |_| 300);
}

#[test]
fn splines_flow_within_every_limit() {
    let mut random = Random::new(95);
    let robot = robot("kr10-r1420");
    for settings in [optimal(), Settings::default()] {
        let mut queue = Queue::new(robot.clone(), start());
        let origin = frame_components(&robot.kinematics.forward(&start().axes));
        for index in 0..12 {
            let mut pose = origin;
            pose[0] += random.between(-60.0, 60.0);
            pose[1] += 40.0 * f64::from(index + 1);
            pose[2] += random.between(-60.0, 60.0);
            let target = Target::Spline { pose, wobj: Frame::identity(), external: [UNSET; 6] };
            let speed = Speed { tcp: 1000.0, ..fast() };
            queue.add(&Command { speed, ..command(target) }, &settings).unwrap();
        }
        let rows = run(&mut queue, 100.0);
        assert_within_limits(&robot, &rows, "spline");
        assert_eq!(rows.last().unwrap().finished, 12);
    }
}
