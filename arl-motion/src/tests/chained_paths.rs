//! Motions that make one path with their neighbours: ccir and spl.

use nalgebra::Vector3;

use crate::tests::*;

fn at_work() -> Joints {
    axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0])
}

fn ccir(pose: [f64; 6]) -> Command {
    command(Target::Circle { pose, wobj: Frame::identity(), follow: false, external: [UNSET; 6] })
}

fn spl(pose: [f64; 6]) -> Command {
    command(Target::Spline { pose, wobj: Frame::identity(), external: [UNSET; 6] })
}

/// The pose so far away from where the flange is at work.
fn beside(robot: &Robot, [x, y, z]: [f64; 3]) -> [f64; 6] {
    let mut pose = frame_components(&robot.kinematics.forward(&at_work().axes));
    (pose[0], pose[1], pose[2]) = (pose[0] + x, pose[1] + y, pose[2] + z);
    pose
}

fn place(row: &Step) -> Vector3<f64> {
    row.tcp.translation.vector
}

/// How near the trace comes to a point, in mm, between its rows, too.
fn nearest(rows: &[Step], point: &Vector3<f64>) -> f64 {
    let off = |pair: &[Step]| {
        let (a, b) = (place(&pair[0]), place(&pair[1]));
        let along = ((point - a).dot(&(b - a)) / (b - a).norm_squared().max(1e-12)).clamp(0.0, 1.0);
        (a + (b - a) * along - point).norm()
    };
    rows.windows(2).map(off).fold(f64::INFINITY, f64::min)
}

fn point(pose: &[f64; 6]) -> Vector3<f64> {
    Vector3::new(pose[0], pose[1], pose[2])
}

#[test]
fn ccir_goes_along_the_circles_of_its_neighbours() {
    let robot = robot("kr10-r1420");
    // A quarter, a quarter and half of one circle, then a fifth point off it.
    let centre = Vector3::from_column_slice(&beside(&robot, [0.0, 100.0, 0.0])[..3]);
    let on = |degrees: f64| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        beside(&robot, [0.0, 100.0 - 100.0 * cosine, 100.0 * sine])
    };
    let poses = [on(90.0), on(180.0), on(300.0)];
    for zone in [-1.0, 10.0] {
        let mut queue = Queue::repeatable(robot.clone(), at_work());
        for (line, pose) in poses.iter().enumerate() {
            let speed = Speed { tcp: 300.0, ..fast() };
            let zone = Zone { tcp: zone, ..Zone::NONE };
            let number =
                queue.add(&Command { line: line as u32 + 1, zone, speed, ..ccir(*pose) }, &Settings::default());
            assert_eq!(number, Ok(line as u64 + 1));
        }
        queue.conclude().unwrap();
        let rows = run(&mut queue, 100.0);
        assert_within_limits(&robot, &rows, "ccir");
        for row in &rows {
            assert!(((place(row) - centre).norm() - 100.0).abs() < 1e-3, "{} {zone}", (place(row) - centre).norm());
        }
        for pose in &poses {
            assert!(nearest(&rows, &point(pose)) < 2e-3, "{} {zone}", nearest(&rows, &point(pose)));
        }
        assert!((place(rows.last().unwrap()) - point(&poses[2])).norm() < 1e-6);
        assert_eq!(rows.last().unwrap().finished, 3);
        let rests = rows[2..rows.len() - 1].iter().filter(|row| row.rests).count();
        assert_eq!(rests, if zone > 0.0 { 0 } else { 2 });
    }
}

#[test]
fn each_ccir_but_the_last_looks_at_the_next() {
    let robot = robot("kr10-r1420");
    let points = [[0.0, 50.0, 50.0], [0.0, 100.0, 0.0], [0.0, 200.0, 30.0], [0.0, 250.0, -50.0]];
    let poses = points.map(|offset| beside(&robot, offset));
    let mut queue = Queue::repeatable(robot.clone(), at_work());
    for (line, pose) in poses.iter().enumerate() {
        queue.add(&Command { line: line as u32 + 1, ..ccir(*pose) }, &Settings::default()).unwrap();
    }
    // Another kind of motion ends the chain.
    queue.add(&lin(beside(&robot, [0.0, 250.0, 0.0])), &Settings::default()).unwrap();
    let rows = run(&mut queue, 100.0);
    assert_within_limits(&robot, &rows, "ccir");
    let start = point(&beside(&robot, [0.0; 3]));
    let all: Vec<Vector3<f64>> = [start].into_iter().chain(poses.iter().map(point)).collect();
    let circle = |a: usize| {
        let track = crate::geometry::track::Track::Arc(
            crate::geometry::arc::arc_through(&[all[a], all[a + 1], all[a + 2]]).unwrap(),
        );
        let track_points: Vec<Vector3<f64>> = (0..=2000).map(|step| track.at(f64::from(step) / 2000.0)).collect();
        track_points
    };
    for (line, on) in [(1, 0), (2, 1), (3, 2), (4, 2)] {
        let circle = circle(on);
        for row in rows.iter().filter(|row| row.line == line) {
            let off = circle.iter().map(|point| (point - place(row)).norm()).fold(f64::INFINITY, f64::min);
            assert!(off < 0.2, "ccir {line}: {off} mm");
        }
    }
}

