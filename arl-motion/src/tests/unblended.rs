//! Targets that are not rounded off, and what is said of them.

use crate::tests::*;

/// What is said of the targets of lines from the start, each so far from the one before in mm, deg and mm (deg) of
/// external axes.
fn unblended_corners(offsets: &[([f64; 6], [f64; 2])], zone: f64) -> Vec<(u32, NoBlend)> {
    let robot = with_external_axes("kr10-r1420");
    let start = Joints { axes: [0.0, -90.0, 90.0, 0.0, 45.0, 0.0], external: [0.0, 0.0, UNSET, UNSET, UNSET, UNSET] };
    let mut queue = Queue::repeatable(robot.clone(), start);
    let mut pose = frame_components(&robot.kinematics.forward(&start.axes));
    let mut external = start.external;
    for (line, (offset, moved)) in (1..).zip(offsets) {
        pose.iter_mut().zip(offset).for_each(|(value, by)| *value += by);
        external.iter_mut().zip(moved).for_each(|(value, by)| *value += by);
        let target = Target::Line { pose, wobj: Frame::identity(), external };
        let zone = Zone { tcp: zone, ..Zone::NONE };
        queue.add(&Command { target, zone, line, ..lin(pose) }, &Settings::default()).unwrap();
    }
    run(&mut queue, 100.0);
    queue.take_unblended().into_iter().map(|target| (target.corner.unwrap(), target.why)).collect()
}

const STAYS: [f64; 2] = [0.0; 2];

#[test]
fn paths_that_turn_are_rounded_off() {
    let square =
        [[0.0, 100.0, 0.0], [0.0, 0.0, -100.0], [0.0, -100.0, 0.0]].map(|[x, y, z]| ([x, y, z, 0.0, 0.0, 0.0], STAYS));
    assert_eq!(unblended_corners(&square, 10.0), []);
}

#[test]
fn a_reversal_is_reported_as_one() {
    let there = [0.0, 0.0, -80.0, 0.0, 0.0, 0.0];
    let back = there.map(|value| -value);
    // Whatever is wrong with the axes where the way turns back.
    assert_eq!(unblended_corners(&[(there, STAYS), (back, STAYS)], 10.0), [(1, NoBlend::Reversal)]);
    let slanted = [40.0, 30.0, -80.0, 0.0, 0.0, 0.0];
    let offsets = [(slanted, STAYS), (slanted.map(|value| -value / 2.0), STAYS)];
    assert_eq!(unblended_corners(&offsets, 2.0), [(1, NoBlend::Reversal)]);
}

