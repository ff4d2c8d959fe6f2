//! Weaves: their figures beside the path, their speed, their limits.

use crate::tests::*;
use nalgebra::Vector3;

fn weave(shape: WeaveShape) -> Weave {
    Weave {
        shape,
        frequency: 2.0,
        amplitude: 5.0,
        dwells: [0.0; 3],
        angle: 60.0,
        radius: 2.0,
        turned: Vector3::zeros(),
    }
}

fn woven(weave: Weave) -> Settings {
    Settings { weave: Some(weave), ..Settings::default() }
}

const SHAPES: [WeaveShape; 5] =
    [WeaveShape::Simple, WeaveShape::VShape, WeaveShape::Triangle, WeaveShape::Ellipse, WeaveShape::Eight];

/// A stance whose tool points down.
fn above() -> Joints {
    axes([0.0, -90.0, 90.0, 0.0, 90.0, 0.0])
}

/// A queue, and the pose in which its robot stands.
fn queue(robot: &Arc<Robot>) -> (Queue, [f64; 6]) {
    let pose = frame_components(&robot.kinematics.forward(&above().axes));
    (Queue::repeatable(robot.clone(), above()), pose)
}

/// A line from `pose` by x, y, z mm.
fn line(pose: &mut [f64; 6], by: [f64; 3], tcp: f64) -> Command {
    for (value, by) in pose.iter_mut().zip(by) {
        *value += by;
    }
    Command { speed: Speed { tcp, ..fast() }, ..lin(*pose) }
}

/// The TCP's offsets from the line through two points: along, to the left, up.
fn offsets(rows: &[Step], from: &[f64; 6], to: &[f64; 6]) -> Vec<Vector3<f64>> {
    let place = |pose: &[f64; 6]| Vector3::new(pose[0], pose[1], pose[2]);
    let x = (place(to) - place(from)).normalize();
    let z = Vector3::z();
    let y = z.cross(&x);
    let offset = |row: &Step| {
        let here = row.tcp.translation.vector - place(from);
        Vector3::new(here.dot(&x), here.dot(&y), here.dot(&z))
    };
    rows.iter().map(offset).collect()
}

#[test]
fn a_weave_that_cannot_be_followed_is_not_taken_for_a_singular_point() {
    let robot = robot("kr10-r1420");
    for (frequency, amplitude) in [(1e5, 5.0), (1e9, 5.0), (2.0, 1e6)] {
        let (mut queue, mut to) = queue(&robot);
        let settings = woven(Weave { frequency, amplitude, ..weave(WeaveShape::Simple) });
        match queue.add(&line(&mut to, [0.0, 300.0, 0.0], 100.0), &settings) {
            Err(PlanError::TooDense { along }) => assert!(along < 0.1, "{along}"),
            other => panic!("{frequency} {amplitude}: {other:?}"),
        }
    }
    let words = PlanError::TooDense { along: 0.5 }.to_string();
    assert!(words.contains("50.0 % along the path: take a lower frequency"), "{words}");
}

#[test]
fn a_duration_beyond_all_measure_is_not_written_out() {
    let words = PlanError::NoSpeed { what: "the duration in s", value: 1e300 }.to_string();
    assert_eq!(words, "the duration in s is 1e300, which is too much");
}

#[test]
fn weaves_are_as_wide_and_as_long_as_asked_and_begin_and_end_on_the_path() {
    let robot = robot("kr10-r1420");
    for shape in SHAPES {
        let (mut queue, mut to) = queue(&robot);
        let from = to;
        queue.add(&line(&mut to, [0.0, 300.0, 0.0], 50.0), &woven(weave(shape))).unwrap();
        let rows = run(&mut queue, 100.0);
        assert_eq!(queue.take_slowed().0, 1.0, "{shape:?}");
        assert_within_limits(&robot, &rows, &format!("{shape:?}"));
        let off = offsets(&rows, &from, &to);
        let widest = off.iter().map(|at| at.yz().norm()).fold(0.0, f64::max);
        assert!((widest - 5.0).abs() < 0.01, "{shape:?}: {widest}");
        assert!((off.last().unwrap() - Vector3::new(300.0, 0.0, 0.0)).norm() < 1e-6);
        // 50 mm/s at 2 Hz: 25 mm a figure. Where the left side is left repeats so.
        let crossings: Vec<f64> = off
            .windows(2)
            .filter(|pair| pair[0].y > 2.0 && pair[1].y <= 2.0)
            .map(|pair| (pair[0].x + pair[1].x) / 2.0)
            .collect();
        let inner = &crossings[1..crossings.len() - 1];
        assert!(crossings.len() >= 11, "{shape:?}: {}", crossings.len());
        for pair in inner.windows(2) {
            assert!((pair[1] - pair[0] - 25.0).abs() < 0.1, "{shape:?}: {pair:?}");
        }
        let (lowest, highest) = off.iter().fold((0.0_f64, 0.0_f64), |(low, high), at| (low.min(at.z), high.max(at.z)));
        match shape {
            // The sides of the V go up, away from what the tool points at, 30 deg to either side.
            WeaveShape::VShape | WeaveShape::Triangle => {
                // Rounding moves the farthest place of the triangle's blunter corners a little.
                let slack = if shape == WeaveShape::VShape { 0.05 } else { 0.4 };
                assert!(lowest > -0.1 && (highest - 5.0 * 30.0_f64.to_radians().cos()).abs() < slack, "{shape:?}");
                let (left, right) = off.iter().fold((0.0_f64, 0.0_f64), |(l, r), at| (l.max(at.y), r.min(at.y)));
                assert!((left - 2.5).abs() < slack && (right + 2.5).abs() < slack, "{shape:?}: {left} {right}");
            }
            _ => assert!(lowest > -1e-6 && highest < 1e-6, "{shape:?}: {lowest} {highest}"),
        }
    }
}