#[test]
fn a_ccir_needs_a_second_one_and_three_points_off_a_line() {
    let robot = robot("kr10-r1420");
    let earlier = |line: u32, error: PlanError| Err(PlanError::Earlier { line, error: Box::new(error) });
    let mut queue = Queue::repeatable(robot.clone(), at_work());
    queue.add(&ccir(beside(&robot, [0.0, 50.0, 0.0])), &Settings::default()).unwrap();
    assert!(!queue.idle());
    for _ in 0..500 {
        assert!(queue.step(Cycle::MS, Override::FULL).rests, "it waits for the second one");
    }
    assert_eq!(queue.conclude(), earlier(7, PlanError::LoneCircle));
    // On a line, and one point twice.
    for second in [[0.0, 100.0, 0.0], [0.0, 50.0, 0.0]] {
        let mut queue = Queue::repeatable(robot.clone(), at_work());
        queue.add(&ccir(beside(&robot, [0.0, 50.0, 0.0])), &Settings::default()).unwrap();
        let found = queue.add(&ccir(beside(&robot, second)), &Settings::default());
        assert_eq!(found.map(|_| ()), earlier(7, PlanError::NoCircle));
    }
}

/// Points of a smooth spatial curve, with turning.
fn bends(robot: &Robot, count: u32) -> Vec<[f64; 6]> {
    let bend = |index: u32| {
        let turn = f64::from(index) * 0.7;
        let mut pose = beside(robot, [40.0 * turn.sin(), 60.0 * f64::from(index), 50.0 * (1.3 * turn).cos() - 50.0]);
        pose[3] += 12.0 * turn.sin();
        pose[4] += 9.0 * (0.5 * turn).sin();
        pose
    };
    (1..=count).map(bend).collect()
}

#[test]
fn a_spline_passes_all_its_points_without_a_stop() {
    for (name, tcp) in [("kr10-r1420", 150.0), ("kr10-r1420", 1e4), ("irb2400-10", 400.0), ("tx2-60", 120.0)] {
        let robot = with_external_axes(name);
        let start = Joints { external: [10.0, -20.0, UNSET, UNSET, UNSET, UNSET], ..at_work() };
        let start =
            if name == "kr10-r1420" { start } else { Joints { axes: [-30.0, 10.0, 30.0, 0.0, 45.0, 0.0], ..start } };
        let mut queue = Queue::repeatable(robot.clone(), start);
        let origin = point(&beside(&robot, [0.0; 3]));
        let here = robot.kinematics.forward(&start.axes).translation.vector;
        let mut poses = bends(&robot, 6);
        for pose in &mut poses {
            for axis in 0..3 {
                pose[axis] = here[axis] + (pose[axis] - origin[axis]) * if name == "kr10-r1420" { 1.0 } else { 0.3 };
            }
            let angles = frame_components(&robot.kinematics.forward(&start.axes));
            let base = beside(&robot, [0.0; 3]);
            for axis in 3..6 {
                pose[axis] += angles[axis] - base[axis];
            }
        }
        let mut settings = Settings::default();
        for (index, pose) in poses.iter().enumerate() {
            let external = [10.0 + 5.0 * index as f64, (index * index) as f64, UNSET, UNSET, UNSET, UNSET];
            let target = Target::Spline { pose: *pose, wobj: Frame::identity(), external };
            let speed = Speed { tcp, ..fast() };
            queue.add(&Command { speed, line: index as u32 + 1, ..command(target) }, &settings).unwrap();
            settings.acc_percent = if index == 3 { 60.0 } else { 100.0 };
        }
        queue.conclude().unwrap();
        let rows = run(&mut queue, 100.0);
        assert_within_limits(&robot, &rows, name);
        for pose in &poses {
            let off = nearest(&rows, &point(pose));
            assert!(off < 0.02, "{name}: {off} mm beside a point");
        }
        let inner = &rows[2..rows.len() - 1];
        assert!(inner.iter().all(|row| !row.rests), "{name}: it stopped on the way");
        let last = rows.last().unwrap();
        assert!((place(last) - point(&poses[5])).norm() < 1e-6);
        assert!(last.tcp.rotation.angle_to(&frame(poses[5]).rotation) < 1e-9);
        assert_eq!(last.joints.external[..2], [35.0, 25.0]);
        let speeds: Vec<f64> =
            rows.windows(2).skip(1).map(|pair| (place(&pair[1]) - place(&pair[0])).norm() / CYCLE).collect();
        let fastest = speeds.iter().fold(0.0_f64, |most, speed| most.max(*speed));
        assert!(fastest <= tcp * 1.01, "{name}: {fastest}");
        if tcp < 200.0 && name == "kr10-r1420" {
            let even = speeds.iter().filter(|speed| **speed > 0.97 * tcp).count();
            assert!(even * 10 > speeds.len() * 7, "{name}: {even} of {} at the speed", speeds.len());
        }
    }
}

