//! Whole motions from the trace: limits, targets, durations.

use crate::tests::*;

#[test]
fn axis_motions_use_the_limits_and_never_break_them() {
    let mut random = Random::new(31);
    for name in ["kr10-r1420", "tx2-60", "hsr065", "cobra600"] {
        let robot = with_external_axes(name);
        for _ in 0..12 {
            let mut queue = Queue::repeatable(robot.clone(), random_joints(&robot, &mut random, 1.0));
            let mut targets = Vec::new();
            for _ in 0..3 {
                let target = random_joints(&robot, &mut random, 1.0);
                let speed = Speed { percent: random.between(20.0, 100.0), ..fast() };
                let command = Command { speed, ..command(Target::Joints(target)) };
                queue.add(&command, &Settings::default()).unwrap();
                targets.push(target);
            }
            let rows = run(&mut queue, 100.0);
            assert_within_limits(&robot, &rows, name);
            for (target, motion) in targets.iter().zip(1..) {
                let last = rows.iter().rev().find(|row| row.motion == motion).unwrap();
                assert_eq!(values(&robot, &last.joints), values(&robot, target), "reached exactly");
                assert!(last.finished == motion && last.line == 7);
            }
        }
    }
}

#[test]
fn a_full_speed_axis_motion_reaches_its_limits() {
    let robot = robot("kr10-r1420");
    let mut queue = Queue::repeatable(robot.clone(), axes([-100.0, -90.0, 90.0, 0.0, 30.0, 0.0]));
    queue.add(&movej([100.0, -90.0, 90.0, 0.0, 30.0, 0.0]), &Settings::default()).unwrap();
    let rows = run(&mut queue, 100.0);
    let used = usage(&robot, &rows);
    assert!(used.iter().all(|used| (0.99..1.001).contains(used)), "{used:?}");
    // 200 deg at 220 deg/s, and one ramp of 1/5 s + 5/60 s.
    let expected: f64 = 200.0 / 220.0 + 0.2 + 5.0 / 60.0;
    assert!((rows.len() as f64 * CYCLE - expected).abs() < 0.003, "{} rows", rows.len());
}

/// A line that can be moved, its start, and its target in the base.
fn random_line(robot: &Robot, random: &mut Random) -> (Joints, Joints, Command, Frame) {
    let start = random_joints(robot, random, 0.7);
    let goal = random_joints(robot, random, 0.7);
    let mut tool =
        frame([random.between(-50.0, 50.0), 20.0, random.between(0.0, 200.0), 10.0, random.between(-90.0, 90.0), 5.0]);
    if random.between(0.0, 1.0) < 0.3 {
        tool = Frame::identity();
    }
    let wobj = frame([random.between(-500.0, 500.0), 100.0, 50.0, random.between(-180.0, 180.0), 10.0, 20.0]);
    // Somewhere on the way to a random pose, so that short lines come up, too.
    let from = robot.kinematics.forward(&start.axes) * tool;
    let to = robot.kinematics.forward(&goal.axes) * tool;
    let share = random.between(0.01, 1.0);
    let rotation = from.rotation.slerp(&to.rotation, share * random.between(0.0, 1.0));
    let position = from.translation.vector.lerp(&to.translation.vector, share);
    let target = Frame::from_parts(position.into(), rotation);
    let pose = frame_components(&(wobj.inverse() * target));
    let line = Target::Line { pose, wobj, external: goal.external };
    (start, goal, Command { rig: Rig::with_tool(tool), ..command(line) }, target)
}

#[test]
fn lines_are_straight_and_within_all_limits() {
    let mut random = Random::new(32);
    for name in ["kr10-r1420", "kr6-r700", "irb2400-10", "tx2-60", "six-10"] {
        let robot = with_external_axes(name);
        let (mut planned, mut tried) = (0, 0);
        while planned < 15 {
            tried += 1;
            let (start, goal, mut command, target) = random_line(&robot, &mut random);
            let mut queue = Queue::repeatable(robot.clone(), start);
            command.speed = Speed { tcp: random.between(50.0, 2500.0), ori: random.between(50.0, 500.0), ..fast() };
            if queue.add(&command, &Settings::default()).is_err() {
                continue;
            }
            planned += 1;
            let from = command.rig.tcp_at(&robot.kinematics.forward(&start.axes));
            let rows = run(&mut queue, 100.0);
            assert_within_limits(&robot, &rows, name);
            assert_tcp_limits(&robot, &rows, &command.speed);
            for row in rows.iter().skip(1) {
                let (off, turned) = off_line(&from, &target, &row.tcp);
                assert!(off < 1e-6 && turned < 1e-8, "{name}: {off} mm, {turned} rad off the line");
            }
            let last = rows.last().unwrap();
            let (off, turned) =
                (last.tcp.translation.vector - target.translation.vector, last.tcp.rotation.angle_to(&target.rotation));
            assert!(off.norm() < 1e-6 && turned < 1e-9);
            assert_eq!(last.joints.external[..2], goal.external[..2]);
            assert_eq!(robot.kinematics.cfg(&last.joints.axes), robot.kinematics.cfg(&start.axes), "cfg is kept");
        }
        assert!(tried < 15 * 12, "{name}: of {tried} random lines only {planned} could be planned");
    }
}

