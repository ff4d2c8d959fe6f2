//! What is recorded of motions.

use crate::queue::{MotionRecord, Recorder};
use crate::tests::*;

/// Records lines from the start, each so far from the one before in mm and deg, with its profile; `stop` in a cycle,
/// and on after rest.
fn record(offsets: &[([f64; 6], VelocityProfile)], zone: f64, stop: Option<(usize, Stop)>) -> Vec<MotionRecord> {
    let robot = with_external_axes("kr10-r1420");
    let start = Joints { axes: [0.0, -90.0, 90.0, 0.0, 45.0, 0.0], external: [0.0, 0.0, UNSET, UNSET, UNSET, UNSET] };
    let mut queue = Queue::repeatable(robot.clone(), start);
    let mut recorder = Recorder::new(robot.clone(), &mut queue);
    let mut pose = frame_components(&robot.kinematics.forward(&start.axes));
    for (offset, profile) in offsets {
        pose.iter_mut().zip(offset).for_each(|(value, by)| *value += by);
        let settings = Settings { profile: *profile, ..Settings::default() };
        let command = Command { zone: Zone { tcp: zone, ..Zone::NONE }, ..lin(pose) };
        let number = queue.add(&command, &settings).unwrap();
        recorder.planned(&mut queue, number, &command, &settings);
    }
    let mut cycle = 0;
    while !queue.idle() {
        match stop {
            Some((at, stop)) if cycle == at => queue.stop_on_path(stop),
            Some((at, _)) if cycle == at + 1000 => queue.resume(),
            _ => {}
        }
        let step = queue.step(Cycle::MS, Override::FULL);
        recorder.step(&mut queue, &step);
        cycle += 1;
        assert!(cycle < 100_000, "it does not end");
    }
    recorder.records().to_vec()
}

/// The shares of the limits that each motion came nearest to.
fn shares(records: &[MotionRecord]) -> Vec<[f64; 3]> {
    records.iter().map(|record| record.closest().map(|closest| closest.map_or(0.0, |closest| closest.share))).collect()
}

fn assert_within(records: &[MotionRecord]) {
    for (record, shares) in records.iter().zip(shares(records)) {
        assert!(shares.iter().all(|share| *share < 1.02), "{record:?}");
    }
}

#[test]
fn a_tool_that_turns_back_has_no_kink() {
    let turns = [8.0, -8.0, 8.0, -8.0].map(|turn| ([0.0, 60.0, 0.0, turn, 0.0, 0.0], VelocityProfile::S));
    assert_within(&record(&turns, 20.0, None));
}

#[test]
fn what_a_motion_without_limits_of_jerk_leaves_is_not_that_of_the_next_one() {
    let offsets =
        [([0.0, 60.0, 0.0, 0.0, 0.0, 0.0], VelocityProfile::T), ([0.0, 0.0, -60.0, 0.0, 0.0, 0.0], VelocityProfile::S)];
    assert_within(&record(&offsets, -1.0, None));
}

#[test]
fn a_fast_stop_is_measured_by_its_own_limits() {
    let offset = [([0.0, 300.0, 0.0, 0.0, 0.0, 0.0], VelocityProfile::S)];
    let records = record(&offset, -1.0, Some((300, Stop::Fast)));
    assert_within(&records);
    // It is no stop at all where nothing uses its limits.
    assert!(shares(&records)[0][2] > 0.9, "{records:?}");
}

#[test]
fn external_axes_that_move_alone_have_their_own_speed() {
    let robot = with_external_axes("kr10-r1420");
    let start = Joints { axes: [0.0, -90.0, 90.0, 0.0, 45.0, 0.0], external: [0.0, 0.0, UNSET, UNSET, UNSET, UNSET] };
    let pose = frame_components(&robot.kinematics.forward(&start.axes));
    for (turning, linear, unit, programmed) in
        [(90.0, 0.0, "deg/s", 60.0), (0.0, 400.0, "mm/s", 250.0), (90.0, 300.0, "deg/s", 60.0)]
    {
        let mut queue = Queue::repeatable(robot.clone(), start);
        let mut recorder = Recorder::new(robot.clone(), &mut queue);
        let external = [turning, linear, UNSET, UNSET, UNSET, UNSET];
        let target = Target::Line { pose, wobj: Frame::identity(), external };
        let command = Command { target, speed: Speed { exj: 60.0, exl: 250.0, ..fast() }, ..lin(pose) };
        let number = queue.add(&command, &Settings::default()).unwrap();
        recorder.planned(&mut queue, number, &command, &Settings::default());
        while !queue.idle() {
            let step = queue.step(Cycle::MS, Override::FULL);
            recorder.step(&mut queue, &step);
        }
        let [record] = recorder.records() else { panic!("one motion") };
        assert_eq!((record.programmed.value, record.programmed.unit), (programmed, unit));
        assert!((record.reached / programmed - 1.0).abs() < 0.01, "{record:?}");
    }
}

#[test]
fn a_gate_that_was_looked_at_from_above_has_one_record() {
    let robot = robot("hsr065");
    let at = |[j1, j2, j3, j4]: [f64; 4]| axes([j1, j2, j3, j4, 0.0, 0.0]);
    let (from, to) = (at([-40.0, 60.0, 0.0, 10.0]), at([50.0, 70.0, 20.0, -90.0]));
    let pose = frame_components(&robot.kinematics.forward(&to.axes));
    let wanted = Wanted { cfg: Some(robot.kinematics.cfg(&to.axes)), turn: -1 };
    let gate = |part: GatePart| {
        let (rising, falling) = (Lift::default(), Lift::default());
        let gate = Gate { rise: 25.0, sink: 25.0, highest: None, rising, falling, smooth: false, part };
        command(Target::Gate { pose, wobj: Frame::identity(), wanted, external: to.external, gate })
    };
    let mut queue = Queue::repeatable(robot.clone(), from);
    let mut recorder = Recorder::new(robot.clone(), &mut queue);
    let mut steps = 0;
    let back = Command { line: 8, ..command(Target::Joints(from)) };
    for command in [gate(GatePart::Above), gate(GatePart::Rest), gate(GatePart::Above), back] {
        let number = queue.add(&command, &Settings::default()).unwrap();
        recorder.planned(&mut queue, number, &command, &Settings::default());
        while !queue.idle() {
            let step = queue.step(Cycle::MS, Override::FULL);
            recorder.step(&mut queue, &step);
            steps += u32::from(step.motion != 0);
        }
    }
    let records = recorder.records();
    assert_eq!(records.iter().map(|record| (record.number, record.line)).collect::<Vec<_>>(), [(1, 7), (3, 7), (4, 8)]);
    // Up and over and down again, as far as all of it.
    assert!((records[0].path_length - records[1].path_length).abs() > 50.0, "{records:?}");
    let whole: f64 = records.iter().map(|record| record.duration).sum();
    assert!((whole - f64::from(steps) * CYCLE).abs() < 1e-9);
}
