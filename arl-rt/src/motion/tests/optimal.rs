//! The profile O.

use super::stops::{assert_same_path, two_motions_with};
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
    let mut random = Random::new(92);
    for name in ["kr10-r1420", "tx2-60", "irb2400-10"] {
        let robot = with_external_axes(name);
        for round in 0..3 {
            let mut queue = random_chain(&robot, &mut random, &optimal());
            let end = *queue.end();
            let rows = run(&mut queue, 100.0);
            assert_within_limits(&robot, &rows, &format!("{name} {round}"));
            assert_eq!(values(&robot, &rows.last().unwrap().joints), values(&robot, &end), "{name} {round}");
            assert_eq!(rows.last().unwrap().finished, 10);
        }
    }
}

#[test]
fn stops_stay_on_the_path_and_resume() {
    let robot = robot("kr10-r1420");
    let reference = run(&mut two_motions_with(&robot, &optimal()), 100.0);
    assert_within_limits(&robot, &reference, "undisturbed");
    let mut random = Random::new(93);
    let mut longest = 0;
    for _ in 0..8 {
        let mut queue = two_motions_with(&robot, &optimal());
        let mut rows = vec![reference[0]];
        for _ in 0..3 {
            for _ in 0..random.between(1.0, 0.4 * reference.len() as f64) as usize {
                rows.push(queue.step(CYCLE, 100.0));
            }
            queue.stop_on_path(Stop::General);
            let mut cycles = 0;
            while !queue.rests() {
                rows.push(queue.step(CYCLE, 100.0));
                cycles += 1;
                assert!(cycles < 3000);
            }
            longest = longest.max(cycles);
            let at = *queue.joints();
            for _ in 0..20 {
                rows.push(queue.step(CYCLE, 100.0));
                assert_eq!(*queue.joints(), at, "it stands still");
            }
            queue.resume();
        }
        while !queue.idle() {
            rows.push(queue.step(CYCLE, 100.0));
        }
        assert_within_limits(&robot, &rows, "stops");
        assert_same_path(&robot, &rows, &reference);
        assert_eq!(rows.last().unwrap().joints, reference.last().unwrap().joints);
    }
    assert!(longest < 600, "{longest}");
}

#[test]
fn the_override_changes_time_alone() {
    let robot = robot("kr10-r1420");
    let reference = run(&mut two_motions_with(&robot, &optimal()), 100.0);
    let half = run(&mut two_motions_with(&robot, &optimal()), 50.0);
    let ratio = half.len() as f64 / reference.len() as f64;
    assert!((ratio - 2.0).abs() < 0.01, "{ratio}");
    let mut random = Random::new(94);
    for _ in 0..5 {
        let mut queue = two_motions_with(&robot, &optimal());
        let mut rows = vec![reference[0]];
        let (mut percent, mut hold) = (100.0, 0);
        while !queue.idle() {
            if hold == 0 {
                percent = if random.between(0.0, 1.0) < 0.2 { 0.0 } else { random.between(1.0, 100.0) };
                hold = random.between(20.0, 300.0) as usize;
            }
            hold -= 1;
            rows.push(queue.step(CYCLE, percent));
            assert!(rows.len() < 500_000);
        }
        assert_within_limits(&robot, &rows, "override");
        assert_same_path(&robot, &rows, &reference);
        assert_eq!(rows.last().unwrap().joints, reference.last().unwrap().joints);
    }
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