/// The TCP's speed, acceleration and jerk, from the trace.
fn assert_tcp_limits(robot: &Robot, rows: &[Step], speed: &Speed) {
    let tcp = &robot.tcp;
    let mut series: Vec<_> = rows.iter().skip(1).map(|row| row.tcp.translation.vector).collect();
    for most in [speed.tcp.min(tcp.vel), tcp.acc, tcp.jerk] {
        series = series.windows(2).map(|pair| (pair[1] - pair[0]) / CYCLE).collect();
        let highest = series.iter().fold(0.0_f64, |most, value| most.max(value.norm()));
        assert!(highest <= 1.01 * most + 1e-3, "{highest} of {most}");
    }
    for pair in rows.windows(2).skip(1) {
        let turn = pair[0].tcp.rotation.angle_to(&pair[1].tcp.rotation).to_degrees() / CYCLE;
        assert!(turn <= 1.01 * speed.ori.min(tcp.ori_vel) + 1e-3, "{turn} deg/s");
    }
}

#[test]
fn a_line_takes_its_programmed_speed() {
    let robot = robot("kr10-r1420");
    let start = axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let at = frame_components(&robot.kinematics.forward(&start.axes));
    let mut queue = Queue::repeatable(robot.clone(), start);
    let speed = Speed { tcp: 400.0, ..fast() };
    let mut pose = at;
    pose[1] += 300.0;
    queue.add(&Command { speed, ..lin(pose) }, &Settings::default()).unwrap();
    let rows = run(&mut queue, 100.0);
    let speeds = rows
        .windows(2)
        .skip(1)
        .map(|pair| (pair[1].tcp.translation.vector - pair[0].tcp.translation.vector).norm() / CYCLE);
    let highest = speeds.fold(0.0, f64::max);
    assert!(highest > 399.6 && highest < 400.04, "{highest}");
}

#[test]
fn many_motions_join_without_a_jolt() {
    let mut random = Random::new(33);
    let robot = robot("kr10-r1420");
    let mut queue = Queue::repeatable(robot.clone(), axes([0.0, -90.0, 90.0, 10.0, 60.0, 0.0]));
    let mut added = 0;
    while queue.has_room() {
        let end = *queue.end();
        let mut pose = frame_components(&robot.kinematics.forward(&end.axes));
        pose[0] += random.between(-100.0, 100.0);
        pose[1] += random.between(-100.0, 100.0);
        pose[2] += random.between(-100.0, 100.0);
        let cfg = robot.kinematics.cfg(&end.axes);
        let command = if added % 2 == 0 { lin(pose) } else { ptp(pose, cfg) };
        if queue.add(&Command { line: added + 1, ..command }, &Settings::default()).is_ok() {
            added += 1;
        }
    }
    assert_eq!(added as usize, LOOK_AHEAD);
    assert_eq!(queue.add(&movej([0.0; 6]), &Settings::default()), Err(PlanError::Full));
    let rows = run(&mut queue, 100.0);
    assert_within_limits(&robot, &rows, "a long queue");
    let lines: Vec<u32> = rows.iter().skip(1).map(|row| row.line).collect();
    assert!(lines.windows(2).all(|pair| pair[1] == pair[0] || pair[1] == pair[0] + 1));
    assert_eq!(lines.last(), Some(&added));
    // Every motion has a row in which it stands at its end.
    assert_eq!(rows.iter().filter(|row| row.rests && row.motion > 0).count() as u32, added);
}

#[test]
fn manual_mode_limits_the_tcp_on_every_motion() {
    let mut random = Random::new(34);
    let settings = Settings { manual: true, ..Settings::default() };
    for name in ["kr10-r1420", "hsr065"] {
        let robot = robot(name);
        for _ in 0..20 {
            let mut queue = Queue::repeatable(robot.clone(), random_joints(&robot, &mut random, 0.8));
            let tool = frame([50.0, 0.0, 250.0, 0.0, 30.0, 0.0]);
            let target = random_joints(&robot, &mut random, 0.8);
            queue.add(&Command { rig: Rig::with_tool(tool), ..command(Target::Joints(target)) }, &settings).unwrap();
            let rows = run(&mut queue, 100.0);
            let speeds = rows
                .windows(2)
                .skip(1)
                .map(|pair| (pair[1].tcp.translation.vector - pair[0].tcp.translation.vector).norm() / CYCLE);
            let highest = speeds.fold(0.0, f64::max);
            assert!(highest < 252.5 && highest > 200.0, "{name}: {highest} mm/s");
        }
    }
    let robot = robot("kr10-r1420");
    let mut queue = Queue::repeatable(robot, axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]));
    let pose = [UNSET, 400.0, UNSET, UNSET, UNSET, UNSET];
    queue.add(&lin(pose), &settings).unwrap();
    let rows = run(&mut queue, 100.0);
    let speeds = rows
        .windows(2)
        .skip(1)
        .map(|pair| (pair[1].tcp.translation.vector - pair[0].tcp.translation.vector).norm() / CYCLE);
    let highest = speeds.fold(0.0, f64::max);
    assert!(highest > 249.7 && highest < 250.03, "{highest}");
}