#[test]
fn the_plane_turns_about_the_axis_that_is_named() {
    let robot = robot("kr10-r1420");
    let ranges = |turned: Vector3<f64>| {
        let (mut queue, mut to) = queue(&robot);
        let from = to;
        queue
            .add(&line(&mut to, [0.0, 200.0, 0.0], 50.0), &woven(Weave { turned, ..weave(WeaveShape::Simple) }))
            .unwrap();
        let off = offsets(&run(&mut queue, 100.0), &from, &to);
        (off.iter().map(|at| at.y).fold(0.0, f64::max), off.iter().map(|at| at.z).fold(0.0, f64::max))
    };
    let angle = 30.0_f64.to_radians();
    let (y, z) = ranges(Vector3::x() * angle);
    assert!((y - 5.0 * angle.cos()).abs() < 0.01 && (z - 5.0 * angle.sin()).abs() < 0.01, "{y} {z}");
    let (y, z) = ranges(Vector3::y() * angle);
    assert!((y - 5.0).abs() < 0.01 && z < 1e-6, "{y} {z}");
    let (y, z) = ranges(Vector3::z() * angle);
    assert!((y - 5.0 * angle.cos()).abs() < 0.01 && z < 1e-6, "{y} {z}");
}

#[test]
fn the_override_and_stops_change_no_point_of_a_weave() {
    let robot = robot("kr10-r1420");
    let path = |drive: &mut dyn FnMut(&mut Queue, usize) -> Step| {
        let (mut queue, mut to) = queue(&robot);
        let from = to;
        queue.add(&line(&mut to, [0.0, 120.0, 0.0], 60.0), &woven(weave(WeaveShape::Simple))).unwrap();
        let mut rows = Vec::new();
        while !queue.idle() {
            rows.push(drive(&mut queue, rows.len()));
            assert!(rows.len() < 100_000);
        }
        assert_within_limits(&robot, &rows, "weave");
        offsets(&rows, &from, &to)
    };
    let whole = path(&mut |queue, _| queue.step(Cycle::MS, Override::FULL));
    let y_at = |x: f64| {
        let after = whole.partition_point(|at| at.x < x).clamp(1, whole.len() - 1);
        let (a, b) = (whole[after - 1], whole[after]);
        if b.x > a.x { a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x) } else { a.y }
    };
    let half = path(&mut |queue, cycle| queue.step(Cycle::MS, at([100.0, 30.0, 70.0][cycle / 400 % 3])));
    let stopped = path(&mut |queue, cycle| {
        match cycle {
            300 => queue.stop_on_path(Stop::Fast),
            900 | 1700 => queue.resume(),
            1400 => queue.stop_on_path(Stop::General),
            _ => {}
        }
        queue.step(Cycle::MS, Override::FULL)
    });
    for rows in [half, stopped] {
        let worst = rows.iter().map(|at| (at.y - y_at(at.x)).abs()).fold(0.0, f64::max);
        assert!(worst < 2e-3, "{worst}");
    }
}

#[test]
fn what_is_too_fast_for_the_robot_slows_the_path_down() {
    let robot = robot("kr10-r1420");
    for (frequency, amplitude) in [(8.0, 10.0), (20.0, 3.0), (3.0, 60.0)] {
        for shape in SHAPES {
            let (mut queue, mut to) = queue(&robot);
            let from = to;
            let fast = Weave { frequency, amplitude, ..weave(shape) };
            queue.add(&line(&mut to, [0.0, 100.0, 0.0], 100.0), &woven(fast)).unwrap();
            let rows = run(&mut queue, 100.0);
            let share = queue.take_slowed().0;
            assert!(share < 0.95 && share > 0.01, "{shape:?} {frequency}: {share}");
            assert_within_limits(&robot, &rows, &format!("{shape:?} {frequency}"));
            let mut places: Vec<Vector3<f64>> = rows.iter().map(|row| row.tcp.translation.vector).collect();
            for most in [robot.tcp.vel, robot.tcp.acc * 1.05, robot.tcp.jerk * 1.05] {
                places = places.windows(2).map(|pair| (pair[1] - pair[0]) / CYCLE).collect();
                let highest = places.iter().skip(1).map(Vector3::norm).fold(0.0, f64::max);
                assert!(highest <= most * 1.01, "{shape:?} {frequency}: {highest} of {most}");
            }
            assert!((offsets(&rows, &from, &to).last().unwrap() - Vector3::new(100.0, 0.0, 0.0)).norm() < 1e-6);
        }
    }
}