#[test]
fn a_spline_through_points_on_a_line_is_a_line() {
    let robot = robot("kr10-r1420");
    let mut queue = Queue::repeatable(robot.clone(), at_work());
    for y in [20.0, 90.0, 95.0, 250.0] {
        queue
            .add(
                &Command { speed: Speed { tcp: 200.0, ..fast() }, ..spl(beside(&robot, [0.0, y, 0.0])) },
                &Settings::default(),
            )
            .unwrap();
    }
    queue.conclude().unwrap();
    let rows = run(&mut queue, 100.0);
    assert_within_limits(&robot, &rows, "line");
    let (from, to) = (beside(&robot, [0.0; 3]), beside(&robot, [0.0, 250.0, 0.0]));
    for row in &rows {
        let (off, turned) = off_line(&frame(from), &frame(to), &row.tcp);
        assert!(off < 1e-6 && turned < 1e-8, "{off} {turned}");
    }
    assert!(rows[2..rows.len() - 1].iter().all(|row| !row.rests));
}

#[test]
fn the_path_of_a_spline_does_not_depend_on_when_its_motions_come() {
    let robot = robot("kr10-r1420");
    let poses = bends(&robot, 6);
    let slow = |pose: &[f64; 6]| Command { speed: Speed { tcp: 250.0, ..fast() }, ..spl(*pose) };
    let reference = {
        let mut queue = Queue::repeatable(robot.clone(), at_work());
        for pose in &poses {
            queue.add(&slow(pose), &Settings::default()).unwrap();
        }
        queue.conclude().unwrap();
        run(&mut queue, 100.0)
    };
    // Late, but before the robot has stood still for long.
    for pause in [40, 180, 260, 330] {
        let mut queue = Queue::repeatable(robot.clone(), at_work());
        let mut rows = vec![reference[0]];
        for (index, pose) in poses.iter().enumerate() {
            queue.add(&slow(pose), &Settings::default()).unwrap();
            for _ in 0..if index > 0 { pause } else { 0 } {
                rows.push(queue.step(Cycle::MS, Override::FULL));
            }
        }
        queue.conclude().unwrap();
        while !queue.idle() {
            rows.push(queue.step(Cycle::MS, Override::FULL));
        }
        assert_within_limits(&robot, &rows, "late");
        for row in rows.iter().step_by(7) {
            let off = nearest(&reference, &place(row));
            assert!(off < 0.01, "pause {pause}: {off} mm off the way");
        }
        assert_eq!(rows.last().unwrap().joints, reference.last().unwrap().joints);
    }
}

#[test]
fn a_motion_of_a_spline_that_comes_much_too_late_begins_a_new_one() {
    let robot = robot("kr10-r1420");
    let poses = bends(&robot, 4);
    let mut queue = Queue::repeatable(robot.clone(), at_work());
    let mut rows = vec![queue.step(Cycle::MS, Override::FULL)];
    for pose in &poses {
        queue.add(&spl(*pose), &Settings::default()).unwrap();
        for _ in 0..2000 {
            rows.push(queue.step(Cycle::MS, Override::FULL));
        }
        assert!(queue.idle() && queue.take_broken().is_none());
        assert!((place(rows.last().unwrap()) - point(pose)).norm() < 1e-6);
    }
    assert_within_limits(&robot, &rows, "single");
    // One by one they are lines.
    let from = frame(beside(&robot, [0.0; 3]));
    let first = frame(poses[0]);
    assert!(rows.iter().filter(|row| row.motion == 1).all(|row| off_line(&from, &first, &row.tcp).0 < 1e-6));
}