#[test]
fn external_axes_alone_are_reported_as_such() {
    let along = [0.0, 80.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(unblended_corners(&[(along, STAYS), ([0.0; 6], [20.0, 100.0])], 10.0), [(1, NoBlend::ExternalAlone)]);
}

#[test]
fn a_zone_that_is_nothing_beside_the_next_motion_is_reported_as_such() {
    let (along, down) = ([0.0, 200.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, -200.0, 0.0, 0.0, 0.0]);
    assert_eq!(unblended_corners(&[(along, STAYS), (down, STAYS)], 1e-4), [(1, NoBlend::NothingToRound)]);
}

#[test]
fn the_same_lines_are_reported_once() {
    let robot = robot("kr10-r1420");
    let start = axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let mut queue = Queue::repeatable(robot.clone(), start);
    let [here, mut there] = [frame_components(&robot.kinematics.forward(&start.axes)); 2];
    there[2] -= 50.0;
    for _ in 0..5 {
        for (line, pose) in [(1, there), (2, here)] {
            let zone = Zone { tcp: 5.0, ..Zone::NONE };
            queue.add(&Command { zone, line, ..lin(pose) }, &Settings::default()).unwrap();
        }
    }
    run(&mut queue, 100.0);
    let corners: Vec<_> = queue.take_unblended().into_iter().map(|target| (target.corner, target.line)).collect();
    assert_eq!(corners, [(Some(1), 2), (Some(2), 1)]);
    assert_eq!(queue.take_unblended(), []);
}

/// How many cycles lines to and fro take whose tool turns by so many deg each time, with a zone in mm, and why targets
/// are not rounded off.
fn to_and_fro(profile: VelocityProfile, turn: f64, zone: f64) -> (usize, Vec<NoBlend>) {
    let robot = robot("kr6-r700");
    let start = axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let mut queue = Queue::repeatable(robot.clone(), start);
    let mut pose = frame_components(&robot.kinematics.forward(&start.axes));
    for index in 0..8 {
        let sign = if index % 2 == 0 { 1.0 } else { -1.0 };
        let offset = [0.0, 30.0 * sign, 25.0, turn * sign, 0.0, turn * sign];
        pose.iter_mut().zip(offset).for_each(|(value, by)| *value += by);
        let speed = Speed { tcp: 900.0, ..fast() };
        let command = Command { zone: Zone { tcp: zone, ..Zone::NONE }, speed, ..lin(pose) };
        queue.add(&command, &Settings { profile, ..Settings::default() }).unwrap();
    }
    let rows = run(&mut queue, 100.0);
    assert_within_limits_of(&robot, &rows, profile, &format!("{profile:?} {turn} {zone}"));
    (rows.len(), queue.take_unblended().into_iter().map(|target| target.why).collect())
}

#[test]
fn a_blend_that_would_take_longer_than_a_stop_is_none() {
    for profile in [VelocityProfile::S, VelocityProfile::T] {
        let (mut dropped, mut kept) = (0, 0);
        for turn in [0.0, 12.0] {
            let (stops, _) = to_and_fro(profile, turn, -1.0);
            for zone in [0.01, 0.1, 1.0, 10.0] {
                let (cycles, why) = to_and_fro(profile, turn, zone);
                let most = 1.003 * stops as f64 + 2.0;
                assert!(cycles as f64 <= most, "{profile:?}, {turn} deg, {zone} mm: {cycles}, {stops} with stops");
                assert!(why.iter().all(|why| *why == NoBlend::Slower), "{why:?}");
                if why.is_empty() { kept += 1 } else { dropped += 1 }
            }
        }
        assert!(dropped > 0 && kept > 0, "{profile:?}: {dropped} {kept}");
    }
}

#[test]
fn a_tool_that_turns_along_short_lines_and_splines_gains_time_by_zones() {
    let robot = robot("irb2400-10");
    let start = axes([0.0, 0.0, 0.0, 0.0, 45.0, 0.0]);
    let targets = [
        (false, [915.536, -2.558, 1403.207, 184.740, 48.464, 175.117]),
        (false, [913.185, 8.301, 1395.372, 172.992, 53.604, 185.042]),
        (false, [921.027, 1.284, 1397.319, 187.174, 37.774, 190.182]),
        (false, [910.094, -6.046, 1391.453, 172.615, 42.510, 177.162]),
        (true, [916.780, 2.355, 1403.488, 180.921, 34.185, 175.066]),
        (true, [923.090, -4.861, 1393.906, 187.710, 34.372, 170.529]),
        (false, [914.915, 6.511, 1391.557, 188.408, 53.146, 190.852]),
        (false, [911.652, 5.385, 1393.832, 180.487, 42.228, 172.181]),
    ];
    let took = |percent: f64| {
        let mut queue = Queue::repeatable(robot.clone(), start);
        for (spline, pose) in targets {
            let (wobj, external) = (Frame::identity(), [UNSET; 6]);
            let target =
                if spline { Target::Spline { pose, wobj, external } } else { Target::Line { pose, wobj, external } };
            let (zone, speed) = (Zone { percent, ..Zone::NONE }, Speed { tcp: 300.0, ..fast() });
            queue.add(&Command { zone, speed, ..command(target) }, &Settings::default()).unwrap();
        }
        let rows = run(&mut queue, 100.0);
        assert_within_limits(&robot, &rows, &format!("zones of {percent} %"));
        rows.len() as f64
    };
    let (zones, stops) = (took(100.0), took(-1.0));
    assert!(zones < 0.8 * stops, "{zones} cycles, {stops} with stops");
}

#[test]
fn targets_that_all_but_coincide_are_distinguished_from_singular_points() {
    let robot = robot("kr10-r1420");
    let start = axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let [x, y, z, ..] = frame_components(&robot.kinematics.forward(&start.axes));
    for apart in [1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2] {
        let mut queue = Queue::repeatable(robot.clone(), start);
        for to in [[x, y + 100.0, z], [x, y + 100.0 + apart, z], [x - 100.0, y + 100.0 + apart, z]] {
            let zone = Zone { tcp: 20.0, ..Zone::NONE };
            let target = lin([to[0], to[1], to[2], UNSET, UNSET, UNSET]);
            queue.add(&Command { zone, ..target }, &Settings::default()).unwrap();
        }
        run(&mut queue, 100.0);
        let reasons: Vec<NoBlend> = queue.take_unblended().into_iter().map(|target| target.why).collect();
        assert!(
            reasons.iter().all(|why| matches!(why, NoBlend::NothingToRound | NoBlend::Slower)),
            "{apart}: {reasons:?}"
        );
    }
}