#[test]
fn a_weave_goes_on_through_blends_and_ends_before_a_stop() {
    let robot = robot("kr10-r1420");
    for step in [60.0, 7.0] {
        let (mut queue, mut to) = queue(&robot);
        let from = to;
        let count = (300.0 / step) as u32;
        let zone = Zone { tcp: 2.0, ..Zone::NONE };
        for _ in 0..count {
            let command = Command { zone, ..line(&mut to, [0.0, step, 0.0], 50.0) };
            queue.add(&command, &woven(weave(WeaveShape::Simple))).unwrap();
        }
        assert!(!was_late(&mut queue));
        let rows = run(&mut queue, 100.0);
        assert_within_limits(&robot, &rows, "chain");
        let off = offsets(&rows, &from, &to);
        let length = step * f64::from(count);
        // The same as along one line: a sine of 25 mm from the start of the chain.
        for at in off.iter().filter(|at| at.x > 13.0 && at.x < length - 13.0) {
            let expected = 5.0 * (at.x / 25.0 * std::f64::consts::TAU).sin();
            assert!((at.y - expected).abs() < 0.1, "{step}: {at} {expected}");
        }
        assert!((off.last().unwrap() - Vector3::new(length, 0.0, 0.0)).norm() < 1e-6);
    }
}

#[test]
fn random_chains_with_weaves_keep_every_limit_and_reach_every_target() {
    let mut random = Random::new(141);
    for name in ["kr10-r1420", "tx2-60", "irb2400-10"] {
        let robot = with_external_axes(name);
        for round in 0..4 {
            let mut queue = Queue::repeatable(robot.clone(), random_joints(&robot, &mut random, 0.5));
            let (mut added, mut tried) = (0_u32, 0);
            while added < 6 && tried < 300 {
                tried += 1;
                let end = *queue.end();
                let goal = random_joints(&robot, &mut random, 0.5);
                let mut pose = frame_components(&robot.kinematics.forward(&end.axes));
                for (index, value) in pose.iter_mut().enumerate() {
                    *value += if index < 3 { random.between(-120.0, 120.0) } else { random.between(-15.0, 15.0) };
                }
                let (external, wobj) = (goal.external, Frame::identity());
                let target = match random.between(0.0, 5.0) as u32 {
                    0 => Target::Joints(goal),
                    1 | 2 => Target::Line { pose, wobj, external },
                    _ => {
                        let here = robot.kinematics.forward(&end.axes).translation.vector;
                        let via = [0, 1, 2].map(|i| (here[i] + pose[i]) / 2.0 + random.between(-50.0, 50.0));
                        Target::Arc { via, pose, wobj, angle: None, follow: false, external }
                    }
                };
                let some = Weave {
                    frequency: random.between(0.5, 6.0),
                    amplitude: random.between(0.5, 12.0),
                    dwells: [0, 1, 2].map(|_| random.between(-0.1, 0.15).max(0.0)),
                    angle: random.between(0.0, 120.0),
                    radius: random.between(0.0, 5.0),
                    turned: Vector3::y() * random.between(-0.5, 0.5),
                    ..weave(SHAPES[random.between(0.0, 5.0) as usize])
                };
                let settings = if random.between(0.0, 1.0) < 0.8 { woven(some) } else { Settings::default() };
                let zone = if random.between(0.0, 1.0) < 0.5 { Zone { tcp: 15.0, ..Zone::NONE } } else { Zone::NONE };
                let speed =
                    Speed { tcp: random.between(10.0, 200.0), ori: 100.0, exj: 100.0, exl: 100.0, percent: 40.0 };
                let command = Command { target, zone, speed, line: added + 1, ..movej([0.0; 6]) };
                if queue.add(&command, &settings).is_ok() {
                    added += 1;
                }
            }
            assert!(added == 6, "{name}: {added} of {tried}");
            let end = *queue.end();
            let rows = run(&mut queue, 100.0);
            assert_within_limits(&robot, &rows, &format!("{name} {round}"));
            assert_eq!(values(&robot, &rows.last().unwrap().joints), values(&robot, &end), "{name} {round}");
        }
    }
}

#[test]
fn a_tool_that_points_along_the_path_leaves_no_side_to_weave_to() {
    let robot = robot("kr10-r1420");
    let (mut queue, mut to) = queue(&robot);
    let down = line(&mut to, [0.0, 0.0, -50.0], 50.0);
    assert_eq!(queue.add(&down, &woven(weave(WeaveShape::Simple))), Err(PlanError::ToolAlongPath));
    queue.add(&down, &Settings::default()).unwrap();
}