#[test]
fn splines_and_circles_round_off_into_their_neighbours() {
    let mut random = Random::new(53);
    for profile in [VelocityProfile::S, VelocityProfile::T] {
        let robot = with_external_axes("kr10-r1420");
        let settings = Settings { profile, ..Settings::default() };
        for round in 0..8 {
            let start = Joints { external: [0.0, 0.0, UNSET, UNSET, UNSET, UNSET], ..at_work() };
            let mut queue = Queue::repeatable(robot.clone(), start);
            let (mut added, mut tried) = (0_u32, 0);
            let mut kind = 0;
            while added < 14 && tried < 300 {
                tried += 1;
                if random.between(0.0, 1.0) < 0.4 {
                    kind = random.between(0.0, 4.0) as u32;
                }
                let external = [random.between(-30.0, 30.0), random.between(-50.0, 50.0), UNSET, UNSET, UNSET, UNSET];
                let mut pose = beside(&robot, [0, 1, 2].map(|_| random.between(-120.0, 120.0)));
                for turn in &mut pose[3..] {
                    *turn += random.between(-15.0, 15.0);
                }
                let wobj = Frame::identity();
                let target = match kind {
                    0 => Target::Line { pose, wobj, external },
                    1 => Target::Pose { pose, wobj, wanted: Wanted { cfg: None, turn: -1 }, external },
                    // A pair at least.
                    2 => Target::Circle { pose, wobj, follow: false, external },
                    _ => Target::Spline { pose, wobj, external },
                };
                let size = random.between(2.0, 40.0);
                let zone = match random.between(0.0, 3.0) as u32 {
                    0 => Zone::NONE,
                    1 => Zone { percent: size, ..Zone::NONE },
                    _ => Zone { tcp: size, joint: size / 3.0, ori: size, turning: 5.0, linear: 20.0, ..Zone::NONE },
                };
                let speed = Speed { tcp: random.between(50.0, 1500.0), percent: random.between(10.0, 100.0), ..fast() };
                match queue.add(&Command { target, zone, speed, ..movej([0.0; 6]) }, &settings) {
                    Ok(_) => added += 1,
                    Err(PlanError::Earlier { error, .. }) => assert_eq!(*error, PlanError::LoneCircle),
                    Err(error) => panic!("{error}"),
                }
            }
            let _ = queue.conclude();
            let end = *queue.end();
            let rows = run(&mut queue, 100.0);
            let [vel, acc, jerk] = usage(&robot, &rows);
            assert!(vel <= 1.01, "{profile:?} {round}: {vel}");
            // T limits no jerk, and at speed its blends take what the axes' accelerations change by within a cycle.
            let limited = profile == VelocityProfile::S;
            assert!(!limited || (acc <= 1.01 && jerk <= 1.01), "{round}: {acc} {jerk}");
            assert_eq!(values(&robot, &rows.last().unwrap().joints), values(&robot, &end), "{round}");
        }
    }
}

#[test]
fn splines_turn_back_at_any_angle() {
    let robot = robot("kr10-r1420");
    for (far, near) in [(60.0, 60.0), (90.0, 30.0), (30.0, 90.0)] {
        for angle in [120.0, 135.0, 145.0, 149.9, 150.1, 165.0, 175.0, 178.0, 180.0_f64] {
            let (sine, cosine) = angle.to_radians().sin_cos();
            let mut queue = Queue::repeatable(robot.clone(), at_work());
            for place in [[0.0, far, 0.0], [0.0, far + near * cosine, near * sine], [50.0, 0.0, 40.0]] {
                let command = spl(beside(&robot, place));
                queue.add(&command, &Settings::default()).unwrap_or_else(|error| panic!("{angle} {far}: {error}"));
            }
            let rows = run(&mut queue, 100.0);
            let what = format!("{angle} {far} {near}");
            assert_within_limits(&robot, &rows, &what);
            // It goes exactly through the point, with a stop where it turns back, and hardly beyond it.
            let at = Vector3::from(<[f64; 3]>::try_from(&beside(&robot, [0.0, far, 0.0])[..3]).unwrap());
            let nearest = rows.iter().map(|row| (place(row) - at).norm()).fold(f64::INFINITY, f64::min);
            assert!(nearest < 0.5, "{what}: {nearest}");
            let stop = rows[1..rows.len() - 1].iter().any(|row| row.rests && row.finished == 1);
            assert_eq!(stop, angle > 150.0, "{what}");
        }
    }
}
